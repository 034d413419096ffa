# SPDX-License-Identifier: GPL-3.0-or-later
# What a tolerance does to single beds against what it costs, for 200 and 2,000
# spheres; both by the sharp runs, multirate at 5e-4.
#   gnuplot -c plots/precision/tolerance.gp IN OUT
# IN: table of tolerance.sh; beds that are not in it are left out.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 2
height = 560
columns = "bed"
call "style.gp" "precision/tolerance.gp IN OUT" ARG2 ARG1

array bed = ["friction-0.2", "2000-spheres"]
array name = ["200 spheres", "2,000 spheres"]
array colour = [blue, vermillion]
method(how) = how[:strstrt(how, ",") - 1]
tolerance(how) = how[strstrt(how, ",") + 2:]
# of a bed's rows by a method, all but the sharp runs
pick(k, m, what) = strcol("bed") eq bed[k] && method(strcol(2)) eq m && \
  strcol("rms of single beds") ne "-" ? column(what) : NaN
# labels keep clear of the other line
on_right(k, how) = (tolerance(how) eq "2e-3") == (k == 2)
cost = "CPU time by that of the sharp runs"

set logscale xy
set xrange [0.45:5]
set yrange [1e-4:2e-2]
set format y "10^{%T}"
set xtics (0.5, 1, 2, 4)
set lmargin at screen 0.18
set xlabel "CPU time, by that of multirate at 5e-4 m/s"
set ylabel "rms difference of the union"
plot for [k=1:2] ARG1 using (pick(k, "multirate", cost)): \
    "rms of single beds" with linespoints lw line pt 14 ps symbol \
    lc rgb colour[k] title name[k].", multirate", \
  for [k=1:2] ARG1 using (pick(k, "rkc", cost)):"rms of single beds" \
    with points lw line pt 6 ps symbol lc rgb colour[k] title name[k].", RKC", \
  for [k=1:2] for [right=0:1] ARG1 \
    using (right == on_right(k, strcol(2)) ? pick(k, "multirate", cost) : NaN): \
    "rms of single beds":(tolerance(strcol(2))) with labels \
    offset right ? 3.5 : -3.5,0.2 tc rgb colour[k] notitle
