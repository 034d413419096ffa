#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Pictures and animations of beds: what is on them, where the scripts are found,
# and what is said when something is missing. Run from the root of the
# repository; B is the directory of the programs.
. tests/harness.sh

image() { # FILE: a PNG without the text that says what made it
  local length
  length=$((16#$(od -An -tx1 -j 33 -N 4 "$1" | tr -d ' \n')))
  head -c 33 "$1"
  tail -c +$((34 + 12 + length)) "$1"
}
export TMPDIR=$T/scratch
unset DEM_PLOTS
mkdir "$TMPDIR"

# with the variable "environment", if it is set
refuse() { # NAME STATUS PATTERN ARGUMENT...: one line, no picture
  local name=$1 want=$2 pattern=$3
  timeout 60 env ${environment:-} "$B/analyze" "${@:4}" >"$T/out" \
    2>"$T/err" </dev/null
  local status=$?
  check "$name: exit status $status" test $status = "$want"
  check "$name: $(head -n 3 "$T/err")" test "$(wc -l <"$T/err")" = 1 -a \
    "$(grep -Ec "^analyze: $pattern" "$T/err")" = 1 -a ! -s "$T/out"
}

first() { # COUNT FILE: its first bytes
  head -c "$1" "$2" | od -An -c | tr -d ' \n'
}

# --- without anything to draw with --------------------------------------------
bed() { # ROWS: in the unit cube
  printf '# format=bed-1\n# t=0\n'
  printf '# wall=%s\n' '0 0 0 -1 0 0' '1 0 0 1 0 0' '0 0 0 0 -1 0' \
    '0 1 0 0 1 0' '0 0 0 0 0 -1' '0 0 1 0 0 1'
  printf 'id\tx\ty\tz\tr\n'"$1"'# status=ok\n'
}
bed '0\t0.5\t0.5\t0.5\t0.4\n' >"$T/one"
"$B/settle" --count 120 --base 0.7,0.7 --model basic --time 0.4 --frames 3 \
  >"$T/bed"
refuse 'an unknown ending' 2 '--output .*x.jpg: expected .*.png or .svg' \
  draw --output "$T/x.jpg" "$T/one"
refuse 'an unknown ending' 2 '--output .*x.avi: expected .*.gif, .mp4' \
  movie --output "$T/x.avi" "$T/one"
refuse 'no such frame' 3 '--frame 3: there are frames 0 to 2' \
  draw --frame 3 --output "$T/x.png" "$T/bed"
refuse 'half a frame' 2 '--frame 0.5: expected a whole number' \
  draw --frame 0.5 --output "$T/x.png" "$T/bed"
refuse 'from below' 2 '--view: expected' draw --view 30,95 --output "$T/x.png" \
  "$T/bed"
refuse 'no such color' 2 '--color mud: expected one of height' \
  draw --color mud --output "$T/x.png" "$T/bed"
refuse 'no such directory' 1 "$T/none/x.png: No such" \
  draw --output "$T/none/x.png" "$T/one"
head -n 60 "$T/bed" >"$T/cut"
refuse 'a bed cut short' 3 "$T/cut:[0-9]*: .*cut short" \
  draw --output "$T/x.png" "$T/cut"
mkdir "$T/nothing"
environment=PATH=$T/nothing refuse 'no gnuplot' 1 'gnuplot: not found.*gnuplot-nox' \
  draw --output "$T/x.png" "$T/one"
environment=PATH=$T/nothing refuse 'no ffmpeg' 1 'ffmpeg: not found' \
  movie --output "$T/x.mp4" "$T/one"
check 'no picture came of that' test -z "$(ls "$T" | grep '^x')"
check 'nothing is left in scratch' test -z "$(ls "$TMPDIR")"

if ! command -v gnuplot >/dev/null; then
  echo 'skipped: pictures (gnuplot is not installed)'
  check_done
  exit
fi

# --- pictures -----------------------------------------------------------------
pixels() { # PNG: x, y and rgb of every other pixel both ways, by gnuplot
  gnuplot -e "set table '$T/table'; plot '$1' binary filetype=png \
    every 2:2 with rgbimage" 2>/dev/null
  awk '/^ *[0-9]/ {print $1, $2, $3, $4, $5}' "$T/table"
}
# One ball of radius 0.4 in the unit cube, seen from turn 30 and tilt 72: the
# picture's scale is what fits, its disc's area follows. The rim may be off by a
# pixel, and three edges of the box, two pixels wide, may cross it.
"$B/analyze" draw --output "$T/one.png" "$T/one"
check 'a PNG' test "$(first 4 "$T/one.png")" = '211PNG'
pixels "$T/one.png" | awk '
  $1 < 0.79 * 1280 {
    low = $3 < $4 ? $3 : $4; low = low < $5 ? low : $5
    high = $3 > $4 ? $3 : $4; high = high > $5 ? high : $5
    if (high - low > 20) {n++; x += $1; y += $2}}
  END {
    pi = 4 * atan2(1, 1); turn = pi / 6; tilt = 72 * pi / 180
    wide = cos(turn) + sin(turn) + 0.06
    tall = cos(tilt) * wide - 0.06 * cos(tilt) + sin(tilt) + 0.06
    scale = 0.78 * 1280 / wide
    if (0.89 * 960 / tall < scale) scale = 0.89 * 960 / tall
    scale /= 2
    r = 0.4 * scale; want = pi * r * r; d = n - want
    tol = 2 * pi * r + 3 * 2 * r
    if (!(d < tol && -d < tol)) bad = 1
    dx = x / n - 0.41 * 1280; dy = y / n - (0.04 + 0.93) / 2 * 960
    if (!(dx * dx + dy * dy < 9)) bad = 1
    if (bad) print n, want, tol, dx, dy > "/dev/stderr"
    exit bad || !n}'
check 'one ball: its area and place' test $? = 0
"$B/analyze" draw "$T/one" >"$T/piped.png"
check 'a picture to standard output' cmp -s <(image "$T/one.png") \
  <(image "$T/piped.png")

# Seen from turn 30 and tilt 72: a ball before the large one, one that looks out
# from behind it, and two that do not; from the other side the last is hidden.
mkdir "$T/copy"
echo 'system("cp ".ARG1." ".ARG2)' >"$T/copy/bed.gp"
awk 'BEGIN {pi = 4 * atan2(1, 1); turn = pi / 6; tilt = 72 * pi / 180
  cx = sin(tilt) * sin(turn); cy = -sin(tilt) * cos(turn); cz = cos(tilt)
  ax = cos(turn); ay = sin(turn)
  print "id,x,y,z,r"
  n = split("0 0 .4  0 -.5 .3  0 .45 .05  .2 -.5 .25  .1 -.5 .25", k, " ")
  for (i = 1; i < n; i += 3)
    printf "%d,%.17g,%.17g,%.17g,%g\n", (i + 2) / 3, 5 + ax * k[i] + \
      cx * k[i + 1], ay * k[i] + cy * k[i + 1], cz * k[i + 1], k[i + 2]
  }' >"$T/five.csv"
check 'only what is seen is drawn' test "$(DEM_PLOTS=$T/copy "$B/analyze" draw \
  --color id "$T/five.csv" | cut -f 5 | tail -n +3 | tr '\n' ' ')" = '1 3 4 '
check 'from behind others are seen' test "$(DEM_PLOTS=$T/copy "$B/analyze" \
  draw --color id --view 210,72 "$T/five.csv" | cut -f 5 | tail -n +3 |
  sort | tr '\n' ' ')" = '1 2 4 '
