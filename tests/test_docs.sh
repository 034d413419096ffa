#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The pages are in step with the captions they include, and every file that they
# name is there.
. tests/harness.sh

report() { # NAME STATUS
  check "$1" test "$2" = 0
}

included=0
pages="README.md CONTRIBUTING.md docs/*.md"
for page in $pages; do
  awk -f plots/captions.awk "$page" | cmp -s - "$page"
  report "$page: captions are not those of docs/ (make readme)" $?
  n=$(grep -c '^<!-- docs/' "$page")
  included=$((included + n))
  dir=$(dirname "$page")
  for link in $(grep -o '](\([^)#:]*\))' "$page" | tr -d '()]'); do
    # a caption's links are from the page that includes it
    [ -e "$dir/$link" ] || [ -e "$link" ]
    report "$page: no file $link" $?
  done
done
((included > 0))
report 'no page includes a caption' $?
printf '<!-- docs/none.md -->\n<!-- end -->\n' > "$T/page"
! awk -f plots/captions.awk "$T/page" > /dev/null 2>&1
report 'a missing caption passes' $?
check_done
