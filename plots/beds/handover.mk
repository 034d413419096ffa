# SPDX-License-Identifier: GPL-3.0-or-later
# What gaps and bridges for meshers cost; one bed, half a minute.
HANDOVER_SIZES := 0.005 $(if $(QUICK),,0.01) 0.02 $(if $(QUICK),,0.03) 0.05 \
  $(if $(QUICK),,0.07) 0.1 $(if $(QUICK),,0.15) 0.2
$(D)/handover.tsv: plots/beds/handover.sh $(D)/structure/rotation-1.bed | \
  $(B)/analyze
	B=$(B) $< $(D)/structure/rotation-1.bed $(HANDOVER_SIZES) > $@
fig-handover: $(F)/handover.svg ## what gaps and bridges for meshers do to the solid fraction
$(F)/handover.svg: plots/beds/handover.gp plots/style.gp $(D)/handover.tsv
	$(draw)

.PHONY: fig-handover
