/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What columns are, by names that programs of many kinds give them; and what
   may be two things, is refused with both names. */
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include "check.h"
#include "files/columns.h"

enum { MOST = 16 };

/* Splits "a|b|c". */
static size_t split(const char *line, struct text name[MOST]) {
  size_t count = 0;
  for (const char *at = line; at; count++) {
    const char *bar = strchr(at, '|');
    name[count] = (struct text){at, bar ? (size_t)(bar - at) : strlen(at)};
    at = bar ? bar + 1 : NULL;
  }
  return count;
}

/* The meanings in one line, "id x - vy"; - for what is none of ours, and behind
   a column its unit where that is not 1. */
static void describe(const struct columns *c, char *text, size_t size) {
  size_t used = 0;
  text[0] = 0;
  for (size_t k = 0; k < c->count && used < size; k++) {
    const char *name =
        c->at[k] == COLUMN_OTHER ? "-" : column_name((enum column)c->at[k]);
    used += (size_t)snprintf(text + used, size - used, k ? " %s" : "%s", name);
    if (c->unit[k] != 1 && used < size)
      used += (size_t)snprintf(text + used, size - used, "*%g", c->unit[k]);
  }
}

static const struct {
  const char *names, *are;
} known[] = {
    /* plain, any case */
    {"id|x|y|z|r|m|vx|vy|vz|wx|wy|wz", "id x y z r m vx vy vz wx wy wz"},
    {"ID|X|Y|Z|Radius|MASS", "id x y z r m"},
    {"x|y|z|d|t", "x y z d t"},
    {" x | y |z |diameter|Time", "x y z d t"},
    /* where and how fast, in other words */
    {"Points:0|Points:1|Points:2|radius", "x y z r"},
    {"Points_0|Points_1|Points_2|Radius", "x y z r"},
    {"Points_X|Points_Y|Points_Z|Points_Magnitude|Diameter", "x y z - d"},
    {"pos[0]|pos[1]|pos[2]|vel[0]|vel[1]|vel[2]", "x y z vx vy vz"},
    {"pos1|pos2|pos3|vel1|vel2|vel3|pos", "x y z vx vy vz -"},
    {"Position.X|Position.Y|Position.Z|Radius", "x y z r"},
    {"Position[X] (m)|Position[Y] (m)|Position[Z] (m)", "x y z"},
    {"posX|posY|posZ|velX|velY|velZ|omegaX|omegaY|omegaZ",
     "x y z vx vy vz wx wy wz"},
    {"posx|posy|posz|velx|vely|velz", "x y z vx vy vz"},
    {"POSX|POSY|POSZ|RADIUS", "x y z r"},
    {"XPos|YPos|ZPos", "x y z"},
    {"xpos|ypos|zpos", "x y z"},
    {"x_pos|y_pos|z_pos|v_x|v_y|v_z|w_x|w_y|w_z", "x y z vx vy vz wx wy wz"},
    {"center_x|center_y|center_z", "x y z"},
    {"centre x|centre y|centre z", "x y z"},
    {"cx|cy|cz|r", "x y z r"},
    {"xc|yc|zc|r", "x y z r"},
    {"coord_x|coord_y|coord_z", "x y z"},
    {"X Coordinate|Y Coordinate|Z Coordinate", "x y z"},
    {"x-coordinate|y-coordinate|z-coordinate", "x y z"},
    {"Coordinates:0|Coordinates:1|Coordinates:2", "x y z"},
    {"Center of Mass X|Center of Mass Y|Center of Mass Z", "x y z"},
    {"centerOfMassX|centerOfMassY|centerOfMassZ", "x y z"},
    {"com_x|com_y|com_z", "x y z"},
    {"Centroid.X|Centroid.Y|Centroid.Z", "x y z"},
    {"location x|location y|location z", "x y z"},
    {"Particle Position X|Particle Position Y|Particle Position Z|"
     "Particle Radius|Particle ID|Particle Mass",
     "x y z r id m"},
    {"sphere_x|sphere_y|sphere_z|sphere_diameter", "x y z d"},
    {"x|y|z|linear velocity x|linear velocity y|linear velocity z",
     "x y z vx vy vz"},
    {"x|y|z|Velocity:0|Velocity:1|Velocity:2", "x y z vx vy vz"},
    {"x|y|z|angular velocity x|angular velocity y|angular velocity z",
     "x y z wx wy wz"},
    {"x|y|z|AngularVelocity.X|rot_vel_y|omega_z", "x y z wx wy wz"},
    /* units */
    {"x [m]|y [m]|z [m]|r [m]", "x y z r"},
    {"X (m)|Y (m)|Z (m)|Radius (m)|Time (s)", "x y z r t"},
    {"x_m|y_m|z_m|radius_m|mass_kg|time_s", "x y z r m t"},
    {"x / m|y / m|z / m|d / mm", "x y z d*0.001"},
    {"x, m|y, m|z, m|size, mm", "x y z -"},
    {"x [mm]|y [mm]|z [mm]|d [\xC2\xB5m]|m [g]|t [ms]",
     "x*0.001 y*0.001 z*0.001 d*1e-06 m*0.001 t*0.001"},
    {"x(cm)|y(cm)|z(cm)|vx(cm/s)|vy(cm/s)|vz(cm/s)|wx (rad/s)",
     "x*0.01 y*0.01 z*0.01 vx*0.01 vy*0.01 vz*0.01 wx"},
    {"x_mm|y_mm|z_mm|diameter_mm", "x*0.001 y*0.001 z*0.001 d*0.001"},
    {"x [-]|y (-)|z ()|r", "x y z r"},
    {"Center X (mm)|Center Y (mm)|Center Z (mm)", "x*0.001 y*0.001 z*0.001"},
    /* what only looks like it */
    {"x|y|z|radius|T", "x y z r -"},
    {"x|y|z|radius|t|T", "x y z r t -"},
    {"X|Y|Z|R|T|Time", "x y z r - t"},
    {"x|y|z|radius|T [K]|T_s|T_min", "x y z r - - -"},
    {"x|y|z|radius|T (s)", "x y z r t"},
    {"x|y|z|radius|temperature|temp", "x y z r - -"},
    {"x|y|z|R|G|B|radius", "x y z - - - r"},
    {"x|y|z|r|g|b|diameter", "x y z - - - d"},
    {"x|y|z|r|theta|diameter", "x y z - - d"},
    {"x|y|z|r (m)|theta (deg)|radius", "x y z - - r"},
    {"x|y|z|r (deg)|radius|d (kg/m3)|t (C)|m [mol]", "x y z - r - - -"},
    {"x|y|z|mean radius|radius of gyration|r_g|radius", "x y z - - - r"},
    {"x|y|z|r|x0|y0|z0|dx|fx|ux|xs|ix|nx", "x y z r - - - - - - - - -"},
    {"x|y|z|r|angular momentum x|force x|mass x", "x y z r - - -"},
    {"x|y|z|c1|v0|vel:3|vel:0", "x y z - - - -"},
    {"x|y|z|step", "x y z t"},
    {"x|y|z|Frame|Time", "x y z - t"},
    {"|x|y|z|", "- x y z -"}};

