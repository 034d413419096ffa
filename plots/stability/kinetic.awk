# SPDX-License-Identifier: GPL-3.0-or-later
# Kinetic energy per sphere (J), without spin, of each frame of a bed:
#   awk -v run=NAME -f kinetic.awk BED
BEGIN {
  FS = "\t"
  OFS = "\t"
  print "run", "t", "kinetic"
}
function put() { if (n) print run, t, e / n; n = e = 0 }
/^# t=/ { put(); t = substr($0, 5); next }
/^#/ || NF < 9 || $1 == "id" { next }
{ n++; e += $6 * ($7^2 + $8^2 + $9^2) / 2 }
END { put() }
