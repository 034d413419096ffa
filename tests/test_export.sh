#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The promises of `analyze export`: formats read back by others' readers (where
# they are installed) and by our own, frames, file names, refusals. Its binary
# formats are taken apart in test_export.c. Run from the root of the repository;
# B is the directory of the programs.
. tests/harness.sh
B=$(cd "$B" && pwd) || exit 1
export OMP_NUM_THREADS=1
python=/usr/bin/python3 # Debian's, which has Debian's packages

export_() { # ARGUMENT...
  timeout 60 "$B/analyze" export --quiet "$@" </dev/null
}

refuse() { # NAME STATUS PATTERN ARGUMENT...: one line, and no result
  local name=$1 code=$2 pattern=$3
  shift 3
  export_ "$@" >"$T/out" 2>"$T/err"
  local status=$?
  if [[ $status == "$code" && $(wc -l <"$T/err") == 1 && ! -s $T/out ]] &&
    grep -Eq -e "^analyze: .*$pattern" "$T/err"; then
    pass
  else
    fail "$name: exit status $status, expected $code and '$pattern'"
  fi
}

same_numbers() { # A B: text of numbers, to the last bit of what %.17g carries
  paste -d '\n' <(tr -s ', \t' '\n' <"$1" | grep .) \
    <(tr -s ', \t' '\n' <"$2" | grep .) | awk '
      NR % 2 {a = $1; next}
      {n++; if ($1 == "" || a == "" || a + 0 != $1 + 0 || a ~ /nan/) bad = 1}
      END {exit bad || n == 0 || NR % 2}'
}

# --- a film of four spheres, numbered 0, 1, 7 and 9, two of them overlapping --
film() {
  local t
  printf '# format=bed-1\n# wall=0 0 0 0 0 -1\n# wall=0 0 0 -1 0 0\n'
  printf '# wall=2 0 0 2 0 0\n'
  for t in 0 0.25 0.5; do
    [[ $t == 0 ]] || printf '\n\n'
    printf '# t=%s\n' $t
    printf 'id\tx\ty\tz\tr\tm\tvx\tvy\tvz\twx\twy\twz\n'
    awk -v t=$t 'BEGIN {OFS = "\t"; split("0 1 7 9", id, " ")
      for (i = 1; i <= 4; i++)
        print id[i], sprintf("%.17g", 0.3 * i + t / 3), 0.5 + i / 7,
          0.3 - t / 7, 0.1 * i, 1 + i / 3, t * i, -t, 0.125 * i, i, -i / 3, t}'
  done
  printf '# status=ok\n'
}
film >"$T/film"
columns() { # FRAME COLUMN...: of the film, space-separated
  local k=$1
  shift
  awk -v k="$k" -v want="$*" -F '\t' '
    $1 == "id" {f++; for (i = 1; i <= NF; i++) at[$i] = i; next}
    /^#/ || NF < 2 {next}
    f == k + 1 {n = split(want, name, " "); line = ""
      for (i = 1; i <= n; i++) line = line (i > 1 ? " " : "") $at[name[i]]
      print line}' "$T/film"
}

# --- text -----------------------------------------------------------------
export_ --format positions "$T/film" >"$T/p"
columns 2 x y z >"$T/want"
check "positions are those of the last frame" same_numbers "$T/p" "$T/want"
check "positions: three columns by tabs, nothing else" \
  awk -F '\t' 'NF != 3 || /[^-+.0-9e\t]/ {bad = 1} END {exit bad || NR != 4}' \
  "$T/p"
export_ --format positions --frame 1 "$T/film" >"$T/p"
columns 1 x y z >"$T/want"
check "--frame 1 is the second" same_numbers "$T/p" "$T/want"
check "from a pipe" cmp -s "$T/p" \
  <("$B/analyze" export --quiet --format positions --frame 1 <"$T/film")

export_ --format csv "$T/film" >"$T/film.csv"
check "csv: one row of names, all frames" [ "$(grep -n t,id "$T/film.csv")" = \
  1:t,id,x,y,z,r,m,vx,vy,vz,wx,wy,wz ]
for k in 0 1 2; do
  columns $k id x y z r m vx vy vz wx wy wz
done >"$T/want"
check "csv: the numbers" same_numbers \
  <(tail -n +2 "$T/film.csv" | cut -d , -f 2-) "$T/want"
check "csv: the times" [ "$(tail -n +2 "$T/film.csv" | cut -d , -f 1 |
  uniq -c | tr -s ' \n' ' ')" = ' 4 0 4 0.25 4 0.5 ' ]
export_ --format csv --frame 2 "$T/film" | cut -d , -f 2- >"$T/csv"
check "csv: one frame" [ "$(wc -l <"$T/csv")" = 5 ]

