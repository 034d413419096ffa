/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene as options name it: from a command line (SCENE_OPTIONS in
   shared_options.h) or from the keys of a bed's header. Tested in
   tests/test_contacts.c and, through settle, in tests/test_cli.sh. */
#ifndef SCENE_OPTIONS_H
#define SCENE_OPTIONS_H

#include "files/bed_io.h"
#include "program/options.h"
#include "model/scene.h"

/* Options that describe a scene in other words than struct scene. */
struct scene_words {
  const char *model;          /* name of one of scene_models */
  const char *lever;          /* of one of scene_levers, NULL: the first */
  struct option_list gravity; /* one number, downwards, or three */
  const char *periodic;       /* axes, of scene_periodic; NULL: none */
  struct option_list base;    /* sides of the box, two */
};

/* The words for scene_default(). */
struct scene_words scene_words_default(void);

/* For option wall: appends {px, py, pz, nx, ny, nz} to a struct scene. */
int scene_wall_option(const struct option_list *v, void *scene);

/* Text of --help for lever's default. */
void scene_lever_unset(char *text, size_t size);

/* For option cylinder: appends {px, py, pz, ax, ay, az, R}. */
int scene_cylinder_option(const struct option_list *v, void *scene);

/* For option periodic: its choices, and what --help says of its default. */
extern const char *const scene_periodic[];
void scene_no_periodic(char *text, size_t size);

/* Puts the words into the scene and checks it. NULL, or what is wrong, a
   static string. */
const char *scene_finish(struct scene *s, const struct scene_words *w);

/* Sets every option that is a parameter and was not given on the command line
   from the header's key of its name, but for those that skip, which may be
   NULL, is true for. NULL, or "key=value: expected ...", in a static buffer of
   the calling thread's. */
const char *header_options(const struct bed_header *h,
                           struct option_spec *options,
                           bool (*skip)(const struct option_spec *));

/* Gives options' defaults what they are for spheres of that radius (m) and mass
   (kg) under the gravity of w, after the header's key for it, and returns their
   similarity. Errors are left to header_options, which comes next. */
struct similarity header_similarity(const struct bed_header *h,
                                    struct option_spec *options,
                                    const struct scene_words *w, double radius,
                                    double mass);

/* The scene of a bed: its header's keys over the defaults of scene_default()
   for such spheres, so no key is no wall. h and b may be NULL; without a sphere
   the defaults are for the paper's. The scene is to be
   freed, also after an error. Returns NULL or what is wrong, as above. */
const char *scene_from_header(struct scene *s, const struct bed_header *h,
                              const struct bed *b);

#endif
