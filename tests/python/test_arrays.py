"""Wrong shapes, types and buffers: an exception that names the argument, and never a crash."""
from array import array

import pytest
from conftest import close, directions, listed

import weft

LOBE = weft.Lobe("charlie-neubelt")
WO, WI = directions(6), directions(6, 2)


@pytest.mark.parametrize(
    "wo, kind, words",
    [
        ([1.0, 0.0], ValueError, "wo: has the shape"),
        (1.0, ValueError, "wo: has the shape"),
        ([[1.0, 0.0, 0.0], [1.0, 0.0]], ValueError, "wo: "),
        ("abc", TypeError, "wo: must"),
        (b"abc", (TypeError, ValueError), "wo: "),
        (None, TypeError, "wo: must"),
        ([None] * 3, TypeError, "wo: must"),
        ([1j, 0, 0], TypeError, "wo: must"),
        (object(), TypeError, "wo: must"),
        ({}, TypeError, "wo: must"),
        ([WO[0]] * 5, ValueError, "do not go together"),
    ],
)
def test_a_wrong_argument_is_named(wo, kind, words):
    with pytest.raises(kind, match=words):
        LOBE.eval(wo, WI)


def test_buffers_of_the_standard_library_are_read():
    flat = array("f", [c for d in WO for c in d])
    view = memoryview(flat).cast("B").cast("f", (6, 3))
    wide = memoryview(array("d", flat)).cast("B").cast("d", (6, 3))
    frozen = memoryview(bytes(flat)).cast("f", (6, 3))
    expected = listed(LOBE.eval(WO, WI))
    for buffer in (view, wide, frozen):
        assert close(listed(LOBE.eval(buffer, WI)), expected)
    with pytest.raises(ValueError, match="wo: has the shape"):
        LOBE.eval(flat, WI)
    with pytest.raises(TypeError, match="wo: must"):
        LOBE.eval(memoryview(b"x" * 12).cast("c", (4, 3)), WI)


def test_an_array_that_is_written_is_checked():
    np = pytest.importorskip("numpy")
    out = np.empty((6, 3), np.float32)
    assert LOBE.eval(WO, WI, out=out) is out and close(out.tolist(), listed(LOBE.eval(WO, WI)))
    first = np.empty((3, 6), np.float32).T
    assert LOBE.eval(WO, WI, out=first) is first and (first == out).all()
    gaps = np.zeros((12, 6), np.float32)[::2, ::2]
    assert LOBE.eval(WO, WI, out=gaps) is gaps and (gaps == out).all()
    with pytest.raises(TypeError, match="out: must be an array of float32, not float64"):
        LOBE.eval(WO, WI, out=np.empty((6, 3)))
    with pytest.raises(TypeError, match="out: must be an array of float32, not list"):
        LOBE.eval(WO, WI, out=[0.0] * 18)
    with pytest.raises(ValueError, match=r"out: has the shape \(6,\), and must have \(6, 3\)"):
        LOBE.eval(WO, WI, out=np.empty(6, np.float32))
    frozen = np.empty((6, 3), np.float32)
    frozen.flags.writeable = False
    with pytest.raises(ValueError, match="out: is read-only"):
        LOBE.eval(WO, WI, out=frozen)
    wo = np.array(WO, np.float32).T.copy().T
    alphas = out[:, 0]
    for given in (lambda: LOBE.eval(wo, WI, out=wo), lambda: LOBE.eval(WO, WI, alpha=first.T[0], out=first)):
        with pytest.raises(ValueError, match="out: overlaps"):
            given()
    assert LOBE.eval(WO, WI, alpha=alphas.clip(0.1, 1), out=out) is out


def test_layouts_and_types_change_nothing():
    np = pytest.importorskip("numpy")
    expected = LOBE.eval(WO, WI)
    wo = np.array(WO, np.float32)
    padded = np.zeros((12, 4), np.float32)
    padded[::2, :3] = wo
    odd = np.zeros(6 * 12 + 1, np.uint8)
    odd[1:] = np.frombuffer(wo.tobytes(), np.uint8)
    frozen = wo.copy()
    frozen.flags.writeable = False
    for given in (
        np.asfortranarray(wo),
        wo.astype(np.float64),
        wo.astype(">f4"),
        padded[::2, :3],
        wo[::-1][::-1],
        odd[1:].view(np.float32).reshape(6, 3),
        frozen,
        wo.astype(np.longdouble),
    ):
        assert np.array_equal(LOBE.eval(given, WI), expected)
    assert np.array_equal(LOBE.eval(wo.reshape(2, 3, 3), np.reshape(WI, (2, 3, 3))), expected.reshape(2, 3, 3))
    assert LOBE.eval(wo[:, None], np.array(WI)[None]).shape == (6, 6, 3)
    assert np.array_equal(LOBE.eval(wo[:, None], np.array(WI)[None])[range(6), range(6)], expected)
    assert expected.T.flags.c_contiguous and expected.dtype == np.float32
    for wrong in (wo > 0, wo.astype(complex), wo.astype(str), np.array(wo, object)):
        with pytest.raises(TypeError, match="wo: must hold real numbers"):
            LOBE.eval(wrong, WI)


