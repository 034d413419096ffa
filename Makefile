# SPDX-License-Identifier: GPL-3.0-or-later
# make help lists the targets. Works with make 3.81 and later; there, a failure
# in the middle of a pipe goes unseen, as .SHELLFLAGS is of 3.82.
SHELL := bash
.SHELLFLAGS := -o pipefail -c
.DELETE_ON_ERROR:
.SUFFIXES:

# What may be set: CC AR CPPFLAGS CFLAGS LDFLAGS; OPENMP= builds without
# threads, which Debian's musl-gcc needs, as its libgomp is glibc's; GSL_CFLAGS
# and GSL_LIBS for a GSL that neither pkg-config nor gsl-config tells of; B, where
# products go; PREFIX and DESTDIR of install.
# make has a CC of its own, cc, which is whatever the system prefers; the figures
# were made by gcc.
ifeq ($(origin CC),default)
CC := $(if $(shell command -v gcc),gcc,cc)
endif
CFLAGS ?= -O3 -g
WARNINGS := -Wall -Wextra -Wpedantic -Wconversion
INCLUDES := -Icommon
B := build
O := $(B)/obj
PREFIX ?= /usr/local

all: $(B)/bounce $(B)/settle $(B)/analyze $(B)/sweep ## build the programs

# What the compiler, its target and the libraries offer.
ifneq ($(filter-out clean help deps deps-developer uninstall sanitize tidy,$(or $(MAKECMDGOALS),all)),)
$(shell CC='$(CC)' CPPFLAGS='$(CPPFLAGS)' CFLAGS='$(CFLAGS)' \
  LDFLAGS='$(LDFLAGS)' common/platform/probe.sh $(B)/config.mk)
include $(B)/config.mk
PROBED := yes
endif
GSL_CFLAGS ?= $(FOUND_GSL_CFLAGS)
GSL_LIBS ?= $(FOUND_GSL_LIBS)
OPENMP ?= $(FOUND_OPENMP)
ALL_CFLAGS = -std=c11 $(WARNINGS) $(FOUND_QUIET) $(INCLUDES) $(GSL_CFLAGS) \
  $(or $(OPENMP),$(FOUND_SIMD)) $(CPPFLAGS) $(CFLAGS)

# Kernel: once per instruction set. NaN and infinity must stay what they are.
KERNEL_CFLAGS := -fno-math-errno -fno-trapping-math $(VECLIB)
KERNEL_OBJECTS := $(KERNELS:%=$(O)/common/dynamics/kernel_%.o)

