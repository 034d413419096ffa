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
unsealed "$T/bed" | sed 's/^# wall=1 0 0 1 0 0/# wall=2 0 0 1 0 0/
  s/^# wall=0 1 0 0 1 0/# wall=0 3 0 0 1 0/' >"$T/wide"
hand --format csv "$T/wide" >/dev/null
check 'the box is the cube on the base' \
  grep -q 'of the box 0,2,0,3,0,2 ' "$T/said"

# --- the paper's solver ------------------------------------------------------
solver() { # FOLDER: x y z r of each sphere (m), as it has them; L1 L2 L3 xi_gl
  tr -s ' \t\n' '\n' <"$1/spheres_positions.txt" | awk -v params="$1/Params" '
    function value(text, part, k, v) {  # a product or quotient of names
      k = split(text, part, /[*\/]/)
      v = part[1] in name ? name[part[1]] : part[1] + 0
      if (k > 1) {
        part[2] = part[2] in name ? name[part[2]] : part[2] + 0
        v = text ~ /\// ? v / part[2] : v * part[2]
      }
      return v
    }
    BEGIN {
      while ((getline line < params) > 0)
        if (line !~ /^#/ && split(line, f, " ") == 2)
          name[f[1]] = value(f[2])
      split("x y z", axis, " ")
      OFS = ","
    }
    /^[-+]?[0-9.]+(e[-+]?[0-9]+)?$/ {c[++got] = $1; if (got < 3) next
      for (k = 1; k <= 3; k++)
        c[k] = c[k] * name["beads_scaling"] + name["beads_offset_" axis[k]]
      if (++balls <= 1000) print c[1], c[2], c[3], name["ball_radius"]
      got = 0; next}
    {exit}
    END {print balls + 0, name["L1"], name["L2"], name["L3"], name["xi_gl"]}' \
    OFMT=%.17g CONVFMT=%.17g
}

freezing() { # NAME ARGUMENT...: hands a bed on and reads it as the solver does
  local name=$1
  shift
  rm -rf "$T/case"
  check "$name" hand --format freezethaw --output "$T/case" "$@"
  solver "$T/case" >"$T/solver"
  IFS=, read -r balls l1 l2 l3 xi < <(tail -n 1 "$T/solver")
  (echo x,y,z,r && sed '$d' "$T/solver") >"$T/solver.csv"
}
freezing 'freezethaw' "$T/geometry"
check 'freezethaw: 200 balls are read' [ "$balls" = 200 ]
check 'freezethaw: nothing but numbers' \
  awk -F '\t' 'NF != 3 || /[^-+.0-9e\t]/ {bad = 1} END {exit bad}' \
  "$T/case/spheres_positions.txt"
check 'freezethaw: positions are of a unit base' cmp -s \
  <(awk -F '\t' '/^[0-9]/ {print $2 + 0, $3 + 0, $4 + 0}' "$T/geometry") \
  <(awk '{print $1 + 0, $2 + 0, $3 + 0}' "$T/case/spheres_positions.txt")
check "freezethaw: the published domain, got $l1 $l2 $l3" \
  [ "$l1 $l2 $l3" = '0.029999999999999999 0.029999999999999999 0.059999999999999998' ]
near 'freezethaw: its radius' "$(awk -F , 'NR == 2 {print $4}' \
  "$T/solver.csv")" "$(awk -v r="$r" 'BEGIN {printf "%.17g", 0.03 * r}')" 1e-17
near 'freezethaw: the solid is the one stated' "$(stated fraction)" \
  "$(union --box "0,$l1,0,$l2,0,$l1" "$T/solver.csv")" 1e-10
near 'freezethaw: and the bed'"'"'s' "$(stated fraction)" \
  "$(union "$T/geometry")" 1e-10
# the phase field at the midpoints of a grid, as the solver computes it
diffuse() { # CELLS XI: its mean in the bottom cube
  "$B/analyze" export --quiet --format raw --distance --cells "$1" \
    --box "0,$l1,0,$l2,0,$l1" "$T/solver.csv" | od -An -v -w8 -tf8 | awk -v xi="$2" '
    {a = exp(-$1 / xi); sum += a == "inf" ? 1 : a / (1 + a)}
    END {printf "%.17g", sum / NR}'
}
for width in 1000 500 300; do
  near "freezethaw: mean of the profile at L3/$width" "$(
    sed -n "s|^#  *xi_gl L3/$width *\([0-9.]*\),.*|\1|p" "$T/case/Params")" \
    "$(diffuse 60 "$(awk -v l="$l3" -v w=$width 'BEGIN {print l / w}')")" 2e-3
done
near 'freezethaw: the width suggested' "$xi" \
  "$(awk -v l="$l3" 'BEGIN {print l / 300}')" 1e-12
