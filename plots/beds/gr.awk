# SPDX-License-Identifier: GPL-3.0-or-later
# One block of the means of several files of analyze gr: pairs and expected
# pairs are added up. interval is the half width of the 95 % confidence of their
# ratio, from its scatter over the files (a ratio estimator, Student's t).
#   awk -v variant=NAME -f gr.awk FILE...
BEGIN {
  FS = OFS = "\t"
  split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", student, " ")
}
FNR == 1 {
  files++
  for (k = 1; k <= NF; k++)
    at[$k] = k
  n = 0
  next
}
/^[0-9]/ {
  r[++n] = $at["r"]
  pairs[n] += $at["pairs"]
  expected[n] += $at["expected"]
  p[n, files] = $at["pairs"]
  e[n, files] = $at["expected"]
}
END {
  if (!n)
    exit 1
  t = files < 2 ? 0 : files <= 10 ? student[files - 1] : 1.96
  print "variant", "r", "g", "interval", "pairs", "expected"
  for (k = 1; k <= n; k++) {
    g = pairs[k] / expected[k]
    for (f = s = 0; f++ < files;)
      s += (p[k, f] - g * e[k, f])^2
    interval = files > 1 ? t * sqrt(s * files / (files - 1)) / expected[k] : 0
    printf "%s\t%.17g\t%.17g\t%.9g\t%.17g\t%.17g\n", variant, r[k], g,
      interval, pairs[k], expected[k]
  }
  print "\n"
}
