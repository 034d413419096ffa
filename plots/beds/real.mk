# SPDX-License-Identifier: GPL-3.0-or-later
# Five beds as people have them, beside published figures; two minutes of CPU time.
REAL_NAMES := glass steel sand two periodic
REAL_SEEDS := 1 2 $(if $(QUICK),,3)
REAL_BEDS := $(foreach n,$(REAL_NAMES),$(REAL_SEEDS:%=$(D)/real/$(n)-%.bed))
$(D)/real/%.bed: plots/beds/real.sh | $(B)/settle
	@mkdir -p $(@D)
	B=$(B) QUICK=$(QUICK) $< bed $(subst -, ,$*) > $@
$(D)/real.tsv: plots/beds/real.sh $(REAL_BEDS) | $(B)/analyze
	B=$(B) $< table $(REAL_BEDS) > $@
$(F)/real.md: $(D)/real.tsv
$(F)/real-%.png: $(D)/real/%-1.bed | $(B)/analyze
	@mkdir -p $(@D)
	$(B)/analyze draw --view 30,70 --output $@ $<
real-beds: $(F)/real.md $(REAL_NAMES:%=$(F)/real-%.png) ## glass, steel, sand, two sizes, periodic sides: beside published figures
	@cat $<
.PHONY: real-beds
