"""A BRDF behind one handle: a lobe, a material, a woven cloth, or a measurement."""
from __future__ import annotations

import ctypes
from array import array
from math import prod
from typing import Any, Optional, Sequence, Union

from . import _abi
from ._arrays import HAVE_NUMPY, Array, Arrays, Floats, Given, Made, common
from ._library import Handle, PathLike, call, choice, created, fill, integer, lib, names, path
from .images import taken
from .lobes import Lobe
from .materials import Material

Model = Union["Lobe", "Material", "Reflection", str]
_SUFFIXES = (".binary", ".bsdf", ".bin")


class Reflection(Handle):
    """A prepared BRDF, which never changes. Of a Lobe, of a Material (woven of its cloth, seen from afar), or of a
    name: a lobe, an engine profile or workflow on a grey cloth, "preset:NAME", a material file, or a measurement
    (.binary of MERL, .bsdf of RGL, .bin of UTIA)."""

    _free, _noun = "weft_reflection_free", "reflection"

    def __init__(self, model: Model) -> None:
        self.model: Optional[Union[Lobe, Material]] = None
        """The lobe or material that it was made of, a copy; None of a measurement."""
        if isinstance(model, str):
            named = named_model(model)
            if isinstance(named, str):
                super().__init__(created("weft_reflection_read", path(named)))
                return
            model = named
        if isinstance(model, Lobe):
            self.model = model.copy()
            super().__init__(created("weft_reflection_of_lobe", ctypes.byref(model._lobe)))
        elif isinstance(model, Material):
            self.model = model.copy()
            if model.cloth is None:
                super().__init__(created("weft_reflection_create", ctypes.byref(model._material)))
                return
            with model.cloth._use() as cloth:
                super().__init__(created("weft_reflection_create_woven", ctypes.byref(model._material), cloth))
        else:
            raise TypeError(f"model: must be a Lobe, a Material, a Reflection or a name, not {type(model).__name__}")

    @classmethod
    def _of(cls, pointer: Any) -> Reflection:
        reflection = cls.__new__(cls)
        reflection.model = None
        Handle.__init__(reflection, pointer)
        return reflection

    def __repr__(self) -> str:
        return f"<Reflection of {self.model!r}>" if self.model is not None else "<Reflection, measured>"

    def eval(self, wo: Arrays, wi: Arrays, *, part: str = "all") -> Floats:
        """Returns f, shape (..., 3), 1/sr, for unit directions of shape (..., 3), which are broadcast. A call of the
        library takes one wo and many wi: a single wo of shape (3,) is fast, each further one takes about 2
        microseconds.

        part: "all", or "diffuse", "specular", "sheen", "coat", "dust" of a material."""
        which = choice("WeftPart", part, "part")
        a, b = Given(wo, "wo", 3), Given(wi, "wi", 3)
        lead = common(a, b)
        count = prod(lead)
        (eye, keep_o), (light, keep_i) = a.addresses(a.lead), b.addresses(lead)
        rows, out = _interleaved(keep_i, count), array("f", bytes(12 * count))
        single = prod(a.lead) == 1
        (eyes, _) = _spread(a, lead, single, keep_o)
        read, written = rows.buffer_info()[0], out.buffer_info()[0]
        with self._use() as pointer:
            for first in range(0, count, 1 << 24 if single else 1):
                lib.weft_reflection_eval(
                    pointer,
                    which,
                    eyes.buffer_info()[0] + (0 if single else 12 * first),
                    min(1 << 24, count - first) if single else 1,
                    read + 12 * first,
                    written + 12 * first,
                )
        made = Made(lead, 3)
        _parted(out, made.addresses, count)
        del eye, light
        return made.result()  # type: ignore[no-any-return]

    def albedo(self, cos_o: Arrays, *, part: str = "all") -> Floats:
        """Returns E, shape (..., 3), for cosines of wo in the plane of the tangent, shape (...), above 0 to 1; exact
        to about 1 %, of a lobe to 1e-4."""
        which = choice("WeftPart", part, "part")
        given = Given(cos_o, "cos_o", 0)
        count = prod(given.lead)
        [start], keep = given.addresses(given.lead)
        cosines: Any = (ctypes.c_float * count).from_address(start) if count else ()
        if not all(0.0 < c <= 1.0 for c in cosines):
            raise ValueError("cos_o: must be above 0, and at most 1")
        out, made = array("f", bytes(12 * count)), Made(given.lead, 3)
        with self._use() as pointer:
            for k in range(count):
                lib.weft_reflection_albedo(pointer, which, cosines[k], out.buffer_info()[0] + 12 * k)
        _parted(out, made.addresses, count)
        del keep
        return made.result()  # type: ignore[no-any-return]

    def sphere(self, size: int = 256) -> Array:
        """Draws a lit sphere: shape (size, size, 4), float32, linear, 8 <= size <= 4096."""
        image = _abi.WeftImage()
        with self._use() as pointer:
            call("weft_reflection_sphere", pointer, integer(size, "size"), ctypes.byref(image))
        return taken(image)

    def write(
        self,
        file: PathLike,
        *,
        thetas: int = 0,
        phis: int = 0,
        side: int = 0,
        comment: Optional[str] = None,
        threads: int = 0,
    ) -> None:
        """Tabulates f as a .bsdf in RGL's format. thetas (2 to 256) and phis (3 to 256): polar and azimuthal angles of
        wo; side (8 to 512): points along each side of a table; all 0: until f is reproduced within 1e-3 of its
        mean."""
        desc = fill(_abi.WeftBsdfDesc(), thetas=thetas, phis=phis, side=side, comment=comment, threads=threads)
        with self._use() as pointer:
            call("weft_reflection_write", pointer, path(file, "file"), ctypes.byref(desc))

    def difference(self, other: Model) -> float:
        """Returns the mean absolute difference of f, relative to the mean f of this one."""
        theirs = reflection(other)
        with self._use() as mine, theirs._use() as others:
            found: float = lib.weft_reflection_distance(mine, others)
        return found


