#!/usr/bin/env python3
"""What the window takes: frames while it is orbited, the longest frame while a term is switched, the time from Tab to
the first path-traced pixels, processor time while nothing happens, memory. On a display of its own (Xvfb) where there is one, else without.

  bench/view.py [PROGRAM]

With --switches N it only switches terms, profiles and presets of the cloth N times, some minutes for 200, and prints
the memory that is resident meanwhile.

  bench/view.py --switches 200 [PROGRAM]

With --memory it opens both built-in scenes with each sheen lobe, or those named, and prints the memory that is resident
at rest and at most: where the driver compiles the shaders, and where it has them in its cache; and there while frames add
up.

  bench/view.py --memory all [PROGRAM]
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("--switches", type=int, metavar="N")
parser.add_argument("--memory", nargs="?", const="all", metavar="LOBE,...")
parser.add_argument("program", nargs="?", default="build/release/weft")
arguments = parser.parse_args()
program = arguments.program
scene = [program, "view", "builtin:cloth", "--set", "Softbox.emission=0", "--env", "0,0,0", "--light",
         "sun;-1,-2,-1;3,3,3", "--forget", "--json", "--width", "1280", "--height", "720"]
FRAMES = 90

script = ["wait rest", "wait 10", "move 0.3 0.5", "press left"]
script += [f"move {0.3 + 0.004 * k:.4f} 0.5" for k in range(8)]
script += ["wait 30"]
orbit = [f"move {0.34 + 0.004 * k:.4f} 0.5" for k in range(FRAMES)]
script += orbit + ["release left", "wait rest", "wait 10"]
terms = ["burley-sheen", "ashikhmin-neubelt", "charlie-conty-kulla", "exponential", "fibre-table"]
for term in terms:
    script += [f'choose "Material/sheen lobe" {term}', "wait rest", "wait 10"]


def display():
    """A server without a screen, and what names it; None where there is none."""
    if not shutil.which("Xvfb"):
        return None, dict(os.environ)
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1400x900x24"], pass_fds=[write],
                              stderr=subprocess.DEVNULL)
    number = os.read(read, 16).decode().strip()
    return server, dict(os.environ, DISPLAY=":" + number)


def replay(lines, environment, unseen, scene=scene):
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write("\n".join(lines) + "\n")
        file.flush()
        command = scene + ["--script", file.name] + (["--windowless"] if unseen else [])
        out = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True, timeout=7200).stdout
    return [json.loads(line) for line in out.splitlines()]


def idle_share(environment, unseen):
    """Processor time over time once the window is at rest."""
    if unseen:
        return None
    process = subprocess.Popen(scene, env=environment, stdout=subprocess.PIPE)
    for line in process.stdout:
        if json.loads(line)["rest"]:
            break
    time.sleep(2.0)

    def used():
        fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    before, seconds = used(), 5.0
    time.sleep(seconds)
    share = (used() - before) / seconds
    process.terminate()
    process.wait()
    return share


def first_pixels(environment, unseen):
    """Seconds from Tab to a frame that shows path-traced pixels, in the studio's light and of a lobe that was not traced
    before: the least of three starts. Counted from the last report before Tab, so it is an upper bound."""
    plain = scene[:3] + scene[scene.index("--forget"):]
    lines = ["wait rest", f'choose "Material/sheen lobe" {terms[0]}', "wait rest", "wait 10", "key tab",
             "wait shows traced", "wait 2"]
    times = []
    for _ in range(3):
        reports = replay(lines, environment, unseen, plain)
        pressed = next(k for k, r in enumerate(reports) if r["mode"] == "truth")
        shown = next(r["clock"] for r in reports[pressed:] if r["shows"] == "traced")
        times.append(shown - reports[pressed - 1]["clock"])
    return min(times)


def switches(count):
    """Lines of a script: every value of each choice of terms and models, each followed by auto, and every preset, dealt
    in turn so that one of each kind comes early; from the start again where that is not enough. Each is drawn whole."""
    models = json.loads(subprocess.run([program, "models", "--json"], stdout=subprocess.PIPE, check=True).stdout)
    decks = [[("Material/" + choice["id"].replace("_", " "), value) for value in choice["values"][1:]]
             for choice in models["choices"]]
    decks.append([("Material/preset", preset["id"]) for preset in models["presets"]])
    lines, done = ["wait rest", 'click "Material/Models"', "wait rest"], 0
    while done < count:
        for turn in range(max(map(len, decks))):
            for deck in decks:
                if done >= count:
                    return lines
                control, value = deck[turn % len(deck)]
                lines += [f'choose "{control}" {value}', "wait rest"]
                done += 1
                if control != "Material/preset" and done < count:
                    lines += [f'choose "{control}" auto', "wait rest"]
                    done += 1
    return lines


def print_switches(environment, unseen):
    plain = scene[:3] + scene[scene.index("--forget"):]
    reports = replay(switches(arguments.switches), environment, unseen, plain)
    memory = [r["resident_mib"] for r in reports]
    print(f"{arguments.switches} switches of terms, profiles and presets: {max(memory):.0f} MiB resident at most, "
          f"{memory[-1]:.0f} at the end, {memory[0]:.0f} at the start")


def opening(scene_name, lobe):
    command = [program, "view", "builtin:" + scene_name, "--forget", "--json", "--width", "1280", "--height", "720"]
    return command + (["--sheen", lobe] if lobe else [])


def memory_of(scene_name, lobe, environment, unseen):
    """MiB that are resident once the window has been at rest for two seconds without frames that add up, and the most
    until then."""
    command = opening(scene_name, lobe) + ["--accumulate", "0"] + ["--windowless"] * unseen
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE)
    for line in process.stdout:
        if json.loads(line)["rest"]:
            break
    time.sleep(2.0)
    status = dict(line.split(":", 1) for line in open(f"/proc/{process.pid}/status"))
    process.terminate()
    process.wait()
    return [int(status[key].split()[0]) / 1024.0 for key in ("VmRSS", "VmHWM")]


def memory_of_sum(scene_name, lobe, environment, unseen):
    """MiB that are resident after three frames have been added up."""
    lines = ["wait rest", "wait summed 3", "wait 3"]
    return replay(lines, environment, unseen, opening(scene_name, lobe) + ["--accumulate", "256"])[-1]["resident_mib"]


def print_memory(environment, unseen):
    models = subprocess.run([program, "models", "lobe:", "--json"], stdout=subprocess.PIPE, check=True).stdout
    lobes = [lobe["id"] for lobe in json.loads(models) if not {"diffuse", "reference"} & set(lobe["traits"])]
    lobes = [""] + (lobes if arguments.memory == "all" else arguments.memory.split(","))
    compiled = dict(environment, MESA_SHADER_CACHE_DISABLE="true")
    print("MiB resident       sheen                          compiled:  at rest  at most   cached:  at rest  at most  "
          "adding up")
    for name in ("cloth", "sewing"):
        for lobe in lobes:
            numbers = memory_of(name, lobe, compiled, unseen)
            memory_of(name, lobe, environment, unseen) # fills the cache
            numbers += memory_of(name, lobe, environment, unseen)
            numbers += [memory_of_sum(name, lobe, environment, unseen)]
            print("builtin:{:10} {:40} {:8.0f} {:8.0f} {:17.0f} {:8.0f} {:10.0f}".format(name, lobe or "its own", *numbers),
                  flush=True)


server, environment = display()
unseen = server is None
try:
    if arguments.switches:
        print_switches(environment, unseen)
        sys.exit()
    if arguments.memory:
        print_memory(environment, unseen)
        sys.exit()
    reports = replay(script, environment, unseen)
    orbits = max(zip(reports, reports[1:]), key=lambda pair: pair[1]["frame"] - pair[0]["frame"])
    frames, seconds = orbits[1]["frame"] - orbits[0]["frame"], orbits[1]["clock"] - orbits[0]["clock"]
    switches = reports[reports.index(orbits[1]) + 1:]
    print(f"{reports[-1]['driver']}, 1280 x 720, builtin:cloth under a sun, panels open"
          f"{', without a display' if unseen else ''}")
    print(f"orbit: {frames} frames, {frames / seconds:.1f} a second; a picture of all pixels takes "
          f"{orbits[1]['picture_ms']:.1f} ms")
    print(f"switching {len(terms)} sheen lobes: the longest frame of the window {max(r['worst_ms'] for r in switches):.0f} ms")
    print(f"from Tab to the first path-traced pixels: at most {first_pixels(environment, unseen):.3f} s")
    print(f"memory: {max(r['resident_mib'] for r in reports):.0f} MiB at most, {reports[0]['resident_mib']:.0f} at the start")
    share = idle_share(environment, unseen)
    if share is not None:
        print(f"at rest: {100 * share:.2f} % of one processor")
finally:
    if server:
        server.terminate()
