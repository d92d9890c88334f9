"""Renders a glTF file with Blender Cycles on the CPU, under settings equal to weft's, and measures it.

    blender -b --factory-startup -noaudio --python-exit-code 1 --debug-cycles --verbose 2 \\
        -P bench/cycles.py -- SCENE -o OUT.exr

The one line on stdout that begins with "{" is the result, in JSON; README.md beside this file says what each
figure means, and what is made equal. Made for Blender 3.4.
"""

import argparse
import ctypes
import json
import math
import os
import re
import resource
import sys
import tempfile
import time

import bpy
import numpy
from mathutils import Matrix, Vector


def parse():
    parser = argparse.ArgumentParser(prog="cycles.py", formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("scene", help=".gltf or .glb")
    parser.add_argument("-o", "--output", required=True, help=".exr, linear, 32-bit float")
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=480)
    parser.add_argument("--spp", type=int, default=64, help="samples a pixel")
    parser.add_argument("--time", type=float, help="seconds to sample for, instead of --spp")
    parser.add_argument("--max-depth", type=int, default=8, help="bounces after the first hit")
    parser.add_argument("--camera", help="eye;target;vertical fov: x,y,z;x,y,z;degrees; else the file's")
    parser.add_argument("--env", help="lat-long .hdr or .exr, or 'r,g,b'; else black")
    parser.add_argument("--env-strength", type=float, default=1.0)
    parser.add_argument("--env-rotation", type=float, default=0.0, help="degrees about +y")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def numbers(text, count):
    values = [float(part) for part in text.split(",")]
    if len(values) != count:
        raise SystemExit(f"cycles.py: '{text}' is not {count} numbers")
    return values


# ---- the scene -----------------------------------------------------------------------------------

# glTF's y-up to Blender's z-up, as the importer turns it: (x, y, z) -> (x, -z, y).
Y_UP_TO_Z_UP = Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))


def load(path):
    numpy.bool = bool  # numpy 1.24 took the name away, the importer of Blender 3.4 still says it
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # COMPAT takes the intensities of KHR_lights_punctual as W/sr and W/m^2, which weft does too
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(path), convert_lighting_mode="COMPAT")
    for material in bpy.data.materials:
        if material.use_nodes and material.use_backface_culling:
            emit_in_front(material.node_tree)


def emit_in_front(tree):
    """A single-sided material of glTF sends light from its front only; the importer leaves it two-sided."""
    for shader in [node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"]:
        color, strength = shader.inputs["Emission"], shader.inputs["Emission Strength"]
        if strength.default_value == 0 or not (color.is_linked or any(color.default_value[:3])):
            continue
        geometry, front = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMath")
        front.operation = "MULTIPLY_ADD"  # strength (1 - backfacing)
        front.inputs[1].default_value = -strength.default_value
        front.inputs[2].default_value = strength.default_value
        tree.links.new(geometry.outputs["Backfacing"], front.inputs[0])
        tree.links.new(front.outputs[0], strength)


def place_camera(scene, text):
    if text is None:
        scene.camera = next((thing for thing in bpy.data.objects if thing.type == "CAMERA"), None)
        if scene.camera is None:
            raise SystemExit("cycles.py: the file has no camera; say --camera")
        return
    parts = text.split(";")
    eye, target, fov = numbers(parts[0], 3), numbers(parts[1], 3), float(parts[2])
    back = (Vector(eye) - Vector(target)).normalized()
    right = Vector((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    pose = Matrix((right, up, back)).transposed().to_4x4()
    pose.translation = eye
    data = bpy.data.cameras.new("benchmark")
    data.sensor_fit, data.angle_y = "VERTICAL", math.radians(fov)
    data.clip_start, data.clip_end = 1e-4, 1e4
    scene.camera = bpy.data.objects.new("benchmark", data)
    scene.camera.matrix_world = Y_UP_TO_Z_UP @ pose
    scene.collection.objects.link(scene.camera)


def light_environment(scene, text, strength, rotation):
    """Both programs run a lat-long image's columns clockwise seen from above. weft's middle column looks
    along glTF's -z, which the importer turns into Blender's +y; Cycles' looks along +x. So what Cycles looks
    up is the direction turned by a quarter clockwise, less the environment's own turn (counter-clockwise)."""
    world = scene.world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = strength
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    if text is None:
        return
    if not os.path.exists(text):
        background.inputs["Color"].default_value = (*numbers(text, 3), 1)
        return
    picture = tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(os.path.abspath(text))
    picture.image.colorspace_settings.name = "Linear"
    mapping, coordinate = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0, 0, math.radians(-90 - rotation))
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], background.inputs["Color"])


# ---- the settings --------------------------------------------------------------------------------