def _interleaved(data: Any, count: int) -> array[float]:
    """Returns x y z x y z of an array of components."""
    flat = data.tobytes() if HAVE_NUMPY else data
    parts = array("f", flat) if not HAVE_NUMPY else array("f")
    if HAVE_NUMPY:
        parts.frombytes(flat)
    rows = array("f", bytes(12 * count))
    for k in range(3):
        rows[k::3] = parts[k * count : (k + 1) * count]
    return rows


def _spread(given: Given, lead: tuple[int, ...], single: bool, data: Any) -> tuple[array[float], Any]:
    """Returns the directions wo one after the other: one of them, or one for each pair."""
    if single:
        return _interleaved(data, 1), data
    _, spread = given.addresses(lead)
    return _interleaved(spread, prod(lead)), spread


def _parted(rows: array[float], addresses: Sequence[int], count: int) -> None:
    """Writes x y z x y z as an array of components."""
    for k, address in enumerate(addresses):
        part = rows[k::3]
        ctypes.memmove(address, part.buffer_info()[0], 4 * count)


def named_model(name: str) -> Union[Lobe, Material, str]:
    """Returns the lobe or material of a name, as the program takes it; the path of a measurement as it is."""
    if lib.weft_lobe_find(name.encode("utf-8", "replace")) >= 0:
        return Lobe(name)
    if name.lower().endswith(_SUFFIXES):
        return name
    if name in names("weft_profile_name") or name in names("weft_workflow_name"):
        return Material.of_profile(name)
    if name in names("weft_preset_name"):
        return Material(f"preset:{name}")
    return Material(name)


def reflection(model: Model) -> Reflection:
    """Returns a reflection as it is, and else makes one."""
    return model if isinstance(model, Reflection) else Reflection(model)


__all__ = ["Model", "Reflection"]
