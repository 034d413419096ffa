#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What `analyze export` hands on to solvers and meshers: units, the solid
# fraction that it states, and for each client the files as that client reads
# them. The clients themselves read them in tests/clients.sh. Run from the root
# of the repository; B is the directory of the programs.
. tests/harness.sh
B=$(cd "$B" && pwd) || exit 1
export OMP_NUM_THREADS=1

hand() { # ARGUMENT...: what is said goes to $T/said
  timeout 60 "$B/analyze" export "$@" </dev/null 2>"$T/said"
}

refuse() { # NAME STATUS PATTERN ARGUMENT...: one line, and no result
  local name=$1 code=$2 pattern=$3
  shift 3
  hand "$@" >"$T/out"
  local status=$?
  if [[ $status == "$code" && $(wc -l <"$T/said") == 1 && ! -s $T/out ]] &&
    grep -Eq -e "^analyze: .*$pattern" "$T/said"; then
    pass
  else
    fail "$name: exit status $status, expected $code and '$pattern': $(
      cat "$T/said")"
  fi
}

near() { # NAME VALUE WANT TOLERANCE
  check "$1: got '$2', want '$3' within $4" awk -v x="$2" -v w="$3" -v t="$4" \
    'BEGIN {exit !(x ~ /^[+-]?[0-9][0-9.e+-]*$/ && w ~ /^[+-]?[0-9]/ &&
      x - w <= t && w - x <= t)}'
}

stated() { # PATTERN: the number after it in what was said
  sed -n "s/.*$1 \([-+0-9.e]*\).*/\1/p" "$T/said" | head -n 1
}

union() { # ARGUMENT...: the last row's union by `analyze fraction`
  "$B/analyze" fraction "$@" | awk -F '\t' '
    NR == 1 {for (i = 1; i <= NF; i++) if ($i == "union") c = i} {x = $c}
    END {print x}'
}

# --- the bed of the paper, and what is handed on of it ----------------------
"$B/settle" --quiet --seed 1 >"$T/bed" 2>"$T/err" || fail 'no bed'
"$B/analyze" radius --quiet --keep contact-mean "$T/bed" >"$T/geometry"
r=$(awk -F '=' '/^# radius=/ {print $2}' "$T/geometry")

# --- units ------------------------------------------------------------------
for format in csv xyz lammps lammps-data; do
  hand --format $format --frame 0 "$T/bed" >"$T/m"
  near "$format states the exact union" "$(stated fraction)" \
    "$(union "$T/bed")" 1e-12
  hand --format $format --frame 0 --scale 4 --offset 16,32,64 "$T/bed" >"$T/big"
  near "$format in other units states the same" "$(stated fraction)" \
    "$(union "$T/bed")" 1e-12
  check "$format: the box is in the units written" \
    grep -q 'of the box 16,20,32,36,64,68 ' "$T/said"
done
columns() { # FILE: x y z r v of a table
  tail -n +2 "$1" | tr , ' ' | awk '{print $3, $4, $5, $6, $8, $9, $10}'
}
hand --format csv --scale 4 --offset 16,32,64 "$T/bed" >"$T/big"
hand --format csv "$T/bed" >"$T/m"
check 'lengths and speeds are scaled, places moved' awk '
  {for (k = 1; k <= 3; k++) {d = 4 * $k + 2 ^ (k + 3) - $(k + 7)
     if (!(d <= 2e-14 && -d <= 2e-14)) bad = 1}
   for (k = 4; k <= 7; k++) if (4 * $k != $(k + 7)) bad = 1}
  END {exit bad || NR != 200}' <(paste -d ' ' <(columns "$T/m") \
  <(columns "$T/big"))
check 'mass, id, time and spin are not' cmp -s \
  <(cut -d , -f 1,2,7,11- "$T/m") <(cut -d , -f 1,2,7,11- "$T/big")
hand --format raw --cells 12 --scale 4 --offset 16,32,64 "$T/bed" >"$T/big"
hand --format raw --cells 12 "$T/bed" >"$T/m"
check 'voxels of the same places' awk '
  {d = $1 - $2; if (!(d <= 1e-12 && -d <= 1e-12)) bad = 1; n += $1 > 0}
  END {exit bad || NR != 1728 || n < 1000}' <(paste -d ' ' \
  <(od -An -v -w8 -tf8 "$T/m") <(od -An -v -w8 -tf8 "$T/big"))
hand --format csv --quiet "$T/bed" >"$T/m"
check '--quiet says nothing' [ ! -s "$T/said" ]
refuse 'no scale' 2 '--scale 0: expected a number above 0' --format csv \
  --scale 0 "$T/bed"
refuse 'half an offset' 2 '--offset 1,2: expected 3 numbers' --format csv \
  --offset 1,2 "$T/bed"

# our own format, which is another bed
hand --format bed "$T/geometry" >"$T/again"
check 'a bed is the bed' cmp -s "$T/again" "$T/geometry"
refuse 'a bed in other units' 2 '--scale: not for --format bed' --format bed \
  --scale 2 "$T/bed"
sed '$d' "$T/bed" >"$T/cut"
check 'a cut bed stays marked' [ "$(hand --format bed --allow-partial \
  "$T/cut" | tail -n 1)" = '# status=cut' ]
# the default box is the base's cube
sed 's/^# wall=1 0 0 1 0 0/# wall=2 0 0 1 0 0/
  s/^# wall=0 1 0 0 1 0/# wall=0 3 0 0 1 0/' "$T/bed" >"$T/wide"
hand --format csv "$T/wide" >/dev/null
check 'the box is the cube on the base' \
  grep -q 'of the box 0,2,0,3,0,2 ' "$T/said"

check_done
