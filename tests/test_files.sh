#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Outputs: where they end up, what of the old file stays, and what they must not
# be. analyze export writes most of them here, settle those beside a bed.
. tests/harness.sh

D=$T/d
mkdir "$D"
printf 'x,y,z,r\n0,0,0,1\n3,0,0,1\n' >"$T/bed.csv"
cp "$T/bed.csv" "$D/bed.csv"
"$B/analyze" export --format positions "$T/bed.csv" >"$T/good"

write() { # OUTPUT [INPUT]: exports to it
  timeout 20 "$B/analyze" export --format positions --quiet --output "$1" \
    "${2:-$T/bed.csv}" >"$T/out" 2>"$T/err" </dev/null
  status=$?
}
written() { # NAME FILE: the file is what was to be written
  check "$1: exit status $status" test "$status" = 0
  check "$1: complete" cmp -s "$2" "$T/good"
  check "$1: nothing beside it" test -z "$(ls -d "$D"/*partial* 2>/dev/null)"
}
mode() {
  ls -ld "$1" | cut -c 1-10
}
refused() { # NAME STATUS PATTERN: of what ran last
  check "$1: exit status $status" test "$status" = "$2"
  check "$1: one line" test "$(grep -Ec "$3" "$T/err")" = 1 -a \
    "$(wc -l <"$T/err")" = 1
  check "$1: nothing beside it" test -z "$(ls -d "$D"/*partial* 2>/dev/null)"
}

# --- links and modes ----------------------------------------------------------
umask 022
write "$D/new"
written 'a new file' "$D/new"
check 'a new file: the mode of others' test "$(mode "$D/new")" = -rw-r--r--
chmod 600 "$D/new"
write "$D/new"
written 'written again' "$D/new"
check 'written again: its mode' test "$(mode "$D/new")" = -rw-------
chmod 640 "$D/new"
mkdir "$D/far"
ln -s ../old "$D/far/link"
ln -s far/link "$D/link"
echo old >"$D/old"
write "$D/link"
written 'through two links' "$D/old"
check 'the links stay' test -L "$D/link" -a -L "$D/far/link"
rm "$D/old"
write "$D/link"
written 'through links to nothing yet' "$D/old"
check 'the links stay' test -L "$D/link" -a -L "$D/far/link"
ln -s "$D/old" "$D/absolute"
write "$D/absolute"
written 'through a link from the root' "$D/old"
bin=$(cd "$B" && pwd) # B may be a path from here or from the root
(cd "$D" && timeout 20 "$bin/analyze" export --format positions \
  --quiet --output plain bed.csv 2>"$T/err")
status=$?
written 'a name without a directory' "$D/plain"
ln -s circle "$D/circle"
write "$D/circle"
refused 'a circle of links' 1 "circle: .*links"
echo kept >"$D/hard"
ln "$D/hard" "$D/other"
write "$D/hard"
check 'a file of two names: written' cmp -s "$D/hard" "$T/good"
check 'a file of two names: the other keeps' test "$(cat "$D/other")" = kept
check 'a file of two names: said so' grep -q 'hard: .*1 other name.* keeps' \
  "$T/err"
echo old >"$D/mine"
if [[ $(id -u) == 0 ]]; then
  chown 12345:54321 "$D/mine"
  write "$D/mine"
  check 'root keeps the owner' test "$(ls -ln "$D/mine" | awk '{print $3, $4}')" \
    = '12345 54321'
else
  chmod 400 "$D/mine"
  write "$D/mine"
  refused 'a file that is not to be written' 1 'mine: Permission denied'
  check 'and is not' test "$(cat "$D/mine")" = old
fi

# --- what is no regular file --------------------------------------------------
mkfifo "$T/fifo"
cat "$T/fifo" >"$T/through" &
write "$T/fifo"
wait $!
check 'a pipe with a name' cmp -s "$T/through" "$T/good"
check 'it is still one' test -p "$T/fifo"
# by a link of our own, for a mistake of a program that root tests
ln -s /proc/self/fd/2 "$T/stderr"
exec 3>"$T/err"
timeout 20 "$B/settle" --quiet --count 2 --time 0.01 --stats "$T/stderr" \
  >"$T/out" 2>&3
