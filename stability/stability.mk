# SPDX-License-Identifier: GPL-3.0-or-later
# Where methods fail: build/stability VERB, one file of data a run under
# build/data/stability, charts and tables under build/figures. QUICK=1: reduced
# ones. Other .mk files add what they chart by a line `stability: FILES`.
STABILITY_DATA := $(D)/stability
stability: ## where methods fail: every chart and table of it (QUICK=1: small ones)
stability: stability-regions stability-tunnel stability-drift stability-creep \
  stability-cut

# $(call stability_run,NAME,VERB AND OPTIONS): a rule for one file of data
define stability_run
$(STABILITY_DATA)/$(strip $(1)).tsv: $(B)/stability
	@mkdir -p $(STABILITY_DATA)
	$(B)/stability $(strip $(2)) > $$@
endef
# $(call stability_merge,FILES): one table of tables with the same columns
stability_merge = awk 'FNR == 1 { named = 0 } /^\#/ || !NF { next } \
  !named++ && any++ { next } { print }' $(1)

# Stability limits, and the regions that they lie on
$(eval $(call stability_run,limits,limits))
$(eval $(call stability_run,regions,regions --points $(if $(QUICK),61,241)))
stability-regions: $(addprefix $(F)/stability-,regions.svg limits.md) ## largest stable steps, measured and by theory
$(F)/stability-regions.svg: $(STABILITY_DATA)/regions.tsv \
  $(STABILITY_DATA)/limits.tsv plots/regions.gp plots/style.gp
	$(call draw,regions.gp,$(STABILITY_DATA)/regions.tsv $(STABILITY_DATA)/limits.tsv,stability-regions)
$(F)/stability-limits.md: $(STABILITY_DATA)/limits.tsv bench/markdown.awk
	@mkdir -p $(F)
	awk -f bench/markdown.awk $< > $@

# Missed collisions, without and with the cap on travel
STABILITY_PAIRS := merson dopri5 rkf45 rkck rk8pd
TUNNEL_RUNS := $(foreach m,$(STABILITY_PAIRS) rkc,$(foreach t,0 1,tunnel-$(m)-$(t)))
$(foreach m,$(STABILITY_PAIRS) rkc,$(foreach t,0 1,$(eval $(call stability_run,\
  tunnel-$(m)-$(t),tunnel --method $(m) --travel $(t) --runs $(if $(QUICK),4,50)))))
$(STABILITY_DATA)/tunnel.tsv: $(TUNNEL_RUNS:%=$(STABILITY_DATA)/%.tsv)
	$(call stability_merge,$^) > $@
stability-tunnel: $(addprefix $(F)/stability-,tunnel.svg tunnel.md) ## fast spheres out of free flight: who misses
$(F)/stability-tunnel.svg: $(STABILITY_DATA)/tunnel.tsv \
  plots/tunnel.gp plots/style.gp
	$(call draw,tunnel.gp,$<,stability-tunnel)
$(F)/stability-tunnel.md: $(STABILITY_DATA)/tunnel.tsv \
  stability/outcomes.awk bench/markdown.awk
	@mkdir -p $(F)
	awk -f stability/outcomes.awk $< | awk -f bench/markdown.awk > $@

# Energy, at equal cost: evaluations a bounce, and a second of the box
DRIFT_METHODS := $(STABILITY_PAIRS) rkc verlet
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,drift-bounce-$(m),\
  drift --method $(m) --cost 3000 --units $(if $(QUICK),30,1000))))
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,drift-box-$(m),\
  drift --scene box --method $(m) $(if $(QUICK),--count 10 --edge 0.8 \
  --cost 3000 --units 10,--cost 10000 --units 100))))
$(STABILITY_DATA)/drift-bounce.tsv: $(DRIFT_METHODS:%=$(STABILITY_DATA)/drift-bounce-%.tsv)
	$(call stability_merge,$^) > $@
$(STABILITY_DATA)/drift-box.tsv: $(DRIFT_METHODS:%=$(STABILITY_DATA)/drift-box-%.tsv)
	$(call stability_merge,$^) > $@
stability-drift: $(F)/stability-drift.svg ## energy over 1000 bounces and in a closed box
DRIFT_TABLES := $(STABILITY_DATA)/drift-bounce.tsv $(STABILITY_DATA)/drift-box.tsv
$(F)/stability-drift.svg: $(DRIFT_TABLES) plots/drift.gp plots/style.gp
	$(call draw,drift.gp,$(DRIFT_TABLES),stability-drift)

# Creep, with each method's control of settle
CREEP_RUNS := $(DRIFT_METHODS:%=creep-%)
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,creep-$(m),\
  creep --method $(m) $(if $(filter verlet,$(m)),--step 4e-4))))
$(STABILITY_DATA)/creep.tsv: $(CREEP_RUNS:%=$(STABILITY_DATA)/%.tsv)
	$(call stability_merge,$^) > $@
stability-creep: $(F)/stability-creep.svg ## creep below the friction angle
$(F)/stability-creep.svg: $(STABILITY_DATA)/creep.tsv \
  plots/creep.gp plots/style.gp
	$(call draw,creep.gp,$<,stability-creep)

# The cut at lmax, and tapers
CUT_TAPERS := none shift c1 c2
$(foreach t,$(CUT_TAPERS),$(eval $(call stability_run,cut-rk8pd-$(t),\
  cut --method rk8pd --taper $(t) --tightest $(if $(QUICK),1e-10,1e-14))))
$(eval $(call stability_run,cut-merson-none,cut --method merson \
  --tightest $(if $(QUICK),1e-10,1e-14)))
CUT_RUNS := $(CUT_TAPERS:%=cut-rk8pd-%) cut-merson-none
$(STABILITY_DATA)/cut.tsv: $(CUT_RUNS:%=$(STABILITY_DATA)/%.tsv)
	$(call stability_merge,$^) > $@
stability-cut: $(F)/stability-cut.svg ## the floor that the cut at lmax puts under the accuracy
$(F)/stability-cut.svg: $(STABILITY_DATA)/cut.tsv plots/cut.gp plots/style.gp
	$(call draw,cut.gp,$<,stability-cut)

.PHONY: stability stability-regions stability-tunnel stability-drift \
  stability-creep stability-cut
