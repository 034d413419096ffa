/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact's force depends on u = x_i - x_j, the relative velocity w and the
   sum of radius times spin s. Derivatives follow from the chain rule over the
   normal n = u/d, the gap rate n.w and the slip velocity t; P is the projector
   onto the tangent plane. A plane has a fixed normal: dn/du = 0. A cylinder's
   turns with u around its axis a: dn/du = -(P - a a)/(distance from it). With
   the arms of the contact point the sum and the torque depend on the gap as
   well, by l/2. Rolling resistance adds a torque of u and of the difference of
   spins. */
#include "dynamics/jacobian.h"

#include <string.h>

/* Not const where it is read alone: C11 turns none of these into one of const.
 */
typedef double matrix[3][3];

struct derivatives {
  matrix force_u, force_w, force_s;
  matrix torque_u, torque_w, torque_s; /* of n x friction force */
  double torque[3], n[3], gap;         /* that, for its arm */
  matrix roll_u, roll_spin;            /* of the torque of rolling resistance */
};

/* How the two of a contact turn; a wall has no radius and does not. */
struct turning {
  double reduced;                        /* m */
  double arms[3], sum[3], difference[3]; /* arms by spins (m/s); of spins */
};

static struct turning turn_of(const struct contact_list *list, double gap,
                              double ri, const double *wi, double rj,
                              const double *wj) {
  struct turning q = {.reduced = wj ? contact_reduced(ri, rj) : ri};
  vec3_axpy(contact_arm(&list->law, ri, gap), wi, q.arms);
  vec3_axpy(1, wi, q.sum);
  vec3_axpy(1, wi, q.difference);
  if (wj) {
    vec3_axpy(contact_arm(&list->law, rj, gap), wj, q.arms);
    vec3_axpy(1, wj, q.sum);
    vec3_axpy(-1, wj, q.difference);
  }
  return q;
}

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

/* m += a * (b x) y^T */
static void add_product_outer(matrix m, double a, matrix b, const double x[3],
                              const double y[3]) {
  double bx[3];
  for (int i = 0; i < 3; i++)
    bx[i] = vec3_dot(b[i], x);
  add_outer(m, a, bx, y);
}

static void add_matrix(double a, matrix x, matrix y) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      y[i][j] += a * x[i][j];
}

/* Friction and rolling resistance are a factor k = Sigma/v of a velocity v; m
   += a d(k v)/dv. Returns k. */
static double add_slip(const struct contact_law *c, const double v[3], double a,
                       matrix m) {
  const double speed = vec3_norm(v), vmin = c->vmin;
  const double slip = contact_slip(c, speed);
  double unit[3] = {0};
  if (speed > 0)
    for (int i = 0; i < 3; i++)
      unit[i] = v[i] / speed;
  const double slope =
      speed < vmin ? 3 / (vmin * vmin) - 4 * speed / (vmin * vmin * vmin)
                   : -1 / (speed * speed);
  for (int i = 0; i < 3; i++)
    m[i][i] += a * slip;
  add_outer(m, a * slope * speed, unit, unit);
  return slip;
}

/* The torque of contact_roll by u and by the difference of spins. p: P;
   turn: as in differentiate. */