export_ --format xyz "$T/film" >"$T/xyz"
check "xyz: all frames" [ "$(grep -c '^4$' "$T/xyz")" = 3 ]
columns 1 x y z r vx vy vz id m wx wy wz >"$T/want"
check "xyz: the second frame" \
  same_numbers <(sed -n '9,12 s/^X //p' "$T/xyz") "$T/want"
check "xyz: the last frame alone" [ "$(export_ --format xyz --frames last \
  "$T/film" | wc -l)" = 6 ]
check "xyz: floor and side from walls, the rest from spheres" \
  grep -q 'Origin="0 .* 0" pbc="F F F" .*Time=0.25 ' "$T/xyz"
check "xyz: --box" [ "$(export_ --format xyz --box=-1,1,-2,2,-3,3 "$T/film" |
  grep -c '^Lattice="2 0 0 0 4 0 0 0 6" Origin="-1 -2 -3" ')" = 3 ]

export_ --format lammps "$T/film" >"$T/film.dump"
check "lammps: all frames, numbered" [ "$(grep -A 1 'ITEM: TIMESTEP' \
  "$T/film.dump" | grep -c '^[012]$')" = 3 ]
check "lammps: numbers from 1" [ "$(tail -n 4 "$T/film.dump" | cut -d ' ' -f 1 |
  tr '\n' ' ')" = '1 2 8 10 ' ]

# --- our own readers: the union comes back to the last bit
whole=$("$B/analyze" --box 0,2,0,2,0,2 "$T/film")
for format in csv xyz lammps; do
  export_ --format $format "$T/film" >"$T/back"
  check "analyze reads $format" \
    [ "$("$B/analyze" --box 0,2,0,2,0,2 "$T/back")" = "$whole" ]
done

# --- file names -----------------------------------------------------------
check "--output" export_ --format csv --output "$T/named.csv" "$T/film"
check "--output: the same" cmp -s "$T/named.csv" "$T/film.csv"
mkdir "$T/vtk"
check "--frames all" export_ --format vtp --frames all \
  --output "$T/vtk/bed-%04d.vtp" "$T/film"
check "--frames all: one file per frame and their list" \
  [ "$(ls "$T/vtk" | tr '\n' ' ')" = \
  'bed-0000.vtp bed-0001.vtp bed-0002.vtp bed.pvd ' ]
check "the list has times and names beside it" \
  grep -q 'timestep="0.25" file="bed-0001.vtp"' "$T/vtk/bed.pvd"
check "the second file is the second frame" \
  cmp -s <(grep -av '^<?origin' "$T/vtk/bed-0001.vtp") \
  <(export_ --format vtp --frame 1 "$T/film" | grep -av '^<?origin')
check "--frames all: stl" export_ --quiet --format stl --frames all \
  --output "$T/vtk/%d.stl" "$T/film"
check "--frames all: no list for stl" \
  [ "$(ls "$T/vtk" | grep -c 'stl\|pvd')" = 4 ]

# --- the same bytes for any number of threads
for what in '' --binary --distance; do
  export_ --format raw --cells 40 --box 0,2,0,2,0,1 $what "$T/film" >"$T/one"
  export_ --format raw --cells 40 --box 0,2,0,2,0,1 $what --threads 3 \
    "$T/film" >"$T/three"
  check "threads change nothing $what" cmp -s "$T/one" "$T/three"
done

# --- refusals -------------------------------------------------------------
film | sed '$d' >"$T/cut"
refuse 'no format' 2 '--format: expected' "$T/film"
refuse 'unknown format' 2 '--format vtk: expected one of positions csv' \
  --format vtk "$T/film"
refuse 'box' 2 '--box: expected x0 < x1' --format raw --box 0,1,1,0,0,1 \
  "$T/film"
refuse 'flat box' 2 '--box: expected x0 < x1' --format vti --box 0,1,1,1,0,1 \
  "$T/film"
refuse 'box of positions' 2 '--box: not for --format positions' \
  --format positions --box 0,1,0,1,0,1 "$T/film"
refuse 'facets of voxels' 2 '--facets: not for --format raw' --format raw \
  --facets 80 "$T/film"
refuse 'two cells' 2 '--cells: expected N or NX,NY,NZ' --format raw \
  --cells 4,4 "$T/film"
refuse 'no cells' 2 '--cells: expected whole numbers' --format raw \
  --cells 4,0,4 "$T/film"
refuse 'part of a cell' 2 '--cells: expected whole numbers' --format raw \
  --cells 4.5 "$T/film"
refuse 'cells beyond any file' 2 '--cells: .* bytes' --format raw \
  --cells 300000 "$T/film"
