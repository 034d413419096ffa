# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.5: speed-up (above) and parallel efficiency (below) against cores,
# one block of the file for each curve, a method with a number of spheres.
#   gnuplot -c plots/paper/fig4.5.gp IN OUT
# IN: columns method, n, threads, speedup, efficiency, independent (what as many
# runs of one thread keep of their speed side by side: the machine's own limit).
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 6
height = 740
columns = "method n threads speedup efficiency independent"
call "style.gp" "paper/fig4.5.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
array name[blocks]
array dash[blocks]
array label[blocks]
seen = ""
do for [b=1:blocks] {
  stats ARG1 index b-1 using (name[b] = strcol("method"), spheres = \
    column("n"), 0) nooutput
  label[b] = sprintf("%s, {/:Italic n} = %d", method_title(name[b]), spheres)
  # the numbers of spheres of one method: solid and filled, dashed and open
  dash[b] = strstrt(seen, "|".name[b]."|") > 0 ? 2 : 1
  seen = seen."|".name[b]."|"
}
mark(b) = method_point(name[b]) - (dash[b] > 1 && method_point(name[b])%2 > 0)

set logscale xy 2
set multiplot
set autoscale noextend
set offsets graph 0.06,graph 0.06,graph 0.06,graph 0.06
set format x ""
set ylabel "speed-up"
set bmargin at screen 0.6
plot for [b=1:blocks] ARG1 index b-1 using "threads":"speedup" \
    with linespoints lw line dt dash[b] pt mark(b) ps symbol \
    lc rgb method_colour(name[b]) title label[b], \
  ARG1 using "threads":"threads" with lines lw 1.5*thin dt 3 lc rgb black \
    title "ideal", \
  NaN with points pt 1 ps symbol lc rgb black \
    title "independent runs"
unset key
unset logscale y
set format x "%h"
set xlabel "cores"
set ylabel "efficiency"
set yrange [0:1.1]
set ytics 0.25
set tmargin at screen 0.55
set bmargin at screen (87. + 28*key_rows)/height
plot for [b=1:blocks] ARG1 index b-1 using "threads":"efficiency" \
    with linespoints lw line dt dash[b] pt mark(b) ps symbol \
    lc rgb method_colour(name[b]), \
  ARG1 using "threads":"independent" with points pt 1 ps symbol \
    lc rgb black, \
  ARG1 using "threads":(1) with lines lw 1.5*thin dt 3 lc rgb black
unset multiplot
