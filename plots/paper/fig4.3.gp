# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.3: solids volume fraction in the unit cube against time: mean (line)
# and range (band) over the seeds, one block of the file for each variant.
#   gnuplot -c plots/paper/fig4.3.gp IN OUT
# IN: columns variant, t, mean, min, max.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 2
columns = "variant t mean min max"
call "style.gp" "paper/fig4.3.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
array variant[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (variant[b] = strcol("variant"), 0) nooutput
}

set xlabel "time {/:Italic t} (s)"
set ylabel "volume fraction {/:Italic ε}_s (sum of spheres)"
set xrange [*:*] noextend
set yrange [0:*]
plot for [b=1:blocks] ARG1 index b-1 using "t":"min":"max" \
    with filledcurves fc rgb variant_colour(variant[b]) notitle, \
  for [b=1:blocks] ARG1 index b-1 using "t":"mean" with lines \
    lw line dt variant_dash(variant[b]) lc rgb variant_colour(variant[b]) \
    title variant_title(variant[b])
