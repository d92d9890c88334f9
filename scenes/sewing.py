"""Makes sewing.glb, the scene builtin:sewing: an old sewing machine that has gathered dust.

    python3 scenes/sewing.py scenes/sewing.glb

Everything is swept, turned or stacked from the numbers below: python3-numpy is all it takes. World space is glTF's:
+y up, metres, camera on the +z side; the needle is on the left, the hand wheel on the right.
"""

import math
import sys

import numpy as np

from parts import Glb, backdrop_part, grid_triangles, softbox_part, unit

BASE_TOP, BED_TOP = 0.035, 0.068  # wooden base, then the iron bed
BED_HALF = (0.19, 0.089)  # in x and z
ARM_Y = 0.255  # of the shaft
PILLAR_X, HEAD_X = 0.118, -0.135
NEEDLE_X, FOOT_X = -0.147, -0.126
WHEEL_X, WHEEL_RADIUS = 0.204, 0.069

CAMERA_EYE, CAMERA_TARGET, CAMERA_FOV = (-0.33, 0.46, 0.96), (0.018, 0.136, 0.0), 27.0
KEY_CENTRE, KEY_SIZE = (-0.75, 0.95, 0.45), (0.7, 0.7)
RIM_CENTRE, RIM_SIZE = (0.85, 0.6, -0.35), (0.25, 0.8)
LIGHTS_TARGET = (0.0, 0.15, 0.0)


def dust(amount, noise=0.9, falloff=1.5, color=(0.62, 0.57, 0.5)):
    return {"weft": {"dust": amount, "dustNoise": noise, "dustScale": 0.04, "dustFalloff": falloff,
                     "dustColor": list(color)}}


def metal(color, roughness, amount):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1.0], "metallicFactor": 1.0,
                                     "roughnessFactor": roughness}, "extras": dust(amount)}


def plain(color, roughness, amount=0.0):
    return {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1.0], "metallicFactor": 0.0,
                                     "roughnessFactor": roughness}, "extras": dust(amount)}


def lamp(color, strength):
    return {**plain((0.0, 0.0, 0.0), 1.0), "emissiveFactor": list(color),
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}}