def equal_settings(scene, arguments):
    scene.render.engine = "CYCLES"
    render, cycles = scene.render, scene.cycles
    render.resolution_x, render.resolution_y = arguments.width, arguments.height
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", arguments.threads
    render.use_compositing = render.use_sequencer = render.use_simplify = False
    render.film_transparent = False
    render.use_motion_blur = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    render.image_settings.exr_codec = "ZIP"
    render.filepath = os.path.abspath(arguments.output)
    render.use_file_extension = False
    scene.view_settings.view_transform = "Raw"
    scene.view_settings.look = "None"

    cycles.device = "CPU"
    cycles.samples = 2**24 if arguments.time else arguments.spp
    cycles.time_limit = arguments.time or 0
    cycles.seed = arguments.seed
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.use_auto_tile = False
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 1.5
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = arguments.max_depth
    cycles.transmission_bounces = cycles.volume_bounces = arguments.max_depth
    cycles.transparent_max_bounces = max(8, arguments.max_depth)


# ---- the measurement -----------------------------------------------------------------------------


def cpu_seconds():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return use.ru_utime + use.ru_stime


def resident(kind):
    """VmRSS, the memory resident now, or VmHWM, the most so far; bytes."""
    with open("/proc/self/status") as file:
        return 1024 * int(re.search(kind + r":\s+(\d+) kB", file.read())[1])


class Capture:
    """What the process writes to stdout and stderr, kept from the terminal; as text once it is over."""

    def __enter__(self):
        self.file = tempfile.TemporaryFile()
        self.kept = [(fd, os.dup(fd)) for fd in (1, 2)]
        self.redirect([(fd, self.file.fileno()) for fd in (1, 2)])
        return self

    def __exit__(self, *_):
        self.redirect(self.kept)
        for _, fd in self.kept:
            os.close(fd)
        self.file.seek(0)
        self.text = self.file.read().decode(errors="replace")

    @staticmethod
    def redirect(pairs):
        sys.stdout.flush()
        ctypes.CDLL(None).fflush(None)
        for fd, source in pairs:
            os.dup2(source, fd)


def render():
    """Renders; returns Cycles' words, and the moments (clock, CPU seconds) at which its status changed."""
    moments = []
    bpy.app.handlers.render_stats.append(lambda *_: moments.append((time.perf_counter(), cpu_seconds())))
    with Capture() as capture:
        bpy.ops.render.render(write_still=True)
    return capture.text, moments


def result(arguments, log, moments, started, before):
    summary = re.search(r"Rendered (\d+) samples in ([\d.]+) seconds\n", log)
    if not summary:
        raise SystemExit(log + "cycles.py: no timing: start blender with --debug-cycles --verbose 2")
    spp, seconds = int(summary[1]), float(summary[2])
    begin, end = sampling(moments, seconds)
    scene = bpy.context.scene
    peaks = re.findall(r"\| Mem:[\d.]+M, Peak:([\d.]+)M", log)
    return {
        "renderer": f"Blender {bpy.app.version_string} Cycles",
        "scene": os.path.basename(arguments.scene),
        "width": scene.render.resolution_x, "height": scene.render.resolution_y, "spp": spp,
        "max_depth": scene.cycles.max_bounces, "threads": scene.render.threads,
        "triangles": triangles(),
        "sampling_seconds": seconds,
        "sampling_cpu_seconds": round(end[1] - begin[1], 3),
        "render_seconds": round(end[0] - moments[0][0], 3),
        "total_seconds": round(time.perf_counter() - started, 3),
        "samples_per_second": round(scene.render.resolution_x * scene.render.resolution_y * spp / seconds),
        "peak_resident_bytes": resident("VmHWM"), "resident_before_bytes": before,
        "cycles_peak_bytes": round(2**20 * max(map(float, peaks), default=0.0)),
    }


def sampling(moments, seconds):
    """The moments at which Cycles began and ended to sample: its status changes at both, and the last two
    changes are its end and Blender's."""
    end = moments[-2]
    return min(moments, key=lambda moment: abs(end[0] - seconds - moment[0])), end


def triangles():
    graph = bpy.context.evaluated_depsgraph_get()
    return sum(len(polygon.vertices) - 2 for instance in graph.object_instances
               if instance.object.type == "MESH" for polygon in instance.object.data.polygons)


def main():
    started = time.perf_counter()
    arguments = parse()
    load(arguments.scene)
    scene = bpy.context.scene
    place_camera(scene, arguments.camera)
    light_environment(scene, arguments.env, arguments.env_strength, arguments.env_rotation)
    equal_settings(scene, arguments)
    before = resident("VmRSS")
    log, moments = render()
    print(json.dumps(result(arguments, log, moments, started, before)), flush=True)


main()