static void test_known(void) {
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
    struct text name[MOST];
    struct columns c;
    char text[200] = "";
    const size_t count = split(known[k].names, name);
    const int status = columns_of_names(&c, count, name);
    if (status == GSL_SUCCESS)
      describe(&c, text, sizeof text);
    if (!CHECK(status == GSL_SUCCESS && !strcmp(text, known[k].are) &&
               columns_place(&c) && columns_named_place(count, name)))
      fprintf(stderr, "  %s: '%s' %s\n", known[k].names, text, c.wrong);
  }
}

/* Both names, and what they may be. */
static void test_ambiguous(void) {
  static const char *const cases[][3] = {
      {"x|y|z|r|radius", "'r'", "'radius'"},
      {"x|y|z|r|X", "'x'", "'X'"},
      {"x|y|z|r|Points:0|Points:1|Points:2", "'x'", "'Points:0'"},
      {"x|y|z|d|Diameter (mm)", "'d'", "'Diameter (mm)'"},
      {"x|y|z|r|m|mass", "'m'", "'mass'"},
      {"x|y|z|r|t|time", "'t'", "'time'"},
      {"x|y|z|r|vx|Velocity:0|Velocity:1|Velocity:2", "'vx'", "'Velocity:0'"},
      {"id|ID|x|y|z|r", "'id'", "'ID'"},
      {"x|y|z|r|theta", "'r'", "'theta'"},
      {"x|y|z|R|phi (rad)", "'R'", "'phi (rad)'"},
      {"X|Y|Z|R|T", "'T'", "temperature"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct text name[MOST];
    struct columns c;
    const size_t count = split(cases[k][0], name);
    if (!CHECK(columns_of_names(&c, count, name) == GSL_EINVAL &&
               strstr(c.wrong, cases[k][1]) && strstr(c.wrong, cases[k][2]) &&
               strstr(c.wrong, "expected") && columns_named_place(count, name)))
      fprintf(stderr, "  %s: '%s'\n", cases[k][0], c.wrong);
  }
}

static void test_list(void) {
  struct columns c;
  char text[100];
  static const char *const good[][2] = {
      {"x,y,z", "x y z"},
      {"-,x,y,z,r", "- x y z r"},
      {"id, x, y, z, d, -, t", "id x y z d - t"},
      {"radius,z,y,x,-,-,mass", "r z y x - - m"}};
  for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
    CHECK(columns_of_list(&c, good[k][0]) == GSL_SUCCESS);
    describe(&c, text, sizeof text);
    if (!CHECK(!strcmp(text, good[k][1])))
      fprintf(stderr, "  %s: %s\n", good[k][0], text);
  }
  static const char *const bad[] = {
      "",       "x,y",   "x,y,z,q",        "x,y,z,x",
      "x,y,z,", "x y z", "x,y,z,T",        "x,,y,z",
      "r,d,id", "x;y;z", "x,y,z,r,radius", "x [mm],y [mm],z [mm],r"};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
    if (!CHECK(columns_of_list(&c, bad[k]) == GSL_EINVAL && *c.wrong))
      fprintf(stderr, "  %s\n", bad[k]);
}

