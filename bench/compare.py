"""weft and Blender Cycles side by side, one run: rate, memory, and error after equal time.

    python3 bench/compare.py [--quick | --long] [cloth] [lace] [lamps] [chair]

Without names all four: builtin:cloth; the same cloth as coated lace, an alpha mask under the sheen `fibre`; the
same cloth under six emissive polygons; SheenChair.
Equal picture size, light, camera, depth and pixel filter, two threads each. A rate is samples over the time spent
sampling, start-up and building left out on both sides. The error is relMSE against each renderer's own converged
picture, since their sheens differ: after 5 s; with --quick after 2 s; with --long after 2, 5 and 20 s, against
pictures of many more samples. Cycles counts bounces after the first hit, weft scattering events: 8 is 9.
"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
WEFT = ROOT / "build/release/weft"
CHAIR = ROOT.parent / "shared/data/gltf/SheenChair/SheenChair.gltf"
STUDIO = ROOT.parent / "shared/data/env/studio_small_03_1k.hdr"
QUICK, LONG = "--quick" in sys.argv, "--long" in sys.argv
NAMES = [name for name in sys.argv[1:] if not name.startswith("-")] or ["cloth", "lace", "lamps", "chair"]
RATE_SPP = 16 if QUICK else 64
TIMES = (2,) if QUICK else (2, 5, 20) if LONG else (5,)
# a long run's errors are so small that the slower renderer's converged picture may have fewer samples
CONVERGED_SPP = {"weft": 128 if QUICK else 8192 if LONG else 1024, "cycles": 128 if QUICK else 2048 if LONG else 1024}


def weft(scene, out, common, extra):
    command = [WEFT, "render", scene, "-o", out, "--json", "--quiet", "--max-depth", "9", *common, *extra]
    result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return {"rate": result["samples_per_second"], "memory": result["peak_memory_bytes"], "info": result}


def cycles(scene, out, common, extra):
    command = ["blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "--debug-cycles",
               "--verbose", "2", "-P", ROOT / "bench/cycles.py", "--", scene, "-o", out, "--max-depth", "8",
               *common, *extra]
    # Blender's Python looks for itself on PATH: only Debian's has the numpy that the importer needs
    debian = {**os.environ, "PATH": "/usr/bin:/bin"}
    done = subprocess.run(command, capture_output=True, text=True, env=debian)
    if done.returncode:
        raise SystemExit(done.stdout[-2000:] + done.stderr[-2000:])
    line = next(line for line in done.stdout.splitlines() if line.startswith("{"))
    result = json.loads(line)
    return {"rate": result["samples_per_second"], "memory": result["peak_resident_bytes"], "info": result}


def relmse(a, b):
    command = [WEFT, "diff", a, b, "--metric", "relmse", "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["value"]


def compare(name, weft_scene, cycles_scene, light, folder):
    camera = weft(weft_scene, f"{folder}/camera.exr", ["--width", "64", "--height", "48"], ["--spp", "1"])["info"]
    eye, target = (",".join(f"{v:.7g}" for v in camera["camera"][key]) for key in ("eye", "target"))
    common = ["--camera", f"{eye};{target};{camera['camera']['fov']:.7g}", "--env", *light, "--threads", "2"]
    big, small = ["--width", "640", "--height", "480"], ["--width", "320", "--height", "240"]
    rows = {}
    for renderer, run, scene in (("weft", weft, weft_scene), ("cycles", cycles, cycles_scene)):
        picture, truth = f"{folder}/{renderer}.exr", f"{folder}/{renderer}-converged.exr"
        option = "--time-limit" if renderer == "weft" else "--time"
        rows[renderer] = run(scene, picture, common + big, ["--spp", str(RATE_SPP)])
        run(scene, truth, common + small, ["--spp", str(CONVERGED_SPP[renderer]), "--seed", "7"])
        rows[renderer]["errors"] = []
        for seconds in TIMES:
            run(scene, picture, common + small, [option, str(seconds)])
            rows[renderer]["errors"].append(relmse(picture, truth))
    print(f"\n{name}, 640 x 480, {RATE_SPP} samples a pixel; relMSE at 320 x 240")
    print(f"{'':8}{'M samples/s':>12}{'peak MiB':>10}" + "".join(f"{f'after {seconds} s':>12}" for seconds in TIMES))
    for renderer, row in rows.items():
        print(f"{renderer:8}{row['rate'] * 1e-6:12.3f}{row['memory'] / 2**20:10.0f}"
              + "".join(f"{error:12.3e}" for error in row["errors"]))
    w, c = rows["weft"], rows["cycles"]
    print(f"{'ratio':8}{w['rate'] / c['rate']:12.2f}{w['memory'] / c['memory']:10.3f}"
          + "".join(f"{ours / theirs:12.3f}" for ours, theirs in zip(w["errors"], c["errors"])), flush=True)


def png(path, size, pixel):
    """A square RGBA picture."""
    rows = b"".join(b"\0" + bytes(c for x in range(size) for c in pixel(x, y)) for y in range(size))
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 6, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in chunks:
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))


def save(folder, name, options):
    """builtin:cloth with these options as a file that both read."""
    path = f"{folder}/{name}.glb"
    subprocess.run([WEFT, "render", "builtin:cloth", "--save", path, "--quiet", *options], check=True)
    return path


def lace(folder):
    """A third of the cloth is holes, round ones."""
    def hole(x, y):
        return (230, 230, 230, 0 if (x % 16 - 8) ** 2 + (y % 16 - 8) ** 2 < 27 else 255)
    png(f"{folder}/lace.png", 64, hole)
    texture = {"texture": "lace.png", "scale": 4}
    material = {"alpha_mode": "mask", "alpha_cutoff": 0.5, "base_color": {**texture, "factor": [0.6, 0.5, 0.4]},
                "opacity": {**texture, "channel": "a"}, "sheen_lobe": "fibre", "sheen_color": 0.5,
                "clearcoat": 0.5, "clearcoat_roughness": 0.2}
    with open(f"{folder}/lace.json", "w", encoding="utf-8") as file:
        json.dump(material, file)
    return save(folder, "lace", ["--material", f"Cloth={folder}/lace.json"])


def lamps(folder):
    """Five more beside its own, around the cloth."""
    places = ("2,1,0;-1,-.3,0", "0,2,-1.5;0,-1,.8", "-2,.6,-1;1,-.2,.5", "1,.4,1.6;-.5,0,-1", "1.4,2,1;-.7,-1,-.5")
    return save(folder, "lamps", [part for k, place in enumerate(places)
                                  for part in ("--light", f"polygon;{place};.4,.4;{4 + 2 * k},5,{12 - 2 * k}")])


with tempfile.TemporaryDirectory() as folder:
    light = [STUDIO, "--env-strength", "0.2"] if STUDIO.exists() else ["0.2,0.2,0.2"]
    if "cloth" in NAMES:
        compare("builtin:cloth", "builtin:cloth", ROOT / "scenes/cloth.glb", light, folder)
    if "lace" in NAMES:
        compare("coated lace", lace(folder), f"{folder}/lace.glb", light, folder)
    if "lamps" in NAMES:
        compare("six lamps", lamps(folder), f"{folder}/lamps.glb", light, folder)
    if "chair" not in NAMES:
        pass
    elif CHAIR.exists() and STUDIO.exists():
        compare("SheenChair", CHAIR, CHAIR, [STUDIO], folder)
    else:
        print("\nSheenChair: skipped, the asset is not here")
