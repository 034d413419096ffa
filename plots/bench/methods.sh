#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Means over seeds of DIR/VARIANT-METHOD-SEED.{stats,tsv}, a block per variant:
# CPU time with its least and largest, evaluations, fractions; difference is the
# mean over seeds of the union less that of Merson's bed of the same seed, and
# interval the half width of its 95 % confidence (Student's t); and the factor in
# CPU time to the paper's way (every pair twice) with Merson's method.
#   methods.sh DIR VARIANT...
set -eu
dir=$1
shift
awk '$1 == "spheres" { n = $2 } $1 == "t_end" { t = $2 }
  END { printf "# run=%g s of %d spheres\n", t, n }' "$dir/$1-merson-1.stats"
for variant; do
  awk -F '\t' -v OFS='\t' -v variant="$variant" '
    BEGIN {
      split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", t, " ")
      methods = split("allpairs merson dopri5 rkf45 rk8pd rkc multirate verlet", \
        name, " ")
    }
    FNR == 1 {
      file = FILENAME
      sub(/.*\//, "", file)
      split(substr(file, length(variant) + 2), part, /[-.]/)
      method = part[1]
      seed = part[2]
    }
    $1 == "cpu_seconds" {
      n[method]++
      cpu[method] += $2
      if (n[method] == 1 || $2 < least[method]) least[method] = $2
      if ($2 > most[method]) most[method] = $2
    }
    $1 == "rhs_evaluations" { evaluations[method] += $2 }
    FILENAME ~ /\.tsv$/ && FNR > 1 {
      sum[method] += $2
      united[method] += $3
      bed[method, seed] = $3
      seeds[method] = seeds[method] " " seed
    }
    END {
      print "variant", "method", "seeds", "cpu_seconds", "cpu_least", \
        "cpu_most", "evaluations", "us_per_evaluation", "sum", "union", \
        "difference", "interval", "times_cheaper"
      for (i = 1; i <= methods; i++) {
        m = name[i]
        k = split(seeds[m], s, " ")
        d = v = 0
        for (j = 1; j <= k; j++) d += (bed[m, s[j]] - bed["merson", s[j]]) / k
        for (j = 1; j <= k; j++)
          v += (bed[m, s[j]] - bed["merson", s[j]] - d)^2
        interval = "-"
        if (k > 1 && m != "merson")
          interval = sprintf("%.5f", (k <= 10 ? t[k - 1] : 2) * \
            sqrt(v / (k - 1) / k))
        printf "%s\t%s\t%d\t%.3f\t%.3f\t%.3f\t%.0f\t%.1f\t%.4f\t%.4f\t%+.5f\t%s\t%.3g\n", \
          variant, m, k, cpu[m] / k, least[m], most[m], evaluations[m] / k, \
          1e6 * cpu[m] / evaluations[m], sum[m] / k, united[m] / k, d, \
          interval, cpu["allpairs"] / n["allpairs"] / (cpu[m] / k)
      }
      print "\n"
    }' "$dir/$variant"-*
done
