# SPDX-License-Identifier: GPL-3.0-or-later
# The union seed by seed, as a table in Markdown: Merson with two tolerances,
# and rkc, with their differences to Merson's sharper one.
#   awk -f seeds.awk ROW...    rows of bed.sh
BEGIN { FS = "\t" }
FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
{
  s = $(at["seed"])
  union[s, $(at["method"]) $(at["tol"])] = $(at["union"])
  if (!(s in known)) {
    known[s] = 1
    seeds++
    if (s > last) last = s
  }
}
function size(x) { return x < 0 ? -x : x }
END {
  print "| seed | Merson 0.01 | Merson 0.1 - Merson 0.01 | rkc 5e-4 | " \
    "rkc - Merson 0.01 |"
  print "|---|---|---|---|---|"
  for (s = 1; s <= last; s++) {
    if (!(s in known)) continue
    sharp = union[s, "merson0.01"]
    merson = union[s, "merson0.1"] - sharp
    rkc = union[s, "rkc5e-4"] - sharp
    printf "| %d | %.5f | %+.1e | %.5f | %+.5f |\n", s, sharp, merson, \
      union[s, "rkc5e-4"], rkc
    if (size(merson) > most_merson) most_merson = size(merson)
    if (size(rkc) > most_rkc) most_rkc = size(rkc)
  }
  printf "| largest | | %.1e | | %.5f |\n", most_merson, most_rkc
}
