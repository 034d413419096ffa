# SPDX-License-Identifier: GPL-3.0-or-later
# Beds as their contacts harden, in two codes: the union (above) and the contacts
# of a sphere (below) against the mean overlap of contacts, so that hard contacts
# are at the left edge.
#   gnuplot -c plots/beds/hardening.gp HARDENING OUT
# HARDENING: by plots/beds/hardening.sh.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1120
columns = "set overlap union error z z_error"
call "style.gp" "beds/hardening.gp HARDENING" ARG2 ARG1

array name[7] = ["settle 0", "lammps hooke 0", "lammps hertz 0", \
  "settle 0.2 1e-2", "settle 0.2 1e-3", \
  "lammps hooke 0.345", "lammps hertz 0.345"]
array title[7] = ["settle, no friction", "linear, no friction", \
  "Hertz, no friction", "settle, v_{min} = 1e-2", "settle, v_{min} = 1e-3", \
  "linear, friction", "Hertz, friction"]
colour(k) = k < 4 ? blue : vermillion
dash(k) = int(word("1 2 4 1 3 2 4", k))
point(k) = int(word("7 4 8 7 13 4 8", k))
in_set(k, y) = strcol("set") eq name[k] ? column(y) : NaN
present = ""
do for [k=1:7] {
  present = present.(int(system(sprintf("grep -c '^%s\t' '%s' || true", \
    name[k], ARG1))) > 0 ? sprintf(" %d", k) : "")
}
set logscale x
set xrange [1e-4:0.1]
set format x "10^{%T}"
set xlabel "mean overlap of contacts (diameters)"
set multiplot
set tmargin at screen 0.985
set bmargin at screen 0.62
set ylabel "solid fraction (union)"
unset key
plot for [k in present] ARG1 using "overlap":(in_set(int(k), "union")) with lines lw line \
    dt dash(int(k)) lc rgb colour(int(k)), \
  for [k in present] ARG1 using "overlap":(in_set(int(k), "union")):"error" \
    with yerrorbars pt point(int(k)) ps symbol lw thin lc rgb colour(int(k))
set tmargin at screen 0.53
set bmargin at screen 0.185
set ylabel "contacts of a sphere"
set key at screen 0.5,0.01 center bottom maxrows 4
plot for [k in present] ARG1 using "overlap":(in_set(int(k), "z")) with linespoints \
  lw line dt dash(int(k)) pt point(int(k)) ps symbol lc rgb colour(int(k)) title title[int(k)]
unset multiplot
