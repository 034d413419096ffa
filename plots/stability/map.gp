# SPDX-License-Identifier: GPL-3.0-or-later
# Map of outcomes: what became of beds, by tolerance or step and stiffness, a
# panel a variant and method. A cell has the outcome's colour and letter.
#   gnuplot -c plots/stability/map.gp IN OUT
# IN: rows by map.sh.
set loadpath system("dirname '".ARG0."'")."/.."
key_rows = 3
height = 1240
columns = "panel setting kappa outcome"
call "style.gp" "stability/map.gp IN OUT" ARG2 ARG1

outcomes = "settled denser looser jitter gave_up tunnelled stopped"
letters = "· + − J G W X"
titles = "'· settled' '+ denser bed' '− looser bed' 'J jitter' 'G gave up' ". \
  "'W through a wall' 'X blew up'"
colours = "#CDE8DD ".orange." #F5DFA8 ".purple." ".sky." #B5B5B5 ".vermillion
# four in a row, of which the first has three
panels = "basic-merson basic-merson-free basic-merson-short - basic-rkc ". \
  "basic-rkc-free basic-multirate basic-verlet rotation-merson rotation-rkc ". \
  "rotation-multirate rotation-verlet"
headings = "'Merson' '… no cap' '… {/:Italic l}_{max} 0.1 m' '' 'RKC' ". \
  "'… no cap' 'multirate' 'Verlet' 'Merson' 'RKC' 'multirate' 'Verlet'"
below(p) = p < 4 || p == 9 ? "{/:Italic δ} (m/s^2)" : p % 4 == 0 ? \
  "step (s)" : "tol (m/s)"

# the values of a column, in order; all of them or a panel's
values(name, panel, order) = system(sprintf("awk -F'\\t' 'NR == 1 { for ". \
  "(k = 1; k <= NF; k++) at[$k] = k; next } (p == \"\" || $at[\"panel\"] ". \
  "== p) && !seen[$at[c]]++ { print $at[c] }' p='%s' c='%s' '%s' | ". \
  "LC_ALL=C sort -g%s | tr '\\n' ' '", panel, name, ARG1, order))
place(list, s) = strstrt(" ".list, " ".s." ") == 0 ? NaN : \
  words(list[:strstrt(" ".list, " ".s." ") - 1]) + 1
is(o) = strcol("panel") eq name && strcol("outcome") eq word(outcomes, o) ? \
  place(settings, strcol("setting")) : NaN
seen(o) = strstrt(" ".values("outcome", name, "")." ", \
  " ".word(outcomes, o)." ") > 0
kappas = values("kappa", "", "")
# the legend has what occurs in any panel
occur = ""
do for [o=1:words(outcomes)] {
  if (strstrt(" ".values("outcome", "", "")." ", \
    " ".word(outcomes, o)." ") > 0) { occur = occur.sprintf(" %d", o) }
}

set border linewidth thin
unset grid
unset xtics
unset ytics
set yrange [0.5:words(kappas) + 0.5]
across = 0.192
high = 0.185
set multiplot
do for [p=1:12] {
  name = word(panels, p)
  settings = values("setting", name, "r")
  i = (p - 1)%4
  j = (p - 1)/4
  left = 0.16 + i*(across + 0.012)
  upper = 0.955 - j*(high + 0.105)
  set lmargin at screen left
  set rmargin at screen left + across
  set tmargin at screen upper
  set bmargin at screen upper - high
  set xrange [0.5:(words(settings) > 0 ? words(settings) : 1) + 0.5]
  set title word(headings, p) offset 0,-0.7
  unset label
  do for [k=1:words(settings)] {
    set label word(settings, k) at k,graph -0.03 right rotate by 50 \
      font ",16"
  }
  set label below(p) at graph 0.5,-0.3 center
  if (i == 1) {           # a panel that every row has
    do for [k=1:words(kappas)] {
      set label word(kappas, k) at screen 0.15,first k right
    }
    set label "{/:Italic κ} (1/m), ".(j < 2 ? "no friction" : "full model") \
      at screen 0.03,screen upper - high/2 center rotate by 90
  }
  there = ""
  do for [o=1:words(outcomes)] {
    there = there.(seen(o) ? sprintf(" %d", o) : "")
  }
  if (words(there) > 0) {
    plot for [o in there] ARG1 using (is(int(o))): \
        (place(kappas, strcol("kappa"))):(0.47):(0.47) with boxxyerror \
        fillstyle solid 1 noborder linecolor rgb word(colours, int(o)) \
        notitle, \
      for [o in there] ARG1 using (is(int(o))): \
        (place(kappas, strcol("kappa"))):(word(letters, int(o))) with labels \
        notitle, \
      for [o in occur] keyentry with boxes \
        fillstyle solid 1 noborder linecolor rgb word(colours, int(o)) \
        title word(titles, int(o))
  }
  unset key
}
unset multiplot
