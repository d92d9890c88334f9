#!/usr/bin/env python3
"""Prints the frames a second of a GPU for each sheen lobe and a woven cloth, beside what real-time viewers promise: 120
frames a second and 300 MB.

  bench/gpu.py [--only MATERIAL]... [--size WIDTHxHEIGHT]... [--seconds S] [--software]
  bench/gpu.py --bounds

builtin:cloth under a sun, its softbox with a soft shadow and the environment, drawn without a window at 1920 x 1080 and
3840 x 2160 with one sample a pixel: at rest, where each pixel is shaded, and in motion, where 4 x 4 pixels share a point.
Each frame is waited for. First: seconds from an uploaded scene on to its first picture, the shader caches of weft and of
the driver empty. Process: the most memory that was resident, the interpreter's included. GPU: what the driver's counter
rose by (nvidia-smi, or mem_info_vram_used of amdgpu), "-" without one. Behind a figure, < is below 120, > above 300.

MATERIAL is a lobe or preset:NAME. A measurement takes S seconds (1), all of it at most 280: what is left then is named. A
renderer in software is refused unless --software asks for it.

--bounds needs no GPU. It prints how many frames a second the arithmetic of one light allows at most, by the cycles of
docs/cost.md: a SIMD of RDNA2 is occupied by 64 pixels for so many cycles, so a card of that many SIMDs draws at most
SIMDs x 64 x clock / (cycles x pixels) frames a second.
"""
import argparse
import ctypes
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
os.environ.setdefault("WEFT_LIBRARY", str(ROOT / "build/release/libweft.so"))
sys.path.insert(0, str(ROOT / "python"))

try:
    import weft  # noqa: E402
    from weft import _abi, _library  # noqa: E402
except ImportError as error:
    sys.exit(f"weft: bench/gpu.py: {error}; script/build release makes it")

LEAST_FRAMES, MOST_MB, BUDGET, MOTION = 120.0, 300.0, 280.0, 4
SOFTWARE = re.compile("llvmpipe|softpipe|swrast|swiftshader|lavapipe", re.IGNORECASE)
CLOTH = "preset:woven-denim"
SIZES = [(1920, 1080), (3840, 2160)]
# SIMDs, two in a compute unit, and the clock in Hz: the game clock that AMD states, and the highest that Valve states.
CARDS = {"Radeon RX 6900 XT": (160, 2.015e9), "Steam Deck": (16, 1.6e9)}


def refuse(why):
    sys.exit(f"weft: bench/gpu.py: {why}")


# ---- one material, in a process of its own


def scene_of(material):
    scene = weft.Scene("builtin:cloth")
    scene.add_light("directional", direction=(-1, -2, -1), color=(3, 3, 3))
    if material.startswith("preset:"):
        scene.assign(material)
    elif material:
        scene.set("*.sheen_lobe", material)
    return scene


def peak_mb():
    status = pathlib.Path("/proc/self/status").read_text()
    return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024 / 1e6


def measure(material, sizes, seconds, limit):
    """Returns what is found of a material, without the frames for which there was no time."""
    ends = time.monotonic() + limit
    scene, found = scene_of(material), {"frames": []}
    begin = time.monotonic()
    raster = weft.Raster(scene)
    with raster._use(alone=True) as pointer:

        def draw(size, rate):
            view = _abi.WeftRasterView(width=size[0], height=size[1], samples=1, camera=b"0", shading_rate=rate)
            _library.call("weft_raster_draw", pointer, ctypes.byref(view))
            _library.lib.weft_raster_finish(pointer)

        draw(sizes[0], 1)
        found["first"] = time.monotonic() - begin
        for size in sizes:
            for rate in (1, MOTION):
                if time.monotonic() > ends:
                    return found
                draw(size, rate)  # its shaders are compiled
                count, begin = 0, time.monotonic()
                while not count or time.monotonic() - begin < seconds:
                    draw(size, rate)
                    count += 1
                found["frames"].append(count / (time.monotonic() - begin))
                found["process"] = peak_mb()
    return found


def driver():
    """Returns the name of the renderer."""
    return weft.Raster(weft.Scene("builtin:ball")).info.driver


# ---- the table


def gpu_used():
    """Returns the memory of GPUs that is in use, MB; None where nothing tells."""
    counters = pathlib.Path("/sys/class/drm").glob("card*/device/mem_info_vram_used")
    used = [int(counter.read_text()) / 1e6 for counter in counters]
    told = []
    if shutil.which("nvidia-smi"):
        told = subprocess.run(["nvidia-smi", "--query-gpu=memory.used", "--format=csv,noheader,nounits"],
                              capture_output=True, text=True).stdout.split()
    used += [int(mebibytes) * 1.048576 for mebibytes in told if mebibytes.isdigit()]
    return sum(used) if used else None


class GpuWatch:
    """The most that the memory of the GPU rises by meanwhile."""

    def __enter__(self):
        self.before = self.most = gpu_used()
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._look)
        if self.before is not None:
            self._thread.start()
        return self

    def _look(self):
        while not self._done.wait(0.1):
            self.most = max(self.most, gpu_used() or 0.0)

    def __exit__(self, *_):
        self._done.set()
        if self.before is not None:
            self._thread.join()

    def rise(self):
        return None if self.before is None else self.most - self.before


