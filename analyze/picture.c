/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "picture.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "label.h"
#include "measure.h"
#include "platform/system.h"
#include "program/litter.h"
#include "program/origin.h"
#include "geometry/neighbors.h"

enum { HEIGHT, SPEED, RADIUS, CONTACTS, ID };

const struct picture_color picture_colors[] = {
    [HEIGHT] = {"height", "height (m)", "centre above the origin",
                .from_zero = false},
    [SPEED] = {"speed", "speed (m/s)", "of the centre", .from_zero = true},
    [RADIUS] = {"radius", "radius (m)", "of the sphere", .from_zero = false},
    [CONTACTS] = {"contacts", "touching spheres", "how many touch the sphere",
                  .from_zero = true, .whole = true},
    [ID] = {"id", "id", "number of the sphere", .whole = true},
    {0}};

static char *joined(const char *a, const char *b, const char *c) {
  const size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
  char *text = malloc(size);
  if (!text)
    die(EXIT_IO, "out of memory");
  snprintf(text, size, "%s%s%s", a, b, c);
  return text;
}

bool ends_in(const char *name, const char *ending) {
  const size_t n = strlen(name), e = strlen(ending);
  return n > e && !strcmp(name + n - e, ending);
}

/* The scratch directory and what is in it go with the program. */

struct scratch_file {
  char *path;
  struct scratch_file *next;
};

void picture_begin(struct picture *p, const char *output, bool quiet) {
  p->progress = progress_begin(quiet);
  p->done = -1;
  if (!(p->view.at[1] >= 0 && p->view.at[1] <= 90) ||
      !(fabs(p->view.at[0]) <= 360))
    die(EXIT_USAGE, "--view: expected a turn from -360 to 360 and an angle to "
                    "the vertical from 0 to 90");
  if (!output && isatty(STDOUT_FILENO))
    die(EXIT_USAGE, "expected --output, or a file or pipe for the picture");
  p->file.stream = stdout;
  if (output)
    output_open(&p->file, output);
  const char *place = getenv("TMPDIR");
  p->scratch = joined(place && *place ? place : "/tmp", "/dem-XXXXXX", "");
  litter_hold();
  litter_add(p->scratch); /* has its name when it is there */
  if (!mkdtemp(p->scratch))
    die(EXIT_IO, "%s: %s", p->scratch, strerror(errno));
  litter_release();
}

const char *picture_path(struct picture *p, const char *name) {
  const size_t directory = strlen(p->scratch) + 1;
  struct scratch_file *f;
  for (f = p->files; f; f = f->next)
    if (!strcmp(f->path + directory, name))
      return f->path;
  f = malloc(sizeof *f);
  if (!f)
    die(EXIT_IO, "out of memory");
  *f = (struct scratch_file){joined(p->scratch, "/", name), p->files};
  p->files = f;
  litter_add(f->path);
  return f->path;
}

char *picture_script(const char *name) {
  /* from the program: where it is installed, and where it was built */
  static const char *const places[] = {"/../share/dem/plots/", "/plots/"};
  const char *set = getenv("DEM_PLOTS");
  if (set && *set)
    return joined(set, "/", name);
  char program[4096];
  if (!system_program(program, sizeof program))
    *program = 0;
  char *slash = strrchr(program, '/');
  for (size_t k = 0; slash && k < sizeof places / sizeof *places; k++) {
    *slash = 0;
    char *script = joined(program, places[k], name);
    if (access(script, R_OK) == 0)
      return script;
    free(script);
  }
  die(EXIT_IO,
      "%s: not found in share/dem/plots beside the program: expected its "
      "directory in DEM_PLOTS",
      name);
}

/* Marks of the picture */

/* The row of picture_colors that the user named. */
static size_t chosen_color(const struct picture *p) {
  size_t c = 0;
  while (strcmp(picture_colors[c].name, p->color))
    c++;
  return c;
}

static void check_memory(int status) {
  if (status != GSL_SUCCESS)
    die_status(status, "colours");
}

/* One number for each sphere. */
static double *color_values(const struct picture *p, const struct bed *b) {
  const size_t color = chosen_color(p);
  double *value = calloc(b->n + 1, sizeof *value);
  if (!value)
    die(EXIT_IO, "out of memory");
  if (color == CONTACTS) {
    struct neighbors near = {0};
    check_memory(neighbors_find(&near, b->n, b->x, 3, b->r, 0));
    for (size_t k = 0; k < near.count; k++) {
      value[near.i[k]]++;
      value[near.j[k]]++;
    }
    neighbors_free(&near);
    return value;
  }
  for (size_t i = 0; i < b->n; i++) {
    const double *v = b->v + 3 * i;
    value[i] = color == HEIGHT  ? b->x[3 * i + 2]
               : color == SPEED ? gsl_hypot3(v[0], v[1], v[2])
               : color == ID    ? (double)b->id[i]
                                : b->r[i];
  }
  return value;
}

