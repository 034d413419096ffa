# Error of the mean fraction of settled beds against CPU time, by method and
# tolerance; a panel a variant. A whisker that goes through the floor of its
# panel is of an error that the seeds cannot tell from zero; runs that failed
# are crosses at the top. The default of settle has a ring.
#   gnuplot -c plots/settling.gp IN OUT
# IN: blocks by precision/settling.awk.
set loadpath system("dirname '".ARG0."'")
key_rows = 3
height = 1000
columns = "variant method tol step cpu_seconds difference interval status"
call "style.gp" "settling.gp IN OUT" ARG2 ARG1

good(i) = strcol("status") eq "ok"
bad(i) = strcol("status") eq "failed"
default(i) = good(0) && strcol("method") eq "rkc" && strcol("tol") eq "5e-4"
# the blocks of a panel that have such rows
chosen(list, panel) = system(sprintf("awk -F'\t' '%s' '%s'", \
  "/^$/ { next } $1 == \"variant\" { b++; next } $1 == \"".panel."\" && ". \
  list." && !seen[b]++ { printf \" %d\", b }", ARG1))
# an empty loop, too, asks for the values of its first turn
of(list, i) = i > words(list) ? 1 : int(word(list, i))
stats ARG1 using (blocks = column(-2) + 1) nooutput
array method[blocks]
do for [b=1:blocks] {
  stats ARG1 index b-1 using (method[b] = strcol("method"), 0) nooutput
}

bottom = 5e-7
top = 0.1
d(i) = abs(column("difference"))
shown(i) = d(0) > 1.5*bottom ? d(0) : 1.5*bottom
low(i) = d(0) - column("interval") > bottom ? d(0) - column("interval") : bottom
high(i) = d(0) + column("interval")
cpu(test) = test ? column("cpu_seconds") : NaN

set logscale xy
set format y "10^{%T}"
set xrange [0.04:50]
set yrange [bottom:top]
set lmargin at screen 0.17
set ylabel "error of the mean union fraction"
variants = "rotation basic"
headings = "'friction and rotation, paired by seed' 'no friction, unpaired'"
panel = 0.375
set multiplot
do for [p=1:2] {
  set tmargin at screen 0.975 - (p - 1)*(panel + 0.03)
  set bmargin at screen 0.975 - (p - 1)*(panel + 0.03) - panel
  set format x p == 2 ? "%h" : ""
  set xlabel p == 2 ? "CPU time for 8 s of 200 spheres (s)" : ""
  set label 1 word(headings, p) at graph 0.98,0.94 right
  ok = chosen("$NF == \"ok\"", word(variants, p))
  failed = chosen("$NF == \"failed\"", word(variants, p))
  ring = chosen("$2 == \"rkc\" && $3 == \"5e-4\"", word(variants, p))
  plot for [i=1:words(ok)] ARG1 index of(ok, i)-1 using (cpu(good(0))):(shown(0)): \
      (low(0)):(high(0)) with yerrorbars lw thin pt method_point(method[of(ok, i)]) \
      ps symbol lc rgb method_colour(method[of(ok, i)]) notitle, \
    for [i=1:words(ok)] ARG1 index of(ok, i)-1 using (cpu(good(0))):(shown(0)) \
      with linespoints lw line pt method_point(method[of(ok, i)]) \
      ps symbol lc rgb method_colour(method[of(ok, i)]) notitle, \
    for [i=1:words(failed)] ARG1 index of(failed, i)-1 using (cpu(bad(0))):(top) \
      with points pt 2 ps 1.6*symbol lw line lc rgb method_colour(method[of(failed, i)]) \
      notitle, \
    for [i=1:words(ring)] ARG1 index of(ring, i)-1 using (cpu(default(0))):(shown(0)) \
      with points pt 65 ps 2.6*symbol lw line lc rgb black notitle, \
    for [m in p == 1 ? "merson dopri5 rkf45 rkc verlet" : ""] keyentry \
      with linespoints lw line pt method_point(m) ps symbol \
      lc rgb method_colour(m) title method_title(m), \
    for [m in p == 1 ? "default" : ""] keyentry with points pt 65 \
      ps 2.6*symbol lw line lc rgb black title "settle's default"
  unset key
}
unset multiplot