freezing 'a soft bed' "$T/bed"
near 'its overlaps ask for a thinner profile' "$xi" \
  "$(awk -v l="$l3" 'BEGIN {print l / 500}')" 1e-12
# walls of 5 % of the domain, as in the published case; another base
freezing 'with walls' --scale 0.027 --offset 0.0015,0.0015,0.0015 "$T/bed"
near 'walls: the domain' "$l1" 0.03 1e-17
near 'walls: the solid' "$(stated fraction)" "$(union --box \
  0.0015,0.0285,0.0015,0.0285,0.0015,0.0285 "$T/solver.csv")" 1e-10
near 'walls: is the same' "$(stated fraction)" "$(union "$T/bed")" 1e-10
awk 'BEGIN {OFS = "\t"} /^# checksum=/ {next} /^# wall=/ {sub(/=1/, "=4"); sub(/=0 1/, "=0 4")
  print; next} /^[0-9]/ {for (k = 2; k <= 5; k++) $k *= 4} {print}' \
  FS='\t' CONVFMT=%.17g OFMT=%.17g "$T/bed" >"$T/large"
freezing 'a base of 4 m' "$T/large"
check 'another base: the same numbers' awk '
  {for (k = 1; k <= 3; k++) {d = $k - $(k + 3)
    if (!(d < 1e-14 && -d < 1e-14)) bad = 1}} END {exit bad || NR != 200}' \
  <(paste <(awk -F '\t' '/^[0-9]/ {print $2, $3, $4}' "$T/bed") \
  "$T/case/spheres_positions.txt")
near 'another base: the same solid' "$(union --box "0,$l1,0,$l2,0,$l1" \
  "$T/solver.csv")" "$(union "$T/bed")" 1e-10
hand --format freezethaw --output "$T/case" "$T/bed"
check 'its own Params may be written again' [ $? = 0 ]
mkdir "$T/theirs"
echo 'L1 0.03' >"$T/theirs/Params"
refuse 'a Params of their own' 2 'its Params is not of' --format freezethaw \
  --output "$T/theirs" "$T/bed"
check 'it is left alone' [ "$(ls "$T/theirs")" = Params ]
refuse 'no folder' 2 'expected --output' --format freezethaw "$T/bed"
awk 'BEGIN {print "x,y,z,r"; for (i = 0; i < 1001; i++)
  print (i % 10 + 0.5) / 10 "," (int(i / 10) % 10 + 0.5) / 10 "," \
    (int(i / 100) + 0.5) / 10 ",0.04"}' >"$T/many.csv"
refuse 'a thousand and one' 3 '1001 spheres; .* after 1000' \
  --format freezethaw --output "$T/none" "$T/many.csv"
check 'a refusal leaves no folder' [ ! -e "$T/none" ]
head -n 1001 "$T/many.csv" >"$T/most.csv"
check 'a thousand' hand --format freezethaw --output "$T/most" "$T/most.csv"
printf 'x,y,z,r\n.5,.5,.5,.1\n.2,.2,.2,.11\n' >"$T/two.csv"
refuse 'unequal radii' 3 'several radii' --format freezethaw \
  --output "$T/none" "$T/two.csv"
printf 'x,y,z,r\n.5,.5,1.74,.1\n' >"$T/high.csv"
refuse 'a bed above the lid' 3 'z = 0.0552 m, above .* 0.055 m' \
  --format freezethaw --output "$T/none" "$T/high.csv"
printf 'x,y,z,r\n.5,.5,1.73,.1\n' >"$T/high.csv"
check 'a bed below it' hand --format freezethaw --output "$T/none" "$T/high.csv"
refuse 'a domain below 0' 2 '--offset: the base begins below 0 of y' \
  --format freezethaw --offset 0,-0.001,0 --output "$T/none2" "$T/bed"
"$B/analyze" export --format freezethaw --output "$T/full/case" "$T/bed" \
  2>"$T/said"
check 'a folder in none' [ $? = 1 ]
check 'all frames, a folder each' hand --format freezethaw --frames all \
  --output "$T/case-%02d" "$T/bed"
check 'all frames: are there' cmp -s "$T/case-00/spheres_positions.txt" \
  "$T/case/spheres_positions.txt"

# --- periodic sides ----------------------------------------------------------
"$B/settle" --quiet --periodic xy --count 40 --time 1.5 >"$T/periodic"
all=$(union "$T/periodic")
for format in positions csv xyz lammps vtp geo stl freezethaw; do
  hand --format $format --output "$T/one" "$T/periodic"
  near "periodic: $format states all that is in the box" \
    "$(stated 'solid fraction')" "$all" 1e-11
  rm -rf "$T/one"
done
hand --format csv "$T/periodic" >"$T/one.csv"
check 'periodic: csv has each sphere once' [ "$(wc -l <"$T/one.csv")" = 41 ]
hand --format csv --images "$T/periodic" >"$T/all.csv"
near 'periodic: its copies fill the box' "$(union --box 0,1,0,1,0,1 \
  "$T/all.csv")" "$all" 1e-12
