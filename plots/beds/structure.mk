# SPDX-License-Identifier: GPL-3.0-or-later
# How the spheres of the frictionless bed and of the full model's touch and are
# arranged: ten beds of each.
STRUCTURES := basic rotation
STRUCTURE_BEDS := $(foreach m,$(STRUCTURES),$(SEEDS:%=$(D)/structure/$(m)-%.bed))
define structure_run
$(D)/structure/$(1)-$(2).bed: $(B)/settle
	@mkdir -p $$(@D)
	$(SETTLE) --model $(1) --seed $(2) > $$@
endef
$(foreach m,$(STRUCTURES),$(foreach s,$(SEEDS),\
  $(eval $(call structure_run,$(m),$(s)))))

$(D)/structure/%.gr: $(D)/structure/%.bed $(B)/analyze
	$(B)/analyze gr --rmax 3 --bins 120 $< > $@
$(D)/structure/gr.tsv: plots/beds/gr.awk $(STRUCTURE_BEDS:.bed=.gr)
	for m in $(STRUCTURES); do \
	  awk -v variant=$$m -f $< $(D)/structure/$$m-*.gr || exit; \
	done > $@
fig-gr: $(F)/gr.svg ## pair correlation of the frictionless bed and the full model's
$(F)/gr.svg: plots/beds/gr.gp plots/style.gp $(D)/structure/gr.tsv
	$(draw)

structure: $(F)/structure.md ## contacts and order, means over 10 beds per model
	@cat $<
$(F)/structure.md: plots/beds/structure.sh $(B)/analyze $(STRUCTURE_BEDS)
	@mkdir -p $(@D)
	B=$(B) $< $(D)/structure $(STRUCTURES) > $@

# The radius of the geometry is a choice; the effect of each on the paper's fraction
$(D)/radius/%.tsv: $(D)/structure/%.bed | $(B)/analyze
	@mkdir -p $(@D)
	$(B)/analyze radius --report $(BOX) $< > $@
table-radius: $(F)/table-radius.md ## sum, union and overlaps at each choice of the radius
	@cat $<
$(D)/radius.tsv: plots/beds/table-radius.sh \
  $(STRUCTURE_BEDS:$(D)/structure/%.bed=$(D)/radius/%.tsv)
	$< $(D)/radius $(STRUCTURES) > $@
$(F)/table-radius.md: $(D)/radius.tsv

.PHONY: fig-gr structure table-radius
