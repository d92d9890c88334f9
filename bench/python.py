#!/usr/bin/env python3
"""Prints what eval of each lobe takes from Python over what it takes from C, for arrays of several lengths, each the
best of runs in turn: bench/python.py [--quick]. Arrays are components first, as the library reads them; the last
column has them pair by pair, as NumPy makes them, which are copied.

With --most X the exit status is 1 where a ratio of the longest arrays is above X."""
import os
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build", "release")
os.environ.setdefault("WEFT_LIBRARY", os.path.join(BUILD, "libweft.so"))
sys.path.insert(0, os.path.join(ROOT, "python"))

import numpy as np  # noqa: E402

import weft  # noqa: E402

COUNTS = (1000, 10000, 100000)


def directions(count, seed):
    z, phi = np.random.default_rng(seed).random((2, count))
    s = np.sqrt(1 - z * z)
    return np.array([s * np.cos(2 * np.pi * phi), s * np.sin(2 * np.pi * phi), z], np.float32)


def best(call, runs=10):
    """Returns the seconds of the fastest of some runs."""
    least = float("inf")
    for _ in range(runs):
        start = time.perf_counter()
        call()
        least = min(least, time.perf_counter() - start)
    return least


class InC:
    """A program in C that evaluates as many pairs."""

    def __init__(self, count):
        self._process = subprocess.Popen(
            [os.path.join(BUILD, "bench", "bench_python"), str(count)],
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def seconds(self, id):
        self._process.stdin.write(id + "\n")
        self._process.stdin.flush()
        return float(self._process.stdout.readline())

    def close(self):
        self._process.communicate()


def ratios(lobe, count, program, rounds):
    """Returns the times of C, and of Python by components and by pairs."""
    wo, wi = directions(count, 1), directions(count, 2)
    pairs = [np.ascontiguousarray(d.T) for d in (wo, wi)]
    least = [float("inf")] * 3
    for _ in range(rounds):
        least = [
            min(a, b)
            for a, b in zip(
                least, (program.seconds(lobe.id), best(lambda: lobe.eval(wo.T, wi.T)), best(lambda: lobe.eval(*pairs)))
            )
        ]
    return least


def main():
    rounds = 3 if "--quick" in sys.argv else 20
    most = float(sys.argv[sys.argv.index("--most") + 1]) if "--most" in sys.argv else None
    programs = {count: InC(count) for count in COUNTS}
    print(
        "python: eval of Python over that of C, pairs at once\n"
        + "lobe".ljust(28)
        + "".join(f"{count:>10,}" for count in COUNTS)
        + "  by pairs     ns in C"
    )
    worst = 0.0
    for id in weft.lobes():
        lobe, row = weft.Lobe(id), []
        if "reference" in lobe.info.traits:
            continue
        for count in COUNTS:
            c, components, pairs = ratios(lobe, count, programs[count], rounds)
            row.append(components / c)
        worst = max(worst, row[-1])
        print(
            id.ljust(28) + "".join(f"{r:10.2f}" for r in row) + f"{pairs / c:10.2f}{1e9 * c / COUNTS[-1]:12.2f}",
            flush=True,
        )
    for program in programs.values():
        program.close()
    print(f"the greatest of {COUNTS[-1]:,}: {worst:.2f}")
    return int(most is not None and worst > most)


sys.exit(main())
