"""What the scripts of this folder make scenes from: meshes as grids of points, and the glTF file they go into.

A part is a dictionary of glTF attributes, POSITION and NORMAL and perhaps TEXCOORD_0, and `index`, its triangles.
World space is glTF's: +y up, metres.
"""

import json
import math
import struct

import numpy as np


def unit(v):
    v = np.asarray(v, dtype=np.float64)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def grid_triangles(rows, columns):
    """Two triangles a cell of a grid stored row by row, split along alternating diagonals."""
    j, i = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (j * columns + i).ravel()
    b, c, d = a + columns, a + columns + 1, a + 1
    odd = ((i + j) % 2 == 1).ravel()[:, None]
    first = np.where(odd, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(odd, np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return np.stack([first, second], 1).reshape(-1, 3)


def smooth_normals(position, index):
    """Vertex normals: the area-weighted mean of the triangles around."""
    p = position[index]
    face = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normal = np.zeros_like(position)
    for corner in range(3):
        np.add.at(normal, index[:, corner], face)
    return unit(normal)


def swept_part(position, normal, uv, uv_size):
    """A part from a grid of points with normals; triangles face along them, empty ones are dropped. uv is in
    metres, uv_size what a unit of it spans."""
    rows, columns, _ = position.shape
    p, n = position.reshape(-1, 3), normal.reshape(-1, 3)
    index = grid_triangles(rows, columns)
    face = np.cross(p[index[:, 1]] - p[index[:, 0]], p[index[:, 2]] - p[index[:, 0]])
    backwards = np.einsum("ij,ij->i", face, n[index].sum(1)) < 0
    index[backwards] = index[backwards][:, ::-1]
    index = index[np.linalg.norm(face, axis=1) > 1e-12]
    return {"POSITION": p, "NORMAL": n, "TEXCOORD_0": uv.reshape(-1, 2) / uv_size, "index": index}


def backdrop_part(half_width, front, back, radius, top, uv_size):
    """A photographer's sweep: floor from z = front to back, quarter round, wall up to y = top."""
    t = np.linspace(0, math.pi / 2, 49)
    z = np.r_[front, back - radius * np.sin(t), back - radius]
    y = np.r_[0, radius * (1 - np.cos(t)), top]
    ny, nz = np.r_[1, np.cos(t), 0], np.r_[0, np.sin(t), 1]
    x = np.array([-half_width, half_width])
    grid = np.broadcast_arrays(x[None, :], y[:, None], z[:, None])
    normal = np.broadcast_arrays(np.zeros((1, 2)), ny[:, None], nz[:, None])
    length = np.concatenate([[0], np.cumsum(np.hypot(np.diff(z), np.diff(y)))])
    uv = np.stack(np.broadcast_arrays(x[None, :], length[:, None]), 2)
    return swept_part(np.stack(grid, 2), np.stack(normal, 2), uv, uv_size)


def frame_towards(eye, target):
    """Right, up and back of something at eye that looks at target."""
    back = unit(np.subtract(eye, target))
    right = unit(np.cross([0.0, 1.0, 0.0], back))
    return right, np.cross(back, right), back


def softbox_part(centre, target, width, height):
    """A rectangle of two triangles that faces the target."""
    right, up, back = frame_towards(centre, target)
    s = np.array([-0.5, 0.5])
    u, v = np.meshgrid(s, s)
    position = np.array(centre) + width * u[..., None] * right + height * v[..., None] * up
    uv = np.stack([u + 0.5, 0.5 - v], 2)
    return swept_part(position, np.broadcast_to(-back, position.shape), uv, 1.0)


class Glb:
    """Collects meshes, cameras and nodes; writes them as one binary glTF file. A mesh has the name of its
    material."""

    def __init__(self, materials):
        self.materials = materials
        self.binary = bytearray()
        self.views, self.accessors, self.meshes, self.nodes, self.cameras = [], [], [], [], []

    def accessor(self, array, kind, target, bounds=False):
        array = np.ascontiguousarray(array)
        component = {"float32": 5126, "uint16": 5123, "uint32": 5125}[array.dtype.name]
        self.binary += bytes(-len(self.binary) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": array.nbytes,
                           "target": target})
        self.binary += array.tobytes()
        entry = {"bufferView": len(self.views) - 1, "componentType": component,
                 "count": array.size if kind == "SCALAR" else len(array), "type": kind}
        if bounds:
            entry["min"], entry["max"] = array.min(0).tolist(), array.max(0).tolist()
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def primitive(self, part, material):
        index = part["index"].astype(np.uint16 if len(part["POSITION"]) < 65536 else np.uint32).ravel()
        kinds = {"POSITION": "VEC3", "NORMAL": "VEC3", "TEXCOORD_0": "VEC2"}
        attributes = {name: self.accessor(part[name].astype(np.float32), kind, 34962, name == "POSITION")
                      for name, kind in kinds.items() if name in part}
        return {"attributes": attributes, "indices": self.accessor(index, "SCALAR", 34963),
                "material": list(self.materials).index(material)}

    def add_mesh(self, name, parts):
        self.meshes.append({"name": name, "primitives": [self.primitive(part, name) for part in parts]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1})

    def add_camera(self, name, eye, target, fov):
        self.cameras.append({"name": name, "type": "perspective", "perspective": {
            "yfov": math.radians(fov), "aspectRatio": 4 / 3, "znear": 0.05, "zfar": 100.0}})
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = frame_towards(eye, target)
        matrix[:3, 3] = eye
        columns = matrix.T.ravel().tolist()
        self.nodes.append({"name": name, "camera": len(self.cameras) - 1, "matrix": columns})

    def write(self, path, name, extensions):
        document = {
            "asset": {"version": "2.0", "generator": f"weft scenes/{name}.py",
                      "copyright": "The weft maintainers, MIT licence"},
            "extensionsUsed": extensions,
            "scene": 0, "scenes": [{"name": name, "nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes, "meshes": self.meshes, "cameras": self.cameras,
            "materials": [{"name": name, **content} for name, content in self.materials.items()],
            "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.binary)}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + bytes(-len(self.binary) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
