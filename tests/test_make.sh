#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The makefiles: each variable is assigned in one place, so that no file
# changes what another one means; nothing that make 3.81 does not know.
. tests/harness.sh

makefiles=(Makefile)
while IFS= read -r file; do
  makefiles+=("$file")
done < <(find plots -name '*.mk' | sort)

# assigned FILE...: one line "NAME FILE:LINE BRANCH" for each assignment.
# Variables of one target are not counted; alternatives of a conditional have
# different branches. Names made by rules are taken as they are written.
assigned() {
  awk '
    function count(name) { print name, FILENAME ":" FNR, branch() }
    function branch(  k, b) {
      b = "-"
      for (k = 1; k <= depth; k++) b = b open[k] "." part[k] "-"
      return b
    }
    FNR == 1 { depth = 0 }
    {
      rest = $0
      while (match(rest, /\(eval [^ :=?+]+ *[:?+]?=/)) {
        name = substr(rest, RSTART + 6, RLENGTH - 6)
        sub(/ *[:?+]?=$/, "", name)
        count(name)
        rest = substr(rest, RSTART + RLENGTH)
      }
    }
    /^\t/ || /^#/ { next }
    /^ *if(n?eq|n?def)/ { open[++depth] = FILENAME ":" FNR; part[depth] = 1 }
    /^ *else/ { part[depth]++ }
    /^ *endif/ { depth-- }
    match($0, /^ *(override |export )*[A-Za-z0-9_.$(){},%-]+ *[:?+]?=/) {
      name = substr($0, RSTART, RLENGTH)
      gsub(/^ *|(override |export )|[:?+]?=$| *$/, "", name)
      sub(/ *[:?+]?=$/, "", name)
      count(name)
    }
    /^define / { count($2) }' "$@"
}

# twice FILE...: the assignments of variables that have more than one, unless
# all are alternatives of one conditional
twice() {
  assigned "$@" | sort | awk '
    {
      place[$1] = place[$1] " " $2
      n[$1]++
      if (index(seen[$1], " " $3 " ")) same[$1] = 1
      seen[$1] = seen[$1] " " $3 " "
      where = $3
      sub(/\.[0-9]+-$/, "", where)
      if (n[$1] > 1 && where != first[$1]) same[$1] = 1
      first[$1] = where
    }
    END { for (v in n) if (n[v] > 1 && same[v]) print v ":" place[v] }' | sort
}

twice "${makefiles[@]}" >"$T/err"
check 'a variable is assigned twice' test ! -s "$T/err"

# what it says of some lines
cat >"$T/a.mk" <<'END'
ONCE := 1
TWICE := 1
ifeq ($(X),)
EITHER := 1
else
EITHER := 2
endif
ifeq ($(X),)
NESTED := 1
endif
ifeq ($(X),)
NESTED := 2
endif
target: ONCE := 2
recipe:
	TWICE=3
$(foreach s,a b,$(eval MADE_$(s) := 1))
END
printf 'TWICE += 2\nMADE_$(s) = 2\n' >"$T/b.mk"
check 'twice finds what is assigned twice, and no more' test \
  "$(twice "$T/a.mk" "$T/b.mk" | cut -d : -f 1 | tr '\n' ' ')" = \
  'MADE_$(s) NESTED TWICE '

grep -n '&:' "${makefiles[@]}" >"$T/err"
check 'a grouped target (&:), which make 3.81 does not know' \
  test ! -s "$T/err"

check_done
