/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formats of others: tables, LAMMPS dumps, XYZ. The same spheres in every
   format are the same frames, bit for bit; what is not a whole, well-formed
   file is refused with the line where it goes wrong; and the small files of
   tests/corpus do no harm to any reader. Run from the repository's root. */
#include "fuzz_readers.c" /* the checks that fuzzing makes */

#include <dirent.h>
#include "model/bed.h"
#include "check.h"

struct frames_read {
  int status; /* GSL_EOF: all was read */
  size_t count;
  struct bed bed[4];
  char error[512];
};

#define BED "# format=bed-1\n"

static const struct bed_reader_options plain = {.largest = 1e100};

static struct frames_read read_text(const char *text, size_t size,
                                    const struct bed_reader_options *o) {
  struct frames_read f = {.status = GSL_SUCCESS};
  FILE *in = fmemopen((void *)text, size, "r");
  struct bed_reader *r;
  if (!in || bed_reader_open(&r, in, "file", o) != GSL_SUCCESS)
    abort();
  while (f.count < 4 && f.status == GSL_SUCCESS) {
    f.status = bed_reader_next(r, &f.bed[f.count]);
    f.count += f.status == GSL_SUCCESS;
  }
  snprintf(f.error, sizeof f.error, "%s", bed_reader_error(r));
  bed_reader_close(r);
  fclose(in);
  return f;
}

static void free_frames(struct frames_read *f) {
  for (size_t k = 0; k < f->count; k++)
    bed_free(&f->bed[k]);
}

/* --- the same spheres in every format --------------------------------------*/

/* Frame 0: two spheres at t = 0.5, frame 1: one at t = 1.5. */
static const struct {
  double t, row[12]; /* id x y z r m v w */
} spheres[] = {
    {0.5, {7, 0.5, 0.25, -1, 0.125, 2, 1, 2, 3, 4, 5, 6}},
    {0.5, {-4, 1.5, 0.1, 1. / 1024, 0.25, 3, -1, -2, 1e-30, 0, 0, 0}},
    {1.5, {7, 0.5, 0.25, -2, 0.125, 2, 1, 2, 3, 4, 5, 6}}};

enum { PLACE = 1, RADIUS = 2, REST = 4, ID_TOO = 8, TIME = 16, ALL = 31 };

static void check_spheres(const struct frames_read *f, int what,
                          const char *text) {
  bool good = CHECK(f->status == GSL_EOF) && CHECK(f->count == 2) &&
              CHECK(f->bed[0].n == 2) && CHECK(f->bed[1].n == 1);
  for (size_t k = 0; good && k < 3; k++) {
    const struct bed *b = &f->bed[k / 2];
    const size_t i = k % 2;
    const double *row = spheres[k].row;
    good &= CHECK(fuzz_same(b->x + 3 * i, row + 1, 3));
    if (what & TIME)
      good &= CHECK(b->t == spheres[k].t);
    if (what & ID_TOO)
      good &= CHECK(b->id[i] == (long)row[0]);
    if (what & RADIUS)
      good &= CHECK(b->r[i] == row[4]);
    if (what & REST)
      good &= CHECK(b->m[i] == row[5]) &&
              CHECK(fuzz_same(b->v + 3 * i, row + 6, 3)) &&
              CHECK(fuzz_same(b->w + 3 * i, row + 9, 3));
  }
  if (!good)
    fprintf(stderr, "  %s, from\n%s\n", f->error, text);
}

