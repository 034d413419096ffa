/* One version for all programs. */
#ifndef VERSION_H
#define VERSION_H

#define DEM_VERSION "0.2.0"

#endif
