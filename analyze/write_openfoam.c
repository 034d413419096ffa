/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenFOAM: a case for blockMesh and snappyHexMesh, which fill the box with
   cubes, keep those that can be reached from a point in the pore, and move
   their corners onto the surface. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include "files/numbers.h"
#include "geometry/clearance.h"
#include "measure.h"
#include "program/files.h"
#include "program/options.h"
#include "writers.h"

static void open_dictionary(struct output_file *f, const char *folder,
                            const char *name, const struct write_frame *of) {
  output_open_in(f, folder, name);
  write_origin(f->stream, &origin_slashes, of);
  fprintf(f->stream,
          "// %s\n"
          "FoamFile\n{\n    version 2.0;\n    format  ascii;\n"
          "    class   dictionary;\n    object  %s;\n}\n\n",
          of->shape->statement, name);
}

static void put_point(FILE *out, double x, double y, double z) {
  const double p[3] = {x, y, z};
  fputc('(', out);
  for (int k = 0; k < 3; k++) {
    char text[NUMBER_SIZE];
    number_format(p[k], text);
    fprintf(out, k < 2 ? "%s " : "%s)", text);
  }
}

/* Cubes; cells is their number along the longest side. */
static void write_block(FILE *out, const double box[6], size_t cells) {
  static const struct {
    const char *name;
    int corner[4];
  } faces[6] = {{"xmin", {0, 4, 7, 3}}, {"xmax", {1, 2, 6, 5}},
                {"ymin", {0, 1, 5, 4}}, {"ymax", {3, 7, 6, 2}},
                {"zmin", {0, 3, 2, 1}}, {"zmax", {4, 5, 6, 7}}};
  double longest = 0;
  for (int k = 0; k < 3; k++)
    longest = fmax(longest, box[2 * k + 1] - box[2 * k]);
  fprintf(out, "scale 1;\nvertices\n(\n");
  for (int c = 0; c < 8; c++) {
    const int x = (c % 4 == 1) | (c % 4 == 2), y = c % 4 > 1, z = c > 3;
    fputs("    ", out);
    put_point(out, box[x], box[2 + y], box[4 + z]);
    fputc('\n', out);
  }
  fprintf(out, ");\nblocks\n(\n    hex (0 1 2 3 4 5 6 7) (");
  for (int k = 0; k < 3; k++) {
    const double side = box[2 * k + 1] - box[2 * k];
    fprintf(out, k < 2 ? "%.0f " : "%.0f",
            fmax(1, round(side / longest * (double)cells)));
  }
  fprintf(out, ") simpleGrading (1 1 1)\n);\nedges ();\nboundary\n(\n");
  for (int f = 0; f < 6; f++)
    fprintf(out, "    %s { type patch; faces ((%d %d %d %d)); }\n",
            faces[f].name, faces[f].corner[0], faces[f].corner[1],
            faces[f].corner[2], faces[f].corner[3]);
  fprintf(out, ");\nmergePatchPairs ();\n");
}

/* A tube and slanting walls, which the mesher knows as such: their geometry or
   how finely it is resolved. */
static void put_walls(FILE *out, const struct shape *s, bool geometry) {
  const struct container *c = s->solid.container;
  double p[3], q[3];
  if (c && c->radius > 0 && geometry) {
    shape_tube(s, p, q);
    fputs("    tube\n    {\n        type searchableCylinder;\n        point1 ",
          out);
    put_point(out, p[0], p[1], p[2]);
    fputs(";\n        point2 ", out);
    put_point(out, q[0], q[1], q[2]);
    char text[NUMBER_SIZE];
    number_format(c->radius, text);
    fprintf(out, ";\n        radius %s;\n    }\n", text);
  } else if (c && c->radius > 0) {
    fputs("        tube { level (1 1); }\n", out);
  }
  for (size_t k = 0; c && k < c->planes; k++) {
    fprintf(out,
            geometry ? "    wall%zu\n" : "        wall%zu { level (1 1); }\n",
            k);
    if (!geometry)
      continue;
    shape_plane(s, k, p, q);
    fputs("    {\n        type searchablePlane;\n"
          "        planeType pointAndNormal;\n"
          "        pointAndNormalDict\n        {\n            basePoint ",
          out);
    put_point(out, p[0], p[1], p[2]);
    fputs(";\n            normal ", out);
    put_point(out, q[0], q[1], q[2]);
    fputs(";\n        }\n    }\n", out);
  }
}

