#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Single values of what analyze hands on and settle begins with, each against what a
# scene of a few spheres has by hand. Run from the root of the repository; B is the
# directory of the programs.
. tests/harness.sh
. tests/faults.sh

hand() { # FORMAT FILE OPTION...: what is said goes to $T/said
  timeout 60 "$B/analyze" export --format "$1" "${@:3}" "$2" </dev/null \
    2>"$T/said"
}

# --- LAMMPS: obstacles are of type 2, what moves of type 1
printf 'id\tx\ty\tz\tr\tfixed\n3\t.2\t.5\t.5\t.1\t0\n4\t.7\t.5\t.5\t.1\t1\n' \
  >"$T/obstacle"
hand lammps-data "$T/obstacle" >"$T/data"
check 'lammps-data: types' test "$(awk '
  $2 " " $3 == "atom types" {types = $1}
  /^Atoms/ {on = 1; next} /^Velocities/ {on = 0}
  on && NF {row = row " " $1 ":" $2}
  END {print types row}' "$T/data")" = '2 3:1 4:2'

# --- gmsh: a box around each sphere, with 1/1000 of the least radius to spare
{
  printf '# format=bed-1\n# t=0\n# wall=0 0 0 0 0 -1\n'
  printf '# cylinder=0.5 0.5 0 0 0 1 1\nx\ty\tz\tr\n'
  printf '.25\t.3\t.35\t.2\n.6\t.65\t.7\t.125\n# status=ok\n'
} >"$T/two"
hand geo "$T/two" --walls >"$T/geo"
check 'geo: boxes of spheres' awk '
  {x[1] = 0.25; x[2] = 0.3; x[3] = 0.35; r = 0.2}
  /^part\(\)/ {
    if (n++) {x[1] = 0.6; x[2] = 0.65; x[3] = 0.7; r = 0.125}
    gsub(/^[^{]*[{]|[}].*/, ""); split($0, c, /, */)
    for (k = 1; k <= 3; k++) {
      d = c[k] - (x[k] - r - 1.25e-4); e = c[k + 3] - (x[k] + r + 1.25e-4)
      if (d * d > 1e-20 || e * e > 1e-20) bad = 1
    }
  }
  END {exit bad || n != 2}' "$T/geo"
check 'geo: no sphere is cut' grep -q 'walls and faces cut no sphere' "$T/said"

check 'geo: the volume of both' grep -q ': 2 spheres, solid fraction 0\.[0-9]* of' \
  "$T/said"
check 'geo: both are cut out' grep -q '^pore() = .*Volume{2:3}' "$T/geo"
timeout 60 "$B/analyze" export --format geo --box 2,3,2,3,2,3 "$T/two" >"$T/geo" \
  2>"$T/said"
check 'geo: a box without spheres is all pore' grep -qx 'pore() = {inside()};' \
  "$T/geo"
{
  sed '/^x/q' "$T/two"
  printf '.375\t.375\t.5\t.125\n.375\t.625\t.5\t.125\n# status=ok\n'
} >"$T/touch"
hand geo "$T/touch" --walls --bridge 0.0625 >"$T/geo"
check 'geo: the box of a bridge, from centre to centre' awk '
  /^part\(\)/ {
    gsub(/^[^{]*[{]|[}].*/, ""); split($0, c, /, */)
    split("0.3125 0.3125 0.4375 0.4375 0.6875 0.5625", want, " ")
    for (k = 1; k <= 6; k++) {
      d[k] = c[k] - want[k] - (k < 4 ? -1.25e-4 : 1.25e-4)
      off += d[k] * d[k] # of the last one, the bridge
    }
    last = off; off = 0; n++
  }
  END {exit !(n == 3 && last < 1e-20)}' "$T/geo"

# --- STL: what its head says, and copies across periodic sides
{
  printf '# format=bed-1\n# t=0\n# base=1,1\n# periodic=xy\nx\ty\tz\tr\n'
  printf '.05\t.5\t.5\t.1\n# status=ok\n'
} >"$T/across"
hand stl "$T/across" --facets 20 >"$T/stl"
check 'stl: the sphere and its copy' test "$(wc -c <"$T/stl")" = \
  $((84 + 2 * 20 * 50))
check 'stl: its head' grep -aq '20 facets each, 0\.[0-9]* of a ball' "$T/stl"

printf '# t=0\nx\ty\tz\tr\n0\t0\t0\t10\n11\t0\t0\t.5\n# status=ok\n' >"$T/unequal"
refused 3 'at places of 12; fewer cells' "$B/analyze" export --format stl --merged \
  --cells 40000 --box=-10,11.5,-0.01,0.01,-0.01,0.01 "$T/unequal"

# --- the solver of freezing: twice as high as it is wide, and the widest profile
# that changes the fraction by at most 0.01
awk 'BEGIN {
  print "# format=bed-1\n# t=0\nx\ty\tz\tr"
  for (i = 0; i < 512; i++)
    printf "%g\t%g\t%g\t%g\n", (i % 8 + 0.5) / 8, (int(i / 8) % 8 + 0.5) / 8,
      (int(i / 64) + 0.5) / 8, 0.03
  print "# status=ok"}' >"$T/small"
for bed in one small; do
  [[ $bed == small ]] ||
    printf '# t=0\nx\ty\tz\tr\n.5\t.5\t.5\t.25\n# status=ok\n' >"$T/one"
  hand freezethaw "$T/$bed" --output "$T/freeze-$bed"
  check "freezethaw, $bed: the domain and the profile" awk '
    $2 == "xi_gl" {
      split($3, w, "/"); c = $5 < 0 ? -$5 : $5
      if (c <= 0.01) wide = w[2]
      if (!most || c > most) most = c
    }
    $1 ~ /^L[123]$/ {side[$1] = $2}
    $1 == "xi_gl" {given = $2}
    END {
      d = side["L3"] - 2 * side["L1"]
      exit !(side["L1"] > 0 && d * d < 1e-20 && given == "L3/" wide)
    }' "$T/freeze-$bed/Params"
done
check 'freezethaw: one as wide as may be and one that is not' test "$(cat \
  "$T"/freeze-{one,small}/Params | sed -n 's/^xi_gl *//p' | tr '\n' ' ')" = \
  'L3/300 L3/1000 '

# --- OpenFOAM: cubes, so many along the longest side
hand openfoam "$T/one" --box 0,1,0,2,0,4 --cells 8 --output "$T/block"
check 'openfoam: cubes' grep -q '^ *hex (0 1 2 3 4 5 6 7) (2 4 8) ' \
  "$T/block/system/blockMeshDict"

# --- OpenFOAM: the axis of a leaning tube and the normal of the wall across it
{
  printf '# format=bed-1\n# t=0\n# cylinder=0.5 0.5 0 0.6 0 0.8 0.4\n'
  printf '# wall=0.5 0.5 0.1 -0.6 0 -0.8\n'
  printf 'x\ty\tz\tr\n0.7\t0.5\t0.4\t0.1\n# status=ok\n'
} >"$T/lean"
hand openfoam "$T/lean" --walls --cells 8 --output "$T/foam"
check 'openfoam: the tube and the wall' awk '
  function is(d, want) {d -= want; return d * d < 1e-20}
  {gsub(/[();]/, "")}
  $1 == "point1" {for (k = 2; k <= 4; k++) p[k] = $k}
  $1 == "point2" {
    for (k = 2; k <= 4; k++) {d[k] = $k - p[k]; dd += d[k] * d[k]}
    l = sqrt(dd); tube = is(d[2] / l, 0.6) && is(d[3], 0) && is(d[4] / l, 0.8)
  }
  $1 == "normal" && NF == 4 && is($3, 0) && $4 < -0.1 {
    wall = is($2 / $4, 0.75)
  }
  END {exit !(tube && wall)}' "$T/foam/system/snappyHexMeshDict"

# --- slabs: the last is what is left, here too thin beside a sphere
timeout 60 "$B/analyze" fraction --box 0,1,0,1,0,0.500000000000001 --slab 0.25 \
  "$T/two" >"$T/out" 2>"$T/err"
check 'fraction: as good as two slabs' test $? = 0
refused 3 'a box too small' "$B/analyze" fraction \
  --box 0,1e-4,0,1e-4,0,0.50000001 --slab 0.25 "$T/two"

# --- profiles begin at the box's lower side
timeout 60 "$B/analyze" profile --box 0,1,0,1,1,2 --points 2 "$T/two" >"$T/out" \
  2>"$T/err"
check 'profile: heights' test "$(awk '/^[0-9]/ {print $2}' "$T/out" |
  tr '\n' ' ')" = '1.25 1.75 '

