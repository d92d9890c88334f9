# blender.py - delivered files in Blender's importer: blender --background --python-exit-code 1 --python blender.py -- FILE...
#
# A line a file. An error of the importer ends Blender with 1, and so does a material that lost its base colour, its
# roughness or its normal map.
import json
import struct
import sys

import bpy
import numpy

numpy.bool = bool  # which Blender 3.4 of Debian still asks for


def materials_of(path):
    with open(path, "rb") as file:
        head = file.read(20)
        return json.loads(file.read(struct.unpack_from("<I", head, 12)[0]))["materials"]


def check(wanted, made):
    shader = next(node for node in made.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    facets = wanted.get("pbrMetallicRoughness", {})
    for name, texture, factor in (("Base Color", "baseColorTexture", None),
                                  ("Roughness", "metallicRoughnessTexture", "roughnessFactor")):
        value = shader.inputs[name]
        assert value.is_linked == (texture in facets), f"{made.name}: {name}"
        if factor and texture not in facets:
            assert abs(value.default_value - facets.get(factor, 1.0)) < 1e-5, f"{made.name}: {factor}"
    assert shader.inputs["Normal"].is_linked == ("normalTexture" in wanted), f"{made.name}: normal"


for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.ops.import_scene.gltf(filepath=path) == {"FINISHED"}, path
    wanted = {material["name"]: material for material in materials_of(path)}
    for made in bpy.data.materials:
        check(wanted[made.name], made)
    broken = [image.name for image in bpy.data.images if image.size[0] == 0]
    assert not broken, f"{path}: {broken}"
    print(f"{path}: {len(bpy.data.materials)} materials, {len(bpy.data.images)} images")
