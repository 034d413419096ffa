# SPDX-License-Identifier: GPL-3.0-or-later
# Benchmarks: never part of the tests, since machines are shared. Every speed
# stands beside the fraction that it gave. `make bench-clean` forgets the runs.
BENCH := $(D)/bench

# Methods by name: what settle is told, and the seeds that are run. The paper's
# own way, every pair twice, takes minutes per seed for the full model.
BENCH_METHODS := allpairs merson dopri5 rkf45 rk8pd rkc verlet
BENCH_allpairs := --pairs all --method merson
BENCH_merson := --method merson
BENCH_dopri5 := --method dopri5
BENCH_rkf45 := --method rkf45
BENCH_rk8pd := --method rk8pd
BENCH_rkc := --method rkc
BENCH_verlet := --method verlet --step 2.5e-5
BENCH_SEEDS_allpairs := 1
BENCH_SEEDS_merson := 1 2 3 4 5 6 7 8 9 10
BENCH_SEEDS_dopri5 := 1 2 3
BENCH_SEEDS_rkf45 := 1 2 3
BENCH_SEEDS_rk8pd := 1 2 3
BENCH_SEEDS_rkc := 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20
BENCH_SEEDS_verlet := 1 2 3

# $(call bench_run,VARIANT,METHOD,SEED)
define bench_run
$(BENCH)/$(1)-$(2)-$(3).tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $$(@D)
	$(SETTLE) --model $(1) $$(BENCH_$(2)) --seed $(3) \
	  --stats $$(@:.tsv=.stats) | $(B)/analyze $(BOX) > $$@
endef
$(foreach v,$(VARIANTS),$(foreach m,$(BENCH_METHODS),\
  $(foreach s,$(BENCH_SEEDS_$(m)),$(eval $(call bench_run,$(v),$(m),$(s))))))

BENCH_RUNS := $(foreach v,$(VARIANTS),$(foreach m,$(BENCH_METHODS),\
  $(BENCH_SEEDS_$(m):%=$(BENCH)/$(v)-$(m)-%.tsv)))

bench: $(F)/bench.md $(F)/bench.svg $(F)/scaling.md $(F)/scaling.svg ## CPU time beside accuracy, by method; cost per sphere up to 100,000
	@cat $(F)/bench.md $(F)/scaling.md
$(BENCH)/bench.tsv: plots/bench/methods.sh plots/bench/bench.mk $(BENCH_RUNS)
	$< $(BENCH) > $@
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

PEERS_QUICK := SEEDS=1 STEP=4 TIME=0.5
bench-peers: $(F)/peers.md ## LAMMPS and LIGGGHTS on the same 200 spheres, where installed
	@cat $<
.PHONY: $(BENCH)/peers.tsv
$(BENCH)/peers.tsv: plots/bench/peers/peers.sh | $(B)/settle $(B)/analyze
	@mkdir -p $(@D)
	B=$(B) $(if $(QUICK),$(PEERS_QUICK)) $< > $@
$(F)/peers.md: $(BENCH)/peers.tsv

bench-clean: ## remove the data of the benchmarks
	rm -rf $(BENCH)

.PHONY: bench bench-peers bench-clean
