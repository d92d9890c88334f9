"""Lobes over arrays: the same numbers as pair by pair, in whatever shape and type they come."""
import copy
import ctypes
import os
import pickle
import shutil
import subprocess

import pytest
from conftest import close, directions, listed

import weft
from weft import _abi
from weft._library import lib

WO, WI = directions(40), directions(40, 2)


def one_by_one(lobe, wo, wi):
    """Evaluates by the call for one pair."""
    f = (ctypes.c_float * 3)()
    lib.weft_lobe_eval(ctypes.byref(lobe._lobe), (ctypes.c_float * 3)(*wo), (ctypes.c_float * 3)(*wi), f)
    return list(f)


@pytest.mark.parametrize("id", weft.lobes())
def test_arrays_agree_with_single_pairs(id):
    lobe = weft.Lobe(id, color=(1.0, 0.5, 0.25))
    f = listed(lobe.eval(WO, WI))
    assert close(f, [one_by_one(lobe, o, i) for o, i in zip(WO, WI)], 1e-3)


def test_samples_have_the_pdf_that_they_come_with():
    lobe = weft.Lobe("ggx", alpha=0.3)
    wi, pdf = lobe.sample(WO, [[(k + 0.5) / 40, (k * 7 % 40 + 0.5) / 40] for k in range(40)])
    drawn = [k for k in range(40) if listed(pdf)[k] > 0]
    assert len(drawn) > 20
    again = listed(lobe.pdf(WO, wi))
    assert all(close(again[k], listed(pdf)[k], 1e-3) for k in drawn)


def test_albedo_of_lambert_is_its_color():
    e = listed(weft.Lobe("lambert", color=(0.5, 0.25, 1.0)).albedo([1.0, 0.5, 0.1]))
    assert close(e, [[0.5, 0.25, 1.0]] * 3, 1e-4)
    assert close(listed(weft.Lobe("lambert").albedo(0.5)), [1.0] * 3, 1e-4)


def test_one_direction_is_broadcast_over_many():
    lobe = weft.Lobe("charlie-neubelt")
    assert close(listed(lobe.eval(WO[0], WI)), listed(lobe.eval([WO[0]] * 40, WI)))
    assert close(listed(lobe.eval(WO[0], WI[0])), listed(lobe.eval(WO, WI))[0])


def test_parameters_for_each_pair_agree_with_a_lobe_of_each():
    alphas, colors = [0.1 + 0.02 * k for k in range(40)], [[1.0, k / 40, 0.5] for k in range(40)]
    lobe = weft.Lobe("charlie-neubelt")
    f, pdf = listed(lobe.eval(WO, WI, alpha=alphas, color=colors)), listed(lobe.pdf(WO, WI, alpha=alphas))
    wi, density = lobe.sample(WO, [0.3, 0.6], alpha=alphas)
    for k in (0, 17, 39):
        one = weft.Lobe("charlie-neubelt", alpha=alphas[k], color=colors[k])
        assert close(f[k], listed(one.eval(WO[k], WI[k])), 1e-4)
        assert close(pdf[k], listed(one.pdf(WO[k], WI[k])), 1e-4)
        assert close(listed(wi)[k], listed(one.sample(WO[k], [0.3, 0.6])[0]), 1e-3)
    assert len(listed(density)) == 40


def test_below_the_horizon_is_black():
    assert listed(weft.Lobe("ggx").eval([0, 0, 1], [[0, 0, -1], [float("nan"), 0, 1], [0, 0, 1]]))[:2] == [[0] * 3] * 2


def test_no_pairs_give_no_results():
    lobe = weft.Lobe("ggx")
    np = pytest.importorskip("numpy")
    assert lobe.eval(np.empty((0, 3)), np.empty((0, 3))).shape == (0, 3)
    assert lobe.pdf(np.empty((2, 0, 3)), [0, 0, 1]).shape == (2, 0)
    assert lobe.albedo([]).shape == (0, 3)


