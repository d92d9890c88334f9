#!/usr/bin/env python3
"""farm.py - one picture by several processes beside one: two ranks of weft-mpi, and parts that are merged

    python3 bench/farm.py [--quick]

Prints how many times as fast two ranks of one thread each are as one thread of weft, the better of three, and what share of the
time of 1,024 samples (--quick: 64) weft merge takes. Ranks are left out, with a word, where there is no MPI. The machine needs
two processors that have nothing else to do."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

BUILD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "build", "release")
WEFT, MPI = os.path.join(BUILD, "weft"), os.path.join(BUILD, "weft-mpi")
QUICK = "--quick" in sys.argv
PICTURE = ["render", "builtin:cloth", "--width", "320", "--height", "240", "--threads", "1", "--quiet", "--json"]
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2", MPI]


def rate(program, folder):
    """Returns millions of samples a second, while the picture is rendered."""
    command = [*program, *PICTURE, "--spp", "64" if QUICK else "256", "-o", f"{folder}/picture.exr"]
    return max(
        json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["samples_per_second"] / 1e6
        for _ in range(3)
    )


def seconds(*command):
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - start


with tempfile.TemporaryDirectory() as folder:
    one = rate([WEFT], folder)
    print(f"one thread             {one:.3f} M samples/s")
    if os.path.exists(MPI) and shutil.which("mpirun"):
        two = rate(MPIRUN, folder)
        print(f"two ranks              {two:.3f} M samples/s, {two / one:.2f} times")
    else:
        print("two ranks              left out: no MPI")
    spp, parts = "64" if QUICK else "1024", [f"{folder}/part-{k}.exr" for k in (1, 2)]
    render = sum(
        seconds(WEFT, *PICTURE, "--spp", spp, "--chunk", f"{k + 1}/2", "-o", part) for k, part in enumerate(parts)
    )
    merge = seconds(WEFT, "merge", *parts, "-o", f"{folder}/picture.exr", "--quiet")
    print(f"two parts, {spp} samples {render:.1f} s; merge {merge:.3f} s, {100 * merge / render:.2f} %")
