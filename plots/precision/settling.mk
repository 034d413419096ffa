# SPDX-License-Identifier: GPL-3.0-or-later
# Whole beds: error of the fraction against CPU time by method and tolerance.
# Merson at 0.01 is what the others are compared with. QUICK=1: fewer and smaller
# beds (plots/beds/beds.mk).

# Seeds by what a run costs; the first of Merson's are needed by all.
BED_MERSON := $(if $(QUICK),2,20)
BED_EMBEDDED := $(if $(QUICK),1,4)
BED_RKC := $(if $(QUICK),2,20)
BED_VERLET := $(if $(QUICK),2,8)
BED_BASIC := $(if $(QUICK),2,40)
EMBEDDED_TOLERANCES := $(if $(QUICK),0.1,10 1 0.1)
RKC_TOLERANCES := $(if $(QUICK),0.1 5e-4,1 0.1 0.01 5e-4 1e-4)
MULTIRATE_TOLERANCES := $(if $(QUICK),2e-3,0.05 0.01 2e-3 5e-4)
VERLET_STEPS := $(if $(QUICK),1e-3 2.5e-5,1e-3 4e-4 2e-4 1e-4 5e-5 2.5e-5)

# Tolerances of a method in order, so that charts join them.
SETTLING_FULL := \
  $(foreach t,$(MULTIRATE_TOLERANCES),\
    $(call bed_runs,$(FULL)/method-multirate/tol-$(t),3,$(BED_RKC))) \
  $(foreach t,$(RKC_TOLERANCES),\
    $(call bed_runs,$(FULL)/method-rkc/tol-$(t),3,$(BED_RKC))) \
  $(foreach h,$(VERLET_STEPS),\
    $(call bed_runs,$(FULL)/method-verlet/step-$(h),3,$(BED_VERLET))) \
  $(foreach m,merson dopri5 rkf45,$(foreach t,$(EMBEDDED_TOLERANCES),\
    $(call bed_runs,$(FULL)/method-$(m)/tol-$(t),1,$(BED_EMBEDDED)))) \
  $(call bed_runs,$(FULL)/method-merson/tol-0.01,1,$(BED_MERSON))
SETTLING_PLAIN := \
  $(foreach m,merson dopri5 rkf45,$(foreach t,$(EMBEDDED_TOLERANCES),\
    $(call bed_runs,$(PLAIN)/method-$(m)/tol-$(t),3,$(BED_BASIC)))) \
  $(call bed_runs,$(PLAIN)/method-merson/tol-0.01,3,$(BED_BASIC)) \
  $(foreach t,$(MULTIRATE_TOLERANCES),\
    $(call bed_runs,$(PLAIN)/method-multirate/tol-$(t),3,$(BED_BASIC))) \
  $(foreach t,$(RKC_TOLERANCES),\
    $(call bed_runs,$(PLAIN)/method-rkc/tol-$(t),3,$(BED_BASIC))) \
  $(foreach h,$(VERLET_STEPS),\
    $(call bed_runs,$(PLAIN)/method-verlet/step-$(h),3,$(BED_VERLET)))

settling: $(F)/precision-settling.svg $(F)/precision-settling.md ## error of a bed's fraction against CPU time: which method to take
$(BEDS)/settling.tsv: plots/precision/settling.awk plots/precision/settling.mk \
  $(SETTLING_FULL) $(SETTLING_PLAIN)
	awk -f $< $(SETTLING_FULL) $(SETTLING_PLAIN) > $@
$(BEDS)/panels.tsv: plots/precision/panels.awk $(BEDS)/settling.tsv
	awk -f $^ > $@
$(F)/precision-settling.svg: plots/precision/settling.gp plots/style.gp \
  $(BEDS)/panels.tsv
	$(draw)
$(F)/precision-settling.md: $(BEDS)/settling.tsv

# Seed by seed: rkc at its default, and Merson with two tolerances
SEED_RUNS := $(foreach m,merson/tol-0.01 merson/tol-0.1 rkc/tol-5e-4,\
  $(call bed_runs,$(FULL)/method-$(m),$(if $(filter rkc/%,$(m)),3,1),$(BED_RKC)))
seeds: $(F)/precision-seeds.md ## rkc beside Merson, seed by seed
	@cat $<
$(F)/precision-seeds.md: plots/precision/seeds.awk plots/precision/settling.mk \
  $(SEED_RUNS)
	@mkdir -p $(@D)
	awk -f $< $(SEED_RUNS) > $@

precision: settling $(F)/precision-seeds.md
.PHONY: settling seeds
