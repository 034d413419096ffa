# SPDX-License-Identifier: GPL-3.0-or-later
# A block for each file by kinetic.awk, with the largest energy within 0.2 s of
# each time: without the zeros that an oscillating energy goes through.
#   awk -f envelope.awk FILE... > BLOCKS
BEGIN { FS = OFS = "\t" }
FNR == 1 {
  put()
  run = ""
  print (NR > 1 ? "\n\n" : "") $0, "largest"
  next
}
{
  run = $1
  t[++n] = $2
  kinetic[n] = $3
}
function put(  k, i, most, first) {
  first = 1
  for (k = 1; k <= n; k++) {
    while (t[first] < t[k] - 0.2) first++
    most = kinetic[k]
    for (i = first; i <= n && t[i] <= t[k] + 0.2; i++)
      if (kinetic[i] > most) most = kinetic[i]
    print run, t[k], kinetic[k], most
  }
  n = 0
}
END { put() }
