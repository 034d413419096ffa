#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A bed in other codes: the same start, box, mass, gravity and end time, their
# own contact laws; CPU time and volume fraction side by side.
#
#   B=build SEEDS="1 2 3" STEP=1 plots/bench/peers/peers.sh > table.tsv
#
# B      where the programs settle and analyze are
# SEEDS  seeds of the start
# TIME   end of the run, s
# REST=1 until the bed is at rest, by the criterion of settle --until-rest, whose
#        two conditions the other codes look at once a second; TIME at most
# STEP   factor on the steps of the other codes, to see what they hide
# COUNT  spheres
# BASE   width of the box (m)
# ROWS   what to run, a line for each: CODE CONTACT FRICTION K, or settle MODEL
#        FRICTION - OPTION...
# KEEP   folder for the beds, NUMBER-SEED.bed by the number of the row, from 1
#
# A code that is not installed is left out with a line on standard error.
# A speed without its fraction means nothing: the laws differ. Here e = 0.4 and
# the friction coefficient 0.2 are shared, but F0 exp(-kappa l) is far softer
# than the springs below, and our friction at rest reaches 2 phi/(1 + e^2).
set -eu -o pipefail

B=${B:-build}
SEEDS=${SEEDS:-1 2 3}
STEP=${STEP:-1}
REST=${REST:-}
T=${TIME:-$([ -n "$REST" ] && echo 300 || echo 8)}
COUNT=${COUNT:-200}
BASE=${BASE:-1}
KEEP=${KEEP:-}
ROWS=${ROWS:-$(for code in lammps liggghts; do
  for case in 'hooke 0.2 1e4' 'hooke 0.2 1e5' 'hertz 0.2 1e5' 'hooke 0 1e4' \
    'hooke 0 1e5'; do
    echo "$code $case"
  done
done
printf 'settle rotation 0.2 -%s\n' '' ' --tol 5e-4' ' --method rkc'
printf 'settle basic 0 -%s\n' '' ' --method rkc')}
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "$B" 2> /dev/null && pwd) || bin=$B
for program in settle analyze; do
  if [ ! -x "$bin/$program" ]; then
    echo "peers.sh: no $B/$program: run make first" >&2
    exit 1
  fi
done
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
# One thread and one process everywhere.
export OMP_NUM_THREADS=1
failed=0

# A bed file as a data file of LAMMPS; columns by name, density for the mass.
# The box is 6 m high: the start reaches 4.3 m. LIGGGHTS needs the second type
# for the walls.
to_data() {
  awk -F '\t' -v types="$1" -v width="$BASE" '
    /^#/ || !NF { next }
    !named { for (i = 1; i <= NF; i++) c[$i] = i; named = 1; next }
    {
      r = $c["r"]
      density = $c["m"] / (4 / 3 * atan2(0, -1) * r ^ 3)
      line[++n] = sprintf("%d 1 %.17g %.17g %.17g %.17g %.17g", $c["id"] + 1, \
        2 * r, density, $c["x"], $c["y"], $c["z"])
    }
    END {
      printf "start\n\n%d atoms\n%d atom types\n\n", n, types
      printf "0 %s xlo xhi\n0 %s ylo yhi\n0 6 zlo zhi\n\nAtoms\n\n", width, width
      for (i = 1; i <= n; i++) print line[i]
    }'
}

# The last frame of a dump as a bed file.
to_bed() {
  awk -v program="$1" -v t="$2" -v width="$BASE" '
    BEGIN {
      OFS = "\t"
      print "# format=bed-1"
      print "# program=" program
      print "# t=" t
      print "# wall=0 0 0 0 0 -1"
      print "# wall=0 0 0 -1 0 0"
      print "# wall=" width " 0 0 1 0 0"
      print "# wall=0 0 0 0 -1 0"
      print "# wall=0 " width " 0 0 1 0"
      print "id", "x", "y", "z", "r", "m", "vx", "vy", "vz", "wx", "wy", "wz"
    }
    /^ITEM:/ { atoms = /^ITEM: ATOMS/; if (atoms) n = 0; next }
    atoms { line[++n] = $0 }
    END {
      for (i = 1; i <= n; i++) {
        split(line[i], v, " ")
        print v[1] - 1, v[2], v[3], v[4], 0.1, 1, v[5], v[6], v[7], v[8], \
          v[9], v[10]
      }
      print "# status=ok"
    }'
}

