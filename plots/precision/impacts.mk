# SPDX-License-Identifier: GPL-3.0-or-later
# The impacts of Chung and Ooi by our law.
$(D)/precision/impacts.tsv: plots/precision/impacts.sh $(B)/precision
	@mkdir -p $(@D)
	B=$(B) QUICK=$(QUICK) $< > $@
$(F)/impacts.svg: plots/precision/impacts.gp plots/style.gp \
  $(D)/precision/impacts.tsv
	$(draw)
impacts: $(F)/impacts.svg ## impacts of Chung and Ooi: errors, and the hard limit
precision: impacts
.PHONY: impacts
