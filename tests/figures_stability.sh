# SPDX-License-Identifier: GPL-3.0-or-later
# A part of tests/test_figures.sh: make stability. What docs/stability.md says of
# where methods fail must be in the data.
D=$T/data/stability

# in_range NAME FILE PROGRAM: the awk program prints a value and its bounds for
# rows of FILE, whose columns are c["name"]; there must be some, all in range
in_range() {
  awk -F '\t' '/^#/ || NF == 0 { next }
    !named || $1 == "method" { for (k = 1; k <= NF; k++) c[$k] = k
                               named = 1; next }
    '"$3" "$2" | awk -v name="$1" '
    { n++
      if (!($2 + 0 <= $1 + 0 && $1 + 0 <= $3 + 0) || $1 ~ /nan|inf/) {
        bad++
        print name ": " $1 " is not in " $2 " to " $3 " (" $4 " " $5 ")" } }
    END { exit !n || bad }' >&2
}
inside() { # the same as a check of its own
  check "$1" in_range "$@"
}

# Limits: theory is that of the stepper on the linear test equation, measured on
# contacts; and what the literature has (Hairer and Wanner, IV.2; Merson from
# its polynomial).
inside 'limits: measured by theory' "$D/limits.tsv" \
  '{ print $c["ratio"], 0.95, 1.05, $1, $2 }'
known() { # METHOD AXIS VALUE: to the digits that are printed there
  inside "limits: $1, $2 axis" "$D/limits.tsv" \
    '$1 == "'"$1"'" && $2 == "'"$2"'" {
       print $c["theory"] / '"$3"', 0.997, 1.003, $1, $2 }'
}
known merson real 3.548
known merson imaginary 3.464
known dopri5 real 3.307
known dopri5 imaginary 0.997
known rkf45 real 3.678
# rkc, s even: |R| is 1 again at T_s(w0 + w1 z) = T_s(w0), z = -2 w0/w1
for s in 2 10; do
  known "rkc s=$s" real "$(awk -v s=$s 'BEGIN {
    w = 1 + 2 / 13 / s^2; a = log(w + sqrt(w^2 - 1))
    t = (exp(s*a) + exp(-s*a)) / 2
    d = s * (exp(s*a) - exp(-s*a)) / (exp(a) - exp(-a))
    e = (s^2 * t - w * d) / (w^2 - 1)
    print 2 * w * e / d }')"
done

# Missed collisions: without the cap nearly all by Merson, with it none by any,
# and all bounces right where the tolerance is not absurd.
inside 'tunnel: Merson misses without the cap' "$D/tunnel.tsv" \
  '$1 == "merson" && $2 == "sphere" && $3 == 0 {
     print $c["missed"] / $c["runs"], 0.75, 1, $1, $c["speed"] }'
inside 'tunnel: with the cap none is missed and none gives up' \
  "$D/tunnel.tsv" \
  '$3 > 0 { print $c["missed"] + $c["failed"], 0, 0, $1, $2 }'
inside 'tunnel: with the cap all bounce' "$D/tunnel.tsv" \
  '$3 > 0 && ($1 != "rkc" || $c["tol"] < 0.05) {
     print $c["bounced"] / $c["runs"], 1, 1, $1, $2 }'

# Energy at equal cost, 3000 evaluations per bounce: rounding for rk8pd and
# verlet, which is off by up to (omega h)^2/8 within a contact, omega =
# kappa v0/2 and h = 3e-4 s, but comes back; proportional to time for the rest.
inside 'drift: rk8pd and verlet at the apex' "$D/drift-bounce.tsv" \
  '$1 == "verlet" || $1 == "rk8pd" {
     print ($c["error"])^2, 0, 1e-24, $1, $c["units"] }'
inside 'drift: verlet within contacts' "$D/drift-bounce.tsv" \
  '$1 == "verlet" { print $c["largest"], 1e-5, 1.3e-3, $1, $c["units"] }'
inside 'drift: Merson loses in proportion to time' "$D/drift-bounce.tsv" \
  '$1 == "merson" { e = $c["error"] / $c["units"]
     if (!first) first = e
     print e / first, 0.5, 2, $1, $c["units"] }'
inside 'drift: rkc gains, 1000 times as much' "$D/drift-bounce.tsv" \
  '$1 == "merson" { m = $c["error"] } $1 == "rkc" { r = $c["error"] }
   END { print r / -m, 1000, 1e9 }'
inside 'drift: the box, verlet bounded' "$D/drift-box.tsv" \
  '$1 == "verlet" { print $c["largest"], 0, 3e-4, $1, $c["units"] }'
inside 'drift: the box, rkc gains a percent' "$D/drift-box.tsv" \
  '$1 == "rkc" { e = $c["error"] } END { print e, 0.01, 1 }'

# Creep: rkc and verlet keep the closed form, embedded methods with the paper's
# control jitter about it at the edge of stability by up to a few tenths of vmin.
inside 'creep: rkc and verlet' "$D/creep.tsv" \
  '($1 == "rkc" || $1 == "verlet") && $2 < 1 {
     print $c["measured"] / $c["closed"], 0.998, 1.002, $1, $2 }'
inside 'creep: sliding above the friction angle' "$D/creep.tsv" \
  '$2 > 1 { print $c["measured"] / $c["closed"], 0.995, 1.005, $1, $2 }'
inside 'creep: what is held is slower than vmin' "$D/creep.tsv" \
  '$1 ~ /rkc|verlet/ && $2 < 1 { print $c["most"], 0, 1, $1, $2 }'

# The cut: the floor by its formula, in proportion to which the gap is off.
inside 'cut: the floor is the formula' "$D/cut.tsv" \
  '$1 == "rk8pd" && $2 == "none" && $3 < 0.12 && $c["tol"] < 2e-10 {
     f = 2 * 10 * exp(-150 * $3) / 150 * (150 * $3 + log(30) - 1)
     print $c["error_gap"] / f, 0.9, 1.1, $3, $c["tol"] }'
inside 'cut: tapers are further off' "$D/cut.tsv" \
  '$1 == "rk8pd" && $3 == 0.1 && $c["tol"] < 2e-10 {
     e[$2] = $c["error_gap"] }
   END { for (t in e) if (t != "none") print e[t] / e["none"], 3, 12, t }'

# The page that warnings point to
for section in 'Stability limits' 'Penetration' 'Wrong beds' \
  'Missed collisions' 'Energy' 'The cut at lmax'; do
  check "docs/stability.md: $section" \
    grep -q "^## $section\$" docs/stability.md
done
