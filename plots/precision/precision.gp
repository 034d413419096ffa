# SPDX-License-Identifier: GPL-3.0-or-later
# Work-precision or convergence chart with two logarithmic axes, one block of
# the file for each method. A run that failed is a cross on the edge of the
# chart where its error would be too large.
#   gnuplot -c plots/precision/precision.gp IN OUT TITLE XCOLUMN YCOLUMN XLABEL YLABEL \
#     [ORDERS]
# IN: columns method, status, XCOLUMN and YCOLUMN. ORDERS, such as "2 4", are
# guides through the middle of the data: error = work^-order, or x^order when
# x is tol, h or step.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 560
columns = "method status ".(ARGC < 7 ? "" : ARG4." ".ARG5)
call "style.gp" \
  "precision/precision.gp IN OUT TITLE XCOLUMN YCOLUMN XLABEL YLABEL [ORDERS]" \
  (ARGC < 7 ? "" : ARG2) ARG1
xname = ARG4
yname = ARG5
orders = ARGC > 7 ? ARG8 : ""

error_on_x = strstrt(xname, "error") > 0
slope(order) = error_on_x ? -1./order : xname eq "tol" || xname eq "h" || \
  xname eq "step" ? order : -order
# the i-th of a list; an empty loop, too, asks for the values of its first turn
order(i) = i > words(orders) ? 1 : real(word(orders, i))
of(blocks, i) = i > words(blocks) ? 1 : int(word(blocks, i))
good(i) = strcol("status") eq "ok" && column(xname) < 1e300 && \
  column(yname) < 1e300
real_value(name) = column(name) > 0 && column(name) < 1e300

stats ARG1 using (blocks = column(-2) + 1) nooutput
# the errors of failed runs don't count for the ranges, their work does
stats ARG1 using (real_value(xname) && (good(0) || !error_on_x) ? \
  column(xname) : NaN) nooutput
xlow = 10**floor(log10(STATS_min))
xhigh = 10**ceil(log10(STATS_max))
xmiddle = sqrt(STATS_min*STATS_max)
stats ARG1 using (real_value(yname) && (good(0) || error_on_x) ? \
  column(yname) : NaN) nooutput
ylow = 10**floor(log10(STATS_min))
yhigh = 10**ceil(log10(STATS_max))
ymiddle = sqrt(STATS_min*STATS_max)
within(v, low, high) = v > high ? high : v > low ? v : low
xwithin(i) = within(column(xname), xlow, xhigh)
ywithin(i) = within(column(yname), ylow, yhigh)

# so that gnuplot says nothing of curves without points
set datafile missing "none"
array name[blocks]
array dash[blocks]
done = ""               # the blocks that have good runs
failed = ""             # and those that have failed ones
seen = ""
do for [b=1:blocks] {
  ngood = 0
  nbad = 0
  stats ARG1 index b-1 using (name[b] = strcol("method"), \
    ngood = ngood + good(0), nbad = nbad + !good(0), 0) nooutput
  done = done.(ngood > 0 ? sprintf(" %d", b) : "")
  failed = failed.(nbad > 0 ? sprintf(" %d", b) : "")
  kind = "|".word(name[b], 1)."|"
  dash[b] = strstrt(seen, kind) > 0 ? 2 : 1
  seen = seen.kind
}

set title ARG3 offset 0,(style_end eq ".svg" ? -0.6 : 0)
set tmargin at screen 0.91
set lmargin at screen 0.19
set rmargin at screen 0.955
set logscale xy
set xrange [xlow:xhigh]
set yrange [ylow:yhigh]
set format "10^{%T}"
# a label for every decade, or every other one without ticks between
xstep = log10(xhigh/xlow) > 8 ? 100 : 10
ystep = log10(yhigh/ylow) > 8 ? 100 : 10
set xtics xstep
set ytics ystep
set mxtics xstep == 10 ? 10 : 1
set mytics ystep == 10 ? 10 : 1
set xlabel ARG6
set ylabel ARG7
plot for [i=1:words(orders)] \
    ymiddle*(x/xmiddle)**slope(order(i)) with lines \
    lw 1.5*thin dt i+1 lc rgb grey notitle, \
  for [i=1:words(done)] ARG1 index of(done, i)-1 using \
    (good(0) ? xwithin(0) : NaN):(ywithin(0)) with linespoints lw line \
    dt dash[of(done, i)] pt method_point(name[of(done, i)]) ps symbol \
    lc rgb method_colour(name[of(done, i)]) notitle, \
  for [i=1:words(failed)] ARG1 index of(failed, i)-1 using \
    (good(0) ? NaN : error_on_x ? xhigh : xwithin(0)): \
    (error_on_x ? ywithin(0) : yhigh) with points pt 2 ps 1.6*symbol \
    lw line lc rgb method_colour(name[of(failed, i)]) notitle, \
  for [b=1:blocks] keyentry with linespoints lw line dt dash[b] \
    pt method_point(name[b]) ps symbol lc rgb method_colour(name[b]) \
    title method_title(name[b]), \
  for [i=1:words(failed)>0] keyentry with points pt 2 ps 1.6*symbol lw line \
    lc rgb black title "failed", \
  for [i=1:words(orders)] keyentry with lines lw 1.5*thin dt i+1 \
    lc rgb grey title "order ".word(orders, i)
