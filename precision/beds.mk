# SPDX-License-Identifier: GPL-3.0-or-later
# Whole beds: error of the fraction against CPU time by method and tolerance.
# One file a run under build/data/beds, named by the options of settle that made it
# (precision/bed.sh), so that a stopped make goes on where it was. The CPU times
# of the chart come from the runs under timed/, which have the machine to
# themselves as far as these rules go: others wait for the lock meanwhile.
# QUICK=1: fewer, smaller and shorter runs.
BEDS := $(D)/beds
SHARED := flock -s $(B)/timing.lock
TIMED := flock -x $(B)/timing.lock

$(BEDS)/timed/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	RUN='$(TIMED)' B=$(B) precision/bed.sh $(BED_SIZE)$* > $@
$(BEDS)/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	RUN='$(SHARED)' B=$(B) precision/bed.sh $(BED_SIZE)$* > $@

first = $(wordlist 1,$(1),$(BED_SEEDS))
after = $(filter-out $(call first,$(1)),$(call first,$(2)))
# $(call bed_runs,SETTINGS,TIMED,SEEDS): how many seeds, the first of them timed
bed_runs = $(patsubst %,$(BEDS)/timed/$(1)/seed-%.tsv,$(call first,$(2))) \
  $(patsubst %,$(BEDS)/$(1)/seed-%.tsv,$(call after,$(2),$(3)))

# Seeds by what a run costs. Merson at 0.01 is what the others are compared
# with; the first of its seeds are needed by all.
ifeq ($(QUICK),)
BED_SEEDS := $(shell seq 40)
BED_SIZE :=
BED_OPTIONS :=
BED_MERSON := 20
BED_PAIRS := 4
BED_RKC := 20
BED_VERLET := 8
BED_BASIC := 40
PAIR_TOLERANCES := 10 1 0.1
RKC_TOLERANCES := 1 0.1 0.01 1e-3 5e-4 1e-4
VERLET_STEPS := 1e-3 4e-4 2e-4 1e-4 5e-5 2.5e-5
else
BED_SEEDS := 1 2
BED_SIZE := base-0.5,0.5/count-40/time-2/
BED_OPTIONS := --base 0.5,0.5 --count 40 --time 2
BED_MERSON := 2
BED_PAIRS := 1
BED_RKC := 2
BED_VERLET := 2
BED_BASIC := 2
PAIR_TOLERANCES := 0.1
RKC_TOLERANCES := 0.1 5e-4
VERLET_STEPS := 1e-3 2.5e-5
endif

full := model-rotation
BED_RUNS := \
  $(call bed_runs,$(full)/method-merson/tol-0.01,1,$(BED_MERSON)) \
  $(call bed_runs,$(full)/method-merson/tol-0.1,1,$(BED_MERSON)) \
  $(foreach t,$(RKC_TOLERANCES),\
    $(call bed_runs,$(full)/method-rkc/tol-$(t),3,$(BED_RKC))) \
  $(foreach h,$(VERLET_STEPS),\
    $(call bed_runs,$(full)/method-verlet/step-$(h),3,$(BED_VERLET))) \
  $(foreach t,$(filter-out 0.1,$(PAIR_TOLERANCES)),\
    $(call bed_runs,$(full)/method-merson/tol-$(t),1,$(BED_PAIRS))) \
  $(foreach m,dopri5 rkf45,$(foreach t,$(PAIR_TOLERANCES),\
    $(call bed_runs,$(full)/method-$(m)/tol-$(t),1,$(BED_PAIRS))))

plain := model-basic
BED_RUNS += \
  $(foreach m,merson dopri5 rkf45,$(foreach t,$(PAIR_TOLERANCES),\
    $(call bed_runs,$(plain)/method-$(m)/tol-$(t),3,$(BED_BASIC)))) \
  $(call bed_runs,$(plain)/method-merson/tol-0.01,3,$(BED_BASIC)) \
  $(foreach t,$(RKC_TOLERANCES),\
    $(call bed_runs,$(plain)/method-rkc/tol-$(t),3,$(BED_BASIC))) \
  $(foreach h,$(VERLET_STEPS),\
    $(call bed_runs,$(plain)/method-verlet/step-$(h),3,$(BED_VERLET)))

# Tolerances in order, so that charts join them
$(BEDS)/settling.tsv: $(BED_RUNS) precision/settling.awk precision/beds.mk
	awk -f precision/settling.awk $(BED_RUNS) > $@
settling: $(F)/precision-settling.svg $(F)/precision-settling.md ## error of a bed's fraction against CPU time: which method to take
$(F)/precision-settling.svg: $(BEDS)/settling.tsv plots/settling.gp \
  plots/style.gp
	$(call draw,settling.gp,$<,precision-settling)
$(F)/precision-settling.md: $(BEDS)/settling.tsv bench/markdown.awk
	@mkdir -p $(@D)
	awk -f bench/markdown.awk $< > $@

# Seed by seed: rkc as settle has it, and Merson with two tolerances
SEED_RUNS := $(foreach m,merson/tol-0.01 merson/tol-0.1 rkc/tol-5e-4,\
  $(call bed_runs,$(full)/method-$(m),$(if $(filter rkc/%,$(m)),3,1),$(BED_RKC)))
seeds: $(F)/precision-seeds.md ## rkc beside Merson, seed by seed
	@cat $<
$(F)/precision-seeds.md: $(SEED_RUNS) precision/seeds.awk precision/beds.mk
	@mkdir -p $(@D)
	awk -f precision/seeds.awk $(SEED_RUNS) > $@

precision: settling $(F)/precision-seeds.md
.PHONY: settling seeds
