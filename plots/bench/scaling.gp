# SPDX-License-Identifier: GPL-3.0-or-later
# Cost per sphere and evaluation against the number of spheres.
#   gnuplot -c plots/bench/scaling.gp IN OUT
# IN: columns spheres, ns_per_sphere_and_evaluation.
set loadpath system("dirname '".ARG0."'")."/.."
columns = "spheres ns_per_sphere_and_evaluation"
call "style.gp" "bench/scaling.gp IN OUT" ARG2 ARG1

set logscale x
set yrange [0:*]
set offsets 0,0,graph 0.1,0
set xlabel "spheres"
set ylabel "time per sphere and evaluation (ns)"
plot ARG1 using "spheres":"ns_per_sphere_and_evaluation" with linespoints \
  lw line pt method_point("rkc") ps symbol lc rgb method_colour("rkc") \
  title "full model, RKC, one thread"