# --- LAMMPS: a step for the lightest sphere, 2.5e-5 s times the root of its mass
{
  printf '# format=bed-1\n# t=0\n# wall=0 0 0 0 0 -1\nid\tx\ty\tz\tr\tm\n'
  printf '2000\t.3\t.3\t.3\t.1\t4\n2001\t.7\t.7\t.7\t.1\t.25\n# status=ok\n'
} >"$T/masses"
"$B/settle" --quiet --scene "$T/masses" --model basic --f0 10 --time 1 \
  --export-lammps "$T/lammps" >"$T/out" 2>"$T/err"
check 'lammps: numbers from 1 on' test "$(awk '/^Atoms/ {on = 1; next}
  /^Velocities/ {on = 0} on && NF {printf "%s ", $1}' "$T/lammps/bed.data")" = '1 2 '
check 'lammps: the step' grep -qx 'timestep 1.25e-05' "$T/lammps/in.scene"

# --- what is read: nan begins a sphere, and an empty file is one, wherever it stands
printf '# format=bed-1\nx\ty\tz\tr\nnan\t0\t0\t1\n' >"$T/nan"
refused 3 "nan:3: column x is 'nan'" "$B/analyze" fraction "$T/nan"
: >"$T/empty"
printf 'ITEM: %s\n' $'TIMESTEP\n0' $'NUMBER OF ATOMS\n0' \
  $'BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1' 'ATOMS id x y z radius' >"$T/nobody"
