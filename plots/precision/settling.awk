# SPDX-License-Identifier: GPL-3.0-or-later
# Error of the mean fraction by method and setting, from rows of bed.sh: blocks
# of a model and method, for settling.gp and plots/markdown.awk.
#   awk -f settling.awk ROW...
# What runs are compared with is Merson's method at its smallest tolerance. With
# friction its bed of the same seed: difference is the mean over seeds of the
# union less its, interval the half width of that mean's 95 % confidence, rms
# and largest the root mean square and the largest over the seeds; spread is the
# standard deviation of the union itself over them. Without friction settling is
# chaotic and only the means over seeds compare. CPU seconds are those of runs
# that had the machine to themselves, under timed/.
BEGIN {
  FS = "\t"
  # Student's t, 97.5 %, for 1 to 10 degrees of freedom
  split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228", \
    student, " ")
}
FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
function get(name) { return $(at[name]) }
{
  setting = get("step") == "-" ? get("tol") : get("step")
  fixed = get("step") != "-" && get("method") != "verlet"
  block = get("model") "\t" get("method") (fixed ? " fixed" : "")
  run = block "\t" setting
  if (!(block in blocks)) {
    blocks[block] = ++nblocks
    name[nblocks] = block
  }
  if (!(run in count)) {
    runs[block] = runs[block] (runs[block] == "" ? "" : "\t") setting
    tol[run] = get("tol")
    step[run] = get("step")
  }
  i = ++count[run]
  size = get("time") " s of " get("count") " spheres"
  seed[run, i] = get("seed")
  union[run, i] = get("union")
  if (get("status") != "ok") failed[run]++
  evaluations[run] += get("evaluations")
  if (FILENAME ~ /\/timed\//) {
    cpu[run] += get("cpu_seconds")
    timed[run]++
  }
  model = get("model")
  if (get("method") == "merson" && !fixed && \
      (!(model in sharp) || setting + 0 < sharp[model] + 0))
    sharp[model] = setting
}
function quantile(df) {
  # Cornish and Fisher's expansion beyond the table, good to 2e-4
  return df <= 10 ? student[int(df)] : 1.95996 + 2.37227 / df + 2.8225 / df^2
}
# mean, variance of the mean, and count of x[1..n]
function moments(n,  i, s, v) {
  for (i = 1; i <= n; i++) s += x[i]
  mean = s / n
  for (i = 1; i <= n; i++) v += (x[i] - mean)^2
  variance = n > 1 ? v / (n - 1) / n : 0
}
function print_run(block, setting,   run, ref, i, j, n, m, v, mv, paired, \
    largest, spread, status) {
  run = block "\t" setting
  for (i = 1; i <= count[run]; i++) x[i] = union[run, i]
  moments(count[run])
  spread = count[run] > 1 && !failed[run] ? \
    sprintf("%.6f", sqrt(variance * count[run])) : "nan"
  split(block, part, "\t")
  ref = part[1] "\tmerson\t" sharp[part[1]]
  paired = part[1] != "basic"
  n = largest = 0
  if (!failed[run] && paired) {
    for (i = 1; i <= count[run]; i++)
      for (j = 1; j <= count[ref]; j++)
        if (seed[run, i] == seed[ref, j]) {
          x[++n] = union[run, i] - union[ref, j]
          if (x[n] > largest) largest = x[n]
          if (-x[n] > largest) largest = -x[n]
        }
    moments(n)
    m = mean
    v = variance
    for (i = rms = 0; i++ < n;) rms += x[i]^2
    rms = sqrt(rms / n)
    df = n - 1
  } else if (!failed[run]) {
    for (i = 1; i <= count[ref]; i++) x[i] = union[ref, i]
    moments(count[ref])
    m = -mean
    mv = variance
    for (i = 1; i <= count[run]; i++) x[i] = union[run, i]
    n = count[run]
    moments(n)
    m += mean
    v = variance + mv
    df = n + count[ref] - 2
  }
  status = failed[run] ? "failed" : run == ref ? "reference" : "ok"
  printf "%s\t%s\t%s\t%s\t%d\t%s\t%.0f\t%s\t", part[1], part[2], tol[run], \
    step[run], count[run], timed[run] ? sprintf("%.3f", cpu[run] / timed[run]) \
    : "nan", evaluations[run] / count[run], spread
  if (status == "ok" && n)
    printf "%+.6f\t%.6f\t%s\t%s\t%s\n", m, \
      (n > 1 ? quantile(df) * sqrt(v) : "nan"), \
      paired ? sprintf("%.6f", rms) : "-", \
      paired ? sprintf("%.6f", largest) : "-", status
  else
    printf "nan\tnan\tnan\tnan\t%s\n", status
}
END {
  print "# run=" size
  for (b = 1; b <= nblocks; b++) {
    print (b > 1 ? "\n\n" : "") "variant\tmethod\ttol\tstep\tseeds\t" \
      "cpu_seconds\tevaluations\tspread\tdifference\tinterval\trms\tlargest\tstatus"
    n = split(runs[name[b]], s, "\t")
    for (i = 1; i <= n; i++) print_run(name[b], s[i])
  }
}
