"""Passports, distances, matches and fits of models."""
from __future__ import annotations

import ctypes
from array import array
from math import prod
from typing import Any, Iterable, Optional, Union

from . import _abi
from ._arrays import Array, Arrays, Given, common, shaped
from ._library import (
    Handle,
    PathLike,
    Progress,
    Watch,
    call,
    choice,
    created,
    fill,
    index_of,
    integer,
    lib,
    logged,
    owned_text,
    path,
    raise_error,
    text,
)
from ._records import Record, record
from .lobes import Lobe
from .materials import Material, material_inputs
from .reflections import Model, Reflection, _interleaved, named_model, reflection

_NOTES = ("nothing", "bright", "edge", "gains")


class Passport(Record):
    """What was measured of a model; include/weft/measure.h describes every member. Among them: `rows` values of the
    parameter in `values`; `albedo` (rows, cosines) over `cosines`, its maximum `albedo_most`; `reciprocity`;
    `furnace` (layer rules, sheens, views); `pdf_most`, `p` and `tests` of sampling; `variance_ratio`."""

    @property
    def significance(self) -> float:
        """The probability that the least p value of so many tests is as small if the sampler is right."""
        found: float = lib.weft_passport_significance(self.p, self.tests)
        return found


def passport(
    model: Union[str, Lobe, Material], *, quick: bool = False, gpu: bool = False, brief: bool = False, threads: int = 0
) -> Passport:
    """Measures the energy, reciprocity and sampling of a lobe, of an engine profile by name, or of a woven material.
    Takes seconds with `quick`, else up to minutes, which Ctrl+C does not interrupt. gpu: also the shader text on the
    GPU; brief: only E, reciprocity, variance and half precision."""
    desc = fill(
        _abi.WeftPassportDesc(), threads=threads, quick=int(bool(quick)), no_gpu=int(not gpu), brief=int(bool(brief))
    )
    out, kept = _abi.WeftPassport(), None  # type: Any, Any
    if isinstance(model, Lobe):
        kept = _abi.WeftLobe.from_buffer_copy(model._lobe)
        desc.lobe = ctypes.pointer(kept)
        call("weft_passport_measure", ctypes.byref(desc), ctypes.byref(out))
    elif isinstance(model, Material):
        if model.cloth is None:
            raise ValueError("model: is a material that is not woven; a profile is measured by its name")
        kept = _abi.WeftMaterial.from_buffer_copy(model._material)
        desc.id, desc.material = b"material", ctypes.pointer(kept)
        with model.cloth._use() as cloth:
            desc.cloth = cloth
            call("weft_passport_measure", ctypes.byref(desc), ctypes.byref(out))
    else:
        desc.id = text(model, "model")
        call("weft_passport_measure", ctypes.byref(desc), ctypes.byref(out))
    return _passport_record(out)


def _passport_record(out: Any) -> Passport:
    found: Passport = record(out, Passport)
    members = found.__dict__
    for name in (
        "values",
        "albedo",
        "albedo_half",
        "variance",
        "variance_cosine",
        "half_floor",
        "half_zero",
        "half_off",
    ):
        members[name] = (
            members[name][: found.rows]
            if not isinstance(members[name], memoryview)
            else _first(members[name], found.rows)
        )
    for name in ("furnace", "furnace_noise"):
        members[name] = (
            members[name][: found.layers]
            if not isinstance(members[name], memoryview)
            else _first(members[name], found.layers)
        )
    return found


def _first(view: memoryview, rows: int) -> Any:
    """Returns the first rows of an array without NumPy."""
    shape = (rows,) + (view.shape or ())[1:]
    flat = array("f")
    flat.frombytes(view.cast("B")[: 4 * prod(shape)])
    return shaped(flat, shape) if rows else memoryview(flat)


# ---- distance and match


def distance(to: Model, source: Model, metric: str = "cosine", *, part: str = "all") -> float:
    """Returns the distance of two models, 0: equal; `source` is the reference. metric: "cosine", "log" or "picture",
    see include/weft/match.h; part: of a material, "all" or "diffuse", "specular", "sheen", "coat", "dust"."""
    out = ctypes.c_double()
    a, b = reflection(to), reflection(source)
    with a._use() as mine, b._use() as theirs:
        call(
            "weft_brdf_distance",
            mine,
            theirs,
            choice("WeftPart", part, "part"),
            choice("WeftBrdfMetric", metric, "metric"),
            ctypes.byref(out),
        )
    return out.value


class Match(Record):
    """The closest one: `model`, a Lobe or Material; the errors `copied` of the start and `matched` of the result;
    `evaluations`."""