check 'periodic: copies are whole periods away' awk -F , '
  BEGIN {n = 0}
  function off(a, b) {a -= b; a -= sprintf("%.0f", a); return a < 0 ? -a : a}
  FNR == NR {if (FNR > 1) {x[n] = $3; y[n] = $4; z[n++] = $5}; next}
  FNR > 1 {for (i = 0; i < n; i++)
      if (off($3, x[i]) < 1e-12 && off($4, y[i]) < 1e-12 && $5 == z[i]) break
    if (i == n) bad = 1; else if ($3 != x[i] || $4 != y[i]) moved++}
  END {exit bad || !(moved > 5)}' "$T/one.csv" "$T/all.csv"
check 'periodic: xyz has the cell' grep -q \
  '^Lattice="1 0 0 0 1 0 0 0 [0-9.]*" Origin="0 0 [-0-9.e]*" pbc="T T F"' \
  <(hand --format xyz "$T/periodic")
check 'periodic: and none where there are copies' grep -q 'pbc="F F F"' \
  <(hand --format xyz --images "$T/periodic")
hand --format lammps "$T/periodic" >"$T/dump"
check 'periodic: lammps has the cell' [ "$(sed -n 7,9p "$T/dump")" = \
  'ITEM: BOX BOUNDS pp pp ff
0 1
0 1' ]
refuse 'copies in a dump' 2 '--images: not for --format lammps' \
  --format lammps --images "$T/periodic"
refuse 'copies in a network' 2 '--network: expected no --images' \
  --format vtp --network --images "$T/periodic"
freezing 'periodic: freezethaw' "$T/periodic"
near 'periodic: the solver gets it all' "$(union --box \
  "0,$l1,0,$l2,0,$l1" "$T/solver.csv")" "$all" 1e-10
hand --format stl --merged --cells 40 "$T/periodic" >"$T/stl"
check 'periodic: merged within the bound' awk -v d="$(stated 'that is')" \
  -v b="$(stated '(step\/r)^2\/3 =')" \
  'BEGIN {exit !(b > 0 && b < 0.04 && d < b && -d < b)}'
# contacts across the sides: lines as long as two spheres that touch
hand --format vtp --network "$T/periodic" >"$T/vtp"
sides=$(sed -n 's/.* \([0-9]*\) across periodic sides.*/\1/p' "$T/said")
check "periodic: $sides contacts across the sides" [ "$sides" -gt 3 ]
data=$(grep -abo '<AppendedData encoding="raw">' "$T/vtp" | cut -d : -f 1)
array() { # OFFSET TYPE: of the file's appended part, a number a line
  local at=$((data + 31 + $1))
  local bytes
  bytes=$(od -An -j $at -N 8 -tu8 "$T/vtp")
  od -An -v -w8 -j $((at + 8)) -N $((bytes)) -t"$2" "$T/vtp"
}
ends=$(sed -n '/<Lines>/,/<\/Lines>/s/.*"connectivity".*offset="\([0-9]*\)".*/\1/p' \
  "$T/vtp")
check 'periodic: no line is longer than two spheres' awk '
  FNR == NR {x[FNR - 1] = $1; next} {end[n++] = $1}
  END {for (k = 0; k < n; k += 2) {d = 0
    for (m = 0; m < 3; m++) d += (x[3 * end[k] + m] - x[3 * end[k + 1] + m]) ^ 2
    if (!(d <= 0.2 ^ 2)) bad = 1; if (d > 0.18 ^ 2) long++}
    exit bad || !(long > 20)}' <(array 0 f8) <(array "$ends" d8)
# a sphere on a side, and a box that is no whole period long
parts() { # as it is said of voxels
  sed -n 's/.*make \([0-9]*\) solid parts* and \([0-9]*\) pore.*/\1 \2/p' \
    "$T/said"
}
awk '/^[0-9]/ {if (n++) next; $2 = 0; $3 = 0; $4 = 0.5} {print}' FS='\t' \
  OFS='\t' <(unsealed "$T/periodic") >"$T/corner"
hand --format raw --cells 20 "$T/corner" >"$T/raw"
check "periodic: four quarters are one solid: $(parts)" [ "$(parts)" = '1 1' ]
hand --format palabos --cells 20 "$T/corner" >"$T/raw"
check "periodic: and turned: $(parts)" [ "$(parts)" = '1 1' ]
hand --format raw --cells 22,20,20 --box 0,1.1,0,1,0,1 "$T/corner" >"$T/raw"
check "periodic: but not in part of a period: $(parts)" [ "$(parts)" = '2 1' ]

# --- voxels for others -------------------------------------------------------
hand --format raw --binary --cells 7,6,5 "$T/bed" >"$T/raw"
said=$(tail -n 1 "$T/said")
check 'palabos' hand --format palabos --cells 7,6,5 "$T/bed" >"$T/text"
check 'palabos says the same of it' [ "$(tail -n 1 "$T/said")" = "$said" ]
said=
check 'palabos: z fastest, then y, then x' cmp -s \
  <(od -An -v -w1 -tu1 "$T/raw" | awk '{v[NR - 1] = $1} END {
    for (i = 0; i < 7; i++) for (j = 0; j < 6; j++) for (k = 0; k < 5; k++)
      print v[i + 7 * (j + 6 * k)]}') <(tr ' ' '\n' <"$T/text")
check 'palabos: a line for each x and y' \
  awk 'NF != 5 {bad = 1} END {exit bad || NR != 42}' "$T/text"
box=-0.5,1,0,0.75,0,2
hand --format raw --cells 3,2,5 --box=$box --scale 2 "$T/bed" >"$T/raw"
check 'mhd' hand --format mhd --cells 3,2,5 --box=$box --scale 2 \
  --output "$T/image.mhd" "$T/bed"
check 'mhd: the numbers are those of raw' cmp -s "$T/raw" "$T/image.raw"
check 'mhd: the first midpoint and the steps' [ "$(sed -n \
  's/^\(Offset\|ElementSpacing\|DimSize\|Element.*\) = //p' "$T/image.mhd" |
  tr '\n' ' ')" = '-0.5 0.375 0.40000000000000002 1 0.75 0.80000000000000004 3 2 5 MET_DOUBLE image.raw ' ]
hand --format mhd --binary --output "$T/image.mhd" "$T/bed"
check 'mhd: bytes' grep -q 'MET_UCHAR' "$T/image.mhd"
refuse 'mhd: another name' 2 'ends in .mhd' --format mhd --output "$T/a.raw" \
  "$T/bed"
check 'mhd: a file for each frame' hand --format mhd --cells 4 --frames all \
  --output "$T/f%d.mhd" "$T/bed"
check 'mhd: its own numbers' grep -q '= f0.raw$' "$T/f0.mhd"
refuse 'palabos: no numbers' 2 '--distance: not for --format palabos' \
  --format palabos --distance "$T/bed"

# parts: two spheres that touch and one apart; a box around a sphere has an
# inside and an outside
printf 'x,y,z,r\n.25,.5,.5,.2\n.64,.5,.5,.2\n.25,.2,.2,.1\n' >"$T/three.csv"
for what in '' --binary --distance; do
  hand --format raw --cells 50 $what "$T/three.csv" >/dev/null
  check "parts of three spheres $what" [ "$(parts)" = '2 1' ]
done
awk 'BEGIN {print "x,y,z,r"; for (i = 0; i < 2000; i++) {
  z = (i + 0.5) / 1000 - 1; p = 2.399963229728653 * i; s = sqrt(1 - z * z)
  print 0.5 + 0.35 * s * cos(p) "," 0.5 + 0.35 * s * sin(p) "," 0.5 + 0.35 * z \
    ",0.05"}; print "0.5,0.5,0.5,0.1"}' >"$T/shell.csv"
