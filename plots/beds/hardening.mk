# SPDX-License-Identifier: GPL-3.0-or-later
# LAMMPS beside settle as contacts harden; some 2 minutes of CPU time.
$(D)/hardening.tsv: plots/beds/hardening.sh plots/bench/peers/peers.sh | \
  $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	B=$(B) QUICK=$(QUICK) $< > $@
$(F)/hardening.svg: plots/beds/hardening.gp plots/style.gp $(D)/hardening.tsv
	$(draw)
$(F)/hardening.md: $(D)/hardening.tsv
fig-hardening: $(F)/hardening.svg $(F)/hardening.md ## LAMMPS's contacts beside ours as they harden (2 minutes)
	@cat $(F)/hardening.md
.PHONY: fig-hardening
