# SPDX-License-Identifier: GPL-3.0-or-later
# One block of the means of several files of analyze gr: pairs and expected
# pairs are added up.
#   awk -v variant=NAME -f gr.awk FILE...
BEGIN { FS = OFS = "\t" }
FNR == 1 {
  for (k = 1; k <= NF; k++)
    at[$k] = k
  n = 0
  next
}
/^[0-9]/ {
  r[++n] = $at["r"]
  pairs[n] += $at["pairs"]
  expected[n] += $at["expected"]
}
END {
  if (!n)
    exit 1
  print "variant", "r", "g", "pairs", "expected"
  for (k = 1; k <= n; k++)
    printf "%s\t%.17g\t%.17g\t%.17g\t%.17g\n", variant, r[k],
      pairs[k] / expected[k], pairs[k], expected[k]
  print "\n"
}
