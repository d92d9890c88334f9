"""Seconds from the start of `weft render --engine raster` to its end with a picture written, 960 x 720, four samples.

    python3 bench/start.py [--quick] [WEFT]
    python3 bench/start.py --text [WEFT]

Cold: weft's own cache and the driver's cache of shaders (Mesa's) are empty, and the files of the programs are in
memory. Warm: an earlier run has filled both. Plain: cold, and the shaders are compiled as they are written, not
flattened, which --shader-dir asks for. The best of some runs, which take turns; behind it the seconds of processor.
"""

import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
DATA = ROOT.parent / "shared/data"
STUDIO = DATA / "env/studio_small_03_1k.hdr"
QUICK = "--quick" in sys.argv
WEFT = pathlib.Path(next((name for name in sys.argv[1:] if not name.startswith("--")), ROOT / "build/release/weft"))
ROUNDS = 2 if QUICK else 5
LAMPS = ("2,1,0;-1,-.3,0", "0,2,-1.5;0,-1,.8", "-2,.6,-1;1,-.2,.5", "1,.4,1.6;-.5,0,-1", "1.4,2,1;-.7,-1,-.5")
SCENES = [["builtin:spheres"],
          ["builtin:cloth", *(part for place in LAMPS for part in ("--light", f"polygon;{place};.4,.4;6,5,8"))]]
if (DATA / "gltf/SheenChair/SheenChair.gltf").exists():
    SCENES += [[DATA / "gltf/SheenChair/SheenChair.gltf"]]
    SCENES += [[DATA / "gltf/SheenChair/SheenChair.gltf", "--env", STUDIO]]


def row_name(scene):
    return pathlib.Path(scene[0]).stem + (f" {scene[1]}" if len(scene) > 1 else "")


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def start(scene, folder, more=(), before=()):
    command = [*before, WEFT, "render", *scene, "-o", f"{folder}/picture.png", "--engine", "raster", "--quiet",
               "--width", "960", "--height", "720", "--msaa", "4", *more]
    caches = {**os.environ, "XDG_CACHE_HOME": f"{folder}/cache", "MESA_SHADER_CACHE_DIR": f"{folder}/mesa"}
    used, begin = processor_seconds(), time.monotonic()
    subprocess.run(command, check=True, env=caches)
    return time.monotonic() - begin, processor_seconds() - used


def text_share(scene):
    """Per cent of the samples of a cold start that lie in functions of src/text."""
    objects = WEFT.parent.glob("CMakeFiles/weft_objects.dir/src/text/*/*.o")
    listed = subprocess.run(["nm", *objects], check=True, stdout=subprocess.PIPE, text=True).stdout
    functions = {line.split()[2].split(".")[0] for line in listed.splitlines() if " t " in line.lower()}
    with tempfile.TemporaryDirectory() as folder:
        start(scene, folder, before=("perf", "record", "-q", "-F", "1500", "-o", f"{folder}/samples"))
        report = subprocess.run(["perf", "report", "-i", f"{folder}/samples", "--sort", "dso,symbol"],
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    rows = [line.split() for line in report.splitlines() if "%" in line and "libweft" in line]
    return sum(float(row[0].rstrip("%")) for row in rows if row[3].split(".")[0] in functions)


def main():
    with tempfile.TemporaryDirectory() as folder:
        start(SCENES[0], folder)  # so that the files are in memory
    if "--text" in sys.argv:
        for scene in (["builtin:cloth"], *SCENES[2:]):
            print(f"{row_name(scene):26}{text_share(scene):8.1f} % of the processor's time")
        return
    print("start to picture, s            cold   (processor)      warm   (processor)     plain   (processor)")
    for scene in SCENES:
        cold, warm, plain = [], [], []
        for _ in range(ROUNDS):
            with tempfile.TemporaryDirectory() as folder:
                cold.append(start(scene, folder))
                warm.append(start(scene, folder))
            with tempfile.TemporaryDirectory() as folder:
                os.mkdir(f"{folder}/none")
                plain.append(start(scene, folder, ("--shader-dir", f"{folder}/none")))
        best = (f"{min(each)[0]:9.2f} {min(c for _, c in each):13.2f}" for each in (cold, warm, plain))
        print(f"{row_name(scene):26}" + "".join(best))


main()
