# SPDX-License-Identifier: GPL-3.0-or-later
# The wrong bed: the runs of plots/precision/settling.mk with friction and
# rotation, Merson at fixed steps, and the two embedded methods that are too
# expensive for more than one seed.
WRONG_EXTRA := \
  $(foreach h,4e-4 2e-4 1e-4 5e-5,\
    $(call bed_runs,$(FULL)/method-merson/step-$(h),0,4)) \
  $(foreach m,rkck rk8pd,$(foreach t,10 0.1,\
    $(call bed_runs,$(FULL)/method-$(m)/tol-$(t),0,1)))
WRONG_BEDS := $(SETTLING_FULL) $(if $(QUICK),,$(WRONG_EXTRA))
stability-wrong-bed: $(F)/stability-wrong-bed.svg ## at which step or tolerance friction melts the bed
$(BEDS)/wrong.tsv: plots/precision/settling.awk plots/stability/wrong-bed.mk \
  $(WRONG_BEDS)
	awk -f $< $(WRONG_BEDS) > $@
$(BEDS)/slip.tsv: plots/stability/slip.awk | $(B)/settle
	@mkdir -p $(@D)
	$(B)/settle --quiet $(BED_OPTIONS) | awk -f $< > $@
$(F)/stability-wrong-bed.svg: plots/stability/wrong-bed.gp plots/style.gp \
  $(BEDS)/wrong.tsv $(BEDS)/slip.tsv
	$(draw)

stability: stability-wrong-bed
.PHONY: stability-wrong-bed
