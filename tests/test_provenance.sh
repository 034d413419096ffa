#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a file says of its origin: every program, verb and format writes one, which
# has the version and the command line, unless its format has no place for them;
# tables have it by --origin
# (docs/reliability.md, "What a file says of its origin"). Run from the root of the
# repository; B is the directory of the programs.
. tests/harness.sh
B=$(cd "$B" && pwd)
version=$("$B/settle" --version | sed 's/.* //')
cd "$T" || exit 1
PATH=$B:$PATH

settle --quiet --count 12 --time 0.8 --frames 2 --log log \
  --origin --stats stats >bed.tsv || exit 1
frames=$(grep -c '^id' bed.tsv)
sum=$(grep '^# checksum=' bed.tsv | tail -n 1 | sed 's/.*=//')
bed="bed.tsv, checksum $sum"

has() { # NAME FILE TEXT...: each of them somewhere in the file
  local text
  for text in "${@:3}"; do
    check "$1: has '$text'" grep -aqF -- "$text" "$2"
  done
}
table() { # FILE COMMAND: lines of comment at its head, then the names of columns
  has "$2" "$1" "# version=$version" "# command=$2" '# build='
  case $2 in
    *rest* | precision* | stability*) has "$2" "$1" '# kernel=' ;;
  esac
  check "$2: the first line is the program" test "$(head -n 1 "$1")" = \
    "# program=${2%% *}"
  check "$2: names behind them" awk '/^#/ {next} {exit !/^[a-z]/}' "$1"
  check "$2: comments at the head alone" awk '!/^#/ {rows = 1} /^#/ && rows {bad = 1}
    END {exit bad}' "$1"
}

# --- settle and bounce ----------------------------------------------------------
has 'settle: bed' bed.tsv "# version=$version" '# build=' '# kernel='
has 'settle --stats' stats $'version\t'"$version" $'build\t' $'kernel\t' \
  $'command\tsettle --quiet --count 12'
has 'settle --log' log "# version=$version" '# build=' '# kernel=' '# count=12' \
  '# seed=1'
check 'settle --log: as the bed has it' cmp -s \
  <(sed -n '/^# t=/q; /^# \(format\|checksum\)=/!p' bed.tsv) <(grep '^#' log)
settle --quiet --count 2 --time 0 --export-lammps folder >out || exit 1
for file in in.scene in.run bed.data; do
  has "settle --export-lammps: $file" folder/$file "# version=$version" \
    '# command=' '--export-lammps folder'
done
bounce --quiet --rebound --stats stats >out || exit 1
table out 'bounce --rebound --stats stats'
has 'bounce --stats' stats $'version\t'"$version" \
  $'command\tbounce --rebound --stats stats'

for study in 'precision rolling --method rkc --rung 1e-3 --timed 0' 'stability cut'; do
  $study >out 2>err
  check "$study: exit status" test $? = 0
  table out "$study"
done

# --- tables of analyze ----------------------------------------------------------
named= # verbs that were tried
for verb in fraction 'fraction --slab 0.2' profile contacts 'contacts --network' \
  mixture rest gr order hard 'radius --report'; do
  named+=" ${verb%% *}"
  files=(bed.tsv)
  [[ $verb != hard ]] || files=(a.tsv b.tsv)
  for kappa in 150 600; do
    [[ $verb != hard ]] || settle --quiet --count 30 --base 0.5,0.5 --model basic \
      --time 2 --kappa $kappa >"$([[ $kappa = 150 ]] && echo a || echo b).tsv"
  done
  # shellcheck disable=SC2086
  analyze $verb --origin --quiet "${files[@]}" >out 2>err
  check "analyze $verb: exit status" test $? = 0
  table out "analyze $verb --origin ${files[*]}"
  # shellcheck disable=SC2086
  analyze $verb "${files[@]}" >plain 2>/dev/null
  check "analyze $verb: else it begins with the names" cmp -s \
    <(grep -v '^#' out) plain
done
for verb in $(analyze --complete | grep -v '^-'); do
  case $verb in
    export | draw | movie) ;; # below
    *) check "analyze $verb was tried" grep -qw "$verb" <<<"$named" ;;
  esac
done
analyze --origin --mean bed.tsv bed.tsv >out
table out 'analyze --origin --mean bed.tsv bed.tsv'
# words that need quotes, and bytes that are no ASCII, as bash reads them back
cp bed.tsv $'it\'s "ä"\n?.tsv'
analyze --origin $'it\'s "ä"\n?.tsv' >out
check 'a name with quotes, letters and a line' test "$(eval "printf '%s\n' \
  $(sed -n 's/^# command=analyze --origin //p' out)")" = $'it\'s "ä"\n?.tsv'
check 'is written in ASCII, without quotation marks' test -z \
  "$(sed -n '/^#/p' out | tr -d '\n\040\041\043-\176')"

# --- exports ----------------------------------------------------------------------
# What each says: all, the version and the bed's checksum, or nothing.
formats=$(analyze export --complete | sed -n 's/^--format\t[^\t]*\t//p' |
  tr ' ' '\n')
