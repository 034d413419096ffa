# SPDX-License-Identifier: GPL-3.0-or-later
# The paper's bed against the friction coefficient: a sweep of 1,000 beds, some
# 7 minutes of CPU time. A stopped make goes on where it was.
FRICTIONS := $(if $(QUICK),0.05 0.5,0 0.02 0.05 0.1 0.15 0.2 0.3 0.5 0.7 1)
FRICTION_SEEDS := $(if $(QUICK),4,100)
$(D)/friction/runs.tsv: plots/beds/friction.mk
	@mkdir -p $(@D)
	{ printf 'friction\tseed\n'; \
	  for seed in $$(seq $(FRICTION_SEEDS)); do \
	    for friction in $(FRICTIONS); do \
	      printf '%s\t%s\n' $$friction $$seed; \
	    done; \
	  done; } > $@
$(D)/friction/results.tsv: $(D)/friction/runs.tsv | $(B)/sweep $(B)/settle \
  $(B)/analyze
	$(B)/sweep --jobs 0 --work $(@D)/work --measure 'fraction $(BOX)' \
	  --measure contacts --settle '$(if $(QUICK),$(SMALL))' $< > $@
$(D)/friction/means.tsv: $(D)/friction/results.tsv | $(B)/sweep
	$(B)/sweep --summary friction $< > $@
fig-friction: $(F)/friction.svg ## solid fraction and contacts of 1,000 beds against the friction coefficient
$(F)/friction.svg: plots/beds/friction.gp plots/style.gp \
  $(D)/friction/means.tsv
	$(draw)

.PHONY: fig-friction