static void widen(double *low, double *high, double from, double to,
                  bool first) {
  if (low && (first || from < *low))
    *low = from;
  if (high && (first || to > *high))
    *high = to;
}

void picture_measure(struct picture *p, const struct bed *b,
                     const struct bed_header *h) {
  header_walls(h, p->box, p->fixed);
  double *value = color_values(p, b);
  for (size_t i = 0; i < b->n; i++, p->measured++) {
    const bool first = !p->measured;
    for (size_t a = 0; a < 3; a++)
      widen(p->fixed[2 * a] ? NULL : &p->box[2 * a],
            p->fixed[2 * a + 1] ? NULL : &p->box[2 * a + 1],
            b->x[3 * i + a] - b->r[i], b->x[3 * i + a] + b->r[i], first);
    widen(&p->low, &p->high, value[i], value[i], first);
  }
  free(value);
}

/* The viewer's axes, as plots/draw/balls.gp has them: rightwards, upwards, to
   the viewer. */
static void view_axes(const struct picture *p, double axes[3][3]) {
  const double turn = p->view.at[0] * M_PI / 180,
               tilt = p->view.at[1] * M_PI / 180;
  const double a[3][3] = {
      {cos(turn), sin(turn), 0},
      {-cos(tilt) * sin(turn), cos(tilt) * cos(turn), sin(tilt)},
      {sin(tilt) * sin(turn), -sin(tilt) * cos(turn), cos(tilt)}};
  memcpy(axes, a, sizeof a);
}

/* Which spheres can be seen: those that are foremost in a pixel of a coarse
   picture. Of a large bed that leaves a few thousand. */
enum { PIXELS = 1000 };

static bool *find_seen(const struct picture *p, const struct bed *b) {
  double axes[3][3], low[2] = {0}, high[2] = {0};
  bool *seen = calloc(b->n + 1, sizeof *seen);
  double *place = malloc((3 * b->n + 1) * sizeof *place);
  size_t *front = malloc(PIXELS * PIXELS * sizeof *front);
  double *depth = malloc(PIXELS * PIXELS * sizeof *depth);
  if (!seen || !place || !front || !depth)
    die(EXIT_IO, "out of memory");
  view_axes(p, axes);
  for (size_t i = 0; i < b->n; i++)
    for (size_t k = 0; k < 3; k++) {
      const double *x = b->x + 3 * i, *a = axes[k];
      const double at = a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
      place[3 * i + k] = at;
      if (k < 2)
        widen(&low[k], &high[k], at - b->r[i], at + b->r[i], i == 0);
    }
  const double size =
      fmax(fmax(high[0] - low[0], high[1] - low[1]), 1e-300) / PIXELS;
  for (size_t k = 0; k < PIXELS * PIXELS; k++)
    depth[k] = -HUGE_VAL;
  for (size_t i = 0; i < b->n; i++) {
    const double r = fmax(b->r[i] / size, 0.75),
                 x = (place[3 * i] - low[0]) / size,
                 y = (place[3 * i + 1] - low[1]) / size;
    const int x0 = (int)fmax(0, ceil(x - r - 0.5)),
              x1 = (int)fmin(PIXELS - 1, floor(x + r - 0.5)),
              y0 = (int)fmax(0, ceil(y - r - 0.5)),
              y1 = (int)fmin(PIXELS - 1, floor(y + r - 0.5));
    for (int v = y0; v <= y1; v++)
      for (int u = x0; u <= x1; u++) {
        const double du = u + 0.5 - x, dv = v + 0.5 - y,
                     q = r * r - du * du - dv * dv;
        const size_t k = (size_t)v * PIXELS + (size_t)u;
        const double z = q > 0 ? place[3 * i + 2] / size + sqrt(q) : -HUGE_VAL;
        if (z > depth[k]) {
          depth[k] = z;
          front[k] = i;
        }
      }
  }
  for (size_t k = 0; k < PIXELS * PIXELS; k++)
    if (depth[k] > -HUGE_VAL)
      seen[front[k]] = true;
  free(place);
  free(front);
  free(depth);
  return seen;
}

void picture_write(struct picture *p, const struct bed *b, const char *name) {
  const char *path = picture_path(p, name);
  FILE *out = fopen(path, "w");
  if (!out)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  double *value = color_values(p, b);
  bool *seen = find_seen(p, b);
  fprintf(out, "# t=%.17g\nx\ty\tz\tr\tvalue\n", b->t);
  for (size_t i = 0; i < b->n; i++)
    if (seen[i])
      fprintf(out, "%.9g\t%.9g\t%.9g\t%.9g\t%.9g\n", b->x[3 * i],
              b->x[3 * i + 1], b->x[3 * i + 2], b->r[i], value[i]);
  if (ferror(out) | fclose(out))
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  free(seen);
  free(value);
}

