# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.4: accepted time steps against time for the three model variants.
#   gnuplot -c plots/paper/fig4.4.gp BASIC FRICTION ROTATION OUT
# IN: log of settle, one row for each accepted step, columns t and steps.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 2
columns = "t steps"
call "style.gp" "paper/fig4.4.gp BASIC FRICTION ROTATION OUT" ARG4 ARG1 ARG2 ARG3

variants = "basic friction rotation"
array rows[3]
do for [i=1:3] {
  stats value("ARG".i) using (column("steps")) nooutput
  rows[i] = STATS_records
}
# a thousand points a curve, with the first hundred (the axis is a log) and
# the last
keep(row, i) = row < 100 || row % (rows[i]/1000 + 1) == 0 || row == rows[i] - 1

set xlabel "time {/:Italic t} (s)"
set ylabel "accepted steps"
set xrange [0:*] noextend
set logscale y
set format y "10^{%T}"
set ytics 10
set mytics 10
plot for [i=1:3] value("ARG".i) \
  using "t":(keep(int($0), i) ? column("steps") : NaN) with lines lw line \
  dt variant_dash(word(variants, i)) lc rgb variant_colour(word(variants, i)) \
  title variant_title(word(variants, i))
