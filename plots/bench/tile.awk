# SPDX-License-Identifier: GPL-3.0-or-later
# Lays out -v a= by -v b= copies of a settled bed in the unit box as one bed in a
# box of a by b metres.
BEGIN { FS = "\t" }
# of a bed that is changed no checksum holds
/^# (wall|base|count|status|checksum)=/ { next }
/^#/ { print; next }
/^id/ {
  printf "# base=%d,%d\n", a, b
  print "# wall=0 0 0 0 0 -1\n# wall=0 0 0 -1 0 0\n# wall=0 0 0 0 -1 0"
  printf "# wall=%d 0 0 1 0 0\n# wall=0 %d 0 0 1 0\n", a, b
  print
  next
}
NF {
  for (i = 0; i < a; i++)
    for (j = 0; j < b; j++) {
      printf "%d\t%.17g\t%.17g", id++, $2 + i, $3 + j
      for (k = 4; k <= NF; k++) printf "\t%s", $k
      print ""
    }
}
END { print "# status=ok" }
