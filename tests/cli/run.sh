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

# A cube of 1 m as OBJ; an argument leaves that many of its faces out.
put_cube() {  # file [faces left out]
  {
    printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
    printf 'f %s\n' '1 4 3 2' '5 6 7 8' '1 2 6 5' '4 8 7 3' '1 5 8 4' '2 3 7 6' |
      tail -n +$((1 + ${2:-0}))
  } > "$1"
}

solids() {
  put_cube cube.obj
  local n pattern
  for pattern in "--chunks 30" "--chunks 20 --near 0,0,0 --near 1,1,1 --radius 0.4 --share 0.8" \
    "--sites 0.2,0.2,0.2;0.8,0.8,0.8 --sites 0.5,0.5,0.9" \
    "--pattern slices --slices 2x1x3 --offset-variation 0.3 --angle-variation-deg 5" \
    "--pattern radial --centre 0.5,0.5,0.5 --axis 0,0,1 --rays 7 --rings 2 --radius 0.4" \
    "--pattern brick --brick 0.5x0.25x0.5 --offset 0.5 --mortar 0.02"; do
    # shellcheck disable=SC2086
    expect_exit 0 "$sunder" fracture cube.obj $pattern --material brick --name crate -o a.glb \
      -o a.obj -o a.stl --report a.json
    expect_text a.json '"sound": true'
    for n in a.glb a.obj a.stl; do expect_exit 0 "$sunder" check $n; done
  done
  for n in 1 2 5; do
    expect_exit 0 "$sunder" fracture cube.obj --chunks 40 --threads $n -o $n.glb -o $n.svg
  done
  for n in 2 5; do
    cmp 1.glb $n.glb && cmp 1.svg $n.svg || fail "$n threads change the bytes"
  done
  cat > s.json << END
{"sunder": 1, "walls": [{"outline": {"rect": [2, 1]}}],
 "solids": [{"file": "cube.obj", "scale": 0.5, "position": [0, 0, 2], "pattern":
   {"type": "voronoi", "chunks": 9}}]}
END
  expect_exit 0 "$sunder" fracture s.json -o s.glb --report s.json.json
  expect_exit 0 "$sunder" check s.glb
  expect_exit 0 "$sunder" fracture s.json --set solids.0.pattern.chunks=2 -o t.glb
  expect_exit 2 "$sunder" fracture s.json -o cube.obj
  expect_text err "would overwrite the input"
}

