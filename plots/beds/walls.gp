# SPDX-License-Identifier: GPL-3.0-or-later
# How near the walls are: solid fraction (union) against the distance from the
# side walls (above), and the mean of beds against the side of the box, with what
# others found for spheres in cylinders (below). Lengths in diameters. Each panel
# has its own legend.
#   gnuplot -c plots/beds/walls.gp PROFILE SIZE OUT
# PROFILE: columns base, keep, wall, union, a block for each base and radius.
# SIZE: columns base, keep, region, seeds, side, union, standard error.
# docs/walls.md has the sources of the formulas.
set loadpath system("dirname '".ARG0."'")."/.."
height = 1120
columns = "base keep union"
call "style.gp" "beds/walls.gp PROFILE SIZE OUT" ARG3 ARG1 ARG2

# void fractions: z diameters from a wall; of a cylinder of N diameters
bulk = 0.36
de_klerk(z) = z <= 0.637 ? 2.14*z**2 - 2.53*z + 1 : \
  bulk + 0.29*exp(-0.6*z)*cos(2.3*pi*(z - 0.16)) + 0.15*exp(-0.9*z)
dixon(N) = 0.4 + 0.05/N + 0.412/N**2
zou_yu(N) = 0.372 + 0.002*(exp(15.306/N) - 1)
benyahia(N) = 0.390 + 1.740/(N + 1.140)**2
close_packing = 0.64

# the smallest and the largest box
stats ARG1 using "base" nooutput
narrow = STATS_min
wide = STATS_max
in_profile(base, keep) = column("base") == base && strcol("keep") eq keep ? \
  column("union") : NaN
in_size(keep, region) = strcol("keep") eq keep && strcol("region") eq region ? \
  column("union") : NaN

stats ARG2 using "side" nooutput

set key samplen 1.7 width -1 maxrows 2
set multiplot
set tmargin at screen 0.985
set bmargin at screen 0.685
set xlabel "distance from the side walls (diameters)"
set ylabel "solid fraction (union)"
set xrange [0:4]
set yrange [0:1]
set key at screen 0.52,0.575 center bottom
plot ARG1 using "wall":(in_profile(narrow, "nominal")) with lines lw line \
    dt 2 lc rgb vermillion \
    title sprintf("side %g, nominal radius", narrow), \
  ARG1 using "wall":(in_profile(narrow, "contact-mean")) with lines lw line \
    dt 2 lc rgb blue title sprintf("side %g, contact radius", narrow), \
  ARG1 using "wall":(in_profile(wide, "contact-mean")) with lines lw line \
    dt 1 lc rgb blue title sprintf("side %g, contact radius", wide), \
  [0:4] 1 - de_klerk(x) with lines lw line dt 3 lc rgb black \
    title "de Klerk 2003"
set tmargin at screen 0.55
set bmargin at screen 0.225
set xlabel "side of the box, or diameter of the cylinder (diameters)"
set logscale x
set xrange [STATS_min < 4 ? 2 : 4:25]
set yrange [*<0.5:0.8<*]
set xtics (2, 3, 4, 5, 7, 10, 15, 20, 25)
set key at screen 0.5,0.005 center bottom maxrows 5
plot ARG2 using "side":(in_size("nominal", "whole")):"standard error" \
    with yerrorbars pt 5 ps symbol lw thin lc rgb vermillion \
    title "whole, nominal", \
  ARG2 using "side":(in_size("nominal", "inner")):"standard error" \
    with yerrorbars pt 4 ps symbol lw thin lc rgb vermillion \
    title "inner, nominal", \
  ARG2 using "side":(in_size("contact-mean", "whole")):"standard error" \
    with yerrorbars pt 7 ps symbol lw thin lc rgb blue \
    title "whole, contact", \
  ARG2 using "side":(in_size("contact-mean", "inner")):"standard error" \
    with yerrorbars pt 6 ps symbol lw thin lc rgb blue \
    title "inner, contact", \
  for [k in "nominal contact-mean"] ARG2 using \
    "side":(in_size(k, "paper")):"standard error" with yerrorbars pt 3 \
    ps 1.3*symbol lw thin lc rgb black \
    title k eq "nominal" ? "the paper's bed" : "", \
  [4:25] close_packing with lines lw line lc rgb grey \
    title "random close packing", \
  [4:25] 1 - benyahia(x) with lines lw line dt 1 lc rgb sky \
    title "Benyahia, O'Neill 2005", \
  [4:25] 1 - zou_yu(x) with lines lw line dt 2 lc rgb green \
    title "Zou, Yu 1995, dense", \
  [4:25] 1 - dixon(x) with lines lw line dt 4 lc rgb purple title "Dixon 1988"
unset multiplot