static void same_spheres(const char *text, int what) {
  static const struct bed_reader_options radius = {.radius = 0.125};
  const struct bed_reader_options *o = what & RADIUS ? &plain : &radius;
  struct frames_read f = read_text(text, strlen(text), o);
  check_spheres(&f, what, text);
  free_frames(&f);

  /* the line ends of others, and a byte order mark */
  char dos[4096] = "\xEF\xBB\xBF";
  size_t size = 3;
  for (const char *c = text; *c; c++) {
    if (*c == '\n' && size % 2) /* and trailing blanks here and there */
      dos[size++] = ' ';
    if (*c == '\n')
      dos[size++] = '\r';
    dos[size++] = *c;
  }
  f = read_text(dos, size, o);
  check_spheres(&f, what, dos);
  free_frames(&f);

  /* cut at every byte: refused, or less of it where a whole line more or
     less cannot be told; what is given is as it was */
  struct frames_read whole = read_text(text, strlen(text), o);
  for (size_t cut = 1; cut < strlen(text); cut++) {
    for (int partial = 0; partial < 2; partial++) {
      struct bed_reader_options as = *o;
      as.allow_partial = partial;
      f = read_text(text, cut, &as);
      bool good = f.status == GSL_EOF || f.status == GSL_EINVAL;
      good =
          good && (partial || f.status == GSL_EINVAL || text[cut - 1] == '\n');
      for (size_t k = 0; good && k < f.count; k++)
        good = f.bed[k].n <= whole.bed[k].n &&
               fuzz_same(f.bed[k].x, whole.bed[k].x, 3 * f.bed[k].n) &&
               fuzz_same(f.bed[k].r, whole.bed[k].r, f.bed[k].n);
      if (!CHECK(good))
        fprintf(stderr, "  cut at byte %zu of\n%s\n", cut, text);
      free_frames(&f);
    }
  }
  free_frames(&whole);
}

#define BOX "ITEM: BOX BOUNDS pp pp ff\n-1 3\n0 2\n-4 4e0\n"