refuse 'cells beyond numbers' 2 '--cells: finer than' --format raw \
  --box 1e15,1000000000000001,0,1,0,1 --cells 16 "$T/film"
refuse 'type of bytes' 2 '--binary: is bytes' --format raw --binary \
  --type float32 "$T/film"
refuse 'binary distance' 2 '--binary and --distance' --format raw --binary \
  --distance "$T/film"
refuse 'frame and frames' 2 '--frame and --frames' --format xyz --frame 0 \
  --frames all "$T/film"
refuse 'no such frame' 3 '--frame 3: there are 3' --format xyz --frame 3 \
  "$T/film"
refuse 'all frames without a name' 2 '--output with a %d' --format vtp \
  --frames all "$T/film"
refuse 'a name without a number' 2 '--output with a %d' --format vtp \
  --frames all --output "$T/a.vtp" "$T/film"
for name in '%s' '%n' '%d-%d' '%04d/a' '%999d' '%'; do
  refuse "the name $name" 2 'expected one %d' --format vtp --frames all \
    --output "$T/$name.vtp" "$T/film"
done
refuse 'a file cut short' 3 'cut' --format positions "$T/cut"
check 'and nothing under its name' [ ! -e "$T/no.csv" ]
refuse 'no such folder' 1 'none/a.csv' --format csv --output "$T/none/a.csv" \
  "$T/film"
export_ --format csv --output "$T/no.csv" "$T/cut" 2>/dev/null
check 'a refused file leaves nothing' [ "$(ls "$T" | grep -c 'no.csv')" = 0 ]
export_ --format lammps "$T/cut" >"$T/out" 2>/dev/null
check 'a cut film is not exported as a whole one' [ $? = 3 ]

# memory and disk that do not suffice
for format in positions csv xyz lammps lammps-data vtp stl vti raw palabos bed geo; do
  export_ --quiet --format $format "$T/film" 2>"$T/err" >/dev/full
  check "a full disk: $format" [ $? = 1 ]
  check "a full disk: $format says so" grep -q 'No space left' "$T/err"
done
(ulimit -f 64 && export_ --format raw --output "$T/large.raw" "$T/film") \
  2>"$T/err"
check 'a file too large' [ $? = 1 ]
check 'a file too large says so' grep -q 'large.raw: takes .* ulimit -f has room' \
  "$T/err"
check 'a file too large leaves nothing' \
  [ "$(ls "$T" | grep -c 'large.raw')" = 0 ]
(ulimit -v 2000000 && export_ --format raw --cells 500000000,1,1 \
  --output "$T/wide.raw" "$T/film") 2>"$T/err"
status=$?
if ! sanitized 'rows beyond memory'; then
  check 'rows beyond memory' [ $status = 1 ]
  check 'rows beyond memory: said so' grep -q 'out of memory' "$T/err"
fi

# --- others' readers ------------------------------------------------------
if [[ -x $python ]] && "$python" -c 'import vtk' 2>/dev/null; then
  export_ --format vti --cells 8,6,4 --box=-1,1,0,1.5,0,0.5 "$T/film" \
    >"$T/a.vti"
  export_ --format vti --cells 8,6,4 --box=-1,1,0,1.5,0,0.5 --type float32 \
    --distance "$T/film" >"$T/d.vti"
  export_ --format vti --cells 8,6,4 --box=-1,1,0,1.5,0,0.5 --binary \
    "$T/film" >"$T/b.vti"
  export_ --format raw --cells 8,6,4 --box=-1,1,0,1.5,0,0.5 "$T/film" \
    >"$T/a.raw"
  export_ --format vtp "$T/film" >"$T/a.vtp"
  export_ --quiet --format stl "$T/film" >"$T/a.stl"
  cat >"$T/read.py" <<'END'
import array, sys, vtk
def read(kind, name):
    r = kind()
    r.SetFileName(sys.argv[1] + "/" + name)
    r.Update()
    assert r.GetErrorCode() == 0, name
    return r.GetOutput()
p = read(vtk.vtkXMLPolyDataReader, "a.vtp")
assert p.GetNumberOfPoints() == p.GetNumberOfVerts() == 4
assert p.GetFieldData().GetArray("TimeValue").GetValue(0) == 0.5
data = p.GetPointData()
rows = [l.split(",") for l in open(sys.argv[1] + "/csv").read().split()[1:]]
for i, row in enumerate(rows):
    got = [data.GetArray("id").GetValue(i)] + list(p.GetPoint(i))
    got += [data.GetArray(n).GetValue(i) for n in ("radius", "mass")]
    got += data.GetArray("velocity").GetTuple(i)
    got += data.GetArray("angular_velocity").GetTuple(i)
    assert got == [float(x) for x in row], (got, row)
    assert p.GetCell(i).GetPointId(0) == i
