"""The table of what a GPU draws (bench/gpu.py), tiny and in software, and what it refuses."""
import os
import pathlib
import subprocess
import sys

import pytest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "bench/gpu.py"

if os.environ.get("WEFT_TEST_PLAIN"):
    pytest.skip("it needs no NumPy: once is enough", allow_module_level=True)


def bench(*words):
    ran = subprocess.run([sys.executable, PROGRAM, *words], capture_output=True, text=True)
    if "OpenGL" in ran.stderr:
        pytest.skip(ran.stderr.strip())
    return ran


def test_a_row_has_a_figure_for_each_column():
    ran = bench("--software", "--size", "64x36", "--only", "charlie-neubelt", "--seconds", "0.05")
    assert ran.returncode == 0 and ran.stderr == ""
    named, head, row = ran.stdout.splitlines()
    assert "builtin:cloth" in named and "64x36" in head
    material, first, process, gpu, rest, motion = row.split()
    assert material == "charlie-neubelt" and (gpu == "-" or float(gpu.rstrip(">")) >= 0)
    assert 0 < float(first) < 300 and 20 < float(process.rstrip(">")) < 3000
    assert float(rest.rstrip("<")) > 0.1 and float(motion.rstrip("<")) > 0.1


def test_what_says_nothing_of_a_gpu_is_refused_in_a_line():
    ran = bench("--only", "charlie-neubelt", "--size", "16x16", "--seconds", "0.01")
    if ran.returncode == 0:
        pytest.skip("there is a GPU")
    assert ran.stdout == "" and ran.stderr.count("\n") == 1 and "--software" in ran.stderr


@pytest.mark.parametrize("words, why", [(["--only", "treacle"], "treacle: is no lobe"), (["--size", "0x4"], "0x4"),
                                        (["--size", "wide"], "wide"), (["--seconds", "nan"], "nan: 0.01 to 60")])
def test_what_makes_no_sense_is_refused(words, why):
    ran = bench("--software", *words)
    assert ran.returncode != 0 and ran.stdout == "" and why in ran.stderr


def test_bounds_are_those_of_the_cycles_of_the_docs():
    ran = bench("--bounds")
    rows = {line[:28].strip(): line[28:].split() for line in ran.stdout.splitlines()[2:]}
    cost = (PROGRAM.parents[1] / "docs/cost.md").read_text()
    for name in ("charlie-neubelt", "fibre"):
        cells = next(line for line in cost.splitlines() if line.startswith(f"| {name} | ")).split("|")
        assert int(rows[name][0]) == int(cells[6])
        assert float(rows[name][1]) == pytest.approx(160 * 64 * 2.015e9 / (int(cells[6]) * 1920 * 1080), rel=0.01)
    assert int(rows["a point of denim"][0]) > 1000
    assert float(rows["fibre"][2]) == pytest.approx(float(rows["fibre"][1]) / 4, rel=0.01)
