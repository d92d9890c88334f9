"""Models as text for engines: GLSL, HLSL, WGSL, C or a Shadertoy, with their tables."""
from __future__ import annotations

import ctypes
from typing import Any, Optional, Sequence, Union

from . import _abi
from ._library import call, fill, lib, names
from ._records import Record, record
from .images import seen
from .lobes import Lobe
from .materials import Material


class Export(Record):
    """A text, `text`, and the `tables` that it reads: records of `name`, `texels` (float32, one channel), `scale` and
    `offset`. Upload them as they are, without filtering or mipmaps."""


def export_targets() -> list[str]:
    """Returns the languages of exports."""
    return names("weft_export_target_name")


def _desc(model: Any, keep: list[Any], right: Optional[Lobe], members: dict[str, Any]) -> Any:
    desc = fill(_abi.WeftExportDesc(), **members)
    if isinstance(model, str):
        if lib.weft_lobe_find(model.encode("utf-8", "replace")) < 0:
            return fill(desc, profile=model)
        model = Lobe(model)
    if isinstance(model, Lobe):
        keep.append(_abi.WeftLobe.from_buffer_copy(model._lobe))
        desc.lobe = ctypes.pointer(keep[-1])
        if right is not None:
            if not isinstance(right, Lobe):
                raise TypeError(f"right: must be a Lobe, not {type(right).__name__}")
            keep.append(_abi.WeftLobe.from_buffer_copy(right._lobe))
            desc.right = ctypes.pointer(keep[-1])
    elif isinstance(model, Material):
        keep.append(_abi.WeftMaterial.from_buffer_copy(model._material))
        desc.material = ctypes.pointer(keep[-1])
    else:
        raise TypeError(f"model: must be a Lobe, a Material or a name, not {type(model).__name__}")
    return desc


def export(
    model: Union[str, Lobe, Material, Sequence[Union[str, Lobe, Material]]],
    target: str = "glsl",
    *,
    lut: str = "c",
    right: Optional[Lobe] = None,
    name: Optional[str] = None,
    albedo: bool = False,
    fold_pi: bool = False,
    prefix: Optional[str] = None,
    call_line: Optional[str] = None,
    ambient: bool = False,
) -> Export:
    """Makes the text of a model, or of up to 16 together: lobes, engine profiles and workflows by name, materials.

    target: "glsl", "essl", "hlsl", "c", "shadertoy" or "wgsl"; lut: the form of tables, "c", "png16", "exr", "dds",
    "npy"; right: for a Shadertoy, a second lobe; name: of a material in the text; albedo: with E of a lobe; fold_pi: f
    times pi; prefix: of every name; call_line: the command that made it, for the first lines; ambient: with what lights a
    lobe by an environment map."""
    models = list(model) if isinstance(model, (list, tuple)) else [model]
    if not 1 <= len(models) <= _abi.CONSTANTS["WEFT_EXPORT_MODELS_MAX"]:
        raise ValueError(f"model: are {len(models)}, and must be 1 to {_abi.CONSTANTS['WEFT_EXPORT_MODELS_MAX']}")
    members = dict(
        target=target,
        lut=lut,
        name=name,
        albedo=int(bool(albedo)),
        fold_pi=int(bool(fold_pi)),
        prefix=prefix,
        call=call_line,
        ambient=int(bool(ambient)),
    )
    keep: list[Any] = []
    descs = (_abi.WeftExportDesc * len(models))(*(_desc(m, keep, right, members) for m in models))
    out = _abi.WeftExport()
    if len(models) == 1:
        call("weft_export", ctypes.byref(descs[0]), ctypes.byref(out))
    else:
        call("weft_export_all", descs, len(models), ctypes.byref(out))
    try:
        tables = [record(t, leave=("texels",), texels=seen(t.texels)) for t in out.tables[: out.table_count]]
        return Export(text=ctypes.string_at(out.text, out.size).decode(), tables=tables)
    finally:
        lib.weft_export_free(ctypes.byref(out))


__all__ = ["Export", "export", "export_targets"]
