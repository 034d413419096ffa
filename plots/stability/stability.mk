# SPDX-License-Identifier: GPL-3.0-or-later
# Where methods fail: build/stability VERB. Other .mk files add what they chart
# by a line `stability: TARGET`.
STABILITY_DATA := $(D)/stability
stability: ## where methods fail: every chart and table of it (QUICK=1: small ones)
stability: stability-regions stability-tunnel stability-drift stability-creep \
  stability-cut

# $(call stability_run,NAME,VERB AND OPTIONS): a rule for one file of data
define stability_run
$(STABILITY_DATA)/$(strip $(1)).tsv: $(B)/stability
	@mkdir -p $$(@D)
	$(B)/stability $(strip $(2)) > $$@
endef
# $(call stability_merge,FILES): one table of tables with the same columns
stability_merge = awk 'FNR == 1 { named = 0 } /^\#/ || !NF { next } \
  !named++ && any++ { next } { print }' $(1)

# Stability limits, and the regions that they lie on
$(eval $(call stability_run,limits,limits))
$(eval $(call stability_run,regions,regions --points $(if $(QUICK),61,241)))
stability-regions: $(addprefix $(F)/stability-,regions.svg limits.md) ## largest stable steps, measured and by theory
$(F)/stability-regions.svg: plots/stability/regions.gp plots/style.gp \
  $(STABILITY_DATA)/regions.tsv $(STABILITY_DATA)/limits.tsv
	$(draw)
$(F)/stability-limits.md: $(STABILITY_DATA)/limits.tsv

# Missed collisions, without and with the cap on travel
TUNNEL_RUNS := $(foreach m,$(EMBEDDED) rkc,$(foreach t,0 1,tunnel-$(m)-$(t)))
$(foreach m,$(EMBEDDED) rkc,$(foreach t,0 1,$(eval $(call stability_run,\
  tunnel-$(m)-$(t),tunnel --method $(m) --travel $(t) --runs $(if $(QUICK),4,50)))))
$(STABILITY_DATA)/tunnel.tsv: $(TUNNEL_RUNS:%=$(STABILITY_DATA)/%.tsv)
	$(call stability_merge,$^) > $@
stability-tunnel: $(addprefix $(F)/stability-,tunnel.svg tunnel.md) ## share of collisions missed out of free flight, by method
$(F)/stability-tunnel.svg: plots/stability/tunnel.gp plots/style.gp \
  $(STABILITY_DATA)/tunnel.tsv
	$(draw)
$(STABILITY_DATA)/outcomes.tsv: plots/stability/outcomes.awk \
  $(STABILITY_DATA)/tunnel.tsv
	awk -f $^ > $@
$(F)/stability-tunnel.md: $(STABILITY_DATA)/outcomes.tsv

# Energy, at equal cost: evaluations per bounce, and per second of the box
DRIFT_METHODS := $(EMBEDDED) rkc verlet
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,drift-bounce-$(m),\
  drift --method $(m) --cost 3000 --units $(if $(QUICK),30,1000))))
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,drift-box-$(m),\
  drift --scene box --method $(m) $(if $(QUICK),--count 10 --edge 0.8 \
  --cost 3000 --units 10,--cost 10000 --units 100))))
$(STABILITY_DATA)/drift-bounce.tsv: \
  $(DRIFT_METHODS:%=$(STABILITY_DATA)/drift-bounce-%.tsv)
	$(call stability_merge,$^) > $@
$(STABILITY_DATA)/drift-box.tsv: \
  $(DRIFT_METHODS:%=$(STABILITY_DATA)/drift-box-%.tsv)
	$(call stability_merge,$^) > $@
stability-drift: $(F)/stability-drift.svg ## energy over 1000 bounces and in a closed box
$(F)/stability-drift.svg: plots/stability/drift.gp plots/style.gp \
  $(STABILITY_DATA)/drift-bounce.tsv $(STABILITY_DATA)/drift-box.tsv
	$(draw)

# Creep, with each method's control of settle
CREEP_RUNS := $(DRIFT_METHODS:%=creep-%)
$(foreach m,$(DRIFT_METHODS),$(eval $(call stability_run,creep-$(m),\
  creep --method $(m) $(if $(filter verlet,$(m)),--step 4e-4))))
$(STABILITY_DATA)/creep.tsv: $(CREEP_RUNS:%=$(STABILITY_DATA)/%.tsv)
	$(call stability_merge,$^) > $@
stability-creep: $(F)/stability-creep.svg ## creep below the friction angle
$(F)/stability-creep.svg: plots/stability/creep.gp plots/style.gp \
  $(STABILITY_DATA)/creep.tsv
	$(draw)

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
$(F)/stability-cut.svg: plots/stability/cut.gp plots/style.gp \
  $(STABILITY_DATA)/cut.tsv
	$(draw)

.PHONY: stability stability-regions stability-tunnel stability-drift \
  stability-creep stability-cut
