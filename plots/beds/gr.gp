# SPDX-License-Identifier: GPL-3.0-or-later
# Pair correlation of the spheres' centres, one block of the file per variant,
# with bands of its 95 % confidence over the beds.
#   gnuplot -c plots/beds/gr.gp IN OUT
# IN: columns variant, r, g, interval; to its largest r.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 1
columns = "variant r g interval"
call "style.gp" "beds/gr.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
array variant[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (variant[b] = strcol("variant"), 0) nooutput
}
stats ARG1 using "r" nooutput

set xlabel "distance of the centres {/:Italic r} (nominal diameters)"
set ylabel "pair correlation {/:Italic g}({/:Italic r})"
set xrange [0.8:STATS_max]
# what tells the beds apart is below the first peak
set logscale y
set yrange [0.2:8]
set ytics (0.2, 0.5, 1, 2, 5)
set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead lw thin dt 3 \
  lc rgb grey
above(v) = v > 0.02 ? v : 0.02
plot for [b=1:blocks] ARG1 index b-1 using "r": \
  (above(column("g") - column("interval"))): \
  (above(column("g") + column("interval"))) with filledcurves \
  fs transparent solid 0.25 noborder lc rgb variant_colour(variant[b]) \
  notitle, for [b=1:blocks] ARG1 index b-1 using "r":"g" with lines \
  lw line dt variant_dash(variant[b]) lc rgb variant_colour(variant[b]) \
  title variant_title(variant[b])
