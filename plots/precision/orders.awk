# SPDX-License-Identifier: GPL-3.0-or-later
# The cost of a kink: the order that is observed at fixed steps, and the share
# of adaptive steps that are rejected at a tolerance of 1e-6. Sets come as two
# files, SET.tsv by tolerance and SET-steps.tsv by step. The order is the slope of a
# straight line through the logarithms of the errors, down to the least and of
# those the last four that are at least four times it, since it may be
# rounding.
# One row per method, one column per set.
#   awk -f orders.awk SET.tsv... SET-steps.tsv... > TABLE.md
BEGIN {
  FS = "\t"
}

function slope(key,   i, x, y, n, sx, sy, sxx, sxy) {
  for (i = least[key]; i >= 1 && n < 4; i--)
    if (error[key, i] >= 4 * error[key, least[key]]) {
      x = log(step[key, i])
      y = log(error[key, i])
      n++
      sx += x
      sy += y
      sxx += x * x
      sxy += x * y
    }
  return n < 2 ? "-" : \
    sprintf("%.2f", (n * sxy - sx * sy) / (n * sxx - sx * sx))
}

FNR == 1 {
  set = FILENAME
  sub(/.*\//, "", set)
  fixed = sub(/-steps\.tsv$/, "", set)
  sub(/\.tsv$/, "", set)
  if (!(set in seen)) {
    seen[set] = 1
    sets[++count] = set
  }
}
/^#/ || !NF { next }
$1 == "method" {
  for (i = 1; i <= NF; i++) column[$i] = i
  next
}
$column["status"] != "ok" { next }
{
  if (!($1 in known)) {
    known[$1] = 1
    methods[++kinds] = $1
  }
  key = set SUBSEP $1
}
!fixed && $1 != "verlet" && $column["tol"] == 1e-6 {
  tried = $column["accepted"] + $column["rejected"]
  share[key] = sprintf("%.0f", 100 * $column["rejected"] / tried)
}
fixed && $4 > 0 {
  i = ++points[key]
  step[key, i] = $column["step"]
  error[key, i] = $4
  if (i == 1 || $4 < error[key, least[key]]) least[key] = i
}
function table(title, orders,   s, m, line, rule, key) {
  line = "| " title " |"
  rule = "|---|"
  for (s = 1; s <= count; s++) {
    line = line " " sets[s] " |"
    rule = rule "---|"
  }
  print line "\n" rule
  for (m = 1; m <= kinds; m++) {
    line = "| " methods[m] " |"
    for (s = 1; s <= count; s++) {
      key = sets[s] SUBSEP methods[m]
      line = line " " (orders ? slope(key) : key in share ? share[key] : "-") \
        " |"
    }
    print line
  }
}

END {
  table("order at fixed steps", 1)
  print ""
  table("rejected steps (%)", 0)
}