static void test_same_spheres(void) {
  /* tables */
  same_spheres("t,id,x,y,z,r,m,vx,vy,vz,wx,wy,wz\n"
               "0.5,7,0.5,0.25,-1,0.125,2,1,2,3,4,5,6\n"
               "0.5,-4,1.5,0.1,0.0009765625,0.25,3,-1,-2,1e-30,0,0,0\n"
               "1.5,7,0.5,0.25,-2,0.125,2,1,2,3,4,5,6\n",
               ALL);
  same_spheres("Colour;Time;ID;X;Y;Z;Diameter;Mass;VX;VY;VZ;omegax;omegay;"
               "omegaz;\n"
               "red;0,5;7;0,5;2,5e-1;-1;0,25;2;1;2;3;4;5;6;\n"
               "\"a;b\";5D-1;-4;1,5;0,1;\"9.765625d-4\";0.5;3;-1;-2;1e-30;0;0;"
               "0\n"
               "nan;1.5;7;0.5;0.25;-2;0.25;2;1;2;3;4;5;6;\n",
               ALL);
  same_spheres("\"x\"\t\"y\"\t\"z\"\td\tname of it\n"
               "0.5\t0.25\t-1\t0.25\tone sphere\n"
               "1.5\t0.1\t0.0009765625\t0.5\t\n"
               "\n\n"
               "x\ty\tz\tradius\n"
               "0.5\t0.25\t-2\t0.125\n",
               PLACE | RADIUS);
  same_spheres("# made by hand\n"
               "# x   y  z\n"
               " 0.5 0.25 -1\n"
               "1.5 0.1 0.0009765625\n"
               "\n"
               "+.5 .25 -2.\n",
               PLACE);
  /* keys are a bed's alone */
  same_spheres("# radius=1\n# t = 5\n# t=0.5 s\nx,y,z\n0.5,0.25,-1\n"
               "1.5,0.1,0.0009765625\n,,\n# status=converged\n"
               "# format=csv 2\n0.5,0.25,-2\n# seed=3\n",
               PLACE);

  /* XYZ */
  same_spheres("2\nhere may stand anything, even = and \"\nA 0.5 0.25 -1 9 x\n"
               " B   1.5\t0.1 0.0009765625\n1\n\nA 0.5 0.25 -2\n\n\n",
               PLACE);
  same_spheres("2\n i =        0, time =        0.5, E = -1\n"
               "A 0.5 0.25 -1\nB 1.5 0.1 0.0009765625\n"
               "1\n i =        1, time =        1.5, E = -1\nA 0.5 0.25 -2\n",
               PLACE | TIME);
  same_spheres(
      "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:id:I:1:"
      "radius:R:1:mass:R:1:velo:R:3:angular_velocity:R:3 Time=0.5 pbc=\"T T "
      "F\"\nA 0.5 0.25 -1 7 0.125 2 1 2 3 4 5 6\n"
      "B 1.5 1d-1 0.0009765625 -4 0.25 3 -1 -2 1e-30 0 0 0\n"
      "1\nTime=1.5 Properties=id:I:1:pos:R:3:radius:R:1:selected:L:1:masses:R:"
      "1:forces:R:3:velocities:R:3:omega:R:3 'my time'=8\n"
      "7 0.5 0.25 -2 0.125 T 2 nan nan nan 1 2 3 4 5 6\n",
      ALL);
  same_spheres("2\nproperties=\"x:R:1:y:R:1:z:R:1:diameter:R:1\" t=0.5\n"
               "0.5 0.25 -1 0.25\n1.5 0.1 0.0009765625 0.5\n"
               "1\nt=1.5 note={a b t=7} Properties=pos:R:3:r:R:1\n"
               "0.5 0.25 -2 0.125\n",
               PLACE | RADIUS | TIME);

  /* LAMMPS */
  same_spheres("ITEM: UNITS\nsi\nITEM: TIME\n0.5\nITEM: TIMESTEP\n100\n"
               "ITEM: NUMBER OF ATOMS\n2\n" BOX
               "ITEM: ATOMS id type x y z radius mass vx vy vz omegax omegay "
               "omegaz c_1[1] \n"
               "7 1 0.5 0.25 -1 0.125 2 1 2 3 4 5 6 nan\n"
               "-4 1 1.5 0.1 0.0009765625 0.25 3 -1 -2 1e-30 0 0 0 x\n"
               "ITEM: TIMESTEP\n200\nITEM: TIME\n1.5\n"
               "ITEM: NUMBER OF ATOMS\n1\n" BOX
               "ITEM: ATOMS omegax omegay omegaz id diameter mass x y z xs ys "
               "zs vx vy vz\n"
               "4 5 6 7 0.25 2 0.5 0.25 -2 8 8 8 1 2 3\n",
               ALL);
  /* scaled: products and sums that a double holds exactly, but for 0.1 */
  same_spheres("ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n" BOX
               "ITEM: ATOMS xs ys zs radius\n"
               "0.375 0.125 0.375 0.125\n"
               "0.625 0.05 0.5001220703125 0.25\n"
               "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\n" BOX
               "ITEM: ATOMS xsu ysu zsu radius ix iy iz\n"
               "0.375 0.125 0.25 0.125 0 0 0\n",
               PLACE | RADIUS);
  same_spheres("ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n" BOX
               "ITEM: ATOMS xs ys zs xu yu zu\n"
               "9 9 9 0.5 0.25 -1\n9 9 9 1.5 0.1 0.0009765625\n"
               "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\n"
               "ITEM: ATOMS xu yu zu\n0.5 0.25 -2\n",
               PLACE);
}

/* A tilted box: its corners are where its edges lead, and the bounds in the
   file are those of the whole box. */
static void test_tilted(void) {
  const double lo[3] = {-1, 2, 3}, size[3] = {4, 2, 8};
  for (int c = 0; c < 8; c++) { /* signs of the tilts */
    const double xy = c & 1 ? 1.5 : -1.5, xz = c & 2 ? 0.5 : -0.5,
                 yz = c & 4 ? 0.25 : -0.25;
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9}, at[8][3];
    for (int k = 0; k < 8; k++) {
      const double s[3] = {k & 1, k >> 1 & 1, k >> 2 & 1};
      at[k][0] = lo[0] + s[0] * size[0] + s[1] * xy + s[2] * xz;
      at[k][1] = lo[1] + s[1] * size[1] + s[2] * yz;
      at[k][2] = lo[2] + s[2] * size[2];
      for (int d = 0; d < 3; d++) {
        low[d] = fmin(low[d], at[k][d]);
        high[d] = fmax(high[d], at[k][d]);
      }
    }
    char text[1000];
    snprintf(text, sizeof text,
             "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n8\nITEM: BOX BOUNDS xy "
             "xz yz pp pp pp\n%g %g %g\n%g %g %g\n%g %g %g\nITEM: ATOMS xs ys "
             "zs d\n0 0 0 1\n1 0 0 1\n0 1 0 1\n1 1 0 1\n0 0 1 1\n1 0 1 1\n0 1 "
             "1 1\n1 1 1 1\n",
             low[0], high[0], xy, low[1], high[1], xz, low[2], high[2], yz);
    struct frames_read f = read_text(text, strlen(text), &plain);
    if (CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].n == 8))
      for (int k = 0; k < 8; k++) /* all sums are exact */
        CHECK(fuzz_same(f.bed[0].x + 3 * k, at[k], 3));
    free_frames(&f);
  }
}

