# SPDX-License-Identifier: GPL-3.0-or-later
# Frictionless mixtures beside what others expect of hard spheres of their sizes;
# some 8 minutes of CPU time.
MIXTURE_SEEDS := 1 2 $(if $(QUICK),,3)
MIXTURE_NAMES := \
  $(foreach x,$(if $(QUICK),,0.4 0.6) 0.7 $(if $(QUICK),,0.8) 0.9,two-$(x)) \
  $(foreach x,0 $(if $(QUICK),,0.1 0.2) 0.3,lognormal-$(x))
MIXTURE_BEDS := $(foreach n,$(MIXTURE_NAMES),\
  $(MIXTURE_SEEDS:%=$(D)/mixtures/$(n)-%.bed))
$(D)/mixtures/%.bed: plots/mixtures/bed.sh | $(B)/settle
	@mkdir -p $(@D)
	B=$(B) QUICK=$(QUICK) $< $(subst -, ,$*) > $@
$(D)/mixtures/mixtures.tsv: plots/mixtures/table.sh $(MIXTURE_BEDS) | \
  $(B)/analyze
	B=$(B) $< $(MIXTURE_BEDS) > $@
fig-mixtures: $(F)/mixtures.svg $(F)/mixtures.md ## mixtures beside others' random close packing
	@cat $(F)/mixtures.md
$(F)/mixtures.svg: plots/mixtures/mixtures.gp plots/style.gp \
  $(D)/mixtures/mixtures.tsv
	$(draw)
$(F)/mixtures.md: $(D)/mixtures/mixtures.tsv

.PHONY: fig-mixtures
