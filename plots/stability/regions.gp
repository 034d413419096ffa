# SPDX-License-Identifier: GPL-3.0-or-later
# Stability regions |R(z)| <= 1 of the methods, and the limits measured on
# contacts as points on the axes. Upper panel: pairs; lower: rkc.
#   gnuplot -c plots/stability/regions.gp REGIONS LIMITS OUT
# REGIONS: one block a method, columns method re im modulus, a grid; LIMITS:
# columns method axis measured.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 800
columns = ""
call "style.gp" "stability/regions.gp REGIONS LIMITS OUT" ARG3 ARG1 ARG2
regions = ARG1
limits = ARG2

stats regions using (blocks = column(-2) + 1) nooutput
array name[blocks]
do for [b=1:blocks] {
  stats regions index b-1 using (name[b] = strcol("method"), 0) nooutput
}
is_rkc(b) = name[b][:3] eq "rkc"
# the contours as curves
set contour base
set cntrparam levels discrete 1
unset surface
array contour_file[blocks]
do for [b=1:blocks] {
  contour_file[b] = system("mktemp")
  set table contour_file[b]
  splot regions index b-1 using "re":"im":"modulus" with lines
  unset table
}
unset contour
set surface

set multiplot
set datafile separator whitespace
unset datafile columnheaders
unset key
set xlabel "Re {/:Italic h λ}"
set ylabel "Im {/:Italic h λ}"
colour(b) = b == 7 ? black : method_colour(name[b])
on_axis(b, axis) = sprintf("< awk -F '\\t' '$1 == \"%s\" && $2 == \"%s\" " \
  ."{ print $4 }' '%s'", name[b], axis, limits)
set rmargin at screen 0.965

set tmargin at screen 0.975
set bmargin at screen 0.56
set xrange [-6:1.5]
set yrange [0:6]
plot \
  for [b=1:5] contour_file[b] using 1:2 with lines lw line \
    lc rgb colour(b) notitle, \
  for [b=1:5] on_axis(b, "real") using (-$1):(0) with points \
    pt method_point(name[b]) ps 1.4*symbol lc rgb colour(b) notitle, \
  for [b=1:5] on_axis(b, "imaginary") using (0):1 with points \
    pt method_point(name[b]) ps 1.4*symbol lc rgb colour(b) notitle

set tmargin at screen 0.465
set bmargin at screen (75. + 28*key_rows)/height
set xrange [-70:5]
set yrange [0:9]
set key at screen 0.5,0.02 center bottom vertical maxrows key_rows Left
plot for [b=6:7] contour_file[b] using 1:2 with lines lw line \
    lc rgb colour(b) notitle, \
  for [b=6:7] on_axis(b, "real") using (-$1):(0) with points \
    pt method_point(name[b]) ps 1.4*symbol lc rgb colour(b) notitle, \
  for [b=6:7] on_axis(b, "imaginary") using (0):1 with points \
    pt method_point(name[b]) ps 1.4*symbol lc rgb colour(b) notitle, \
  for [b=1:blocks] keyentry with linespoints lw line \
    pt method_point(name[b]) ps 1.4*symbol lc rgb colour(b) \
    title method_title(name[b])
unset multiplot
do for [b=1:blocks] {
  system("rm -f ".contour_file[b])
}