/* Without ids, times and masses there are some. */
static void test_defaults(void) {
  const char *text = "1\n\nA 1 2 3\n2\n\nA 1 2 3\nA 1 2 4\n";
  const struct bed_reader_options o = {.radius = 0.3};
  struct frames_read f = read_text(text, strlen(text), &o);
  if (CHECK(f.status == GSL_EOF && f.count == 2)) {
    CHECK(f.bed[0].t == 0 && f.bed[1].t == 1); /* the frame's number */
    CHECK(f.bed[1].id[1] == 1 && f.bed[1].m[1] == 1 && f.bed[1].r[1] == 0.3);
    CHECK(f.bed[1].v[3] == 0 && f.bed[1].w[5] == 0);
  }
  free_frames(&f);
  text = "ITEM: TIMESTEP\n700\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS x y z\n"
         "1 2 3\n";
  f = read_text(text, strlen(text), &o);
  CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].t == 700);
  free_frames(&f);
  /* a file's own radius counts */
  text = "x y z r\n1 2 3 4\n";
  f = read_text(text, strlen(text), &o);
  CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].r[0] == 4);
  free_frames(&f);
  text = BED "# radius=2\nx\ty\tz\n1\t2\t3\n# status=ok\n";
  f = read_text(text, strlen(text), &o);
  CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].r[0] == 2);
  free_frames(&f);
  /* the last of a header's times, and of its radii, which rows may have */
  text = BED "# t=4\n# radius=-1\n# t=5\nx\ty\tz\tr\n1\t2\t3\t4\n# status=ok\n";
  f = read_text(text, strlen(text), &o);
  CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].r[0] == 4 &&
        f.bed[0].t == 5);
  free_frames(&f);
  text = BED "# t = 5\nx\ty\tz\n1\t2\t3\n# status = ok \n";
  f = read_text(text, strlen(text), &o);
  CHECK(f.status == GSL_EOF && f.count == 1 && f.bed[0].r[0] == 0.3 &&
        f.bed[0].t == 5);
  free_frames(&f);
}

/* --- none ------------------------------------------------------------------*/

static void test_no_spheres(void) {
  static const char *const files[] = {
      "0\nA comment\n", "1\n\nA 1 2 3\n0\n\n1\n\nA 1 2 3\n",
      "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n0\nITEM: ATOMS x y z\n"};
  for (size_t k = 0; k < 3; k++) {
    struct bed_reader_options o = {.radius = 0.1};
    struct frames_read f = read_text(files[k], strlen(files[k]), &o);
    CHECK(f.status == GSL_EINVAL && strstr(f.error, "no spheres"));
    free_frames(&f);
    o.may_be_empty = true;
    f = read_text(files[k], strlen(files[k]), &o);
    CHECK(f.status == GSL_EOF && f.count == (k == 1 ? 3 : 1));
    CHECK(f.bed[k == 1].n == 0);
    free_frames(&f);
  }
}

/* --- what is refused, and where --------------------------------------------*/

#define STEP "ITEM: TIMESTEP\n0\n"                 /* lines 1, 2 */
#define COUNT(n) "ITEM: NUMBER OF ATOMS\n" #n "\n" /* lines 3, 4 */
#define ATOMS "ITEM: ATOMS id x y z radius\n"      /* line 5 */
#define ATOM "1 1 2 3 .1\n"
#define EXTENDED "Properties=species:S:1:pos:R:3:radius:R:1"

