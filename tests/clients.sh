#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The programs that beds are handed on to read what `analyze export` writes, and
# say what they have read: their figure, ours, and the difference. Debian's
# packages: gmsh python3-gmsh openfoam admesh python3-vtk9 python3-numpy
# python3-ase lammps. What is not installed is skipped, and said to be. Not part
# of make check: make clients takes some minutes. B is the directory of the
# programs.
. tests/harness.sh
B=$(cd "$B" && pwd) || exit 1
export OMP_NUM_THREADS=1
python=/usr/bin/python3 # Debian's, which has Debian's packages
skipped=0

skip() { # CLIENT PACKAGE
  echo "SKIPPED: $1 (install $2)" >&2
  skipped=$((skipped + 1))
}

has() { # MODULE: of Debian's Python
  [[ -x $python ]] && "$python" -c "import $1" 2>/dev/null
}

hand() { # ARGUMENT...: what is said goes to $T/said
  timeout 600 "$B/analyze" export "$@" </dev/null 2>"$T/said"
}

stated() { # PATTERN: the number after it in what was said
  sed -n "s/.*$1 \([-+0-9.e]*\).*/\1/p" "$T/said" | head -n 1
}

agree() { # CLIENT WHAT THEIRS OURS TOLERANCE: relative, and a line of the table
  printf '%-10s %-34s %-18s %-18s' "$1" "$2" "$3" "$4"
  if awk -v x="$3" -v w="$4" -v t="$5" 'BEGIN {
    if (x !~ /^[-+]?[0-9]/ || w !~ /^[-+]?[0-9]/) exit 1
    d = w == 0 ? x - w : x / w - 1
    printf " %+.1e\n", d
    exit !(d <= t && -d <= t)}'; then
    pass
  else
    fail "$1: $2: $3, expected $4 within $5"
  fi
}

# The paper's bed of 200, and 25 spheres of it on the floor.
"$B/settle" --quiet --seed 1 >"$T/bed" 2>"$T/err" || fail 'no bed'
"$B/analyze" radius --quiet --keep contact-mean "$T/bed" >"$T/geometry"
unsealed "$T/geometry" | awk '/^[0-9]/ && ++n > 25 {next} {print}' >"$T/small"
slab=0,1,0,1,0,0.5
# A tube, and a bed with periodic sides.
"$B/settle" --quiet --cylinder 0.3,0.3,0,0,0,1,0.3 --count 40 --time 4 \
  >"$T/tube.bed" 2>"$T/err" || fail 'no tube'
"$B/analyze" radius --quiet --keep contact-mean "$T/tube.bed" >"$T/tube"
"$B/settle" --quiet --periodic xy --count 40 --time 2 >"$T/periodic" \
  2>"$T/err" || fail 'no periodic bed'

share() { # PORE: the solid share of the box that was stated
  sed -n 's/.*of the box \([-+0-9.e,]*\) .*/\1/p' "$T/said" | head -n 1 |
    awk -F , -v p="$1" '{v = ($2 - $1) * ($4 - $3) * ($6 - $5)
      printf "%.12g", 1 - p / v}'
}
printf '%-10s %-34s %-18s %-18s %s\n' client what theirs ours difference

# --- gmsh --------------------------------------------------------------------
cat >"$T/read_gmsh.py" <<'END'
import sys, gmsh
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.open(sys.argv[1])
groups = {gmsh.model.getPhysicalName(d, t): (d, t)
          for d, t in gmsh.model.getPhysicalGroups()}
def size(name):
    d, t = groups[name]
    return sum(gmsh.model.occ.getMass(d, e)
               for e in gmsh.model.getEntitiesForPhysicalGroup(d, t))
print("pore", repr(size("pore")))
print("names", ",".join(sorted(groups)))
if len(sys.argv) > 2:
    gmsh.model.mesh.generate(3)
    _, tags, _ = gmsh.model.mesh.getElements(3)
    print("tetrahedra", sum(len(t) for t in tags))
