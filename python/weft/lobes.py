"""The catalogue of lobes: f, pdf, samples and albedo over arrays."""
from __future__ import annotations

import ctypes
import os
from concurrent.futures import ThreadPoolExecutor
from math import prod
from typing import Any, Mapping, Optional, Union

from . import _abi
from ._arrays import Array, Arrays, Floats, Given, Made, common
from ._library import PathLike, call, integer, lib, logged, number, path, text, triple
from ._records import Record, record, tidy

_TRAITS = {
    name[10:].lower().replace("_", "-"): value
    for name, value in _abi.CONSTANTS.items()
    if name
    in (
        "WEFT_LOBE_RECIPROCAL",
        "WEFT_LOBE_CONSERVES",
        "WEFT_LOBE_LOSSLESS",
        "WEFT_LOBE_TWO_COLORS",
        "WEFT_LOBE_ANISOTROPIC",
        "WEFT_LOBE_REFERENCE",
        "WEFT_LOBE_DIFFUSE",
        "WEFT_LOBE_TABLE",
        "WEFT_LOBE_TINTED",
        "WEFT_LOBE_SYSTEM",
    )
}


class ParamInfo(Record):
    """A parameter of a lobe: `name`, `help`, `default`, the plausible range `low` to `high`, the possible range
    `hard_low` to `hard_high`, and `choices`, the ids of a choice, or None for a number."""


class LobeInfo(Record):
    """A lobe of the catalogue: `id`, `traits` (a set of texts such as "reciprocal"), `params` (a list of ParamInfo)."""


def lobes() -> list[str]:
    """Returns the ids of all lobes."""
    return [lib.weft_lobe_info(k).contents.id.decode() for k in range(lib.weft_lobe_count())]


def _info(index: int) -> LobeInfo:
    info = lib.weft_lobe_info(index).contents
    params = []
    for k in range(info.param_count):
        source = info.params[k]
        choices: Optional[list[str]] = None
        if source.choices:
            choices = []
            while source.choices[len(choices)] is not None:
                choices.append(source.choices[len(choices)].decode())
        params.append(record(source, ParamInfo, choices=choices))
    traits = {name for name, bit in _TRAITS.items() if info.traits & bit}
    return LobeInfo(id=info.id.decode(), traits=traits, params=params)


def lobe_info(id: str) -> LobeInfo:
    """Returns what the catalogue says of a lobe."""
    return Lobe(id).info


def load_lobe(file: PathLike) -> str:
    """Adds a lobe of your own from a file NAME.h, for the whole process, and returns its id. The file runs as native
    code, and the machine's C compiler makes it; docs/adding-a-lobe.md has the language."""
    index = ctypes.c_int()
    logged("weft_lobe_load", path(file, "file"), ctypes.byref(index))
    name: bytes = lib.weft_lobe_info(index.value).contents.id
    return name.decode()


def _words(value: Any, name: str) -> bytes:
    """Returns a value of a parameter as the library reads it: a number, a choice, or three numbers."""
    if isinstance(value, str):
        return text(value, name)
    if hasattr(value, "__len__") and not hasattr(value, "__index__"):
        return ",".join(repr(v) for v in triple(value, name)).encode()
    return repr(number(value, name)).encode()


