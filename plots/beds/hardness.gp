# SPDX-License-Identifier: GPL-3.0-or-later
# How soft contacts may be: the union (above) and the contacts of a sphere
# (below) against 1/(kappa r), so that hard contacts are at the left edge and the
# law union = U + c/(kappa r) is a straight line.
#   gnuplot -c plots/beds/hardness.gp GROUPS LIMITS OUT
# Columns as of plots/beds/softness.awk.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1120
columns = ""
call "style.gp" "beds/hardness.gp GROUPS LIMITS OUT" ARG3 ARG1 ARG2

sets = system("awk -F '\t' 'NR > 1 { gsub(/ /, \"_\", $1); print $1 }' '".ARG2."'")
count = words(sets)
title_of(k) = system(sprintf("echo '%s' | sed 's/_/ /g; s/v min/v_{min}/; s/friction 0.2, //; s/, .*, bulk/, bulk/'", \
  word(sets, k)))
in_set(k, y) = system_name(strcol("set")) eq word(sets, k) ? column(y) : NaN
# the name with its blanks as in the list
system_name(s) = joined(s, "")
joined(s, out) = strlen(s) == 0 ? out : \
  joined(s[2:], out.(s[1:1] eq " " ? "_" : s[1:1]))
hard(k, name) = real(system(sprintf("awk -F '\t' -v k=%d -v name=%s 'NR == 1 ". \
  "{ for (i = 1; i <= NF; i++) at[$i] = i } NR == k + 1 { print $at[name] }' '%s'", \
  k, name, ARG2)))
array U[count]
array C[count]
do for [k=1:count] { U[k] = hard(k, "hard"); C[k] = hard(k, "slope") }
colour(k) = word(blue." ".vermillion." ".green." ".purple." ".sky." ".orange, k)
point(k) = int(word("7 5 9 11 13 15", k))

set multiplot
set xrange [0:0.07]
set xtics ("∞" 0, "120" 1./120, "60" 1./60, "30" 1./30, "15" 1./15)
set tmargin at screen 0.985
set bmargin at screen 0.62
set ylabel "solid fraction (union)"
set xlabel "stiffness, {/:Italic κ r} (scale: 1/{/:Italic κ r})"
unset key
plot for [k=1:count] ARG1 using "softness":(in_set(k, "union")):"error" \
    with yerrorbars pt point(k) ps symbol lw thin lc rgb colour(k), \
  for [k=1:count] [0:1./29] U[k] + C[k]*x with lines lw line lc rgb colour(k)
set tmargin at screen 0.53
set bmargin at screen 0.185
set ylabel "contacts of a sphere"
set key at screen 0.5,0.01 center bottom maxrows 4
plot for [k=1:count] ARG1 using "softness":(in_set(k, "z")) \
    with linespoints pt point(k) ps symbol lw thin lc rgb colour(k) \
    title title_of(k)
unset multiplot