# colours by speed: Pythagorean velocities, far apart
printf '%s\n' x,y,z,r,vx,vy,vz 0,0,0,.1,3,4,0 1,0,0,.1,0,5,12 2,0,0,.1,1,2,2 \
  >"$T/speeds.csv"
check 'colours are speeds' test "$(DEM_PLOTS=$T/copy "$B/analyze" draw \
  --color speed "$T/speeds.csv" | cut -f 5 | tail -n +3 | sort -n | tr '\n' ' ')" \
  = '3 5 13 '
"$B/analyze" draw --output "$T/bed.png" "$T/bed"

# the same spheres in another format: the same bytes
awk -F '\t' '/^# t=/ {n = 0} /^[0-9]/ {row[++n] = $0}
  END {print "# format=bed-1"; print "id\tx\ty\tz\tr"
    for (k = 1; k <= n; k++) {split(row[k], c, "\t")
      print c[1] "\t" c[2] "\t" c[3] "\t" c[4] "\t" c[5]}
    print "# status=ok"}' "$T/bed" >"$T/rows"
grep -v '^#' "$T/rows" | tr '\t' , >"$T/table.csv"
"$B/analyze" draw --output "$T/rows.png" "$T/rows"
"$B/analyze" draw <"$T/table.csv" >"$T/table.png"
check 'a table, a pipe: the same bytes' cmp -s <(image "$T/rows.png") \
  <(image "$T/table.png")
