# SPDX-License-Identifier: GPL-3.0-or-later
# Beds without side walls: 1,000 spheres on 10 by 10 diameters with periodic sides,
# of which the heights from 2 to 6 diameters are measured; some 4 minutes of CPU
# time. Friction 0.174 is a Coulomb coefficient of 0.3 at rest.
BULK_SIDE := $(if $(QUICK),0.8,2)
BULK := --base $(BULK_SIDE),$(BULK_SIDE) --periodic xy \
  --count $(if $(QUICK),80 --time 2,1000)
BULK_BOX := 0,$(BULK_SIDE),0,$(BULK_SIDE),0.4,$(if $(QUICK),0.6,1.2)
BULK_MODEL_basic := --model basic
BULK_MODEL_rotation := --friction 0.174 --vmin 1.25e-3
BULK_SEEDS := 1 2 $(if $(QUICK),,3 4)
BULK_GROUPS := basic-0.012 rotation-0.012 $(if $(QUICK),,basic-0.006 basic-0.003)
# $(call bulk_run,MODEL,OVERLAP,SEED)
define bulk_run
$(D)/bulk/$(1)-$(2)-$(3).bed: | $(B)/settle
	@mkdir -p $$(@D)
	$(B)/settle --quiet $(BULK) $(BULK_MODEL_$(1)) --overlap $(2) --seed $(3) > $$@
endef
bulk_beds = $(BULK_SEEDS:%=$(D)/bulk/$(1)-%.bed)
$(foreach g,$(BULK_GROUPS),$(foreach s,$(BULK_SEEDS),\
  $(eval $(call bulk_run,$(word 1,$(subst -, ,$(g))),$(word 2,$(subst -, ,$(g))),$(s)))))
$(D)/bulk/%.gr: $(D)/bulk/%.bed | $(B)/analyze
	$(B)/analyze gr --margin $(if $(QUICK),0.5,2) --rmax 5 --bins 125 $< > $@
$(D)/bulk/gr.tsv: plots/beds/gr.awk $(foreach m,basic rotation,\
  $(patsubst %.bed,%.gr,$(call bulk_beds,$(m)-0.012)))
	for m in basic rotation; do \
	  awk -v variant=$$m -f $< $(D)/bulk/$$m-0.012-*.gr || exit; \
	done > $@
$(D)/bulk/bulk.tsv: plots/beds/bulk.sh $(foreach g,$(BULK_GROUPS),\
  $(call bulk_beds,$(g))) | $(B)/analyze
	B=$(B) $< $(BULK_BOX) $(filter %.bed,$^) > $@
fig-bulk: $(F)/bulk.svg $(F)/bulk.md ## beds without side walls: fraction, contacts, pair correlation
	@cat $(F)/bulk.md
$(F)/bulk.svg: plots/beds/gr.gp plots/style.gp $(D)/bulk/gr.tsv
	$(draw)
$(F)/bulk.md: $(D)/bulk/bulk.tsv

.PHONY: fig-bulk
