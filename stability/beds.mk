# SPDX-License-Identifier: GPL-3.0-or-later
# Where beds go wrong: a map of outcomes over tolerance, kappa and variant; the
# stiffest spheres coming to rest; the fraction against step and tolerance. Runs
# are those of precision/beds.mk, one file each, named by settle's options.

# The map, $(call map_runs,MODEL,METHOD,SETTINGS,SEEDS,MORE). Softer spheres reach
# further: the cut at lmax grows with kappa so that its jump stays below 5e-4 N.
MAP_REACH_30 := /lmax-0.33
MAP_REACH_60 := /lmax-0.17
map_path = $(BEDS)/model-$(1)/method-$(2)/$(3)/kappa-$(4)$(5)/$(MAP_END)/seed-$(6).tsv
map_runs = $(foreach k,$(MAP_KAPPAS),$(foreach s,$(3),$(foreach n,$(4),\
  $(call map_path,$(1),$(2),$(s),$(k),$(MAP_REACH_$(k))$(5),$(n)))))
# as it is in the paper for all kappa
map_short = $(foreach k,$(MAP_KAPPAS),$(foreach s,$(3),$(foreach n,$(4),\
  $(call map_path,$(1),$(2),$(s),$(k),$(if $(MAP_REACH_$(k)),/lmax-0.1),$(n)))))
ifeq ($(QUICK),)
MAP_KAPPAS := 30 60 150 300 500 1000
MAP_DELTAS := tol-10 tol-1 tol-0.1 tol-0.01
MAP_DEAR_DELTAS := tol-1 tol-0.1
MAP_TOLERANCES := tol-1 tol-0.1 tol-0.01 tol-1e-3 tol-1e-4
MAP_STEPS := step-1e-3 step-4e-4 step-2e-4 step-1e-4 step-5e-5
MAP_SEEDS := 1 2
MAP_END := time-4/frames-41
else
MAP_KAPPAS := 150 500
MAP_DELTAS := tol-0.1
MAP_DEAR_DELTAS :=
MAP_TOLERANCES := tol-1e-3
MAP_STEPS := step-1e-3
MAP_SEEDS := 1
MAP_END := frames-21
endif
MAP_SHORT := $(call map_short,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS))
MAP_BASIC := \
  $(call map_runs,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS)) \
  $(call map_runs,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS),/travel-0) \
  $(call map_runs,basic,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,basic,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS),/travel-0) \
  $(call map_runs,basic,verlet,$(MAP_STEPS),$(MAP_SEEDS)) $(MAP_SHORT)
MAP_RUNS := $(sort $(MAP_BASIC) \
  $(call map_runs,rotation,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,rotation,merson,$(MAP_DEAR_DELTAS),1) \
  $(call map_runs,rotation,verlet,$(MAP_STEPS),$(MAP_SEEDS)))
# several times what those take that end
$(MAP_BASIC): export LIMIT := 8

$(BEDS)/map.tsv: $(MAP_RUNS) stability/map.sh stability/beds.mk
	stability/map.sh $(MAP_RUNS) > $@

# The wrong bed: the runs of the settling with friction and rotation, Merson at
# fixed steps, and the two pairs that are too dear for more than one seed.
ifeq ($(QUICK),)
WRONG_RUNS := $(foreach h,4e-4 2e-4 1e-4 5e-5,\
    $(call bed_runs,$(full)/method-merson/step-$(h),0,4)) \
  $(foreach m,rkck rk8pd,$(foreach t,10 0.1,\
    $(call bed_runs,$(full)/method-$(m)/tol-$(t),0,1)))
endif
WRONG_BEDS := $(filter $(BEDS)/$(full)/% $(BEDS)/timed/$(full)/%,$(BED_RUNS)) \
  $(WRONG_RUNS)
$(BEDS)/wrong.tsv: $(WRONG_BEDS) precision/settling.awk stability/beds.mk
	awk -f precision/settling.awk $(WRONG_BEDS) > $@
$(BEDS)/slip.tsv: stability/slip.awk | $(B)/settle
	@mkdir -p $(@D)
	$(B)/settle --quiet $(BED_OPTIONS) | awk -f $< > $@
stability-wrong-bed: $(F)/stability-wrong-bed.svg ## where friction integrated badly melts the bed
$(F)/stability-wrong-bed.svg: $(BEDS)/wrong.tsv \
  $(BEDS)/slip.tsv plots/wrong-bed.gp plots/style.gp
	$(call draw,wrong-bed.gp,$(BEDS)/wrong.tsv $(BEDS)/slip.tsv,stability-wrong-bed)

stability-map: $(F)/stability-map.svg ## what became of beds by tolerance, kappa and variant
$(F)/stability-map.svg: $(BEDS)/map.tsv plots/map.gp \
  plots/style.gp
	$(call draw,map.gp,$<,stability-map)

# Does kappa = 500 vibrate? Kinetic energy per sphere over time of the variant
# without friction; outputs: steps no longer than the time between 400 outputs
# in 8 s, and no other limit, as in the author's program.
VIBRATION := $(BEDS)/vibration
VIBRATION_RUNS := 30-rkc 150-rkc 150-merson 500-rkc 500-merson 500-loose \
  500-outputs
VIBRATION_30-rkc := --kappa 30 --lmax 0.33
VIBRATION_150-rkc := --kappa 150
VIBRATION_150-merson := --kappa 150 --method merson
VIBRATION_500-rkc := --kappa 500
VIBRATION_500-merson := --kappa 500 --method merson
VIBRATION_500-loose := --kappa 500 --method merson --tol 10
VIBRATION_500-outputs := --kappa 500 --method merson --travel 0 --hmax 0.02005
define vibration_run
$(VIBRATION)/$(1).tsv: | $(B)/settle
	@mkdir -p $$(@D)
	$(B)/settle --quiet --model basic $(VIBRATION_$(1)) \
	  $(or $(BED_OPTIONS),--time 16) --frames 401 | \
	  awk -v run=$(1) -f stability/kinetic.awk > $$@
endef
$(foreach r,$(VIBRATION_RUNS),$(eval $(call vibration_run,$(r))))
$(VIBRATION).tsv: $(VIBRATION_RUNS:%=$(VIBRATION)/%.tsv)
	awk 'FNR == 1 && NR > 1 { print "\n" } 1' $^ > $@
stability-vibration: $(F)/stability-vibration.svg ## does kappa = 500 vibrate: kinetic energy over time
$(F)/stability-vibration.svg: $(VIBRATION).tsv \
  plots/vibration.gp plots/style.gp
	$(call draw,vibration.gp,$<,stability-vibration)

stability: stability-map stability-wrong-bed stability-vibration
.PHONY: stability-map stability-wrong-bed stability-vibration