MATERIALS = {
    "Enamel": {**plain((0.006, 0.006, 0.007), 0.5, 0.3), "extensions": {"KHR_materials_clearcoat": {
        "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.07}}},
    "Brass": metal((0.78, 0.52, 0.2), 0.28, 0.15),
    "Steel": metal((0.62, 0.61, 0.59), 0.22, 0.15),
    "Wood": {**plain((0.085, 0.033, 0.014), 0.45, 0.22), "extensions": {"KHR_materials_clearcoat": {
        "clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.3}}},
    "Thread": {**plain((0.35, 0.02, 0.025), 0.7, 0.1), "extensions": {"KHR_materials_sheen": {
        "sheenColorFactor": [0.4, 0.1, 0.1], "sheenRoughnessFactor": 0.4}}},
    "Cloth": {**plain((0.035, 0.075, 0.105), 0.9), "doubleSided": True, "extensions": {"KHR_materials_sheen": {
        "sheenColorFactor": [0.2, 0.24, 0.27], "sheenRoughnessFactor": 0.5}}},
    "Floor": plain((0.3, 0.285, 0.265), 0.85),
    "Softbox": lamp((1.0, 0.95, 0.88), 15.0),
    "Strip": lamp((0.8, 0.9, 1.0), 8.0),
}


# ---- solids from rings of points -----------------------------------------------------------------


def welded_normals(position, index):
    """Area-weighted, so that flats beside narrow bevels stay flat; vertices in one place share theirs."""
    _, same = np.unique(np.round(position, 7), axis=0, return_inverse=True)
    p = position[index]
    face = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    total = np.zeros((same.max() + 1, 3))
    for corner in range(3):
        np.add.at(total, same[index[:, corner]], face)
    return unit(total[same] + [0.0, 1e-30, 0.0])


def solid(grid):
    """A closed part from rings of points, its triangles turned outwards."""
    rows, columns, _ = grid.shape
    position, index = grid.reshape(-1, 3), grid_triangles(rows, columns)
    p = position[index] - position.mean(0)
    face = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    if np.einsum("ij,ij->", face, p[:, 0]) < 0:
        index = index[:, ::-1]
    index = index[np.linalg.norm(face, axis=1) > 1e-12]
    used, small = np.unique(index, return_inverse=True)
    position, index = position[used], small.reshape(-1, 3)
    return {"POSITION": position, "NORMAL": welded_normals(position, index), "index": index}


def placed(points, origin, axis):
    """Points made about +y, moved to an origin with +y along an axis; where that is not upright, z is down or up."""
    y = unit(axis)
    x = unit(np.cross(y, (0.0, 0.0, 1.0) if abs(y[1]) > 0.9 else (0.0, -1.0, 0.0)))
    return points @ np.stack([x, y, np.cross(x, y)]) + np.asarray(origin)


def bevelled(points, size=0.0006, steps=2):
    """A profile whose inner corners are rounded off, each by a circle that touches its sides."""
    points = [np.asarray(p, dtype=np.float64) for p in points]
    out = [points[0]]
    for before, at, after in zip(points, points[1:], points[2:]):
        a, b = before - at, after - at
        reach = min(size, 0.45 * np.linalg.norm(a), 0.45 * np.linalg.norm(b))
        p, q = at + reach * unit(a), at + reach * unit(b)
        t = np.linspace(0.0, 1.0, steps + 1)[:, None]
        out += list((1 - t) ** 2 * p + 2 * t * (1 - t) * at + t**2 * q)
    return np.array(out + [points[-1]])


def lathe(profile, origin=(0, 0, 0), axis=(0, 1, 0), segments=40, bevel=0.0006):
    """Turns a profile, rows of (radius, height), about an axis; a radius of 0 at its ends closes it."""
    profile = bevelled(profile, bevel)
    angle = np.linspace(0, 2 * math.pi, segments + 1)
    angle[-1] = 0.0
    radius, height = profile[:, :1], profile[:, 1:]
    grid = np.stack(np.broadcast_arrays(radius * np.cos(angle), height, radius * np.sin(angle)), 2)
    return solid(placed(grid, origin, axis))


def ring(profile, **where):
    """The same of a closed profile."""
    return lathe([*profile, profile[0]], **where)


def rounded(half_x, half_z, radius, inset=0.0, corner=8):
    """The outline of a rounded rectangle, `inset` inwards, as rows of (x, z), closed."""
    r = max(radius - inset, 0.0)
    cx, cz = half_x - inset - r, half_z - inset - r
    t = np.linspace(0, math.pi / 2, corner + 1)
    quarters = [np.stack([sx * cx + r * np.cos(t + a), sz * cz + r * np.sin(t + a)], 1)
                for sx, sz, a in ((1, 1, 0), (-1, 1, math.pi / 2), (-1, -1, math.pi), (1, -1, 1.5 * math.pi))]
    outline = np.concatenate(quarters)
    return np.concatenate([outline, outline[:1]])


def slab(half_x, half_z, radius, profile, origin=(0, 0, 0), axis=(0, 1, 0), bevel=0.0008, corner=6):
    """A rounded rectangle stacked along a profile, rows of (inset, height), and closed at both ends."""
    rings = [np.stack([o[:, 0], np.full(len(o), h), o[:, 1]], 1)
             for inset, h in bevelled(profile, bevel) for o in (rounded(half_x, half_z, radius, inset, corner),)]
    ends = [np.broadcast_to(r.mean(0) * [0, 1, 0], r.shape) for r in (rings[0], rings[-1])]
    return solid(placed(np.stack([ends[0], *rings, ends[1]]), origin, axis))


def tube(path, radius, segments=10):
    """A round wire along a path, its frame carried on from point to point; closed at both ends."""
    path = np.asarray(path, dtype=np.float64)
    radius = np.broadcast_to(radius, len(path))
    tangent = unit(np.gradient(path, axis=0))
    x = unit(np.cross(tangent[0], (0.3, 0.5, 0.8)))
    angle = np.linspace(0, 2 * math.pi, segments + 1)
    angle[-1] = 0.0
    rings = []
    for p, t, r in zip(path, tangent, radius):
        x = unit(x - t * np.dot(x, t))
        rings.append(p + r * (np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * np.cross(t, x)))
    ends = [np.broadcast_to(path[k], rings[0].shape) for k in (0, -1)]
    return solid(np.stack([ends[0], *rings, ends[1]]))


def curve(points, count):
    """A smooth path through points. Edwin Catmull, Raphael Rom, "A Class of Local Interpolating Splines", 1974."""
    p = np.asarray(points, dtype=np.float64)
    p = np.concatenate([2 * p[:1] - p[1:2], p, 2 * p[-1:] - p[-2:-1]])
    out = []
    for s in np.linspace(0, len(points) - 1, count):
        k = min(int(s), len(points) - 2)
        t, (a, b, c, d) = s - k, p[k:k + 4]
        out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3))
    return np.array(out)


# ---- the casting: pillar, arm and head in one sweep ----------------------------------------------

# Along the middle of the casting: a line or an arc each; the sizes of its section at lengths along it, half across
# the plane of the sweep and half along z.
PILLAR_BEND, HEAD_BEND = 0.07, 0.052
SPINE = [
    ("line", (PILLAR_X, BED_TOP - 0.004), (PILLAR_X, ARM_Y - PILLAR_BEND)),
    ("arc", (PILLAR_X - PILLAR_BEND, ARM_Y - PILLAR_BEND), PILLAR_BEND, 0, 90),
    ("line", (PILLAR_X - PILLAR_BEND, ARM_Y), (HEAD_X + HEAD_BEND, ARM_Y)),
    ("arc", (HEAD_X + HEAD_BEND, ARM_Y - HEAD_BEND), HEAD_BEND, 90, 180),
    ("line", (HEAD_X, ARM_Y - HEAD_BEND), (HEAD_X, 0.14)),
]
SIZES = [(0.0, 0.064, 0.058), (0.012, 0.056, 0.052), (0.045, 0.047, 0.044), (0.12, 0.046, 0.042),
         (0.23, 0.038, 0.034), (0.3, 0.031, 0.029), (0.37, 0.031, 0.029), (0.44, 0.034, 0.032), (0.6, 0.034, 0.032)]
GROOVES = (0.052, 0.262, 0.356, 0.478)  # lengths along the spine; a brass line runs between each two of them
GROOVE_APART, GROOVE_WIDTH, GROOVE_DEPTH = 0.0065, 0.0028, 0.0011


def spine(length):
    """Point and direction of the casting's middle after so much of its length, or beyond its end."""
    for kind, *piece in SPINE:
        if kind == "line":
            a, b = np.array(piece[0]), np.array(piece[1])
            whole, direction = np.linalg.norm(b - a), unit(b - a)
            at = a + length * direction
        else:
            centre, r, start, end = piece
            whole, angle = r * math.radians(end - start), math.radians(start) + length / r
            at = np.array(centre) + r * np.array([math.cos(angle), math.sin(angle)])
            direction = np.array([-math.sin(angle), math.cos(angle)])
        if length <= whole:
            break
        length -= whole
    return at, direction


def spine_length():
    return sum(np.linalg.norm(np.subtract(*piece)) if kind == "line" else piece[1] * math.radians(piece[3] - piece[2])
               for kind, *piece in SPINE)


def sizes(length):
    """Half sizes there, smooth between the rows of SIZES."""
    at = np.array(SIZES)
    k = int(np.clip(np.searchsorted(at[:, 0], length) - 1, 0, len(at) - 2))
    t = np.clip((length - at[k, 0]) / (at[k + 1, 0] - at[k, 0]), 0.0, 1.0)
    slope = np.gradient(at[:, 1:], at[:, 0], axis=0)
    h = at[k + 1, 0] - at[k, 0]
    return ((2 * t**3 - 3 * t**2 + 1) * at[k, 1:] + (t**3 - 2 * t**2 + t) * h * slope[k]
            + (3 * t**2 - 2 * t**3) * at[k + 1, 1:] + (t**3 - t**2) * h * slope[k + 1])


def section(length, inwards, segments, lower=0.0):
    """A ring of the casting: a rounded box, |x/a|^n + |z/b|^n = 1 with n = 3.2, `inwards` smaller."""
    angle = np.linspace(0, 2 * math.pi, segments + 1)
    angle[-1] = 0.0
    c, s = np.cos(angle), np.sin(angle)
    n = 3.2
    r = (np.abs(c) ** n + np.abs(s) ** n) ** (-1 / n)
    a, b = sizes(length) - inwards
    p, d = spine(length + lower)
    out = np.array([d[1], -d[0]])
    plane = p + (a * r * c)[:, None] * out
    return np.stack([plane[:, 0], plane[:, 1], b * r * s], 1)


def groove(length):
    """Depth of the engraved lines at a length."""
    near = min(abs(length - g + side * GROOVE_APART / 2) for g in GROOVES for side in (-1, 1))
    return GROOVE_DEPTH * max(0.0, 1.0 - (2 * near / GROOVE_WIDTH) ** 2)


def casting(segments=56):
    end, round_off = spine_length(), 0.007
    stations = set(np.linspace(0.0, end - round_off, 64).tolist())
    for g in GROOVES:
        for side in (-1, 1):
            middle = g + side * GROOVE_APART / 2
            stations |= set((middle + GROOVE_WIDTH * np.linspace(-0.7, 0.7, 6)).tolist())
    rings = [section(s, groove(s), segments) for s in sorted(stations)]
    for t in np.radians(np.linspace(0, 90, 7)[1:]):
        rings.append(section(end - round_off, round_off * (1 - math.cos(t)), segments, round_off * math.sin(t)))
    middle = np.broadcast_to(rings[-1].mean(0), rings[-1].shape)
    return solid(np.stack([*rings, 0.4 * rings[-1] + 0.6 * middle, middle]))


def brass_lines(segments=56):
    """Bands laid round the casting between its grooves."""
    parts = []
    for g in GROOVES:
        w, h = 0.0015, 0.0004
        rows = [(-w, 0.001), (-w, -h), (w, -h), (w, 0.001)]
        parts.append(solid(np.stack([section(g + s, inwards, segments) for s, inwards in bevelled(rows, 0.0002, 1)])))
    return parts


# ---- the rest ------------------------------------------------------------------------------------


def screw(origin, axis=(0, 1, 0), radius=0.0042, height=0.0022, turn=0.0):
    """A domed head in two halves, the slot between them."""
    gap, r, halves = 0.16, radius, []
    for side in (0.0, math.pi):
        t = np.linspace(math.asin(gap), math.pi - math.asin(gap), 11)
        outline = np.stack([np.cos(t), np.sin(t)], 1)
        outline = np.concatenate([outline, outline[:1]])
        centre = outline.mean(0)
        rings = []
        for inset, y in ((0.0, -0.001), (0.0, 0.45 * height), (0.08, 0.75 * height), (0.3, height), (1.0, height)):
            o = r * (centre + (1 - inset) * (outline - centre))
            c, s = math.cos(turn + side), math.sin(turn + side)
            rings.append(np.stack([c * o[:, 0] - s * o[:, 1], np.full(len(o), y), s * o[:, 0] + c * o[:, 1]], 1))
        halves.append(solid(placed(np.stack(rings), origin, axis)))
    return halves


def bed():
    """Iron, with a groove engraved along its edge."""
    h = BED_TOP - BASE_TOP
    return slab(*BED_HALF, 0.03, [(0.004, 0), (0, 0.001), (0, 0.011), (0.003, 0.013), (0.003, h - 0.0022), (0.0052, h),
                                  (0.011, h), (0.0118, h - 0.0012), (0.0128, h - 0.0012), (0.0136, h), (0.03, h)],
                (0, BASE_TOP, 0), corner=12)


def bed_line():
    h = BED_TOP - BASE_TOP
    inner, outer = 0.0165, 0.0149
    rows = [(outer, h - 0.001), (outer, h + 0.0003), (inner, h + 0.0003), (inner, h - 0.001)]
    rings = [np.stack([o[:, 0], np.full(len(o), y), o[:, 1]], 1)
             for inset, y in rows for o in (rounded(*BED_HALF, 0.03, inset, 12),)]
    return solid(np.stack(rings) + [0, BASE_TOP, 0])


def base():
    return slab(0.215, 0.113, 0.014, [(0.01, 0), (0, 0.001), (0, 0.02), (0.006, 0.024), (0.006, BASE_TOP),
                                      (0.03, BASE_TOP)], corner=8)


def wheel():
    """Rim, six bowed spokes and hub about the shaft."""
    where = {"origin": (WHEEL_X, ARM_Y, 0), "axis": (1, 0, 0)}
    r = WHEEL_RADIUS
    rim = ring([(r - 0.0125, -0.009), (r - 0.003, -0.0105), (r, -0.007), (r, -0.003), (r - 0.0022, -0.0018),
                (r - 0.0022, 0.0018), (r, 0.003), (r, 0.007), (r - 0.003, 0.0105), (r - 0.0125, 0.009)],
               segments=72, bevel=0.0012, **where)
    hub = lathe([(0, -0.15), (0.031, -0.15), (0.029, -0.05), (0.0275, -0.046), (0.0262, -0.0445), (0.0262, -0.0425),
                 (0.0275, -0.041), (0.0275, -0.031), (0.0245, -0.028), (0.0165, -0.027), (0.0165, 0.006),
                 (0.014, 0.009), (0, 0.009)], segments=40, bevel=0.001, **where)
    spokes = []
    for k in range(6):
        t = math.radians(60 * k + 12)
        out, along = np.array([0, math.cos(t), math.sin(t)]), np.array([0, -math.sin(t), math.cos(t)])
        path = [np.array(where["origin"]) + out * a + along * b - np.array([c, 0, 0])
                for a, b, c in ((0.012, 0, 0.004), (0.028, 0.0035, 0.003), (0.045, 0.003, 0.001), (r - 0.008, 0, 0))]
        spokes.append(tube(curve(path, 14), np.linspace(0.0052, 0.0036, 14), 12))
    return [rim, hub, *spokes]


def clutch():
    """The knurled nut that lets the wheel run free, with a screw in it."""
    angle = np.linspace(0, 2 * math.pi, 73)
    angle[-1] = 0.0
    knurl = np.where(np.arange(73) % 4 < 2, 1.0, 0.955)
    knurl[-1] = knurl[0]
    rows = [(0, 0.009), (0.019, 0.009), (0.02, 0.01), (0.02, 0.0165), (0.0185, 0.0185), (0.006, 0.0195), (0, 0.0195)]
    grid = np.stack([np.stack([r * np.cos(angle) * (knurl if r > 0.0188 else 1.0), np.full(73, y),
                               r * np.sin(angle) * (knurl if r > 0.0188 else 1.0)], 1) for r, y in rows])
    nut = solid(placed(grid, (WHEEL_X, ARM_Y, 0), (1, 0, 0)))
    return [nut, *screw((WHEEL_X + 0.0195, ARM_Y, 0), (1, 0, 0), 0.005, 0.0025, 0.7)]


def bars():
    """Needle bar, needle and clamp; presser bar and its foot with two toes."""
    y = BED_TOP
    bar = lathe([(0, 0.03), (0.0036, 0.03), (0.0036, 0.11), (0, 0.11)], (NEEDLE_X, y, 0), segments=24)
    clamp = lathe([(0, 0.026), (0.0052, 0.026), (0.0052, 0.034), (0, 0.034)], (NEEDLE_X, y, 0), segments=24)
    needle = lathe([(0, 0.0005), (0.0008, 0.006), (0.0009, 0.022), (0.0012, 0.028), (0, 0.028)], (NEEDLE_X, y, 0),
                   segments=12, bevel=0.0001)
    thumb = lathe([(0, 0), (0.0016, 0), (0.0016, 0.007), (0.0042, 0.008), (0.0042, 0.012), (0, 0.012)],
                  (NEEDLE_X, y + 0.03, 0.003), (0, 0, 1), 20, 0.0004)
    presser = lathe([(0, 0.012), (0.0034, 0.012), (0.0034, 0.11), (0, 0.11)], (FOOT_X, y, 0), segments=24)
    shank = lathe([(0, 0.009), (0.005, 0.009), (0.005, 0.024), (0, 0.024)], (FOOT_X, y, 0), segments=24)
    arm = slab(0.5 * (FOOT_X - NEEDLE_X) + 0.004, 0.005, 0.002, [(0.001, 0), (0, 0.001), (0, 0.005), (0.002, 0.005)],
               (0.5 * (FOOT_X + NEEDLE_X), y + 0.006, -0.002), corner=4)
    toes = [tube(curve([(NEEDLE_X + dx, y + 0.0078, -0.008), (NEEDLE_X + dx, y + 0.0034, 0.002),
                        (NEEDLE_X + dx, y + 0.0028, 0.012), (NEEDLE_X + dx, y + 0.0068, 0.021)], 14), 0.0021, 12)
            for dx in (-0.0042, 0.0042)]
    return [bar, clamp, needle, thumb, presser, shank, arm, *toes]


def face_plate():
    """On the end of the head, with an engraved oval and two screws."""
    x, y = HEAD_X - 0.0335, ARM_Y - 0.068
    cover = slab(0.021, 0.042, 0.02, [(0, -0.002), (0, 0.002), (0.004, 0.0026), (0.0048, 0.0018), (0.006, 0.0018),
                                      (0.0068, 0.0026), (0.012, 0.003)], (x, y, 0), (-1, 0, 0), 0.0003, 14)
    return [cover, *screw((x - 0.003, y + 0.03, 0), (-1, 0, 0), 0.0038, 0.002, 0.4),
            *screw((x - 0.003, y - 0.03, 0), (-1, 0, 0), 0.0038, 0.002, 1.1)]


def tension():
    """Two discs on a stud, a coil before them and a knurled nut; a loop over them takes up the thread."""
    where = {"origin": (HEAD_X, ARM_Y - 0.078, 0.0315), "axis": (0, 0, 1)}
    discs = lathe([(0, -0.004), (0.013, -0.004), (0.0135, -0.001), (0.012, 0.0015), (0.005, 0.003), (0.012, 0.0045),
                   (0.0135, 0.007), (0.013, 0.009), (0.006, 0.0095), (0, 0.0095)], segments=48, bevel=0.0008, **where)
    turns = np.linspace(0, 5 * 2 * math.pi, 70)
    coil = tube(np.stack([where["origin"][0] + 0.0058 * np.cos(turns), where["origin"][1] + 0.0058 * np.sin(turns),
                          where["origin"][2] + 0.0105 + 0.0075 * turns / turns[-1]], 1), 0.0006, 6)
    return discs, coil, lathe([(0, 0.018), (0.0075, 0.018), (0.0075, 0.026), (0.006, 0.028), (0, 0.028)], segments=32,
                              bevel=0.0008, **where)


def take_up():
    path = [(HEAD_X - 0.013, ARM_Y - 0.03, 0.028), (HEAD_X - 0.013, ARM_Y - 0.028, 0.04),
            (HEAD_X - 0.015, ARM_Y - 0.02, 0.046), (HEAD_X - 0.02, ARM_Y - 0.012, 0.048)]
    eye = np.linspace(0, 2 * math.pi, 21)
    loop = [(HEAD_X - 0.0232 + 0.0034 * math.cos(a), ARM_Y - 0.0105 + 0.0034 * math.sin(a), 0.048) for a in eye]
    return [tube(curve(path, 18), 0.0019, 12), tube(loop, 0.0011, 8)]


def spool_pin(x):
    return lathe([(0, -0.004), (0.0085, -0.004), (0.0085, 0.0015), (0.004, 0.004), (0.0021, 0.006), (0.0021, 0.058),
                  (0.0012, 0.06), (0, 0.06)], (x, pin_foot(x), 0), segments=24, bevel=0.0005)


def pin_foot(x):
    """The height of the arm's top at an x."""
    length = spine_length() - (HEAD_BEND * math.pi / 2 + ARM_Y - HEAD_BEND - 0.14) - (x - HEAD_X - HEAD_BEND)
    return ARM_Y + sizes(length)[0]


SPOOL_X, FREE_PIN_X = 0.012, -0.04


def spool():
    """Wooden flanges, and thread wound on in ridges between them."""
    where = {"origin": (SPOOL_X, pin_foot(SPOOL_X) + 0.0045, 0), "segments": 32}
    ends = [lathe([(0.0024, y), (0.0165, y), (0.0178, y + 0.0012), (0.0178, y + 0.0028), (0.0165, y + 0.004),
                   (0.0024, y + 0.004), (0.0024, y)], **where) for y in (0.0, 0.04)]
    y = np.linspace(0.004, 0.04, 61)
    bulge = 0.0138 + 0.0016 * np.sin(math.pi * (y - 0.004) / 0.036) + 0.0003 * (np.arange(61) % 2)
    wound = lathe([(0.002, 0.004), *zip(bulge, y), (0.002, 0.04)], bevel=0.0, **where)
    return ends, wound


def thread():
    """From the spool over the arm, round the discs, up to the loop and down to the needle."""
    top = pin_foot(SPOOL_X) + 0.03
    path = [(SPOOL_X - 0.004, top, 0.0145), (-0.05, top - 0.012, 0.022), (HEAD_X + 0.03, ARM_Y + 0.035, 0.026),
            (HEAD_X + 0.016, ARM_Y - 0.02, 0.0405), (HEAD_X + 0.0075, ARM_Y - 0.083, 0.0378),
            (HEAD_X - 0.004, ARM_Y - 0.0905, 0.037), (HEAD_X - 0.0125, ARM_Y - 0.078, 0.0385),
            (HEAD_X - 0.0215, ARM_Y - 0.012, 0.0475), (HEAD_X - 0.024, ARM_Y - 0.016, 0.0485),
            (HEAD_X - 0.018, ARM_Y - 0.1, 0.036), (NEEDLE_X - 0.001, BED_TOP + 0.034, 0.0065),
            (NEEDLE_X, BED_TOP + 0.008, 0.0014), (NEEDLE_X, BED_TOP + 0.0012, 0.0)]
    return tube(curve(path, 120), 0.00045, 5)


def regulator():
    """The stitch length: a slotted plate on the pillar with a lever through it."""
    z = sizes(0.07)[1] - 0.0006
    x, y = PILLAR_X, BED_TOP + 0.078
    outer = slab(0.0115, 0.03, 0.0105, [(0, -0.003), (0, 0.0016), (0.0008, 0.002), (0.0075, 0.002), (0.0082, -0.0005),
                                        (0.0105, -0.0005)], (x, y, z), (0, 0, 1), 0.0003, 10)
    knob = lathe([(0, -0.002), (0.0026, -0.002), (0.0026, 0.006), (0.006, 0.0075), (0.007, 0.011), (0.006, 0.0145),
                  (0, 0.0155)], (x, y - 0.008, z), (0, 0, 1), 32, 0.0012)
    return outer, knob, screw((x, y + 0.0253, z + 0.002), (0, 0, 1), 0.003, 0.0014, 0.9)


def badge():
    """An oval of brass where pillar meets arm."""
    x, y = PILLAR_X, ARM_Y - 0.066
    z = sizes(0.12)[1] - 0.0004
    return slab(0.0135, 0.019, 0.0134, [(0, -0.003), (0, 0.0012), (0.0012, 0.002), (0.0024, 0.002), (0.003, 0.0012),
                                        (0.0045, 0.0012), (0.006, 0.0022), (0.012, 0.0026)],
                (x, y, z), (0, 0, 1), 0.0003, 14)


def plates():
    """Needle plate and slide plate in the bed."""
    x, y, edge = NEEDLE_X + 0.002, BED_TOP - 0.0002, [(0, -0.002), (0, 0.001), (0.003, 0.001)]
    return [slab(0.0225, half, 0.003, edge, (x, y, z), bevel=0.0004) for half, z in ((0.019, 0), (0.0265, 0.047))]


def cloth(rows=70, columns=48):
    """A strip that lies under the foot, runs over the front of bed and base and spreads in folds on the floor."""
    lift = 0.0009
    path = bevelled([(-0.075, BED_TOP), (BED_HALF[1] + 0.003, BED_TOP), (0.1175, BASE_TOP + 0.004), (0.15, 0.0),
                     (0.2, 0.0)], 0.02, 8)
    steps = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    s = np.linspace(0, steps[-1], rows)
    z, y = np.interp(s, steps, path[:, 0]), np.interp(s, steps, path[:, 1])
    d = np.gradient(np.stack([y, z], 1), axis=0)
    up = unit(np.stack([d[:, 1], -d[:, 0]], 1))  # (y, z), off the surface
    u = np.linspace(0, 1, columns)
    free = np.clip((s - 0.14) / 0.12, 0, 1)[:, None] ** 1.3
    fold = 0.5 + 0.5 * np.sin(2 * math.pi * (3.2 * u + 0.35 * np.sin(5 * u)) + 0.9 * np.sin(9 * s)[:, None])
    height = lift + 0.017 * free * fold**1.5 + 0.0006 * np.sin(23 * u + 40 * s[:, None])**2
    x = NEEDLE_X + 0.006 + (u - 0.5) * 0.125 * (1 + 0.35 * free) + 0.01 * free * np.sin(11 * s)[:, None]
    grid = np.stack([x, y[:, None] + height * up[:, :1], z[:, None] + height * up[:, 1:]], 2)
    position, index = grid.reshape(-1, 3), grid_triangles(rows, columns)
    normal = welded_normals(position, index)
    if normal[0, 1] < 0:
        index, normal = index[:, ::-1], -normal
    uv = np.stack(np.broadcast_arrays(u * 0.125, s[:, None]), 2).reshape(-1, 2) / 0.1
    return {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "index": index}


def bed_screws():
    return [half for x, z, t in ((0.165, 0.066, 0.3), (0.165, -0.066, 2.0), (0.03, 0.066, 1.7))
            for half in screw((x, BED_TOP, z), turn=t, radius=0.0046)]


def joined(parts):
    """Parts of one material as one."""
    base = np.cumsum([0] + [len(part["POSITION"]) for part in parts])
    return {"POSITION": np.concatenate([part["POSITION"] for part in parts]),
            "NORMAL": np.concatenate([part["NORMAL"] for part in parts]),
            "index": np.concatenate([part["index"] + first for part, first in zip(parts, base)])}


def main():
    discs, coil, nut = tension()
    slot, knob, slot_screw = regulator()
    flanges, wound = spool()
    lights = [("Softbox", KEY_CENTRE, KEY_SIZE), ("Strip", RIM_CENTRE, RIM_SIZE)]
    meshes = {
        "Enamel": [joined([bed(), casting(), *wheel()])],
        "Brass": [joined([*brass_lines(), bed_line(), badge(), nut, knob])],
        "Steel": [joined([*clutch(), *bars(), *face_plate(), discs, coil, *take_up(), spool_pin(SPOOL_X),
                          spool_pin(FREE_PIN_X), slot, *slot_screw, *plates(), *bed_screws()])],
        "Wood": [joined([base(), *flanges])],
        "Thread": [joined([wound, thread()])],
        "Cloth": [cloth()],
        "Floor": [backdrop_part(4.0, 3.0, -0.9, 0.9, 3.0, 0.5)],
    }
    meshes |= {name: [softbox_part(centre, LIGHTS_TARGET, *size)] for name, centre, size in lights}
    glb = Glb(MATERIALS)
    for name, parts in meshes.items():
        print(f"{name}: {sum(len(part['index']) for part in parts)} triangles")
        glb.add_mesh(name, parts)
    glb.add_camera("Main", CAMERA_EYE, CAMERA_TARGET, CAMERA_FOV)
    glb.write(sys.argv[1], "sewing", ["KHR_materials_clearcoat", "KHR_materials_sheen",
                                      "KHR_materials_emissive_strength"])


main()
