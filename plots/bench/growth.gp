# SPDX-License-Identifier: GPL-3.0-or-later
# CPU time to settle a bed against the number of spheres (top), and the fraction
# that each run gave (bottom): methods of settle, and other codes with two
# stiffnesses.
#   gnuplot -c plots/bench/growth.gp IN OUT
# IN: blocks by growth.awk.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 950
columns = "run spheres union"
call "style.gp" "bench/growth.gp IN OUT" ARG2 ARG1

runs = system("awk -F '\t' '!/^#/ && NF && $1 != \"run\" && !s[$1]++ ". \
  "{ printf \"%s \", $1 }' '".ARG1."'")
code(r) = r[:strstrt(r."-", "-") - 1]
peer(r) = code(r) eq "lammps" || code(r) eq "liggghts"
stiff(r) = r[strlen(r) - 2:]
colour(r) = !peer(r) ? method_colour(r) : code(r) eq "lammps" ? blue : orange
point(r) = !peer(r) ? method_point(r) : stiff(r) eq "1e4" ? 6 : 4
dash(r) = !peer(r) ? 1 : stiff(r) eq "1e4" ? 2 : 4
name(r) = !peer(r) ? "settle, ".method_title(r) : (code(r) eq "lammps" ? \
  "LAMMPS" : "LIGGGHTS").", 10^".stiff(r)[3:]." N/m"

set logscale x
set offsets graph 0.04,graph 0.04,0,0
set multiplot
set tmargin at screen 0.975
set bmargin at screen 0.53
set logscale y
set format y "10^{%T}"
set format x ""
rests = int(system("grep -c 'end (s)' '".ARG1."'")) # runs with an end each
set ylabel "CPU time to ".(rests ? "rest" : "8 s")." (s)"
unset key
plot for [r in runs] ARG1 using (strcol("run") eq r ? column("spheres") : NaN): \
  "CPU (s)" with linespoints lw line dt dash(r) pt point(r) ps symbol \
  lc rgb colour(r)
set tmargin at screen 0.505
set bmargin at screen 0.2
unset logscale y
set format y "%h"
set format x "%h"
set xlabel "spheres"
set ylabel "union"
set key at screen 0.5,0.01 center bottom vertical maxrows 4 width -2
plot for [r in runs] ARG1 using (strcol("run") eq r ? column("spheres") : NaN): \
  "union" with linespoints lw line dt dash(r) pt point(r) ps symbol \
  lc rgb colour(r) title name(r)
unset multiplot
