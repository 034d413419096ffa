# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures of one size as an animated GIF.
#   gnuplot -c plots/draw/movie.gp DIRECTORY COUNT DELAY OUT
# The pictures are DIRECTORY/0.png, 1.png ..., 640 x 480 pixels; each stands for
# DELAY hundredths of a second.
if (ARGC != 4) {
  print "usage: gnuplot -c plots/draw/movie.gp DIRECTORY COUNT DELAY OUT"
  exit status 2
}
columns = 640
rows = 480
set terminal gif animate delay int(ARG3) loop 0 size columns,rows
set output ARG4
set margins 0,0,0,0
unset tics
unset border
unset key
unset colorbox
set xrange [-0.5:columns-0.5]
set yrange [-0.5:rows-0.5]
set autoscale noextend

# A GIF has 256 colours: six levels of red, green and blue, and what lies
# between them by ordered dithering (Bayer 1973).
array bayer[16] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5]
threshold(x, y) = (bayer[(int(y)%4)*4 + int(x)%4 + 1] + 0.5)/16
level(v) = 51*int(v/51. + threshold(column(0), column(-1)))
do for [k=0:int(ARG2)-1] {
  plot sprintf("%s/%d.png", ARG1, k) binary filetype=png \
    using (level($1)):(level($2)):(level($3)) with rgbimage
}