"$B/analyze" draw --frame 2 --output "$T/frame.png" "$T/bed"
check 'the last frame is the default' cmp -s <(image "$T/bed.png") \
  <(image "$T/frame.png")
"$B/analyze" draw --frame 0 --output "$T/frame.png" "$T/bed"
check 'the first one is another' test -s "$T/frame.png"
check 'the first one is another' eval '! cmp -s <(image "$T/bed.png") \
  <(image "$T/frame.png")'
"$B/analyze" draw --view 200,40 --color contacts --output "$T/x.svg" "$T/bed"
check 'an SVG' test "$(grep -c '<svg' "$T/x.svg")" = 1
check 'with its label' grep -q 'touching spheres' "$T/x.svg"

# whatever ~/.gnuplot holds
mkdir "$T/home" "$T/other"
printf 'set logscale z\nset terminal dumb\nset key\nset xrange [1:2]\n' \
  >"$T/home/.gnuplot"
own=tests/cases/gnuplot-own-settings.csv
for home in home other; do
  HOME=$T/$home timeout 60 "$B/analyze" draw --output "$T/$home.png" $own \
    2>"$T/err"
  check "drawn with the settings of $home: exit status $?" test $? = 0
  HOME=$T/$home timeout 60 "$B/analyze" movie $own >"$T/$home.gif" 2>"$T/err"
  check "a movie with the settings of $home" test -s "$T/$home.gif"
done
check 'own settings leave the picture alone' cmp -s <(image "$T/home.png") \
  <(image "$T/other.png")
check 'and the movie' cmp -s "$T/home.gif" "$T/other.gif"
# the same bed in millimetres and in a billionth of that: the same picture, but
# for its numbers
for scale in 1 1e-3 1e-12; do
  awk -F, -v s=$scale 'NR == 1 {print; next}
    {printf "%.17g,%.17g,%.17g,%.17g\n", s * $1, s * $2, s * $3, s * $4}' $own |
    timeout 60 "$B/analyze" draw >"$T/scaled.png" 2>"$T/err"
  check "a bed times $scale" test "$(pixels "$T/scaled.png" | awk \
    '$1 < 0.79 * 1280 {s = $3 - $5; n += s > 20 || s < -20}
      END {print (n > 10000)}')" = 1
done

# --- animations ---------------------------------------------------------------
"$B/analyze" movie --rate 10 "$T/bed" >"$T/x.gif"
check 'a GIF of 640 x 480' test \
  "$(head -c 10 "$T/x.gif" | od -An -tx1 | tr -d ' \n')" = 4749463839618002e001
check 'of three frames' test "$(od -An -v -tx1 "$T/x.gif" | tr -d ' \n' |
  grep -o '21f904..0a00' | wc -l)" = 3
if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then
  "$B/analyze" movie --rate 5 --output "$T/x.mp4" "$T/bed"
  check 'an mp4 of three frames' test "$(ffprobe -v error -count_frames \
    -show_entries stream=width,height,r_frame_rate,nb_read_frames -of csv=p=0 \
    "$T/x.mp4")" = 1280,960,5/1,3
else
  echo 'skipped: mp4 (ffmpeg is not installed)'
fi

# --- where the scripts are ----------------------------------------------------
mkdir -p "$T/prefix/bin" "$T/prefix/share/dem/plots" "$T/mine"
cp "$B/analyze" "$T/prefix/bin"
echo 'print "the installed one"; exit status 3' \
  >"$T/prefix/share/dem/plots/bed.gp"
echo 'print "mine"; exit status 3' >"$T/mine/bed.gp"
real=$B
B=$T/prefix/bin
refuse 'beside the installed program' 1 'gnuplot: the installed one' \
  draw --output "$T/y.png" "$T/one"
environment=DEM_PLOTS=$T/mine refuse 'DEM_PLOTS' 1 'gnuplot: mine' \
  draw --output "$T/y.png" "$T/one"
B=$real
check 'no picture came of that' test ! -e "$T/y.png"
timeout 60 "$B/analyze" draw "$T/one" >/dev/full 2>"$T/err"
check 'a full disk' test $? = 1 -a "$(grep -c 'No space' "$T/err")" = 1
check 'nothing is left in scratch' test -z "$(ls "$TMPDIR")"

check_done
