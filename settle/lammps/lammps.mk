# SPDX-License-Identifier: GPL-3.0-or-later
# settle-lammps: beds beyond one machine (docs/beyond-one-machine.md). Debian's
# liblammps-dev; C++, because LAMMPS is. LAMMPS is under version 2 of the GPL,
# so the program holds nothing of the GSL, which is under version 3 or later:
# what it uses of common/ is built anew with the codes of settle/lammps/codes.
LAMMPS_CXX ?= mpicxx
LAMMPS_INCLUDE ?= /usr/include/lammps
LAMMPS_LIBS ?= -llammps
LAMMPS_OF := steppers/chebyshev steppers/power steppers/predictive \
  steppers/rkc_step steppers/stage dynamics/kernel_select dynamics/rates \
  dynamics/scale model/scene model/similarity files/numbers \
  files/sheet \
  platform/store platform/checksum
LAMMPS_OBJECTS := $(LAMMPS_OF:%=$(O)/lammps/common/%.o) \
  $(O)/lammps/settle/lammps/rows.o
LAMMPS_CXX_OBJECTS := $(O)/lammps/styles.o $(O)/lammps/host.o
LAMMPS_SEES := -Isettle/lammps -Isettle/lammps/codes -Icommon
$(LAMMPS_OBJECTS): INCLUDES := $(LAMMPS_SEES)
$(LAMMPS_OBJECTS): OPENMP := # a rank is one thread
$(O)/lammps/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(filter-out $(GSL_CFLAGS),$(ALL_CFLAGS)) -MMD -MP -c $< -o $@
$(LAMMPS_CXX_OBJECTS): $(O)/lammps/%.o: settle/lammps/%.cpp $(B)/flags
	@mkdir -p $(@D)
	$(LAMMPS_CXX) -std=c++11 -Wall -Wextra -DOMPI_SKIP_MPICXX $(LAMMPS_SEES) \
	  -isystem $(LAMMPS_INCLUDE) \
	  -DDEM_VERSION='$(shell sed -n 's/.*DEM_VERSION //p' common/program/version.h)' \
	  $(CPPFLAGS) $(CFLAGS) -MMD -MP -c $< -o $@
$(B)/settle-lammps: $(LAMMPS_CXX_OBJECTS) $(LAMMPS_OBJECTS) \
  $(KERNEL_OBJECTS)
	$(LAMMPS_CXX) $(CFLAGS) $(LDFLAGS) $^ $(LAMMPS_LIBS) $(LIBMVEC) -lm -o $@
lammps: $(B)/settle-lammps ## build settle-lammps, for beds beyond one machine (liblammps-dev)

.PHONY: lammps
