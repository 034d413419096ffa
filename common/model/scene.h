/* SPDX-License-Identifier: GPL-2.0-or-later */
/* A scene without its spheres: the variant of the model, the contact
   law's parameters, gravity and walls; and one check of it all. */
#ifndef SCENE_H
#define SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include "model/contact.h"
#include "platform/store.h"

/* Lever arms by name: the enum contact_lever. */
struct scene_lever {
  const char *name, *help;
};
extern const struct scene_lever scene_levers[];

/* The paper's three variants (section 3). */
enum scene_model { SCENE_BASIC, SCENE_FRICTION, SCENE_ROTATION };

/* Their features, by number; the last has no name. */
struct scene_variant {
  const char *name, *help;
  bool friction, rotation;
};
extern const struct scene_variant scene_models[];

/* The variant of that name, or GSL_EINVAL. */
int scene_model_named(const char *name, enum scene_model *model);

/* The lever of that name, or GSL_EINVAL. */
int scene_lever_named(const char *name, enum contact_lever *lever);

/* A plane, with the spheres on the side that the normal points away from; or
   the inside of a cylinder. */
struct wall {
  double point[3];  /* any point on it, or on the axis (m) */
  double normal[3]; /* outward, or along the axis; unit length */
  double radius;    /* of the cylinder (m); 0: a plane */
};

struct scene {
  enum scene_model model;
  struct contact_law law;
  double gravity[3]; /* m/s^2 */
  double period[3];  /* along each axis (m); 0: not periodic */
  size_t walls_count;
  struct wall *walls; /* planes first, then cylinders */
};

/* The paper's Tab. 4.2 with the full model and no walls. */
struct scene scene_default(void);

/* The forces and unknowns that the scene needs, which may be fewer than those
   of the variant that it names: with phi = 0 there is no friction, and without
   friction nothing turns. */
bool scene_has_friction(const struct scene *s);
bool scene_has_rotation(const struct scene *s);
/* Features that only turning spheres have. */
bool scene_has_rolling(const struct scene *s);
bool scene_has_lever(const struct scene *s);

/* Appends a plane, before all cylinders; the normal is scaled to unit length.
   Returns GSL_EINVAL if it has none or a number is not finite, GSL_ENOMEM. */
int scene_add_wall(struct scene *s, const double point[3],
                   const double normal[3]);

/* Appends the inside of a cylinder about the line through point along axis. As
   above; GSL_EINVAL also for a radius that is not positive and finite. */
int scene_add_cylinder(struct scene *s, const double point[3],
                       const double axis[3], double radius);

/* Appends the floor z = 0 and four side walls of [0,a] x [0,b]; no lid. */
int scene_add_box(struct scene *s, double a, double b);

/* Distance of x from a plane, positive inside (m). */
static inline double plane_distance(const struct wall *w, const double x[3]) {
  double d[3];
  vec3_sub(w->point, x, d);
  return vec3_dot(d, w->normal);
}

/* The same of a cylinder, and its outward normal nearest to x: zero on the
   axis. */
static inline double cylinder_distance(const struct wall *w, const double x[3],
                                       double normal[3]) {
  vec3_sub(x, w->point, normal);
  vec3_axpy(-vec3_dot(normal, w->normal), w->normal, normal);
  const double away = vec3_norm(normal), inverse = away > 0 ? 1 / away : 0;
  for (int k = 0; k < 3; k++)
    normal[k] *= inverse;
  return w->radius - away;
}

/* The same of any wall. */
static inline double wall_nearest(const struct wall *w, const double x[3],
                                  double normal[3]) {
  if (w->radius > 0)
    return cylinder_distance(w, x, normal);
  for (int k = 0; k < 3; k++)
    normal[k] = w->normal[k];
  return plane_distance(w, x);
}

static inline double wall_distance(const struct wall *w, const double x[3]) {
  double normal[3];
  return w->radius > 0 ? cylinder_distance(w, x, normal) : plane_distance(w, x);
}

/* NULL if the parameters can be computed with, else what is wrong, a static
   string. */
const char *scene_check(const struct scene *s);

void scene_free(struct scene *s);

/* All of it (platform/store.h): what is added to struct scene is added there.
   Taken out into a scene without walls. */
void scene_store(struct scene *scene, struct store *s);

#endif
