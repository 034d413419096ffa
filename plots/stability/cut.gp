# SPDX-License-Identifier: GPL-3.0-or-later
# The cut at lmax puts a floor under the accuracy. Upper panel: error of the gap
# after a collision by tolerance, for several lmax, and the floors by the
# formula. Lower panel: error of the speed by cost for several tapers. A colour
# stands for one force.
#   gnuplot -c plots/stability/cut.gp IN OUT
# IN: columns method taper lmax tol error_velocity error_gap evaluations.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1040
columns = "method taper lmax tol error_velocity error_gap evaluations"
call "style.gp" "stability/cut.gp IN OUT" ARG2 ARG1

# F0 = 10 N, kappa = 150/m, unit mass, v = 1 m/s
floor_of(lmax) = 2*10*exp(-150*lmax)/150*(150*lmax + log(2*150/10.) - 1)
lmaxes = "0.05 0.1 0.15 0.2"
colours = vermillion." ".blue." ".green." ".purple
of(m, taper, lmax) = strcol("method") eq m && strcol("taper") eq taper && \
  strcol("lmax") eq lmax
stats ARG1 using "tol" nooutput
tightest = STATS_min
loosest = STATS_max
stats ARG1 using (strcol("method") eq "rk8pd" ? column("evaluations") : NaN) \
  nooutput
least = STATS_min
most = STATS_max
set logscale xy
set format "10^{%T}"
set lmargin at screen 0.19
set multiplot

set tmargin at screen 0.985
set bmargin at screen 0.655
set xrange [tightest:loosest] noextend
set xtics 100
set mxtics 1
set ytics 100
set yrange [1e-13:1]
set mytics 1
set xlabel "tolerance (m/s)"
set ylabel "error of the gap (1/{/:Italic κ})"
set key at screen 0.52,0.535 center bottom vertical maxrows 2 width -2
do for [i=1:4] {
  set label i word(lmaxes, i)." m" at graph 0.02,first \
    5*floor_of(real(word(lmaxes, i))) left tc rgb word(colours, i)
}
set label 5 "{/:Italic l}_{max}:" at graph 0.02,0.93 left
plot for [i=1:4] floor_of(real(word(lmaxes, i))) with lines lw 2*thin dt 2 \
    lc rgb word(colours, i) notitle, \
  for [i=1:4] ARG1 using (of("rk8pd", "none", word(lmaxes, i)) ? \
    column("tol") : NaN):"error_gap" with linespoints lw line \
    pt method_point("rk8pd") ps symbol lc rgb word(colours, i) notitle, \
  for [i=1:4] ARG1 using (of("merson", "none", word(lmaxes, i)) ? \
    column("tol") : NaN):"error_gap" with points pt 6 ps 0.8*symbol lw thin \
    lc rgb word(colours, i) notitle, \
  keyentry with linespoints lw line pt method_point("rk8pd") ps symbol \
    lc rgb grey title "RK8PD", \
  keyentry with points pt 6 ps 0.8*symbol lw thin lc rgb grey \
    title "Merson", \
  keyentry with lines lw 2*thin dt 2 lc rgb grey title "floor by the formula"
unset label

set tmargin at screen 0.50
set bmargin at screen 0.175
set xrange [0.9*least:1.1*most]
set format x "%g"
set xtics (1000, 1500, 2000, 3000, 4000, 5000)
set yrange [1e-16:1e-6]
set xlabel "evaluations, RK8PD"
set ylabel "relative error of the speed"
set key at screen 0.5,0.01 center bottom vertical maxrows 3 width 0
case_tapers = "none none shift c1 c2"
case_lmaxes = "0.1 0.2 0.1 0.1 0.1"
case_colours = blue." ".purple." ".orange." ".sky." ".black
case_titles = "'cut, 0.1 m' 'cut, 0.2 m' 'shifted, 0.1 m' ". \
  "'C^1 taper, 0.1 m' 'C^2 taper, 0.1 m'"
plot for [i=1:5] ARG1 using (of("rk8pd", word(case_tapers, i), \
    word(case_lmaxes, i)) ? column("evaluations") : NaN): \
    (column("error_velocity") > 0 ? column("error_velocity") : NaN) \
    with linespoints lw line pt int(word("13 13 7 5 9", i)) ps symbol \
    lc rgb word(case_colours, i) title word(case_titles, i)
unset multiplot
