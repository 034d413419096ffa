/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact's force depends on u = x_i - x_j, the relative velocity w and the
   sum of radius times spin s. Derivatives follow from the chain rule over the
   normal n = u/d, the gap rate n.w and the slip velocity t; P is the projector
   onto the tangent plane. A wall has a fixed normal: dn/du = 0. */
#include "dynamics/jacobian.h"

#include <string.h>

/* Not const where it is read alone: C11 turns none of these into one of const.
 */
typedef double matrix[3][3];

struct derivatives {
  matrix force_u, force_w, force_s;
  matrix torque_u, torque_w, torque_s; /* of n x friction force */
};

/* m += a * x y^T */
static void add_outer(matrix m, double a, const double x[3],
                      const double y[3]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      m[i][j] += a * x[i] * y[j];
}

/* m += a * (x cross) */
static void add_cross(matrix m, double a, const double x[3]) {
  m[0][1] -= a * x[2];
  m[0][2] += a * x[1];
  m[1][0] += a * x[2];
  m[1][2] -= a * x[0];
  m[2][0] -= a * x[1];
  m[2][1] += a * x[0];
}

static void add_product(matrix a, matrix b, matrix c) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        c[i][j] += a[i][k] * b[k][j];
}

static void add_matrix(double a, matrix x, matrix y) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      y[i][j] += a * x[i][j];
}

/* curvature: 1/d for two spheres, 0 for a wall, so that dn/du = curvature P. */
static void differentiate(const struct contact_law *c,
                          const struct contact_features has, const double n[3],
                          double gap, double curvature, const double w[3],
                          const double s[3], struct derivatives *d) {
  memset(d, 0, sizeof *d);
  if (gap > c->lmax)
    return;
  const double f = contact_repulsion(c, gap);
  double t[3];
  const double rate = contact_tangent(n, w, s, t);
  matrix p = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  add_outer(p, -1, n, n);
  double rate_u[3]; /* gradient of n.w by u; by w it is n */
  for (int i = 0; i < 3; i++)
    rate_u[i] = curvature * (w[i] - rate * n[i]);

  const double rho = has.elastic ? 1 : contact_rebound(c, -rate);
  const double rho_rate = has.elastic ? 0 : -contact_rebound_slope(c, -rate);
  add_outer(d->force_u, -c->kappa * f * rho, n, n);
  add_outer(d->force_u, f * rho_rate, n, rate_u);
  add_matrix(f * rho * curvature, p, d->force_u);
  add_outer(d->force_w, f * rho_rate, n, n);
  if (!has.friction)
    return;

  /* the friction force is -phi F S(|t|) t with S = Sigma/v */
  const double v = vec3_norm(t), vmin = c->vmin;
  const double slip = contact_slip(c, v);
  double unit[3] = {0};
  if (v > 0)
    for (int i = 0; i < 3; i++)
      unit[i] = t[i] / v;
  const double slip_v = v < vmin
                            ? 3 / (vmin * vmin) - 4 * v / (vmin * vmin * vmin)
                            : -1 / (v * v);
  matrix force_t = {{0}};
  for (int i = 0; i < 3; i++)
    force_t[i][i] = -c->friction * f * slip;
  add_outer(force_t, -c->friction * f * slip_v * v, unit, unit);

  matrix t_u = {{0}}, t_s = {{0}}, cross_s = {{0}};
  add_outer(t_u, -1, n, rate_u);
  add_matrix(-rate * curvature, p, t_u);
  add_cross(cross_s, -curvature, s);
  add_product(cross_s, p, t_u);
  add_cross(t_s, 1, n);

  matrix fr_u = {{0}}, fr_w = {{0}}, fr_s = {{0}};
  add_product(force_t, t_u, fr_u);
  add_outer(fr_u, c->kappa * c->friction * f * slip, t, n);
  add_product(force_t, p, fr_w);
  add_matrix(1, fr_u, d->force_u);
  add_matrix(1, fr_w, d->force_w);
  if (!has.rotation)
    return;
  add_product(force_t, t_s, fr_s);
  add_matrix(1, fr_s, d->force_s);

  matrix cross_n = {{0}}, cross_f = {{0}};
  double friction[3];
  contact_friction(c, gap, t, friction);
  add_cross(cross_n, 1, n);
  add_cross(cross_f, -curvature, friction);
  add_product(cross_n, fr_u, d->torque_u);
  add_product(cross_f, p, d->torque_u);
  add_product(cross_n, fr_w, d->torque_w);
  add_product(cross_n, fr_s, d->torque_s);
}

