# SPDX-License-Identifier: GPL-3.0-or-later
# Variables and rules that the figures and tables of all studies share. plots/
# has a folder for each study: its .mk (which program with which arguments makes
# the data), its awk and shell scripts, and the gnuplot script of each figure,
# named as the figure.
# A figure is two rules, data and picture. Data are one file per run under
# build/data, so that a stopped make goes on where it was; charts and tables are
# under build/figures. QUICK=1: all of it small, in directories of its own.
# A variable is assigned once, in one file (tests/test_make.sh).
STUDIES := paper beds mixtures precision stability bench
D := $(B)/$(if $(QUICK),quick/)data
F := $(B)/$(if $(QUICK),quick/)figures

# A bed: 200 spheres for 8 s unless QUICK; its fraction; seeds of an ensemble
SMALL := --base 0.5,0.5 --count 16 --time 1
SMALL_BOX := --box 0,0.5,0,0.5,0,0.5
SETTLE := $(B)/settle --quiet $(if $(QUICK),$(SMALL))
BOX := $(if $(QUICK),$(SMALL_BOX))
SEEDS := 1 2 $(if $(QUICK),,3 4 5 6 7 8 9 10)
# The paper's method, and all of its kind
PAPER := --method merson --control paper --tol 0.1
EMBEDDED := merson dopri5 rkf45 rkck rk8pd

# Pictures of QUICK have half the size
# -d: whatever ~/.gnuplot holds
GNUPLOT := gnuplot -d $(if $(QUICK),-e magnify=1)
# The rule's gnuplot script with its data as SVG and PNG: the prerequisites that
# end in .gp, and in .tsv or .log.
define draw
@mkdir -p $(@D)
for end in svg png; do \
  $(GNUPLOT) -c $(firstword $(filter %.gp,$^)) $(filter %.tsv %.log,$^) \
    $(basename $@).$$end || exit; \
done
endef

# A table of data as Markdown
$(F)/%.md: plots/markdown.awk
	@mkdir -p $(@D)
	awk -f $< $(filter %.tsv,$^) > $@

include $(foreach s,$(STUDIES),$(sort $(wildcard plots/$(s)/*.mk)))
