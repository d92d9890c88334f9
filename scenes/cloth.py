"""Makes cloth.glb, the scene builtin:cloth: velvet draped over a ball on a round plinth.

    blender -b --factory-startup -noaudio -P scenes/cloth.py -- scenes/cloth.glb [--cells N] [--frames N]

The cloth falls by Blender's cloth simulation; everything else is written down here. World space is glTF's:
+y up, metres, camera on the +z side. The simulation runs in Blender's z-up space; blender() and gltf()
convert.
"""

import argparse
import math
import os
import sys

import bpy
import numpy as np
from mathutils import bvhtree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from parts import Glb, backdrop_part, grid_triangles, smooth_normals, softbox_part, swept_part, unit

CLOTH_SIDE = 1.45  # m
CLOTH_SHIFT = (0.035, 0.02)  # x and z of its middle before it falls; off the axis, so no two sides fall alike
CLOTH_TURN = math.radians(112)  # of the drape about +y, to face the camera
UV_SIZE = 0.5  # m of surface a uv unit spans

PLINTH_RADIUS = 0.6
PLINTH_HEIGHT = 0.16
PLINTH_BEVEL = 0.012
PLINTH_FOOT = (0.035, 0.025)  # depth and height of the shadow gap above the floor

# What holds the cloth up, not in the file: a ball on the axis, this high above the plinth's top.
BALL_HEIGHT, BALL_RADIUS = 0.46, 0.2

FLOOR_HALF_WIDTH = 8.0
FLOOR_FRONT, FLOOR_BACK = 6.0, -3.2  # z where the floor begins and where it starts to rise
SWEEP_RADIUS, WALL_TOP = 2.4, 6.0

CAMERA_EYE, CAMERA_TARGET, CAMERA_FOV = (0.4, 1.02, 1.9), (0.0, 0.33, 0.0), 35.0
SOFTBOX_CENTRE, SOFTBOX_TARGET, SOFTBOX_SIDE = (-1.6, 1.7, 0.7), (0.0, 0.4, 0.0), 1.2

MATERIALS = {
    "Cloth": {
        "doubleSided": True,
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.12, 0.004, 0.012, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9},
        "extensions": {"KHR_materials_sheen": {
            "sheenColorFactor": [0.42, 0.1, 0.13], "sheenRoughnessFactor": 0.35}},
    },
    # Plinth and foot are open below; seen from there as well, they keep light from the floor that they hide.
    "Plinth": {"doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [0.62, 0.6, 0.57, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6}},
    "Floor": {"pbrMetallicRoughness": {
        "baseColorFactor": [0.34, 0.325, 0.31, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9}},
    "Softbox": {
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0},
        "emissiveFactor": [1.0, 0.95, 0.88],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 14.0}},
    },
}


def blender(p):
    """From glTF's y-up to Blender's z-up."""
    return (p[0], -p[2], p[1])


def gltf(points):
    """From Blender's z-up to glTF's y-up, for an array of points."""
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


# ---- the drape: Blender's simulation -------------------------------------------------------------


