# SPDX-License-Identifier: GPL-3.0-or-later
# Shared style and argument checks of the figures:
#   columns = "NAME..."       the columns that every IN must have
#   call "style.gp" "USAGE" OUT IN...
# Exits with 1 if an IN can't be read, 2 on wrong use, 3 if columns are missing.
# Sets the terminal by the ending of OUT: .svg, or .png at twice the nominal
# size. The caller may also set before the call: key_rows, the rows of the
# legend below the figure, and width and height in nominal pixels; 640 pixels
# are a column of 85 mm, so the font of 18 pixels prints at 6.8 pt.

set encoding utf8
if (ARG2 eq "") {
  print "usage: gnuplot -c plots/".ARG1
  exit status 2
}
style_out = ARG2
style_end = strlen(style_out) > 4 ? style_out[strlen(style_out)-3:] : ""
if (style_end ne ".svg" && style_end ne ".png") {
  print style_out.": expected a name that ends in .svg or .png"
  print "usage: gnuplot -c plots/".ARG1
  exit status 2
}
style_awk = "awk '!/^#/ && NF { if (!rows++) names = $0 } ". \
  "END { printf \"%%d\\t%%s\\t\", rows, names }' '%s'"
do for [style_i=3:ARGC] {
  style_in = value(sprintf("ARG%d", style_i))
  if (int(system(sprintf("test -f '%s' -a -r '%s'; echo $?", style_in, \
    style_in)))) {
    print style_in.": missing or not readable"
    exit status 1
  }
  style_names = system(sprintf(style_awk, style_in))
  if (int(style_names[:strstrt(style_names, "\t")-1]) < 2) {
    print style_in.": no data"
    exit status 3
  }
  do for [style_name in columns] {
    if (!strstrt(style_names."\t", "\t".style_name."\t")) {
      print style_in.": no column ".style_name
      exit status 3
    }
  }
}

if (!exists("width")) { width = 640 }
if (!exists("magnify")) { magnify = 2 }
if (!exists("key_rows")) { key_rows = 1 }
if (!exists("height")) { height = 452 + 28*key_rows }
font_size = 18
# pngcairo counts its font in points of 4/3 pixels, svg in pixels
if (style_end eq ".svg") {
  set terminal svg enhanced size width,height background "white" \
    font sprintf("DejaVu Sans,%d", font_size) linewidth 1 dashlength 1
} else {
  set terminal pngcairo enhanced size magnify*width,magnify*height \
    background "white" font sprintf("DejaVu Sans,%d", font_size) \
    fontscale 0.75*magnify linewidth magnify pointscale magnify dashlength 0.5
}
set output style_out

# colours that stay apart for the colour-blind (Okabe and Ito 2008)
black = "#000000"
orange = "#E69F00"
sky = "#56B4E9"
green = "#009E73"
blue = "#0072B2"
vermillion = "#D55E00"
purple = "#CC79A7"
wine = "#882255"
grey = "#777777"

line = 2.5              # width of a curve
thin = 1                # of axes, guides and boxes
# a marker of about 10 pixels in either terminal
symbol = style_end eq ".svg" ? 0.75 : 1.4

set border linewidth thin linecolor rgb black
set tics nomirror out scale 0.7
set grid linetype 1 linewidth 0.5 linecolor rgb "#D5D5D5"
set format "%h"
set xtics offset 0,0.3
set xlabel offset 0,0.6
# svg estimates the width of text too large
set ylabel offset (style_end eq ".svg" ? 1.3 : -0.2),0
set lmargin at screen 0.16
set rmargin at screen 0.965
set tmargin at screen 0.965
set bmargin at screen (87. + 28*key_rows)/height
set key at screen 0.5,0.02 center bottom vertical maxrows key_rows Left \
  reverse samplen 2.3 spacing (style_end eq ".svg" ? 1 : 1.25)
set style fill transparent solid 0.25 noborder
set samples 200
set minussign

# data: tab-separated, # comments, each block begins with a line of names
set datafile separator "\t"
set datafile columnheaders
set datafile missing NaN

# What a line "# KEY=VALUE" of a file says
header(in, key) = system(sprintf("awk '/^# %s=/ { print substr($0, %d); ". \
  "exit }' '%s'", key, strlen(key) + 4, in))

# The model variants look the same in every figure: basic, friction, rotation,
# or rotation with its friction coefficient as in rotation-0.2.
variant_phi(v) = v[:9] eq "rotation-" ? v[10:] : \
  v[:13] eq "rotation phi=" ? v[14:] : ""
variant_colour(v) = v eq "basic" ? blue : v eq "friction" ? vermillion : \
  variant_phi(v) eq "0.1" ? purple : green
variant_dash(v) = v eq "basic" ? 2 : v eq "friction" ? 4 : \
  variant_phi(v) eq "0.1" ? 5 : 1
variant_title(v) = v eq "rotation" ? "friction+rotation" : \
  variant_phi(v) eq "" ? v : "rotation, {/:Italic φ} = ".variant_phi(v)

# So do the methods; words after the first only tell runs of a method apart.
# A method that is not in the key is drawn grey.
method_key = " merson    dopri5    rkf45     rkck      rk8pd     ". \
  "rkc       verlet    msbdf     multirate "
method_number(m) = (strstrt(method_key, " ".word(m, 1)." ") + 9)/10 + 1
method_colour(m) = word(grey." ".blue." ".vermillion." ".orange." ".sky. \
  " ".purple." ".green." ".black." ".grey." ".wine, method_number(m))
method_point(m) = int(word("3 7 5 9 11 13 15 6 4 14", method_number(m)))
method_title(m) = method_number(m) == 1 ? m : word("Merson DOPRI5 RKF45 ". \
  "RKCK RK8PD RKC Verlet MSBDF multirate", method_number(m) - 1). \
  m[strlen(word(m, 1)) + 1:]