static const struct refused {
  const char *text;
  size_t line;
  const char *says;
} refusals[] = {
    /* tables */
    {"x,y\n1,2\n", 1, "expected a bed, a table"},
    {"hello\n", 1, "expected a bed, a table"},
    {"\037\213\b\b\n", 1, "gzip, expected 'zcat"},
    {"1,2,3\n", 1, "no radius"},
    {"x,y,z\n1,2,3\n", 1, "no radius"},
    {"x,y,z,r,X\n1,2,3,4,5\n", 1, "columns 'x' and 'X'"},
    {"x,y,z,r,radius\n1,2,3,4,5\n", 1, "columns 'r' and 'radius'"},
    {"x,y,z,r\n", 1, "no spheres"},
    {"x,y,z,r\n1,2,3,4\n\nx,y,z,r\n", 4, "no spheres"},
    {"x,y,z,r\n1,2,3\n", 2, "column r"},
    {"x,y,z,r\n1,2,3,\n", 2, "column r"},
    {"x,y,z,r,name\n1,2,3,4\n", 2, "expected 5"},
    {"x,y,z,r\n1,2,3,4,5\n", 2, "more than the 4"},
    {"x,y,z,r\n1,2,3,4\n1,2,3,4 5\n", 3, "'4 5'"},
    {"x,y,z,r\n1,,3,4\n", 2, "column y"},
    {"x,y,z,r\n1,nan,3,4\n", 2, "column y is 'nan'"},
    {"x,y,z,r\n1,2,-inf,4\n", 2, "column z is '-inf'"},
    {"x,y,z,r\n1e300,2,3,4\n", 2, "x is 1e+300"},
    {"x,y,z,r\n1,2,3,1e300\n", 2, "r is 1e+300"},
    {"x,y,z,r,vx\n1,2,3,4,-1e300\n", 2, "vx is -1e+300"},
    {"x,y,z,r\n1d999,2,3,4\n", 2, "1d999"},
    {"x,y,z,r\n1d,2,3,4\n", 2, "'1d'"},
    {"x,y,z,r\n1.5.2,2,3,4\n", 2, "1.5.2"},
    {"x;y;z;r\n1.000,5;2;3;4\n", 2, "1.000,5"},
    {"x y z r\n0,5 2 3 4\n", 2, "0,5"},
    {"x,y,z,r\n1,2,3,0\n", 2, "radius 0"},
    {"x,y,z,r\n1,2,3,-1\n", 2, "radius -1"},
    {"x,y,z,d\n1,2,3,-1\n", 2, "diameter -1"},
    {"x,y,z,r,m\n1,2,3,1,0\n", 2, "mass 0"},
    {"id,x,y,z,r\n.5,1,2,3,1\n", 2, "id 0.5"},
    {"id,x,y,z,r\n5,1,2,3,1\n6,1,2,3,1\n5,1,2,3,1\n", 4, "id 5 twice"},
    {"t,x,y,z,r\n1,1,2,3,1\n0,1,2,3,1\n2,1,2,3,1\n", 4, "sorted"},
    {"x,y,z,r\n1,2,3,4\n1,2,3,4", 3, "no end"},
    {"x,y,z,r\n1,2,\033[1m3,4\n", 2, "?[1m3"},
    /* beds */
    {"# format=bed-1\nx\ty\tz\tcolour\n1\t2\t3\t4\n# status=ok\n", 2, "colour"},
    {BED "# t=1\nx\ty\tz\n1\t2\t3\n", 4, "status=ok"},
    {BED "# radius=-1\nx\ty\tz\n1\t2\t3\n# status=ok\n", 4, "radius -1"},
    {BED "# radius=2m\nx\ty\tz\n1\t2\t3\n# status=ok\n", 2, "radius=2m"},
    {BED "# t=1\nx\ty\tz\n1\t2\t3\n\n\n# t=2\nx\ty\tz\n# status=ok\n", 9,
     "no spheres"},
    {BED "# t=1\nx\ty\tz\n1\t2\t3\n\n\n# t=2\n# status=ok\n", 8, "no spheres"},
    {BED
     "# t=1\nx\ty\tz\n1\t2\t3\n\n\n# t=2\n\n\n# t=3\n1\t2\t3\n# status=ok\n",
     10, "no spheres"},
    {BED "# t=1\nx\ty\tz\n1\t2\t3\n\n\n# t=2\nx\ty\tz\n\n\n# t=3\n1\t2\t3\n"
         "# status=ok\n",
     9, "no spheres"},
    {"", 0, "nothing"},
    /* XYZ */
    {"1\n", 1, "cut short"},
    {"1\n\nA 1 2 3\n", 3, "no radius"},
    {"2\n" EXTENDED "\nA 1 2 3 1\n", 3, "cut short"},
    {"2\n" EXTENDED "\nA 1 2 3 1\n1\n" EXTENDED "\nA 1 2 3 1\n", 4, "column x"},
    {"1\n" EXTENDED "\nA 1 2 3 1\nA 1 2 3 1\n", 4, "number of atoms"},
    {"1\n" EXTENDED "\nA 1 2 3 1\nhello\n", 4, "number of atoms"},
    {"1\n" EXTENDED "\nA 1 2 3 1 5\n", 3, "more than"},
    {"1\n" EXTENDED "\nA 1 2 nan 1\n", 3, "column z is 'nan'"},
    {"1\n" EXTENDED "\nA 1 2 3 0\n", 3, "radius 0"},
    {"1\n" EXTENDED " Time=x\nA 1 2 3 1\n", 2, "time is 'x'"},
    {"1\n" EXTENDED ":pos:R:3\nA 1 2 3 1 1 1 1\n", 2, "both may be x"},
    {"1\nProperties=pos:R:3:radius\n1 2 3 1\n", 2, "name:type:count"},
    {"1\nProperties=pos:R:-3\n1 2 3 1\n", 2, "name:type:count"},
    {"1\nProperties=pos:R:3:radius:R:1:a:R:1e18\n1 2 3 1\n", 2,
     "name:type:count"},
    {"1\nProperties=pos:R:3:radius:R:1:a:R:256\n1 2 3 1\n", 2, "columns"},
    {"1\nProperties=pos:R:2:radius:R:1\n1 2 3\n", 2, "x, y and z"},
    {"1000000000000000000\n\nA 1 2 3\n", 1, "whole number"},
    {"9007199254740992\n" EXTENDED "\nA 1 2 3 4\n", 3, "cut short"},
    /* LAMMPS */
    {STEP COUNT(2) ATOMS ATOM, 6, "cut short"},
    {STEP COUNT(2) ATOMS ATOM STEP, 7, "sphere 2 of 2"},
    {STEP COUNT(1) ATOMS ATOM ATOM, 7, "ITEM"},
    {STEP COUNT(2) ATOMS ATOM ATOM, 7, "id 1 twice"},
    {STEP COUNT(-1) ATOMS ATOM, 4, "whole number"},
    {STEP COUNT(1.5) ATOMS ATOM, 4, "whole number"},
    {STEP COUNT(1 1) ATOMS ATOM, 4, "whole number"},
    {STEP COUNT(nan) ATOMS ATOM, 4, "whole number"},
    {STEP COUNT(1e300) ATOMS ATOM, 4, "whole number"},
    {STEP COUNT(1e15) ATOMS ATOM, 6, "cut short"},
    {STEP ATOMS ATOM, 3, "NUMBER OF ATOMS"},
    {STEP "ITEM: NUMBER OF ATOMS\n" ATOMS ATOM, 4, "belongs"},
    {STEP, 2, "cut short"},
    {"ITEM: TIMESTEP\n", 1, "cut short"},
    {"ITEM: TIMESTEP\nx\n", 2, "time step is 'x'"},
    {STEP COUNT(1) "ITEM: ATOMS id x y radius\n1 1 2 3\n", 5, "x y z"},
    {STEP COUNT(1) "ITEM: ATOMS id x y z\n1 1 2 3\n", 5, "no radius"},
    {STEP COUNT(1) "ITEM: ATOMS\n1 1 2 3\n", 5, "x y z"},
    {STEP COUNT(1) "ITEM: ATOMS xs ys zs radius\n1 1 2 3\n", 5, "BOX BOUNDS"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS\n0 1\n0\n0 1\n" ATOMS ATOM, 7, "bounds"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS\n0 1 1 1\n", 6, "bounds"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS\n0 1\n0 nan\n", 7, "bounds"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS abc origin\n1 0 0\n", 6, "bounds"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS\n0 1e300\n0 1\n0 1\n"
                   "ITEM: ATOMS xs ys zs radius\n1e50 0 0 1\n",
     10, "too large"},
    {STEP COUNT(1) "ITEM: BOX BOUNDS\n-1.7e308 1.7e308\n0 1\n0 1\n"
                   "ITEM: ATOMS xs ys zs radius\n0 0 0 1\n",
     10, "too large"},
    {STEP "ITEM: NUMBER OF ENTRIES\n1\n", 3, "not known"},
    {STEP COUNT(1) ATOMS "1 1 2 inf .1\n", 6, "column z is 'inf'"},
    {STEP COUNT(1) ATOMS "1 1 2 1e300 .1\n", 6, "z is 1e+300"},
};

