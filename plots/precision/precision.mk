# SPDX-License-Identifier: GPL-3.0-or-later
# Work-precision charts of small scenes: every stepper over a ladder of
# tolerances, verlet over fixed steps. Data are one file per run (set x method)
# under build/data/precision; a set's runs make one chart for each of its errors
# and each kind of cost. QUICK=1: fewer rungs, sets and charts. Other .mk files
# add what they chart by a line `precision: TARGET`.
PRECISION_DATA := $(D)/precision

# The standard control with its norm by unknown, the same for all, so that
# steppers are compared and not controls.
PRECISION_TIMED := $(if $(QUICK),--timed 0)
ADAPTIVE := $(EMBEDDED) rkc msbdf
FIXED := $(EMBEDDED) rkc verlet

RUNGS := $(if $(QUICK),1e-3 1e-5 1e-7,\
  1e-1 1e-2 1e-3 1e-4 1e-5 1e-6 1e-7 1e-8 1e-9 1e-10 1e-11 1e-12 1e-13)
RUNGS_rkc := $(filter-out 1e-12 1e-13,$(RUNGS))
RUNGS_msbdf := $(filter-out 1e-13,$(RUNGS))
STEPS_HALVED := $(if $(QUICK),6,8)

# Sets: what precision is told, the first of verlet's steps, which is halved so
# many times, methods if not all, errors to chart, and the title.
SET_bounce-30 := bounce --kappa 30
SET_bounce-150 := bounce --kappa 150
SET_bounce-500 := bounce --kappa 500
TITLE_bounce-30 := Rebound, κ = 30 m^{-1}, e = 1
TITLE_bounce-150 := Rebound, κ = 150 m^{-1}, e = 1
TITLE_bounce-500 := Rebound, κ = 500 m^{-1}, e = 1
SET_bounce-30-inelastic := bounce --kappa 30 --restitution 0.70710678118654757
SET_bounce-150-inelastic := bounce --kappa 150 --restitution 0.70710678118654757
SET_bounce-500-inelastic := bounce --kappa 500 --restitution 0.70710678118654757
TITLE_bounce-30-inelastic := Rebound, κ = 30 m^{-1}, e^2 = 1/2
TITLE_bounce-150-inelastic := Rebound, κ = 150 m^{-1}, e^2 = 1/2
TITLE_bounce-500-inelastic := Rebound, κ = 500 m^{-1}, e^2 = 1/2
# The last elastic one again, no step further than 1/κ: what keeps loose steps
# from ending deep in the wall, and what that costs
SET_bounce-500-capped := bounce --kappa 500 --travel 1
TITLE_bounce-500-capped := Rebound, κ = 500 m^{-1}, e = 1, travel of 1/κ
METHODS_bounce-500-capped := $(ADAPTIVE)
BOUNCES := bounce-500-capped $(foreach k,30 150 500,\
  bounce-$(k) bounce-$(k)-inelastic)
$(foreach b,$(BOUNCES),$(eval STEP_$(b) := 4e-4)\
  $(eval ERRORS_$(b) := time energy)$(eval ORDERS_$(b) := 2 5))

SET_collision := collision
STEP_collision := 4e-3
ERRORS_collision := gap velocity
ORDERS_collision := 2 5 8
TITLE_collision := Elastic collision with a wall, 1 m/s

SET_restitution := restitution --speed 0.1
STEP_restitution := 1.6e-2
ERRORS_restitution := speed
ORDERS_restitution := 1 2 5
TITLE_restitution := Restitution, e = 0.4, 0.1 m/s
SET_restitution-fast := restitution --speed 5
STEP_restitution-fast := 4e-4
ERRORS_restitution-fast := speed
ORDERS_restitution-fast := 1 2 5
TITLE_restitution-fast := Restitution, e = 0.4, 5 m/s