def match(
    source: Model,
    to: Union[Lobe, Material, str],
    metric: str = "cosine",
    *,
    hold: Iterable[str] = (),
    threads: int = 0,
    progress: Progress = None,
) -> Match:
    """Finds the parameters of `to`, a lobe or material that the search begins at and that stays as it is, that come
    closest to `source`. hold: names of parameters or inputs that stay, "color" and "f90" of a lobe among them."""
    if isinstance(to, str):
        named = named_model(to)
        if isinstance(named, str):
            raise ValueError(f"to: {named}: is a measurement, and has no parameters")
        to = named
    if not isinstance(to, (Lobe, Material)):
        raise TypeError(f"to: must be a Lobe, a Material or a name, not {type(to).__name__}")
    held = [hold] if isinstance(hold, str) else list(hold)
    job, from_ = _abi.WeftMatchJob(), reflection(source)
    flags = (ctypes.c_int * _abi.CONSTANTS["WEFT_INPUTS_MAX"])()
    if isinstance(to, Lobe):
        job.is_lobe, job.lobe = 1, to._lobe
        for name in held:
            job.hold |= _hold_bit(to, name)
    else:
        job.material, job.held = to._material, ctypes.addressof(flags)
        for name in held:
            index = lib.weft_material_input_find(text(name, "hold"))
            if index < 0:
                raise ValueError(f"hold: {name}: is not an input of a material")
            flags[index] = 1
    error = _abi.WeftError()
    with from_._use() as pointer, Watch(progress) as watch:
        setattr(job, "from", pointer)
        if lib.weft_match_many(
            ctypes.byref(job),
            1,
            choice("WeftBrdfMetric", metric, "metric"),
            integer(threads, "threads", 0, 256),
            watch.callback,
            None,
            ctypes.byref(error),
        ):
            raise_error(error)
    model = Lobe._of(job.lobe) if isinstance(to, Lobe) else Material._of(job.material, to.cloth)
    return record(job.found, Match, model=model)  # type: ignore[no-any-return]


def _hold_bit(lobe: Lobe, name: str) -> int:
    if name in ("color", "f0", "f90"):
        return _abi.CONSTANTS["WEFT_HOLD_COLOR_2" if name == "f90" else "WEFT_HOLD_COLOR"]
    index = lobe._index(name)
    if index < 0:
        raise ValueError(f"hold: {name}: is not a parameter of {lobe.id}")
    return 1 << index


def match_asset(
    file: PathLike, out: PathLike, source: str, to: str, metric: str = "cosine", *, progress: Progress = None
) -> list[Record]:
    """Converts a glTF file for another engine and writes it to out; source and to are ids of profiles. Returns a
    record of each material: `name`, `changed`, `clipped`, `search`, `found` (`copied`, `matched`), `maps` (a set of
    the inputs with a new texture), and the Material `copied` and `matched`."""
    report = ctypes.POINTER(_abi.WeftAssetMatch)()
    count = ctypes.c_int()
    with Watch(progress) as watch:
        logged(
            "weft_match_asset",
            path(file, "file"),
            path(out, "out"),
            index_of("weft_profile_name", source, "source"),
            index_of("weft_profile_name", to, "to"),
            choice("WeftBrdfMetric", metric, "metric"),
            watch.callback,
            None,
            ctypes.byref(report),
            ctypes.byref(count),
            undo=lambda: lib.weft_match_report_free(report),
        )
    try:
        return [
            record(
                r,
                leave=("copied", "matched", "maps"),
                copied=Material._of(r.copied),
                matched=Material._of(r.matched),
                maps={name for k, name in enumerate(material_inputs()) if r.maps >> k & 1},
            )
            for r in (report[k] for k in range(count.value))
        ]
    finally:
        lib.weft_match_report_free(report)


# ---- fit


class Fitted(Record):
    """One candidate: `lobe` over `base`, Lobes with the fitted numbers (of a weave warp and weft); `numbers` that were
    fitted, `error`, `free_error` without the bound on E, `albedo` (the largest E), `evaluations`, `weave`, and `notes`:
    a set of "nothing", "bright", "edge", "gains"."""

    _fitted: Any

    def reflection(self) -> Reflection:
        """Returns both together."""
        return Reflection._of(created("weft_fitted_reflection", ctypes.byref(self._fitted)))

    def material(self) -> Optional[Material]:
        """Returns the material that is exactly this, or None where no material can express it."""
        out = _abi.WeftMaterial()
        return Material._of(out) if lib.weft_fitted_material(ctypes.byref(self._fitted), ctypes.byref(out)) else None


def _fitted(source: Any) -> Fitted:
    notes: int = lib.weft_fitted_notes(ctypes.byref(source))
    found: Fitted = record(
        source,
        Fitted,
        leave=("lobe", "base"),
        lobe=Lobe._of(source.lobe),
        base=Lobe._of(source.base),
        notes={n for k, n in enumerate(_NOTES) if notes >> k & 1},
        weave=bool(lib.weft_fitted_is_weave(ctypes.byref(source))),
    )
    found._fitted = _abi.WeftFitted.from_buffer_copy(source)
    return found


class Fit(Record):
    """A ranking: `fitted`, a list of Fitted, the best first; `baseline`, ggx over lambert; `base_alone`, the error of
    the base without a lobe."""


