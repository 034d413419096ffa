# SPDX-License-Identifier: GPL-3.0-or-later
# The paper's figures and tables. A figure is two rules: data by a program with
# its exact arguments, and a picture by gnuplot. Data are under build/data, one
# file a run, so that a stopped make goes on where it was; charts and tables
# under build/figures.
# QUICK=1: what the studies have of small versions, in directories of their own.
D := $(B)/$(if $(QUICK),quick/)data
F := $(B)/$(if $(QUICK),quick/)figures
SETTLE := $(B)/settle --quiet

# $(call draw,SCRIPT,INPUTS,NAME): both formats
define draw
@mkdir -p $(F)
gnuplot -c plots/$(1) $(2) $(F)/$(3).svg
gnuplot -c plots/$(1) $(2) $(F)/$(3).png
endef

figures: table4.1 fig4.1 fig4.2 fig4.3 fig4.3-rkc fig4.4 fig4.5 table-costs kappa ## every figure and table of the paper

# Bounce test
RESTITUTIONS := 1 0.70710678118654757 0.4
fig4.1: $(F)/fig4.1.svg ## trajectories of a bouncing sphere
$(F)/fig4.1.svg: $(RESTITUTIONS:%=$(D)/bounce-%.tsv) plots/fig4.1.gp plots/style.gp
	$(call draw,fig4.1.gp,$(RESTITUTIONS:%=$(D)/bounce-%.tsv),fig4.1)
$(D)/bounce-%.tsv: $(B)/bounce
	@mkdir -p $(D)
	$(B)/bounce --restitution $* --samples 2001 > $@

table4.1: $(F)/table4.1.md ## rebound times beside the paper's
	@cat $<
$(F)/table4.1.md: plots/table4.1.sh $(B)/bounce
	@mkdir -p $(F)
	B=$(B) plots/table4.1.sh > $@

# The three variants with the paper's method: one run makes bed, log and stats
VARIANTS := basic friction rotation
PAPER := --method merson --control paper --tol 0.1
$(D)/paper-%.bed $(D)/paper-%.log $(D)/paper-%.stats &: $(B)/settle
	@mkdir -p $(D)
	$(SETTLE) --model $* $(PAPER) --log $(D)/paper-$*.log \
	  --stats $(D)/paper-$*.stats > $(D)/paper-$*.bed
$(D)/start.bed: $(B)/settle
	@mkdir -p $(D)
	$(SETTLE) --time 0 > $@

BEDS := $(D)/start.bed $(VARIANTS:%=$(D)/paper-%.bed)
fig4.2: $(F)/fig4.2.png ## the 200 spheres: start, and three variants at 8 s
$(F)/fig4.2.png: $(BEDS) plots/fig4.2.gp plots/balls.gp plots/style.gp
	@mkdir -p $(F)
	gnuplot -c plots/fig4.2.gp $(BEDS) $@

LOGS := $(VARIANTS:%=$(D)/paper-%.log)
fig4.4: $(F)/fig4.4.svg ## accepted steps against time
$(F)/fig4.4.svg: $(LOGS) plots/fig4.4.gp plots/style.gp
	$(call draw,fig4.4.gp,$(LOGS),fig4.4)

# Volume fraction over time, 10 seeds a variant. The paper does not print its
# second friction coefficient; 0.1 is our assumption.
SEEDS := 1 2 3 4 5 6 7 8 9 10
ENSEMBLES := basic friction rotation-0.2 rotation-0.1
OPTIONS_basic := --model basic
OPTIONS_friction := --model friction
OPTIONS_rotation-0.2 := --model rotation --friction 0.2
OPTIONS_rotation-0.1 := --model rotation --friction 0.1
# $(call ensemble,NAME,METHOD OPTIONS): fractions of every variant and seed
define ensemble_run
$(D)/$(1)/$(2)-$(3).tsv: $(B)/settle $(B)/analyze
	@mkdir -p $(D)/$(1)
	$(SETTLE) $$(OPTIONS_$(2)) --seed $(3) $(4) --frames 400 \
	  --stats $(D)/$(1)/$(2)-$(3).stats | $(B)/analyze > $$@
