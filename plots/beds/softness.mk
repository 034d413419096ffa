# SPDX-License-Identifier: GPL-3.0-or-later
# How soft contacts may be and how far friction may creep: the paper's box with
# contacts that touch on average (F0 by the recipe of settle --overlap), kappa r
# from 15 to 480, v_min from 1e-2 to 1e-4 m/s, with and without friction, at 8 s
# and at rest; some 7 minutes of CPU time, of which one bed takes 2.
SOFT := $(D)/soft
SOFT_KAPPAS := 300 600 $(if $(QUICK),,150 1200 2400 4800)
SOFT_CREEPING := 300 600 $(if $(QUICK),,150)
SOFT_LMAX_150 := 0.1
SOFT_LMAX_300 := 0.05
SOFT_LMAX_600 := 0.025
SOFT_LMAX_1200 := 0.0125
SOFT_LMAX_2400 := 0.00625
SOFT_LMAX_4800 := 0.003125
SOFT_SEEDS := 1 2 $(if $(QUICK),,3 4 5)
SOFT_FEW := 1 2 $(if $(QUICK),,3)
SOFT_SMALL := --count 40 --base 0.5,0.5
SOFT_OPTIONS := $(if $(QUICK),$(SOFT_SMALL))
# a bed that rests later than that is measured then, by exit status 5
SOFT_REST := until-rest/time-$(if $(QUICK),20,200)
# $(call soft_runs,SETTINGS,KAPPAS,SEEDS)
soft_runs = $(foreach k,$(2),$(foreach s,$(3),\
  $(SOFT)/kappa-$(k)/f0-36.7/lmax-$(SOFT_LMAX_$(k))/$(1)/seed-$(s).tsv))
SOFT_CREEP := $(if $(QUICK),,3e-3 3e-4)
SOFT_RUNS := \
  $(call soft_runs,model-basic/$(SOFT_REST),$(SOFT_KAPPAS),$(SOFT_SEEDS)) \
  $(call soft_runs,friction-0.2/vmin-1e-2,$(SOFT_KAPPAS),$(SOFT_SEEDS)) \
  $(call soft_runs,friction-0.2/vmin-1e-3,$(SOFT_CREEPING),$(SOFT_FEW)) \
  $(call soft_runs,friction-0.2/vmin-1e-2/$(SOFT_REST),$(SOFT_KAPPAS),$(SOFT_SEEDS)) \
  $(foreach v,$(SOFT_CREEP),\
    $(call soft_runs,friction-0.2/vmin-$(v),600,$(SOFT_FEW))) \
  $(if $(QUICK),,$(call soft_runs,friction-0.2/vmin-1e-4,600,1))
# The other sources of error, in the paper's bed: walls, with the base; the
# tolerance; not at rest, without friction; and chance.
SOFT_BASES := $(if $(QUICK),0.5 0.7,1 1.41 2 2.83 4)
SOFT_BASE_0.5 := base-0.5,0.5/count-40
SOFT_BASE_0.7 := base-0.7,0.7/count-80
SOFT_BASE_1 := base-1,1/count-200
SOFT_BASE_1.41 := base-1.41,1.41/count-400
SOFT_BASE_2 := base-2,2/count-800
SOFT_BASE_2.83 := base-2.83,2.83/count-1600
SOFT_BASE_4 := base-4,4/count-3200
SOFT_TOLS := 0.02 2e-3 $(if $(QUICK),,0.2 1e-4)
SOFT_MANY := $(if $(QUICK),,$(shell seq 11 40)) # for the deviation over seeds
SOFT_TIMES := 2 3 $(if $(QUICK),,4 6 8 16 40)
BUDGET_RUNS := \
  $(foreach b,$(SOFT_BASES),$(SOFT_FEW:%=$(SOFT)/$(SOFT_BASE_$(b))/seed-%.tsv)) \
  $(foreach t,$(SOFT_TOLS),$(SEEDS:%=$(SOFT)/tol-$(t)/seed-%.tsv)) \
  $(SOFT_MANY:%=$(SOFT)/tol-2e-3/seed-%.tsv) \
  $(foreach t,$(SOFT_TIMES),\
    $(SOFT_SEEDS:%=$(SOFT)/model-basic/time-$(t)/seed-%.tsv))
# Without side walls: 300 spheres on 5 by 5 diameters with periodic sides, of which
# 6 diameters of height are measured; friction 0.174 is a Coulomb coefficient of 0.3
# at rest.
SOFT_BULK := --base 1,1 --periodic xy --count $(if $(QUICK),100 --time 2,300)
SOFT_BULK_BOX := --box 0,1,0,1,0.4,$(if $(QUICK),0.6,1.6)
SOFT_BULK_OVERLAPS := 0.0245 0.01225 $(if $(QUICK),,0.006125)
BULK_RUNS := $(foreach o,$(SOFT_BULK_OVERLAPS),$(foreach s,$(SOFT_FEW),\
  $(SOFT)/bulk/model-basic/overlap-$(o)/seed-$(s).tsv \
  $(SOFT)/bulk/friction-0.174/vmin-1.25e-3/overlap-$(o)/seed-$(s).tsv))
$(SOFT)/bulk/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	B=$(B) BOX='$(SOFT_BULK_BOX)' plots/beds/soft.sh $* $(SOFT_BULK) > $@
SOFT_ALL := $(sort $(SOFT_RUNS) $(BUDGET_RUNS) $(BULK_RUNS))

$(SOFT)/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	B=$(B) plots/beds/soft.sh $* $(if $(findstring base-,$*),,$(SOFT_OPTIONS)) > $@
$(SOFT)/groups.tsv $(SOFT)/limits.tsv $(SOFT)/budget.tsv: $(SOFT)/%.tsv: \
  plots/beds/softness.awk $(SOFT_ALL)
	awk -v what=$* -f $< $(SOFT_ALL) > $@
softness: $(F)/hardness.svg $(F)/budget.svg $(F)/softness.md $(F)/softness-limits.md ## softness and creep: fraction, contacts, the error budget (7 minutes)
	@cat $(F)/softness.md $(F)/softness-limits.md
$(F)/hardness.svg: plots/beds/hardness.gp plots/style.gp $(SOFT)/groups.tsv \
  $(SOFT)/limits.tsv
	$(draw)
$(F)/budget.svg: plots/beds/budget.gp plots/style.gp $(SOFT)/budget.tsv
	$(draw)
$(F)/softness.md: $(SOFT)/groups.tsv
$(F)/softness-limits.md: $(SOFT)/limits.tsv

.PHONY: softness