void picture_of(struct picture *p, const struct frames *f) {
  char *const bed = frames_origin(f);
  p->origin = origin_text(bed);
  free(bed);
}

/* Programs that draw. */

/* The first line of what a program said that says something. */
static void first_line(FILE *said, char *text, size_t size) {
  rewind(said);
  text[0] = 0;
  while (fgets(text, (int)size, said)) {
    text[strcspn(text, "\n")] = 0;
    if (strspn(text, " \t^") != strlen(text))
      return;
    text[0] = 0;
  }
}

void picture_run(struct picture *p, const char *package,
                 const char *const argv[]) {
  FILE *said = tmpfile();
  if (!said)
    die(EXIT_IO, "%s: %s", p->scratch, strerror(errno));
  fflush(stdout);
  const pid_t child = litter_fork(); /* a signal ends it, and then us */
  if (child == 0) {
    const int none = open("/dev/null", O_RDWR);
    if (none < 0 || dup2(none, STDIN_FILENO) < 0 ||
        dup2(fileno(said), STDOUT_FILENO) < 0 ||
        dup2(fileno(said), STDERR_FILENO) < 0)
      _exit(126);
    execvp(argv[0], (char *const *)argv);
    _exit(errno == ENOENT ? 127 : 126);
  }
  int status = 0;
  static const struct timespec pause = {.tv_nsec = 5000000};
  for (pid_t ended = 0; child > 0 && ended != child;) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR)
      break;
    progress_tell(&p->progress, p->done);
    if (ended == 0)
      nanosleep(&pause, NULL);
  }
  litter_forked();
  char text[200];
  first_line(said, text, sizeof text);
  fclose(said);
  if (child < 0)
    die(EXIT_IO, "%s: %s", argv[0], strerror(errno));
  if (WIFSIGNALED(status))
    die(EXIT_IO, "%s: ended by signal %d", argv[0], WTERMSIG(status));
  if (WEXITSTATUS(status) == 127)
    die(EXIT_IO, "%s: not found: expected it to be installed (Debian: %s)",
        argv[0], package);
  if (status != 0)
    die(EXIT_IO, "%s: %s", argv[0], *text ? text : "failed");
}

void picture_draw(struct picture *p, const char *name, const char *output) {
  const struct picture_color *color = &picture_colors[chosen_color(p)];
  const double *b = p->box;
  double size[3], widest = 0, low = p->low, high = p->high;
  if (color->from_zero)
    low = 0;
  for (int a = 0; a < 3; a++)
    widest = fmax(widest, b[2 * a + 1] - b[2 * a]);
  for (int a = 0; a < 3; a++) /* walls may meet */
    size[a] = fmax(b[2 * a + 1] - b[2 * a], 1e-6 * widest);
  if (!(high > low) && color->whole) {
    high = low + 1;
  } else if (!(high > low)) { /* one value: the middle of the scale */
    const double half = low != 0 ? fabs(low) / 2 : 0.5;
    low -= half;
    high += half;
  }
  char set[600];
  snprintf(set, sizeof set,
           "turn=%.9g; tilt=%.9g; origin_x=%.9g; origin_y=%.9g; "
           "origin_z=%.9g; base_x=%.9g; base_y=%.9g; box_height=%.9g; "
           "lean=%.9g; value_column='value'; value_low=%.9g; value_high=%.9g; "
           "value_label='%s'; facets=%zu.; magnify=%d",
           p->view.at[0], p->view.at[1], b[0], b[2], b[4], size[0], size[1],
           size[2], 0.03 * fmax(size[0], size[1]), low, high, color->label,
           p->facets, p->half_size ? 1 : 2);
  char *script = picture_script("bed.gp");
  const char *data = picture_path(p, name);
  /* -d: whatever the user's own ~/.gnuplot has */
  const char *const argv[] = {"gnuplot", "-d", "-e",   set, "-c",
                              script,    data, output, NULL};
  picture_run(p, "gnuplot-nox", argv);
  if (access(output, R_OK) != 0)
    die(EXIT_IO, "gnuplot: it made no picture");
  free(script);
}

/* As the program's end would do. */
static void remove_scratch(struct picture *p) {
  while (p->files) {
    struct scratch_file *f = p->files;
    p->files = f->next;
    unlink(f->path);
    litter_forget(f->path);
    free(f->path);
    free(f);
  }
  rmdir(p->scratch);
  litter_forget(p->scratch);
  free(p->scratch);
}

void picture_deliver(struct picture *p, const char *path) {
  FILE *in = fopen(path, "rb");
  if (!in)
    die(EXIT_IO, "%s: %s", path, strerror(errno));
  label_copy(in, p->file.stream, p->origin); /* what follows finds an error */
  const bool failed = ferror(in);
  fclose(in);
  if (failed)
    die(EXIT_IO, "%s: read error", path);
  if (p->file.path)
    output_commit(&p->file);
  else
    finish_output();
  remove_scratch(p);
  free(p->origin);
}
