#!/usr/bin/env python3
"""Writes a table of E of Charlie with Neubelt's V that is wrong, for docs/bake.md to audit: lut.py KIND OUT.npy

KIND is `biased` or `noisy`. `biased` is what the shader source/shaders/ibl_filtering.frag of the glTF sample renderer
computes: it draws half vectors from D of alpha = r^2, yet weighs them as if they were uniform and evaluates D at r.
`noisy` draws few uniform half vectors, other ones for each texel: right on average.
"""
import math
import random
import struct
import sys

SIDE, SAMPLES = 64, 256


def charlie(alpha, sin_h):
    return (2 + 1 / alpha) * sin_h ** (1 / alpha) / (2 * math.pi)


def mirrored(k):
    """The bits of k behind the point instead of before it."""
    return int(f"{k:032b}"[::-1], 2) / 2**32


def albedo(kind, cos_o, r):
    sin_o, total = math.sqrt(1 - cos_o * cos_o), 0.0
    for k in range(SAMPLES):
        if kind == "biased":
            u, v, alpha = k / SAMPLES, mirrored(k), r * r
            sin_h, d_at = v ** (alpha / (2 * alpha + 1)), r
        else:
            u, v = random.random(), random.random()
            sin_h, d_at = math.sqrt(1 - v * v), r * r
        cos_h = math.sqrt(max(1 - sin_h * sin_h, 0))
        dot = sin_o * sin_h * math.cos(2 * math.pi * u) + cos_o * cos_h
        cos_i = 2 * dot * cos_h - cos_o
        if dot > 0 and cos_i > 0:
            total += charlie(d_at, sin_h) / (4 * (cos_o + cos_i - cos_o * cos_i)) * cos_i * dot
    return 8 * math.pi * total / SAMPLES


def main(kind, path):
    random.seed(1)
    values = [albedo(kind, (x + 0.5) / SIDE, (y + 0.5) / SIDE) for y in range(SIDE) for x in range(SIDE)]
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({SIDE}, {SIDE}), }}".encode().ljust(117) + b"\n"
    with open(path, "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header)
        file.write(struct.pack(f"<{len(values)}f", *values))


if len(sys.argv) != 3 or sys.argv[1] not in ("biased", "noisy"):
    sys.exit(__doc__.strip())
main(*sys.argv[1:])
