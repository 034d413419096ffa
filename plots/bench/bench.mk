# SPDX-License-Identifier: GPL-3.0-or-later
# Benchmarks: never part of the tests, since machines are shared. Every speed
# stands beside the fraction that it gave. `make bench-clean` forgets the runs.
BENCH := $(D)/bench

# Methods by name: what settle is told. All have the same seeds, so that beds
# are compared in pairs; but the paper's own way, every pair twice, which takes
# minutes for the full model, has the first alone.
BENCH_METHODS := allpairs merson dopri5 rkf45 rk8pd rkc multirate verlet
BENCH_allpairs := --pairs all --method merson
BENCH_merson := --method merson
BENCH_dopri5 := --method dopri5
BENCH_rkf45 := --method rkf45
BENCH_rk8pd := --method rk8pd
BENCH_rkc := --method rkc
BENCH_multirate := --method multirate
BENCH_verlet := --method verlet --step 2.5e-5
BENCH_SEEDS := $(if $(QUICK),1 2,1 2 3)
bench_seeds = $(if $(filter allpairs,$(1)),$(firstword $(BENCH_SEEDS)),\
  $(BENCH_SEEDS))

# $(call bench_run,VARIANT,METHOD,SEED)
define bench_run
$(BENCH)/$(1)-$(2)-$(3).tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	$(SETTLE) --model $(1) $$(BENCH_$(2)) --seed $(3) \
	  --stats $$(@:.tsv=.stats) | $(B)/analyze $(BOX) > $$@
endef
$(foreach v,$(VARIANTS),$(foreach m,$(BENCH_METHODS),\
  $(foreach s,$(call bench_seeds,$(m)),$(eval $(call bench_run,$(v),$(m),$(s))))))

BENCH_RUNS := $(foreach v,$(VARIANTS),$(foreach m,$(BENCH_METHODS),\
  $(patsubst %,$(BENCH)/$(v)-$(m)-%.tsv,$(call bench_seeds,$(m)))))

bench: $(F)/bench.md $(F)/bench.svg $(F)/scaling.md $(F)/scaling.svg ## CPU time beside accuracy, by method; cost per sphere up to 100,000
	@cat $(F)/bench.md $(F)/scaling.md
$(BENCH)/bench.tsv: plots/bench/methods.sh plots/bench/bench.mk $(BENCH_RUNS)
	$< $(BENCH) $(VARIANTS) > $@
$(F)/bench.md: $(BENCH)/bench.tsv
$(F)/bench.svg: plots/bench/bench.gp plots/style.gp $(BENCH)/bench.tsv
	$(draw)

SCALING_QUICK := TILES='1x1 2x1' LONGEST=8.1
$(BENCH)/scaling.tsv: plots/bench/scaling.sh plots/bench/tile.awk | $(B)/settle
	@mkdir -p $(@D)
	B=$(B) $(if $(QUICK),$(SCALING_QUICK)) $< > $@
$(F)/scaling.md: $(BENCH)/scaling.tsv
$(F)/scaling.svg: plots/bench/scaling.gp plots/style.gp $(BENCH)/scaling.tsv
	$(draw)

# What each feature of a scene costs
FEATURES_QUICK := ROUNDS=2 SIZE='--count 30 --base 0.6,0.6 --time 0.7'
features: $(F)/features.md ## CPU time of each container and law, by the plain scene's
	@cat $<
$(BENCH)/features.tsv: plots/bench/features.sh | $(B)/settle
	@mkdir -p $(@D)
	B=$(B) $(if $(QUICK),$(FEATURES_QUICK)) $< > $@
$(F)/features.md: $(BENCH)/features.tsv

PEERS_QUICK := SEEDS=1 STEP=4 TIME=0.5
bench-peers: $(F)/peers.md ## LAMMPS and LIGGGHTS on the same 200 spheres, where installed
	@cat $<
.PHONY: $(BENCH)/peers.tsv
$(BENCH)/peers.tsv: plots/bench/peers/peers.sh | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	B=$(B) $(if $(QUICK),$(PEERS_QUICK)) $< > $@
$(F)/peers.md: $(BENCH)/peers.tsv

