#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Puts what a benchmark printed between `<!-- bench: NAME -->` and `<!-- end -->` in the place of what
# stands between the same lines of pages. Fails if a block has no place; the others are put in all
# the same. Usage: bench/into_docs.sh PRINTED.md PAGE.md…
set -euo pipefail
printed=$1
shift
status=0
while read -r name; do
  grep -qxF "<!-- bench: $name -->" "$@" || {
    echo "no page has the line <!-- bench: $name -->" >&2
    status=1
  }
done < <(sed -n 's/^<!-- bench: \(.*\) -->$/\1/p' "$printed")
for page in "$@"; do
  awk '
    /^<!-- bench: .* -->$/ { name = $0 }
    FNR == NR {
      if (/^<!-- end -->$/) name = ""
      else if (name != "" && name != $0) block[name] = block[name] $0 "\n"
      next
    }
    /^<!-- bench: .* -->$/ { print; if (name in block) { printf "%s", block[name]; skips = 1 }; next }
    /^<!-- end -->$/ { skips = 0 }
    !skips
  ' "$printed" "$page" > "$page.new"
  if cmp -s "$page" "$page.new"; then rm "$page.new"; else mv "$page.new" "$page"; fi
done
exit $status
