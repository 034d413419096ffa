# SPDX-License-Identifier: GPL-3.0-or-later
# Sums the outcomes of stability tunnel over speeds and tolerances.
BEGIN { FS = OFS = "\t" }
/^#/ { next }
!named { named = 1; next }
{
  key = $1 OFS $2 OFS ($3 > 0 ? "1/kappa" : "none")
  if (!(key in runs))
    order[++count] = key
  runs[key] += $6
  for (k = 7; k <= 10; k++)
    sum[key, k] += $k
}
END {
  print "method", "target", "cap on travel", "shots", "bounced", "missed", \
    "wrong speed", "gave up"
  for (i = 1; i <= count; i++) {
    key = order[i]
    print key, runs[key], sum[key, 7], sum[key, 8], sum[key, 9], sum[key, 10]
  }
}
