"""Lists of the catalogue, and settings of the process."""
from __future__ import annotations

from typing import Optional

from ._library import PathLike, call, choice, index_of, lib, names, path, text
from ._records import Record, record


def _with_help(call_name: str, *arguments: int) -> dict[str, str]:
    return dict(zip(names(call_name + "_name", *arguments), names(call_name + "_help", *arguments)))


def terms(kind: str) -> dict[str, str]:
    """Returns the terms "d", "v" or "f", each with a line on it."""
    return _with_help("weft_term", choice("WeftTermKind", kind, "kind"))


def layers() -> dict[str, str]:
    """Returns the layer rules, each with a line on it."""
    return _with_help("weft_layer")


def workflows() -> dict[str, str]:
    """Returns the workflows of materials, each with a line on it."""
    return _with_help("weft_workflow")


def profiles() -> dict[str, str]:
    """Returns the engine profiles, each with a line on it."""
    return _with_help("weft_profile")


def presets() -> dict[str, str]:
    """Returns the presets of materials, each with a line on it."""
    return _with_help("weft_preset")


def preset_groups() -> dict[str, list[str]]:
    """Returns the groups of presets, in the order to show them, and the presets of each."""
    groups: dict[str, list[str]] = {name: [] for name in names("weft_preset_group_name")}
    for preset, group in zip(names("weft_preset_name"), names("weft_preset_group")):
        groups.setdefault(group, []).append(preset)
    return groups


def preset_text(name: str) -> str:
    """Returns the material file of a preset, JSON."""
    return names("weft_preset_text")[index_of("weft_preset_name", name, "name")]


def builtins() -> dict[str, str]:
    """Returns the built-in scenes, without "builtin:", each with a line on it."""
    return _with_help("weft_builtin")


def aliases() -> dict[str, str]:
    """Returns the names that sources use for terms, each with the kind and id of the term."""
    return _with_help("weft_alias")


class ChartEntry(Record):
    """A material of the reference chart: `name`, `help`, `source`, `kind` ("opaque", "clear", "gem", "metal"),
    `base_color` and `f0`, linear Rec. 709, and `ior` (0 of a metal)."""


def chart() -> list[ChartEntry]:
    """Returns the reference materials, measured and published."""
    found: list[ChartEntry] = []
    while entry := lib.weft_chart(len(found)):
        found.append(record(entry.contents, ChartEntry))
    return found


def catalogue_text(file: str) -> str:
    """Returns the text of a file of the catalogue as it was compiled, such as "lobes/ggx.h", with formula and
    source."""
    found: Optional[bytes] = lib.weft_catalogue_text(text(file, "file"))
    if found is None:
        raise KeyError(file)
    return found.decode()


def version() -> str:
    """Returns the version of the library that runs."""
    found: bytes = lib.weft_version()
    return found.decode()


def isa() -> str:
    """Returns the instruction set of loops in use: "sse2", "avx2" or "avx512"."""
    found: bytes = lib.weft_isa()
    return found.decode()


def use_isa(name: Optional[str] = None) -> None:
    """Pins the instruction set for the whole process; None: the widest. Not while another thread uses weft."""
    call("weft_isa_use", None if name is None else text(name, "name"))


def use_root(folder: Optional[PathLike]) -> None:
    """Lets assets name files in folder too, for the whole process; None: those of their own folders alone. Not while
    another thread uses weft."""
    call("weft_root_use", None if folder is None else path(folder, "folder"))


__all__ = [
    "ChartEntry",
    "aliases",
    "builtins",
    "catalogue_text",
    "chart",
    "isa",
    "layers",
    "preset_groups",
    "preset_text",
    "presets",
    "profiles",
    "terms",
    "use_isa",
    "use_root",
    "version",
    "workflows",
]
