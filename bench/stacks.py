#!/usr/bin/env python3
"""Which materials on builtin:cloth the path tracer shades by loops of vectors, which one vertex at a time, and what
either takes, in ns a sample of the whole picture: a table for docs/render.md.

  bench/stacks.py [--quick] [PROGRAM]

Each row is the least of some renders with --stages in one thread. The options are those of all materials of the scene.
"""
import json
import re
import subprocess
import sys
import tempfile

QUICK = "--quick" in sys.argv
PROGRAM = next((name for name in sys.argv[1:] if not name.startswith("--")), "build/release/weft")
COMMAND = [PROGRAM, "render", "builtin:cloth", "--width", "160", "--height", "120", "--spp", "17",
           "--threads", "1", "--stages", "--json", "--quiet"]
LOOPS, EACH = "stack: views, values, sample", "stack, one vertex at a time"


def ids(heading):
    """Those of a list of `weft models`."""
    listed = subprocess.run([PROGRAM, "models"], check=True, capture_output=True, text=True).stdout
    part = listed.split("\n" + heading, 1)[1].split("\n\n", 1)[0]
    return re.findall(r"^  (\S+)", part, re.MULTILINE)


def stages(options):
    best = None
    for _ in range(1 if QUICK else 3):
        with tempfile.TemporaryDirectory() as folder:
            ran = subprocess.run(COMMAND + ["-o", folder + "/picture.png"] + options, check=True, capture_output=True)
        found = json.loads(ran.stdout)["stages"]
        if best is None or found[LOOPS] + found[EACH] < best[LOOPS] + best[EACH]:
            best = found
    return best[LOOPS], best[EACH]


def main():
    rows = [("the cloth as it is", []), ("with a coat", ["--set", "*.clearcoat=0.5"]),
            ("light goes through", ["--set", "*.diffuse_transmission=0.5"]), ("with dust", ["--set", "*.dust=0.3"]),
            ("`--env-ambient 0.5`", ["--env-ambient", "0.5"])]
    for option, heading in (("workflow", "Workflows"), ("profile", "Profiles"), ("layer", "Layer rules")):
        rows += [(f"`--{option} {name}`", [f"--{option}", name]) for name in ids(heading) if name != "none"]
    rows += [(f"`--sheen {name}`", ["--sheen", name]) for name in
             ("charlie-conty-kulla", "charlie-neubelt", "ashikhmin-neubelt", "ltc-fibre", "fibre", "threads", "woven")]
    print("| builtin:cloth | by loops | one at a time |\n|---|---|---|")
    for name, options in rows:
        loops, each = stages(options)
        print(f"| {name} | {loops:.0f} | {each:.0f} |", flush=True)


main()