END
theirs() { # NAME: from what a reader printed
  awk -v name="$1" '$1 == name {print $2}' "$T/read"
}
if has gmsh; then
  hand --format geo "$T/geometry" >"$T/a.geo"
  "$python" "$T/read_gmsh.py" "$T/a.geo" >"$T/read" 2>"$T/err"
  agree gmsh 'solid, 200 spheres' "$(awk '$1 == "pore" {
    printf "%.12g", 1 - $2}' "$T/read")" "$(stated 'solid fraction')" 1e-6
  check 'gmsh: the names of the surfaces' [ "$(theirs names)" = \
    pore,spheres,xmax,xmin,ymax,ymin,zmax,zmin ]
  hand --format geo --bridge 0.02 --box $slab "$T/small" >"$T/a.geo"
  "$python" "$T/read_gmsh.py" "$T/a.geo" >"$T/read" 2>"$T/err"
  agree gmsh 'solid, 25 spheres with bridges' "$(awk '$1 == "pore" {
    printf "%.12g", 1 - $2 / 0.5}' "$T/read")" "$(stated 'solid fraction')" 1e-6
  hand --format geo --walls "$T/tube" >"$T/a.geo"
  "$python" "$T/read_gmsh.py" "$T/a.geo" >"$T/read" 2>"$T/err"
  agree gmsh 'solid, 40 spheres in a tube' "$(share "$(theirs pore)")" \
    "$(stated 'solid fraction')" 1e-6
  check 'gmsh: the names with a tube' [ "$(theirs names)" = \
    pore,spheres,walls,zmax,zmin ]
  hand --format geo "$T/periodic" >"$T/a.geo"
  "$python" "$T/read_gmsh.py" "$T/a.geo" >"$T/read" 2>"$T/err"
  agree gmsh 'solid, 40 spheres, periodic sides' "$(share "$(theirs pore)")" \
    "$(stated 'solid fraction')" 1e-6
  hand --format geo --gap 0.01 --box $slab "$T/small" >"$T/a.geo"
  "$python" "$T/read_gmsh.py" "$T/a.geo" mesh >"$T/read" 2>"$T/err"
  check "gmsh: a mesh of 25 spheres with gaps: $(theirs tetrahedra)" \
    [ "$(theirs tetrahedra)" -gt 1000 ]
else
  skip gmsh 'gmsh python3-gmsh'
fi

# --- OpenFOAM ----------------------------------------------------------------
if command -v snappyHexMesh >/dev/null; then
  export WM_PROJECT_DIR=${WM_PROJECT_DIR:-/usr/share/openfoam}
  for cells in 24 36; do
    rm -rf "$T/foam"
    hand --format openfoam --cells $cells --box $slab --output "$T/foam" \
      "$T/small"
    (cd "$T/foam" && blockMesh && snappyHexMesh -overwrite && checkMesh) \
      >"$T/log" 2>&1
    check "OpenFOAM: checkMesh, $cells cells" grep -q '^Mesh OK' "$T/log"
    agree OpenFOAM "fluid, 25 spheres, $cells cells" "$(sed -n \
      's/.*Total volume = \([0-9.e-]*[0-9]\).*/\1/p' "$T/log")" "$(awk -v \
      s="$(stated 'solid fraction')" 'BEGIN {printf "%.9g", (1 - s) / 2}')" 0.01
  done
  rm -rf "$T/foam"
  hand --format openfoam --cells 24 --walls --output "$T/foam" "$T/tube"
  (cd "$T/foam" && blockMesh && snappyHexMesh -overwrite && checkMesh) \
    >"$T/log" 2>&1
  check 'OpenFOAM: checkMesh, a tube' grep -q '^Mesh OK' "$T/log"
  agree OpenFOAM 'solid and walls, a tube, 24 cells' "$(share "$(sed -n \
    's/.*Total volume = \([0-9.e-]*[0-9]\).*/\1/p' "$T/log")")" \
    "$(stated 'solid fraction')" 0.01
else
  skip OpenFOAM openfoam
fi

