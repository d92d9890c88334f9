"""Look-up tables of lobes: baked, audited, as closed forms, and as linearly transformed cosines."""
from __future__ import annotations

import ctypes
from array import array
from math import prod
from typing import Any, Optional, Union

from . import _abi
from ._arrays import Array, Arrays, Floats, Given, Made, copied, shaped
from ._library import Handle, Log, Progress, Watch, call, created, fill, integer, lib, names, number, text
from ._records import Record, record
from .images import given as image_given
from .images import taken
from .lobes import Lobe


class BakeKind(Record):
    """A kind of table: `id`, `help`, `lobe` (0: none is taken, 1: one may be, 2: one must be given), `formed` (heeds
    axes), and the default `width` and `height`, texels."""


def bake_kinds() -> list[BakeKind]:
    """Returns the kinds of tables that can be baked."""
    found: list[BakeKind] = []
    while kind := lib.weft_bake_kind(len(found)):
        found.append(record(kind.contents, BakeKind))
    return found


def table_forms() -> list[str]:
    """Returns the names of the axes that engines use."""
    return names("weft_table_form_name")


def _form(axes: Optional[str]) -> Any:
    form = _abi.WeftTableForm()
    if axes is not None:
        call("weft_table_form_parse", text(axes, "axes"), ctypes.byref(form))
    return form


def _form_text(form: Any) -> str:
    buffer = ctypes.create_string_buffer(_abi.CONSTANTS["WEFT_TABLE_FORM_TEXT"])
    lib.weft_table_form_text(ctypes.byref(form), buffer)
    return buffer.value.decode()


def _lobe(lobe: Optional[Union[Lobe, str]]) -> Any:
    """Returns a pointer to a copy of a lobe, or None."""
    if lobe is None:
        return None
    if isinstance(lobe, str):
        lobe = Lobe(lobe)
    if not isinstance(lobe, Lobe):
        raise TypeError(f"lobe: must be a Lobe or its id, not {type(lobe).__name__}")
    return ctypes.pointer(_abi.WeftLobe.from_buffer_copy(lobe._lobe))


def table_axes(axes: Optional[str], lobe: Union[Lobe, str], width: int, height: int) -> tuple[Floats, Floats]:
    """Returns what the texels of a table of that size stand for: the cosine of wo and the lobe's first parameter,
    which may be beyond its possible range; each of shape (height, width)."""
    form, pointer = _form(axes), _lobe(lobe)
    if pointer is None:
        raise TypeError("lobe: must be a Lobe or its id, not None")
    width, height = integer(width, "width", 1, 65536), integer(height, "height", 1, 65536)
    if width * height > _abi.CONSTANTS["WEFT_BAKE_TEXELS_MAX"]:
        raise ValueError(f"width: a table has at most {_abi.CONSTANTS['WEFT_BAKE_TEXELS_MAX']} texels")
    cosines, values = array("f"), array("f")
    cos_o, value = ctypes.c_float(), ctypes.c_float()
    for y in range(height):
        for x in range(width):
            lib.weft_table_form_texel(
                ctypes.byref(form), pointer.contents.lobe, width, height, x, y, ctypes.byref(cos_o), ctypes.byref(value)
            )
            cosines.append(cos_o.value)
            values.append(value.value)
    return shaped(cosines, (height, width)), shaped(values, (height, width))


class Table(Record):
    """A table: `texels`, float32, shape (height, width) or (height, width, channels); `axes`, what they mean; `words`
    and `channels`; the quadrature's `error`, `unmet` and `beyond`; `low` and `high`."""


