# SPDX-License-Identifier: GPL-3.0-or-later
# Work that a method takes to reach an error, for each set (file) and each of
# its errors: evaluations and CPU time for three targets, in brackets by what
# factor that is more than the best. Between the rungs of a ladder by straight
# lines in the logarithms, along the first way down to the target.
#   awk -f work.awk SET.tsv... > TABLE.md
BEGIN {
  FS = "\t"
  kinds = split("1e-3 1e-6 1e-9", targets, " ")
}

function between(error, last, target, a, b) {
  return exp(log(a) + log(last / target) / log(last / error) * log(b / a))
}

function least(table, e, k,   m, best) {
  best = 1e300
  for (m = 1; m <= methods; m++)
    if ((e, k, m) in table && table[e, k, m] < best) best = table[e, k, m]
  return best
}

function cell(table, e, k, m, unit) {
  if (!((e, k, m) in table)) return " - |"
  return sprintf(" %.3g (%.1f) |", unit * table[e, k, m],
                 table[e, k, m] / least(table, e, k))
}

# the tables of the set that ends
function print_set(   e, k, m, row) {
  for (e = 1; e <= errors; e++) {
    printf "%s### %s, error of %s\n\n| method |", printed++ ? "\n" : "", set,
      substr(error_name[e], 7)
    for (k = 1; k <= kinds; k++) printf " evaluations to %s |", targets[k]
    for (k = 1; k <= kinds; k++) printf " CPU time to %s (µs) |", targets[k]
    print "\n|---|---|---|---|---|---|---|"
    for (m = 1; m <= methods; m++) {
      row = "| " method[m] " |"
      for (k = 1; k <= kinds; k++) row = row cell(work, e, k, m, 1)
      for (k = 1; k <= kinds; k++) row = row cell(cpu, e, k, m, 1e6)
      print row
    }
  }
  errors = methods = 0
  delete work
  delete cpu
}

FNR == 1 {
  if (NR > 1) print_set()
  set = FILENAME
  sub(/.*\//, "", set)
  sub(/\.tsv$/, "", set)
}
/^#/ || !NF { next }
$1 == "method" {
  methods++
  errors = 0
  for (i = 1; i <= NF; i++) {
    column[$i] = i
    if ($i ~ /^error_/) {
      error_name[++errors] = $i
      error_column[errors] = i
    }
  }
  for (i = 1; i <= errors; i++) last[i] = 0
  next
}
{
  method[methods] = $1
  good = $column["status"] == "ok"
  evaluations = $column["evaluations"]
  seconds = $column["cpu_seconds"]
  for (i = 1; i <= errors; i++) {
    now = good ? $(error_column[i]) + 0 : 0
    for (k = 1; k <= kinds; k++) {
      target = targets[k] + 0
      if (!good || (i, k, methods) in work || now > target) continue
      between_rungs = last[i] > target && now > 0
      work[i, k, methods] = between_rungs ? \
        between(now, last[i], target, last_work, evaluations) : evaluations
      cpu[i, k, methods] = between_rungs ? \
        between(now, last[i], target, last_cpu, seconds) : seconds
    }
    last[i] = now
  }
  last_work = evaluations
  last_cpu = seconds
}
END { print_set() }