# Everything that depends on contact, code, k and friction coefficient: writes
# the law and prints "dt steps times": so often these steps, unless at rest.
#
# Hooke: k for pairs and walls alike; the damping that gives e for an effective
# mass of 1/2 (pair) and 1 (wall), tangential spring 2/7 k and half the damping
# (what LAMMPS takes for NULL).
#
# Hertz: E such that the stiffness at v = 9 m/s, the impact from 4.2 m, is k by
# LIGGGHTS' formula of gran model hooke, k = 16/15 sqrt(R) Y (15 m v^2/(16
# sqrt(R) Y))^(1/5) with R = r/2 and Y = E/(2 (1 - nu^2)). LIGGGHTS takes no E
# below 5e6 Pa, so this needs k near 1e5 or more. LAMMPS' damping tsuji takes a
# polynomial for the damping ratio of a law that gives e = 0.53 when told 0.4;
# at 0.258 the ratio is what e = 0.4 needs, measured 0.400.
#
# Steps. LAMMPS' manual gives no rule; its examples (examples/pour/in.pour)
# call k = 2e5, dt = 1e-4 as in bench/in.chute appropriate, where m = pi/6 and
# the damping is 50/s: 1/36 of the collision time pi/sqrt(k/m_eff - gamma^2/4).
# LIGGGHTS' manual (fix check/timestep/gran) warns beyond fractions of the
# Rayleigh time, pi r sqrt(rho/G)/(0.1631 nu + 0.8766), and of the Hertz time,
# 2.87 (m_eff^2/(r_eff Y^2 v))^(1/5); its example has 0.1 and 0.1. The material
# is the one above for Hooke too, as that page says. With these steps a head-on
# contact returns 0.37 to 0.40 of the speed, with a tenth of them 0.40 in every
# case, pair and wall.
write_law() {
  awk -v code="$1" -v contact="$2" -v mu="$3" -v k="$4" -v factor="$STEP" \
    -v T="$T" -v rest="$REST" -v law="$tmp/law" '
    function ceil(x) { return int(x) + (int(x) < x) }
    BEGIN {
      pi = atan2(0, -1); e = 0.4; r = 0.1; m = 1; nu = 0.3; v = 9
      rho = m / (4 / 3 * pi * r ^ 3)
      zeta = -log(e) / sqrt(pi ^ 2 + log(e) ^ 2)
      pair = 2 * zeta * sqrt(m / 2 * k)
      wall = 2 * zeta * sqrt(m * k)
      kt = 2 / 7 * k
      Y = 15 / 16 * (k ^ 5 / (m / 2 * v ^ 2)) ^ 0.25 / sqrt(r / 2)
      E = 2 * (1 - nu ^ 2) * Y
      hertz = 2.87 * ((m / 2) ^ 2 / (r / 2 * Y ^ 2 * v)) ^ 0.2
      rayleigh = pi * r * sqrt(rho * 2 * (1 + nu) / E) / (0.1631 * nu + 0.8766)

      if (code == "lammps") {
        dt = (contact == "hooke" ? \
          pi / sqrt(k / (m / 2) * (1 - zeta ^ 2)) : hertz) / 36
        if (contact == "hertz") {
          contact_law = sprintf("hertz/material %.9g 0.258 %g " \
            "tangential mindlin NULL 1 %g damping tsuji", E, nu, mu)
          print "pair_style granular\npair_coeff * * " contact_law > law
          print "variable wall string \"granular " contact_law "\"" > law
        } else if (mu > 0) {
          # Pairs by the older style, up to twice as fast as pair granular;
          # walls not: there it can gain energy at grazing impacts (pull
          # request 5007 of LAMMPS).
          printf "pair_style gran/hooke/history %.9g %.9g %.9g %.9g %g 1\n", \
            k, kt, pair / (m / 2), pair / m, mu > law
          print "pair_coeff * *" > law
          printf "variable wall string \"granular hooke %.9g %.9g tangential " \
            "linear_history %.9g 0.5 %g damping velocity\"\n", \
            k, wall, kt, mu > law
        } else {
          printf "pair_style gran/hooke %.9g %.9g %.9g 0 0 0\n", \
            k, kt, pair / (m / 2) > law
          print "pair_coeff * *" > law
          printf "variable wall string \"granular hooke %.9g %.9g " \
            "tangential linear_nohistory 0 0 damping velocity\"\n", \
            k, wall > law
        }
      } else {
        dt = 0.1 * (hertz < rayleigh ? hertz : rayleigh)
        tangential = mu > 0 ? "tangential history" : ""
        table = "fix %s all property/global %s peratomtypepair 2 " \
          "%.9g %.9g %.9g %.9g\n"
        printf table, "mu", "coefficientFriction", mu, mu, mu, mu > law
        if (contact == "hertz") {
          style = "model hertz " tangential
          flags = "tangential_damping on"
          printf "fix E all property/global youngsModulus peratomtype " \
            "%.9g %.9g\n", E, E > law
          printf "fix nu all property/global poissonsRatio peratomtype " \
            "%g %g\n", nu, nu > law
          printf table, "e", "coefficientRestitution", e, e, e, e > law
        } else {
          style = "model hooke/stiffness " tangential
          flags = "absolute_damping on"
          printf table, "kn", "kn", k, k, k, k > law
          printf table, "kt", "kt", kt, kt, kt, kt > law
          printf table, "gn", "gamman_abs", pair, wall, wall, wall > law
          printf table, "gt", "gammat_abs", pair / 2, wall / 2, wall / 2, \
            wall / 2 > law
        }
        print "pair_style gran " style " " flags "\npair_coeff * *" > law
        print "variable wall string \"" style "\"" > law
        print "variable flags string \"" flags "\"" > law
      }
      if (rest) { # a second at a time
        steps = ceil(1 / (dt * factor))
        printf "%.9g %d %d\n", 1 / steps, steps, ceil(T)
      } else {
        steps = ceil(T / (dt * factor))
        printf "%.9g %d 1\n", T / steps, steps
      }
    }'
}

