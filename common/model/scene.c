/* SPDX-License-Identifier: GPL-2.0-or-later */
#include "model/scene.h"

#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>

const struct scene_variant scene_models[] = {
    [SCENE_BASIC] = {.name = "basic", .help = "repulsion alone"},
    [SCENE_FRICTION] = {.name = "friction",
                        .help = "with friction",
                        .friction = true},
    [SCENE_ROTATION] = {.name = "rotation",
                        .help = "with friction and spin",
                        .friction = true,
                        .rotation = true},
    {0}};

int scene_model_named(const char *name, enum scene_model *model) {
  for (size_t m = 0; scene_models[m].name; m++)
    if (!strcmp(name, scene_models[m].name)) {
      *model = (enum scene_model)m;
      return GSL_SUCCESS;
    }
  return GSL_EINVAL;
}

struct scene scene_default(void) {
  return (struct scene){.model = SCENE_ROTATION,
                        .law = {.f0 = 10,
                                .kappa = 150,
                                .psi = 10,
                                .restitution = 0.4,
                                .friction = 0.2,
                                .vmin = 0.01,
                                .lmax = 0.1},
                        .gravity = {0, 0, -9.81}};
}

const struct scene_lever scene_levers[] = {
    [LEVER_PAPER] = {"paper", "the radii"},
    [LEVER_CONTACT] = {"contact", "distances of the contact point, which keep "
                                  "angular momentum"},
    {0}};

int scene_lever_named(const char *name, enum contact_lever *lever) {
  for (size_t k = 0; scene_levers[k].name; k++)
    if (!strcmp(scene_levers[k].name, name)) {
      *lever = (enum contact_lever)k;
      return GSL_SUCCESS;
    }
  return GSL_EINVAL;
}

bool scene_has_friction(const struct scene *s) {
  return scene_models[s->model].friction && s->law.friction > 0;
}

bool scene_has_rotation(const struct scene *s) {
  return scene_models[s->model].rotation && s->law.friction > 0;
}

bool scene_has_rolling(const struct scene *s) {
  return scene_has_rotation(s) && s->law.rolling > 0;
}

bool scene_has_lever(const struct scene *s) {
  return scene_has_rotation(s) && s->law.lever != LEVER_PAPER;
}

/* Appends a wall to the first `before` of them. */
static int add_wall(struct scene *s, size_t before, const double point[3],
                    const double normal[3], double radius) {
  const double length = vec3_norm(normal);
  if (!(length > 0) || !gsl_finite(length) || !gsl_finite(vec3_norm(point)))
    return GSL_EINVAL;
  struct wall *walls =
      realloc(s->walls, (s->walls_count + 1) * sizeof *s->walls);
  if (!walls)
    return GSL_ENOMEM;
  s->walls = walls;
  struct wall *w = &walls[before];
  memmove(w + 1, w, (s->walls_count - before) * sizeof *w);
  s->walls_count++;
  for (int k = 0; k < 3; k++) {
    w->point[k] = point[k];
    w->normal[k] = normal[k] / length;
  }
  w->radius = radius;
  return GSL_SUCCESS;
}

int scene_add_wall(struct scene *s, const double point[3],
                   const double normal[3]) {
  size_t planes = 0;
  while (planes < s->walls_count && !(s->walls[planes].radius > 0))
    planes++;
  return add_wall(s, planes, point, normal, 0);
}

int scene_add_cylinder(struct scene *s, const double point[3],
                       const double axis[3], double radius) {
  if (!(radius > 0) || !gsl_finite(radius))
    return GSL_EINVAL;
  return add_wall(s, s->walls_count, point, axis, radius);
}

int scene_add_box(struct scene *s, double a, double b) {
  const double wall[5][2][3] = {{{0, 0, 0}, {0, 0, -1}},
                                {{0, 0, 0}, {-1, 0, 0}},
                                {{a, 0, 0}, {1, 0, 0}},
                                {{0, 0, 0}, {0, -1, 0}},
                                {{0, b, 0}, {0, 1, 0}}};
  for (int k = 0; k < 5; k++) {
    const int status = scene_add_wall(s, wall[k][0], wall[k][1]);
    if (status != GSL_SUCCESS)
      return status;
  }
  return GSL_SUCCESS;
}

const char *scene_check(const struct scene *s) {
  const struct contact_law *c = &s->law;
  if (!(c->f0 > 0 && gsl_finite(c->f0)))
    return "f0 must be positive";
  if (!(c->kappa > 0 && gsl_finite(c->kappa)))
    return "kappa must be positive";
  if (!(c->psi > 0 && gsl_finite(c->psi)))
    return "psi must be positive";
  if (!(c->restitution >= 0 && c->restitution <= 1))
    return "restitution must be between 0 and 1";
  if (!(c->friction >= 0 && gsl_finite(c->friction)))
    return "friction must not be negative";
  if (!(c->rolling >= 0 && gsl_finite(c->rolling)))
    return "rolling must not be negative";
  if (!(c->vmin > 0 && gsl_finite(c->vmin)))
    return "vmin must be positive";
  if (!(c->lmax > 0 && gsl_finite(c->lmax)))
    return "lmax must be positive";
  if (!gsl_finite(vec3_norm(s->gravity)))
    return "gravity must be finite";
  return NULL;
}

void scene_free(struct scene *s) {
  free(s->walls);
  s->walls = NULL;
  s->walls_count = 0;
}

static void store_walls(struct scene *scene, struct store *s) {
  size_t count = scene->walls_count;
  store_size(s, &count);
  for (size_t k = 0; k < count && store_status(s) == GSL_SUCCESS; k++) {
    const double up[3] = {0, 0, 1};
    if (s->loads && scene_add_wall(scene, up, up) != GSL_SUCCESS) {
      store_fail(s, GSL_ENOMEM);
      return;
    }
    store_doubles(s, scene->walls[k].point, 3);
    store_doubles(s, scene->walls[k].normal, 3); /* not normalised again */
    store_double(s, &scene->walls[k].radius);
  }
}

void scene_store(struct scene *scene, struct store *s) {
  struct stored {
    enum scene_model model;
    struct contact_law law;
    double gravity[3], period[3];
    size_t walls_count;
    void *walls;
  };
  _Static_assert(sizeof(struct scene) == sizeof(struct stored),
                 "what is new in a scene is to be stored");
  size_t model = scene->model;
  store_part(s, "scene");
  store_size(s, &model);
  if (model > SCENE_ROTATION)
    store_fail(s, GSL_EINVAL);
  else
    scene->model = (enum scene_model)model;
  store_plain(s, &scene->law, sizeof scene->law);
  store_doubles(s, scene->gravity, 3);
  store_doubles(s, scene->period, 3);
  store_walls(scene, s);
}
