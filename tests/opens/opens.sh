#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Opens files with other people's programs, such as are installed: Blender (blender,
# python3-numpy), Godot (godot3, xvfb; .glb only) and assimp's own tool (assimp-utils).
# Usage: tests/opens/opens.sh FILE…
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
status=0

if command -v blender > /dev/null; then
  printed=$(blender -b --factory-startup --python-exit-code 1 --python "$here/blender.py" -- \
    "${@/#/$PWD/}" 2>&1) || status=1
  if [ $status -eq 0 ]; then grep -E '^(opened|Blender [0-9.]+:)' <<< "$printed"; else echo "$printed"; fi
else
  echo "blender is not installed: not tried"
fi

if command -v godot3 > /dev/null && command -v xvfb-run > /dev/null; then
  project=$(mktemp -d)
  trap 'rm -r "$project"' EXIT
  for file in "$@"; do [ "${file%.glb}" = "$file" ] || cp "$file" "$project"; done
  echo "config_version=4" > "$project/project.godot"
  cp "$here/godot.gd" "$project"
  # The editor imports, and ends.
  xvfb-run -a godot3 --editor --quit --path "$project" > "$project/import.log" 2>&1 || true
  xvfb-run -a godot3 --path "$project" -s godot.gd > "$project/opened.log" 2>&1 || status=1
  grep -E '^(opened|FAULT|Godot [0-9.]+)' "$project/opened.log" ||
    { cat "$project/opened.log"; status=1; }
else
  echo "godot3 and xvfb are not installed: not tried"
fi

if command -v assimp > /dev/null; then
  for file in "$@"; do
    counts=$(assimp info "$file" -s 2>&1 | sed -n 's/^\(Meshes\|Faces\|Animation Channels\): *\([0-9]*\)$/\1 \2/p')
    if grep -q '^Faces [1-9]' <<< "$counts"; then
      echo "opened: $file: $(paste -sd, <<< "$counts" | sed 's/,/, /g')"
    else
      echo "FAULT: $file: assimp finds nothing in it"
      status=1
    fi
  done
  assimp version 2>&1 | sed -n 's/^ *Version /assimp /p'
else
  echo "assimp is not installed: not tried"
fi
exit $status
