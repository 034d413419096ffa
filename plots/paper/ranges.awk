# SPDX-License-Identifier: GPL-3.0-or-later
# Mean, least and largest sum fraction at each time over the files of several
# seeds, written by analyze. -v variant=NAME labels the block.
FNR == 1 { row = 0; next }
{
  row++
  if (FNR == NR) times = row
  t[row] = $1
  sum[row] += $2
  if (count_of[row]++ == 0) { least[row] = $2; most[row] = $2 }
  if ($2 < least[row]) least[row] = $2
  if ($2 > most[row]) most[row] = $2
}
END {
  print "variant\tt\tmean\tmin\tmax"
  for (r = 1; r <= times; r++) {
    count = count_of[r]
    if (count != ARGC - 1) {
      print "ranges.awk: row " r " is missing in a file" > "/dev/stderr"
      exit 1
    }
    printf "%s\t%.9g\t%.9g\t%.9g\t%.9g\n", variant, t[r], sum[r] / count,
      least[r], most[r]
  }
  printf "\n\n"
}
