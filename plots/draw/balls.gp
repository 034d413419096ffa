# SPDX-License-Identifier: GPL-3.0-or-later
# Draws one frame of a bed as shaded balls in their box. The caller sets
#   bed, frame                a file and which of its frames, counted from 0
#   left, right, low, high    the part of the picture to fill (screen units)
#   box_height                least height of the box drawn, m
#   metre                     nominal pixels a metre, 0: as large as fits
#   caption                   written above, before the time of the frame
# and loads this. It may also set
#   turn, tilt                the view: around the vertical, and to it, degrees
#   origin_x.., base_x..      the box's corner and base, m; else base= of BED
#   value_column, value_low, value_high
#                             what is coloured; else the id, from 0 to the last
#   lean                      room for balls that lean out of the box, m
#   facets                    of all balls together
#
# The balls are turned into the viewer's axes here and drawn as a map, so that
# their scale is known. Of a ball only the half that faces the viewer is seen:
# one mesh of rings around the line of sight serves all balls, with its light
# (Lambert's law and a highlight) worked out once.

if (!exists("tilt")) {tilt = 72}        # of the view, from above, degrees
if (!exists("turn")) {turn = 30}        # and around the vertical
if (!exists("lean")) {lean = 0.03}
if (!exists("value_column")) {value_column = "id"}
set angles degrees
ax = cos(turn)          # a: to the right
ay = sin(turn)
bx = -cos(tilt)*sin(turn)       # b: upwards
by = cos(tilt)*cos(turn)
bz = sin(tilt)
cx = sin(tilt)*sin(turn)        # c: to the viewer
cy = -sin(tilt)*cos(turn)
cz = cos(tilt)
a(x, y) = ax*x + ay*y
b(x, y, z) = bx*x + by*y + bz*z
c(x, y, z) = cx*x + cy*y + cz*z

# the header: base in the first frame, t in any
if (!exists("origin_x")) {
  origin_x = 0.
  origin_y = 0.
  origin_z = 0.
  base_x = 1.
  base_y = 1.
}
t_frame = NaN
key(name) = strcol(1)[:strlen(name)+3] eq "# ".name."="
text(name) = strcol(1)[strlen(name)+4:]
comma(s) = strstrt(s, ",")
set xrange [*:*]        # stats leaves out what is out of range
set yrange [*:*]
unset datafile columnheaders
set datafile commentschars "%"
stats bed index 0 using (key("base") ? (base = text("base"), \
  base_x = real(base[:comma(base)-1]), base_y = real(base[comma(base)+1:])) \
  : 0, 0) nooutput
stats bed index frame using (key("t") ? t_frame = real(text("t")) : 0, 0) \
  nooutput
set datafile commentschars "#"
set datafile columnheaders

stats bed index frame using (column("z") + column("r")) nooutput
if (!exists("STATS_records")) {
  print sprintf("%s: frame %d has no columns z and r", bed, frame)
  exit status 3
}
n = STATS_records
box_top = STATS_max - origin_z > box_height ? STATS_max - origin_z : box_height
array ball_a[n]
array ball_b[n]
array ball_c[n]
array ball_r[n]
array ball_value[n]
ball = 0
stats bed index frame using (ball = ball + 1, \
  x = column("x") - origin_x, y = column("y") - origin_y, \
  z = column("z") - origin_z, \
  ball_a[ball] = a(x, y), ball_b[ball] = b(x, y, z), \
  ball_c[ball] = c(x, y, z), ball_r[ball] = column("r"), \
  ball_value[ball] = column(value_column)) nooutput
shade_low = exists("value_low") ? value_low : 0
shade_high = exists("value_high") ? value_high : STATS_max > 0 ? STATS_max : 1

# as large as fits: the box and a little for balls that lean out of it
area_a = (right - left)*width
area_b = (high - low)*height
least(x, y) = x < y ? x : y
most(x, y) = x > y ? x : y
a_low = least(ax, 0)*base_x + least(ay, 0)*base_y
a_high = most(ax, 0)*base_x + most(ay, 0)*base_y
b_low = least(bx, 0)*base_x + least(by, 0)*base_y
b_high = most(bx, 0)*base_x + most(by, 0)*base_y + bz*box_top
fit_a = area_a/(a_high - a_low + 2*lean)
fit_b = area_b/(b_high - b_low + 2*lean)
scale = metre > 0 ? metre : least(fit_a, fit_b)
middle_a = 0.5*(a_low + a_high)
middle_b = 0.5*(b_low + b_high)
set view map
set lmargin at screen left
set rmargin at screen right
set bmargin at screen low
set tmargin at screen high
set xrange [middle_a-0.5*area_a/scale:middle_a+0.5*area_a/scale]
# in the middle, but at a given scale on the floor: pictures stand in a row
lowest = metre > 0 ? b_low - lean : middle_b - 0.5*area_b/scale
set yrange [lowest:lowest+area_b/scale]
set zrange [*:*]

