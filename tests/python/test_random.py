"""Ten thousand random calls: each returns or raises an exception that is meant for the caller, and nothing crashes.
Under sanitizers the library's memory is watched too."""
import random
import warnings
from array import array

import weft

try:
    import numpy as np
except ImportError:
    np = None

CALLS = 10000
ALLOWED = (weft.Error, TypeError, ValueError, KeyError, RuntimeError, IndexError, OverflowError)


def numbers(chance):
    return chance.choice(
        [
            0,
            1,
            -1,
            0.3,
            0.5,
            7,
            1e30,
            -1e-30,
            float("nan"),
            float("inf"),
            2**31,
            2**63,
            10**400,
            True,
            None,
            "0.5",
            "x",
            b"1",
            1j,
            [],
            chance.random(),
            chance.gauss(0, 1),
        ]
    )


def words(chance):
    return chance.choice(
        [
            "ggx",
            "lambert",
            "charlie-neubelt",
            "alpha",
            "color",
            "f90",
            "all",
            "sheen",
            "",
            "x" * 2000,
            "a\0b",
            "\ud800",
            "é",
            "twill 2/2",
            "plain",
            "preset:velvet",
            "three",
            "*.roughness",
            "Cloth.base_color",
            "albedo",
            "flip",
            None,
            5,
            b"bytes",
            "profile",
            "silk",
            "warp",
            "builtin:cloth",
            "-1",
            "../x",
            "picture",
        ]
    )


