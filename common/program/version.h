/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One version for all programs. */
#ifndef VERSION_H
#define VERSION_H

#define DEM_VERSION "0.3.0"

#endif
