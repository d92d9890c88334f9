#!/usr/bin/env python3
"""Draws what leaning fibres do with light, for docs/fibre.md: discs.py OUT.png

A disc is the hemisphere of lights seen from above, its rim the horizon; brightness is f cos_i of the lobe `fibre`
towards a viewer at 60 degrees on the right, which the dot marks. From left to right fibres lean by 0, 20 and 40 degrees
towards the viewer above, away from it below. `weft` must be found in PATH.
"""
import math
import struct
import subprocess
import sys
import zlib

RADIUS, GAP, VIEWER, WHITE = 80, 8, 60, 0.35
SIDE = 2 * RADIUS + 2 * GAP
BACK, DOT = (24, 24, 48), (240, 120, 0)


def pixels():
    """Offsets from the middle of a disc that lie in it."""
    span = range(-RADIUS, RADIUS + 1)
    return [(x, y) for y in span for x in span if x * x + y * y < RADIUS * RADIUS]


def disc(tilt, azimuth):
    """f cos_i of each pixel."""
    places = [(math.degrees(math.asin(math.hypot(x, y) / RADIUS)), math.degrees(math.atan2(y, x))) for x, y in pixels()]
    lines = "".join(f"{VIEWER} 0 {theta} {phi}\n" for theta, phi in places)
    command = ["weft", "eval", "fibre", "-p", f"tilt={math.radians(tilt)}", "-p", f"azimuth={math.radians(azimuth)}"]
    answer = subprocess.run(command, input=lines, capture_output=True, text=True, check=True).stdout
    return [float(line.split()[0]) * math.cos(math.radians(place[0]))
            for line, place in zip(answer.splitlines(), places)]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def main():
    tilts, azimuths = (0, 20, 40), (0, 180)
    width, height = SIDE * len(tilts), SIDE * len(azimuths)
    rows = [bytearray(BACK) * width for _ in range(height)]
    dot = RADIUS * math.sin(math.radians(VIEWER))
    for column, tilt in enumerate(tilts):
        for row, azimuth in enumerate(azimuths):
            x0, y0 = column * SIDE + SIDE // 2, row * SIDE + SIDE // 2
            for (x, y), value in zip(pixels(), disc(tilt, azimuth)):
                on_dot = (x - dot) ** 2 + y * y < 12
                grey = round(255 * min(value / WHITE, 1) ** (1 / 2.2))
                at = 3 * (x0 + x)
                rows[y0 - y][at:at + 3] = bytes(DOT if on_dot else (grey, grey, grey))
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    with open(sys.argv[1], "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    main()
