# SPDX-License-Identifier: GPL-3.0-or-later
# Which spheres take short steps with multirate: a bed while its first spheres
# hit the floor, and while it closes.
STEPS_COUNT := $(if $(QUICK),--count 20)
$(eval $(call stability_run,steps-impact,steps --from 0.5 --to 0.55 $(STEPS_COUNT)))
$(eval $(call stability_run,steps-bed,steps --from 1 --to 1.05 $(STEPS_COUNT)))
stability-steps: $(F)/stability-steps.svg ## a bed coloured by the steps that each sphere took with multirate
$(F)/stability-steps.svg: plots/stability/steps.gp plots/style.gp \
  $(STABILITY_DATA)/steps-impact.tsv $(STABILITY_DATA)/steps-bed.tsv
	$(draw)

stability: stability-steps
.PHONY: stability-steps
