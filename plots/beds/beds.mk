# SPDX-License-Identifier: GPL-3.0-or-later
# Beds by any options, for the charts over many of them in plots/precision and
# plots/stability: build/data/beds has a file with one row for each, named by the
# options of settle that made it (plots/beds/bed.sh). CPU times of charts come
# from the runs under timed/, which have the machine to themselves as far as
# these rules go: others wait for the lock meanwhile.
BEDS := $(D)/beds
BED_SMALL := --base 0.5,0.5 --count 40 --time 2
BED_OPTIONS := $(if $(QUICK),$(BED_SMALL))
$(BEDS)/timed/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	RUN='flock -x $(B)/timing.lock' B=$(B) plots/beds/bed.sh $* $(BED_OPTIONS) > $@
$(BEDS)/%.tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	RUN='flock -s $(B)/timing.lock' B=$(B) plots/beds/bed.sh $* $(BED_OPTIONS) > $@

# $(call bed_runs,SETTINGS,TIMED,SEEDS): how many seeds, the first of them timed
BED_SEEDS := $(shell seq $(if $(QUICK),2,40))
bed_first = $(wordlist 1,$(1),$(BED_SEEDS))
bed_runs = $(patsubst %,$(BEDS)/timed/$(1)/seed-%.tsv,$(call bed_first,$(2))) \
  $(patsubst %,$(BEDS)/$(1)/seed-%.tsv,\
    $(filter-out $(call bed_first,$(2)),$(call bed_first,$(3))))
FULL := model-rotation
PLAIN := model-basic
