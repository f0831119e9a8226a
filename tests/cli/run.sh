#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The program as its users meet it. Usage: run.sh PROGRAM SOURCE_DIR CASE; each case is one test.
set -u
sunder=$1 source=$2 case=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

fail() { echo "FAILED: $*" >&2; exit 1; }
expect_exit() {  # code, command… ; output in out, errors in err
  local code=$1
  shift
  "$@" > out 2> err
  local got=$?
  [ "$got" -eq "$code" ] || fail "exit $got instead of $code: $* : $(head -c 400 err)"
}
expect_text() { grep -qF -- "$2" "$1" || fail "no \"$2\" in $1: $(head -c 400 "$1")"; }
expect_files() {  # the files there are, besides out and err
  local got
  got=$(find . -mindepth 1 ! -name out ! -name err -printf '%P\n' | sort | tr '\n' ' ')
  [ "$got" = "${1:+$1 }" ] || fail "files are \"$got\" instead of \"$1\""
}
wall="--wall 6x3x0.2 --cell 0.3 --opening 0.9x2.1@1,0"

version() {
  expect_exit 0 "$sunder" --version
  expect_text out "sunder "
  expect_exit 0 "$sunder" fracture --help
  expect_text out "--jitter"
}
usage_errors() {
  expect_exit 2 "$sunder"
  [ -s out ] && fail "help belongs on standard error here"
  expect_exit 2 "$sunder" fractur
  expect_text err 'did you mean "fracture"'
  expect_exit 2 "$sunder" fracture $wall --jiter 1 -o a.glb
  expect_text err 'did you mean "--jitter"'
  expect_exit 2 "$sunder" fracture $wall -o a.gbl
  expect_text err ".glb .gltf .obj"
  expect_exit 2 "$sunder" fracture $wall -o a.glb --seed -1
  expect_exit 2 "$sunder" fracture $wall -o a.glb --seed 18446744073709551616
  expect_exit 2 "$sunder" fracture $wall
  expect_exit 2 "$sunder" fracture --wall 6x3 -o a.glb
  expect_text err "WIDTHxHEIGHTxTHICKNESS"
  expect_exit 2 "$sunder" fracture $wall -o a.glb -o ./a.glb
  expect_text err "twice"
  expect_exit 2 "$sunder" schema scenes
  expect_files ""
}
bad_input() {
  expect_exit 3 "$sunder" fracture $wall --jitter 1.4 -o a.glb
  expect_text err "/walls/0/pattern/jitter"
  expect_exit 3 "$sunder" fracture missing.json -o a.glb
  echo '{"sunder": 1, "walls": [{"thicknes": 1}]}' > bad.json
  expect_exit 3 "$sunder" fracture bad.json -o a.glb
  expect_text err 'bad.json:1: /walls/0/thicknes'
  expect_text err 'did you mean "thickness"'
  expect_exit 3 "$sunder" fracture --wall 6x3x0.2 --opening 1x1@5.5,1 -o a.glb
  expect_text err "outline"
  expect_exit 3 "$sunder" fracture --wall 1e4x1e4x0.2 --cell 0.001 -o a.glb
  expect_exit 3 "$sunder" check bad.glb
  printf 'glTF garbage' > bad.glb
  expect_exit 3 "$sunder" check bad.glb
  expect_files "bad.glb bad.json"
}
cannot_write() {
  expect_exit 4 "$sunder" fracture $wall -o nowhere/a.glb
  expect_text err "nowhere"
  mkdir a.glb
  expect_exit 4 "$sunder" fracture $wall -o a.glb
  rmdir a.glb
  "$sunder" fracture $wall --json -q > /dev/full 2> err
  [ $? -eq 4 ] || fail "a full standard output is an error"
  (ulimit -f 8; "$sunder" fracture $wall -o a.glb > out 2> err)
  [ $? -eq 4 ] || fail "a file size limit is an error: $(cat err)"
  expect_files ""
}
same_bytes() {
  for n in 1 2 7; do
    expect_exit 0 "$sunder" fracture "$source/data/scenes/room.json" --threads $n -o $n.glb -o $n.obj -o $n.svg
  done
  expect_exit 0 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2_Usable,-AVX2 \
    "$sunder" fracture "$source/data/scenes/room.json" -o f.glb -o f.obj -o f.svg
  for suffix in glb obj svg; do
    sed -i 's/^mtllib .*//' ./*.obj
    for n in 2 7 f; do cmp 1.$suffix $n.$suffix || fail "$suffix differs with $n"; done
  done
}
seeds_differ() {
  expect_exit 0 "$sunder" fracture $wall --seed 1 -o 1.glb
  expect_exit 0 "$sunder" fracture $wall --seed 2 -o 2.glb
  cmp -s 1.glb 2.glb && fail "the seed changes nothing"
  expect_exit 0 "$sunder" fracture $wall --seed 1 --set walls.0.pattern.jitter=0 -o 3.glb
  cmp -s 1.glb 3.glb && fail "--set changes nothing"
  return 0
}
reports_agree() {
  expect_exit 0 "$sunder" fracture $wall -o a.glb -o a.obj --report a.json
  hash=$(grep '"hash"' a.json)
  for file in a.glb a.obj; do
    expect_exit 0 "$sunder" check $file --json
    expect_text out "$hash"
  done
  expect_exit 0 "$sunder" fracture $wall --json
  [ "$(head -c 1 out)" = "{" ] || fail "--json prints something else first"
  expect_exit 0 "$sunder" fracture $wall -o b.glb --quiet
  [ -s out ] || [ -s err ] && fail "--quiet prints something"
  expect_exit 0 "$sunder" fracture $wall -o p.svg -o p.json
  expect_text p.json '"chunks"'
}
scenes_are_sound() {
  for scene in "$source"/data/scenes/*.json; do
    expect_exit 0 "$sunder" fracture "$scene" -o s.glb -o s.obj --report s.json
    expect_text s.json '"sound": true'
    expect_exit 0 "$sunder" check s.glb s.obj
  done
}
planted_faults() {
  expect_exit 0 "$sunder" fracture $wall -o a.obj
  awk '/^v / && ++n == 100 {$2 += 0.01} {print}' a.obj > moved.obj
  expect_exit 1 "$sunder" check moved.obj
  expect_text out "no partner"
  awk '/^f / && ++n == 50 {next} {print}' a.obj > face.obj
  expect_exit 1 "$sunder" check face.obj
  expect_text out "1 chunks are open"
  awk '/^f / && ++n == 50 {print $1, $3, $2, $4; next} {print}' a.obj > flipped.obj
  expect_exit 1 "$sunder" check flipped.obj
  awk '/^o / {skip = ($2 ~ /_0040$/)} skip && /^[fo] / {next} {print}' a.obj > missing.obj
  expect_exit 1 "$sunder" check missing.obj
  expect_text out "no partner"
  awk '/^o / {inside = ($2 ~ /_0040$/)} inside && /^v / {$2 += 0.02} {print}' a.obj > overlap.obj
  expect_exit 1 "$sunder" check overlap.obj
  expect_text out "overlap"
}
interrupt() {
  "$sunder" fracture --wall 100x100x0.2 --cell 0.05 -o big.glb --quiet 2> err &
  local pid=$!
  sleep 0.4
  kill -INT $pid
  wait $pid
  [ $? -eq 130 ] || fail "exit code after an interrupt"
  expect_files ""
}
same_input() {
  cp "$source/data/scenes/facade.json" scene.json
  expect_exit 2 "$sunder" fracture scene.json -o scene.json
  expect_text err "overwrite"
  expect_exit 0 "$sunder" fracture scene.json -o out.svg --set seed=9
  expect_text err "seed 9"
}
schemas() {
  for which in scene material report; do
    expect_exit 0 "$sunder" schema $which
    expect_text out "json-schema.org/draft-07"
  done
}

"$case"
