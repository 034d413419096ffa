# SPDX-License-Identifier: GPL-3.0-or-later
# A tab-separated table with a line of names as Markdown. Later blocks repeat
# the names; they are left out.
BEGIN { FS = "\t" }
/^#/ || NF == 0 { next }
{
  line = "|"
  for (k = 1; k <= NF; k++) line = line " " $k " |"
}
!names { names = $0; print line; gsub(/[^|]+/, "---", line); print line; next }
$0 == names { next }
{ print line }
