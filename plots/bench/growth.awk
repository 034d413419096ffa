# SPDX-License-Identifier: GPL-3.0-or-later
# CPU time and fraction by the number of spheres, a block for each code and
# contact or method, from rows of peers/peers.sh in files COUNT-NAME.tsv; of runs
# to rest the time of rest too.
#   awk -f growth.awk COUNT-NAME.tsv...
# A file without a row is of a code that is not installed.
BEGIN { FS = OFS = "\t" }
FNR == 1 {
  split("", at)
  for (k = 1; k <= NF; k++) at[$k] = k
  file = FILENAME
  sub(/.*\//, "", file)
  sub(/\.tsv$/, "", file)
  spheres = file + 0
  sub(/^[0-9]*-/, "", file)
  next
}
{
  if (!(file in rows)) name[++names] = file
  cpu = $(at["CPU (s)"])
  c = "contact evaluations" in at ? $(at["contact evaluations"]) : "-"
  rows[file] = rows[file] file OFS spheres OFS $(at["seeds"]) OFS \
    $(at["steps"]) OFS cpu OFS sprintf("%.3g", 1000 * cpu / spheres) OFS \
    $(at["union"]) OFS (c == "-" ? c : sprintf("%.0f", c / spheres)) \
    ("end (s)" in at ? OFS $(at["end (s)"]) : "") "\n"
  end = end || "end (s)" in at
}
END {
  for (k = 1; k <= names; k++) {
    if (k > 1) print "\n"
    print "run", "spheres", "seeds", "steps", "CPU (s)", \
      "CPU per sphere (ms)", "union", "contact evaluations per sphere" \
      (end ? OFS "end (s)" : "")
    printf "%s", rows[name[k]]
  }
}
