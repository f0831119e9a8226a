# SPDX-License-Identifier: GPL-3.0-or-later
# What Godot 3 imported from the .glb files of the project that this runs in: as many meshes and
# triangles as the files have, and an animation as long. Exit code 1 if not.
extends SceneTree

func expected_of(path):
	var file = File.new()
	file.open(path, File.READ)
	file.seek(12)
	var size = file.get_32()
	file.get_32()
	var gltf = JSON.parse(file.get_buffer(size).get_string_from_utf8()).result
	var found = {"meshes": 0, "triangles": 0, "seconds": 0.0}
	for node in gltf.nodes:
		if not node.has("mesh"):
			continue
		found.meshes += 1
		for primitive in gltf.meshes[node.mesh].primitives:
			found.triangles += int(gltf.accessors[primitive.indices].count) / 3
	for animation in gltf.get("animations", []):
		for sampler in animation.samplers:
			found.seconds = max(found.seconds, gltf.accessors[sampler.input].max[0])
	return found

func add(node, found):
	if node is MeshInstance:
		found.meshes += 1
		found.triangles += node.mesh.get_faces().size() / 3
	if node is AnimationPlayer:
		for name in node.get_animation_list():
			found.seconds = max(found.seconds, node.get_animation(name).length)
	for child in node.get_children():
		add(child, found)

func check(name):
	var expected = expected_of("res://" + name)
	var found = {"meshes": 0, "triangles": 0, "seconds": 0.0}
	var scene = load("res://" + name)
	if scene != null:
		add(scene.instance(), found)
	var same = found.meshes == expected.meshes and found.triangles == expected.triangles
	same = same and abs(found.seconds - expected.seconds) < 0.05
	print("opened: " if same else "FAULT: ", name, ": ", found, "" if same else ", not " + str(expected))
	return same

func _init():
	var folder = Directory.new()
	folder.open("res://")
	folder.list_dir_begin(true)
	var all_same = true
	var name = folder.get_next()
	while name != "":
		if name.ends_with(".glb"):
			all_same = check(name) and all_same
		name = folder.get_next()
	print("Godot ", Engine.get_version_info().string)
	quit(0 if all_same else 1)
