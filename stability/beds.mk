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

$(BEDS)/map.tsv: $(MAP_RUNS) stability/map.sh
	stability/map.sh $(MAP_RUNS) > $@
