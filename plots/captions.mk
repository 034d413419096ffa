# SPDX-License-Identifier: GPL-3.0-or-later
# Pages with captions in them: each is written once, in docs/NAME.md beside its
# figure docs/NAME.png.
readme: ## put the figures' captions into README.md and docs/
	@for page in README.md docs/*.md; do \
	  awk -f plots/captions.awk $$page > $(B)/page && cat $(B)/page > $$page \
	    || exit; \
	done; rm $(B)/page

.PHONY: readme