for none in empty nobody; do
  "$B/analyze" contacts "$T/two" "$T/$none" >"$T/out" 2>"$T/err"
  check "$none behind a bed: status" test $? = 3
  check "$none behind a bed" grep -Eq \
    "$none:(0: nothing is in| no frame has spheres)" "$T/err"
done
check 'a profile of no spheres is empty' test \
  "$("$B/analyze" profile --points 2 --box 0,1,0,1,0,2 "$T/nobody" |
    awk -F '\t' 'NR > 1 {n++; sum += $3 + $4} END {print n, sum + 0}')" = '2 0'

# --- a tolerance that is finer than softness lets see is noted, with steps of its own
for option in '--tol 1e-5' '--step 1e-3'; do
  "$B/settle" --count 60 --time 0 $option >"$T/out" 2>"$T/err"
  check "settle $option" test "$(grep -c 'finer than softness' "$T/err")" = \
    "$([[ $option == --tol* ]] && echo 1 || echo 0)"
done

# --- the method that a setting asks for, and what help says of it
"$B/settle" --help >"$T/help"
check 'settle --help: the usual method' grep -q -e \
  '--method NAME .*\[multirate; rkc with' "$T/help"
check 'settle: the usual method' grep -qx '# method=multirate' \
  <("$B/settle" --quiet --count 1 --time 0)
check 'settle --step: rkc' grep -qx '# method=rkc' \
  <("$B/settle" --quiet --count 1 --time 0 --step 1e-3)