# The same start in each code and by our methods, at the same depth: a row for
# each number of spheres, with the width of its base (m). Codes that are not installed have
# no rows.
GROWTH_COUNTS := $(if $(QUICK),20 40,200 2000 6000 20000 100000)
GROWTH_20 := 0.5
GROWTH_40 := 0.75
GROWTH_200 := 1
GROWTH_2000 := 3.16
GROWTH_6000 := 5.48
GROWTH_20000 := 10
GROWTH_100000 := 22.36
GROWTH_SEEDS_200 := 1 2 3
GROWTH_ROWS := multirate rkc verlet lammps-1e4 lammps-1e5 liggghts-1e4 \
  liggghts-1e5
GROWTH_multirate := settle rotation 0.2 - --method multirate
GROWTH_rkc := settle rotation 0.2 - --method rkc
GROWTH_verlet := settle rotation 0.2 - --method verlet --step 2.5e-5
GROWTH_lammps-1e4 := lammps hooke 0.2 1e4
GROWTH_lammps-1e5 := lammps hooke 0.2 1e5
GROWTH_liggghts-1e4 := liggghts hooke 0.2 1e4
GROWTH_liggghts-1e5 := liggghts hooke 0.2 1e5
GROWTH_END_growth := $(if $(QUICK),TIME=0.3)
GROWTH_END_rest := REST=1
# $(call growth_run,COUNT,ROW,END): to 8 s (growth), or to rest (rest)
define growth_run
$(BENCH)/$(3)/$(1)-$(2).tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	B=$(B) COUNT=$(1) BASE=$(GROWTH_$(1)) SEEDS='$(or $(GROWTH_SEEDS_$(1)),1)' \
	  $(GROWTH_END_$(3)) ROWS='$(GROWTH_$(2))' plots/bench/peers/peers.sh \
	  > $$@.partial
	mv $$@.partial $$@
endef
# Not those that would take an hour: these grow faster than the others.
GROWTH_LONG := $(if $(QUICK),,6000-verlet 20000-rkc 20000-verlet 100000-rkc \
  100000-verlet)
GROWTH_NAMES := $(filter-out $(GROWTH_LONG),\
  $(foreach n,$(GROWTH_COUNTS),$(GROWTH_ROWS:%=$(n)-%)))
# Verlet's method would take four times as long as to 8 s, hard springs of many
# spheres as long again.
REST_NAMES := $(filter-out %-verlet 6000-rkc 100000-lammps-1e5 \
  100000-liggghts-1e5,$(GROWTH_NAMES))
$(foreach n,$(GROWTH_COUNTS),$(foreach r,$(GROWTH_ROWS),$(foreach e,growth rest,\
  $(eval $(call growth_run,$(n),$(r),$(e))))))

growth: $(F)/growth.md $(F)/growth.svg ## CPU time to 8 s against the number of spheres, beside LAMMPS and LIGGGHTS (hours)
	@cat $(F)/growth.md
growth-rest: $(F)/growth-rest.md $(F)/growth-rest.svg ## the same until the bed is at rest (hours)
	@cat $(F)/growth-rest.md
GROWTH_TABLE := plots/bench/growth.awk plots/bench/bench.mk
$(BENCH)/growth.tsv: $(GROWTH_TABLE) $(GROWTH_NAMES:%=$(BENCH)/growth/%.tsv)
	awk -f $< $(filter %.tsv,$^) > $@
$(BENCH)/growth-rest.tsv: $(GROWTH_TABLE) $(REST_NAMES:%=$(BENCH)/rest/%.tsv)
	awk -f $< $(filter %.tsv,$^) > $@
$(F)/growth.md: $(BENCH)/growth.tsv
$(F)/growth-rest.md: $(BENCH)/growth-rest.tsv
$(F)/growth.svg: plots/bench/growth.gp plots/style.gp $(BENCH)/growth.tsv
	$(draw)
$(F)/growth-rest.svg: plots/bench/growth.gp plots/style.gp $(BENCH)/growth-rest.tsv
	$(draw)

bench-clean: ## remove the data of the benchmarks
	rm -rf $(BENCH)

.PHONY: bench bench-peers features growth growth-rest bench-clean