def arrays(chance):
    """Returns directions, pictures and what is neither, in any layout."""
    shape = chance.choice([(3,), (4, 3), (4, 2), (2, 2, 3), (0, 3), (4,), (), (3, 4), (4, 4, 4), (1, 3), (8, 8)])
    count = 1
    for n in shape:
        count *= n
    values = [chance.gauss(0, 1) for _ in range(count)]
    kind = chance.randrange(8)
    if kind == 0 or np is None:
        if kind % 3 == 1 and count:
            return memoryview(array(chance.choice("fdBl"), [1] * count)).cast("B")
        if kind % 3 == 2 and count:
            return memoryview(array("f", values)).cast("B").cast("f", shape or (1,))
        return [values[3 * k : 3 * k + 3] for k in range(count // 3)]
    made = np.reshape(values, shape).astype(
        chance.choice(["f4", "f4", "f4", "f8", "i4", "u1", "u2", "c8", "?", ">f4", "f2", "O"])
    )
    if kind == 1:
        made = made[::-1] if made.ndim else made
    if kind == 2:
        made = made.T
    if kind == 3:
        made.flags.writeable = False
    if kind == 4:
        made = np.repeat(made, 2, 0)[::2] if made.ndim else made
    return made


def anything(chance):
    return chance.choice([numbers, words, arrays, numbers, words, arrays])(chance)


def test_random_calls_never_crash(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    chance = random.Random(20)
    scene, draft = weft.Scene(), weft.Draft("twill 2/2")
    render = weft.Render(scene, width=16, height=12, halves=True, first_hits=True, threads=1)
    lobes = [weft.Lobe(i) for i in ("ggx", "charlie-neubelt", "fibre", "lambert", "cook-torrance")]
    reflection, material = weft.Reflection("khronos"), weft.Material()
    data = weft.Data.of_pairs([[0, 0, 1]] * 20, [[0, 0.6, 0.8]] * 20, [[0.1, 0.2, 0.3]] * 20)
    ltc = weft.Ltc("lambert", rows=2, columns=2, cache=False)
    something = lambda: anything(chance)  # noqa: E731
    calls = [
        lambda: chance.choice(lobes).eval(arrays(chance), arrays(chance)),
        lambda: chance.choice(lobes).eval(something(), something()),
        lambda: chance.choice(lobes).eval(arrays(chance), arrays(chance), out=arrays(chance)),
        lambda: chance.choice(lobes).eval(arrays(chance), arrays(chance), alpha=something(), color=something()),
        lambda: chance.choice(lobes).eval([0, 0, 1], arrays(chance), **{str(words(chance)): something()}),
        lambda: chance.choice(lobes).pdf(arrays(chance), arrays(chance), out=chance.choice([None, arrays(chance)])),
        lambda: chance.choice(lobes).sample(arrays(chance), chance.choice([[0.5, 0.5], arrays(chance), something()])),
        lambda: lobes[3].albedo(chance.choice([numbers(chance), [0.5, numbers(chance)]])),
        lambda: chance.choice(lobes).__setitem__(words(chance), something()),
        lambda: chance.choice(lobes).__getitem__(words(chance)),
        lambda: weft.Lobe(words(chance), alpha=numbers(chance)),
        lambda: material.__setitem__(
            chance.choice([words(chance), "roughness", "sheen_color", "profile"]), something()
        ),
        lambda: material.__getitem__(words(chance)),
        lambda: material.reads(words(chance)),
        lambda: weft.Reflection(something()),
        lambda: reflection.eval(arrays(chance), arrays(chance), part=chance.choice(["all", "sheen", words(chance)])),
        lambda: reflection.albedo(something()),
        lambda: weft.distance(chance.choice(lobes[:2]), chance.choice([lobes[3], words(chance)]), words(chance)),
        lambda: weft.Data.of_pairs(arrays(chance), arrays(chance), something()),
        lambda: weft.Data(chance.choice([b"", b"0,0,0,0,1,1,1\n", b"\0" * 40, something()]), name=words(chance)),
        lambda: data.distance(chance.choice([lobes[0], words(chance)])),
        lambda: ltc.channel(words(chance)),
        lambda: ltc.at(numbers(chance), numbers(chance)).pdf(something(), arrays(chance)),
        lambda: weft.tonemap(arrays(chance), chance.choice(["aces", words(chance)]), exposure=numbers(chance)),
        lambda: weft.diff(arrays(chance), arrays(chance), chance.choice(["flip", "ssim", words(chance)])),
        lambda: weft.to_linear(arrays(chance)),
        lambda: weft.heat_image(arrays(chance), numbers(chance), numbers(chance)),
        lambda: weft.difference_image(arrays(chance), arrays(chance), numbers(chance)),
        lambda: weft.sheet([arrays(chance)], [words(chance)], columns=numbers(chance)),
        lambda: weft.read_image(chance.choice([b"", b"\x89PNG\r\n\x1a\n", b"\x93NUMPY", bytes(chance.randrange(200))])),
        lambda: weft.write_image(
            chance.choice(["a.exr", "a.png", "a.npy", "a.hdr", "a"]), arrays(chance), comment=words(chance)
        ),
        lambda: weft.Draft(chance.choice([words(chance), b"", b"[WIF]\n"])),
        lambda: draft.set_up(numbers(chance), numbers(chance), True),
        lambda: draft.threads(words(chance)),
        lambda: draft.set_sett(words(chance), numbers(chance)),
        lambda: weft.Cloth(draft, chance.choice(["silk", ("silk", words(chance)), something()]), seed=numbers(chance)),
        lambda: weft.Yarn(words(chance), crimp=numbers(chance)),
        lambda: scene.set(words(chance), something()),
        lambda: scene.assign(chance.choice([b"{}", b"{", words(chance)]), words(chance)),
        lambda: scene.material(chance.choice([numbers(chance), words(chance)])),
        lambda: scene.put_material(chance.choice([0, numbers(chance)]), chance.choice([material, something()])),
        lambda: scene.add_light(
            chance.choice(["point", words(chance)]), position=something(), color=something(), range=numbers(chance)
        ),
        lambda: scene.remove_light(numbers(chance)),
        lambda: scene.texture(numbers(chance)),
        lambda: scene.put_texture(numbers(chance), arrays(chance)),
        lambda: scene.set_environment(chance.choice([(1, 1, 1), something()]), rotation=numbers(chance)),
        lambda: scene.camera(words(chance), aspect=numbers(chance)),
        lambda: scene.set_weave_key(words(chance), something(), words(chance)),
        lambda: render.run(chance.choice([1, 1, numbers(chance)]), seconds=0.05),
        lambda: render.image(),
        lambda: render.aov(chance.choice(["albedo", "variance", words(chance)])),
        lambda: render.restart(
            width=chance.choice([8, 16]),
            height=8,
            threads=1,
            crop=chance.choice([None, something()]),
            background=something(),
            camera=words(chance),
            halves=True,
            first_hits=True,
        ),
        lambda: weft.export(
            chance.choice(["lambert", words(chance)]), chance.choice(["c", words(chance)]), prefix=words(chance)
        ),
        lambda: weft.catalogue_text(words(chance)),
        lambda: weft.Scene(chance.choice([b"", b"glTF", b"{}", words(chance)])),
        lambda: weft.doctor(chance.choice([b"", b"glTF\2\0\0\0", b"{}"])),
        lambda: weft.audit(arrays(chance), chance.choice([lobes[3], "lambert"]), channel=numbers(chance)),
        lambda: weft.bake(words(chance), chance.choice([None, "lambert"]), width=2, height=2, axes=words(chance)),
    ]
    outcomes = {"returned": 0, "raised": 0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for k in range(CALLS):
            while len(scene.lights) > 4:
                scene.remove_light(0)
            state, call = chance.getstate(), chance.randrange(len(calls))
            try:
                calls[call]()
                outcomes["returned"] += 1
            except ALLOWED:
                outcomes["raised"] += 1
            except BaseException as failure:
                raise AssertionError(f"call {call}, the {k}th: {type(failure).__name__}: {failure}") from failure
            del state
    assert min(outcomes.values()) > CALLS // 20, outcomes