# --- pictures: what gnuplot is given, by one that keeps it and draws nothing
long=$T/$(printf '%0200d' 1)
mkdir "$T/bin" "$long"
cp "$T/two" "$long/bed"
cat >"$T/bin/gnuplot" <<'end'
#!/bin/bash
case ${*: -1} in
  *.png) cp "${@: -2:1}" "$SHOWN"; printf '\x89PNG\r\n\x1a\n0000IHDR' ;;
  *.gif) printf 'GIF89a0000\00000;' ;;
esac >"${@: -1}"
end
chmod +x "$T/bin/gnuplot"
PATH=$T/bin:$PATH SHOWN=$T/shown "$B/analyze" draw --quiet --output "$T/x.png" \
  "$T/two" 2>"$T/err"
check 'draw: exit status' test $? = 0
check 'draw: each sphere where it is' cmp -s <(sed 1,2d "$T/shown" | cut -f 1-4) \
  <(printf '0.25\t0.3\t0.35\t0.2\n0.6\t0.65\t0.7\t0.125\n')
PATH=$T/bin:$PATH SHOWN=$T/shown "$B/analyze" movie --quiet "$long/bed" \
  >"$T/x.gif" 2>"$T/err"
check 'movie: exit status' test $? = 0
check 'movie: the text in parts of at most 255 letters' awk '
  {for (k = 1; k <= NF; k++) byte[n++] = $k}
  END {
    if (byte[13] != 33 || byte[14] != 254) exit 1
    for (at = 15; byte[at] > 0; at += byte[at] + 1) {
      parts++
      for (k = 1; k <= byte[at]; k++) text = text sprintf("%c", byte[at + k])
    }
    exit !(parts > 1 && text ~ /^program=analyze\nversion=/ &&
      text ~ /\ncommand=analyze movie .*01\/bed\n/ && byte[at + 1] == 59)
  }' <(od -An -v -tu1 "$T/x.gif")

# What is left when all pictures are drawn is one part of all
if command -v script >/dev/null; then
  cat >"$T/bin/gnuplot-in-time" <<end
#!/bin/bash
[[ \${*: -1} != *.gif ]] || for ((k = 0; k < 500; k++)); do
  grep -q '%' "$T/terminal" && break
  sleep 0.02
done
exec "$T/bin/gnuplot" "\$@"
end
  mkdir "$T/slow"
  mv "$T/bin/gnuplot-in-time" "$T/slow/gnuplot"
  chmod +x "$T/slow/gnuplot"
  PATH=$T/slow:$PATH SHOWN=$T/shown script -qfec \
    "'$B/analyze' movie --output '$T/y.gif' '$T/two'" "$T/terminal" >"$T/out" </dev/null
  check 'movie: half is done, of one picture and the film' test \
    "$(grep -oE '[0-9]+ %' "$T/terminal" | sort -u)" = '50 %'
else
  echo 'skipped: the share of a film that is done (script is not installed)'
fi

# A gnuplot that is done is not ended, whose number another process may have by
# then; one that is not is.
if make_faults; then
  # the data, the picture and the film, once each
  for k in 3 4; do
    PATH=$T/bin:$PATH SHOWN=$T/shown FAULT=unlink:$k FAULT_DONE=$T/unlinked-$k \
      LD_PRELOAD="$T/faults.so" "$B/analyze" movie --quiet "$T/two" >"$T/y.gif" \
      2>"$T/err"
  done
  check 'movie: three files of its own' test -e "$T/unlinked-3" -a ! -e \
    "$T/unlinked-4"
  printf '#!/bin/sh\nkill -s INT $PPID\nsleep 0.3\n' >"$T/bin/gnuplot-that-waits"
  chmod +x "$T/bin/gnuplot-that-waits"
  for ends in no yes; do
    [[ $ends == no ]] || mv "$T/bin/gnuplot-that-waits" "$T/bin/gnuplot"
    PATH=$T/bin:$PATH SHOWN=$T/shown FAULT=kill:1 FAULT_DONE=$T/killed \
      env --default-signal LD_PRELOAD="$T/faults.so" \
      "$B/analyze" draw --quiet --output "$T/x.png" "$T/two" 2>"$T/err"
    check "gnuplot is ended: $ends" test \
      "$([[ -e $T/killed ]] && echo yes || echo no)" = $ends
  done
