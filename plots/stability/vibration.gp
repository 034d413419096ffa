# SPDX-License-Identifier: GPL-3.0-or-later
# Kinetic energy per sphere of beds without friction over time: colour by kappa,
# dash by method.
#   gnuplot -c plots/stability/vibration.gp IN OUT
# IN: blocks of runs, columns run (kappa-method), t and kinetic.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 4
columns = "run t kinetic"
call "style.gp" "stability/vibration.gp IN OUT" ARG2 ARG1

stats ARG1 using (blocks = column(-2) + 1) nooutput
array run[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (run[b] = strcol("run"), 0) nooutput
}
kappa(s) = s[:strstrt(s, "-")-1]
method(s) = s[strstrt(s, "-")+1:]
colour(s) = kappa(s) eq "30" ? orange : kappa(s) eq "150" ? blue : vermillion
dash(s) = method(s) eq "rkc" ? 1 : method(s) eq "merson" ? 2 : \
  method(s) eq "loose" ? 3 : 4
set lmargin at screen 0.18
set logscale y
set yrange [1e-16:100]
set ytics 1e3
set format y "10^{%T}"
set xlabel "time (s)"
set ylabel "kinetic energy per sphere (J)"
ways = "'RKC' 'Merson' 'Merson, {/:Italic δ} = 10' 'Merson, no cap'"
plot for [b=1:blocks] ARG1 index b-1 using "t":"kinetic" with lines \
    lw (dash(run[b]) == 4 ? line : 0.6*line) dt dash(run[b]) \
    lc rgb colour(run[b]) notitle, \
  for [k in "30 150 500"] keyentry with lines lw line \
    lc rgb colour(k."-") title "{/:Italic κ} = ".k." m^{-1}", \
  keyentry with points pt 0 lc rgb "white" title " ", \
  for [i=1:4] keyentry with lines lw (i == 4 ? line : 0.6*line) dt i \
    lc rgb black title word(ways, i)
