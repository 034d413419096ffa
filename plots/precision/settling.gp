# SPDX-License-Identifier: GPL-3.0-or-later
# Error of the fraction of settled beds against CPU time, by method and
# tolerance: of the mean over seeds, of single beds with friction, and of the
# mean without. A whisker that goes through the floor of its panel is of an error
# that the seeds cannot tell from zero; runs that failed are crosses at the top.
# The default of settle has a ring, the spread of seeds is a dashed line.
#   gnuplot -c plots/precision/settling.gp IN OUT
# IN: blocks by settling.awk.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 4
height = 1320
columns = "variant method tol step cpu_seconds spread difference interval rms status"
call "style.gp" "precision/settling.gp IN OUT" ARG2 ARG1

good(i) = strcol("status") eq "ok"
bad(i) = strcol("status") eq "failed"
default(i) = good(0) && strcol("method") eq "rkc" && strcol("tol") eq "5e-4"
# the blocks of a panel that have such rows
chosen(list, panel) = system(sprintf("awk -F'\t' '%s' '%s'", \
  "/^$/ { next } $1 == \"variant\" { b++; next } $1 == \"".panel."\" && ". \
  list." && !seen[b]++ { printf \" %d\", b }", ARG1))
# an empty loop, too, asks for the values of its first turn
of(list, i) = i > words(list) ? 1 : int(word(list, i))
stats ARG1 using (blocks = column(-2) + 1) nooutput
array method[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (method[b] = strcol("method"), 0) nooutput
}

bottom = 1e-6
top = 0.1
amount(p) = p == 2 ? column("rms") : abs(column("difference"))
shown(p) = amount(p) > 1.5*bottom ? amount(p) : 1.5*bottom
interval(p) = p == 2 || strcol("interval") eq "nan" ? 0 : column("interval")
low(p) = amount(p) - interval(p) > bottom ? amount(p) - interval(p) : bottom
high(p) = amount(p) + interval(p)
cpu(test) = test ? column("cpu_seconds") : NaN

set logscale xy
set format y "10^{%T}"
set xrange [0.04:50]
set yrange [bottom:top]
set lmargin at screen 0.18
variants = "rotation rotation basic"
headings = "'friction and rotation' 'friction and rotation, single beds' ". \
  "'no friction'"
ylabels = "'error of the mean union' 'rms error of the union' ". \
  "'error of the mean union'"
panel = 0.268
set multiplot
do for [p=1:3] {
  variant = word(variants, p)
  set tmargin at screen 0.985 - (p - 1)*(panel + 0.018)
  set bmargin at screen 0.985 - (p - 1)*(panel + 0.018) - panel
  set format x p == 3 ? "%h" : ""
  set xlabel p == 3 ? "CPU time for ".header(ARG1, "run")." (s)" : ""
  set ylabel word(ylabels, p)
  set label 1 word(headings, p) at graph 0.98,0.93 right
  stats ARG1 using (strcol("variant") eq variant && strcol("status") eq \
    "reference" ? column("spread") : NaN) nooutput
  spread = STATS_max
  set arrow 1 from graph 0,first spread to graph 1,first spread nohead dt 2 \
    lw 1.5*thin lc rgb grey
  ok = chosen("$NF == \"ok\"", variant)
  failed = chosen("$NF == \"failed\"", variant)
  ring = chosen("$NF == \"ok\" && $2 == \"rkc\" && $3 == \"5e-4\"", variant)
  plot for [i=1:words(ok)] ARG1 index of(ok, i)-1 using (cpu(good(0))): \
      (shown(p)):(low(p)):(high(p)) with yerrorbars lw thin pt 0 \
      lc rgb method_colour(method[of(ok, i)]) notitle, \
    for [i=1:words(ok)] ARG1 index of(ok, i)-1 using (cpu(good(0))): \
      (shown(p)) with linespoints lw line \
      pt method_point(method[of(ok, i)]) ps symbol \
      lc rgb method_colour(method[of(ok, i)]) notitle, \
    for [i=1:words(failed)] ARG1 index of(failed, i)-1 using \
      (words(failed) ? cpu(bad(0)) : 1):(words(failed) ? top : 9*top) with points pt 2 ps 1.6*symbol lw line \
      lc rgb method_colour(method[of(failed, i)]) notitle, \
    for [i=1:words(ring)] ARG1 index of(ring, i)-1 using (cpu(default(0))): \
      (shown(p)) with points pt 6 ps 2.6*symbol lw line lc rgb black notitle, \
    for [m in p == 1 ? "merson dopri5 rkf45 rkc verlet" : ""] keyentry \
      with linespoints lw line pt method_point(m) ps symbol \
      lc rgb method_colour(m) title method_title(m), \
    for [m in p == 1 ? "default" : ""] keyentry with points pt 6 \
      ps 2.6*symbol lw line lc rgb black title "settle's default", \
    for [m in p == 1 ? "spread" : ""] keyentry with lines dt 2 lw 1.5*thin \
      lc rgb grey title "spread of seeds"
  unset key
}
unset multiplot
