# make help lists the targets.
SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -c
.DELETE_ON_ERROR:
.SUFFIXES:

CC ?= gcc
CFLAGS ?= -O3 -g
WARNINGS := -Wall -Wextra
INCLUDES := -Icommon -Ianalyze -Isettle -Itests
GSL_CFLAGS := $(shell gsl-config --cflags 2>/dev/null)
GSL_LIBS := $(shell gsl-config --libs 2>/dev/null || echo -lgsl -lgslcblas -lm)
OPENMP ?= -fopenmp
ALL_CFLAGS = -std=c11 $(WARNINGS) $(INCLUDES) $(GSL_CFLAGS) $(OPENMP) $(CFLAGS)
B := build
O := $(B)/obj
PREFIX ?= /usr/local

all: $(B)/bounce $(B)/settle $(B)/analyze ## build the programs

# Kernel: once per instruction set. NaN and infinity must stay what they are.
ARCH := $(shell uname -m)
KERNEL_CFLAGS := -fno-math-errno -fno-trapping-math
ifneq (,$(findstring clang,$(shell $(CC) --version 2>/dev/null)))
KERNEL_CFLAGS += -fveclib=libmvec -Wno-pass-failed
endif
ifeq ($(ARCH),x86_64)
KERNELS := x86_64 x86_64_v3 x86_64_v4
MARCH_x86_64 := -march=x86-64
MARCH_x86_64_v3 := -march=x86-64-v3
MARCH_x86_64_v4 := -march=x86-64-v4 -mprefer-vector-width=512
LIBMVEC := -lmvec
else
KERNELS := native
MARCH_native :=
endif
KERNEL_OBJECTS := $(KERNELS:%=$(O)/common/kernel_%.o)

COMMON_OBJECTS := $(patsubst %.c,$(O)/%.o,$(filter-out common/kernel.c,\
	$(wildcard common/*.c))) $(KERNEL_OBJECTS)
LIBRARY := $(B)/libdem.a

# A change of compiler or flags rebuilds everything.
FLAGS_NOW := $(CC) $(ALL_CFLAGS) $(KERNEL_CFLAGS)
$(shell mkdir -p $(B); echo '$(FLAGS_NOW)' | cmp -s - $(B)/flags || \
	echo '$(FLAGS_NOW)' > $(B)/flags)

$(O)/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c $< -o $@

$(KERNEL_OBJECTS): $(O)/common/kernel_%.o: common/kernel.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) $(KERNEL_CFLAGS) $(MARCH_$*) -DKERNEL_ISA=$* \
	  -MMD -MP -c $< -o $@

$(LIBRARY): $(COMMON_OBJECTS)
	@rm -f $@
	ar rcs $@ $^

LINK = $(CC) $(ALL_CFLAGS) $^ $(GSL_LIBS) $(LIBMVEC) -lm -o $@
$(B)/bounce: $(patsubst %.c,$(O)/%.o,$(wildcard bounce/*.c)) $(LIBRARY)
	$(LINK)
$(B)/settle: $(patsubst %.c,$(O)/%.o,$(wildcard settle/*.c)) $(LIBRARY)
	$(LINK)
$(B)/analyze: $(patsubst %.c,$(O)/%.o,$(wildcard analyze/*.c)) $(LIBRARY)
	$(LINK)

-include $(shell find $(B) -name '*.d' 2>/dev/null)
