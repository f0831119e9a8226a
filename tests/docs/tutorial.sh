#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Follows a tutorial: runs each line of its ```sh blocks that calls sunder, in a scratch folder with
# the data of the source, and looks for what it prints and writes.
#   tutorial.sh PROGRAM SOURCE_DIR FILE.md
# A line that ends in "# exit 3" ends so; each line of a ```text block below is printed by the block
# above ("…" alone stands for lines that are left out). Lines that ask for what this program's --help
# does not know (a verb "view", a suffix ".html") are left out.
set -u
sunder=$1 source=$2 tutorial=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
ln -s "$source/data" data
mkdir bin
ln -s "$sunder" bin/sunder
PATH=$work/bin:$PATH
fail() { echo "FAILED: $*" >&2; exit 1; }

is_known() {  # the line's verb and what its options write
  local verb help
  verb=$(awk '{print $2}' <<< "$1")
  "$sunder" --help | grep -q "^  $verb " || return 1
  [ "$verb" = view ] && return
  help=$("$sunder" "$verb" --help)
  [[ ! $1 =~ --report\ [^\ ]*\.html ]] || grep -e --report <<< "$help" | grep -qF html || return 1
  [[ ! $1 =~ -o\ [^\ ]*\.html ]] || grep -e --output <<< "$help" | grep -qF html
}

run() {  # line
  local expected=0 got words i
  [[ $1 =~ \#\ exit\ ([0-9]+)$ ]] && expected=${BASH_REMATCH[1]}
  is_known "$1" || { echo "left out: $1"; return; }
  bash -c "$1" >> said 2>&1
  got=$?
  [ $got -eq "$expected" ] || fail "exit $got instead of $expected: $1: $(tail -c 600 said)"
  [ "$expected" -eq 0 ] || return
  eval "words=(${1%%#*})"
  for ((i = 1; i < ${#words[@]}; i++)); do
    case ${words[i - 1]} in
      -o | --output | --report | --history)
        [ -s "${words[i]}" ] || fail "${words[i]} is not there after: $1" ;;
    esac
  done
  ran=$((ran + 1))
}

ran=0 compared=0 block='' line=''
: > said
while IFS= read -r text; do
  case $text in
    '```sh') block='sh'; : > said; continue ;;
    '```text') block='text'; continue ;;
    '```'*) [ -n "$block" ] && block='' || block=other; continue ;;
  esac
  if [ "$block" = sh ]; then
    line+=$text
    if [[ $line == *\\ ]]; then line=${line%\\}; continue; fi
    [[ $line == sunder\ * ]] && run "$line"
    line=''
  elif [ "$block" = text ] && [ -s said ] && [ "${text// /}" != "…" ]; then
    grep -qxF -- "$text" said || fail "\"$text\" is not printed, but: $(head -c 1500 said)"
    compared=$((compared + 1))
  fi
done < "$tutorial"
[ -z "$block" ] || fail "a block does not end"
if [ $ran -lt 5 ] || [ $compared -lt 1 ]; then fail "only $ran commands ran, $compared lines compared"; fi
echo "$ran commands, $compared lines of output"
