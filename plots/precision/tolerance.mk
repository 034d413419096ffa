# SPDX-License-Identifier: GPL-3.0-or-later
# What --tol of multirate does to beds, seed by seed. Each file of runs is made
# anew when it is removed. QUICK=1: few and small beds.
TOLERANCE := $(D)/tolerance
TOLERANCE_friction-0.2 := --friction 0.2
TOLERANCE_friction-0.1 := --friction 0.1
TOLERANCE_friction-0.5 := --friction 0.5
TOLERANCE_no-friction := --model basic
TOLERANCE_kappa-600 := --kappa 600
TOLERANCE_at-rest := --until-rest --time 300
TOLERANCE_2000-spheres := --count 2000 --base 3.16,3.16
comma := ,
# name,method,tolerance,seeds
TOLERANCE_RUNS := friction-0.2,rkc,5e-4,40 friction-0.2,multirate,5e-4,1000 \
  friction-0.2,multirate,2e-3,1000 friction-0.2,multirate,5e-3,200 \
  friction-0.2,multirate,0.01,200 friction-0.2,multirate,0.05,200 \
  $(foreach t,5e-4 2e-3,friction-0.1,multirate,$(t),200 \
    friction-0.5,multirate,$(t),200 no-friction,multirate,$(t),400 \
    kappa-600,multirate,$(t),40 at-rest,multirate,$(t),60 \
    $(if $(QUICK),,$(t:%=2000-spheres$(comma)multirate$(comma)%$(comma)10))) \
  $(if $(QUICK),,2000-spheres$(comma)rkc$(comma)5e-4$(comma)3 \
    $(patsubst %,2000-spheres$(comma)multirate$(comma)%$(comma)10,0.01 0.05))

# $(call tolerance_run,NAME METHOD TOL SEEDS)
tolerance_file = $(TOLERANCE)/$(word 1,$(1))-$(word 2,$(1))-$(word 3,$(1)).tsv
define tolerance_run
$(call tolerance_file,$(1)): | $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	B=$(B) plots/precision/tolerance.sh run $(word 1,$(1)) \
	  $(word 2,$(1)),$(word 3,$(1)) $(if $(QUICK),2,$(word 4,$(1))) \
	  $(if $(QUICK),$(SMALL)) $(TOLERANCE_$(word 1,$(1))) > $$@.partial
	mv $$@.partial $$@
endef
$(foreach r,$(TOLERANCE_RUNS),\
  $(eval $(call tolerance_run,$(subst $(comma), ,$(r)))))

tolerance: $(F)/precision-tolerance.md $(F)/precision-tolerance.svg ## what --tol does to beds, 1,000 of them seed by seed (an hour)
	@cat $<
$(TOLERANCE)/table.tsv: plots/precision/tolerance.sh \
  $(foreach r,$(TOLERANCE_RUNS),$(call tolerance_file,$(subst $(comma), ,$(r))))
	$< table $(filter %.tsv,$^) > $@
$(F)/precision-tolerance.md: $(TOLERANCE)/table.tsv
$(F)/precision-tolerance.svg: plots/precision/tolerance.gp plots/style.gp \
  $(TOLERANCE)/table.tsv
	$(draw)
.PHONY: tolerance