raw = array.array("d", open(sys.argv[1] + "/a.raw", "rb").read())
for name, kind, cells in (("a.vti", "double", "solid_fraction"),
                          ("d.vti", "float", "distance"),
                          ("b.vti", "unsigned char", "solid")):
    v = read(vtk.vtkXMLImageDataReader, name)
    assert v.GetDimensions() == (9, 7, 5), name
    assert v.GetBounds() == (-1, 1, 0, 1.5, 0, 0.5), name
    a = v.GetCellData().GetArray(cells)
    assert a.GetDataTypeAsString() == kind and a.GetNumberOfTuples() == 192
    if name == "a.vti":
        assert [a.GetValue(i) for i in range(192)] == list(raw)
        assert 0 < min(x for x in raw if x) < 1
s = read(vtk.vtkSTLReader, "a.stl")
assert s.GetNumberOfCells() == 4 * 320
assert s.GetNumberOfPoints() == 4 * 162 # merged: V = F/2 + 2
END
  check "VTK reads vtp, vti and stl" "$python" "$T/read.py" "$T"
else
  echo "test_export.sh: skipped: VTK's reader (python3-vtk9 not installed)" >&2
fi

if [[ -x $python ]] && "$python" -c 'import ase' 2>/dev/null; then
  cat >"$T/read.py" <<'END'
import sys, ase.io
frames = ase.io.read(sys.argv[1] + "/xyz", index=":")
assert [f.info["Time"] for f in frames] == [0, 0.25, 0.5]
f = frames[-1]
assert list(f.get_pbc()) == [False] * 3
assert f.cell[0][0] == 2 and f.cell[0][1] == 0
rows = [l.split(",") for l in open(sys.argv[1] + "/csv").read().split()[1:]]
for i, row in enumerate(rows):
    a = f.arrays
    got = [a["id"][i], *a["positions"][i], a["radius"][i], a["mass"][i],
           *a["velo"][i], *a["angular_velocity"][i]]
    assert got == [float(x) for x in row], (got, row)
d = ase.io.read(sys.argv[1] + "/film.dump", format="lammps-dump-text",
                index=":")
assert len(d) == 3 and abs(d[-1].positions[3] - f.positions[3]).max() == 0
END
  check "ASE reads xyz and the dump" "$python" "$T/read.py" "$T"
else
  echo "test_export.sh: skipped: ASE's reader (python3-ase not installed)" >&2
fi

if command -v lmp >/dev/null; then
  export_ --format lammps-data --frame 0 "$T/film" >"$T/data"
  cat >"$T/in" <<'END'
units si
atom_style sphere
boundary f f f
comm_modify vel yes
read_data data
pair_style zero 1
pair_coeff * *
neighbor 0.1 bin
variable out string "id x y z radius mass vx vy vz omegax omegay omegaz"
write_dump all custom first ${out} modify sort id format float %.17g
read_dump film.dump 2 x y z vx vy vz replace yes box yes
write_dump all custom last ${out} modify sort id format float %.17g
thermo_style custom step atoms ke
thermo 1
rerun film.dump dump x y z vx vy vz
END
  (cd "$T" && timeout 60 lmp -in in -log none >lmp.out 2>&1)
  check "LAMMPS runs" [ $? = 0 ] || tail -n 5 "$T/lmp.out" >&2
  tail -n 4 "$T/first" >"$T/got"
  columns 0 id x y z r m vx vy vz wx wy wz |
    awk '{$1 += 1; print}' CONVFMT=%.17g >"$T/want"
  # density from mass and back: two roundings more
  check "LAMMPS reads the data file" awk '
    function off(a, b, d) {d = a - b; return !(d <= 8e-15 && -d <= 8e-15)}
    {for (k = 1; k <= 12; k++) if (off($k, $(k + 12))) bad = 1}
    END {exit bad || NR != 4}' <(paste -d ' ' "$T/got" "$T/want")
  columns 2 id x y z vx vy vz | awk '{$1 += 1; print}' CONVFMT=%.17g >"$T/want"
  check "LAMMPS's read_dump" same_numbers \
    <(tail -n 4 "$T/last" | cut -d ' ' -f 1-4,7-9) "$T/want"
  check "LAMMPS's rerun passes all frames" [ "$(awk '
    $1 == "Step" {n = 0; on = 1; next} /^Loop/ {on = 0} on {n++}
    END {print n}' \
    "$T/lmp.out")" = 3 ]
else
  echo "test_export.sh: skipped: LAMMPS's readers (lmp not installed)" >&2
fi

check_done
