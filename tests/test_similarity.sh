#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Beds are alike: lengths by 4^k and masses by 2^j, with times by 2^k, give the
# same bed to the last bit, since every number of it changes by a power of two.
# A line of the code that mixes units breaks that.
. tests/harness.sh

# similar NAME A B LENGTH TIME MASS: every number of bed B is that of A, scaled
similar() {
  awk -v l="$4" -v s="$5" -v m="$6" '
    FNR == 1 { file++ }
    /^# t=/ { t = substr($0, 5) }
    !/^[0-9]/ { next }
    file == 1 { row[++rows] = t "\t" $0; next }
    {
      if (split(row[++others], a, "\t") != NF + 1) { bad++; next }
      bad += t + 0 != a[1] * s
      for (c = 1; c <= NF; c++) {
        unit = c == 1 ? 1 : c <= 5 ? l : c == 6 ? m : c <= 9 ? l / s : 1 / s
        bad += $c + 0 != a[c + 1] * unit
      }
    }
    END { exit !(rows > 0 && others == rows && !bad) }
  ' "$2" "$3"
  check "$1: another bed" test $? = 0
}

run() { # FILE OPTION...
  "$B"/settle --quiet --count 40 --frames 3 "${@:2}" > "$T/$1" 2> "$T/err"
  check "settle ${*:2}" test $? = 0
}

for model in basic friction rotation; do
  for method in rkc multirate verlet dopri5 rk8pd rkf45 rkck merson; do
    said="$model, $method"
    more=() small=() large=()
    case $method in
      rkc | multirate) ;;
      verlet) more=(--step 1e-4) small=(--step 0.125e-4) large=(--step 4e-4) ;;
      *) more=(--control standard --tol 1e-3)
        small=(--control standard --tol 0.125e-3)
        large=(--control standard --tol 4e-3) ;;
    esac
    options=(--model $model --method $method)
    run a "${options[@]}" "${more[@]}" --time 0.6
    run b "${options[@]}" "${small[@]}" --time 0.075 \
      --radius 0.0015625 --mass 0.25 # 4^-3, 2^-2
    similar 'small spheres' "$T/a" "$T/b" 0.015625 0.125 0.25
    run c "${options[@]}" "${large[@]}" --time 2.4 --radius 1.6 --mass 1024
    similar 'large spheres' "$T/a" "$T/c" 16 4 1024
  done
done

# Without --time and --tol too, and at rest.
said=
run a --count 16 --until-rest --time 30
run b --count 16 --until-rest --time 3.75 --radius 0.0015625
similar 'until rest' "$T/a" "$T/b" 0.015625 0.125 1
run a --time 0 && run b --time 0 --radius 0.0015625
header() { # FILE KEY
  sed -n "s/^# $2=//p" "$T/$1" | head -n 1
}
for key in kappa:9600:150 f0:10:10 psi:80:10 vmin:0.00125:0.01 \
  lmax:0.0015625:0.1 drop:0.0171875:1.1 base:0.015625,0.015625:1,1 \
  tol:0.00025:0.002 hinit:0.0125:0.1; do
  IFS=: read -r name small paper <<< "$key"
  check "$name of small spheres is $(header b "$name")" \
    test "$(header b "$name")" = "$small"
  check "$name of the paper's is $(header a "$name")" \
    test "$(header a "$name")" = "$paper"
done

# Gravity is in it: four times as strong, half the time.
run a --time 0.6
run b --time 0.3 --gravity 39.24
awk '/^# (f0|psi|vmin|tol|hinit)=/' "$T/b" > "$T/strong"
check 'strong gravity' cmp -s "$T/strong" <(printf '# %s\n' f0=40 psi=5 \
  vmin=0.02 tol=0.004 hinit=0.05)

# A density is a mass; what is given is taken as it is.
run a --time 0 --radius 0.001 --density 2500
within 'mass by density' "$(awk '/^0/ { print $6; exit }' "$T/a")" 1.0471975e-05 \
  1.0471976e-05
run a --time 0 --radius 0.001 --kappa 150
check 'a given kappa' test "$(header a kappa)" = 150
! "$B"/settle --mass 1 --density 2 > "$T/a" 2> "$T/err"
check 'mass and density' test $? = 0

# A scene's spheres count as well, where its header leaves things open.
printf 'x,y,z,r\n0.005,0.005,0.003,0.0015625\n' > "$T/s.csv"
"$B"/settle --quiet --scene "$T/s.csv" --wall 0,0,0,0,0,-1 --time 0.01 \
  > "$T/b" 2> "$T/err"
check 'a scene of small spheres' test "$(header b kappa)" = 9600
check_done