# --- surfaces: admesh, VTK ----------------------------------------------------
hand --format stl --merged --cells 100 "$T/geometry" >"$T/merged.stl"
merged=$(stated 'volume')
exact=$(stated 'of the exact')
agree ours 'merged, 100 cells' "$merged" "$exact" 0.01
if command -v admesh >/dev/null; then
  admesh "$T/merged.stl" >"$T/log" 2>"$T/err"
  check 'admesh: no facet is disconnected' \
    grep -q 'Total disconnected facets *: *0 ' "$T/log"
  check 'admesh: nothing to mend' awk -F : '/Degenerate|Edges fixed|removed|added|reversed|Backwards|Normals fixed/ {n++; if ($2 + 0 != 0) bad = 1}
    END {exit bad || n < 6}' "$T/log"
  # admesh adds volumes up in single precision
  agree admesh 'volume, merged' \
    "$(sed -n 's/.*Volume *: *\([0-9.]*\)/\1/p' "$T/log")" "$merged" 1e-3
  hand --format stl "$T/small" >"$T/bodies.stl"
  admesh "$T/bodies.stl" >"$T/log" 2>"$T/err"
  hand --format stl --merged --cells 60 --walls "$T/tube" >"$T/walled.stl"
  admesh "$T/walled.stl" >"$T/walled.log" 2>"$T/err"
  check 'admesh: with a tube no facet is disconnected' \
    grep -q 'Total disconnected facets *: *0 ' "$T/walled.log"
  agree admesh 'volume, merged with a tube' \
    "$(sed -n 's/.*Volume *: *\([0-9.]*\)/\1/p' "$T/walled.log")" \
    "$(stated 'volume')" 1e-3
  agree admesh 'bodies of 25 spheres' \
    "$(sed -n 's/^Number of parts *: *\([0-9]*\).*/\1/p' "$T/log")" 25 0
else
  skip admesh admesh
fi

cat >"$T/read_vtk.py" <<'END'
import sys, vtk
readers = []
def read(kind, name):
    r = kind()
    readers.append(r)
    r.SetFileName(sys.argv[1] + "/" + name)
    r.Update()
    assert r.GetErrorCode() == 0, name
    return r.GetOutputPort(), r.GetOutput()
port, _ = read(vtk.vtkSTLReader, "merged.stl")
def edges(boundary):
    f = vtk.vtkFeatureEdges()
    f.SetInputConnection(port)
    f.SetBoundaryEdges(boundary)
    f.SetNonManifoldEdges(not boundary)
    f.FeatureEdgesOff()
    f.ManifoldEdgesOff()
    f.Update()
    return f.GetOutput().GetNumberOfCells()
print("open", edges(True))
print("nonmanifold", edges(False))
m = vtk.vtkMassProperties()
m.SetInputConnection(port)
m.Update()
print("volume", repr(m.GetVolume()))
def mean(image, where):
    a = getattr(image, where)().GetScalars()
    return sum(a.GetValue(i) for i in range(a.GetNumberOfTuples())) / \
        a.GetNumberOfTuples()
print("vti", repr(mean(read(vtk.vtkXMLImageDataReader, "a.vti")[1],
                       "GetCellData")))
image = read(vtk.vtkMetaImageReader, "a.mhd")[1]
print("mhd", repr(mean(image, "GetPointData")))
print("origin", *image.GetOrigin())
print("spacing", *image.GetSpacing())
_, p = read(vtk.vtkXMLPolyDataReader, "a.vtp")
print("scalars", p.GetPointData().GetScalars().GetName())
print("lines", p.GetNumberOfLines())
a = p.GetCellData().GetArray("normal_force")
print("force", repr(sum(a.GetValue(i) for i in range(a.GetNumberOfTuples()))))
END
if has vtk; then
  hand --format vtp --network "$T/bed" >"$T/a.vtp"
  hand --format mhd --cells 40 --output "$T/a.mhd" "$T/geometry"
  hand --format vti --cells 40 "$T/geometry" >"$T/a.vti"
  "$python" "$T/read_vtk.py" "$T" >"$T/read" 2>"$T/err"
  agree VTK 'open edges, merged' "$(theirs open)" 0 0
  agree VTK 'edges of more than two facets' "$(theirs nonmanifold)" 0 0
  agree VTK 'volume, merged' "$(theirs volume)" "$merged" 1e-6
  agree VTK 'mean of vti, 40^3' "$(theirs vti)" "$(stated 'solid fraction')" \
    1e-11
  agree VTK 'mean of mhd, 40^3' "$(theirs mhd)" "$(stated 'solid fraction')" \
    1e-11
  check 'VTK: place and spacing of mhd' [ "$(grep -E '^(origin|spacing)' \
    "$T/read" | tr '\n' ' ')" = \
    'origin 0.0125 0.0125 0.0125 spacing 0.025 0.025 0.025 ' ]
  check 'VTK: vtp is coloured by radius' [ "$(theirs scalars)" = radius ]
  "$B/analyze" contacts --network "$T/bed" 2>"$T/err" |
    awk -F '\t' 'NR > 1 {n++; f += $8} END {printf "%d %.12g\n", n, f}' \
      >"$T/contacts"
  read -r contacts force <"$T/contacts"
  agree VTK 'lines of vtp --network' "$(theirs lines)" "$contacts" 0
  agree VTK 'sum of their forces (N)' "$(theirs force)" "$force" 1e-10
