# SPDX-License-Identifier: GPL-3.0-or-later
# Puts the contents of docs/NAME.md between a page's lines
#   <!-- docs/NAME.md --> ... <!-- end -->
# so that a caption is written once, beside its figure: awk -f plots/captions.awk
# README.md. Links of a caption are from docs/; in a page elsewhere they get
# that folder. Exits with 1 if there is no such file, or no end.
function put(line) {
  if (FILENAME !~ /^docs\//) {
    gsub(/\]\(/, "](docs/", line)
    gsub(/\]\(docs\/http/, "](http", line)
  }
  print line
}
/^<!-- docs\/[a-z0-9.-]+\.md -->$/ {
  print
  if ((getline line < $2) <= 0) {
    print FILENAME ":" FNR ": " $2 ": missing or empty" > "/dev/stderr"
    failed = 1
  } else
    put(line)
  while ((getline line < $2) > 0)
    put(line)
  close($2)
  inside = 1
  next
}
/^<!-- end -->$/ { inside = 0 }
!inside { print }
END {
  if (inside)
    print FILENAME ": no <!-- end -->" > "/dev/stderr"
  exit failed || inside
}