def worker(words):
    """Runs this program with empty caches of shaders. Returns the object that it prints."""
    with tempfile.TemporaryDirectory() as folder:
        caches = {name: folder for name in ("XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH")}
        try:
            ran = subprocess.run([sys.executable, __file__, *words], stdout=subprocess.PIPE, text=True,
                                 env={**os.environ, **caches}, timeout=BUDGET)
        except subprocess.TimeoutExpired:
            refuse(f"{' '.join(words[:2])}: took more than {BUDGET:.0f} s")
    if ran.returncode < 0:
        refuse(f"{' '.join(words[:2])}: ended by signal {-ran.returncode}")
    if ran.returncode:
        sys.exit(ran.returncode)  # it has said why
    return json.loads(ran.stdout)


def figure(value, width, digits, mark=""):
    return f"{'-':>{width}} " if value is None else f"{value:{width}.{digits}f}{mark or ' '}"


def row(material, found, rise, sizes):
    frames = found["frames"] + [None] * (2 * len(sizes) - len(found["frames"]))
    above = [">" if mb and mb > MOST_MB else "" for mb in (found.get("process"), rise)]
    cells = [figure(found["first"], 8, 2), figure(found.get("process"), 9, 0, above[0]), figure(rise, 6, 0, above[1])]
    cells += [figure(f, 11, 1, "<" if f and f < LEAST_FRAMES else "") for f in frames]
    return f"{material:28}" + "".join(cells)


def lobes():
    """Returns the lobes that a sheen may have on a GPU."""
    scene, fit = weft.Scene("builtin:cloth"), []
    for lobe in weft.lobes():
        if "reference" in weft.lobe_info(lobe).traits:
            continue
        try:
            scene.set("*.sheen_lobe", lobe)
        except weft.Error:
            continue
        fit.append(lobe)
    return fit


def size_of(text):
    match = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if not match or not all(1 <= int(side) <= 16384 for side in match.groups()):
        raise argparse.ArgumentTypeError(f"{text}: is no WIDTHxHEIGHT of 1 to 16384 pixels")
    return int(match[1]), int(match[2])


def seconds_of(text):
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0.01 <= seconds <= 60.0:
        raise argparse.ArgumentTypeError(f"{text}: 0.01 to 60 seconds are possible")
    return seconds


def table(arguments, materials):
    name = worker(["--driver"])["driver"]
    if SOFTWARE.search(name) and not arguments.software:
        refuse(f"{name} is a renderer in software, which says nothing of a GPU: --software measures it all the same")
    print(f"{name}; builtin:cloth, one sample a pixel; frames a second at rest, and in motion with {MOTION} x {MOTION} "
          "pixels a point")
    sizes = [f"{w}x{h}" for w, h in arguments.size]
    print(f"{'':28}{'first s':>8} {'process':>9} {'GPU MB':>6} " + "".join(f"{s:>11} {'motion':>11} " for s in sizes))
    ends = time.monotonic() + BUDGET
    for k, material in enumerate(materials):
        left = ends - time.monotonic()
        if left < 1.0:
            print(f"no time is left for {', '.join(materials[k:])}")
            break
        with GpuWatch() as watch:
            found = worker(["--row", material, "--seconds", str(arguments.seconds), "--limit",
                            str(left / (len(materials) - k)), *(w for s in sizes for w in ("--size", s))])
        print(row(material, found, watch.rise(), sizes), flush=True)


# ---- what arithmetic allows


def cycles():
    """Returns the cycles of each lobe with a prepared material, and of a point of denim, by docs/cost.md."""
    found = {}
    for line in (ROOT / "docs/cost.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 10 and cells[1].isdigit():
            found["a point of denim" if "loose fibres" in cells[0] else cells[0]] = int(cells[4 if " " in cells[0] else 5])
    return {name: count for name, count in found.items() if count and not name.startswith(("place", "the same"))}


def bounds():
    print(f"{'':28}{'':>8}" + "".join(f"{card:>22}" for card in CARDS))
    print(f"{'':28}{'cycles':>8}" + "".join(f"{f'{w}x{h}':>11}" for _ in CARDS for w, h in SIZES))
    for name, count in cycles().items():
        most = [simds * 64 * clock / (count * w * h) for simds, clock in CARDS.values() for w, h in SIZES]
        print(f"{name:28}{count:8}" + "".join(f"{frames:11.0f}" for frames in most))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="MATERIAL")
    parser.add_argument("--size", action="append", type=size_of, metavar="WIDTHxHEIGHT")
    parser.add_argument("--seconds", type=seconds_of, default=1.0)
    parser.add_argument("--software", action="store_true")
    parser.add_argument("--bounds", action="store_true")
    parser.add_argument("--row", help=argparse.SUPPRESS)  # of a process of its own
    parser.add_argument("--limit", type=float, help=argparse.SUPPRESS)
    parser.add_argument("--driver", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    arguments.size = arguments.size or SIZES
    try:
        if arguments.bounds:
            bounds()
        elif arguments.driver:
            print(json.dumps({"driver": driver()}))
        elif arguments.row:
            print(json.dumps(measure(arguments.row, arguments.size, arguments.seconds, arguments.limit)))
        else:
            known = [*lobes(), CLOTH]
            for material in arguments.only or []:
                if material not in known and not material.startswith("preset:"):
                    refuse(f"{material}: is no lobe of a sheen and no preset:NAME; there are {', '.join(known)}")
            table(arguments, arguments.only or known)
    except weft.Error as error:
        refuse(str(error))


main()
