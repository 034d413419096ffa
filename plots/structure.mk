# SPDX-License-Identifier: GPL-3.0-or-later
# How the spheres of the frictionless bed and of the full model's touch and are
# arranged: ten beds of each.
STRUCTURES := basic rotation
define structure_run
$(D)/structure/$(1)-$(2).bed: $(B)/settle
	@mkdir -p $(D)/structure
	$(SETTLE) --model $(1) --seed $(2) > $$@
$(D)/structure/$(1)-$(2).gr: $(D)/structure/$(1)-$(2).bed $(B)/analyze
	$(B)/analyze gr --rmax 3 --bins 120 $$< > $$@
endef
$(foreach m,$(STRUCTURES),$(foreach s,$(SEEDS),\
	$(eval $(call structure_run,$(m),$(s)))))

$(D)/structure/gr.tsv: $(foreach m,$(STRUCTURES),\
  $(SEEDS:%=$(D)/structure/$(m)-%.gr)) plots/gr.awk
	for m in $(STRUCTURES); do \
	  awk -v variant=$$m -f plots/gr.awk $(D)/structure/$$m-*.gr || exit; \
	done > $@
fig-gr: $(F)/gr.svg ## pair correlation of the frictionless bed and the full model's
$(F)/gr.svg: $(D)/structure/gr.tsv plots/gr.gp plots/style.gp
	$(call draw,gr.gp,$<,gr)

structure: $(F)/structure.md ## contacts and order, means over 10 beds a model
	@cat $<
$(F)/structure.md: plots/structure.sh $(B)/analyze \
  $(foreach m,$(STRUCTURES),$(SEEDS:%=$(D)/structure/$(m)-%.bed))
	@mkdir -p $(F)
	B=$(B) plots/structure.sh $(D)/structure $(STRUCTURES) > $@

.PHONY: fig-gr structure