else
  skip VTK python3-vtk9
fi

# --- numpy -------------------------------------------------------------------
if has numpy; then
  hand --format raw --cells 100 "$T/geometry" >"$T/a.raw"
  "$python" - "$T/a.raw" >"$T/read" 2>"$T/err" <<'END'
import sys, numpy
print("mean", repr(float(numpy.fromfile(sys.argv[1]).reshape(100, 100, 100)
                         .mean())))
END
  agree numpy 'mean of raw, 100^3' "$(theirs mean)" \
    "$(stated 'solid fraction')" 1e-11
else
  skip numpy python3-numpy
fi

# --- ASE ---------------------------------------------------------------------
if has ase; then
  hand --format xyz "$T/bed" >"$T/a.xyz"
  "$python" - "$T/a.xyz" >"$T/read" 2>"$T/err" <<'END'
import sys, ase.io
a = ase.io.read(sys.argv[1])
print("spheres", len(a))
print("speed", repr(float((a.arrays["velo"] ** 2).sum())))
print("volume", repr(float((a.arrays["radius"] ** 3).sum())))
END
  sums=$("$B/analyze" export --quiet --format csv "$T/bed" | awk -F , '
    NR > 1 {v += $8 ^ 2 + $9 ^ 2 + $10 ^ 2; r += $6 ^ 3}
    END {printf "%.14g %.14g", v, r}')
  agree ASE 'spheres' "$(theirs spheres)" 200 0
  hand --format xyz "$T/periodic" >"$T/periodic.xyz"
  check 'ASE: the periodic cell' [ "$("$python" -c "
import sys, ase.io
a = ase.io.read(sys.argv[1])
print(a.pbc.tolist(), a.cell.lengths()[:2].tolist())" "$T/periodic.xyz" \
    2>"$T/err")" = '[True, True, False] [1.0, 1.0]' ]
  agree ASE 'sum of velo^2 (m^2/s^2)' "$(theirs speed)" "${sums% *}" 1e-12
  agree ASE 'sum of radius^3 (m^3)' "$(theirs volume)" "${sums#* }" 1e-12
else
  skip ASE python3-ase
fi

# --- LAMMPS ------------------------------------------------------------------
if command -v lmp >/dev/null; then
  hand --format lammps-data "$T/bed" >"$T/data"
  hand --format lammps "$T/bed" >"$T/dump"
  cat >"$T/in" <<'END'
units si
atom_style sphere
boundary f f f
comm_modify vel yes
read_data data
pair_style zero 1
pair_coeff * *
neighbor 0.1 bin
read_dump dump 0 x y z vx vy vz replace yes box yes
variable m equal mass(all)
variable n equal count(all)
run 0
print "spheres ${n}" append said.lmp
print "mass ${m}" append said.lmp
thermo_style custom step ke
thermo_modify format float %.15g
run 0
END
  (cd "$T" && timeout 60 lmp -in in -log lmp.log >lmp.out 2>&1)
  check 'LAMMPS runs' [ $? = 0 ] || tail -n 5 "$T/lmp.out" >&2
  cp "$T/said.lmp" "$T/read"
  agree LAMMPS spheres "$(theirs spheres)" 200 0
  agree LAMMPS 'mass (kg)' "$(theirs mass)" 200 1e-12
  agree LAMMPS 'kinetic energy (J)' "$(awk '$1 == "Step" {on = 1; next}
    /^Loop/ {on = 0} on && NF == 2 {e = $2} END {print e}' "$T/lmp.out")" \
    "$("$B/analyze" export --quiet --format csv "$T/bed" | awk -F , '
      NR > 1 {e += $7 * ($8 ^ 2 + $9 ^ 2 + $10 ^ 2) / 2}
      END {printf "%.15g", e}')" 1e-12
else
  skip LAMMPS lammps
fi

((skipped == 0)) || echo "$skipped clients skipped" >&2
check_done
