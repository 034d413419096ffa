# SPDX-License-Identifier: GPL-3.0-or-later
# What settling.gp draws, from blocks by settling.awk: a row per marker.
#   awk -f panels.awk SETTLING > PANELS
# panel    single (rms of single beds with friction and rotation), mean (of the
#          same beds), plain (mean without friction)
# side     left: multirate, rkc and Verlet, x is the CPU time; right: the embedded methods,
#          whose cost hardly depends on the tolerance, which is x
# kind     point: y with its 95 % interval, low to high; limit: what the error is
#          below, since its interval holds zero; failed
# The header has the spread of the seeds of each panel, the CPU times of the
# embedded methods, and how many seeds each method has with friction.
BEGIN { FS = OFS = "\t" }
/^# run=/ { print }
/^#/ || !NF { next }
$1 == "variant" { for (k = 1; k <= NF; k++) at[$k] = k; next }
function get(name) { return $(at[name]) }
function put(panel, y, interval,  kind) {
  if (interval == "nan") interval = 0 # of one seed
  kind = get("status") == "failed" ? "failed" : \
    interval + 0 > 0 && y <= interval + 0 ? "limit" : "point"
  rows[panel] = rows[panel] panel OFS side OFS get("method") OFS setting OFS \
    get("seeds") OFS x OFS (kind == "limit" ? y + interval : y) OFS y - interval OFS \
    y + interval OFS kind OFS is_default "\n"
}
{
  variant = get("variant")
  if (get("status") == "reference") spread[variant] = get("spread")
  embedded = get("method") !~ /^(multirate|rkc|verlet)$/
  if (embedded && get("cpu_seconds") + 0 > 0) {
    c = get("cpu_seconds") + 0
    if (!(variant in least) || c < least[variant]) least[variant] = c
    if (c > most[variant]) most[variant] = c
  }
  if (get("status") == "reference") next
  if (variant == "rotation") {
    m = get("method")
    k = get("seeds") + 0
    if (!(m in few) || k < few[m]) few[m] = k
    if (k > many[m]) many[m] = k
  }
  side = embedded ? "right" : "left"
  setting = get("tol") == "-" ? get("step") : get("tol")
  x = embedded ? setting : get("cpu_seconds")
  is_default = get("method") == "multirate" && setting == "2e-3"
  d = get("difference")
  if (d < 0) d = -d
  if (variant == "rotation") {
    put("single", get("rms"), 0)
    put("mean", d, get("interval"))
  } else
    put("plain", d, get("interval"))
}
END {
  print "# spread_single=" spread["rotation"]
  print "# spread_mean=" spread["rotation"]
  print "# spread_plain=" spread["basic"]
  cost = "%.2g to %.2g s"
  print "# cost_single=" sprintf(cost, least["rotation"], most["rotation"])
  print "# cost_mean=" sprintf(cost, least["rotation"], most["rotation"])
  print "# cost_plain=" sprintf(cost, least["basic"], most["basic"])
  for (m in few)
    print "# seeds_" m "=" (few[m] < many[m] ? few[m] " to " : "") many[m] \
      (many[m] > 1 ? " seeds" : " seed")
  print "panel", "side", "method", "setting", "seeds", "x", "y", "low", \
    "high", "kind", "default"
  printf "%s%s%s", rows["single"], rows["mean"], rows["plain"]
}