# One run's CPU seconds (user and system, all of the process), sum, union and
# largest speed, appended to $tmp/runs. Output of the code goes to $tmp/output.
run_peer() {
  local code=$1 program=$2 seed=$3 dt=$4 steps=$5 times=$6
  local types=1 end
  [ "$code" = lammps ] || types=2
  "$bin/settle" "${start[@]}" --seed "$seed" --time 0 --quiet | to_data $types > "$tmp/start"
  rm -f "$tmp/end"
  # The directory because LIGGGHTS writes a log whatever it is told.
  if ! (
    cd "$tmp"
    TIMEFORMAT='%U %S'
    { time "$program" -in "$here/in.$code" -log none -screen "$tmp/output" \
      -var start "$tmp/start" -var law "$tmp/law" -var end "$tmp/end" \
      -var dt "$dt" -var steps "$steps" -var times "$times" -var width "$BASE" \
      -var runs "$here/in.runs" \
      > /dev/null 2> "$tmp/errors"
    } 2> "$tmp/cpu"
  ) || [ ! -s "$tmp/end" ]; then
    return 1
  fi
  taken=$(awk '/^ITEM: TIMESTEP/ { getline step } END { print step }' "$tmp/end")
  end=$(awk -v dt="$dt" -v steps="$taken" 'BEGIN { printf "%.6g", dt * steps }')
  if [ -n "$REST" ] && [ "$taken" -eq $((steps * times)) ]; then
    echo "peers.sh: $code not at rest after $end s" >&2
  fi
  to_bed "$code" "$end" < "$tmp/end" > "$tmp/bed"
}

# The bed in $tmp/bed of a seed, checked: no sphere is lost, none outside the
# walls.
measure() {
  local cpu n outside speed
  [ -z "$KEEP" ] || cp "$tmp/bed" "$KEEP/$number-$1.bed"
  cpu=$(awk '{ print $1 + $2 }' "$tmp/cpu")
  "$bin/analyze" --box "0,$BASE,0,$BASE,0,1" "$tmp/bed" > "$tmp/fraction" ||
    return 1
  awk -F '\t' -v width="$BASE" '
    /^#/ || !NF { next }
    !named { for (i = 1; i <= NF; i++) c[$i] = i; named = 1; next }
    {
      n++
      x = $c["x"]; y = $c["y"]; z = $c["z"]
      outside += !(x > 0 && x < width && y > 0 && y < width && z > 0)
      u = sqrt($c["vx"] ^ 2 + $c["vy"] ^ 2 + $c["vz"] ^ 2)
      if (u > speed) speed = u
    }
    END { print n, outside + 0, speed + 0 }' "$tmp/bed" > "$tmp/sanity"
  read -r n outside speed < "$tmp/sanity"
  if [ "$n" -ne "$COUNT" ] || [ "$outside" -ne 0 ]; then
    echo "peers.sh: $n spheres, $outside of them outside the box" >&2
    return 1
  fi
  awk -v cpu="$cpu" -v speed="$speed" \
    'NR == 2 { print cpu, $2, $3, speed, $1 }' "$tmp/fraction" >> "$tmp/runs"
}