endef
define ensemble
$(foreach e,$(ENSEMBLES),$(foreach s,$(SEEDS),\
	$(eval $(call ensemble_run,$(1),$(e),$(s),$(2)))))
$(D)/$(1)/ranges.tsv: $(foreach e,$(ENSEMBLES),$(SEEDS:%=$(D)/$(1)/$(e)-%.tsv)) \
  plots/ranges.awk
	for e in $(ENSEMBLES); do \
	  awk -v variant="$$$$e" -f plots/ranges.awk $(D)/$(1)/$$$$e-*.tsv || exit; \
	done > $$@
endef
$(eval $(call ensemble,fraction,$(PAPER)))

fig4.3: $(F)/fig4.3.svg ## fraction in [0,1]^3 over time, 10 seeds a variant
$(F)/fig4.3.svg: $(D)/fraction/ranges.tsv plots/fig4.3.gp plots/style.gp
	$(call draw,fig4.3.gp,$(D)/fraction/ranges.tsv,fig4.3)

# The same figure by rkc, and how long each took
$(eval $(call ensemble,fraction-rkc,--method rkc))
fig4.3-rkc: $(F)/fig4.3-rkc.svg $(F)/fig4.3-rkc.md ## fig4.3 by rkc, beside merson
	@cat $(F)/fig4.3-rkc.md
$(F)/fig4.3-rkc.svg: $(D)/fraction-rkc/ranges.tsv plots/fig4.3.gp plots/style.gp
	$(call draw,fig4.3.gp,$(D)/fraction-rkc/ranges.tsv,fig4.3-rkc)
$(F)/fig4.3-rkc.md: $(D)/fraction/ranges.tsv $(D)/fraction-rkc/ranges.tsv plots/compare.sh
	@mkdir -p $(F)
	plots/compare.sh $(D) merson:fraction rkc:fraction-rkc > $@

# Speed-up over threads: the first simulated second, the busiest, three runs
fig4.5: $(F)/fig4.5.svg ## speed-up and parallel efficiency
$(F)/fig4.5.svg: $(D)/speedup.tsv plots/fig4.5.gp plots/style.gp
	$(call draw,fig4.5.gp,$(D)/speedup.tsv,fig4.5)
$(D)/speedup.tsv: plots/speedup.sh $(B)/settle
	@mkdir -p $(D)
	B=$(B) plots/speedup.sh > $@

# Evaluations, steps and CPU seconds by variant and method
METHODS := merson dopri5 rkf45 rkck rk8pd
table-costs: $(F)/table-costs.md ## evaluations, steps, CPU seconds by variant and method
	@cat $<
COSTS := $(foreach v,$(VARIANTS),$(foreach m,$(METHODS),$(D)/costs/$(v)-$(m).tsv))
define cost_run
$(D)/costs/$(1)-$(2).tsv: $(B)/settle $(B)/analyze
	@mkdir -p $(D)/costs
	$(SETTLE) --model $(1) --method $(2) --control paper --tol 0.1 \
	  --stats $(D)/costs/$(1)-$(2).stats | $(B)/analyze > $$@
endef
$(foreach v,$(VARIANTS),$(foreach m,$(METHODS),$(eval $(call cost_run,$(v),$(m)))))
$(F)/table-costs.md: $(COSTS) plots/table-costs.sh
	@mkdir -p $(F)
	plots/table-costs.sh $(COSTS) > $@

# The text's study of kappa: fraction and residual motion
KAPPAS := 30 150 500
kappa: $(F)/kappa.md ## kappa = 30, 150, 500: fraction and residual motion
	@cat $<
$(D)/kappa-%.tsv $(D)/kappa-%.log &: $(B)/settle $(B)/analyze
	@mkdir -p $(D)
	$(SETTLE) --model basic --kappa $* $(PAPER) --frames 9 \
	  --log $(D)/kappa-$*.log | $(B)/analyze > $(D)/kappa-$*.tsv
$(F)/kappa.md: $(KAPPAS:%=$(D)/kappa-%.tsv) plots/kappa.sh
	@mkdir -p $(F)
	plots/kappa.sh $(KAPPAS:%=$(D)/kappa-%) > $@

.PHONY: figures fig4.1 table4.1 fig4.2 fig4.3 fig4.3-rkc fig4.4 fig4.5 table-costs \
  kappa