fi

# --- LAMMPS: three sides
hand lammps "$T/two" >"$T/dump"
check 'lammps: the sides' grep -qx 'ITEM: BOX BOUNDS ff ff ff' "$T/dump"

# --- names of files with numbers of at most 19 digits
refused 2 'expected one %d or %04d' "$B/analyze" export --format positions \
  --frames all --output "$T/a%020d" "$T/two"
hand positions "$T/two" --frames all --output "$T/a%019d"
check 'names: 19 digits' test -s "$T/a0000000000000000000"

# --- manual pages end, and have all that the help has
timeout 20 "$B/analyze" order --man | tr -d '\\' >"$T/man"
check 'a manual page ends' test "${PIPESTATUS[0]}" = 0
check 'a manual page: each line of the summary' test "$("$B/analyze" order --help |
  sed -n '2,/^$/{s/^ *//;/./p}' | while read -r line; do
    grep -qF -- "${line:0:30}" "$T/man" || echo "$line"; done)" = ''

# --- a checkpoint that a killed run has begun is in nobody's way
printf 'half of one' >"$T/check.partial"
"$B/settle" --quiet --count 2 --time 0.01 --output "$T/bed" \
  --checkpoint "$T/check" --every 0 2>"$T/err"
check 'a partial checkpoint: exit status' test $? = 0
check 'a partial checkpoint: made anew' test "$(head -n 1 "$T/check")" = \
  '# format=settle-checkpoint-1' -a ! -e "$T/check.partial"

# --- settle: which sides have walls, and the load on the floor of a tube
check 'periodic x: no walls across x' test "$("$B/settle" --quiet --periodic x \
  --count 1 --time 0 | grep -c '^# wall=.* [-+]*1 0 0$')" = 0
check 'periodic x: walls across y' test "$("$B/settle" --quiet --periodic x \
  --count 1 --time 0 | grep -c '^# wall=.* 0 [-+]*1 0$')" = 2
"$B/settle" --quiet --count 1 --overlap 0.01 --cylinder 0,0,0,0,0,1,1 --time 0 \
  >"$T/bed" 2>"$T/err"
check 'an upright tube has a base' test $? = 0
refused 2 'a cylinder that leans' "$B/settle" --count 1 --overlap 0.01 \
  --cylinder 0,0,0,0.6,0,0.8,1 --time 0

# --- rest: what contacts store counts. A sphere begins deep in the floor, springs
# up and has lost all that within 1 s: it rests when that is 5 s ago, not before
{
  printf '# format=bed-1\n# t=0\n# wall=0 0 0 0 0 -1\nid\tx\ty\tz\tr\tm\n'
  printf '0\t0\t0\t.08\t.1\t1\n# status=ok\n'
} >"$T/deep"
"$B/settle" --quiet --scene "$T/deep" --time 20 --until-rest --stats "$T/stats" \
  >"$T/out" 2>"$T/err"
within 'the end' "$(sed -n 's/^t_end\t//p' "$T/stats")" 5.3 7

# --- settle: a tube that is wider than a sphere and narrower than a place
"$B/settle" --quiet --count 3 --cylinder 0,0,0,0,0,1,0.115 --jitter 0 --time 0 \
  >"$T/narrow" 2>"$T/err"
check 'a narrow tube: one above the other on its axis' test "$(awk '
  /^[0-9]/ && $2 == 0 && $3 == 0 && $4 > z + 0.2 {n++; z = $4}
  END {print n}' "$T/narrow")" = 3

check_done
