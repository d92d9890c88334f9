"""Writes the nap map of a velvet that hands have stroked and a finger has drawn on.

    python3 examples/nap/nap.py examples/nap/nap.png [--side PIXELS]

Red and green are the direction in which the pile leans, from [-1, 1] to [0, 1], red along the tangent and green up
the picture as in glTF; blue is how far it leans, a share of the material's nap. The map spans all of the cloth of
builtin:cloth, 1.45 m: on the picture that its camera takes, u grows upwards and v to the right. Lengths are in sides
of the map. The same numbers come out everywhere; only the standard library is used.
"""

import argparse
import math
import random
import struct
import zlib

HAND = 0.036  # half the width of a stroke of the hand: 10 cm in all
FINGER = 0.0078  # of a finger: 2.3 cm
STROKES = 220
HEART = (0.315, 0.5, 0.0056)  # u and v of its middle, and its scale
SPLAY = math.radians(35)  # what is pressed away sideways at the edge of a stroke


def smooth(x):
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


class Pile:
    """Which way the fibres of each texel lean: dx, dy, x to the right and y down; their length is how far."""

    def __init__(self, side, direction):
        self.side = side
        self.texels = [direction] * (side * side)

    def lay(self, k, angle, weight, lean):
        """Turns texel k towards an angle."""
        dx, dy = self.texels[k]
        self.texels[k] = (dx + weight * (lean * math.cos(angle) - dx), dy + weight * (lean * math.sin(angle) - dy))

    def hand(self, streaks, centre, radius, begin, sweep, lean):
        """An arc about `centre` from the angle `begin`, `sweep` radians on; strokes end softly."""
        reach, turn, end = radius + HAND, 1.0 if sweep > 0.0 else -1.0, 0.05 / radius
        for y in range(*self.span(centre[1], reach)):
            for x in range(*self.span(centre[0], reach)):
                px, py = (x + 0.5) / self.side - centre[0], (y + 0.5) / self.side - centre[1]
                across = (math.hypot(px, py) - radius) / HAND
                if abs(across) >= 1.0:
                    continue
                along = turn * (math.atan2(py, px) - begin) % (2.0 * math.pi)
                if along > abs(sweep):
                    continue
                weight = smooth((1.0 - abs(across)) / 0.22) * smooth(along / end) * smooth((abs(sweep) - along) / end)
                angle = begin + turn * (along + 0.5 * math.pi)
                angle -= turn * SPLAY * across * across * across  # outwards: away from the middle of the stroke
                streak = streaks[int((across + 1.0) * 0.5 * len(streaks))]
                self.lay(y * self.side + x, angle + streak, weight, lean)

    def finger(self, path):
        """Along a chain of points."""
        for (ax, ay), (bx, by) in zip(path, path[1:]):
            length = math.hypot(bx - ax, by - ay)
            tx, ty = (bx - ax) / length, (by - ay) / length
            for y in range(*self.span(0.5 * (ay + by), FINGER + length)):
                for x in range(*self.span(0.5 * (ax + bx), FINGER + length)):
                    px, py = (x + 0.5) / self.side - ax, (y + 0.5) / self.side - ay
                    along, across = (px * tx + py * ty) / length, (py * tx - px * ty) / FINGER
                    if -1.0 <= along < 2.0 and abs(across) < 1.0:
                        weight = smooth((1.0 - abs(across)) / 0.5)
                        self.lay(y * self.side + x, math.atan2(ty, tx) + SPLAY * across**3, weight, 1.0)

    def span(self, middle, reach):
        return max(int((middle - reach) * self.side), 0), min(int((middle + reach) * self.side) + 2, self.side)

    def rows(self):
        for y in range(self.side):
            row = bytearray()
            for dx, dy in self.texels[y * self.side : (y + 1) * self.side]:
                lean = math.hypot(dx, dy)
                scale = 127.5 / max(lean, 1e-6)
                row += bytes((round(127.5 + dx * scale), round(127.5 - dy * scale), round(255.0 * min(lean, 1.0))))
            yield row


def streaks_of(stream):
    """What single fingers leave in a stroke: small turns across it."""
    turns = [stream.gauss(0.0, 0.1) for _ in range(26)]
    return [a + (b - a) * smooth(k / 8.0) for a, b in zip(turns, turns[1:]) for k in range(8)]


def heart(side):
    """From the tip over the lobe on one side to the cleft."""
    middle_u, middle_v, scale = HEART
    for k in range(161):
        t = math.pi * (1.0 - k / 160.0)
        right = 16.0 * math.sin(t) ** 3
        up = 13.0 * math.cos(t) - 5.0 * math.cos(2.0 * t) - 2.0 * math.cos(3.0 * t) - math.cos(4.0 * t)
        yield middle_u + scale * up, middle_v + side * scale * right


def brushed(side):
    pile, stream = Pile(side, (0.5, 0.2)), random.Random(11)
    for _ in range(STROKES):
        radius = stream.uniform(0.12, 0.5)
        middle = stream.uniform(0.0, 2.0 * math.pi)
        at = stream.uniform(0.0, 1.0), stream.uniform(0.0, 1.0)
        centre = at[0] - radius * math.cos(middle), at[1] - radius * math.sin(middle)
        sweep = stream.choice((-1.0, 1.0)) * stream.uniform(0.25, 0.5) / radius
        pile.hand(streaks_of(stream), centre, radius, middle - 0.5 * sweep, sweep, stream.uniform(0.75, 1.0))
    for k in range(7):  # stroked smooth, towards small u, where the finger will draw
        v, radius = HEART[1] + (k - 3) * 1.3 * HAND, 1.5
        begin = stream.uniform(0.14, 0.2) / radius
        sweep = begin + stream.uniform(0.14, 0.22) / radius
        pile.hand(streaks_of(stream), (HEART[0], v - radius), radius, 0.5 * math.pi - begin, sweep, 1.0)
    for way in (-1.0, 1.0):
        pile.finger(list(heart(way)))
    return pile


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(side, rows):
    """Each row less the one above it, which is what deflate likes."""
    above, lines = bytearray(3 * side), bytearray()
    for row in rows:
        lines += b"\2" + bytes((a - b) & 255 for a, b in zip(row, above))
        above = row
    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(lines), 9)) +
            chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("--side", type=int, default=512, help="of the map, in pixels")
    arguments = parser.parse_args()
    with open(arguments.out, "wb") as file:
        file.write(png(arguments.side, brushed(arguments.side).rows()))


if __name__ == "__main__":
    main()