static void test_refusals(void) {
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    const struct refused *c = &refusals[k];
    char start[32];
    snprintf(start, sizeof start, "file:%zu: ", c->line);
    struct frames_read f = {0};
    if (*c->text) {
      f = read_text(c->text, strlen(c->text), &plain);
    } else {
      f = read_text(" ", 0, &plain);
    }
    if (!CHECK(f.status == GSL_EINVAL && strstr(f.error, c->says) &&
               !strncmp(f.error, start, strlen(start)) &&
               !strpbrk(f.error, "\n\033")))
      fprintf(stderr, "  expected %s'%s', got '%s' for\n%s\n", start, c->says,
              f.error, c->text);
    free_frames(&f);
  }

  /* keys without an end */
  char *keys = NULL;
  size_t keys_size = 0;
  FILE *out = open_memstream(&keys, &keys_size);
  if (!out)
    abort();
  fputs(BED, out);
  for (int k = 0; k < 5000; k++)
    fprintf(out, "# key%d=%d\n", k, k);
  fclose(out);
  struct frames_read many = read_text(keys, keys_size, &plain);
  CHECK(many.status == GSL_EINVAL && strstr(many.error, "file:4097: more"));
  free(keys);

  /* one line without an end */
  const size_t size = (1 << 20) + 10;
  char *text = malloc(size);
  if (!text)
    abort();
  memset(text, 'q', size);
  struct frames_read f = read_text(text, size, &plain);
  CHECK(f.status == GSL_EINVAL && strstr(f.error, "file:1: a line of more"));
  free(text);
}

/* --- the corpus ------------------------------------------------------------*/

static void test_corpus(const char *folder, size_t least) {
  DIR *directory = opendir(folder);
  size_t files = 0;
  if (!CHECK(directory))
    return;
  for (struct dirent *entry; (entry = readdir(directory));) {
    static uint8_t data[1 << 16];
    char path[300];
    snprintf(path, sizeof path, "%s/%.255s", folder, entry->d_name);
    if (*entry->d_name == '.')
      continue;
    FILE *in = fopen(path, "rb");
    if (!CHECK(in))
      continue;
    const size_t size = fread(data, 1, sizeof data, in);
    fclose(in);
    CHECK(size > 0 && size < sizeof data);
    CHECK(LLVMFuzzerTestOneInput(data, size) == 0); /* aborts otherwise */
    files++;
  }
  closedir(directory);
  CHECK(files >= least);
}

int main(void) {
  test_same_spheres();
  test_tilted();
  test_defaults();
  test_no_spheres();
  test_refusals();
  test_corpus("tests/corpus", 9);
  test_corpus("tests/cases", 50);
  return check_done();
}
