# SPDX-License-Identifier: GPL-3.0-or-later
# Outcomes of beds over tolerance, kappa and variant: beds by
# plots/beds/beds.mk. Softer spheres reach further: the cut at lmax grows as
# kappa falls, so that its jump stays below 5e-4 N.
MAP_KAPPAS := $(if $(QUICK),150 500,30 60 150 300 500 1000)
MAP_DELTAS := $(if $(QUICK),tol-0.1,tol-10 tol-1 tol-0.1 tol-0.01)
MAP_COSTLY_DELTAS := $(if $(QUICK),,tol-1 tol-0.1)
MAP_TOLERANCES := tol-1e-3 $(if $(QUICK),,tol-1 tol-0.1 tol-0.01 tol-1e-4)
MAP_STEPS := step-1e-3 $(if $(QUICK),,step-4e-4 step-2e-4 step-1e-4 step-5e-5)
MAP_SEEDS := 1
MAP_END := $(if $(QUICK),frames-21,time-4/frames-41)
MAP_REACH_30 := /lmax-0.33
MAP_REACH_60 := /lmax-0.17
# $(call map_runs,MODEL,METHOD,SETTINGS,SEEDS,MORE)
map_path = \
  $(BEDS)/model-$(1)/method-$(2)/$(3)/kappa-$(4)$(5)/$(MAP_END)/seed-$(6).tsv
map_runs = $(foreach k,$(MAP_KAPPAS),$(foreach s,$(3),$(foreach n,$(4),\
  $(call map_path,$(1),$(2),$(s),$(k),$(MAP_REACH_$(k))$(5),$(n)))))
# as it is in the paper for all kappa
map_short = $(foreach k,$(MAP_KAPPAS),$(foreach s,$(3),$(foreach n,$(4),\
  $(call map_path,$(1),$(2),$(s),$(k),$(if $(MAP_REACH_$(k)),/lmax-0.1),$(n)))))
MAP_SHORT := $(call map_short,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS))
MAP_BASIC := \
  $(call map_runs,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS)) \
  $(call map_runs,basic,merson,$(MAP_DELTAS),$(MAP_SEEDS),/travel-0) \
  $(call map_runs,basic,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,basic,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS),/travel-0) \
  $(call map_runs,basic,multirate,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,basic,verlet,$(MAP_STEPS),$(MAP_SEEDS)) $(MAP_SHORT)
MAP_RUNS := $(sort $(MAP_BASIC) \
  $(call map_runs,rotation,rkc,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,rotation,multirate,$(MAP_TOLERANCES),$(MAP_SEEDS)) \
  $(call map_runs,rotation,merson,$(MAP_COSTLY_DELTAS),1) \
  $(call map_runs,rotation,verlet,$(MAP_STEPS),$(MAP_SEEDS)))
# several times what those take that end
$(MAP_BASIC): export LIMIT := 8

stability-map: $(F)/stability-map.svg ## outcomes of beds by tolerance, kappa and variant
$(BEDS)/map.tsv: plots/stability/map.sh plots/stability/map.mk $(MAP_RUNS)
	$< $(MAP_RUNS) > $@
$(F)/stability-map.svg: plots/stability/map.gp plots/style.gp $(BEDS)/map.tsv
	$(draw)

stability: stability-map
.PHONY: stability-map