static void add_rolling(const struct contact_law *c, const double n[3],
                        double f, double curvature, matrix turn, matrix p,
                        const struct turning *q, struct derivatives *d) {
  const double along = vec3_dot(q->difference, n);
  double v[3], tangent[3];
  for (int i = 0; i < 3; i++) {
    tangent[i] = q->difference[i] - along * n[i];
    v[i] = q->reduced * tangent[i];
  }
  matrix by_v = {{0}}, v_u = {{0}};
  const double slip = add_slip(c, v, -c->rolling * f * q->reduced, by_v);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        d->roll_spin[i][j] += q->reduced * by_v[i][k] * p[k][j];
  double turned[3] = {0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      turned[i] += turn[i][j] * tangent[j];
  add_outer(v_u, -q->reduced * curvature, n, turned);
  add_matrix(-q->reduced * curvature * along, turn, v_u);
  add_product(by_v, v_u, d->roll_u);
  add_outer(d->roll_u, c->kappa * c->rolling * f * q->reduced * slip, v, n);
}

/* curvature: 1/d for two spheres, 0 for a plane, so that dn/du = curvature P;
   axis: that of a cylinder along which the normal does not turn either, or
   NULL. */
static void differentiate(const struct contact_law *c,
                          const struct contact_features has, const double n[3],
                          double gap, double curvature, const double *axis,
                          const double w[3], const struct turning *q,
                          struct derivatives *d) {
  const double *s = q->arms;
  memset(d, 0, sizeof *d);
  d->gap = gap;
  memcpy(d->n, n, sizeof d->n);
  if (gap > c->lmax)
    return;
  const double f = contact_repulsion(c, gap);
  double t[3];
  const double rate = contact_tangent(n, w, s, t);
  matrix p = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  add_outer(p, -1, n, n);
  matrix turn; /* dn/du is curvature times this */
  memcpy(turn, p, sizeof turn);
  if (axis)
    add_outer(turn, -1, axis, axis);
  double rate_u[3]; /* gradient of n.w by u; by w it is n */
  for (int i = 0; i < 3; i++)
    rate_u[i] = curvature * (w[i] - rate * n[i]);
  if (axis)
    vec3_axpy(-curvature * vec3_dot(w, axis), axis, rate_u);

  const double rho = has.elastic ? 1 : contact_rebound(c, -rate);
  const double rho_rate = has.elastic ? 0 : -contact_rebound_slope(c, -rate);
  add_outer(d->force_u, -c->kappa * f * rho, n, n);
  add_outer(d->force_u, f * rho_rate, n, rate_u);
  add_matrix(f * rho * curvature, turn, d->force_u);
  add_outer(d->force_w, f * rho_rate, n, n);
  if (!has.friction)
    return;

  /* the friction force is -phi F S(|t|) t with S = Sigma/v */
  matrix force_t = {{0}};
  const double slip = add_slip(c, t, -c->friction * f, force_t);

  matrix t_u = {{0}}, t_s = {{0}}, cross_s = {{0}};
  add_outer(t_u, -1, n, rate_u);
  add_matrix(-rate * curvature, turn, t_u);
  add_cross(cross_s, -curvature, s);
  add_product(cross_s, turn, t_u);
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
  add_product(cross_f, turn, d->torque_u);
  add_product(cross_n, fr_w, d->torque_w);
  add_product(cross_n, fr_s, d->torque_s);
  vec3_cross(n, friction, d->torque);
  if (has.lever) {
    add_product_outer(d->force_u, 0.5, d->force_s, q->sum, n);
    add_product_outer(d->torque_u, 0.5, d->torque_s, q->sum, n);
  }
  if (has.rolling)
    add_rolling(c, n, f, curvature, turn, p, q, d);
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
  const double ri = list->radius[i], b = -2.5 / (list->mass[i] * ri);
  const double r = contact_arm(&list->law, list->radius[j], d->gap);
  add_block(m, i, ROW_V, j, ROW_W, a * r, d->force_s);
  const double arm = contact_arm(&list->law, ri, d->gap) / ri;
  add_block(m, i, ROW_W, j, ROW_X, arm * b * sign, d->torque_u);
  add_block(m, i, ROW_W, j, ROW_V, arm * b * sign, d->torque_w);
  add_block(m, i, ROW_W, j, ROW_W, arm * b * r, d->torque_s);
  if (list->has.lever) {
    matrix by_arm = {{0}};
    add_outer(by_arm, 0.5 / ri, d->torque, d->n);
    add_block(m, i, ROW_W, j, ROW_X, b * sign, by_arm);
  }
  if (list->has.rolling) {
    const double couple = -b / ri * force_sign * sign;
    add_block(m, i, ROW_W, j, ROW_X, couple, d->roll_u);
    add_block(m, i, ROW_W, j, ROW_W, couple, d->roll_spin);
  }
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
    struct turning turning = {0};
    double u[3], w[3];
    vec3_sub(p, q, u);
    periodic_nearest(list->period, u);
    vec3_sub(p + ROW_V, q + ROW_V, w);
    const double distance = vec3_norm(u);
    if (list->has.rotation)
      turning = turn_of(list, distance - ri - rj, ri, p + ROW_W, rj, q + ROW_W);
    const double normal[3] = {u[0] / distance, u[1] / distance,
                              u[2] / distance};
    differentiate(&list->law, list->has, normal, distance - ri - rj,
                  1 / distance, NULL, w, &turning, &d);
    add_body(list, &m, i, i, 1, 1, &d);
    add_body(list, &m, i, j, 1, -1, &d);
    add_body(list, &m, j, i, -1, 1, &d);
    add_body(list, &m, j, j, -1, -1, &d);
  }
  for (size_t c = 0; c < list->wall_contacts; c++) {
    const size_t i = list->wall_row[c];
    const struct wall *wall = &list->walls[list->wall_id[c]];
    const double *p = y + i * stride;
    double normal[3];
    const double ri = list->radius[i];
    const double gap = wall_nearest(wall, p, normal) - ri;
    const bool round = wall->radius > 0;
    struct turning turning = {0};
    for (int a = 0; a < 3; a++)
      normal[a] = -normal[a];
    if (list->has.rotation)
      turning = turn_of(list, gap, ri, p + ROW_W, 0, NULL);
    differentiate(&list->law, list->has, normal, gap,
                  round ? 1 / (gap + ri - wall->radius) : 0,
                  round ? wall->normal : NULL, p + ROW_V, &turning, &d);
    add_body(list, &m, i, i, 1, 1, &d);
  }
}
