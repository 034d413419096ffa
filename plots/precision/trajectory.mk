# SPDX-License-Identifier: GPL-3.0-or-later
# Trajectories of falling spheres, by the rules of precision.mk; each over the
# time in which two tight runs agree (how long that is: horizon). Steps are
# limited by travel as in settle.
SET_trajectory-8 := trajectory --travel 1 --time 2
TITLE_trajectory-8 := 2 × 2 × 2 spheres with friction, 2 s
SET_trajectory-8-basic := trajectory --travel 1 --friction 0 --time 2
TITLE_trajectory-8-basic := 2 × 2 × 2 spheres, no friction, 2 s
SET_trajectory-200 := trajectory --travel 1 --count 200 --time 0.8
TITLE_trajectory-200 := 200 spheres with friction, 0.8 s
SET_trajectory-200-basic := trajectory --travel 1 --count 200 --friction 0 --time 1
TITLE_trajectory-200-basic := 200 spheres, no friction, 1 s
TRAJECTORIES := trajectory-8 trajectory-8-basic \
  $(if $(QUICK),,trajectory-200 trajectory-200-basic)
YLABEL_position := error of position (diameters)
$(foreach s,$(TRAJECTORIES),$(eval STEP_$(s) := 4e-4)\
  $(eval ERRORS_$(s) := position)$(eval ORDERS_$(s) := 1 2 4))
$(foreach m,$(EMBEDDED) rkc msbdf,$(foreach s,$(TRAJECTORIES),\
  $(eval RUNGS_$(s)-$(m) := 1e-1 1e-2 1e-3 1e-4 1e-5 1e-6 \
    $(if $(filter trajectory-8%,$(s)),1e-7 1e-8))))
# msbdf has dense matrices of 1800 unknowns
TRAJECTORY_METHODS := $(EMBEDDED) rkc verlet
METHODS_trajectory-8 := $(if $(QUICK),merson rk8pd rkc verlet)
METHODS_trajectory-8-basic := $(METHODS_trajectory-8)
METHODS_trajectory-200 := $(TRAJECTORY_METHODS)
METHODS_trajectory-200-basic := $(TRAJECTORY_METHODS)
$(call precision_rules,$(TRAJECTORIES))
trajectories: $(call precision_charts,$(TRAJECTORIES)) ## error of falling spheres against work, and its growth over time

# Distance of runs from a sharp one over time, and of two sharp ones from each
# other. Beds of settle, whose frames are interpolated between steps.
HORIZON_METHODS := again merson rkc multirate verlet # beside the reference
HORIZON_reference := --method rk8pd --control standard --tol 1e-10
HORIZON_again := --method rk8pd --control standard --tol 1e-9
HORIZON_merson := --method merson
HORIZON_rkc := --method rkc
HORIZON_multirate := --method multirate
HORIZON_verlet := --method verlet --step 2.5e-5
HORIZON_SIZE := --lmax 0.2 $(if $(QUICK),--count 32 --time 0.8 --frames 41,\
  --time 3 --frames 151)
HORIZON := $(PRECISION_DATA)/horizon
define horizon_run
$(HORIZON)/$(1)-$(2).bed: | $(B)/settle
	@mkdir -p $$(@D)
	$(B)/settle --quiet --model $(1) $(HORIZON_$(2)) $(HORIZON_SIZE) > $$@
endef
HORIZON_RUNS := $(foreach v,basic rotation,\
  $(foreach m,reference $(HORIZON_METHODS),$(HORIZON)/$(v)-$(m).bed))
$(foreach v,basic rotation,$(foreach m,reference $(HORIZON_METHODS),\
  $(eval $(call horizon_run,$(v),$(m)))))
$(HORIZON).tsv: plots/precision/horizon.awk $(HORIZON_RUNS)
	for v in basic rotation; do \
	  for m in $(HORIZON_METHODS); do \
	    awk -v variant=$$v -v method=$$m -f $< $(HORIZON)/$$v-reference.bed \
	      $(HORIZON)/$$v-$$m.bed || exit; \
	  done; \
	done > $@
$(F)/precision-horizon.svg: plots/precision/horizon.gp plots/style.gp \
  $(HORIZON).tsv
	$(draw)
trajectories: $(F)/precision-horizon.svg
precision: trajectories
.PHONY: trajectories
