/* SPDX-License-Identifier: GPL-2.0-or-later */
/* The codes that our library returns, with the values that they have
   everywhere. A host that links LAMMPS, which is under version 2 of the GPL,
   is built with this header and without the GSL, which is under version 3. */
#ifndef CODES_GSL_ERRNO_H
#define CODES_GSL_ERRNO_H

enum {
  GSL_SUCCESS = 0,
  GSL_FAILURE = -1,
  GSL_EINVAL = 4,
  GSL_EFAILED = 5,
  GSL_ENOMEM = 8,
  GSL_EBADFUNC = 9
};

#endif
