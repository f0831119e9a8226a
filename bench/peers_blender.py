# SPDX-License-Identifier: GPL-3.0-or-later
"""A solid into Voronoi cells by Blender's add-on Cell Fracture, with its own settings (`default`) or
with the two that cost it closed and gapless chunks turned off (`tight`: no margin, no split edges).

Usage: blender -b --factory-startup --python-exit-code 1 --python peers_blender.py -- SOLID WAY
SOLID is a text: the number of vertices, of triangles, of sites; then each, one a line. Prints one
line: `CELLS seconds chunks triangles volume unclosed unclosed_when_welded` - processor seconds,
m3, chunks that have an edge without just two faces.
"""
import sys
import time

import addon_utils
import bmesh
import bpy


def read_solid(path):
    with open(path, encoding="ascii") as file:
        counts = [int(word) for word in file.readline().split()]
        rows = [line.split() for line in file]
    vertices = [tuple(map(float, row)) for row in rows[: counts[0]]]
    triangles = [tuple(map(int, row)) for row in rows[counts[0] : counts[0] + counts[1]]]
    sites = [tuple(map(float, row)) for row in rows[counts[0] + counts[1] :]]
    return vertices, triangles, sites


def add_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def unclosed(shape):
    return any(len(edge.link_faces) != 2 for edge in shape.edges)


def measure(chunks):
    triangles, volume, raw, welded = 0, 0.0, 0, 0
    for chunk in chunks:
        shape = bmesh.new()
        shape.from_mesh(chunk.data)
        shape.transform(chunk.matrix_world)
        triangles += sum(len(face.verts) - 2 for face in shape.faces)
        raw += unclosed(shape)
        bmesh.ops.remove_doubles(shape, verts=shape.verts, dist=1e-5)
        welded += unclosed(shape)
        volume += shape.calc_volume(signed=True)
        shape.free()
    return triangles, volume, raw, welded


def main(path, way):
    addon_utils.enable("object_fracture_cell")
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    vertices, triangles, sites = read_solid(path)
    solid = add_object("solid", vertices, triangles)
    add_object("sites", sites, []).parent = solid
    bpy.context.view_layer.objects.active = solid
    solid.select_set(True)
    before = set(bpy.data.objects)
    settings = {"margin": 0.0, "use_sharp_edges": False} if way == "tight" else {}
    start = time.process_time()
    bpy.ops.object.add_fracture_cell_objects(source={"VERT_CHILD"}, source_limit=0, **settings)
    seconds = time.process_time() - start
    chunks = [thing for thing in bpy.data.objects if thing not in before and thing.type == "MESH"]
    numbers = measure(chunks)
    print("CELLS", f"{seconds:.6f}", len(chunks), numbers[0], f"{numbers[1]:.17g}", *numbers[2:])


main(*sys.argv[sys.argv.index("--") + 1 :])
