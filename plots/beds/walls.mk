# SPDX-License-Identifier: GPL-3.0-or-later
# How near the walls are: beds some 13 diameters deep on bases of 5, 10 and 20
# diameters, of which the lowest 10 are measured; some 4 minutes on two cores.
# Beside them the paper's bed.
WALLS_BASES := $(if $(QUICK),1 1.2,4 2 1)
WALLS_SEEDS_1 := $(SEEDS)
WALLS_SEEDS_1.2 := 1
WALLS_SEEDS_2 := 1 2 3 4 5
WALLS_SEEDS_4 := 1 2
WALLS_COUNT_1 := 406
WALLS_COUNT_1.2 := 585
WALLS_COUNT_2 := 1625
WALLS_COUNT_4 := 6500
# $(call walls_run,BASE IN M,SEED)
define walls_run
$(D)/walls/$(1)-$(2).bed: | $(B)/settle
	@mkdir -p $$(@D)
	$(B)/settle --quiet --base $(1),$(1) --count $(WALLS_COUNT_$(1)) \
	  --seed $(2) $(if $(QUICK),--time 0.8) > $$@
endef
$(foreach b,$(WALLS_BASES),$(foreach s,$(WALLS_SEEDS_$(b)),\
  $(eval $(call walls_run,$(b),$(s)))))
WALLS_BEDS := $(SEEDS:%=$(D)/structure/rotation-%.bed) \
  $(foreach b,$(WALLS_BASES),$(WALLS_SEEDS_$(b):%=$(D)/walls/$(b)-%.bed))
$(D)/walls/profile.tsv $(D)/walls/size.tsv: $(D)/walls/%.tsv: \
  plots/beds/walls.sh $(WALLS_BEDS) | $(B)/analyze
	B=$(B) $< $* $(WALLS_BEDS) > $@
fig-walls: $(F)/walls.svg $(F)/walls.md ## how near the walls are: fraction against wall distance and box size
	@cat $(F)/walls.md
$(F)/walls.svg: plots/beds/walls.gp plots/style.gp $(D)/walls/profile.tsv \
  $(D)/walls/size.tsv
	$(draw)
$(F)/walls.md: $(D)/walls/size.tsv

.PHONY: fig-walls