hand --format raw --cells 50 "$T/shell.csv" >/dev/null
check "parts of a shell around a sphere: $(parts)" [ "$(parts)" = '2 2' ]
"$B/analyze" radius --quiet --keep touching "$T/bed" | timeout 60 "$B/analyze" \
  export --format raw --binary 2>"$T/said" >/dev/null
check "a bed that touches falls into parts: $(parts)" \
  awk '{exit !($1 > 150 && $2 == 1)}' <(parts)

# --- gaps, bridges, walls ----------------------------------------------------
nearest() { # the least gap of two spheres in a csv
  tail -n +2 "$1" | awk -F , '
    {for (k = 1; k <= 3; k++) x[NR, k] = $(k + 2); r[NR] = $6
     for (i = 1; i < NR; i++) {
       d = 0
       for (k = 1; k <= 3; k++) d += (x[i, k] - $(k + 2)) ^ 2
       d = sqrt(d) - r[i] - $6
       if (NR == 2 || d < least) least = d}}
    END {printf "%.17g", least}'
}
for gap in 0 0.004; do
  check "gap $gap" hand --format csv --gap $gap "$T/bed" >"$T/apart.csv"
  near "gap $gap is the least gap" "$(nearest "$T/apart.csv")" $gap 1e-15
  near "gap $gap: the exact change" "$(stated 'change of the fraction')" \
    "$(awk -v a="$(union "$T/apart.csv")" -v b="$(union "$T/bed")" \
      'BEGIN {printf "%.17g", a - b}')" 1e-11
  near "gap $gap: the fraction left" "$(stated 'solid fraction')" \
    "$(union "$T/apart.csv")" 1e-11
