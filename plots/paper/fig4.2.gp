# SPDX-License-Identifier: GPL-3.0-or-later
# Fig. 4.2: the spheres at the start and settled by the three variants, their
# last frames drawn to one scale.
#   gnuplot -c plots/paper/fig4.2.gp START BASIC FRICTION ROTATION OUT
set loadpath system("dirname '".ARG0."'")."/.."
width = 700
height = 800
columns = "id x y z r"
call "style.gp" "paper/fig4.2.gp START BASIC FRICTION ROTATION OUT" \
  ARG5 ARG1 ARG2 ARG3 ARG4

array top[4]
array last[4]
do for [i=1:4] {
  stats value("ARG".i) using (last[i] = column(-2)) nooutput
  stats value("ARG".i) index last[i] using (column("z") + column("r")) nooutput
  top[i] = STATS_max
}
least(x, y) = x < y ? x : y
most(x, y) = x > y ? x : y

# the start at the left, the beds in two rows beside it; 1.43 m is the width
# of a picture and 0.5 m the depth of the base, both as seen
box_height = most(most(top[2], top[3]), top[4])
title = 55.             # two lines of text
metre = least(least(width/3./1.43, \
  (0.975*height - title)/(0.96*top[1] + 0.5)), \
  (0.475*height - title)/(0.96*box_height + 0.5))
unset colorbox
set multiplot
do for [i=1:4] {
  bed = value("ARG".i)
  frame = last[i]
  left = i == 1 ? 0 : i == 3 ? 2/3. : 1/3.
  right = left + 1/3.
  low = (i == 2 || i == 3 ? 0.5 : 0) + 0.025
  high = (i == 4 ? 0.5 : 1) - title/height
  caption = word("(a) (b) (c) (d)", i)." ". \
    word("start basic friction friction+rotation", i)."\n"
  if (i == 4) {
    set colorbox user origin 0.76,0.1 size 0.03,0.3
    set cblabel "start height (order)" offset -4.5,0
    set cbtics ("lowest" 0, "highest" 1)
  }
  load "draw/balls.gp"
}
unset multiplot
