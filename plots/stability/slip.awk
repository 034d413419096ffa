# SPDX-License-Identifier: GPL-3.0-or-later
# How fast slip relaxes in a settled bed: for a range of steps the share of the
# contacts' force that is held by contacts whose slip a step of forward Euler,
# which is what Verlet does to forces by velocities, makes oscillate.
#   awk -f slip.awk BED
# A contact's slip decays at most at phi F Sigma'max sum(1/m + r^2/I) over the
# bodies that it moves, with Sigma'max = 1.5/vmin and I = 2/5 m r^2; Euler
# oscillates and grows where h times that is over 2. Rates of single contacts:
# what others do to the same spheres makes modes faster still.
BEGIN {
  FS = "\t"
  OFS = "\t"
  n = walls = contacts = 0
}
/^# [a-z0-9]+=/ {
  eq = index($0, "=")
  key[substr($0, 3, eq - 3)] = substr($0, eq + 1)
  if (/^# wall=/) wall[walls++] = substr($0, eq + 1)
  next
}
/^#/ || NF < 5 || $1 == "id" { next }
{
  x[n] = $2; y[n] = $3; z[n] = $4; r[n] = $5; m[n] = $6
  n++
}
function contact(gap, mobility,  force) {
  if (gap > key["lmax"]) return
  force = key["f0"] * exp(-key["kappa"] * gap)
  rate[contacts] = key["friction"] * force * 1.5 / key["vmin"] * mobility
  load[contacts++] = force
  total += force
}
END {
  for (i = 0; i < n; i++) {
    for (j = 0; j < i; j++)
      contact(sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + (z[i] - z[j])^2) - \
        r[i] - r[j], 3.5 / m[i] + 3.5 / m[j])
    for (k = 0; k < walls; k++) {
      split(wall[k], w, " ")
      contact((w[1] - x[i]) * w[4] + (w[2] - y[i]) * w[5] + \
        (w[3] - z[i]) * w[6] - r[i], 3.5 / m[i])
    }
  }
  print "step", "share"
  for (e = 0; e <= 60; e++) {
    h = exp((0.05 * e - 6) * log(10))
    unstable = 0
    for (c = 0; c < contacts; c++)
      if (h * rate[c] > 2) unstable += load[c]
    print h, unstable / total
  }
}
