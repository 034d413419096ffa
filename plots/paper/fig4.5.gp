# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.5: speed-up (above) and parallel efficiency (below) against cores,
# one block of the file for each curve, a method with a number of spheres. Bars
# are the least and largest of the runs.
#   gnuplot -c plots/paper/fig4.5.gp IN OUT
# IN: columns method, n, threads, speedup, least, most, and independent,
# independent_least, independent_most (what as many runs of one thread keep of
# their speed side by side: the machine's own limit).
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 700
columns = "method n threads speedup least most independent"
call "style.gp" "paper/fig4.5.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
stats ARG1 using "threads" nooutput
cores = STATS_max
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
# curves beside each other, so that their bars are apart
at(b) = column("threads") + 0.03*(b - 0.5*blocks)

set multiplot
set xrange [0.7:cores + 0.3]
set xtics 1
set format x ""
set ylabel "speed-up"
set yrange [0:cores + 0.2<*]

set bmargin at screen 0.6
do for [panel=1:2] {
  of(s, b) = panel == 1 ? s : s/column("threads")
  plot for [b=1:blocks] ARG1 index b-1 using (at(b)): \
      (of(column("speedup"), b)):(of(column("least"), b)): \
      (of(column("most"), b)) with yerrorbars lw line pt mark(b) ps symbol \
      lc rgb method_colour(name[b]) notitle, \
    for [b=1:blocks] ARG1 index b-1 using (at(b)): \
      (of(column("speedup"), b)) with linespoints lw line dt dash[b] \
      pt mark(b) ps symbol lc rgb method_colour(name[b]) title label[b], \
    for [b=1:blocks] ARG1 index b-1 using (at(b)): \
      (of(column("threads")*column("independent"), b)): \
      (of(column("threads")*column("independent_least"), b)): \
      (of(column("threads")*column("independent_most"), b)) \
      with yerrorbars lw thin pt 1 ps symbol lc rgb black \
      title b == 1 ? "independent runs" : "", \
    [0.7:cores + 0.3] (panel == 1 ? x : 1) \
      with lines lw 1.5*thin dt 3 lc rgb black title "ideal"
  unset key
  set format x "%h"
  set xlabel "cores"
  set ylabel "efficiency"
  set yrange [0:1.15<*]
  set ytics autofreq
  set tmargin at screen 0.55
  set bmargin at screen (87. + 28*key_rows)/height
}
unset multiplot
