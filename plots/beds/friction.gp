# SPDX-License-Identifier: GPL-3.0-or-later
# Solid fraction (union, above) and coordination number (below) of settled beds
# against the friction coefficient: means over seeds with 95 % intervals, and
# the standard deviation of one bed as a band.
#   gnuplot -c plots/beds/friction.gp IN OUT
# IN: a summary by sweep: friction, n, union, union_se, z, z_se.
set loadpath system("dirname '".ARG0."'")."/.."
height = 860
columns = "friction n union union_se z z_se"
call "style.gp" "beds/friction.gp IN OUT" ARG2 ARG1

interval = 1.96
spread(name) = column(name."_se")*sqrt(column("n"))
set xrange [-0.03:1.03]
set multiplot
set tmargin at screen 0.985
set bmargin at screen 0.6
set ylabel "solid fraction (union)"
set xlabel "friction coefficient {/:Italic φ}"
unset key
do for [panel=1:2] {
  name = word("union z", panel)
  if (panel == 2) {
    set tmargin at screen 0.49
    set bmargin at screen 0.155
    set ylabel "contacts per sphere"
    set key at screen 0.5,0.01 center bottom maxrows 1 samplen 2
  }
  plot ARG1 using "friction":(column(name) - spread(name)): \
      (column(name) + spread(name)) with filledcurves lc rgb sky \
      title "one bed, ± std. dev.", \
    ARG1 using "friction":(column(name)):(interval*column(name."_se")) \
      with yerrorlines pt 7 ps 0.7*symbol lw line lc rgb blue \
      title "mean, 95 %"
}
unset multiplot