done
hand --format csv --gap 0.1 "$T/two.csv" >"$T/apart.csv"
check 'a gap that is there changes nothing' cmp -s "$T/apart.csv" \
  <(hand --format csv "$T/two.csv")
refuse 'a gap too wide' 3 '--gap: two centres' --format csv --gap 0.6 "$T/two.csv"
hand --format bed --gap 0.004 "$T/bed" >"$T/apart"
check 'a bed keeps the radius of its dynamics' \
  grep -q '^# radius_dynamics=0.1$' "$T/apart"
check 'a bed says what the gap did' \
  grep -q '^# gap=.*radii times 0.[0-9]*, change of the fraction -' "$T/apart"
check 'a bed with a gap is a bed' [ "$("$B/analyze" "$T/apart" | wc -l)" = 2 ]
refuse 'a bed of two radii' 3 'several radii' --format bed --gap 0.1 "$T/two.csv"
for format in xyz lammps-data vtp vti stl; do
  check "$format has the change in its header" grep -aq \
    'gap: radii times 0.[0-9]*, change of\|spheres, solid fraction' \
    <(hand --format $format --gap 0.004 "$T/bed" | head -n 6)
  check "$format: and not without one" [ "$(hand --format $format "$T/bed" |
    head -n 6 | grep -ac 'change of\|solid fraction')" = 0 ]
done
hand --format xyz --gap 0.004 "$T/bed" >"$T/apart.xyz"
check 'xyz with a note is read again' [ "$("$B/analyze" "$T/apart.xyz" |
  wc -l)" = 2 ]

# two that touch: pi X^4/(2 r) to the leading order, here to all of them
printf 'x,y,z,r\n.3,.5,.5,.2\n.7,.5,.5,.2\n' >"$T/pair.csv"
hand --format raw --cells 50 --bridge 0.1 "$T/pair.csv" >"$T/raw"
near 'bridge: one' "$(sed -n 's/.*bridges: \([0-9]*\),.*/\1/p' "$T/said")" 1 0
near 'bridge: its collar' "$(stated 'change of the fraction')" \
  "$(awk 'BEGIN {r = 0.2; x = 0.1; pi = atan2(0, -1); s = sqrt(r * r - x * x)
    cap = pi * (r - s) ^ 2 * (2 * r + s) / 3
    printf "%.17g", 2 * (pi * x * x * (r - s) - cap)}')" 1e-13
near 'bridge: the voxels have it' "$(stated 'mean solid fraction')" \
  "$(stated 'solid fraction')" 1e-5
check 'bridge: one solid' [ "$(parts)" = '1 1' ]
printf 'x,y,z,r\n.29,.5,.5,.2\n.71,.5,.5,.2\n' >"$T/pair.csv"
hand --format raw --bridge 0.1 "$T/pair.csv" >"$T/raw"
check 'no bridge where spheres do not touch' [ "$(parts)" = '2 1' ]
hand --format raw --bridge 0.1 --reach 0.03 "$T/pair.csv" >"$T/raw"
check 'but within reach' [ "$(parts)" = '1 1' ]
"$B/analyze" radius --quiet --keep touching "$T/bed" >"$T/touching"
hand --format raw --bridge 0.02 "$T/touching" >"$T/raw"
check "bridges hold a bed that touches together: $(parts)" \
  awk '{exit !($1 < 5)}' <(parts)
for format in positions csv xyz lammps lammps-data vtp bed; do
  refuse "no bridges in $format" 2 "--bridge: not for --format $format" \
    --format $format --bridge 0.01 "$T/bed"
done
refuse 'a bridge too thick' 3 'less than the least radius, 0.1 m' --format raw \
  --bridge 0.1 "$T/bed"
refuse 'reach alone' 2 '--reach: expected --bridge' --format raw --reach 0.1 \
  "$T/bed"

# walls: five of them, in a box of 12 cells of 0.1 m with one beyond each
hand --format raw --cells 12,12,11 --walls "$T/bed" >"$T/raw"
near 'walls: the share of them' "$(stated 'walls')" \
  "$(awk 'BEGIN {printf "%.17g", 1 - 1 / (1.2 * 1.2 * 1.1)}')" 1e-11
near 'walls: and the bed' "$(stated 'solid fraction')" \
  "$(awk -v u="$(union "$T/bed")" 'BEGIN {v = 1.2 * 1.2 * 1.1
    printf "%.17g", (v - 1 + u) / v}')" 1e-11
near 'walls: voxels' "$(stated 'mean solid fraction')" \
  "$(stated 'solid fraction')" 1e-11
check 'walls: all cells beyond them' awk '
  {i = (NR - 1) % 12; j = int((NR - 1) / 12) % 12; k = int((NR - 1) / 144)
   if (i == 0 || i == 11 || j == 0 || j == 11 || k == 0) {n++
     d = $1 - 1; if (!(d < 1e-12 && -d < 1e-12)) bad = 1}}
  END {exit bad || NR != 1584 || n != 584}' <(od -An -v -w8 -tf8 "$T/raw")