class Data(Handle):
    """A measurement: pairs of directions and f. Of a file (.binary, .bsdf, .bin, else a table of theta_o, phi_o,
    theta_i, phi_i, r, g, b in degrees and 1/sr), of its bytes and name, or by `Data.of_pairs`."""

    _free, _noun = "weft_data_free", "measurement"

    def __init__(self, file: Union[PathLike, bytes], *, name: str = "data.csv") -> None:
        if isinstance(file, bytes):
            pointer = created("weft_data_read_memory", file, len(file), text(name, "name"))
        else:
            pointer = created("weft_data_read", path(file, "file"))
        super().__init__(pointer)

    @classmethod
    def of_pairs(cls, wo: Arrays, wi: Arrays, f: Arrays, *, isotropic: bool = False) -> Data:
        """Makes data of unit directions and f, 1/sr, each of shape (..., 3). isotropic: rotating both directions about
        the normal leaves f unchanged."""
        arrays = [Given(wo, "wo", 3), Given(wi, "wi", 3), Given(f, "f", 3)]
        lead = common(*arrays)
        count = integer(prod(lead), "the number of pairs", 1)
        rows = [_interleaved(given.addresses(lead)[1], count) for given in arrays]
        data = cls.__new__(cls)
        Handle.__init__(
            data, created("weft_data_create", count, *(r.buffer_info()[0] for r in rows), int(bool(isotropic)))
        )
        return data

    def __len__(self) -> int:
        """Returns the number of samples in use."""
        with self._use() as pointer:
            return int(lib.weft_data_count(pointer, None))

    @property
    def read(self) -> int:
        """The number of samples that were read, grazing and unmeasured ones among them."""
        total = ctypes.c_int()
        with self._use() as pointer:
            lib.weft_data_count(pointer, ctypes.byref(total))
        return total.value

    def samples(self) -> tuple[Array, Array, Array]:
        """Returns wo, wi and f of the samples in use, each of shape (n, 3)."""
        with self._use() as pointer:
            count: int = lib.weft_data_count(pointer, None)
            rows = [array("f", bytes(12 * count)) for _ in range(3)]
            starts = [r.buffer_info()[0] for r in rows]
            for k in range(count):
                lib.weft_data_sample(pointer, k, *(start + 12 * k for start in starts))
        return tuple(shaped(r, (count, 3)) for r in rows)  # type: ignore[return-value]

    def _desc(self, metric: Optional[str]) -> Any:
        return fill(_abi.WeftFitDesc(), metric=metric, chosen=int(metric is not None))

    def fit(
        self,
        *,
        base: Optional[str] = None,
        only: Optional[str] = None,
        metric: Optional[str] = None,
        free: bool = False,
        expressible: bool = False,
        threads: int = 0,
        progress: Progress = None,
    ) -> Fit:
        """Fits all lobes over a diffuse base, and ranks them. base: a diffuse lobe (body), "all", or "woven"; only: one
        candidate; metric: "log" or "cosine"; free: without the bound E <= 1; expressible: only what a material can
        express. Takes minutes for all lobes of a large measurement; progress (of a fraction) returns True to stop."""
        out = _abi.WeftFit()
        with self._use() as pointer, Watch(progress) as watch:
            desc = fill(
                self._desc(metric),
                base=base,
                only=only,
                free=int(bool(free)),
                expressible=int(bool(expressible)),
                threads=threads,
            )
            desc.progress = watch.callback
            call("weft_fit", pointer, ctypes.byref(desc), ctypes.byref(out))
        return Fit(
            fitted=[_fitted(out.fitted[k]) for k in range(out.count)],
            baseline=_fitted(out.baseline),
            base_alone=out.base_alone,
        )

    def fit_material(self, material: Material, *, metric: Optional[str] = None) -> Match:
        """Finds the inputs of a material that come closest, from those given on; `matched` is the error."""
        if not isinstance(material, Material):
            raise TypeError(f"material: must be a Material, not {type(material).__name__}")
        start, out = _abi.WeftMaterial.from_buffer_copy(material._material), _abi.WeftMatch()
        with self._use() as pointer:
            call("weft_fit_material", pointer, ctypes.byref(self._desc(metric)), ctypes.byref(start), ctypes.byref(out))
        return record(out, Match, model=Material._of(start, material.cloth))  # type: ignore[no-any-return]

    def distance(self, model: Model, *, metric: Optional[str] = None) -> float:
        """Returns the error of a model as it is."""
        out, other = ctypes.c_double(), reflection(model)
        with self._use() as pointer, other._use() as theirs:
            call("weft_data_distance", pointer, ctypes.byref(self._desc(metric)), theirs, ctypes.byref(out))
        return out.value

    def lobe_text(self, name: str, about: str = "A measurement.") -> tuple[str, Record]:
        """Returns the text of a lobe's file NAME.h for `load_lobe`, and its `error`, `f0` and `f90`."""
        out, made = ctypes.c_void_p(), _abi.WeftDataLobe()
        with self._use() as pointer:
            call(
                "weft_data_lobe",
                pointer,
                text(name, "name"),
                text(about, "about"),
                ctypes.byref(out),
                ctypes.byref(made),
            )
        return owned_text(out.value), record(made)


__all__ = ["Data", "Fit", "Fitted", "Match", "Passport", "distance", "match", "match_asset", "passport"]