class Lobe:
    """A lobe with its parameters and colours.

    Directions are in the shading frame: +z the normal, +x the tangent, unit length, away from the surface; wo towards
    the viewer, wi towards the light. f is in 1/sr and without the cosine, pdf in 1/sr over solid angle.

    >>> lobe = Lobe("charlie-neubelt", alpha=0.3)
    >>> f = lobe.eval(wo, wi)                     # shapes (n, 3), (n, 3) -> (n, 3)
    >>> f = lobe.eval(wo, wi, alpha=alphas)       # each pair with a parameter of its own, shape (n,)

    Shapes are broadcast. Arrays of another type than float32 are converted. Results are arrays whose components lie
    one after the other in memory, as `numpy.empty((3, n)).T`; arrays of that layout are read without a copy."""

    __slots__ = ("_lobe",)

    def __init__(self, id: str, **params: Any) -> None:
        self._lobe = _abi.WeftLobe()
        call("weft_lobe_init", text(id, "id"), ctypes.byref(self._lobe))
        for name, value in params.items():
            self[name] = value

    @classmethod
    def _of(cls, source: Any) -> Lobe:
        lobe = cls.__new__(cls)
        lobe._lobe = _abi.WeftLobe.from_buffer_copy(source)
        return lobe

    def copy(self) -> Lobe:
        """Returns a lobe with the same parameters and colours."""
        return self._of(self._lobe)

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Lobe:
        return self.copy()

    def __reduce__(self) -> Any:
        return _unpickled, (self.id, self.params, self.color, self.f90)

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Lobe) and bytes(self._lobe) == bytes(other._lobe)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        parts = [f"{name}={value!r}" for name, value in self.params.items()]
        return f"Lobe({self.id!r}{''.join(', ' + p for p in parts)}, color={self.color})"

    # ---- numbers

    @property
    def id(self) -> str:
        """The name in the catalogue."""
        name: bytes = lib.weft_lobe_info(self._lobe.lobe).contents.id
        return name.decode()

    @property
    def info(self) -> LobeInfo:
        """What the catalogue says of it."""
        return _info(self._lobe.lobe)

    def _index(self, name: str) -> int:
        index: int = lib.weft_lobe_param_find(self._lobe.lobe, text(name, "parameter"))
        return index

    def __getitem__(self, name: str) -> Union[float, str]:
        """Returns a parameter: a number, or the id of a choice."""
        index = self._index(name)
        if index < 0:
            raise KeyError(name)
        info = lib.weft_lobe_info(self._lobe.lobe).contents.params[index]
        value: float = self._lobe.params[index]
        return info.choices[int(value)].decode() if info.choices else tidy(value)

    def __setitem__(self, name: str, value: Any) -> None:
        """Sets a parameter, "color" or "f90". A number beyond the plausible range is a WeftWarning and is clamped to
        the possible one. "roughness", where no parameter has that name, sets the first one as a material does."""
        logged("weft_lobe_set", ctypes.byref(self._lobe), text(name, "parameter"), _words(value, name))

    @property
    def params(self) -> dict[str, Union[float, str]]:
        """All parameters, by name. A copy."""
        return {p.name: self[p.name] for p in self.info.params}

    @property
    def color(self) -> tuple[float, float, float]:
        """f0, linear Rec. 709: a factor on f, or the albedo of the fibres of a lobe that is "tinted"."""
        return tuple(map(tidy, self._lobe.f0))  # type: ignore[return-value]

    @color.setter
    def color(self, value: Any) -> None:
        self["color"] = value

    @property
    def f90(self) -> tuple[float, float, float]:
        """The second colour, which lobes of "two-colors" read."""
        return tuple(map(tidy, self._lobe.f90))  # type: ignore[return-value]

    @f90.setter
    def f90(self, value: Any) -> None:
        self["f90"] = value

    # ---- arrays

    def _each(self, each: Mapping[str, Any]) -> Optional[_Each]:
        return _Each(self, each) if each else None

    def eval(self, wo: Arrays, wi: Arrays, *, out: Optional[Array] = None, **each: Arrays) -> Floats:
        """Returns f, shape (..., 3), 1/sr, for pairs of shape (..., 3); 0 where a direction is not above the horizon.

        each: parameters, `color` (..., 3) and `f90` as arrays, a value for each pair. out: an array of float32 of that
        shape, which is filled and returned."""
        a, b, own = Given(wo, "wo", 3), Given(wi, "wi", 3), self._each(each)
        lead = common(a, b, *own.given) if own else common(a, b)
        (o, keep_o), (i, keep_i) = a.addresses(lead), b.addresses(lead)
        lobes_ = own.filled(lead) if own else None
        made = Made(lead, 3, out, "out", (keep_o, keep_i, *own.keep) if own else (keep_o, keep_i))
        colors = _abi.WeftColors(*made.addresses)
        pair = _count(lead), _abi.WeftDirections(*o), _abi.WeftDirections(*i), colors
        if own:
            call("weft_eval_each", lobes_, *pair, None)
        else:
            call("weft_eval_n", ctypes.byref(self._lobe), *pair)
        return made.result()  # type: ignore[no-any-return]

    def pdf(self, wo: Arrays, wi: Arrays, *, out: Optional[Array] = None, **each: Arrays) -> Floats:
        """Returns the density of sample() at wi, shape (...), 1/sr; arguments as of eval()."""
        a, b, own = Given(wo, "wo", 3), Given(wi, "wi", 3), self._each(each)
        lead = common(a, b, *own.given) if own else common(a, b)
        (o, keep_o), (i, keep_i) = a.addresses(lead), b.addresses(lead)
        lobes_ = own.filled(lead) if own else None
        made = Made(lead, 0, out, "out", (keep_o, keep_i, *own.keep) if own else (keep_o, keep_i))
        pair = _count(lead), _abi.WeftDirections(*o), _abi.WeftDirections(*i)
        if own:
            call("weft_eval_each", lobes_, *pair, _abi.WeftColors(), made.addresses[0])
        else:
            call("weft_pdf_n", ctypes.byref(self._lobe), *pair, made.addresses[0])
        return made.result()  # type: ignore[no-any-return]

    def sample(self, wo: Arrays, u: Arrays, **each: Arrays) -> tuple[Floats, Floats]:
        """Draws wi for each wo, shape (..., 3), and u, shape (..., 2) in [0, 1). Returns wi, shape (..., 3), and its
        pdf, shape (...), 1/sr; where the pdf is 0 there is no sample, and wi must not be used."""
        a, b, own = Given(wo, "wo", 3), Given(u, "u", 2), self._each(each)
        lead = common(a, b, *own.given) if own else common(a, b)
        (o, keep_o), (uv, keep_u) = a.addresses(lead), b.addresses(lead)
        wi, pdf = Made(lead, 3), Made(lead, 0)
        arrays = _count(lead), _abi.WeftDirections(*o), *uv, *wi.addresses, pdf.addresses[0]
        if own:
            call("weft_sample_each", own.filled(lead), *arrays)
        else:
            call("weft_sample_n", ctypes.byref(self._lobe), *arrays)
        del keep_o, keep_u
        return wi.result(), pdf.result()

    def albedo(self, cos_o: Arrays, *, threads: int = 0) -> Floats:
        """Returns the directional albedo E, shape (..., 3), for cosines of wo, shape (...), clamped to [1e-6, 1]: by
        quadrature to 1e-4, which takes about a millisecond each, shared among threads (0: all processors)."""
        given = Given(cos_o, "cos_o", 0)
        lead = given.lead
        [start], keep = given.addresses(lead)
        made, count = Made(lead, 3), _count(lead)
        threads = integer(threads, "threads", 0, 256) or os.cpu_count() or 1
        lobe = _abi.WeftLobe.from_buffer_copy(self._lobe)

        def piece(first: int) -> None:
            colors = _abi.WeftColors(*(address + 4 * first for address in made.addresses))
            call("weft_albedo_n", ctypes.byref(lobe), min(8, count - first), start + 4 * first, colors)

        if count:
            pool = ThreadPoolExecutor(threads)
            try:
                for _ in pool.map(piece, range(0, count, 8)):
                    pass
            finally:
                pool.shutdown(cancel_futures=True)
        del keep
        return made.result()  # type: ignore[no-any-return]