check "/dev/stderr is still the same file" test "$T/err" -ef /dev/fd/3
exec 3>&-
check "/dev/stderr is no place for a file beside it" grep -q "^t_end" "$T/err"
write "$D/far"
refused 'a directory' 1 'far: Is a directory'
write "$T/none/x"
refused 'no such directory' 1 'none/x: No such'
write -
refused 'a dash' 2 '^analyze: -: expected the name of a file'

# --- what is in use already ---------------------------------------------------
write "$D/bed.csv" "$D/bed.csv"
refused 'the input' 2 'bed.csv: expected another file'
check 'the input is as it was' cmp -s "$D/bed.csv" "$T/bed.csv"
ln -s bed.csv "$D/alias"
write "$D/alias" "$D/bed.csv"
refused 'the input by another name' 2 'alias: expected another file'
ln "$D/bed.csv" "$D/twin"
write "$D/twin" "$D/bed.csv"
refused 'the input by a hard link' 2 'twin: expected another file'
check 'the input is as it was' cmp -s "$D/bed.csv" "$T/bed.csv"
rm "$D/twin"
timeout 20 "$B/analyze" export --format positions --output "$D/bed.csv" \
  <"$D/bed.csv" >"$T/out" 2>"$T/err"
status=$?
refused 'the input by standard input' 2 'expected another file'
check 'the input is as it was' cmp -s "$D/bed.csv" "$T/bed.csv"
for verb in fraction order rest gr 'radius --report'; do
  # shellcheck disable=SC2086 # several words
  timeout 20 "$B/analyze" $verb "$D/bed.csv" >>"$D/bed.csv" 2>"$T/err"
  status=$?
  refused "$verb: appended to its input" 2 'bed.csv: expected another file'
  check "$verb: the input is as it was" cmp -s "$D/bed.csv" "$T/bed.csv"
done
settle=("$B/settle" --quiet --count 2 --time 0.01)
timeout 20 "${settle[@]}" --log "$D/x" --stats "$D/x" >"$T/out" 2>"$T/err"
status=$?
refused 'two outputs, one new file' 2 'x: expected another file.*already'
check 'neither is there' test ! -e "$D/x"
echo old >"$D/x"
ln -s x "$D/y"
timeout 20 "${settle[@]}" --log "$D/x" --stats "$D/y" >"$T/out" 2>"$T/err"
status=$?
refused 'two outputs, one old file' 2 'expected another file'
check 'it is as it was' test "$(cat "$D/x")" = old
(cd "$D" && timeout 20 "$bin/settle" "${settle[@]:1}" --log z \
  --stats ../d/z >"$T/out" 2>"$T/err")
status=$?
refused 'two outputs, one new file by two paths' 2 'expected another file'
timeout 20 "${settle[@]}" --log "$T/stderr" --stats "$T/stderr" 2>&1 >"$T/out" |
  cat >"$T/both"
check 'what is no regular file may be more than one' test \
  "$(grep -c -e ^t_end -e ^method -e kinetic "$T/both")" = 3

# A name is given to a file that is on the disk, and the directory after that.
if command -v strace >/dev/null &&
  strace -o "$T/trace" -e trace=fsync,rename true 2>/dev/null; then
  export ASAN_OPTIONS=detect_leaks=0 # LeakSanitizer traces as well
  strace -f -y -o "$T/trace" -e trace=fsync,rename,renameat,renameat2 \
    "$B/analyze" export --format positions --quiet --output "$D/new" \
    "$T/bed.csv" 2>"$T/err"
  check 'fsync, rename, fsync of the directory' awk -v d="$D" '
    /fsync/ && /partial/ && / = 0$/ {file = NR}
    /rename/ && / = 0$/ {name = NR}
    /fsync/ && index($0, d ">") && / = 0$/ {directory = NR}
    END {exit !(file && file < name && name < directory)}' "$T/trace"
  strace -f -o "$T/trace" -e trace=fsync -e inject=fsync:error=EIO \
    "$B/analyze" export --format positions --quiet --output "$D/plain" \
    "$T/bed.csv" >"$T/out" 2>"$T/err"
  status=$?
  refused 'a disk that fails' 1 'plain: (Input/output|I/O) error'
else
  echo 'skipped: fsync before rename (strace is not installed, or may not trace)'
fi
check_done
