# SPDX-License-Identifier: GPL-3.0-or-later
# Kinetic energy per sphere of beds without friction over time, as an envelope:
# beds of three stiffnesses (above), and the stiffest by method (below).
#   gnuplot -c plots/stability/vibration.gp IN OUT
# IN: blocks of runs, columns run (kappa-method), t and largest.
set loadpath system("dirname '".ARG0."'")."/.."
height = 880
columns = "run t largest"
call "style.gp" "stability/vibration.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
block(run) = int(system(sprintf("awk -F '\t' '$1 == \"run\" { b++ } ". \
  "$1 == \"%s\" { print b - 1; exit }' '%s'", run, ARG1)))
kappa(s) = s[:strstrt(s, "-")-1]
kappa_colour(s) = kappa(s) eq "30" ? orange : kappa(s) eq "150" ? blue : \
  vermillion
dash(s) = s[strstrt(s, "-")+1:] eq "rkc" ? 1 : 2
way(s) = "{/:Italic κ} = ".kappa(s).(dash(s) == 1 ? "" : ", Merson")
method_colour_of(s) = s eq "500-rkc" ? vermillion : s eq "500-merson" ? black : \
  s eq "500-loose" ? sky : purple
ways = "'RKC' 'Merson' 'Merson, {/:Italic δ} = 10 m/s^2' 'Merson, no cap'"

# by the panel
line_dash(s) = panel == 1 ? dash(s) : 1
line_colour(s) = panel == 1 ? kappa_colour(s) : method_colour_of(s)

stats ARG1 using "t" nooutput
end = STATS_max
set lmargin at screen 0.18
set logscale y
set xrange [0:end]
set yrange [1e-10:100]
set ytics 100
set mytics 1
set format y "10^{%T}"
set ylabel "kinetic energy per sphere (J)"
set multiplot
do for [panel=1:2] {
  runs = panel == 1 ? "30-rkc 150-rkc 150-merson 500-rkc" : \
    "500-rkc 500-merson 500-loose 500-outputs"
  set tmargin at screen panel == 1 ? 0.985 : 0.5
  set bmargin at screen panel == 1 ? 0.635 : 0.15
  set xlabel panel == 2 ? "time (s)" : ""
  unset label
  late = panel == 1 ? "150-rkc" : "500-outputs"
  if (end > 6) {
    stats ARG1 index block(late) using \
      (column("t") > 5 ? column("t") : NaN):"largest" nooutput
    if (STATS_max_y > 1e-6) {
      if (panel == 1) {
        set label 2 "late re-\narrangement" at \
          STATS_pos_max_y + 0.1*end,STATS_max_y/30 left
      } else {
        set label 2 "late rearrangement" at STATS_pos_max_y,STATS_max_y \
          center offset 0,1
      }
    }
  }
  heading = panel == 1 ? "by stiffness {/:Italic κ} (m^{-1}), RKC" : \
    "{/:Italic κ} = 500 m^{-1} by method"
  set label 1 heading at graph 0.98,0.93 right
  key_y = panel == 1 ? 0.525 : 0.005
  set key at screen 0.5,key_y center bottom maxrows 2
  plot for [r in runs] ARG1 index block(r) using "t":"largest" with lines \
      lw line dt line_dash(r) \
      lc rgb line_colour(r) notitle, \
    for [i=1:words(runs)] keyentry with lines lw line \
      dt line_dash(word(runs, i)) lc rgb line_colour(word(runs, i)) \
      title panel == 1 ? way(word(runs, i)) : word(ways, i)
}
unset multiplot