# Lines of spheres: short is one passage of collisions, long hundreds
SET_toda-6 := toda-open --count 6 --time 0.2
SET_toda-6-long := toda-closed --count 6 --time 10
SET_toda-50 := toda-open --count 50 --time 0.5
SET_toda-50-long := toda-closed --count 50 --time 5
TITLE_toda-6 := Toda lattice, 6 spheres, 0.2 s
TITLE_toda-6-long := Toda lattice, 6 spheres in a box, 10 s
TITLE_toda-50 := Toda lattice, 50 spheres, 0.5 s
TITLE_toda-50-long := Toda lattice, 50 spheres in a box, 5 s
TODAS := toda-6 toda-6-long toda-50 toda-50-long
$(foreach t,$(TODAS),$(eval STEP_$(t) := 1.6e-3)\
  $(eval ERRORS_$(t) := eigenvalue)$(eval ORDERS_$(t) := 2 4 8))
RUNGS_toda-6-long-rkc := 1e-1 1e-2 1e-3 1e-4 1e-5 1e-6 1e-7
RUNGS_toda-50-long-rkc := 1e-1 1e-2 1e-3 1e-4 1e-5
RUNGS_toda-50-rkc := 1e-1 1e-2 1e-3 1e-4 1e-5 1e-6 1e-7 1e-8
# msbdf has dense matrices of 300 unknowns: minutes
METHODS_toda-50 := $(EMBEDDED) rkc verlet
METHODS_toda-50-long := $(EMBEDDED) rkc verlet

# At fixed steps from STEADY on the creep is stable
STEADY_rolling := 4e-4
STEADY_transition := 4e-4
SET_rolling := rolling
STEP_rolling := 1.6e-3
ERRORS_rolling := velocity
ORDERS_rolling := 1 2 3
TITLE_rolling := Sliding to rolling: velocity at 0.1 s
SET_transition := transition
STEP_transition := 1.6e-3
ERRORS_transition := time
ORDERS_transition := 1 2 3
TITLE_transition := Sliding to rolling: time of half full friction

SET_exponential := exponential
TITLE_exponential := Exponential repulsion, e = 1
SET_exponential-inelastic := exponential --restitution 0.4
TITLE_exponential-inelastic := Exponential repulsion, e = 0.4
SET_spring := spring
TITLE_spring := Linear spring, e = 1
SET_walton-braun := walton-braun
TITLE_walton-braun := Walton and Braun, e = 0.4
LAWS := exponential exponential-inelastic spring walton-braun
$(foreach l,$(LAWS),$(eval STEP_$(l) := 6.4e-3)\
  $(eval ERRORS_$(l) := gap)$(eval ORDERS_$(l) := 2 5 8))

# The same with fixed steps for all: the order that is left
STEPPED := rolling transition $(LAWS)
define stepped_set
SET_$(1)-steps := $$(SET_$(1))
STEP_$(1)-steps := $$(or $$(STEADY_$(1)),$$(STEP_$(1)))
METHODS_$(1)-steps := $$(FIXED)
FIXED_$(1)-steps := yes
ERRORS_$(1)-steps := $$(ERRORS_$(1))
ORDERS_$(1)-steps := $$(ORDERS_$(1))
TITLE_$(1)-steps := $$(TITLE_$(1))
endef
$(foreach s,$(STEPPED),$(eval $(call stepped_set,$(s))))

YLABEL_time := error of time (s)
YLABEL_energy := relative error of energy
YLABEL_gap := error of gap (m)
YLABEL_velocity := error of velocity (m/s)
YLABEL_speed := relative error of speed
YLABEL_eigenvalue := relative drift of eigenvalues
XLABEL_evaluations := evaluations
XLABEL_cpu_seconds := CPU time (s)
XLABEL_step := step (s)

PRECISION_ALL := $(BOUNCES) collision restitution restitution-fast $(TODAS) \
  rolling transition $(LAWS) $(STEPPED:%=%-steps)
PRECISION_QUICK := bounce-150 collision restitution toda-6 rolling transition \
  $(LAWS) rolling-steps $(LAWS:%=%-steps)
PRECISION_SETS := $(if $(QUICK),$(PRECISION_QUICK),$(PRECISION_ALL))

# $(call ladder,SET,METHOD)
halved = $(shell awk 'BEGIN { h = $(1); for (k = 0; k <= $(2); k++) \
  { printf " --step-rung %.4g", h; h /= 2 } }')
