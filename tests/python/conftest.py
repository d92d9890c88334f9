"""What the tests of the package share. With WEFT_TEST_PLAIN they run as where NumPy is not installed."""
import math
import os
import random
import sys

if os.environ.get("WEFT_TEST_PLAIN"):
    sys.modules["numpy"] = None

import pytest

import weft


def listed(values):
    """Returns an array of either kind as lists of numbers."""
    return values.tolist() if hasattr(values, "tolist") else values


def directions(count, seed=1):
    """Returns unit directions above the horizon, as a list of lists."""
    chance, found = random.Random(seed), []
    while len(found) < count:
        x, y, z = (chance.gauss(0, 1) for _ in range(3))
        length = math.sqrt(x * x + y * y + z * z)
        found.append([x / length, y / length, abs(z) / length])
    return found


def close(a, b, tolerance=1e-6):
    """Returns True if all numbers of two lists are near each other."""
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(close(x, y, tolerance) for x, y in zip(a, b))
    return abs(a - b) <= tolerance * max(1.0, abs(a), abs(b))


@pytest.fixture(scope="session")
def cloth():
    """A small picture's scene, which no test changes."""
    with weft.Scene("builtin:cloth") as scene:
        yield scene