def _count(lead: tuple[int, ...]) -> int:
    return lead[0] if len(lead) == 1 else prod(lead)


def _unpickled(id: str, params: Mapping[str, Any], color: Any, f90: Any) -> Lobe:
    lobe = Lobe(id, **params)
    lobe._lobe.f0[:], lobe._lobe.f90[:] = color, f90
    return lobe


class _Each:
    """Parameters and colours as arrays."""

    def __init__(self, lobe: Lobe, each: Mapping[str, Any]) -> None:
        self._record = _abi.WeftLobes(lobe=lobe._lobe)
        self._slots: list[tuple[Given, list[int], str]] = []
        self.given: list[Given] = []
        for name, value in each.items():
            if name in ("color", "f0", "f90"):
                given, slot = Given(value, name, 3), "f90" if name == "f90" else "f0"
                self._slots.append((given, [0, 1, 2], slot))
            else:
                index = lobe._index(name)
                if index < 0:
                    raise TypeError(f"{name}: is not a parameter of {lobe.id}")
                given = Given(value, name, 0)
                self._slots.append((given, [index], "params"))
            self.given.append(given)
        self.keep: list[Any] = []

    def filled(self, lead: tuple[int, ...]) -> Any:
        """Returns the record, whose arrays live as long as this object."""
        for given, places, member in self._slots:
            addresses, keep = given.addresses(lead)
            self.keep.append(keep)
            for place, address in zip(places, addresses):
                getattr(self._record, member)[place] = address
        return ctypes.byref(self._record)
