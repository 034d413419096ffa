# SPDX-License-Identifier: GPL-3.0-or-later
# Upright tubes of 2 to 20 diameters, filled some 7 diameters high by spheres at
# random places that fall: the void share against the distance from the wall, and
# its mean against the width of the tube; some 2 minutes of CPU time.
TUBES := $(if $(QUICK),2 5,2 2.5 3 3.5 4 4.5 5 6 7 8 10 15 20)
TUBES_FEW := 15 20
TUBES_SHOWN := $(if $(QUICK),5,5 8 20)
TUBES_LAW := --kappa 600 --f0 36.7 --lmax 0.025
tube_seeds = $(if $(QUICK),1 2,$(if $(filter $(1),$(TUBES_FEW)),1 2,1 2 3 4))
tube_beds = $(foreach n,$(1),$(patsubst %,$(D)/tubes/$(n)-%.bed,\
  $(call tube_seeds,$(n))))
# $(call tube_run,N,SEED): 6 N^2 spheres of 0.2 m
define tube_run
$(D)/tubes/$(1)-$(2).bed: | $(B)/settle
	@mkdir -p $$(@D)
	r=$$$$(awk 'BEGIN { print 0.1 * $(1) }'); \
	$(B)/settle --quiet --cylinder $$$$r,$$$$r,0,0,0,1,$$$$r --fill random \
	  --count $$$$(awk 'BEGIN { printf "%d", 6 * $(1) ^ 2 + 0.5 }') \
	  --seed $(2) $(TUBES_LAW) $(if $(QUICK),--time 2) > $$@
endef
$(foreach n,$(TUBES),$(foreach s,$(call tube_seeds,$(n)),\
  $(eval $(call tube_run,$(n),$(s)))))
$(D)/tubes/profile.tsv: plots/beds/tubes.sh $(call tube_beds,$(TUBES_SHOWN)) \
  | $(B)/analyze
	B=$(B) $< profile $(filter %.bed,$^) > $@
$(D)/tubes/size.tsv: plots/beds/tubes.sh $(call tube_beds,$(TUBES)) | $(B)/analyze
	B=$(B) $< size $(filter %.bed,$^) > $@
fig-tubes: $(F)/tubes.svg $(F)/tubes.md ## void share of tubes, against the distance from the wall and their width
	@cat $(F)/tubes.md
$(F)/tubes.svg: plots/beds/tubes.gp plots/style.gp $(D)/tubes/profile.tsv \
  $(D)/tubes/size.tsv
	$(draw)
$(F)/tubes.md: $(D)/tubes/size.tsv

.PHONY: fig-tubes