COMMON_OBJECTS := $(patsubst %.c,$(O)/%.o,$(filter-out common/dynamics/kernel.c,\
	$(wildcard common/*/*.c))) $(KERNEL_OBJECTS)
LIBRARY := $(B)/libdem.a

# A change of compiler or flags rebuilds everything.
FLAGS_NOW := $(CC) $(ALL_CFLAGS) $(KERNEL_CFLAGS)
ifdef PROBED
$(shell mkdir -p $(B); echo '$(FLAGS_NOW)' | cmp -s - $(B)/flags || \
	echo '$(FLAGS_NOW)' > $(B)/flags)
endif

$(O)/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c $< -o $@

# Their inner loops are roots, which errno would keep from being vectorized.
$(O)/common/geometry/ball_cell.o $(O)/common/geometry/voxels.o: ALL_CFLAGS += -fno-math-errno

$(KERNEL_OBJECTS): $(O)/common/dynamics/kernel_%.o: common/dynamics/kernel.c $(B)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) $(KERNEL_CFLAGS) $(MARCH_$*) -DKERNEL_ISA=$* \
	  -MMD -MP -c $< -o $@

$(LIBRARY): $(COMMON_OBJECTS)
	@rm -f $@
	$(AR) rcs $@ $^

LINK = $(CC) $(ALL_CFLAGS) $(LDFLAGS) $(WRAPPED) $^ $(GSL_LIBS) $(LIBMVEC) -lm -o $@
# Each program is a folder of sources.
PROGRAMS := bounce settle analyze precision stability
define program_rule
$(B)/$(1): $(patsubst %.c,$(O)/%.o,$(wildcard $(1)/*.c)) $(LIBRARY)
	$$(LINK)
endef
$(foreach p,$(PROGRAMS),$(eval $(call program_rule,$(p))))

# A script, which finds settle and analyze beside it.
$(B)/sweep: sweep/sweep.sh
	install -D $< $@

# Where analyze finds what it draws with, as long as it is not installed.
$(B)/analyze: | $(B)/plots
$(B)/plots:
	ln -s "$(CURDIR)/plots/draw" $@

-include $(shell find $(B) -name '*.d' 2>/dev/null)

# Tests: every tests/test_*.c is a program, every tests/test_*.sh a script; each
# ends with a line "N passed, N failed".
TEST_PROGRAMS := $(patsubst tests/%.c,$(B)/tests/%,$(wildcard tests/test_*.c))
TEST_SCRIPTS := $(wildcard tests/test_*.sh)
$(B)/tests/%: $(O)/tests/%.o $(LIBRARY)
	@mkdir -p $(@D)
	$(LINK)
.SECONDARY:

# What allocates is replaced by what can fail.
$(B)/tests/test_memory: WRAPPED := $(foreach f,malloc calloc realloc \
	gsl_odeiv2_step_alloc gsl_odeiv2_evolve_alloc \
	gsl_odeiv2_control_scaled_new gsl_rng_alloc gsl_rstat_quantile_alloc \
	gsl_poly_complex_workspace_alloc gsl_root_fsolver_alloc \
	gsl_integration_glfixed_table_alloc,-Wl,--wrap=$(f))

# Those that run studies and whole beds take most of the time.
LONG_SCRIPTS := tests/test_figures.sh tests/test_settling.sh
check: all $(B)/precision $(B)/stability $(TEST_PROGRAMS) ## run the tests, JOBS=2 at a time (minutes)
	@B=$(B) tests/run.sh $(TEST_SCRIPTS) $(TEST_PROGRAMS)

check-quick: all $(B)/precision $(B)/stability $(TEST_PROGRAMS) ## those without studies and whole beds
	@B=$(B) tests/run.sh $(filter-out $(LONG_SCRIPTS),$(TEST_SCRIPTS)) \
	  $(TEST_PROGRAMS)

# The tests without studies once more, with what gcc can find while they run:
# memory that is not ours, behaviour that is undefined. CHECK=check: all of them.
CHECK ?= check-quick
SANITIZED := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all \
  -fno-omit-frame-pointer
sanitize: ## run the tests with the address and undefined-behaviour sanitizers
	$(MAKE) $(CHECK) B=$(B)/sanitize CFLAGS='$(SANITIZED)'

tidy: ## what cppcheck, clang-tidy and gcc -fanalyzer find
	tests/tidy.sh

clients: all ## have the programs that beds are handed to read them (minutes)
	@B=$(B) tests/clients.sh

# What the fuzzer finds is kept in B/fuzz; the small cases of tests/corpus are
# read again by tests/test_formats.c.
FUZZ_CC ?= clang
FUZZ_SECONDS ?= 60
FUZZ_SOURCES := tests/fuzz_readers.c $(wildcard common/files/*.c) \
	common/model/bed.c common/platform/store.c common/platform/checksum.c
$(B)/fuzz/readers: $(FUZZ_SOURCES) $(wildcard common/files/*.h)
	@mkdir -p $(@D)
	$(FUZZ_CC) -std=c11 -O1 -g -fsanitize=fuzzer,address,undefined \
	  -fno-sanitize-recover=undefined $(WARNINGS) $(INCLUDES) $(GSL_CFLAGS) \
	  $(FUZZ_SOURCES) $(GSL_LIBS) -o $@

INSTANTS ?= 200
ROW ?= *
torture: all ## kill runs and go on, let each call fail, INSTANTS=200 (an hour), ROW='malloc*'
	B=$(B) tests/torture.sh $(INSTANTS) 1 '$(ROW)'

threads: ## two threads under clang's thread sanitizer and archer (libomp-dev)
	$(MAKE) $(B)/threads/settle $(B)/threads/analyze B=$(B)/threads CC=clang \
	  CFLAGS='-O1 -g -fsanitize=thread'
	B=$(B)/threads tests/threads.sh

RUNS ?= 10000
SOAK ?= 3600
load: all ## RUNS=10000 in a row, 64 at once, one for SOAK=3600 s
	B=$(B) tests/load.sh $(RUNS) $(SOAK)

million: all ## memory of 1,008,200 spheres over 1,000 evaluations (15 CPU minutes)
	B=$(B) tests/million.sh

valgrind: all ## small scenes of every method, and the verbs, under valgrind
	B=$(B) tests/valgrind.sh

MUTANTS ?= 300
mutants: ## break the sources at MUTANTS=300 places, and see the tests notice (hours)
	B=$(B) tests/mutants.sh $(MUTANTS)

$(B)/fuzz/programs: tests/fuzz_programs.c
	@mkdir -p $(@D)
	$(CC) -std=c11 -O2 $(WARNINGS) $< -o $@

fuzz: $(B)/fuzz/readers fuzz-programs ## feed random files to the readers (clang), and options, FUZZ_SECONDS=60
	@mkdir -p $(B)/fuzz/corpus
	$(B)/fuzz/readers -max_total_time=$(FUZZ_SECONDS) -timeout=10 -verbosity=0 -print_final_stats=1 \
	  -rss_limit_mb=1024 -max_len=4096 -dict=tests/fuzz_readers.dict \
	  -artifact_prefix=$(B)/fuzz/ $(B)/fuzz/corpus tests/corpus tests/cases

fuzz-programs: $(B)/fuzz/programs ## random options and damaged checkpoints for the programs, with sanitizers
	$(MAKE) $(B)/sanitize/settle $(B)/sanitize/analyze B=$(B)/sanitize \
	  CFLAGS='$(SANITIZED)'
	B=$(B)/sanitize tests/fuzz_programs.sh $(B)/fuzz/programs $(FUZZ_SECONDS)

# What is needed, and what some tests use where it is there; then what a developer
# has besides.
PACKAGES := gcc make libgsl-dev gnuplot-nox fonts-dejavu-core
PACKAGES_TESTS := groff-base xz-utils zstd
PACKAGES_DEVELOPER := clang libomp-dev clang-tidy clang-format cppcheck \
  shellcheck strace valgrind ffmpeg parallel slurm-wlm liblammps-dev
has = command -v $(1) >/dev/null
apt = $$([ "$$(id -u)" = 0 ] || echo sudo) apt-get
define install_packages
$(apt) update && $(apt) install -y --no-install-recommends $(1)
endef
deps: ## install the Debian packages (as root, or with sudo)
	@if ! { $(call has,gnuplot) && $(call has,gsl-config); }; then \
	  $(call install_packages,$(PACKAGES) $(PACKAGES_TESTS)); \
	elif ! { $(call has,groff) && $(call has,xz) && $(call has,zstd); }; then \
	  $(call install_packages,$(PACKAGES_TESTS)) || \
	    echo "without $(PACKAGES_TESTS): some tests will be skipped"; \
	else \
	  echo "GSL, gnuplot and what the tests use are installed"; \
	fi
deps-developer: ## ... and what else developers use: clang, linters
	@$(call install_packages,$(PACKAGES) $(PACKAGES_TESTS) $(PACKAGES_DEVELOPER))

demo: all ## settle 200 spheres, print the solid fraction, draw the bed
	$(B)/settle --seed 1 > $(B)/demo.tsv.partial
	@mv $(B)/demo.tsv.partial $(B)/demo.tsv
	$(B)/analyze $(B)/demo.tsv
	gnuplot -d -c plots/draw/bed.gp $(B)/demo.tsv $(B)/demo.png
	@echo "the bed: $(B)/demo.tsv, its picture: $(B)/demo.png"

# Man pages: each program and verb prints its own.
VERBS = $(shell $(B)/analyze --complete | grep -v '^-')
$(B)/man/.done: $(B)/bounce $(B)/settle $(B)/analyze $(B)/sweep
	@rm -rf $(@D) && mkdir -p $(@D)
	for p in bounce settle analyze sweep; do \
	  $(B)/$$p --man > $(@D)/$$p.1 || exit; \
	done
	for v in $(VERBS); do \
	  $(B)/analyze $$v --man > $(@D)/analyze-$$v.1 || exit; \
	done
	@touch $@

man: $(B)/man/.done ## man pages of the programs and their verbs, in build/man

BINDIR = $(DESTDIR)$(PREFIX)/bin
SHARE = $(DESTDIR)$(PREFIX)/share
COMPLETIONS = $(SHARE)/bash-completion/completions
# The folders that are ours alone, and those that others use too.
OWN = $(SHARE)/dem/plots $(SHARE)/dem $(SHARE)/doc/dem/docs $(SHARE)/doc/dem
SHARED = $(COMPLETIONS) $(SHARE)/bash-completion $(SHARE)/man/man1 \
  $(SHARE)/man $(SHARE)/doc $(SHARE) $(BINDIR) $(DESTDIR)$(PREFIX)
install: all man ## programs, man pages, completion, pages, what draw needs; PREFIX, DESTDIR
	install -d $(BINDIR) $(SHARE)/man/man1 $(COMPLETIONS) $(OWN)
	install $(B)/bounce $(B)/settle $(B)/analyze $(B)/sweep $(BINDIR)
	install -m 644 $(B)/man/*.1 $(SHARE)/man/man1
	for p in bounce settle analyze sweep; do \
	  install -m 644 common/program/completion.bash $(COMPLETIONS)/$$p || exit; \
	done
	install -m 644 plots/style.gp plots/draw/{balls,bed,movie}.gp \
	  $(SHARE)/dem/plots
	install -m 644 README.md CHANGELOG.md LICENSE $(SHARE)/doc/dem
	install -m 644 docs/*.md docs/*.png $(SHARE)/doc/dem/docs

# Folders go only if they are empty, those of others only in a DESTDIR.
uninstall: ## remove what install has brought
	rm -f $(BINDIR)/{bounce,settle,analyze,sweep} \
	  $(SHARE)/man/man1/{bounce,settle,analyze,analyze-*,sweep}.1 \
	  $(COMPLETIONS)/{bounce,settle,analyze,sweep}
	rm -rf $(SHARE)/dem $(SHARE)/doc/dem
	$(if $(DESTDIR),-rmdir $(SHARED) 2>/dev/null)

clean: ## remove everything that was made
	rm -rf $(B)

help: ## this list
	@sed -n 's/^\([a-zA-Z0-9.-]*\):.*## \(.*\)/\1\t\2/p' $(MAKEFILE_LIST) | \
	  expand -t 16

include plots/rules.mk plots/captions.mk settle/lammps/lammps.mk

.PHONY: all check check-quick clients sanitize tidy torture threads load million valgrind mutants fuzz fuzz-programs deps deps-developer demo man install uninstall clean help