static void write_snappy(FILE *out, const struct shape *s,
                         const double point[3], double clearance) {
  fprintf(out, "castellatedMesh true;\nsnap true;\naddLayers false;\n\n"
               "geometry\n{\n"
               "    spheres.stl { type triSurfaceMesh; name spheres; }\n");
  put_walls(out, s, true);
  fprintf(out, "}\n\ncastellatedMeshControls\n{\n"
               "    maxLocalCells 100000000;\n    maxGlobalCells 100000000;\n"
               "    minRefinementCells 0;\n    nCellsBetweenLevels 2;\n"
               "    resolveFeatureAngle 30;\n    features ();\n"
               "    refinementSurfaces\n    {\n"
               "        spheres { level (1 1); }\n");
  put_walls(out, s, false);
  fprintf(out,
          "    }\n"
          "    refinementRegions {}\n"
          "    allowFreeStandingZoneFaces false;\n"
          "    // in the pore, %.4g from everything\n"
          "    locationInMesh ",
          clearance);
  put_point(out, point[0], point[1], point[2]);
  fprintf(out,
          ";\n}\n\nsnapControls\n{\n"
          "    nSmoothPatch 3;\n    tolerance 2;\n    nSolveIter 50;\n"
          "    nRelaxIter 5;\n    nFeatureSnapIter 10;\n"
          "    implicitFeatureSnap true;\n    explicitFeatureSnap false;\n"
          "    multiRegionFeatureSnap false;\n}\n\n"
          "addLayersControls\n{\n    layers {}\n    relativeSizes true;\n"
          "    expansionRatio 1;\n    finalLayerThickness 0.3;\n"
          "    minThickness 0.1;\n    nGrow 0;\n    featureAngle 60;\n"
          "    nRelaxIter 3;\n    nSmoothSurfaceNormals 1;\n"
          "    nSmoothNormals 3;\n    nSmoothThickness 10;\n"
          "    maxFaceThicknessRatio 0.5;\n"
          "    maxThicknessToMedialRatio 0.3;\n    minMedianAxisAngle 90;\n"
          "    nBufferCellsNoExtrude 0;\n    nLayerIter 50;\n}\n\n"
          "meshQualityControls\n{\n"
          "    maxNonOrtho 65;\n    maxBoundarySkewness 4;\n"
          "    maxInternalSkewness 4;\n    maxConcave 80;\n"
          "    minVol 1e-30;\n    minTetQuality 1e-15;\n    minArea -1;\n"
          "    minTwist 0.02;\n    minDeterminant 0.001;\n"
          "    minFaceWeight 0.05;\n    minVolRatio 0.01;\n"
          "    minTriangleTwist -1;\n    nSmoothScale 4;\n"
          "    errorReduction 0.75;\n    relaxed { maxNonOrtho 75; }\n}\n\n"
          "mergeTolerance 1e-6;\n");
}

void write_openfoam(const char *folder, const struct write_frame *f,
                    const struct write_options *o) {
  struct shape *s = f->shape;
  double point[3], clearance;
  const int status = clearance_deepest(&s->solid, s->box, point, &clearance);
  if (status == GSL_EDOM)
    frame_refuse(s->frames, s->source, "no point of the box is in the pore");
  frame_check(s->frames, s->source, status);
  /* off the planes of a grid, where the middle of something round may be */
  static const double aside[3] = {0.0317, 0.0231, 0.0119};
  for (int k = 0; k < 3; k++)
    point[k] += aside[k] * clearance;
  shape_measure(s);
  shape_say_ends(s);

  struct output_file surface, block, snappy, control, schemes, solution;
  output_folder(folder);
  char *system = output_folder_in(folder, "system");
  char *constant = output_folder_in(folder, "constant");
  char *surfaces = output_folder_in(constant, "triSurface");
  output_open_in(&surface, surfaces, "spheres.stl");
  open_dictionary(&block, system, "blockMeshDict", f);
  open_dictionary(&snappy, system, "snappyHexMeshDict", f);
  open_dictionary(&control, system, "controlDict", f);
  open_dictionary(&schemes, system, "fvSchemes", f);
  open_dictionary(&solution, system, "fvSolution", f);
  /* the mesh has the volume of its surface, which should be the spheres' */
  struct write_options bodies = *o;
  bodies.equal_volume = true;
  bodies.apart = true;
  write_stl(surface.stream, f, &bodies);
  double domain[6];
  shape_domain(s, domain);
  write_block(block.stream, domain, o->cells[0]);
  write_snappy(snappy.stream, s, point, clearance);
  fprintf(control.stream, "application snappyHexMesh;\nstartFrom startTime;\n"
                          "startTime 0;\nstopAt endTime;\nendTime 1;\n"
                          "deltaT 1;\nwriteControl timeStep;\n"
                          "writeInterval 1;\nwriteFormat ascii;\n"
                          "writePrecision 10;\n");
  fprintf(schemes.stream, "ddtSchemes {}\ngradSchemes {}\ndivSchemes {}\n"
                          "laplacianSchemes {}\ninterpolationSchemes {}\n"
                          "snGradSchemes {}\n");
  fprintf(solution.stream, "solvers {}\n");
  output_commit(&surface);
  output_commit(&block);
  output_commit(&snappy);
  output_commit(&control);
  output_commit(&schemes);
  output_commit(&solution);
  free(surfaces);
  free(constant);
  free(system);
}