struct dense {
  double *at;
  size_t dimension, stride;
};

/* at rows (i, a..a+2) and columns (j, b..b+2) */
static void add_block(const struct dense *m, size_t i, size_t a, size_t j,
                      size_t b, double scale, matrix x) {
  for (size_t r = 0; r < 3; r++)
    for (size_t c = 0; c < 3; c++)
      m->at[(i * m->stride + a + r) * m->dimension + j * m->stride + b + c] +=
          scale * x[r][c];
}

/* Rates of body i by the unknowns of body j. sign: that of u's and w's
   derivative by them; the torque has the sign of the force's body taken out
   already, since it is the same for both. */
static void add_body(const struct contact_list *list, const struct dense *m,
                     size_t i, size_t j, double force_sign, double sign,
                     struct derivatives *d) {
  if (i >= list->moving)
    return;
  const double a = force_sign / list->mass[i];
  add_block(m, i, ROW_V, j, ROW_X, a * sign, d->force_u);
  add_block(m, i, ROW_V, j, ROW_V, a * sign, d->force_w);
  if (!list->has.rotation)
    return;
  const double r = list->radius[j],
               b = -2.5 / (list->mass[i] * list->radius[i]);
  add_block(m, i, ROW_V, j, ROW_W, a * r, d->force_s);
  add_block(m, i, ROW_W, j, ROW_X, b * sign, d->torque_u);
  add_block(m, i, ROW_W, j, ROW_V, b * sign, d->torque_w);
  add_block(m, i, ROW_W, j, ROW_W, b * r, d->torque_s);
}

void jacobian_dense(const struct contact_list *list, const double *y,
                    double *dfdy) {
  const size_t n = list->rows, stride = list->stride;
  const struct dense m = {dfdy, n * stride, stride};
  memset(dfdy, 0, m.dimension * m.dimension * sizeof *dfdy);
  for (size_t i = 0; i < list->moving; i++)
    for (size_t c = 0; c < 3; c++)
      dfdy[(i * stride + c) * m.dimension + i * stride + ROW_V + c] = 1;

  struct derivatives d;
  for (size_t c = 0; c < list->near.count; c++) {
    const size_t i = list->near.i[c], j = list->near.j[c];
    const double *p = y + i * stride, *q = y + j * stride;
    const double ri = list->radius[i], rj = list->radius[j];
    double u[3], w[3], s[3] = {0};
    vec3_sub(p, q, u);
    vec3_sub(p + ROW_V, q + ROW_V, w);
    if (list->has.rotation) {
      vec3_axpy(ri, p + ROW_W, s);
      vec3_axpy(rj, q + ROW_W, s);
    }
    const double distance = vec3_norm(u);
    const double normal[3] = {u[0] / distance, u[1] / distance,
                              u[2] / distance};
    differentiate(&list->law, list->has, normal, distance - ri - rj,
                  1 / distance, w, s, &d);
    add_body(list, &m, i, i, 1, 1, &d);
    add_body(list, &m, i, j, 1, -1, &d);
    add_body(list, &m, j, i, -1, 1, &d);
    add_body(list, &m, j, j, -1, -1, &d);
  }
  for (size_t c = 0; c < list->wall_contacts; c++) {
    const size_t i = list->wall_row[c];
    const struct wall *wall = &list->walls[list->wall_id[c]];
    const double *p = y + i * stride;
    double s[3] = {0}, normal[3];
    for (int a = 0; a < 3; a++)
      normal[a] = -wall->normal[a];
    if (list->has.rotation)
      vec3_axpy(list->radius[i], p + ROW_W, s);
    differentiate(&list->law, list->has, normal,
                  wall_distance(wall, p) - list->radius[i], 0, p + ROW_V, s,
                  &d);
    add_body(list, &m, i, i, 1, 1, &d);
  }
}