def bake(
    kind: str,
    lobe: Optional[Union[Lobe, str]] = None,
    *,
    width: int = 0,
    height: int = 0,
    axes: Optional[str] = None,
    tolerance: float = 0.0,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Makes a table, such as bake("e", "charlie-neubelt", axes="filament"). kind: an id of bake_kinds(); width and
    height: texels, 0: as the kind has it; axes: a name of table_forms() or elements such as "cos,alpha,centres";
    tolerance: of each value's quadrature, 0: 1e-4. progress gets the finished fraction, and returns True to stop."""
    desc = fill(_abi.WeftBakeDesc(), kind=kind, width=width, height=height, tolerance=tolerance, threads=threads)
    desc.form, pointer = _form(axes), _lobe(lobe)
    if pointer is not None:
        desc.lobe = pointer
    info, image = _abi.WeftBakeInfo(), _abi.WeftImage()
    with Watch(progress) as watch, Log() as log:
        desc.progress, desc.log = watch.callback, ctypes.pointer(log._record)
        call("weft_bake", ctypes.byref(desc), ctypes.byref(info), ctypes.byref(image))
    return record(info, Table, texels=taken(image), axes=_form_text(desc.form))  # type: ignore[no-any-return]


class Audit(Record):
    """What is wrong with a table: `found`, a list of `fault` ("none", "biased", ...) and `text`, the gravest first;
    `fits`, `part`, `texels`, `left_out`, the `largest` error and its `place`, `rms`, `mean`, `beyond`, `together`,
    `step`, `error`; `axes` and `lobe` that it was compared by, `other` where it is of another lobe; `errors`, an array
    (height, width, 3) of error, table and E."""


def audit(
    image: Arrays,
    lobe: Optional[Union[Lobe, str]] = None,
    *,
    channel: int = 0,
    axes: Optional[str] = None,
    scale: float = 0.0,
    most: float = 0.0,
    tolerance: float = 0.0,
    threads: int = 0,
    progress: Progress = None,
) -> Audit:
    """Compares a table of E with the quadrature of a lobe (None: the nearest) at its own texels. scale multiplies the
    table, 0: 1; most: the largest error that passes, 0: 0.01."""
    source, keep = image_given(image, "image")
    desc = fill(_abi.WeftAuditDesc(), channel=channel, scale=scale, most=most, tolerance=tolerance, threads=threads)
    desc.image = ctypes.pointer(source)
    pointer, form = _lobe(lobe), _form(axes)
    if pointer is not None:
        desc.lobe = pointer
    if axes is not None:
        desc.form = ctypes.pointer(form)
    out, errors = _abi.WeftAudit(), _abi.WeftImage()
    with Watch(progress) as watch:
        desc.progress = watch.callback
        call("weft_audit", ctypes.byref(desc), ctypes.byref(out), ctypes.byref(errors))
    found = [record(out.found[k]) for k in range(out.faults)]

    def lobe_id(index: int) -> Optional[str]:
        return lib.weft_lobe_info(index).contents.id.decode() if index >= 0 else None

    result: Audit = record(
        out,
        Audit,
        leave=("form", "faults"),
        found=found,
        axes=_form_text(out.form),
        lobe=lobe_id(out.lobe),
        other=lobe_id(out.other),
        errors=taken(errors),
    )
    return result


class AlbedoForm(Record):
    """A closed form of E: `exponential`, `root`, the degrees `across` (x) and `along` (roughness), `terms` of shape
    (along + 1, across + 1), the largest `error` with its `cos_o` and `roughness`. E = P or exp P, cut off at 0, of
    P = sum terms[j, i] x^i roughness^j, x = cos_o or its root."""

    _form: Any

    def at(self, cos_o: float, roughness: float) -> float:
        """Returns E."""
        value: float = lib.weft_form_at(
            ctypes.byref(self._form), number(cos_o, "cos_o"), number(roughness, "roughness")
        )
        return value


def bake_form(
    lobe: Union[Lobe, str],
    *,
    part: str = "sum",
    error: float = 0.0,
    lowest: float = 0.0,
    threads: int = 0,
    progress: Progress = None,
) -> AlbedoForm:
    """Finds the polynomial of fewest terms that is E of a lobe within an error (0: 0.01), from a roughness on."""
    desc = fill(_abi.WeftAlbedoFormDesc(), part=part, error=error, lowest=lowest, threads=threads)
    desc.lobe = _lobe(lobe)
    out = _abi.WeftAlbedoForm()
    with Watch(progress) as watch:
        desc.progress = watch.callback
        call("weft_bake_form", ctypes.byref(desc), ctypes.byref(out))
    shape = (out.along + 1, out.across + 1)
    form: AlbedoForm = record(out, AlbedoForm, terms=copied(ctypes.addressof(out.terms), "f", shape))
    form._form = out
    return form


class Ltc(Handle):
    """A lobe as linearly transformed cosines: a table over the cosine of wo and the lobe's first parameter.

    rows and columns: 2 to 256, 0: 32; low and high: of the parameter, both 0: its plausible range; f0 and f90: colours
    that the transform is fitted to; norm: 1, 2 or 3; level: f is finite at the horizon; cache: of the user's folder."""

    _free, _noun = "weft_ltc_free", "table"

    def __init__(
        self,
        lobe: Union[Lobe, str],
        *,
        rows: int = 0,
        columns: int = 0,
        low: float = 0.0,
        high: float = 0.0,
        f0: float = 0.0,
        f90: float = 0.0,
        norm: int = 0,
        level: bool = False,
        threads: int = 0,
        cache: bool = True,
        progress: Progress = None,
    ) -> None:
        desc = fill(
            _abi.WeftLtcDesc(),
            rows=rows,
            columns=columns,
            low=low,
            high=high,
            f0=f0,
            f90=f90,
            norm=norm,
            level=int(bool(level)),
            threads=threads,
            no_cache=int(not cache),
        )
        pointer = _lobe(lobe)
        with Watch(progress) as watch:
            desc.progress = ctypes.cast(watch.callback, type(desc.progress))
            super().__init__(created("weft_ltc_create", pointer, ctypes.byref(desc), free=self._free))

    @property
    def info(self) -> Record:
        """`rows`, `columns`, `low`, `high`, `cached`, `seconds`, `mean_error`, `worst_error`, `worst_cos_o`,
        `worst_value`."""
        with self._use() as pointer:
            return record(lib.weft_ltc_info(pointer))  # type: ignore[no-any-return]

    def channel(self, name: str) -> Array:
        """Returns "z", "q", "b", "r", "amplitude", "amplitude_f90" or "error": shape (rows, columns). A copy."""
        known = names("weft_ltc_channel_name")
        if text(name, "name").decode() not in known:
            raise ValueError(f"name: is {name!r:.40}, and must be one of {', '.join(known)}")
        with self._use() as pointer:
            info = lib.weft_ltc_info(pointer)
            address = lib.weft_ltc_channel(pointer, known.index(name))
            return copied(address, "f", (info.rows, info.columns))  # type: ignore[no-any-return]

    @property
    def cosines(self) -> Floats:
        """The cosine of wo of each column."""
        return self._axis("weft_ltc_cos_o", "columns")

    @property
    def values(self) -> Floats:
        """The parameter of each row."""
        return self._axis("weft_ltc_value", "rows")

    def _axis(self, call_name: str, member: str) -> Floats:
        with self._use() as pointer:
            count = getattr(lib.weft_ltc_info(pointer), member)
            flat = array("f", (getattr(lib, call_name)(pointer, k) for k in range(count)))
        return shaped(flat, (count,))  # type: ignore[no-any-return]

    def at(self, cos_o: float, value: float) -> LtcLobe:
        """Returns the transform for a cosine and a parameter, between the nodes; both are clamped to the table."""
        with self._use() as pointer:
            return LtcLobe(lib.weft_ltc_at(pointer, number(cos_o, "cos_o"), number(value, "value")))


class LtcLobe:
    """The transform for one wo: `z`, `q`, `b`, `r`, `amplitude`, `amplitude_f90`."""

    __slots__ = ("_lobe",)

    def __init__(self, source: Any) -> None:
        self._lobe = _abi.WeftLtcLobe.from_buffer_copy(source)

    def __getattr__(self, name: str) -> float:
        if name in ("z", "q", "b", "r", "amplitude", "amplitude_f90"):
            value: float = getattr(self._lobe, name)
            return value
        raise AttributeError(name)

    def inverse(self, wo: Arrays) -> Floats:
        """Returns M^-1 for a wo of shape (3,): shape (3, 3)."""
        eye, keep = _single(wo, "wo")
        m = (ctypes.c_float * 9)()
        lib.weft_ltc_inverse(ctypes.byref(self._lobe), eye, m)
        del keep
        return copied(ctypes.addressof(m), "f", (3, 3))  # type: ignore[no-any-return]

    def sample(self, wo: Arrays, u: Arrays) -> tuple[Floats, float]:
        """Draws one wi, shape (3,), for a wo of shape (3,) and u of shape (2,) in [0, 1); returns it and its pdf,
        1/sr; 0 means no sample."""
        eye, keep = _single(wo, "wo")
        pair = Given(u, "u", 2)
        if pair.lead != ():
            raise ValueError("u: must have the shape (2,)")
        [first, _], keep_u = pair.addresses(())
        wi = (ctypes.c_float * 3)()
        pdf: float = lib.weft_ltc_sample(ctypes.byref(self._lobe), eye, first, wi)
        del keep, keep_u
        return copied(ctypes.addressof(wi), "f", (3,)), pdf

    def pdf(self, wo: Arrays, wi: Arrays) -> Floats:
        """Returns D, shape (...), 1/sr, for a wo of shape (3,) and wi of shape (..., 3)."""
        eye, keep = _single(wo, "wo")
        given = Given(wi, "wi", 3)
        made, count = Made(given.lead, 0), prod(given.lead)
        starts, keep_i = given.addresses(given.lead)
        parts = [(ctypes.c_float * count).from_address(s) for s in starts] if count else []
        out = (ctypes.c_float * max(count, 1)).from_address(made.addresses[0]) if count else (ctypes.c_float * 1)()
        for k in range(count):
            out[k] = lib.weft_ltc_pdf(ctypes.byref(self._lobe), eye, (ctypes.c_float * 3)(*(p[k] for p in parts)))
        del keep, keep_i
        return made.result()  # type: ignore[no-any-return]


def _single(value: Arrays, name: str) -> tuple[int, Any]:
    given = Given(value, name, 3)
    if given.lead != ():
        raise ValueError(f"{name}: must have the shape (3,)")
    starts, keep = given.addresses(())
    return starts[0], keep


__all__ = [
    "AlbedoForm",
    "Audit",
    "BakeKind",
    "Ltc",
    "LtcLobe",
    "Table",
    "audit",
    "bake",
    "bake_form",
    "bake_kinds",
    "table_axes",
    "table_forms",
]