ladder = $(if $(or $(FIXED_$(1)),$(filter verlet,$(2))),\
  $(call halved,$(STEP_$(1)),$(STEPS_HALVED)),\
  $(addprefix --rung ,$(or $(if $(QUICK),,$(RUNGS_$(1)-$(2))),$(RUNGS_$(2)),\
  $(RUNGS))))
methods = $(or $(METHODS_$(1)),$(ADAPTIVE) verlet)

# $(call precision_run,SET,METHOD)
define precision_run
$(PRECISION_DATA)/$(1)/$(2).tsv: $(B)/precision
	@mkdir -p $$(@D)
	$(B)/precision $(SET_$(1)) --method $(2) $$(call ladder,$(1),$(2)) \
	  $(PRECISION_TIMED) > $$@
endef
# $(call precision_set,SET): its runs as blocks of one file
define precision_set
$(foreach m,$(call methods,$(1)),$(eval $(call precision_run,$(1),$(m))))
$(PRECISION_DATA)/$(1).tsv: $(patsubst %,$(PRECISION_DATA)/$(1)/%.tsv,\
  $(call methods,$(1)))
	awk 'FNR == 1 && NR > 1 { print "\n" } 1' $$^ > $$@
endef
# $(call precision_chart,SET,ERROR,COST)
define precision_chart
$(F)/precision-$(1)-$(2)-$(3).svg: plots/precision/precision.gp \
  plots/style.gp $(PRECISION_DATA)/$(1).tsv
	@mkdir -p $$(@D)
	for end in svg png; do \
	  $(GNUPLOT) -c $$< $$(filter %.tsv,$$^) $$(basename $$@).$$$$end \
	  '$$(TITLE_$(1))' $(3) error_$(2) '$$(XLABEL_$(3))' \
	  '$$(YLABEL_$(2))' '$$(ORDERS_$(1))' || exit; \
	done
endef
# $(call precision_costs,SET) and $(call precision_charts,SETS): what they make
precision_costs = $(if $(FIXED_$(1)),step,evaluations cpu_seconds)
precision_charts = $(foreach s,$(1),$(foreach e,$(ERRORS_$(s)),\
  $(foreach c,$(call precision_costs,$(s)),$(F)/precision-$(s)-$(e)-$(c).svg)))
# $(call precision_rules,SETS)
precision_rules = $(foreach s,$(1),$(eval $(call precision_set,$(s)))\
  $(foreach e,$(ERRORS_$(s)),$(foreach c,$(call precision_costs,$(s)),\
  $(eval $(call precision_chart,$(s),$(e),$(c))))))
$(call precision_rules,$(PRECISION_SETS))

# Tables: work for given errors, orders that are left, rejected steps
PRECISION_QUICK_FIGURES := \
  $(F)/precision-bounce-150-time-evaluations.svg \
  $(F)/precision-rolling-steps-velocity-step.svg
PRECISION_BY_STEP := $(filter %-steps,$(PRECISION_SETS))
$(F)/precision-work.md: plots/precision/work.awk plots/precision/precision.mk \
  $(patsubst %,$(PRECISION_DATA)/%.tsv,$(filter-out %-steps,$(PRECISION_SETS)))
	@mkdir -p $(@D)
	awk -f $(filter %.awk %.tsv,$^) > $@
$(F)/precision-orders.md: plots/precision/orders.awk \
  plots/precision/precision.mk $(patsubst %,$(PRECISION_DATA)/%.tsv,\
    $(PRECISION_BY_STEP:%-steps=%) $(PRECISION_BY_STEP))
	@mkdir -p $(@D)
	awk -f $(filter %.awk %.tsv,$^) > $@

# The laws side by side
$(F)/precision-contrast.svg: plots/precision/contrast.gp plots/style.gp \
  $(LAWS:%=$(PRECISION_DATA)/%-steps.tsv)
	$(draw)

precision: precision-scenes ## charts of accuracy against work
precision-scenes: $(F)/precision-work.md $(F)/precision-orders.md \
  $(F)/precision-contrast.svg \
  $(if $(QUICK),$(PRECISION_QUICK_FIGURES),\
  $(call precision_charts,$(PRECISION_SETS)))
.PHONY: precision precision-scenes
