#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The pages' places for what benchmarks print, and the benchmarks, name each other; every number of
# the README has its table. Usage: tests/bench_docs.sh ROOT
set -euo pipefail
cd "$1"
faults=0
fault() {
  echo "$*" >&2
  faults=$((faults + 1))
}

benches=$(sed -n 's/^sunder_bench(\([a-z_]*\) .*/\1/p' bench/CMakeLists.txt)
places=$(sed -n 's/^<!-- bench: \(.*\) -->$/\1/p' docs/*.md)
# Names of blocks as the sources have them: "pattern window".
printed=$(grep -hoE "\"($(tr '\n' '|' <<< "$benches" | sed 's/|$//')) [a-z0-9-]+\"" bench/*.cpp bench/*.js |
  tr -d '"' | sort -u)
printed+=$'\nstress'  # ./dev stress docs

for bench in $benches; do
  grep -q "^$bench " <<< "$places" || fault "no page shows anything of ./dev bench $bench"
  grep -qE "^$bench,[^,]*,[0-9]+,[0-9a-f]{7,}\+?," docs/bench/runs.csv ||
    fault "docs/bench/runs.csv does not tell the commit of ./dev bench $bench"
done
for results in docs/bench/*.csv; do
  head -1 "$results" | grep -q ',commit,' || fault "$results has no column for the commit"
  if tail -n +2 "$results" | grep -qvE ',[0-9a-f]{7,}\+?,"[^"]*",[0-9-]{10}$'; then
    fault "$results has a line without its commit"
  fi
done
while read -r place; do
  grep -qxF "$place" <<< "$printed" || fault "a page waits for \"$place\", which no bench prints"
done <<< "$places"
while read -r block; do
  grep -qxF "$block" <<< "$places" || fault "no page has a place for \"$block\""
done <<< "$printed"
repeated=$(sort <<< "$places" | uniq -d)
[ -z "$repeated" ] || fault "more than one place for: $repeated"

for page in docs/*.md; do
  awk '/^<!-- bench: / { if (open) exit 1; open = 1 } /^<!-- end -->$/ { if (!open) exit 1; open = 0 }
       END { if (open) exit 1 }' "$page" || fault "$page: a block does not end, or ends twice"
  while read -r picture; do
    [ -f "docs/$picture" ] || fault "$page shows docs/$picture, which is not there"
  done < <(sed -n 's/.*<img src="\([^"]*\)".*/\1/p' "$page")
done

# | claim in the README | block | page |
claims=$(sed -n '/^<!-- readme numbers -->$/,/^<!-- end of readme numbers -->$/p' docs/performance.md |
  grep '^|' | tail -n +3)
[ -n "$claims" ] || fault "docs/performance.md lacks the table of the README's numbers"
readme=$(tr -s '\n ' '  ' < README.md)
while IFS='|' read -r _ claim source _; do
  claim=$(sed 's/^ *//; s/ *$//' <<< "$claim")
  grep -qF -- "$claim" <<< "$readme" || fault "the README no longer says \"$claim\""
  block=$(sed -n 's/.*`\([a-z_]* [a-z0-9-]*\)`.*/\1/p' <<< "$source")
  [ -z "$block" ] || grep -qxF "$block" <<< "$places" || fault "\"$claim\": no place for \"$block\""
done <<< "$claims"
exit $((faults > 0))
