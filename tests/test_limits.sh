#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What does not fit into memory or on the disk is said before the work, and memory
# that fails in the middle of it ends a program with exit status 1 and no numbers.
. tests/harness.sh
. tests/faults.sh

"$B/settle" --quiet --count 40 --base 0.5,0.5 --time 0.5 --frames 2 >"$T/bed"

# --- memory, before the run ---------------------------------------------------
refused 1 '100000000 spheres with --method multirate take about 361 GB of memory, 3.6 kB each, and' \
  "$B/settle" --count 100000000
if ! sanitized 'limits of memory'; then
  refused 1 'ulimit -v has 1.02 GB: expected fewer spheres' \
    bash -c "ulimit -v 1000000; '$B/settle' --count 1000000 --method rkc"
  # without spin
  refused 1 '--method rkc take about 1.21 GB of memory, 1.2 kB each' \
    bash -c "ulimit -v 1000000; '$B/settle' --count 1000000 --method rkc --model basic"
  check 'what fits is not refused' bash -c "ulimit -v 1000000
    '$B/settle' --quiet --count 1000 --base 3,3 --time 0 >'$T/out'"
fi

# --- the disk, before the first voxel -------------------------------------------
for format in raw vti mhd palabos; do
  rm -f "$T"/voxels*
  refused 1 "$T/voxels.mhd: takes " "$B/analyze" export --format $format \
    --cells 100000 --output "$T/voxels.mhd" "$T/bed"
  check "$format: nothing is left" [ -z "$(find "$T" -name 'voxels*')" ]
done
while read -r format; do
  # shellcheck disable=SC2086
  "$B/analyze" export --quiet --format $format --output "$T/small" "$T/bed"
  size=$(wc -c <"$T/small")
  check "$format: with as much as it takes" bash -c "ulimit -f $((size / 1024 + 1))
    '$B/analyze' export --quiet --format $format --output '$T/same' '$T/bed'"
  # but for the name of the output in the command line
  check "$format: the same file" cmp -s <(grep -av '^<?origin' "$T/small") \
    <(grep -av '^<?origin' "$T/same")
  refused 1 'and ulimit -f has room for 1.02 kB' bash -c "ulimit -f 1
    '$B/analyze' export --format $format --output '$T/no' '$T/bed'"
  check "$format: no half of it" [ ! -e "$T/no" ]
done <<'END'
stl
stl --merged --cells 10
csv
vtp
raw --cells 10
palabos --cells 10
END
check 'a pipe has room' [ "$("$B/analyze" export --quiet --format raw --binary \
  --cells 20 "$T/bed" | wc -c)" = 8000 ]
# --- memory that fails in the middle --------------------------------------------
if make_faults; then
  from=1 tried=0 wrong=0
  for verb in fraction rest 'radius --report' gr 'export --format raw --cells 4'; do
    fail_memory "$verb" "$T/bed" $from 29
    from=$((from + 5))
  done
  check "memory that fails: $wrong of $tried are wrong" [ $wrong = 0 -a $tried -gt 40 ]
fi
check_done