static void test_units(void) {
  static const struct {
    const char *names, *row, *are; /* NULL: no row of units */
  } rows[] = {
      {"x|y|z|r", "m|m|m|m", "x y z r"},
      {"x|y|z|r", "[mm]|[mm]|[mm]|[um]", "x*0.001 y*0.001 z*0.001 r*1e-06"},
      {"id|x|y|z|r|name", "-|(cm)|(cm)|(cm)|(cm)|text",
       "id x*0.01 y*0.01 z*0.01 r*0.01 -"},
      {"id|x|y|z|t|vx", "|m|m|m|ms|mm/s", "id x y z t*0.001 vx*0.001"},
      {"x|y|z|r", "1|1|1|1", NULL}, /* numbers */
      {"x|y|z|r", "-|-|-|-", NULL}, /* nothing */
      {"x|y|z|r", "m|m|m|kg", NULL},
      {"x|y|z|r", "m|m|m|float", NULL},
      {"x|y|z|r", "0.1|m|m|m", NULL}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct text name[MOST], row[MOST];
    struct columns c;
    char text[200];
    CHECK(columns_of_names(&c, split(rows[k].names, name), name) ==
          GSL_SUCCESS);
    const bool taken = columns_of_units(&c, split(rows[k].row, row), row);
    describe(&c, text, sizeof text);
    if (!CHECK(taken == (rows[k].are != NULL)) ||
        (taken && !CHECK(!strcmp(text, rows[k].are))))
      fprintf(stderr, "  %s: %s\n", rows[k].row, text);
  }
}

/* One unit of millimetres and none beside it: a factor of 1000, either way. */
static void test_units_missing(void) {
  static const struct {
    const char *names, *row, *wrong[2]; /* NULL: none */
  } tables[] = {{"x [mm]|y [mm]|z [mm]|r", NULL, {"'x [mm]'", "'r'"}},
                {"x_cm|y_cm|z_cm|radius", NULL, {"'x_cm'", "'radius'"}},
                {"x|y|z|d (um)", NULL, {"'d (um)'", "'x'"}},
                {"x|y|z|r", "mm|mm|mm|-", {"'x'", "'r'"}},
                {"x|y|z|r|vx (mm/s)|vy|vz", NULL, {"'vx (mm/s)'", "'vy'"}},
                {"x [mm]|y [mm]|z [mm]|r [mm]", NULL, {NULL}},
                {"x [m]|y [m]|z [m]|r", NULL, {NULL}},
                {"x|y|z|r [m]", NULL, {NULL}},
                {"x [m]|y [m]|z [m]|r [mm]|vx", NULL, {NULL}},
                {"x [mm]|y [mm]|z [mm]|r", "-|-|-|mm", {NULL}},
                {"x [mm]|y [mm]|z [mm]", NULL, {NULL}},
                {"x|y|z|r|t [ms]|h [mm]", NULL, {NULL}}};
  for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
    struct text name[MOST], row[MOST];
    struct columns c;
    CHECK(columns_of_names(&c, split(tables[k].names, name), name) ==
          GSL_SUCCESS);
    if (tables[k].row)
      CHECK(columns_of_units(&c, split(tables[k].row, row), row));
    const int status = columns_check_units(&c);
    const char *const *wrong = tables[k].wrong;
    if (!CHECK(wrong[0] ? status == GSL_EINVAL && strstr(c.wrong, wrong[0]) &&
                              strstr(c.wrong, wrong[1])
                        : status == GSL_SUCCESS))
      fprintf(stderr, "  %s: '%s'\n", tables[k].names, c.wrong);
  }
}

/* Names without end, and of any bytes, do no harm. */
static void test_any_bytes(void) {
  char bytes[300];
  struct text name[MOST_FIELDS];
  struct columns c;
  for (size_t seed = 0; seed < 300; seed++) {
    for (size_t k = 0; k < sizeof bytes; k++)
      bytes[k] = (char)(seed < 256 ? (size_t)seed : (k * 7919 + seed * seed));
    for (size_t k = 0; k < MOST_FIELDS; k++)
      name[k] = (struct text){bytes + k, (k * seed) % (sizeof bytes - k)};
    const int status = columns_of_names(&c, MOST_FIELDS, name);
    CHECK(status == GSL_SUCCESS || (status == GSL_EINVAL && *c.wrong));
  }
}

int main(void) {
  test_known();
  test_ambiguous();
  test_list();
  test_units();
  test_units_missing();
  test_any_bytes();
  return check_done();
}
