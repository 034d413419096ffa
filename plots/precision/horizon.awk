# SPDX-License-Identifier: GPL-3.0-or-later
# Largest distance between the spheres of two beds of the same frames, in
# diameters, over time, as a block.
#   awk -v variant=V -v method=M -f horizon.awk BED BED
BEGIN {
  FS = "\t"
  OFS = "\t"
  print "variant", "method", "t", "distance"
}
FNR == 1 { bed++; frame = 0 }
/^# t=/ { t[++frame] = substr($0, 5); next }
/^#/ || NF < 4 || $1 == "id" { next }
bed == 1 {
  x[frame, $1] = $2
  y[frame, $1] = $3
  z[frame, $1] = $4
  r[$1] = $5
  next
}
{
  d = sqrt(($2 - x[frame, $1])^2 + ($3 - y[frame, $1])^2 + \
    ($4 - z[frame, $1])^2) / (2 * r[$1])
  if (!(d <= most[frame])) most[frame] = d
}
END {
  for (k = 1; k <= frame; k++) print variant, method, t[k], most[k] + 0
  print "\n"
}
