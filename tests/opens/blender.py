# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens files that sunder wrote in Blender and asks whether all is there: every part as an object,
every triangle, closed once equal corners are one, the volumes that the file tells, and how long the
animation is. Usage: blender -b --factory-startup --python-exit-code 1 --python blender.py -- FILE...
"""
import collections
import json
import math
import struct
import sys

import bmesh
import bpy
import numpy

# Debian 12's importer asks for names that its numpy no longer has.
for name, kind in (("bool", bool), ("int", int), ("float", float)):
    if name not in numpy.__dict__:
        setattr(numpy, name, kind)


def read_json(path):
    with open(path, "rb") as file:
        if path.endswith(".gltf"):
            return json.load(file)
        file.read(12)
        size, _ = struct.unpack("<II", file.read(8))
        return json.loads(file.read(size))


def expected_of_gltf(path):
    gltf = read_json(path)
    accessors = gltf["accessors"]
    nodes = [node for node in gltf["nodes"] if "mesh" in node]
    triangles = sum(
        accessors[primitive["indices"]]["count"] // 3
        for node in nodes
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]
    )
    volumes = {}
    for node in nodes:
        volume = node.get("extras", {}).get("sunder", {}).get("volume")
        if volume is not None:
            volumes[node["name"]] = volume
    inputs = [s["input"] for a in gltf.get("animations", []) for s in a["samplers"]]
    length = max((accessors[i]["max"][0] for i in inputs), default=0.0)
    return {"objects": len(nodes), "triangles": triangles, "volumes": volumes, "length": length}


def expected_of_obj(path):
    objects = triangles = 0
    with open(path, encoding="utf-8") as file:
        for line in file:
            objects += line.startswith("o ")
            triangles += len(line.split()) - 3 if line.startswith("f ") else 0
    return {"objects": objects, "triangles": triangles, "volumes": {}, "length": 0.0}


def is_closed(mesh):
    """Whether each side of a face has its reverse; corners of equal bits are one."""
    ids = {}
    corner = [ids.setdefault(tuple(vertex.co), len(ids)) for vertex in mesh.vertices]
    sides = collections.Counter()
    for polygon in mesh.polygons:
        loop = [corner[v] for v in polygon.vertices]
        sides.update(zip(loop, loop[1:] + loop[:1]))
    return all(count == 1 and sides[(b, a)] == 1 for (a, b), count in list(sides.items()))


def volume_of(mesh):
    shape = bmesh.new()
    shape.from_mesh(mesh)
    volume = shape.calc_volume(signed=True)
    shape.free()
    return volume


def found():
    meshes = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    scene = bpy.context.scene.render
    frames = max((action.frame_range[1] for action in bpy.data.actions), default=0.0)
    return {
        "objects": len(meshes),
        "triangles": sum(len(p.vertices) - 2 for thing in meshes for p in thing.data.polygons),
        "unclosed": [thing.name for thing in meshes if not is_closed(thing.data)],
        "volumes": {thing.name: volume_of(thing.data) for thing in meshes},
        "length": frames * scene.fps_base / scene.fps,
    }


def faults_of(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".obj"):
        expected = expected_of_obj(path)
        bpy.ops.wm.obj_import(filepath=path)
    else:
        expected = expected_of_gltf(path)
        bpy.ops.import_scene.gltf(filepath=path)
    seen = found()
    faults = [
        f"{key}: {seen[key]}, not {expected[key]}"
        for key in ("objects", "triangles")
        if seen[key] != expected[key]
    ]
    if seen["unclosed"]:
        faults.append(f"{len(seen['unclosed'])} not closed: {seen['unclosed'][0]}")
    for name, volume in expected["volumes"].items():
        if not math.isclose(seen["volumes"].get(name, 0), volume, rel_tol=1e-3, abs_tol=1e-9):
            faults.append(f"{name}: volume {seen['volumes'].get(name)}, not {volume}")
            break
    if abs(seen["length"] - expected["length"]) > 0.05:
        faults.append(f"animation of {seen['length']} s, not {expected['length']}")
    text = f"{seen['objects']} objects, {seen['triangles']} triangles, {seen['length']:.2f} s"
    print("opened" if not faults else "FAULT", path, text, *faults, sep=": ", flush=True)
    return faults


def main(paths):
    failed = [path for path in paths if faults_of(path)]
    print(f"Blender {bpy.app.version_string}: {len(paths)} files, {len(failed)} with faults")
    if failed:
        raise SystemExit(1)


main(sys.argv[sys.argv.index("--") + 1 :])