hand --format raw --binary --cells 12 --walls --thickness 0.5 "$T/bed" >"$T/raw"
check 'walls: as thick as wanted' grep -q 'box -0.5,1.5,-0.5,1.5,-0.5,1 ' \
  "$T/said"
hand --format palabos --cells 4,5,6 --walls "$T/wide" | tr ' ' '\n' |
  tr -d '\n' >"$T/text"
hand --format raw --binary --cells 4,5,6 --walls "$T/wide" >"$T/raw"
check 'walls: palabos turns them, too' [ "$(od -An -v -w1 -tu1 "$T/raw" | awk '
  {v[NR - 1] = $1} END {for (i = 0; i < 4; i++) for (j = 0; j < 5; j++)
    for (k = 0; k < 6; k++) printf "%d", v[i + 4 * (j + 5 * k)]}')" = \
  "$(cat "$T/text")" ]
# a tube in the place of the side walls, and one that leans with an end across,
# of a few spheres on the floor
unsealed "$T/bed" | awk '/^[0-9]/ && ++n > 25 {next} {print}' >"$T/small"
sed '/^# wall=/d; s/^# model=.*/&\n# wall=0 0 0 0 0 -1\n# cylinder=0.5 0.5 7 0 0 1 0.5/' \
  "$T/small" >"$T/tube"
sed '/^# wall=/d; s/^# model=.*/&\n# cylinder=0.5 0.5 0 0.6 0 0.8 0.4\n# wall=0.5 0.5 0.1 -0.6 0 -0.8/' \
  "$T/small" >"$T/lean"
hand --format raw --cells 40 --walls "$T/tube" >"$T/raw"
check 'tube: the box is around it' grep -q \
  'of the box -0.1,1.1,-0.1,1.1,-0.1,0.7' "$T/said"
high=$(sed -n 's/.*of the box -0.1,1.1,-0.1,1.1,-0.1,\([0-9.]*\) .*/\1/p' "$T/said")
near 'tube: it is as high as the square in it is wide' "$high" 0.70710678118654757 1e-15
near 'tube: the share of the walls' "$(stated 'walls')" "$(awk -v h="$high" \
  'BEGIN {printf "%.17g", 1 - atan2(0, -1) / 4 * h / (1.44 * (h + 0.1))}')" 1e-11
near 'tube: voxels' "$(stated 'mean solid fraction')" \
  "$(stated 'solid fraction')" 2e-5
# between two shells, the spheres of the inner and what profile has between
between=$("$B/analyze" profile --cylinder 0.5,0.5,0.5 --from-wall 0.1 \
  --points 200 --box "0,1,0,1,0,$high" "$T/tube" 2>"$T/err" | awk -F '\t' '
  NR > 1 {a = 0.5 - $2; sum += $4 * 2 * atan2(0, -1) * a * 0.1}
  END {print sum / (NR - 1)}')
outer=$(sed -n 's/.*; \([0-9.]*\) of the rest.*/\1/p' "$T/said")
sed 's/^# cylinder=.*/# cylinder=0.5 0.5 7 0 0 1 0.4/' "$T/tube" >"$T/thin"
hand --format raw --cells 2 --walls --box "0,1,0,1,0,$high" "$T/thin" >"$T/raw"
inner=$(sed -n 's/.*; \([0-9.]*\) of the rest.*/\1/p' "$T/said")
near 'tube: what is between two of them' "$(awk -v o="$outer" -v i="$inner" \
  'BEGIN {printf "%.17g", atan2(0, -1) * (o * 0.25 - i * 0.16)}')" "$between" 2e-5
for keep in tube lean; do
  hand --format raw --binary --cells 7,6,5 --walls "$T/$keep" >"$T/raw"
  hand --format palabos --cells 7,6,5 --walls "$T/$keep" >"$T/text"
  check "$keep: palabos turns it" cmp -s <(od -An -v -w1 -tu1 "$T/raw" | awk '
    {v[NR - 1] = $1} END {for (i = 0; i < 7; i++) for (j = 0; j < 6; j++)
      for (k = 0; k < 5; k++) print v[i + 7 * (j + 6 * k)]}') \
    <(tr ' ' '\n' <"$T/text")
  hand --format stl --merged --cells 60 --walls "$T/$keep" >"$T/stl"
  check "$keep: merged within the bound" awk -v d="$(stated 'that is')" \
    -v b="$(stated '(step\/r)^2\/3 =')" \
    'BEGIN {exit !(b > 0 && b < 0.04 && d < b && -d < b)}'
  hand --format geo --walls --scale 2 --offset 1,0,0 "$T/$keep" >"$T/geo"
  solid=$(stated 'solid fraction')
  hand --format geo --walls "$T/$keep" >"$T/geo"
  near "$keep: in other units" "$solid" "$(stated 'solid fraction')" 1e-9
  check "$keep: geo has its walls" grep -q 'Physical Surface("walls")' "$T/geo"
  check "$keep: openfoam" hand --format openfoam --walls --output "$T/foam" \
    "$T/$keep"
  check "$keep: openfoam has the tube" grep -q searchableCylinder \
    "$T/foam/system/snappyHexMeshDict"
  refuse "$keep: as bodies" 3 'expected --merged' --format stl --walls "$T/$keep"
done
check 'lean: geo cuts the tube off' grep -q 'Volume{inside()}' "$T/geo"
check 'lean: openfoam, too' grep -q 'type searchablePlane' \
  "$T/foam/system/snappyHexMeshDict"
sed 's/^# cylinder=.*/&\n&/' "$T/tube" >"$T/tubes"
refuse 'two tubes' 3 'several cylinders' --format raw --walls "$T/tubes"
refuse 'a box within the tube' 3 'none is within --box' --format raw --walls \
  --box 0.4,0.6,0.4,0.6,0.1,0.3 "$T/tube"
refuse 'no walls' 3 '--walls: the header has none' --format raw --walls \
  "$T/two.csv"
refuse 'walls beyond the box' 3 '--walls: none is within --box' --format raw \
  --walls --box 0.1,0.9,0.1,0.9,0.1,0.9 "$T/bed"
refuse 'thickness alone' 2 '--thickness: expected --walls' --format raw \
  --thickness 0.1 "$T/bed"
refuse 'thickness of a box' 2 '--thickness: expected --walls and no --box' \
  --format raw --walls --box 0,1,0,1,0,1 --thickness 0.1 "$T/bed"
refuse 'reach alone' 2 '--reach: expected --bridge' --format raw --reach 0.01 \
  "$T/bed"

# --- gmsh --------------------------------------------------------------------
geo() { # FILE: its spheres as a table
  echo x,y,z,r
  sed -n 's/^Sphere([0-9]*) = {\(.*\)};$/\1/p' "$1" | tr -d ' '
}
hand --format geo --scale 2 --offset 1,0,0 "$T/geometry" >"$T/geo"
geo "$T/geo" >"$T/geo.csv"
near 'geo: its spheres are the solid' "$(union --box 1,3,0,2,0,2 "$T/geo.csv")" \
  "$(stated 'solid fraction')" 1e-12
check 'geo: its box' grep -q '^Box(1) = {1, 0, 0, 2, 2, 2};$' "$T/geo"
check 'geo: numbers from 2 on' awk -F '[()]' '/^Sphere/ {if ($2 != ++n + 1)
  bad = 1} /Volume{2:/ {split($0, f, /2:|}/); if (index($0, "2:" n + 1 "}") == 0)
  bad = 1} END {exit bad || n < 100}' "$T/geo"
check 'geo: seven named surfaces and the pore' [ "$(grep -c '^ *Physical' \
  "$T/geo")" = 8 ]
hand --format geo --bridge 0.03 "$T/touching" >"$T/geo"
check 'geo: bridges' [ "$(grep -c '^Cylinder' "$T/geo")" -gt 300 ]
hand --format geo "$T/pair.csv" >"$T/geo"
check 'geo: no word of spheres apart' [ "$(grep -c touch "$T/said")" = 0 ]
# acos(0.1/0.2)
printf 'x,y,z,r\n.9,.5,.5,.2\n.25,.5,.5,.2\n' >"$T/ends.csv"
hand --format geo "$T/ends.csv" >"$T/geo"
check 'geo: the wedge at a face' grep -q \
  'cut 1 spheres, at 60 degrees and more; the narrowest gap to others is 0.05$' \
  "$T/said"
awk '/^[0-9]/ {if (n++) next; $2 = 0.7; $3 = 0.5; $4 = 0.3; $5 = 0.4} {print}' \
  FS='\t' OFS='\t' <(unsealed "$T/tube") >"$T/ends"
# at 0.2 of the axis of a tube of 0.5: cos = (0.25 + 0.16 - 0.04)/0.4
hand --format geo --walls "$T/ends" >"$T/geo"
check 'geo: the wedge at a tube' grep -q 'cut 1 spheres, at 22 degrees' "$T/said"
printf 'x,y,z,r\n.3,.5,.5,.2\n.7,.5,.5,.2\n' >"$T/pair.csv"
hand --format geo "$T/pair.csv" >"$T/geo"
check 'geo: spheres that just touch' grep -q '1 pair of spheres touch' "$T/said"
refuse 'geo: beads too small for its tolerance' 3 'tolerance of 1e-07: --scale' \
  --format geo --scale 0.0001 "$T/bed"
hand --format geo --walls "$T/bed" >"$T/geo"
check 'geo: the box ends at the walls' grep -q '^Box(1) = {0, 0, 0, 1, 1, 1};$' \
  "$T/geo"

# --- OpenFOAM ----------------------------------------------------------------
check 'openfoam' hand --format openfoam --output "$T/foam" --scale 0.5 \
  --offset 1,0,0 --bridge 0.02 "$T/geometry"
check 'openfoam: its files' [ "$(cd "$T/foam" && find . -type f | sort |
  tr '\n' ' ')" = './constant/triSurface/spheres.stl ./system/blockMeshDict ./system/controlDict ./system/fvSchemes ./system/fvSolution ./system/snappyHexMeshDict ' ]
hand --format stl --equal-volume --scale 0.5 --offset 1,0,0 --bridge 0.02 \
  "$T/geometry" >"$T/stl"
check 'openfoam: the surface' cmp -s "$T/stl" \
  "$T/foam/constant/triSurface/spheres.stl"
check 'openfoam: the block' [ "$(sed -n '/^vertices/,/^edges/p' \
  "$T/foam/system/blockMeshDict" | tr -d '\n')" = 'vertices(    (1 0 0)    (1.5 0 0)    (1.5 0.5 0)    (1 0.5 0)    (1 0 0.5)    (1.5 0 0.5)    (1.5 0.5 0.5)    (1 0.5 0.5));blocks(    hex (0 1 2 3 4 5 6 7) (40 40 40) simpleGrading (1 1 1));edges ();' ]
hand --format openfoam --box 0,1,0,0.5,0,0.25 --cells 16 --output "$T/cubes" \
  "$T/geometry"
check 'openfoam: its cells are cubes' grep -qF '(16 8 4) simpleGrading' \
  "$T/cubes/system/blockMeshDict"
hand --format csv --scale 0.5 --offset 1,0,0 "$T/geometry" >"$T/m"
check 'openfoam: a point in the pore' awk -F , -v p="$(sed -n \
  's/^ *locationInMesh (\(.*\));/\1/p' "$T/foam/system/snappyHexMeshDict")" '
  BEGIN {if (split(p, x, " ") != 3 || x[1] <= 1 || x[1] >= 1.5) exit 1
    least = 1
    for (k = 2; k <= 3; k++) if (x[k] <= 0 || x[k] >= 0.5) exit 1}
  FNR > 1 {d = -$6; s = 0; for (k = 1; k <= 3; k++) s += (x[k] - $(k + 2)) ^ 2
    d += sqrt(s); if (d < least) least = d}
  END {exit !(least > 0.01)}' "$T/m"
printf 'x,y,z,r\n.5,.5,.5,2\n' >"$T/full.csv"
refuse 'openfoam: no pore' 3 'no point of the box is in the pore' \
  --format openfoam --output "$T/none3" "$T/full.csv"
check 'openfoam: a refusal leaves no folder' [ ! -e "$T/none3" ]
refuse 'openfoam: three numbers of cells' 2 '--cells: expected N, along' \
  --format openfoam --output "$T/none3" --cells 4,4,4 "$T/bed"

# --- surfaces ----------------------------------------------------------------
for keep in bed geometry touching; do
  hand --format stl --merged --cells 60 "$T/$keep" >"$T/stl"
  near "merged $keep: the volume is as stated" "$(stated 'volume')" \
    "$(stated 'of the exact')" 0.02
  check "merged $keep: within the bound" awk -v d="$(stated 'that is')" \
    -v b="$(stated '(step\/r)^2\/3 =')" \
    'BEGIN {exit !(b > 0 && b < 0.04 && d < b && -d < b)}'
done
printf 'x,y,z,r\n0,0,0,0.1\n' >"$T/one.csv" # steps of 0.2/40 m
hand --format stl --merged --cells 40 "$T/one.csv" >"$T/stl"
near 'merged: the bound' "$(stated '(step\/r)^2\/3 =')" \
  "$(awk 'BEGIN {print (0.2 / 40 / 0.1) ^ 2 / 3}')" 1e-5
refuse 'merged: facets' 2 '--merged: expected --cells' --format stl --merged \
  --facets 80 "$T/bed"
refuse 'cells of bodies' 2 '--cells: expected --merged' --format stl --cells 9 \
  "$T/bed"
refuse 'merged: too fine for its numbers' 3 'too small for single precision' \
  --format stl --merged --offset 10000,0,0 "$T/bed"
refuse 'merged: nothing' 3 'no spheres' --format stl --merged \
  --radius 0.1 <(printf 'ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z\n')
printf 'x,y,z,r\n1e6,1e6,1e6,0.01\n' >"$T/far.csv"
hand --format stl "$T/far.csv" >"$T/stl"
check 'facets too small for their place' grep -q 'single precision' "$T/said"

check_done
