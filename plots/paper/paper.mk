# SPDX-License-Identifier: GPL-3.0-or-later
# The paper's figures and tables.
figures: table4.1 fig4.1 fig4.2 fig4.3 fig4.3-rkc fig4.4 fig4.5 table-costs kappa ## every figure and table of the paper

# Bounce test
RESTITUTIONS := 1 0.70710678118654757 0.4
fig4.1: $(F)/fig4.1.svg ## trajectories of a bouncing sphere
$(F)/fig4.1.svg: plots/paper/fig4.1.gp plots/style.gp \
  $(RESTITUTIONS:%=$(D)/paper/bounce-%.tsv)
	$(draw)
$(D)/paper/bounce-%.tsv: $(B)/bounce
	@mkdir -p $(@D)
	$(B)/bounce --restitution $* --samples 2001 > $@

table4.1: $(F)/table4.1.md ## rebound times beside the paper's
	@cat $<
$(F)/table4.1.md: plots/paper/table4.1.sh $(B)/bounce
	@mkdir -p $(@D)
	B=$(B) $< > $@

# The three variants with the paper's method: one run makes bed, log and stats
VARIANTS := basic friction rotation
$(D)/paper/%.bed $(D)/paper/%.log $(D)/paper/%.stats: $(B)/settle
	@mkdir -p $(@D)
	$(SETTLE) --model $* $(PAPER) --log $(D)/paper/$*.log \
	  --stats $(D)/paper/$*.stats > $(D)/paper/$*.bed
$(D)/paper/start.tsv: $(B)/settle
	@mkdir -p $(@D)
	$(SETTLE) --time 0 > $@

fig4.2: $(F)/fig4.2.png ## the 200 spheres: start, and three variants at 8 s
$(F)/fig4.2.png: plots/paper/fig4.2.gp plots/draw/balls.gp plots/style.gp \
  $(D)/paper/start.tsv $(VARIANTS:%=$(D)/paper/%.bed)
	@mkdir -p $(@D)
	$(GNUPLOT) -c $< $(filter %.tsv %.bed,$^) $@

fig4.4: $(F)/fig4.4.svg ## accepted steps against time
$(F)/fig4.4.svg: plots/paper/fig4.4.gp plots/style.gp \
  $(VARIANTS:%=$(D)/paper/%.log)
	$(draw)

# Volume fraction over time, 10 seeds per variant. The paper does not print its
# second friction coefficient; 0.1 is our assumption.
ENSEMBLES := basic friction rotation-0.2 rotation-0.1
OPTIONS_basic := --model basic
OPTIONS_friction := --model friction
OPTIONS_rotation-0.2 := --model rotation --friction 0.2
OPTIONS_rotation-0.1 := --model rotation --friction 0.1
# $(call fraction_runs,FOLDER,METHOD OPTIONS): of every variant and seed
define fraction_run
$(D)/$(1)/$(2)-$(3).tsv: $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	$(SETTLE) $$(OPTIONS_$(2)) --seed $(3) $(4) --frames 400 \
	  --stats $$(@:.tsv=.stats) | $(B)/analyze $(BOX) > $$@
endef
define fraction_runs
$(foreach e,$(ENSEMBLES),$(foreach s,$(SEEDS),\
  $(eval $(call fraction_run,$(1),$(e),$(s),$(2)))))
$(D)/$(1)/ranges.tsv: plots/paper/ranges.awk \
  $(foreach e,$(ENSEMBLES),$(SEEDS:%=$(D)/$(1)/$(e)-%.tsv))
	for e in $(ENSEMBLES); do \
	  awk -v variant="$$$$e" -f $$< $(D)/$(1)/$$$$e-*.tsv || exit; \
	done > $$@
endef
$(eval $(call fraction_runs,fraction,$(PAPER)))
fig4.3: $(F)/fig4.3.svg ## fraction in [0,1]^3 over time, 10 seeds per variant
$(F)/fig4.3.svg: plots/paper/fig4.3.gp plots/style.gp $(D)/fraction/ranges.tsv
	$(draw)

# The same figure by rkc, and how long each took
$(eval $(call fraction_runs,fraction-rkc,--method rkc))
fig4.3-rkc: $(F)/fig4.3-rkc.svg $(F)/fig4.3-rkc.md ## fig4.3 by rkc, beside merson
	@cat $(F)/fig4.3-rkc.md
$(F)/fig4.3-rkc.svg: plots/paper/fig4.3.gp plots/style.gp \
  $(D)/fraction-rkc/ranges.tsv
	$(draw)
$(F)/fig4.3-rkc.md: plots/paper/compare.sh $(D)/fraction/ranges.tsv \
  $(D)/fraction-rkc/ranges.tsv
	@mkdir -p $(@D)
	$< $(D) merson:fraction rkc:fraction-rkc > $@

# Speed-up over threads: the first simulated second, the busiest, three runs
SPEEDUP_QUICK := COUNTS='40 80' TIME=0.2
fig4.5: $(F)/fig4.5.svg ## speed-up and parallel efficiency
$(F)/fig4.5.svg: plots/paper/fig4.5.gp plots/style.gp $(D)/speedup.tsv
	$(draw)
$(D)/speedup.tsv: plots/paper/speedup.sh $(B)/settle
	@mkdir -p $(@D)
	B=$(B) $(if $(QUICK),$(SPEEDUP_QUICK)) $< > $@

# Evaluations, steps and CPU seconds by variant and method
table-costs: $(F)/table-costs.md ## evaluations, steps, CPU seconds by variant and method
	@cat $<
define cost_run
$(D)/costs/$(1)-$(2).tsv: $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	$(SETTLE) --model $(1) --method $(2) --control paper --tol 0.1 \
	  --stats $$(@:.tsv=.stats) | $(B)/analyze $(BOX) > $$@
endef
$(foreach v,$(VARIANTS),$(foreach m,$(EMBEDDED),\
  $(eval $(call cost_run,$(v),$(m)))))
$(F)/table-costs.md: plots/paper/table-costs.sh \
  $(foreach v,$(VARIANTS),$(EMBEDDED:%=$(D)/costs/$(v)-%.tsv))
	@mkdir -p $(@D)
	$< $(filter %.tsv,$^) > $@

# The text's study of kappa: fraction and residual motion. With kappa = 30 centres
# leave the box, so that settle calls the bed a failure, status 4.
KAPPAS := 30 150 500
kappa: $(F)/kappa.md ## kappa = 30, 150, 500: fraction and residual motion
	@cat $<
$(D)/kappa-%.tsv $(D)/kappa-%.log: $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	{ $(SETTLE) --model basic --kappa $* $(PAPER) --frames 9 \
	  --log $(D)/kappa-$*.log || [ $$? = 4 ]; } | \
	  $(B)/analyze --allow-partial $(BOX) > $(D)/kappa-$*.tsv
$(F)/kappa.md: plots/paper/kappa.sh $(KAPPAS:%=$(D)/kappa-%.tsv)
	@mkdir -p $(@D)
	$< $(KAPPAS:%=$(D)/kappa-%) > $@

.PHONY: figures fig4.1 table4.1 fig4.2 fig4.3 fig4.3-rkc fig4.4 fig4.5 \
  table-costs kappa
