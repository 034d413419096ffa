/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "program/scene_options.h"

#include <stdio.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "program/shared_options.h"

struct scene_words scene_words_default(void) {
  const struct scene s = scene_default();
  return (struct scene_words){.model = scene_models[s.model].name,
                              .gravity = {1, {-s.gravity[2]}},
                              .base = {2, {1, 1}}};
}

int scene_wall_option(const struct option_list *v, void *scene) {
  return scene_add_wall(scene, v->at, v->at + 3);
}

void scene_lever_unset(char *text, size_t size) {
  snprintf(text, size, "%s", scene_levers[0].name);
}

int scene_cylinder_option(const struct option_list *v, void *scene) {
  return scene_add_cylinder(scene, v->at, v->at + 3, v->at[6]);
}

const char *const scene_periodic[] = {"x", "y", "xy", NULL};

void scene_no_periodic(char *text, size_t size) {
  snprintf(text, size, "none");
}

const char *scene_finish(struct scene *s, const struct scene_words *w) {
  const struct option_list *g = &w->gravity;
  if (scene_model_named(w->model, &s->model) != GSL_SUCCESS)
    return "model: expected basic, friction or rotation";
  if (w->lever && scene_lever_named(w->lever, &s->law.lever) != GSL_SUCCESS)
    return "lever: expected paper or contact";
  if (g->count != 1 && g->count != 3)
    return "gravity: expected one number or three";
  for (int k = 0; k < 3; k++)
    s->gravity[k] = g->count == 3 ? g->at[k] : 0;
  if (g->count == 1)
    s->gravity[2] = -g->at[0];
  for (int k = 0; k < 2; k++) {
    const bool wanted = w->periodic && strchr(w->periodic, "xy"[k]);
    if (wanted && !(w->base.count == 2 && w->base.at[k] > 0))
      return "periodic: expected sides by base=a,b above 0";
    s->period[k] = wanted ? w->base.at[k] : 0;
  }
  return scene_check(s);
}

const char *header_options(const struct bed_header *h,
                           struct option_spec *options,
                           bool (*skip)(const struct option_spec *)) {
  static _Thread_local char wrong[512];
  for (size_t k = 0; k < h->count; k++) {
    struct option_spec *o = option_find(options, h->at[k].name);
    if (!o || !o->parameter || o->given || (skip && skip(o)))
      continue;
    const char *want = option_set(o, h->at[k].value);
    if (!want)
      continue;
    snprintf(wrong, sizeof wrong, "%s=%.100s: expected %s", o->name,
             h->at[k].value, want);
    return wrong;
  }
  return NULL;
}

static bool is_no_gravity(const struct option_spec *o) {
  return strcmp(o->name, "gravity") != 0;
}

struct similarity header_similarity(const struct bed_header *h,
                                    struct option_spec *options,
                                    const struct scene_words *w, double radius,
                                    double mass) {
  header_options(h, options, is_no_gravity);
  const double *g = w->gravity.at;
  const double strength =
      w->gravity.count == 1 ? fabs(g[0]) : gsl_hypot3(g[0], g[1], g[2]);
  const struct similarity s = similarity_of(radius, mass, strength);
  options_scale(options, &s);
  return s;
}

const char *scene_from_header(struct scene *s, const struct bed_header *h,
                              const struct bed *b) {
  *s = scene_default();
  struct scene_words words = scene_words_default();
  struct option_spec options[] = {SCENE_OPTIONS(*s, words),
                                  {.name = "base",
                                   .type = OPTION_LIST,
                                   .value = &words.base,
                                   .least = 2,
                                   .most = 2,
                                   .parameter = true},
                                  {0}};
  words.base.count = 0; /* none is known but for a header's */
  if (h && b && b->n)
    header_similarity(h, options, &words, bed_mean(b, b->r), bed_mean(b, b->m));
  const char *wrong = h ? header_options(h, options, NULL) : NULL;
  return wrong ? wrong : scene_finish(s, &words);
}