# A row from $tmp/runs: means and standard errors over the seeds, the largest
# speed of all; and the contact evaluations of the last seed, where known. With
# REST the mean end too.
row() {
  awk -v OFS='\t' -v head="$1" -v contacts="${2:--}" -v rest="$REST" '
    {
      cpu += $1; sum += $2; uni += $3; uni2[NR] = $3; end += $5
      if ($4 > speed) speed = $4
    }
    END {
      mean = uni / NR
      for (i = 1; i <= NR; i++) s += (uni2[i] - mean) ^ 2
      error = NR > 1 ? sprintf("%.4f", sqrt(s / (NR - 1) / NR)) : "-"
      gsub(/ /, "\t", head)
      print head, NR, sprintf("%.2f", cpu / NR), sprintf("%.4f", sum / NR), \
        sprintf("%.4f", mean), error, sprintf("%.1e", speed), contacts \
        (rest ? OFS sprintf("%.1f", end / NR) : "")
    }' "$tmp/runs"
}

# A row of another code: CODE CONTACT FRICTION K
peer_row() {
  local code=$1 contact=$2 mu=$3 k=$4 program=$1
  [ "$code" = liggghts ] || program=lmp
  if ! command -v "$program" > /dev/null; then
    [[ $missing == *$code* ]] ||
      echo "peers.sh: no $program: install the package $code (Debian, Ubuntu:" \
        "apt-get install $code); left out" >&2
    missing+=" $code"
    return
  fi
  write_law "$code" "$contact" "$mu" "$k" > "$tmp/steps"
  read -r dt steps times < "$tmp/steps"
  for seed in $SEEDS; do
    if ! run_peer "$code" "$program" "$seed" "$dt" "$steps" "$times" ||
      ! measure "$seed"; then
      echo "peers.sh: $* seed $seed failed:" >&2
      cat "$tmp/errors" "$tmp/output" 2> /dev/null | grep -a ERROR >&2 || true
      failed=1
      return
    fi
  done
  row "$code $contact $mu $k $(printf '%.3g' "$dt") $taken"
}

# A row of settle: MODEL FRICTION - OPTION...; its steps are those of the last
# seed.
settle_row() {
  local model=$1 mu=$2 method steps contacts
  shift 3
  [ -z "$REST" ] || set -- "$@" --until-rest
  for seed in $SEEDS; do
    TIMEFORMAT='%U %S'
    { time "$bin/settle" "${start[@]}" --model "$model" --seed "$seed" \
      --time "$T" --quiet --stats "$tmp/stats" "$@" > "$tmp/bed" \
      2> "$tmp/errors"; } 2> "$tmp/cpu" || { cat "$tmp/errors" >&2; exit 1; }
    measure "$seed"
  done
  steps=$(awk -F '\t' '$1 == "steps_accepted" { print $2 }' "$tmp/stats")
  method=$(awk -F '\t' '$1 == "method" { print $2 }' "$tmp/stats")
  contacts=$(awk -F '\t' '$1 == "contact_evaluations" { print $2 }' \
    "$tmp/stats")
  method+=$(sed -n 's/.*--tol /-/p' <<< "$*")
  row "settle $model-$method $mu - adaptive $steps" "$contacts"
}

start=(--count "$COUNT" --base "$BASE,$BASE")
missing=
printf '%s\t' code contact friction 'k (N/m)' 'step (s)' steps seeds \
  'CPU (s)' sum union 'standard error'
printf '%s\t%s%s\n' 'largest speed (m/s)' 'contact evaluations' \
  "${REST:+$'\t'end (s)}"
number=0
while read -r code what; do
  : > "$tmp/runs"
  number=$((number + 1))
  # shellcheck disable=SC2086 # words
  case $code in
    settle) settle_row $what ;;
    *) peer_row $code $what ;;
  esac
done <<< "$ROWS"
exit $failed