def test_parameters_are_set_by_name_and_clamped_with_a_warning():
    lobe = weft.Lobe("ggx")
    with pytest.warns(weft.WeftWarning, match="alpha.*out of range") as caught:
        lobe["alpha"] = 7.0
    assert caught[0].filename == __file__  # where the caller's line is
    assert lobe["alpha"] == lobe.info.params[0].hard_high
    lobe = weft.Lobe("cook-torrance", d="charlie", v="charlie-v")
    assert (lobe["d"], lobe["v"]) == ("charlie", "conty-kulla")
    with pytest.raises(weft.Error, match="is not a parameter") as failure:
        lobe["fuzz"] = 1
    assert (failure.value.code, failure.value.result, failure.value.message) == (2, "usage", "param-name")
    with pytest.raises(KeyError):
        lobe["fuzz"]
    with pytest.raises(TypeError, match="fuzz: is not a parameter of cook-torrance"):
        lobe.eval(WO, WI, fuzz=1.0)


def test_a_lobe_is_a_value():
    lobe = weft.Lobe("ggx", alpha=0.3, color=(1, 0.5, 0.2))
    for other in (lobe.copy(), copy.deepcopy(lobe), pickle.loads(pickle.dumps(lobe))):
        assert other == lobe
        other["alpha"] = 0.5
        assert other != lobe and lobe["alpha"] == 0.3
    assert "alpha=0.3" in repr(lobe) and lobe.color == (1.0, 0.5, 0.2)


def test_the_catalogue_says_what_a_lobe_takes():
    info = weft.lobe_info("charlie-neubelt")
    assert info.id == "charlie-neubelt" and "reciprocal" in info.traits
    assert [p.name for p in info.params] == ["alpha"] and info.params[0].low < info.params[0].default
    with pytest.raises(weft.Error, match="^charly: is not a lobe"):
        weft.Lobe("charly")


def test_a_lobe_of_ones_own_joins_the_catalogue(tmp_path):
    if not shutil.which(os.environ.get("CC", "cc")):
        pytest.skip("there is no C compiler")
    file = tmp_path / "python_lambert.h"
    text = weft.catalogue_text("lobes/lambert.h")
    for case in ("lambert", "LAMBERT", "Lambert"):
        text = text.replace(case, {"l": "python_", "L": "Python" if case[1] == "a" else "PYTHON_"}[case[0]] + case)
    file.write_text(text)
    id = weft.load_lobe(file)
    assert id == "python-lambert" and id in weft.lobes()
    assert close(listed(weft.Lobe(id).eval(WO, WI)), listed(weft.Lobe("lambert").eval(WO, WI)))


def test_records_are_those_of_the_c_compiler(tmp_path):
    """Compiles a program that prints sizes and offsets of all records, which _abi.py states for ctypes."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    include = os.environ.get("WEFT_INCLUDE")
    if not compiler or not include:
        pytest.skip("there is no C compiler, or WEFT_INCLUDE does not say where the headers are")
    records = {
        name: kind
        for name, kind in vars(_abi).items()
        if name.startswith("Weft") and isinstance(kind, type) and issubclass(kind, ctypes.Structure) and "_" not in name
    }
    lines = [
        f'printf("%zu\\n", sizeof({name}));'
        + "".join(f'printf("%zu\\n", offsetof({name}, {field[0]}));' for field in kind._fields_)
        for name, kind in records.items()
    ]
    source = tmp_path / "records.c"
    source.write_text(
        '#include <stddef.h>\n#include <stdio.h>\n#include "weft/weft.h"\nint main(void) {\n'
        + "\n".join(lines)
        + "\nreturn 0; }\n"
    )
    subprocess.run([compiler, "-std=c11", f"-I{include}", str(source), "-o", str(tmp_path / "records")], check=True)
    printed = subprocess.run([str(tmp_path / "records")], check=True, capture_output=True, text=True).stdout.split()
    ours = [
        str(n)
        for kind in records.values()
        for n in (ctypes.sizeof(kind), *(getattr(kind, f[0]).offset for f in kind._fields_))
    ]
    assert len(records) > 60 and printed == ours
