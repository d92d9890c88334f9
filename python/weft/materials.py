"""Materials in numbers, under workflows and engine profiles."""
from __future__ import annotations

import ctypes
import math
from typing import Any, Optional, Union

from . import _abi
from ._library import PathLike, choice, created, lib, logged, names, path, text
from ._records import NAMES, Record, record, tidy
from .lobes import _words
from .weaves import Cloth


class InputInfo(Record):
    """An input of materials: `name`, `help`, `label`, `kind` ("scalar", "color", "normal", "direction", "angle"), the
    `initial` value, the plausible range `low` to `high` and the possible one `hard_low` to `hard_high`; angles in
    degrees."""


def material_inputs() -> dict[str, InputInfo]:
    """Returns what every material takes, by name."""
    found: dict[str, InputInfo] = {}
    source = _abi.WeftInputInfo()
    while lib.weft_material_input_info(len(found), ctypes.byref(source)):
        label: Optional[bytes] = lib.weft_material_input_label(len(found))
        info = record(source, InputInfo, label=label.decode() if label else "")
        found[info.name] = info
    return found


def material_choices() -> dict[str, list[str]]:
    """Returns the choices of a material, by name, such as "layer" or "profile", and the ids that each may take."""
    return {
        name: [
            value
            for k, value in enumerate(names("weft_material_choice_value", index))
            if lib.weft_material_choice_fits(index, k)
        ]
        for index, name in enumerate(names("weft_material_choice_name"))
    }


class Material:
    """A material in numbers, without textures.

    >>> velvet = Material("preset:velvet", profile="three")
    >>> velvet["sheen_color"] = (1, 0.7, 0.7)

    Of a file (docs/materials.md), of "preset:NAME", or without one a grey dielectric. Inputs are numbers or three of
    them, linear Rec. 709, angles in degrees; choices are ids, or "auto". `cloth` is the Cloth that it is woven of, or
    None."""

    __slots__ = ("_material", "cloth")

    def __init__(self, file: Optional[PathLike] = None, **inputs: Any) -> None:
        self._material = _abi.WeftMaterial()
        self.cloth: Optional[Cloth] = None
        if file is None:
            lib.weft_material_default(ctypes.byref(self._material))
        else:
            pointer = created("weft_material_read_woven", path(file, "file"), ctypes.byref(self._material), free="weft_cloth_free")
            self.cloth = Cloth._of(pointer) if pointer else None
        for name, value in inputs.items():
            self[name] = value

    @classmethod
    def _of(cls, source: Any, cloth: Optional[Cloth] = None) -> Material:
        material = cls.__new__(cls)
        material._material, material.cloth = _abi.WeftMaterial.from_buffer_copy(source), cloth
        return material

    @classmethod
    def of_profile(cls, profile: str, **inputs: Any) -> Material:
        """Returns a grey cloth with a white sheen under an engine profile or a workflow, as the program takes their
        names."""
        kind = "profile" if profile in names("weft_profile_name") else "workflow"
        return cls(
            None, **{kind: profile}, base_color=0.2, sheen_color=1.0, sheen_roughness=0.5, roughness=1.0, **inputs
        )

    def copy(self) -> Material:
        """Returns a material with the same numbers and the same cloth."""
        return self._of(self._material, self.cloth)

    __copy__ = copy

    def __eq__(self, other: Any) -> bool:
        return (
            isinstance(other, Material)
            and bytes(self._material) == bytes(other._material)
            and self.cloth is other.cloth
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        fresh = _abi.WeftMaterial()
        lib.weft_material_default(ctypes.byref(fresh))
        plain = Material._of(fresh)
        parts = [f"{n}={self[n]!r}" for n in [*material_choices(), *material_inputs()] if self[n] != plain[n]]
        return f"Material({', '.join(parts)})"

    def __getitem__(self, name: str) -> Union[float, tuple[float, float, float], str]:
        """Returns an input, or the id of a choice."""
        index: int = lib.weft_material_input_find(text(name, "name"))
        if index >= 0:
            source = _abi.WeftInputInfo()
            lib.weft_material_input_info(index, ctypes.byref(source))
            kind, value = NAMES["WeftInputKind"][source.kind], self._material.inputs[index].value
            if kind == "color":
                return tuple(map(tidy, value))  # type: ignore[return-value]
            return (
                tidy(ctypes.c_float(math.degrees(value[0])).value) if kind in ("direction", "angle") else tidy(value[0])
            )
        index = lib.weft_material_choice_find(text(name, "name"))
        if index < 0:
            raise KeyError(name)
        chosen: Optional[bytes] = lib.weft_material_choice_value(index, self._material.choices[index])
        return chosen.decode() if chosen else "auto"

    def __setitem__(self, name: str, value: Any) -> None:
        """Sets an input or a choice. A number beyond the plausible range is a WeftWarning and is clamped to the
        possible one."""
        logged("weft_material_set", ctypes.byref(self._material), text(name, "name"), _words(value, name))

    def reads(self, name: str) -> bool:
        """Returns True if an input has any influence on this material."""
        index: int = lib.weft_material_input_find(text(name, "name"))
        if index < 0:
            raise KeyError(name)
        return bool(lib.weft_material_reads(ctypes.byref(self._material), index))

    @property
    def double_sided(self) -> bool:
        """False: visible only from the front."""
        return bool(self._material.double_sided)

    @double_sided.setter
    def double_sided(self, value: bool) -> None:
        self._material.double_sided = int(bool(value))

    @property
    def unlit(self) -> bool:
        """True: base_color is shown as it is."""
        return bool(self._material.unlit)

    @unlit.setter
    def unlit(self, value: bool) -> None:
        self._material.unlit = int(bool(value))

    @property
    def alpha_mode(self) -> str:
        """ "opaque", "mask" or "blend"."""
        return str(NAMES["WeftAlphaMode"].get(self._material.alpha_mode))

    @alpha_mode.setter
    def alpha_mode(self, value: str) -> None:
        self._material.alpha_mode = choice("WeftAlphaMode", value, "alpha_mode")

    def texture(self, name: str) -> int:
        """Returns the number, from 1, of the texture of the scene that an input is multiplied by; 0: none."""
        index: int = lib.weft_material_input_find(text(name, "name"))
        if index < 0:
            raise KeyError(name)
        return int(self._material.inputs[index].texture)


__all__ = ["InputInfo", "Material", "material_choices", "material_inputs"]
