# SPDX-License-Identifier: GPL-3.0-or-later
# Pages with captions in them: each is written once, in docs/NAME.md beside its
# figure docs/NAME.png.
readme: ## put the figures' captions into README.md and docs/
	@for page in README.md docs/*.md; do \
	  awk -f plots/captions.awk $$page > $(B)/page && cat $(B)/page > $$page \
	    || exit; \
	done; rm $(B)/page

# The figures that the pages show: docs/NAME.png, made as build/figures/NAME.png
# or by another name there. Those that have been made are copied.
SHOWN := bench budget bulk fig4.3 friction gr growth growth-rest handover hardening \
  hardness precision-contrast precision-horizon precision-settling \
  precision-tolerance \
  stability-creep stability-cut stability-drift \
  stability-map stability-regions stability-steps stability-tunnel \
  stability-vibration stability-wrong-bed tubes walls
SHOWN_AS := \
  beads-two=real-two \
  mixtures-fraction=mixtures \
  precision-bounce=precision-bounce-150-inelastic-time-evaluations \
  precision-impacts=impacts \
  precision-rolling=precision-rolling-steps-velocity-step \
  precision-toda=precision-toda-6-long-eigenvalue-evaluations \
  precision-trajectory=precision-trajectory-200-position-evaluations \
  precision-trajectory-8=precision-trajectory-8-position-evaluations
docs-figures: ## copy the figures that the pages show, as far as they are made, to docs/
	@for name in $(SHOWN) $(SHOWN_AS); do \
	  if [ -e $(F)/$${name#*=}.png ]; then \
	    cp -v $(F)/$${name#*=}.png docs/$${name%%=*}.png; \
	  fi; \
	done

.PHONY: readme docs-figures
