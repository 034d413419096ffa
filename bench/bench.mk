# SPDX-License-Identifier: GPL-3.0-or-later
# Benchmarks: never part of the tests, since machines are shared. Every speed
# stands beside the fraction it was had at. One file a run under build/bench, so
# a stopped make goes on where it was; `make bench-clean` begins anew.
BD := $(B)/bench

# Methods by name: what settle is told, and the seeds that are run. The paper's
# own way, every pair twice, takes minutes a seed for the full model.
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
BENCH_RUNS += $(BD)/$(1)-$(2)-$(3).tsv
$(BD)/$(1)-$(2)-$(3).tsv: | $(B)/settle $(B)/analyze
	@mkdir -p $(BD)
	$(B)/settle --quiet --model $(1) $$(BENCH_$(2)) --seed $(3) \
	  --stats $(BD)/$(1)-$(2)-$(3).stats | $(B)/analyze > $$@
endef
$(foreach v,basic friction rotation,$(foreach m,$(BENCH_METHODS),\
  $(foreach s,$(BENCH_SEEDS_$(m)),$(eval $(call bench_run,$(v),$(m),$(s))))))

bench: $(F)/bench.md $(F)/bench.svg $(F)/scaling.md $(F)/scaling.svg ## CPU time beside accuracy, by method; cost per sphere up to 100,000
	@cat $(F)/bench.md $(F)/scaling.md
$(BD)/bench.tsv: $(BENCH_RUNS) bench/methods.sh
	bench/methods.sh $(BD) > $@
$(F)/bench.md: $(BD)/bench.tsv bench/markdown.awk
	@mkdir -p $(F)
	awk -f bench/markdown.awk $< > $@
$(F)/bench.svg: $(BD)/bench.tsv plots/bench.gp plots/style.gp
	$(call draw,bench.gp,$(BD)/bench.tsv,bench)

$(BD)/scaling.tsv: bench/scaling.sh bench/tile.awk | $(B)/settle
	@mkdir -p $(BD)
	B=$(B) bench/scaling.sh > $@
$(F)/scaling.md: $(BD)/scaling.tsv bench/markdown.awk
	@mkdir -p $(F)
	awk -f bench/markdown.awk $< > $@
$(F)/scaling.svg: $(BD)/scaling.tsv plots/scaling.gp plots/style.gp
	$(call draw,scaling.gp,$(BD)/scaling.tsv,scaling)

bench-peers: all ## LAMMPS and LIGGGHTS on the same 200 spheres, where installed
	@mkdir -p $(F)
	B=$(B) bench/peers/peers.sh > $(F)/peers.tsv
	@awk -f bench/markdown.awk $(F)/peers.tsv | tee $(F)/peers.md

bench-clean: ## forget the benchmarks' runs
	rm -rf $(BD)

.PHONY: bench bench-peers bench-clean
