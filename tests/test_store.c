/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The store: what is put in comes out again to the last bit, and what does not
   fit is refused. Integrators that are taken out of one go on as those that
   were put in; settle's whole runs are tested in test_checkpoint.sh. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "check.h"
#include "platform/checksum.h"
#include "platform/store.h"
#include "steppers/integrate.h"

/* --- checksum --------------------------------------------------------------*/

static uint32_t sum_of(const char *text, size_t first) {
  struct checksum c = checksum_begin();
  checksum_add(&c, text, first);
  checksum_add(&c, text + first, strlen(text) - first);
  return checksum_value(&c);
}

static void test_checksum(void) {
  /* the check value of the CRC-32 in every table of CRCs */
  for (size_t first = 0; first <= 9; first++)
    CHECK(sum_of("123456789", first) == 0xCBF43926u);
  CHECK(sum_of("", 0) == 0);
  CHECK(sum_of("The quick brown fox jumps over the lazy dog", 11) ==
        0x414FA339u);
}

/* --- values ----------------------------------------------------------------*/

struct thing {
  double x, row[3];
  size_t n, rows[2];
  bool flag, flags[3];
  char *text, *none;
  struct {
    int a;
    double b;
  } plain;
};

static void thing_store(struct thing *t, struct store *s) {
  store_part(s, "thing");
  store_double(s, &t->x);
  store_doubles(s, t->row, 3);
  store_size(s, &t->n);
  store_sizes(s, t->rows, 2);
  store_flag(s, &t->flag);
  store_flags(s, t->flags, 3);
  store_text(s, &t->text);
  store_text(s, &t->none);
  store_plain(s, &t->plain, sizeof t->plain);
}

static const struct thing example = {
    .x = 0x1.fffffffffffffp-1022,
    .row = {-0.0, INFINITY, 0x1.23456789abcdep3},
    .n = SIZE_MAX,
    .rows = {5, 7},
    .flag = true,
    .flags = {true, false, true},
    .text = (char[]){"a\nb"},
    .plain = {7, 0.1}};

static bool same(const struct thing *a, const struct thing *b) {
  return !memcmp(&a->x, &b->x, sizeof a->x) &&
         !memcmp(a->row, b->row, sizeof a->row) && a->n == b->n &&
         a->rows[0] == b->rows[0] && a->rows[1] == b->rows[1] &&
         a->flag == b->flag && !memcmp(a->flags, b->flags, sizeof a->flags) &&
         a->text && !strcmp(a->text, b->text) && !a->none &&
         a->plain.a == b->plain.a && a->plain.b == b->plain.b;
}

/* A file with the example; how long it is. */
static FILE *example_file(size_t *length) {
  FILE *file = tmpfile();
  struct thing t = example;
  struct store s = store_saving(file);
  thing_store(&t, &s);
  CHECK(store_status(&s) == GSL_SUCCESS);
  *length = (size_t)ftell(file);
  rewind(file);
  return file;
}

static void test_values(void) {
  size_t length;
  FILE *file = example_file(&length);
  struct thing t = {0};
  struct store s = store_loading(file);
  thing_store(&t, &s);
  CHECK(store_status(&s) == GSL_SUCCESS && same(&t, &example));
  CHECK((size_t)ftell(file) == length);
  double more;
  store_double(&s, &more);
  CHECK(store_status(&s) == GSL_EFAILED);
  free(t.text);
  fclose(file);
}

/* Ends anywhere: an error, no memory lost (under the sanitizers). */
static void test_short(void) {
  size_t length;
  FILE *file = example_file(&length);
  char *bytes = malloc(length);
  CHECK(fread(bytes, 1, length, file) == length);
  fclose(file);
  for (size_t cut = 0; cut < length; cut++) {
    FILE *part = tmpfile();
    CHECK(fwrite(bytes, 1, cut, part) == cut);
    rewind(part);
    struct thing t = {0};
    struct store s = store_loading(part);
    thing_store(&t, &s);
    CHECK(store_status(&s) == GSL_EFAILED);
    free(t.text);
    fclose(part);
  }
  free(bytes);
}

/* What stands in the file, and what is asked for. */
static int status_of(void (*put)(struct store *),
                     void (*take)(struct store *)) {
  FILE *file = tmpfile();
  struct store in = store_saving(file);
  put(&in);
  CHECK(store_status(&in) == GSL_SUCCESS);
  rewind(file);
  struct store out = store_loading(file);
  take(&out);
  fclose(file);
  return store_status(&out);
}

static void part_a(struct store *s) {
  store_part(s, "part a");
}
static void part_b(struct store *s) {
  store_part(s, "part b");
}
static void part_longer(struct store *s) {
  store_part(s, "part a and more");
}
static void three_doubles(struct store *s) {
  double x[3] = {1, 2, 3};
  store_doubles(s, x, 3);
}
static void two_doubles(struct store *s) {
  double x[2] = {0};
  store_doubles(s, x, 2);
  CHECK(s->loads && x[0] == 0);
}
static void a_byte(struct store *s) {
  unsigned char byte = 2;
  store_bytes(s, &byte, 1);
}
static void a_flag(struct store *s) {
  bool flag = false;
  store_flag(s, &flag);
  CHECK(!flag);
}
static void a_long_text(struct store *s) {
  bool there = true;
  size_t length = (1 << 20) + 1;
  store_flag(s, &there);
  store_size(s, &length);
}
static void a_text(struct store *s) {
  char *text = NULL;
  store_text(s, &text);
  CHECK(!text);
}