def test_plain_buffers_that_are_written_are_checked():
    if weft._arrays.HAVE_NUMPY:
        pytest.skip("with NumPy its arrays are written")
    out = memoryview(array("f", bytes(72))).cast("B").cast("f", (6, 3))
    assert LOBE.eval(WO, WI, out=out) is out and close(out.tolist(), listed(LOBE.eval(WO, WI)))
    for wrong, kind, words in (
        (memoryview(bytes(72)).cast("f", (6, 3)), ValueError, "out: is read-only"),
        (array("d", bytes(144)), TypeError, "out: must be a buffer of floats"),
        (array("f", bytes(72)), ValueError, "out: has the shape"),
        ([], TypeError, "out: must"),
    ):
        with pytest.raises(kind, match=words):
            LOBE.eval(WO, WI, out=wrong)
    with pytest.raises(ValueError, match="wo: is not contiguous"):
        LOBE.eval(memoryview(array("f", [0] * 6))[::2], WI)


@pytest.mark.parametrize(
    "image, kind, words",
    [
        ([[0.5]], TypeError, None),
        ([], None, None),
        (b"", None, None),
        (None, TypeError, "image: must"),
        ("x", TypeError, "image: must"),
    ],
)
def test_what_is_no_picture_is_refused(image, kind, words):
    if image == [[0.5]] and weft._arrays.HAVE_NUMPY:
        pytest.skip("NumPy makes an array of lists")
    with pytest.raises(kind or (TypeError, ValueError), match=words):
        weft.tonemap(image)


@pytest.mark.parametrize(
    "call, kind",
    [
        (lambda: weft.Lobe(3), TypeError),
        (lambda: weft.Lobe("a\0b"), ValueError),
        (lambda: weft.Lobe("\ud800"), ValueError),
        (lambda: weft.Lobe("ggx", alpha="wide"), weft.Error),
        (lambda: weft.Lobe("ggx", alpha=None), TypeError),
        (lambda: weft.Lobe("ggx", alpha=float("nan")), weft.Error),
        (lambda: weft.Lobe("ggx", color=(1, 2)), ValueError),
        (lambda: weft.render(spp=0), ValueError),
        (lambda: weft.render(spp=2.5), TypeError),
        (lambda: weft.render(width=2**40), ValueError),
        (lambda: weft.render(width=-5, spp=1), weft.Error),
        (lambda: weft.render(background="pink"), ValueError),
        (lambda: weft.render(crop=(1, 2)), ValueError),
        (lambda: weft.render(colour=1), TypeError),
        (lambda: weft.render("no-such.glb"), weft.Error),
        (lambda: weft.bake("nothing"), weft.Error),
        (lambda: weft.bake("albedo", "ggx", axes="up"), weft.Error),
        (lambda: weft.Draft("twill"), weft.Error),
        (lambda: weft.Draft(b""), weft.Error),
        (lambda: weft.Yarn("tin"), weft.Error),
        (lambda: weft.Cloth("plain", ("wool",)), TypeError),
        (lambda: weft.match("ggx", 3), TypeError),
        (lambda: weft.export("ggx", "cobol"), ValueError),
        (lambda: weft.export([]), ValueError),
        (lambda: weft.terms("x"), ValueError),
        (lambda: weft.use_isa("mmx"), weft.Error),
        (lambda: weft.plot("polar", []), ValueError),
        (lambda: weft.distance("ggx", "lambert", "taste"), ValueError),
        (lambda: weft.Reflection("lambert").eval([0, 0, 1], [0, 0, 1], part=1), TypeError),
        (lambda: weft.Data.of_pairs([0, 0, 1], [0, 0, 1], [0, 0, 0]), weft.Error),
        (lambda: weft.Reflection(7), TypeError),
        (lambda: weft.read_image("no-such.png"), weft.Error),
        (lambda: weft.Lobe("ggx").albedo(0.5, threads=-1), ValueError),
    ],
)
def test_a_call_without_sense_is_an_exception(call, kind):
    with pytest.raises(kind) as failure:
        call()
    assert "\n" not in str(failure.value)