hulls() {
  local mode name size="--wall 3x2x0.2 --cell 0.5 --opening 0.9x1.1@1,0"
  # shellcheck disable=SC2086
  expect_exit 0 "$sunder" fracture $size -o plain.glb -o plain.obj
  # shellcheck disable=SC2086
  expect_exit 0 "$sunder" fracture $size --hulls none -o none.glb --hull-error 0.5 --max-hulls 3
  cmp plain.glb none.glb || fail "no hulls change the bytes"
  for mode in ucx:UCX_wall_chunk_0000_00 convcol:wall_chunk_0000_00-convcolonly; do
    name=${mode#*:}
    # shellcheck disable=SC2086
    expect_exit 0 "$sunder" fracture $size --hulls ${mode%:*} -o h.glb -o h.gltf -o h.obj
    expect_text err " hulls, at most "
    expect_text h.gltf "\"name\":\"$name\""
    expect_text h.obj "o $name"
    for file in glb gltf obj; do
      expect_exit 0 "$sunder" check h.$file --report h.json
      "$sunder" check plain.glb --report plain.json > out
      for key in chunks triangles; do
        [ "$(grep "\"$key\"" h.json)" = "$(grep "\"$key\"" plain.json)" ] ||
          fail "check counts hulls as $key in h.$file"
      done
    done
    # shellcheck disable=SC2086
    expect_exit 0 "$sunder" fracture $size --hulls ${mode%:*} --threads 3 -o i.glb
    cmp h.glb i.glb || fail "threads change the hulls"
  done
  # shellcheck disable=SC2086
  expect_exit 0 "$sunder" fracture $size --physics -o p.gltf -o p.glb
  expect_text p.gltf '"extensionsUsed":["KHR_physics_rigid_bodies"]'
  expect_text p.gltf '"convexHull":true},"physicsMaterial":0'
  expect_text p.gltf '"inertiaDiagonal"'
  expect_text p.gltf '_body_01'
  expect_exit 0 "$sunder" check p.glb
  expect_exit 0 "$sunder" check p.gltf
  for mode in "gear.stl --chunks 30" "vase.obj --chunks 90" "scan.ply --chunks 20 --repair"; do
    # shellcheck disable=SC2086
    expect_exit 0 "$sunder" fracture "$source/data/models/"$mode --hulls ucx --hull-error 0.2 -o m.glb
    expect_text err "; 0 chunks above 0.2"
    expect_exit 0 "$sunder" check m.glb
  done
  echo '{"sunder": 1, "walls": [{}], "hulls": {"nodes": "ucx", "max_hulls": 2}}' > s.json
  expect_exit 0 "$sunder" fracture s.json -o s.gltf
  expect_text s.gltf UCX_wall_chunk_0000_00
  expect_exit 0 "$sunder" fracture s.json --hulls convcol -o s.gltf
  expect_text s.gltf wall_chunk_0000_00-convcolonly
  expect_exit 2 "$sunder" fracture s.json --hulls box -o s.gltf
  expect_exit 2 "$sunder" fracture s.json --hull-error 0 -o s.gltf
  expect_exit 2 "$sunder" fracture s.json --max-hulls 65 -o s.gltf
  expect_exit 2 "$sunder" fracture s.json --hull-vertices 3 -o s.gltf
  expect_text err "/hulls/max_vertices: 3 is outside [4, 255]"
  expect_exit 4 "$sunder" fracture $wall --hulls ucx -o l.glb --name \
    abcdefghijabcdefghijabcdefghijabcdefghij
  expect_text err "is too long for hulls"
}

solid_errors() {
  put_cube cube.obj
  put_cube open.obj 1
  expect_exit 3 "$sunder" fracture open.obj -o a.glb
  expect_text err "open.obj: is not a solid: 4 open edges, first near ("
  expect_text err "--repair"
  expect_exit 0 "$sunder" fracture open.obj --repair --chunks 9 -o a.glb --report a.json
  expect_text err "solid: repair: "
  expect_text a.json '"volume_before"'
  expect_exit 0 "$sunder" check a.glb
  expect_exit 2 "$sunder" fracture cube.obj --chunks 0 -o a.glb
  expect_text err "--chunks: 0 is outside"
  expect_exit 2 "$sunder" fracture cube.obj --pattern slices --slices 1x2 -o a.glb
  expect_text err "--slices 1x2: expected X,Y,Z or XxYxZ"
  expect_exit 2 "$sunder" fracture cube.obj --cell 0.3 -o a.glb
  expect_text err '--cell: unknown key "cell"'
  expect_exit 2 "$sunder" fracture cube.obj --patern slices -o a.glb
  expect_text err 'did you mean "--pattern"'
  expect_exit 2 "$sunder" fracture cube.obj --near 1,2 -o a.glb
  expect_text err "--near 1,2: expected X,Y,Z in metres"
  expect_exit 2 "$sunder" fracture cube.obj --carve 1,2 -o a.glb
  expect_text err "--carve 1,2: expected X,Y,Z:RADIUS"
  expect_exit 2 "$sunder" fracture cube.obj --carve 1,2,3:-1 -o a.glb
  expect_text err "--carve: -1 is outside"
  expect_exit 2 "$sunder" fracture cube.obj --scale 0 -o a.glb
  expect_text err "--scale: 0 is outside"
  expect_exit 2 "$sunder" fracture cube.obj --anchors left -o a.glb
  expect_text err "--anchors goes with --wall"
  expect_exit 2 "$sunder" fracture --wall 1x1x0.1 --repair -o a.glb
  expect_text err "--repair goes with a model"
  expect_exit 2 "$sunder" fracture cube.obj --wall 1x1x0.1 -o a.glb
  expect_exit 2 "$sunder" fracture cube.obj -o ./cube.obj
  expect_text err "would overwrite the input"
  expect_exit 2 "$sunder" fracture missing.obj -o a.glb
  expect_text err 'MODEL: the model "missing.obj" does not exist'
  echo '{"sunder": 1, "solids": [{"file": "../cube.obj"}]}' > s.json
  mkdir sub && mv s.json sub/
  expect_exit 3 "$sunder" fracture sub/s.json -o a.glb
  expect_text err "is not in the scene's folder"
  expect_exit 0 "$sunder" fracture sub/s.json --allow-outside -o b.glb
  head -c 200 cube.obj | tr 'v' '\377' > bad.obj
  expect_exit 3 "$sunder" fracture bad.obj -o c.glb
  [ ! -e c.glb ] || fail "a model that cannot be read left a file"
}

version() {
  expect_exit 0 "$sunder" --version
  expect_text out "sunder "
  expect_exit 0 "$sunder" fracture --help
  expect_text out "--jitter"
  # The program needs nothing of the folder it was built in, nor an environment.
  mkdir elsewhere
  cd elsewhere || exit 1
  for verb in --version "schema scene" "schema parameters" "fracture --help"; do
    expect_exit 0 env -i "$sunder" $verb
    [ -s out ] || fail "$verb prints nothing from another folder"
    [ -s err ] && fail "$verb complains: $(cat err)"
  done
  expect_files ""
}
view() {
  # shellcheck disable=SC2086
  expect_exit 0 "$sunder" fracture $wall -o a.glb -o a.gltf -o a.obj --report a.json
  if ! "$sunder" view a.glb -o a.html 2> err; then  # this build has no page
    expect_exit 4 "$sunder" view a.glb -o a.html
    expect_text err "nodejs npm"
    return
  fi
  expect_text err "wrote a.html"
  expect_exit 0 "$sunder" view a.glb a.json a.gltf a.obj -o a.html -o b.html -q
  [ -s err ] && fail "-q prints"
  cmp a.html b.html || fail "pages differ"
  # shellcheck disable=SC2086
  expect_exit 0 "$sunder" fracture $wall -o direct.html -o one.html
  cmp <(grep 'id="sunder-file-0"' direct.html) <(grep 'id="sunder-file-0"' one.html) || fail "same asset, other page"
  expect_exit 2 "$sunder" view -o c.html
  expect_exit 2 "$sunder" view a.glb
  expect_exit 2 "$sunder" view a.glb -o c.svg
  expect_text err "view writes .html"
  expect_exit 2 "$sunder" view a.txt -o c.html
  expect_text err ".glb .gltf .obj .stl .ply"
  expect_exit 2 "$sunder" view a.json a.glb -o c.html
  expect_text err "there is none"
  expect_exit 2 "$sunder" view a.glb a.json a.json -o c.html
  expect_text err "already"
  expect_exit 2 "$sunder" view a.glb -o c.html --json
  expect_exit 3 "$sunder" view nothing.glb -o c.html
  expect_text err "nothing.glb"
  head -c 1000 a.glb > cut.glb
  expect_exit 3 "$sunder" view cut.glb -o c.html
  expect_text err "cut off"
  echo '{"sunder": 1}' > scene.json
  expect_exit 3 "$sunder" view a.glb scene.json -o c.html
  expect_text err "is a scene"
  rm a.bin
  expect_exit 3 "$sunder" view a.gltf -o c.html
  expect_text err "a.bin"
  expect_exit 4 "$sunder" view a.glb -o nowhere/c.html
  [ -e c.html ] && fail "half a page"
  return 0
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
  for option in --seed --threads --name --report --anchors --set --cell -o; do
    expect_exit 2 "$sunder" fracture $wall -o a.glb $option ""
    expect_text err "needs a value"
  done
  expect_exit 2 "$sunder" fracture $wall --seed= 3 -o a.glb
  expect_text err "--seed needs a value"
  expect_exit 2 "$sunder" schema scenes
  expect_files ""
}
one_value_each() {  # an option does not take the words after its value
  cp "$source/data/scenes/facade.json" scene.json
  expect_exit 2 "$sunder" fracture $wall -o wall.glb scene.json
  expect_text err '"scene.json" belongs to no option'
  cmp -s scene.json "$source/data/scenes/facade.json" || fail "the scene is overwritten"
  expect_exit 0 "$sunder" fracture -o a.svg scene.json -o b.svg
  expect_exit 0 "$sunder" fracture --set seed=3 scene.json -o a.svg --set walls.0.name=front
  expect_text err "seed 3"
  expect_exit 2 "$sunder" fracture $wall --jitter 0.5 0.6 -o a.svg
  expect_exit 2 "$sunder" fracture $wall --cell 0.4 -o a.svg
  expect_text err "--cell is given twice"
  expect_exit 2 "$sunder" fracture $wall --seed 1 --seed 2 -o a.svg
  expect_text err "--seed is given twice"
  expect_exit 0 "$sunder" fracture --wall 6x3x0.2 --pattern voronoi-sites --sites 1,1 --sites 4,2 \
    --opening 1x1@1,1 --opening 1x1@3,1 -o c.svg
  expect_text err "2 chunks"
  expect_exit 2 "$sunder" fracture --wall 6x3x0.2 --pattern voronoi-sites --sites 1,1 4,2 -o c.svg
  expect_files "a.svg b.svg c.svg scene.json"
}
bad_values() {  # on the command line: named by their option
  while IFS='|' read -r words message; do
    expect_exit 2 "$sunder" fracture $words -o a.glb
    expect_text err "error: $message"
  done << 'END'
--wall 6x3x0.2 --jitter 1.4|--jitter: 1.4 is outside [0, 1]
--wall 6x3x0.2 --cell inf|--cell: must be a number
--wall 6x3x0.2 --cell nan|--cell: must be a number
--wall 6x3x0.2 --cell 0x1|--cell: must be a number
--wall 6x3x0.2 --cell 1e999|--cell: must be a number
--wall 6x3x0|--wall: 0 is outside
--wall 6x-3x0.2|--wall: -3 is outside
--wall 6x3xinf|--wall 6x3xinf: expected WIDTHxHEIGHTxTHICKNESS
--wall 6x3x0.2 --opening 0x1@1,1|--opening: 0 is outside
--wall 6x3x0.2 --opening 1x1|--opening 1x1: expected WxH@X,Y
--wall 6x3x0.2 --opening 1x1@1,y|--opening 1x1@1,y: expected WxH@X,Y
--wall 6x3x0.2 --anchors bottom,botom|--anchors: unknown word "botom", did you mean "bottom"?
--wall 6x3x0.2 --name a/b|--name: a name is 1 to
--wall 6x3x0.2 --material stone|--material: unknown material "stone"
--wall 6x3x0.2 --min-cell -1|--min-cell: -1 is outside
--wall 6x3x0.2 --pattern spiderwep|--pattern: unknown word "spiderwep", did you mean "spiderweb"?
--wall 6x3x0.2 --pattern spiderweb --impacts 1,1 --min-points 20|--min-points: min_points = 20
--wall 6x3x0.2 --pattern voronoi-sites --sites 1e9,1|--sites: 1e9 is outside
--wall 6x3x0.2 --set walls.0.pattern.jitter=2|--set: /walls/0/pattern/jitter: 2 is outside [0, 1]
END
  expect_exit 2 "$sunder" fracture "$source/data/scenes/facade.json" --set seed=-1 -o a.glb
  expect_text err "error: --set: /seed"
  expect_exit 2 "$sunder" fracture $wall --name $'a\tb\001' -o a.glb
  expect_text err 'got "a\tb\u0001"'
  expect_files ""
}
number_forms() {  # what people write and JSON refuses means the same number
  expect_exit 0 "$sunder" fracture --wall 6x3x0.2 --cell 0.3 --jitter 1 --opening 1x2@0.5,0 -o a.glb
  expect_exit 0 "$sunder" fracture --wall +6x03x.2 --cell 3.e-1 --jitter 1. --opening 1e0x2@.5,-0 \
    -o b.glb
  cmp a.glb b.glb || fail "the same wall spelt otherwise is another"
}
bad_input() {
  echo '{"sunder": 1, "walls": [{"pattern": {"type": "voronoi-grid", "jitter": 1.4}}]}' > bad.json
  expect_exit 3 "$sunder" fracture bad.json -o a.glb
  expect_text err "bad.json:1: /walls/0/pattern/jitter"
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
  # Another sin, cos, exp, pow and log of the C library; they differ in last bits.
  expect_exit 0 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA \
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
  for scene in "$source"/data/scenes/*.json "$source"/data/models/*.json; do
    grep -q '"building"' "$scene" && continue
    expect_exit 0 "$sunder" fracture "$scene" -o s.glb -o s.obj --report s.json
    expect_text s.json '"sound": true'
    expect_exit 0 "$sunder" check s.glb s.obj
  done
}
buildings_run() {  # each for the first moments, by its solver: it stands, and its report is whole
  local hybrid=0 bullet=0
  for scene in "$source"/data/scenes/*.json; do
    grep -q '"building"' "$scene" || continue
    expect_exit 0 "$sunder" collapse "$scene" --set simulation.duration=0.4 -o b.glb -o b.svg \
      --report b.json --history b.csv
    expect_exit 0 "$sunder" check b.glb
    for key in '"broken_at_rest": 0,' '"broken_by": {' '"weight": ' '"sag": {' '"hash": "' \
               '"warnings": []'; do
      expect_text b.json "$key"
    done
    # Joules that nothing explains, against the building lifted by a metre.
    awk 'match($0, /"weight": [^,}]*/) {weight = substr($0, RSTART + 10, RLENGTH - 10)}
         match($0, /"numerical": [^,}]*/) {lost = substr($0, RSTART + 13, RLENGTH - 13)}
         END {exit !(weight > 0 && lost != "" && lost * lost < 1e-18 * weight * weight)}' b.json ||
      fail "$scene: energy.numerical is too large: $(grep numerical b.json)"
    if grep -q '"solver": "bullet"' "$scene"; then
      bullet=$((bullet + 1))
      expect_text b.json '"solver": {"name": "bullet"'
      expect_text b.json '"solves": {"full": 0, "update": 0,'
    else
      hybrid=$((hybrid + 1))
      expect_text b.json '"solver": {"name": "hybrid"'
      grep -q '"solves": {"full": [1-9]' b.json || fail "$scene: no frame was solved"
    fi
  done
  [ "$hybrid" -ge 4 ] && [ "$bullet" -ge 1 ] || fail "$hybrid and $bullet scenes of buildings"
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
unsound_results() {  # a frame too narrow for float32 corners: the volume is off
  local frame="--wall 6x3x0.2 --opening 5.99x2.99@0,0 --min-cell 0"
  expect_exit 1 "$sunder" fracture $frame -o a.glb --report a.json --quiet
  expect_text a.json '"sound": false'
  expect_text err "NOT SOUND"
  expect_text err "the volume is"
  expect_exit 1 "$sunder" fracture $frame --json --quiet
  [ "$(head -c 1 out)" = "{" ] || fail "faults belong on standard error"
  expect_text err "the volume is"
  expect_exit 1 "$sunder" check a.glb
  expect_text out "the volume is"
  expect_exit 0 "$sunder" fracture $wall --json
  grep -q "SOUND" err && fail "faults of a sound asset"
  return 0
}
formats_without_chunks() {
  expect_exit 0 "$sunder" fracture $wall -o a.stl -o a.ply -o a.obj
  for file in a.stl a.ply; do
    expect_exit 0 "$sunder" check $file
    expect_text out "one solid"
    grep -q " chunks, \|bonds" out && fail "$file is said to have chunks: $(cat out)"
  done
  expect_exit 0 "$sunder" check a.obj
  expect_text out " chunks, "
}
signal_while_writing() {  # signal, pid: sent when the unfinished file is there
  while kill -0 "$2" 2> /dev/null; do
    if [ -n "$(find . -name '.sunder-*.tmp')" ]; then
      kill -"$1" "$2"
      return
    fi
    sleep 0.01
  done
  fail "it ended before SIG$1 could be sent: $(cat err)"
}
interrupt() {
  local signal
  for signal in INT TERM HUP; do
    "$sunder" fracture --wall 20x20x0.2 --cell 0.05 -o big.glb --quiet 2> err &
    signal_while_writing $signal $!
    wait $! 2> /dev/null
    [ $? -eq $((128 + $(kill -l $signal))) ] || fail "exit code after SIG$signal"
    expect_files ""
  done
  # Under nohup a hang-up is nothing.
  (trap '' HUP; exec "$sunder" fracture --wall 30x30x0.2 --cell 0.1 -o big.glb --quiet) 2> err &
  signal_while_writing HUP $!
  wait $! || fail "a hang-up that is ignored stops the program"
  expect_files "big.glb"
}
same_input() {
  cp "$source/data/scenes/facade.json" scene.json
  expect_exit 2 "$sunder" fracture scene.json -o scene.json
  expect_text err "overwrite"
  expect_exit 2 "$sunder" fracture scene.json -o a.svg --report ./x/../scene.json
  expect_text err "overwrite"
  ln -s scene.json link.json
  expect_exit 2 "$sunder" fracture scene.json -o a.svg --report link.json
  expect_text err "overwrite"
  cmp -s scene.json "$source/data/scenes/facade.json" || fail "the scene is overwritten"
  expect_exit 0 "$sunder" fracture scene.json -o out.svg --set seed=9
  expect_text err "seed 9"
  expect_exit 0 "$sunder" fracture scene.json -o a.glb
  cp a.glb before.glb
  expect_exit 2 "$sunder" check a.glb --report a.glb
  expect_text err ".json"
  ln -s a.glb asset.json
  expect_exit 2 "$sunder" check a.glb --report asset.json
  expect_text err "overwrite"
  cmp a.glb before.glb || fail "the asset is overwritten"
  expect_exit 0 "$sunder" check a.glb --report a.json
  expect_text a.json '"sound": true'
}
same_output() {  # two names of one file
  mkdir x
  ln -s x y
  ln -s a.svg later.svg
  for other in ./a.svg x/../a.svg "$PWD/a.svg" later.svg; do
    expect_exit 2 "$sunder" fracture $wall -o a.svg -o "$other"
    expect_text err "written twice"
  done
  expect_exit 2 "$sunder" fracture $wall -o x/r.json --report y/r.json
  expect_text err "written twice"
  expect_exit 2 "$sunder" fracture $wall --report r.txt
  expect_text err "--report r.txt"
  expect_files "later.svg x y"
  expect_exit 0 "$sunder" fracture $wall -o a.svg -o x/a.svg
}
# What bash offers for the last word.
complete_words() {  # words…
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  _sunder
  [ ${#COMPREPLY[@]} -eq 0 ] || printf '%s ' "${COMPREPLY[@]}"
}
expect_offer() {  # offered, words…
  local got
  got=$(complete_words "${@:2}")
  [ "$got" = "${1:+$1 }" ] || fail "bash offers \"$got\" instead of \"$1\" for: ${*:2}"
}
completions() {
  local shell verb verbs option word
  verbs=$("$sunder" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
  [ "$(echo "$verbs" | wc -l)" -ge 6 ] || fail "the verbs are \"$verbs\""
  for shell in bash zsh fish; do
    expect_exit 0 "$sunder" completion $shell
    cp out script.$shell
    ! command -v $shell > script.path || $shell -n script.$shell || fail "$shell cannot read its script"
  done
  expect_exit 0 "$sunder" schema man
  sed 's/\\-/-/g' out > script.man
  for verb in $verbs; do
    for shell in bash zsh fish man; do expect_text script.$shell "$verb"; done
    expect_exit 0 "$sunder" $verb --help
    for option in $(grep -oE '^  (-[a-z],)?--[a-z-]+' out | tr , ' '); do
      for shell in bash zsh man; do expect_text script.$shell "$option"; done
      word=${option#--}
      [ "$word" = "$option" ] && word="-s ${option#-}" || word="-l $word "
      grep "from $verb'" script.fish | grep -qF -- "$word" || fail "fish does not know $verb $option"
    done
  done
  if command -v groff > script.path; then
    groff -man -ww -Tutf8 script.man > out 2> err
    [ -s err ] && fail "groff: $(cat err)"
    expect_text out "SUNDER(1)"
    expect_text out "A bug of the program."
  fi
  rm script.path
  # shellcheck source=/dev/null
  . ./script.bash
  # shellcheck disable=SC2086
  for verb in $verbs; do
    [[ " $(complete_words sunder '') " == *" $verb "* ]] || fail "bash does not offer $verb"
    expect_exit 0 "$sunder" $verb --help
    for option in $(grep -oE '^  (-[a-z],)?--[a-z-]+' out | tr , ' '); do
      [[ " $(complete_words sunder $verb "$option") " == *" $option "* ]] ||
        fail "bash does not offer $verb $option"
    done
  done
  mkdir folder
  touch a.json b.obj c.txt wall.glb
  expect_offer "fracture" sunder fr
  expect_offer "--hulls --hull-error --hull-vertices" sunder fracture --hull
  expect_offer "ucx" sunder fracture --hulls u
  expect_offer "slices spiderweb" sunder fracture --pattern s
  expect_offer "slices spiderweb" sunder fracture --pattern = s
  expect_offer "float-glass" sunder fracture --wall 1x1x0.1 --material fl
  expect_offer "a.json" sunder impact a
  expect_offer "folder" sunder impact fo
  expect_offer "" sunder impact b
  expect_offer "b.obj" sunder fracture b
  expect_offer "wall.glb" sunder check w
  expect_offer "x.svg" sunder impact a.json -o x.s
  expect_offer "x.csv" sunder collapse a.json --history x.c
  expect_offer "" sunder fracture --seed ''
  for word in $(complete_words sunder schema ''); do expect_exit 0 "$sunder" schema "$word"; done
  for word in $(complete_words sunder fracture --hulls ''); do
    expect_exit 0 "$sunder" fracture --wall 1x1x0.1 --hulls "$word" -o wall.glb
  done
  for word in $(complete_words sunder fracture --material ''); do
    expect_exit 0 "$sunder" fracture --wall 1x1x0.1 --cell 0.5 --material "$word" -o wall.glb
  done
  expect_exit 2 "$sunder" completion
  expect_exit 2 "$sunder" completion csh
  expect_text err "bash, zsh and fish"
}
pictures() {  # without a browser
  local n width words
  building_scene
  cat > w.json << 'END'
{"sunder": 1, "walls": [{"pattern": {"type": "voronoi-grid", "cell": 0.6}}], "simulation": {"duration": 0.5},
 "projectiles": [{"position": [3, 1, 2], "velocity": [0, 0, -9]}]}
END
  for words in "fracture w.json" "impact w.json" "impact w.json --at 0.4" "collapse s.json --at 0.5" \
    "collapse s.json --set simulation.duration=0.2"; do
    # shellcheck disable=SC2086
    for n in 1 2; do expect_exit 0 "$sunder" $words -o $n.png -o $n.svg --width 300; done
    cmp 1.png 2.png || fail "$words draws another picture the second time"
    width=$(od -An -j16 -N4 -tx1 1.png | tr -d ' ')
    [ "$width" = 0000012c ] || fail "$words: a width of 0x$width instead of 300"
    # shellcheck disable=SC2086
    expect_exit 0 env FONTCONFIG_FILE=/nonexistent HOME=/nonexistent "$sunder" $words -o 3.png
    rm 1.* 2.* 3.*
  done
  while IFS='|' read -r words n message; do
    # shellcheck disable=SC2086
    expect_exit $n "$sunder" fracture w.json $words
    expect_text err "$message"
  done << 'END'
-o a.png --width 0|2|--width 0: expected a whole number from 64 to 8192
-o a.png --width 63|2|--width 63: expected a whole number from 64 to 8192
-o a.png --width 8193|2|--width 8193: expected a whole number from 64 to 8192
-o a.png --width -5|2|--width -5: expected a whole number from 64 to 8192
-o a.png --width 1e3|2|--width 1e3: expected a whole number from 64 to 8192
-o a.png --width 99999999999999999999999|2|--width 99999999999999999999999: expected
-o a.png --width=|2|--width needs a value
-o a.png --width 100 --width 200|2|--width is given twice
-o a.svg --width 100|2|--width is of -o FILE.png, and there is none
-o a.png -o ./a.png|2|written twice
-o none/a.png|4|none/a.png: cannot create a file in its folder
-o /proc/a.png|4|/proc/a.png: cannot create a file in its folder
END
  expect_files "s.json w.json"
}
report_pages() {  # every verb writes one that loads nothing and names the command
  cp "$source/data/scenes/window-shot.json" "a b.json"
  local short="--set simulation.duration=0.1"
  expect_exit 0 "$sunder" impact "a b.json" $short --report i.html --report i.json -q
  expect_text i.html 'sunder impact &#39;a b.json&#39; --set simulation.duration=0.1 --report i.html'
  expect_text i.html "$(grep -o '"hash": "[0-9a-f]*' i.json | cut -d'"' -f4)"
  cp "$source/data/scenes/steel-frame.json" s.json
  expect_exit 0 "$sunder" collapse s.json $short --report c.html -q
  expect_text c.html "The building stands"
  expect_exit 0 "$sunder" fracture $wall --report f.html -o f.glb -q
  expect_exit 0 "$sunder" check f.glb --report k.html -q
  for page in i c f k; do
    expect_text $page.html "</html>"
    ! grep -qE 'https?:|<script|src=' $page.html || fail "$page.html loads something"
  done
  expect_exit 2 "$sunder" impact "a b.json" --report i.htm
  expect_text err "--report i.htm: a report is a .json or .html file"
  expect_exit 2 "$sunder" impact "a b.json" --report i.html --report ./i.html
  expect_text err "written twice"
  expect_exit 2 "$sunder" check f.glb f.glb --report k.html
  expect_text err "check takes one file with it"
}
schemas() {
  for which in scene material report impact-report collapse-report; do
    expect_exit 0 "$sunder" schema $which
    expect_text out "json-schema.org/draft-07"
  done
}

impact_usage() {
  echo '{"sunder": 1, "walls": [{}], "projectiles": [{"position": [3, 1, 5], "velocity": [0, 0, -9]}]}' > s.json
  while IFS='|' read -r words message; do
    expect_exit 2 "$sunder" impact $words
    expect_text err "error: $message"
  done << 'END'
|impact needs a scene file
s.json|impact has nothing to write: give -o FILE
s.json -o a.obj|-o a.obj: impact writes .glb .gltf .svg .png .html .json, and .obj with --at
s.json -o a.png --at 99|--at 99 is after the end of the run, which lasts 5 s
s.json --json --at 1|--at says which moment
s.json -o a.glb -o ./a.glb|./a.glb is written twice
s.json -o ./s.json|./s.json would overwrite the input
s.json t.json -o a.glb|"t.json" belongs to no option
s.json -o a.glb --wall=6x3x0.2|there is no option "--wall"
s.json -o a.glb --no-skip=3|
s.json -o a.glb --no-skipp|there is no option "--no-skipp", did you mean "--no-skip"?
s.json -o a.glb --set projectiles.0.mass=0|--set: /projectiles/0/mass: 0 is outside
s.json -o a.glb --seed -1|--seed -1: expected a whole number
END
  expect_exit 0 "$sunder" impact --help
  expect_text out "--no-skip"
  expect_exit 0 "$sunder" schema impact-report
  expect_files "s.json"
}
max_error() {  # chooses what the scene leaves open; a value that is none writes nothing
  cat > s.json << END
{"sunder": 1, "walls": [{"outline": {"rect": [1, 1]}, "pattern": {"type": "voronoi-grid", "cell": 0.5}}],
 "projectiles": [{"radius": 0.1, "mass": 10, "position": [0.5, 0.5, 1], "velocity": [0, 0, -10]}],
 "simulation": {"duration": 0.1}}
END
  cat > b.json << END
{"sunder": 1, "building": {"posts": [2, 2], "storeys": 1}, "simulation": {"duration": 0.1}}
END
  local step last=1
  for asked in 0.3 0.01 0.001; do
    expect_exit 0 "$sunder" impact s.json --max-error $asked --report r.json
    expect_text r.json '"asked": true'
    expect_text r.json "\"max_error\": $asked"
    expect_text r.json '"met": true'
    expect_text r.json '"chosen": ["iterations", "step"], "step": '
    step=$(sed -n 's/.*"chosen": \[[^]]*\], "step": \([0-9.e-]*\),.*/\1/p' r.json)
    awk "BEGIN {exit !($step < $last)}" || fail "steps of $step s for $asked are not shorter"
    last=$step
  done
  expect_exit 0 "$sunder" impact s.json --max-error 1e-9 --report r.json
  expect_text r.json '"met": false'
  expect_text err "max_error = 1e-9 is less than the settings give"
  # What the scene gives stays.
  expect_exit 0 "$sunder" impact s.json --set simulation.step=0.002 --max-error 0.3 --report r.json
  expect_text r.json '"step": 0.002'
  expect_exit 0 "$sunder" collapse b.json --max-error 0.02 --report r.json
  expect_text r.json '"asked": true'
  rm r.json
  for n in 0 -1 2 nan inf abc 0x1 1e999 '[1]' '{}' true; do
    for verb in impact collapse; do
      expect_exit 2 "$sunder" $verb $([ $verb = impact ] && echo s || echo b).json \
        "--max-error=$n" -o a.glb --report r.json
      expect_text err "error: --max-error: "
      expect_text err "(0, 1]"
    done
  done
  expect_exit 2 "$sunder" impact s.json --max-error "" -o a.glb
  expect_text err "--max-error needs a value"
  expect_exit 2 "$sunder" impact s.json --max-error 0.1 --max-error 0.2 -o a.glb
  expect_exit 2 "$sunder" impact s.json --set simulation.max_error=2 -o a.glb
  expect_text err "error: --set: /simulation/max_error: 2 is outside (0, 1]"
  expect_files "b.json s.json"
}
impact_is_the_same() {
  scene=$source/data/scenes/brick-door.json
  short="--set simulation.duration=1.2"
  expect_exit 0 "$sunder" impact "$scene" $short -o 1.glb -o 1.svg --report 1.json
  expect_exit 0 "$sunder" impact "$scene" $short --threads 7 -o 2.glb -o 2.svg --report 2.json
  expect_exit 0 "$sunder" impact "$scene" $short --no-skip -o 3.glb -o 3.svg --report 3.json
  # Another sin, cos, exp, pow and log of the C library; they differ in last bits.
  expect_exit 0 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2_Usable,-FMA_Usable \
    "$sunder" impact "$scene" $short -o 4.glb -o 4.svg --report 4.json
  expect_exit 0 "$sunder" fracture "$scene" -o wall.glb
  sed 's/"outline".*/"asset": "wall.glb",/; /"openings"/d; s/"thickness".*brick",//; /"pattern"/d' \
    "$scene" > asset.json
  expect_exit 0 "$sunder" impact asset.json $short -o 5.glb -o 5.svg --report 5.json
  grep '"hash"' 1.json > hash
  [ -s hash ] || fail "the report has no hash"
  for n in 2 3 4; do
    grep -qF "$(cat hash)" $n.json || fail "the hash of run $n differs"
    cmp 1.glb $n.glb || fail "the recording of run $n differs"
    cmp 1.svg $n.svg || fail "the pictures of run $n differ"
  done
  grep -q '"chunks_freed": 0,' 1.json && fail "nothing broke"
  expect_exit 0 "$sunder" check 1.glb
}
impact_input() {
  scene=$source/data/scenes/wrecking-ball.json
  hit() { "$sunder" impact "$scene" --set simulation.duration=0.05 --report r.json "$@"; }
  expect_exit 3 hit --set 'projectiles.0.position=[3, 1, 0.1]'
  expect_text err 'projectile "ball" starts inside wall "wall"'
  expect_exit 3 hit --set 'projectiles.0.position=[3, 0.1, 3]'
  expect_text err 'below the ground'
  expect_exit 2 hit --set projectiles.0.mass=0
  expect_exit 2 hit --set projectiles.0.mass=-1
  expect_exit 2 hit --set 'projectiles.0.velocity=[0, 0, 1e999]'
  expect_exit 2 hit --set 'projectiles.0.velocity=[0, 0, NaN]'
  expect_files ""
  sed 's/"outline".*/"asset": "other.obj",/; s/"thickness".*//; /"pattern"/d' "$scene" > s.json
  printf 'o cube\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' > other.obj
  expect_exit 3 "$sunder" impact s.json --report r.json
  expect_text err "other.obj"
  echo nonsense > other.obj
  expect_exit 3 "$sunder" impact s.json --report r.json
  expect_text err "other.obj"
  expect_files "other.obj s.json"
}

building_scene() {  # two bays by two, two storeys, and a ball that hits a post of the corner
  cat > s.json << 'END'
{"sunder": 1,
 "building": {"posts": [3, 3], "storeys": 2},
 "projectiles": [{"name": "ball", "radius": 0.4, "mass": 2000, "position": [-3, 2, 0],
                  "velocity": [20, 0, 0]}],
 "simulation": {"duration": 1}}
END
}
collapse_usage() {
  building_scene
  while IFS='|' read -r words message; do
    expect_exit 2 "$sunder" collapse $words
    expect_text err "error: $message"
  done << 'END'
|collapse needs a scene file
s.json|collapse has nothing to write: give -o FILE
s.json -o a.stl|-o a.stl: collapse writes .glb .gltf .svg .png .html .json
s.json -o a.obj|-o a.obj: collapse writes .glb .gltf .svg .png .html .json, and .obj with --at
s.json -o a.obj -o a.stl --at 1|-o a.stl: collapse writes
s.json --history x.txt|--history x.txt: a history is a .csv or .json file
s.json --history x|--history x: a history is a .csv or .json file
s.json --history s.json|s.json would overwrite the input
s.json --history a.json --report ./a.json|a.json is written twice
s.json -o a.glb --at -1|--at -1: expected seconds
s.json -o a.glb --at 1s|--at 1s: expected seconds
s.json -o a.glb --at inf|--at inf: expected seconds
s.json --report r.json --at 1|--at says which moment -o FILE.glb, .gltf, .obj, .svg, .png or .html shows
s.json -o a.glb --at 1.1|--at 1.1 is after the end of the run, which lasts 1 s
s.json -o a.glb --at 1 --at 2|--at is given twice
s.json t.json -o a.glb|"t.json" belongs to no option
s.json -o a.glb --histroy=a.csv|there is no option "--histroy", did you mean "--history"?
s.json -o a.glb --set building.storeys=0|--set: /building/storeys: 0 is outside
END
  expect_exit 2 "$sunder" impact s.json -o a.glb --history=a.csv
  expect_text err 'there is no option "--history"'
  expect_exit 0 "$sunder" collapse --help
  expect_text out "--history"
  expect_exit 0 "$sunder" schema collapse-report
  expect_files "s.json"
}
collapse_input() {
  collapse() { "$sunder" collapse "$1" --report r.json "${@:2}"; }
  expect_exit 3 collapse missing.json
  expect_text err "missing.json"
  echo '{"sunder": 1, "walls": [{}]}' > w.json
  expect_exit 3 collapse w.json
  expect_text err "the scene has no building to bring down"
  echo '{"sunder": 1, "building": {"storeyss": 2}}' > b.json
  expect_exit 3 collapse b.json
  expect_text err 'b.json:1: /building/storeyss'
  expect_text err 'did you mean "storeys"'
  building_scene
  expect_exit 3 collapse s.json --set 'projectiles.0.position=[0, 2, 0]'
  expect_text err '"ball"'
  expect_exit 3 collapse s.json --set 'projectiles.0.position=[-3, 0.1, 0]'
  expect_text err '"ball"'
  for verb in fracture impact; do
    expect_exit 3 "$sunder" $verb s.json --report r.json
    expect_text err "the scene has no walls"
  done
  printf '0, 0.1\n1, 0.2\n' > quake.csv
  sed -i '$s/}$/, "scenario": {"ground_motion": "quake.csv"}}/' s.json
  expect_exit 2 collapse s.json --history ./quake.csv
  expect_text err "quake.csv would overwrite the input"
  expect_files "b.json quake.csv s.json w.json"
}
collapse_is_the_same() {
  building_scene
  run() {  # number, more options
    expect_exit 0 "$sunder" collapse s.json "${@:2}" -o $1.glb -o $1.svg --report $1.json --history $1.csv
  }
  run 1
  expect_text 1.json '"name": "hybrid"'
  run 2 --threads 1
  run 3 --threads 2
  run 4 --no-skip
  grep '"hash"' 1.json > hash
  [ -s hash ] || fail "the report has no hash"
  for n in 2 3 4; do
    grep -qF "$(cat hash)" $n.json || fail "the hash of run $n differs"
    for suffix in glb svg csv; do
      cmp 1.$suffix $n.$suffix || fail "the .$suffix of run $n differs"
    done
  done
  grep -q '"broken_joints": \[\],' 1.json && fail "nothing broke"
  # What is not asked for is not kept, and changes nothing.
  expect_exit 0 "$sunder" collapse s.json --json
  expect_text out "$(cat hash)"
}
collapse_files() {
  building_scene
  short="--set simulation.duration=0.2"
  expect_exit 0 "$sunder" collapse s.json $short -o a.glb -o a.obj -o a.svg --at 0.2 --history h.json
  expect_text h.json '"times"'
  grep -q '"animations"' a.glb && fail "a moment is no animation"
  expect_exit 0 "$sunder" collapse s.json $short -o b.glb --history h.csv --quiet
  [ "$(head -n 1 h.csv)" = \
    time,joint,N,Vy,Vz,T,My,Mz,force_utilisation,torque_utilisation,utilisation ] ||
    fail "another header"
  grep -q '"animations"' b.glb || fail "no animation"
  expect_files "a.glb a.mtl a.obj a.svg b.glb h.csv h.json s.json"
}

"$case"