says() { # FILE COMMAND
  has "$2" "$1" "$version" "$2" "$bed"
}
export_() { # FORMAT OPTION...: into FORMAT.out
  analyze export --quiet --format "$1" "${@:2}" bed.tsv >"$1.out" 2>err
  check "export $1: exit status" test $? = 0
}
for format in $formats; do
  case $format in
    xyz | lammps-data | vtp | geo)
      export_ $format --frame 1
      says $format.out "analyze export --format $format --frame 1 bed.tsv"
      ;;
    vti)
      export_ $format --cells 4 --threads 2
      says vti.out 'analyze export --format vti --cells 4 bed.tsv'
      ;;
    stl) # a head of 80 bytes
      export_ $format
      has stl <(head -c 80 stl.out) "analyze export $version of $sum: "
      export_ $format --merged --cells 4
      has 'stl, merged' <(head -c 80 stl.out) "analyze export $version of $sum: "
      ;;
    mhd)
      export_ $format --cells 4 --output m.mhd
      says m.mhd 'analyze export --format mhd --cells 4 --output m.mhd bed.tsv'
      export_ $format --cells 4 --output w.mhd --walls --gap 0.01 --bridge 0.01
      check 'mhd: lines that MetaIO can hold' awk 'length > 500 ||
        /^Comment/ && length > 264 {exit 1}' w.mhd
      check 'mhd: what it cuts is whole below' grep -q \
        '^solid = .*change.*bridges: .*+- ' w.mhd
      ;;
    openfoam)
      export_ $format --output case
      for file in case/system/*; do
        says $file 'analyze export --format openfoam --output case bed.tsv'
      done
      has openfoam <(head -c 80 case/constant/triSurface/spheres.stl) \
        "analyze export $version of $sum: "
      ;;
    freezethaw) # positions are bare, Params beside them are not
      export_ $format --output ice
      says ice/Params 'analyze export --format freezethaw --output ice bed.tsv'
      ;;
    bed) # it is the bed
      export_ $format
      has bed bed.out "# version=$version" "# checksum=$sum"
      ;;
    positions | csv | lammps | raw | palabos) # bare numbers, or no comments
      export_ $format
      check "$format: bare" test "$(grep -ac analyze $format.out)" = 0
      ;;
    *) fail "export --format $format: what does it say?" ;;
  esac
done
check 'all formats' test "$(wc -l <<<"$formats")" -ge 15
export_ xyz
check 'xyz: each frame' test "$(grep -c "command=\"analyze export" xyz.out)" = \
  "$frames"
check 'xyz: with its own checksum' test "$(grep -o 'checksum [0-9a-f]*' xyz.out |
  sort -u | wc -l)" = "$frames"
analyze export --quiet --format vtp --frames all --output f%d.vtp bed.tsv 2>err
has pvd f.pvd "$version" 'analyze export --format vtp --frames all --output f%d.vtp bed.tsv'

# --- pictures ---------------------------------------------------------------------
if command -v gnuplot >/dev/null; then
  for name in draw.png draw.svg movie.gif; do
    analyze ${name%.*} --output $name bed.tsv 2>err
    says $name "analyze ${name%.*} --output $name bed.tsv"
  done
  # the text is a chunk of its own, whose checksum gzip computes as well
  number() { od -An -tx1 -N 4 | tr -d ' \n'; }
  length=$((16#$(tail -c +34 draw.png | number)))
  check 'png: the checksum of its text' test "$(tail -c +38 draw.png |
    head -c $((4 + length)) | gzip -c | tail -c 8 | od -An -tx4 -N 4 |
    tr -d ' \n')" = "$(tail -c +$((42 + length)) draw.png | number)"
  check 'png: the header first, and the picture behind' test \
    "$(head -c 16 draw.png | tail -c 4)$(tail -c 8 draw.png | head -c 4)" = IHDRIEND
  check 'svg: behind the line of XML' test "$(sed -n 2p draw.svg)" = '<?origin'
  # of a movie by ffmpeg, what it is told
  mkdir bin
  printf '#!/bin/bash\nprintf "%%s\\n" "$@" >>%q\ntouch -- "${@: -1}"\n' \
    "$T/told" >bin/ffmpeg
  chmod +x bin/ffmpeg
  PATH=$T/bin:$PATH analyze movie --output a.mp4 bed.tsv 2>err
  has 'movie by ffmpeg' told comment=program=analyze "version=$version" "$bed" \
    'command=analyze movie --output a.mp4 bed.tsv'
else
  echo 'skipped: pictures (gnuplot is not installed)'
fi

# --- sweep ------------------------------------------------------------------------
printf 'seed\n1\n2\n' >runs.tsv
sweep --quiet --origin --settle '--count 4 --time 0.1' --measure rest runs.tsv \
  >swept.tsv 2>err
table swept.tsv "sweep --settle '--count 4 --time 0.1' --measure rest runs.tsv"
sweep --origin --summary '' swept.tsv >out
has summary out "# version=$version" "# command=sweep --summary '' swept.tsv"
check_done
