#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Outcomes of beds: one row per cell of the map, from rows of plots/beds/bed.sh.
#   map.sh ROW... > MAP
# A cell is a panel (model, method; -free without the limit by travel, -short
# with lmax = 0.1 m for soft spheres as well), a tolerance or step, and kappa; of
# its seeds it shows the worst outcome:
#   stopped    an energy no fall can give (over 100 J a sphere) or no number
#   tunnelled  a sphere's centre is outside a wall at a frame or in the end
#   gave_up    no step was short enough for the tolerance, or the CPU time did
#              not suffice for steps that short
#   jitter     kinetic energy per sphere above 0.01 J (14 cm/s) in the last
#              eighth of the time, and not below half of the eighth before;
#              rearrangements of slow beds reach 0.004 J
#   denser, looser  the fraction, mean over seeds, differs from that of rkc at
#              its smallest tolerance by more than 0.005, or 0.02 in the basic
#              variant, where it is by chance that seeds differ
#   settled    none of these
set -eu
export LC_ALL=C
printf 'panel\tsetting\tkappa\toutcome\tseeds\tof\tdifference\tkinetic\n'
awk -F '\t' -v OFS='\t' '
  FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
  function get(name) { return $(at[name]) }
  {
    soft = get("kappa") < 100
    kind = get("travel") == "0" ? "-free" : \
      soft && get("lmax") == "0.1" ? "-short" : ""
    panel = get("model") "-" get("method")
    setting = get("step") == "-" ? get("tol") : get("step")
    bed = get("model") "\t" get("kappa") "\t" get("seed")
    add(panel kind "\t" setting "\t" get("kappa"))
    # hard ones are the same with either lmax
    if (!soft && panel == "basic-merson" && kind == "")
      add(panel "-short\t" setting "\t" get("kappa"))
    if (get("method") == "rkc" && kind == "" && \
        (!(bed in sharp) || setting + 0 < sharp[bed])) {
      sharp[bed] = setting + 0
      reference[bed] = get("union")
    }
  }
  function add(cell,  e, i) {
    if (!(cell in of)) order[++cells] = cell
    i = ++of[cell]
    beds[cell, i] = bed
    union[cell, i] = get("union")
    e = get("kinetic")
    kinetic[cell] = e > kinetic[cell] ? e : kinetic[cell] + 0
    was[cell, i] = e !~ /^[0-9]/ || e > 100 ? "stopped" : \
      get("status") == "stuck" ? "gave_up" : \
      get("outside") > 0 || get("status") == "outside" ? "tunnelled" : \
      get("status") != "ok" ? "gave_up" : \
      e > 0.01 && e > get("kinetic_before") / 2 ? "jitter" : "settled"
  }
  END {
    words = split("settled jitter gave_up tunnelled stopped", worse, " ")
    for (c = 1; c <= cells; c++) {
      cell = order[c]
      worst = 1
      sum = done = 0
      for (i = 1; i <= of[cell]; i++) {
        for (k = worst; k <= words; k++)
          if (was[cell, i] == worse[k]) worst = k
        if (was[cell, i] == "settled" && beds[cell, i] in reference) {
          sum += union[cell, i] - reference[beds[cell, i]]
          done++
        }
      }
      difference = done ? sum / done : "nan"
      outcome = worse[worst]
      for (seeds = i = 0; i++ < of[cell];) seeds += was[cell, i] == outcome
      limit = cell ~ /^basic/ ? 0.02 : 0.005
      if (outcome == "settled" && done && difference > limit)
        outcome = "denser"
      if (outcome == "settled" && done && difference < -limit)
        outcome = "looser"
      print cell, outcome, seeds, of[cell], difference, kinetic[cell]
    }
  }' "$@"
