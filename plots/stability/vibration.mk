# SPDX-License-Identifier: GPL-3.0-or-later
# Does kappa = 500 vibrate? Kinetic energy per sphere over time of the variant
# without friction; outputs: steps no longer than the time between 400 outputs
# in 8 s, and no other limit, as in the author's program. With kappa = 30 centres
# leave the box, so that settle calls the bed a failure, status 4.
VIBRATION := $(BEDS)/vibration
VIBRATION_RUNS := 30-rkc 150-rkc 150-merson 500-rkc 500-merson 500-loose \
  500-outputs
VIBRATION_30-rkc := --method rkc --kappa 30 --lmax 0.33
VIBRATION_150-rkc := --method rkc --kappa 150
VIBRATION_150-merson := --kappa 150 --method merson
VIBRATION_500-rkc := --method rkc --kappa 500
VIBRATION_500-merson := --kappa 500 --method merson
VIBRATION_500-loose := --kappa 500 --method merson --tol 10
VIBRATION_500-outputs := --kappa 500 --method merson --travel 0 --hmax 0.02005
define vibration_run
$(VIBRATION)/$(1).tsv: | $(B)/settle
	@mkdir -p $$(@D)
	{ $(B)/settle --quiet --model basic $(VIBRATION_$(1)) \
	  $(or $(BED_OPTIONS),--time 16) --frames 401 || [ $$$$? = 4 ]; } | \
	  awk -v run=$(1) -f plots/stability/kinetic.awk > $$@
endef
$(foreach r,$(VIBRATION_RUNS),$(eval $(call vibration_run,$(r))))
$(VIBRATION).tsv: plots/stability/envelope.awk \
  $(VIBRATION_RUNS:%=$(VIBRATION)/%.tsv)
	awk -f $^ > $@
stability-vibration: $(F)/stability-vibration.svg ## kinetic energy over time by kappa: does 500 vibrate?
$(F)/stability-vibration.svg: plots/stability/vibration.gp plots/style.gp \
  $(VIBRATION).tsv
	$(draw)

stability: stability-vibration
.PHONY: stability-vibration
