#!/bin/bash
# The pages are in step with the captions they include, and every file that they
# name is there.
set -u
passed=0 failed=0
report() { # NAME STATUS
  if [ "$2" = 0 ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "failed: $1"
  fi
}
included=0
for page in README.md docs/*.md; do
  awk -f docs/include.awk "$page" | cmp -s - "$page"
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
T=$(mktemp -d)
trap 'rm -rf "$T"' EXIT
printf '<!-- docs/none.md -->\n<!-- end -->\n' > "$T/page"
! awk -f docs/include.awk "$T/page" > /dev/null 2>&1
report 'a missing caption passes' $?
echo "$passed passed, $failed failed"
((failed == 0))