static void test_misfits(void) {
  CHECK(status_of(part_a, part_a) == GSL_SUCCESS);
  CHECK(status_of(part_a, part_b) == GSL_EINVAL);
  CHECK(status_of(part_a, part_longer) == GSL_EINVAL);
  CHECK(status_of(part_longer, part_a) == GSL_EINVAL);
  CHECK(status_of(three_doubles, two_doubles) == GSL_EINVAL);
  CHECK(status_of(a_byte, a_flag) == GSL_EINVAL);
  CHECK(status_of(a_long_text, a_text) == GSL_EINVAL);
}

static void test_full(void) {
  FILE *full = fopen("/dev/full", "w");
  if (!full)
    return; /* a system without it has nothing to test here */
  setvbuf(full, NULL, _IONBF, 0);
  struct thing t = example;
  struct store s = store_saving(full);
  thing_store(&t, &s);
  CHECK(store_status(&s) == GSL_EFAILED);
  fclose(full);
}

/* --- integrators -----------------------------------------------------------*/

/* Stiff at times, so that steps change and are rejected. */
static int pulses(double t, const double y[], double dydt[], void *params) {
  (void)params;
  const double k = 50 + 2000 * gsl_pow_8(sin(3 * t));
  dydt[0] = y[1];
  dydt[1] = -k * y[0] - 20 * y[1] + cos(t);
  return GSL_SUCCESS;
}

static int begin(struct integrator **it, const char *method,
                 const char *control, double step, double t) {
  static const double scale[2] = {0.01, 1}, start[2] = {1, 0};
  const struct integrate_options o = {.method = method,
                                      .control = control,
                                      .tol = 1e-3,
                                      .hinit = 0.01,
                                      .step = step};
  return integrate_alloc(it, &o,
                         &(struct integrate_problem){
                             .system = {.function = pulses, .dimension = 2},
                             .scale = scale,
                             .row = 2,
                             .positions = 1},
                         t, start);
}

/* Goes on after a number of steps in another integrator, beside the first. */
static void test_goes_on(const char *method, const char *control, double step,
                         int steps) {
  struct integrator *first, *second;
  CHECK(begin(&first, method, control, step, 0) == GSL_SUCCESS);
  CHECK(begin(&second, method, control, step, 17) == GSL_SUCCESS);
  for (int k = 0; k < steps; k++)
    CHECK(integrate_step(first) == GSL_SUCCESS);
  FILE *file = tmpfile();
  struct store in = store_saving(file);
  integrate_store(first, &in);
  rewind(file);
  struct store out = store_loading(file);
  integrate_store(second, &out);
  CHECK(store_status(&out) == GSL_SUCCESS);
  fclose(file);
  for (int k = 0; k < 200; k++) {
    CHECK(integrate_step(first) == GSL_SUCCESS);
    CHECK(integrate_step(second) == GSL_SUCCESS);
    const struct integrate_counts a = integrate_counts(first),
                                  b = integrate_counts(second);
    if (!CHECK(integrate_time(first) == integrate_time(second) &&
               !memcmp(integrate_state(first), integrate_state(second),
                       2 * sizeof(double)) &&
               integrate_last_step(first) == integrate_last_step(second) &&
               a.accepted == b.accepted && a.rejected == b.rejected)) {
      printf("%s, %s: step %d after %d\n", method, control, k, steps);
      break;
    }
  }
  integrate_free(first);
  integrate_free(second);
}

static void test_integrators(void) {
  for (const struct integrate_method *m = integrate_methods; m->name; m++) {
    if (!m->type || m->opaque)
      continue;
    for (int steps = 0; steps < 12; steps += 5) {
      if (m->fixed)
        test_goes_on(m->name, "paper", 1e-3, steps);
      for (const struct integrate_control *c = integrate_controls;
           m->estimates && c->name; c++)
        if (c->alloc)
          test_goes_on(m->name, c->name, 0, steps);
    }
  }
}

/* --- no memory within a step -----------------------------------------------*/

static int out_of_memory(double t, const double y[], double dydt[],
                         void *params) {
  size_t *left = params;
  return (*left)-- ? pulses(t, y, dydt, NULL) : GSL_EFAULT;
}

/* It ends there, wherever in the step, and does not go on by another one. */
static void test_memory(const char *method) {
  static const double scale[2] = {0.01, 1}, start[2] = {1, 0};
  for (size_t calls = 1; calls < 12; calls++) {
    size_t left = calls;
    struct integrator *it;
    const struct integrate_options o = {
        .method = method, .control = "standard", .tol = 1e-3, .hinit = 0.01};
    CHECK(integrate_alloc(
              &it, &o,
              &(struct integrate_problem){.system = {.function = out_of_memory,
                                                     .dimension = 2,
                                                     .params = &left},
                                          .scale = scale},
              0, start) == GSL_SUCCESS);
    int status = GSL_SUCCESS;
    for (int k = 0; k < 12 && status == GSL_SUCCESS; k++)
      status = integrate_step(it);
    CHECK(status == GSL_ENOMEM);
    integrate_free(it);
  }
}

int main(void) {
  gsl_set_error_handler_off();
  test_checksum();
  test_values();
  test_short();
  test_misfits();
  test_full();
  test_integrators();
  test_memory("merson");
  test_memory("rkf45");
  test_memory("rkc");
  return check_done();
}
