# SPDX-License-Identifier: GPL-3.0-or-later
# Shots out of free flight, no cap on travel: share of those at a sphere that
# are missed, and of those at a wall that come out with a wrong speed or not at
# all; one map a method.
#   gnuplot -c plots/stability/tunnel.gp IN OUT
# IN: columns method target travel speed tol runs missed wrong failed.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 0
height = 1080
columns = "method target travel speed tol runs missed wrong failed"
call "style.gp" "stability/tunnel.gp IN OUT" ARG2 ARG1

methods = "merson dopri5 rkf45 rkck rk8pd rkc"
# rows of IN are looked up by these, in the order that they have
list(k) = system("awk -F '\t' '/^#/ { next } !n++ { next } !s[$".k. \
  "]++ { printf \"%s \", $".k." }' '".ARG1."'")
speeds = list(4)
tols = list(5)
index_of(words_, w) = sum [i=1:words(words_)] (word(words_, i) eq w ? i : 0)
row(m, target) = strcol("method") eq m && strcol("target") eq target && \
  column("travel") == 0
lost(target) = (target eq "sphere" ? column("missed") : \
  column("wrong") + column("failed"))/column("runs")
# white to the colour of failure
mix(low, share) = int(255 + share*(low - 255) + 0.5)
shade(share) = 65536*mix(213, share) + 256*mix(94, share) + mix(0, share)

unset key
unset grid
set xrange [0.5:words(speeds)+0.5]
set yrange [words(tols)+0.5:0.5]
set style fill solid 1 border rgb "#BBBBBB"
set tics scale 0
set multiplot
cell_width = 0.268
cell_height = 0.165
do for [t=1:2] {
  target = word("sphere wall", t)
  top = t == 1 ? 0.93 : 0.44
  heading = (t == 1 ? "another sphere: missed (%)" : \
    "a wall: wrong speed or gave up (%)")
  do for [i=1:6] {
    m = word(methods, i)
    x = 0.165 + ((i - 1) % 3)*(cell_width + 0.005)
    y = top - int((i - 1)/3)*(cell_height + 0.034)
    set lmargin at screen x
    set rmargin at screen x + cell_width
    set tmargin at screen y
    set bmargin at screen y - cell_height
    set title method_title(m).(m eq "rkc" ? ", tol. in m/s" : "") offset 0,-0.9
    unset xtics
    unset ytics
    unset xlabel
    unset ylabel
    unset label
    if (i == 1) { set label 1 heading at screen 0.55,top + 0.045 center }
    if ((i - 1) % 3 == 0) {
      set ytics ()
      do for [k=1:words(tols)] {
        set ytics add (word(tols, k) k)
      }
      set ylabel "{/:Italic δ} (m/s^2)" offset 0.5,0
    }
    if (i > 3) {
      set xtics () offset 0,0.5
      do for [k=1:words(speeds)] {
        set xtics add (word(speeds, k) k)
      }
      set xlabel "speed (m/s)" offset 0,0.9
    }
    plot ARG1 using (row(m, target) ? index_of(speeds, strcol("speed")) : \
        NaN):(index_of(tols, strcol("tol"))):(0.5):(0.5): \
        (shade(lost(target))) with boxxyerror lc rgb variable, \
      ARG1 using (row(m, target) ? index_of(speeds, strcol("speed")) : \
        NaN):(index_of(tols, strcol("tol"))): \
        (sprintf("%.0f", 100*lost(target))) with labels \
        font ",16"
  }
}
unset multiplot