def add_object(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    mesh.update()
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def make_collider(thing, friction):
    thing.modifiers.new("Collision", "COLLISION")
    thing.collision.thickness_outer = 0.004
    thing.collision.thickness_inner = 0.05
    thing.collision.cloth_friction = friction


def add_colliders():
    bpy.ops.mesh.primitive_ico_sphere_add(
        subdivisions=5, radius=BALL_RADIUS, location=blender((0, PLINTH_HEIGHT + BALL_HEIGHT, 0)))
    make_collider(bpy.context.object, 40.0)
    make_collider(add_object("plinth", *joined(plinth_parts(segments=96))), 25.0)
    r = 4.0
    make_collider(add_object("floor", [(-r, -r, 0), (r, -r, 0), (r, r, 0), (-r, r, 0)], [(0, 1, 2, 3)]), 25.0)


def joined(parts):
    """Vertices, in Blender's space, and triangles of several parts as one mesh."""
    vertices, faces, base = [], [], 0
    for part in parts:
        vertices += [blender(p) for p in part["POSITION"]]
        faces += [tuple(base + i for i in t) for t in part["index"]]
        base += len(part["POSITION"])
    return vertices, faces


def cloth_sheet(cells):
    """A flat square just above the ball; vertices row by row, as grid_triangles expects."""
    s = np.linspace(-0.5, 0.5, cells + 1) * CLOTH_SIDE
    u, v = np.meshgrid(s, s)
    x, z = CLOTH_SHIFT[0] + u, CLOTH_SHIFT[1] + v
    y = np.full_like(x, PLINTH_HEIGHT + BALL_HEIGHT + BALL_RADIUS + 0.015)
    vertices = [blender(p) for p in zip(x.ravel(), y.ravel(), z.ravel())]
    row = cells + 1
    faces = [(j * row + i, (j + 1) * row + i, (j + 1) * row + i + 1, j * row + i + 1)
             for j in range(cells) for i in range(cells)]
    return add_object("cloth", vertices, faces)


def drape(cells, frames):
    """The cloth at rest: subdivided once, (2 cells + 1)^2 points in glTF space, row by row."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, frames
    add_colliders()
    cloth = cloth_sheet(cells)
    modifier = cloth.modifiers.new("Cloth", "CLOTH")
    settings, contact = modifier.settings, modifier.collision_settings
    settings.quality = 8
    settings.mass = 0.4
    settings.tension_stiffness = settings.compression_stiffness = 30
    settings.shear_stiffness = 12
    settings.bending_stiffness = 9.0
    settings.tension_damping = settings.compression_damping = settings.shear_damping = 10
    settings.bending_damping = 1.5
    settings.air_damping = 1.0
    contact.collision_quality = 4
    contact.distance_min = 0.004
    contact.use_self_collision = True
    contact.self_distance_min = 0.009
    contact.self_friction = 8
    modifier.point_cache.frame_start, modifier.point_cache.frame_end = 1, frames
    for frame in range(1, frames + 1):
        scene.frame_set(frame)
        if frame % 10 == 0:
            print(f"frame {frame} of {frames}", flush=True)
    return rest_points(cloth)


def rest_points(cloth):
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = cloth.evaluated_get(graph).to_mesh()
    points = np.empty(3 * len(mesh.vertices), dtype=np.float64)
    mesh.vertices.foreach_get("co", points)
    side = math.isqrt(len(mesh.vertices))
    return subdivide(gltf(points.reshape(-1, 3)).reshape(side, side, 3))


def turned(grid, angle):
    """About +y. Ball and plinth are round, so a drape may be turned after its fall."""
    c, s = math.cos(angle), math.sin(angle)
    return grid @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def subdivide(grid):
    """One step of cubic B-spline subdivision (Catmull and Clark 1978, regular grid); borders are curves."""
    for axis in (0, 1):
        a = np.moveaxis(grid, axis, 0)
        fine = np.empty((2 * a.shape[0] - 1,) + a.shape[1:])
        fine[1::2] = (a[:-1] + a[1:]) / 2
        fine[0], fine[-1] = a[0], a[-1]
        fine[2:-1:2] = (a[:-2] + 6 * a[1:-1] + a[2:]) / 8
        grid = np.moveaxis(fine, 0, axis)
    return grid


# ---- parts: dictionaries of glTF attributes and triangles ----------------------------------------


def cloth_part(grid):
    rows, columns, _ = grid.shape
    position = grid.reshape(-1, 3)
    index = grid_triangles(rows, columns)
    u, v = np.meshgrid(np.linspace(0, 1, columns), np.linspace(0, 1, rows))
    uv = np.stack([u.ravel(), v.ravel()], 1) * CLOTH_SIDE / UV_SIZE
    return {"POSITION": position, "NORMAL": smooth_normals(position, index), "TEXCOORD_0": uv, "index": index}


def lathe_part(profile, segments):
    """Turns a profile, rows of (radius, y, radial normal, y normal), about the y axis."""
    profile = np.asarray(profile, dtype=np.float64)
    angle = np.linspace(0, 2 * math.pi, segments + 1)
    ring = np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], 1)
    up = np.array([0.0, 1.0, 0.0])
    radius, y, out, above = (column[:, None, None] for column in profile.T)
    position, normal = radius * ring + y * up, out * ring + above * up
    length = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(profile[:, :2], axis=0).T))])
    around = angle * profile[:, 0].max()
    uv = np.stack(np.broadcast_arrays(around[None, :], length[:, None]), 2)
    return swept_part(position, unit(normal), uv, UV_SIZE)


def arc(radius, y, bevel, start, end, steps=6):
    """A bevel's profile about (radius, y), angles in degrees from the radial direction."""
    t = np.radians(np.linspace(start, end, steps + 1))
    return [(radius + bevel * math.cos(a), y + bevel * math.sin(a), math.cos(a), math.sin(a)) for a in t]


def plinth_parts(segments=192, top_rings=12, side_rings=6):
    """Rings divide the top and the side, since shadows and occlusion may be kept at the vertices."""
    r, h, b = PLINTH_RADIUS, PLINTH_HEIGHT, PLINTH_BEVEL
    depth, gap = PLINTH_FOOT
    top = [(radius, h, 0, 1) for radius in np.linspace(0, r - b, top_rings, endpoint=False)]
    side = [(r, y, 1, 0) for y in np.linspace(h - b, gap + b, side_rings, endpoint=False)[1:]]
    body = top + arc(r - b, h - b, b, 90, 0) + side + arc(r - b, gap + b, b, 0, -90) + [(r - depth, gap, 0, -1)]
    foot = [(r - depth, gap, 1, 0), (r - depth, 0.0, 1, 0)]
    return [lathe_part(body, segments), lathe_part(foot, segments)]


# ---- checks --------------------------------------------------------------------------------------


def crossings(part):
    """Pairs of the part's triangles that meet without sharing a vertex."""
    index = part["index"].tolist()
    tree = bvhtree.BVHTree.FromPolygons(part["POSITION"].tolist(), index, all_triangles=True)
    return sum(1 for a, b in tree.overlap(tree) if a < b and not set(index[a]) & set(index[b]))


def depth_below(part):
    """How deep the deepest vertex lies inside the ball, the plinth or the floor, m; negative is clearance."""
    p = part["POSITION"]
    ball = BALL_RADIUS - np.linalg.norm(p - [0, PLINTH_HEIGHT + BALL_HEIGHT, 0], axis=1)
    plinth = np.minimum(PLINTH_HEIGHT - p[:, 1], PLINTH_RADIUS - np.hypot(p[:, 0], p[:, 2]))
    return float(np.max([ball, plinth, -p[:, 1]]))


def main():
    parser = argparse.ArgumentParser(prog="cloth.py")
    parser.add_argument("output")
    parser.add_argument("--cells", type=int, default=64, help="simulated a side; the file has twice as many")
    parser.add_argument("--frames", type=int, default=110, help="simulated frames of 1/24 s")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])

    cloth = cloth_part(turned(drape(arguments.cells, arguments.frames), CLOTH_TURN))
    print(f"cloth: {len(cloth['index'])} triangles, {crossings(cloth)} crossings, "
          f"deepest {1000 * depth_below(cloth):.1f} mm")
    glb = Glb(MATERIALS)
    glb.add_mesh("Cloth", [cloth])
    glb.add_mesh("Plinth", plinth_parts())
    glb.add_mesh("Floor", [backdrop_part(FLOOR_HALF_WIDTH, FLOOR_FRONT, FLOOR_BACK, SWEEP_RADIUS, WALL_TOP, UV_SIZE)])
    glb.add_mesh("Softbox", [softbox_part(SOFTBOX_CENTRE, SOFTBOX_TARGET, SOFTBOX_SIDE, SOFTBOX_SIDE)])
    glb.add_camera("Main", CAMERA_EYE, CAMERA_TARGET, CAMERA_FOV)
    glb.write(arguments.output, "cloth", ["KHR_materials_sheen", "KHR_materials_emissive_strength"])


main()