# the box: edges of the sides that face the viewer before the balls, the others
# behind them
set style arrow 1 nohead back lw thin lc rgb grey
set style arrow 2 nohead front lw thin lc rgb grey
unset arrow
facing_x = cx > 0 ? base_x : 0.         # these two sides do
facing_y = cy > 0 ? base_y : 0.
do for [lid=0:1] {
  z = lid*box_top
  do for [side=0:1] {
    y = side*base_y
    set arrow from a(0,y),b(0,y,z) to a(base_x,y),b(base_x,y,z) \
      as (y == facing_y ? 2 : 1)
    x = side*base_x
    set arrow from a(x,0),b(x,0,z) to a(x,base_y),b(x,base_y,z) \
      as (x == facing_x ? 2 : 1)
  }
}
do for [corner=0:3] {
  x = (corner & 1)*base_x
  y = (corner >> 1)*base_y
  set arrow from a(x,y),b(x,y,0) to a(x,y),b(x,y,box_top) \
    as (x == facing_x && y == facing_y ? 2 : 1)
}
# pngcairo holds facets back until a box is filled: let that be before the edges
set object 1 rectangle from 0,0 to 0,0 front fs solid noborder
outwards = facing_y > 0 ? ay : -ay      # of the edge that is measured
set label 1 sprintf("%.3g m", base_x) front \
  at a(0.5*base_x,facing_y),b(0.5*base_x,facing_y,0) \
  offset outwards > 0 ? 0.3 : -0.7,-0.8
if (outwards > 0) { set label 1 left } else { set label 1 center }
set label 2 caption.(t_frame == t_frame ? \
  sprintf("{/:Italic t} = %.4g s", t_frame) : "") front \
  at screen left,high offset 0.5,(strstrt(caption, "\n") > 0 ? 1.4 : 0.4)

# The mesh: unit vectors a, b, c, then diffuse light and highlight. It is finer
# for fewer balls, and coarser in an .svg, where a facet takes 150 bytes.
if (!exists("facets")) {facets = style_end eq ".svg" ? 30000. : 120000.}
rings = int(sqrt(facets/(3*n)))
rings = rings < 6 ? 6 : rings > 40 ? 40 : rings
la = -0.40              # to the light
lb = 0.60
lc = sqrt(1 - la**2 - lb**2)
positive(x) = x > 0 ? x : 0
diffuse(a, b, c) = 0.42 + 0.58*positive(la*a + lb*b + lc*c)
highlight(a, b, c) = 0.4* \
  positive((la*a + lb*b + (lc + 1)*c)/sqrt(2 + 2*lc))**40
set print $mesh
do for [ring=0:rings] {
  do for [sector=0:3*rings] {
    ma = sin(90.*ring/rings)*cos(120.*sector/rings)
    mb = sin(90.*ring/rings)*sin(120.*sector/rings)
    mc = cos(90.*ring/rings)
    print sprintf("%.6f\t%.6f\t%.6f\t%.6f\t%.6f", ma, mb, mc, \
      diffuse(ma, mb, mc), highlight(ma, mb, mc))
  }
  print ""
}
unset print

# colours between equally spaced stops (viridis without its darkest part),
# mixed here because palette() answers only after a first plot
array stop[5] = [0x414487, 0x2a788e, 0x22a884, 0x7ad151, 0xfde725]
set palette defined (0 "#414487", 1 "#2a788e", 2 "#22a884", 3 "#7ad151", \
  4 "#fde725")
if (exists("value_low")) {
  set cbrange [value_low:value_high]
} else {
  set cbrange [0:1]
}
mix(p, q, f) = int((1 - f)*(p & 255) + f*(q & 255))
between(p, q, f) = mix(p >> 16, q >> 16, f) << 16 | \
  mix(p >> 8, q >> 8, f) << 8 | mix(p, q, f)
array ball_colour[n]
do for [ball=1:n] {
  place = 4.*(ball_value[ball] - shade_low)/(shade_high - shade_low)
  place = place > 0 ? place : 0.
  after = place < 4 ? int(place) + 1 : 4
  ball_colour[ball] = between(stop[after], stop[after+1], place - after + 1)
}
lit(shade, d, s) = int(shade*d + (255 - shade*d)*s)
colour(rgb, d, s) = lit((rgb >> 16) & 255, d, s) << 16 | \
  lit((rgb >> 8) & 255, d, s) << 8 | lit(rgb & 255, d, s)

set pm3d depthorder
set style fill solid 1
unset border
unset grid
unset xtics
unset ytics
unset ztics
unset key
unset datafile columnheaders
# a map is seen from below: the depth is turned round
splot for [ball=1:n] $mesh using (ball_a[ball] + ball_r[ball]*$1): \
  (ball_b[ball] + ball_r[ball]*$2):(-ball_c[ball] - ball_r[ball]*$3): \
  (colour(ball_colour[ball], $4, $5)) with pm3d fc rgb variable
set datafile columnheaders
