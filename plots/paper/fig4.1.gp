# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.1: height of a bouncing sphere against time, one curve per file.
#   gnuplot -c plots/paper/fig4.1.gp IN1 IN2 IN3 OUT [TITLE1 TITLE2 TITLE3]
# IN: output of bounce, columns t and z.
set loadpath system("dirname '".ARG0."'")."/.."
columns = "t z"
call "style.gp" "paper/fig4.1.gp IN1 IN2 IN3 OUT [TITLE1 TITLE2 TITLE3]" \
  ARG4 ARG1 ARG2 ARG3

title1 = ARGC > 4 ? ARG5 : "{/:Italic e} = 1"
title2 = ARGC > 5 ? ARG6 : "{/:Italic e} = √2/2"
title3 = ARGC > 6 ? ARG7 : "{/:Italic e} = 0.4"

set xlabel "time {/:Italic t} (s)"
set ylabel "height {/:Italic x}_3 (m)"
set autoscale noextend
set offsets 0,0,0.7,0.7
plot ARG1 using "t":"z" with lines lw line dt 1 lc rgb blue title title1, \
  ARG2 using "t":"z" with lines lw line dt 2 lc rgb vermillion title title2, \
  ARG3 using "t":"z" with lines lw line dt 4 lc rgb green title title3
