# SPDX-License-Identifier: GPL-3.0-or-later
# The spheres of a bed in their box, coloured by their order at the start,
# which fills its layers from the bottom.
#   gnuplot -c plots/draw/bed.gp BED OUT [FRAME]
# FRAME counts from 0; without it the last frame is drawn. What balls.gp leaves
# to its caller may be set before (-e), with value_label for the colours.
# style.gp stands beside this where both are installed, else one folder up
set loadpath system("dirname '".ARG0."'") system("dirname '".ARG0."'")."/.."
columns = "x y z r"
call "style.gp" "draw/bed.gp BED OUT [FRAME]" ARG2 ARG1

bed = ARG1
stats bed using (last = column(-2)) nooutput
frame = ARGC > 2 ? int(ARG3) : last
if (frame < 0 || frame > last) {
  print sprintf("%s: no frame %d, there are 0 to %d", bed, frame, last)
  exit status 2
}
left = 0.02
right = 0.8
low = 0.04
high = 0.93
if (!exists("box_height")) {box_height = 0}
metre = 0
caption = ""
set colorbox user origin (exists("value_label") ? 0.8 : 0.82),0.25 size 0.03,0.5
if (exists("value_label")) {
  # above, since ticks of small beds take the room beside
  set label 3 value_label at screen 0.985,0.8 right front
} else {
  set cblabel "start height (order)" offset -4.5,0
  set cbtics ("lowest" 0, "highest" 1)
}
load "balls.gp"
