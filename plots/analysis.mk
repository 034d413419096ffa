# SPDX-License-Identifier: GPL-3.0-or-later
# Figures and tables of what the programs measure beyond the paper. Data as in
# figures.mk: one file a run under build/data, so that a stopped make goes on
# where it was.

# The radius of the geometry is a choice; what each makes of the paper's fraction
RD := $(D)/radius
RADIUS_MODELS := basic rotation
define radius_run
RADIUS_RUNS += $(RD)/$(1)-$(2).tsv
$(RD)/$(1)-$(2).tsv: $(D)/structure/$(1)-$(2).bed | $(B)/analyze
	@mkdir -p $(RD)
	$(B)/analyze radius --report $$< > $$@
endef
$(foreach m,$(RADIUS_MODELS),$(foreach s,$(SEEDS),\
  $(eval $(call radius_run,$(m),$(s)))))
table-radius: $(F)/table-radius.md ## sum, union and overlaps at each choice of the radius
	@cat $<
$(F)/table-radius.md: $(RADIUS_RUNS) plots/table-radius.sh bench/markdown.awk
	@mkdir -p $(F)
	plots/table-radius.sh $(RD) $(RADIUS_MODELS) | \
	  awk -f bench/markdown.awk > $@

# How near the walls are: beds some 13 diameters deep on bases of 5, 10 and 20
# diameters, of which the lowest 10 are measured; some 4 minutes on two cores
WD := $(D)/walls
WALLS_SEEDS_1 := 1 2 3 4 5 6 7 8 9 10
WALLS_SEEDS_2 := 1 2 3 4 5
WALLS_SEEDS_4 := 1 2
WALLS_COUNT_1 := 406
WALLS_COUNT_2 := 1625
WALLS_COUNT_4 := 6500
# $(call walls_run,BASE IN M,SEED)
define walls_run
WALLS_BEDS += $(WD)/$(1)-$(2).bed
$(WD)/$(1)-$(2).bed: | $(B)/settle
	@mkdir -p $(WD)
	$(SETTLE) --base $(1),$(1) --count $(WALLS_COUNT_$(1)) --seed $(2) > $$@
endef
$(foreach b,4 2 1,$(foreach s,$(WALLS_SEEDS_$(b)),\
  $(eval $(call walls_run,$(b),$(s)))))
WALLS_BEDS += $(SEEDS:%=$(D)/structure/rotation-%.bed) # the paper's
$(WD)/profile.tsv $(WD)/size.tsv: $(WD)/%.tsv: $(WALLS_BEDS) plots/walls.sh \
  | $(B)/analyze
	B=$(B) plots/walls.sh $* $(WALLS_BEDS) > $@
fig-walls: $(F)/walls.svg $(F)/walls.md ## how near the walls are: fraction against wall distance and box size
	@cat $(F)/walls.md
$(F)/walls.svg: $(WD)/profile.tsv $(WD)/size.tsv plots/walls.gp plots/style.gp
	$(call draw,walls.gp,$(WD)/profile.tsv $(WD)/size.tsv,walls)
$(F)/walls.md: $(WD)/size.tsv bench/markdown.awk
	@mkdir -p $(F)
	awk -f bench/markdown.awk $< > $@

.PHONY: table-radius fig-walls
