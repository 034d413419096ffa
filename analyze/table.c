/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "table.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "files/numbers.h"
#include "program/command_line.h"
#include "program/origin.h"

struct table_cell {
  double n, mean, squares; /* of deviations from the mean, summed */
  char *text;              /* of a column of words: that of the first bed */
};

void table_open(struct table *t, const struct frames *f, bool mean) {
  *t = (struct table){
      .frames = f, .file = frames_several(f) || mean, .mean = mean};
}

static void put_names(const struct table *t) {
  printf("%s%s\n", t->file ? "file\t" : "", t->names);
}

static void put_origin(const struct table *t) {
  origin_write(stdout, &origin_comment, command_line(), NULL);
  if (t->kernel)
    origin_put(stdout, &origin_comment, "kernel", t->kernel);
}

static void put_gap(const struct table *t) {
  if (t->layout != TABLE_ROWS)
    fputs(t->layout == TABLE_BLOCKS ? "\n\n" : "\n", stdout);
}

static void begin(struct table_mean *m, bool next) {
  if (!next)
    return;
  if (m->count > 1)
    m->uneven |= m->row != m->first_rows;
  if (m->count == 1)
    m->first_rows = m->row;
  m->count++;
  m->row = 0;
}

void table_frame(struct table *t, enum table_layout layout, const char *names) {
  assert(t->column == 0 && (!t->names || !strcmp(t->names, names)));
  if (!t->names) {
    t->columns = 1;
    for (const char *c = names; *c; c++)
      t->columns += *c == '\t';
  }
  t->layout = layout;
  t->names = names;
  if (t->frames_count)
    put_gap(t);
  else if (t->frames->options.origin)
    put_origin(t);
  if (!t->frames_count || layout == TABLE_BLOCKS)
    put_names(t);
  begin(&t->each, true);
  begin(&t->beds, t->frames->first || !t->frames_count);
  t->frames_count++;
}

static void *need(void *memory) {
  if (!memory)
    die(EXIT_IO, "out of memory");
  return memory;
}

static struct table_cell *cell_at(const struct table *t, struct table_mean *m) {
  const size_t needed = (m->row + 1) * t->columns;
  if (needed > m->size) {
    const size_t size = 2 * needed;
    m->cells = need(realloc(m->cells, size * sizeof *m->cells));
    memset(m->cells + m->size, 0, (size - m->size) * sizeof *m->cells);
    m->size = size;
  }
  return &m->cells[m->row * t->columns + t->column];
}

static void add(const struct table *t, struct table_mean *m, double x) {
  struct table_cell *c = cell_at(t, m);
  const double off = x - c->mean;
  c->n++;
  c->mean += off / c->n;
  c->squares += off * (x - c->mean);
}

/* Writes the start of a field: the file, or a tab. */
static void begin_field(const struct table *t, const char *file) {
  assert(t->column < t->columns);
  if (t->column)
    putchar('\t');
  else if (t->file)
    printf("%s\t", file);
}

static void put_number(double x) {
  char text[NUMBER_SIZE];
  number_format(x, text);
  fputs(isnan(x) ? "nan" : text, stdout);
}

static void end_number(struct table *t, double x) {
  if (t->mean) {
    add(t, &t->beds, x);
    add(t, &t->each, x);
  }
  t->column++;
}

void table_number(struct table *t, double x) {
  begin_field(t, t->frames->name);
  put_number(x);
  end_number(t, x);
}

void table_count(struct table *t, size_t n) {
  begin_field(t, t->frames->name);
  printf("%zu", n);
  end_number(t, (double)n);
}

void table_id(struct table *t, long id) {
  begin_field(t, t->frames->name);
  printf("%ld", id);
  end_number(t, (double)id);
}

void table_text(struct table *t, const char *text) {
  begin_field(t, t->frames->name);
  fputs(text, stdout);
  if (t->mean) {
    struct table_cell *c = cell_at(t, &t->beds);
    c->text = c->text ? c->text : need(strdup(text));
    c = cell_at(t, &t->each);
    c->text = c->text ? c->text : need(strdup(text));
  }
  t->column++;
}

void table_end_row(struct table *t) {
  assert(t->column == t->columns);
  putchar('\n');
  t->column = 0;
  t->beds.row++;
  t->each.row++;
}

static double error_of(const struct table_cell *c) {
  return c->n > 1 ? sqrt(c->squares / (c->n - 1) / c->n) : NAN;
}

static void put_means(struct table *t, const struct table_mean *m,
                      const char *file, bool errors) {
  put_gap(t);
  if (t->layout == TABLE_BLOCKS)
    put_names(t);
  for (size_t row = 0; row < m->first_rows; row++) {
    for (t->column = 0; t->column < t->columns; t->column++) {
      const struct table_cell *c = &m->cells[row * t->columns + t->column];
      begin_field(t, file);
      if (c->text)
        fputs(c->text, stdout);
      else
        put_number(errors ? error_of(c) : c->mean);
    }
    putchar('\n');
  }
  t->column = 0;
}

static void free_cells(const struct table_mean *m) {
  for (size_t k = 0; k < m->size; k++)
    free(m->cells[k].text);
  free(m->cells);
}

void table_close(struct table *t) {
  struct table_mean *m = t->beds.count > 1 ? &t->beds : &t->each;
  begin(m, true); /* counts the rows of the last one */
  if (t->mean && t->names) {
    if (m->uneven)
      die(EXIT_INPUT, "--mean: %s differ in the number of their rows",
          m == &t->beds ? "beds" : "frames");
    put_means(t, m, "mean", false);
    put_means(t, m, "standard_error", true);
  }
  free_cells(&t->beds);
  free_cells(&t->each);
}
