# SPDX-License-Identifier: GPL-3.0-or-later
# How far runs of the same start are from a sharp one over time: the time for
# which a trajectory is determined. A panel a variant.
#   gnuplot -c plots/precision/horizon.gp IN OUT
# IN: blocks by horizon.awk; method again is the sharp run's rival.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 2
height = 860
columns = "variant method t distance"
call "style.gp" "precision/horizon.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
array variant[blocks]
array method[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (variant[b] = strcol("variant"), \
    method[b] = strcol("method"), 0) nooutput
}
of(v) = v eq "rotation" ? rotation : basic
rotation = basic = ""
do for [b=1:blocks] {
  if (variant[b] eq "rotation") { rotation = rotation.sprintf(" %d", b) }
  if (variant[b] eq "basic") { basic = basic.sprintf(" %d", b) }
}
nth(list, i) = i > words(list) ? 1 : int(word(list, i))
dash(m) = m eq "again" ? 2 : 1
colour(m) = m eq "again" ? grey : method_colour(m)
title_of(m) = m eq "again" ? "two sharp runs" : method_title(m)
set logscale y
set yrange [1e-13:10]
set ytics 1e3
set format y "10^{%T}"
set lmargin at screen 0.18
set ylabel "largest distance (diameters)"
set multiplot
do for [p=1:2] {
  list = of(word("rotation basic", p))
  set tmargin at screen 0.975 - (p - 1)*0.415
  set bmargin at screen 0.975 - (p - 1)*0.415 - 0.385
  set format x p == 2 ? "%h" : ""
  set xlabel p == 2 ? "time (s)" : ""
  set label 1 word("'friction and rotation' 'no friction'", p) \
    at graph 0.98,0.07 right
  plot for [i=1:words(list)] ARG1 index nth(list, i)-1 using "t":"distance" \
    with lines lw line dt dash(method[nth(list, i)]) \
    lc rgb colour(method[nth(list, i)]) title title_of(method[nth(list, i)])
  unset key
}
unset multiplot
