"""Validation (lint) of a cloth asset: findings for each engine, and repairs."""
from __future__ import annotations

import ctypes
from typing import Union

from . import _abi
from ._library import Handle, PathLike, Progress, Watch, call, created, lib, names, path, text
from ._records import NAMES, Record, record


class Finding(Record):
    """One thing that is wrong: `kind`, `severity` ("note", "warning", "error"), `of` ("asset", "material", "mesh",
    "image") with `index` and `subject`, `words`, `fix`, `fixable`, the `engines` that are affected (none: any reader),
    the `figure` that was measured (NaN: none), `place` (a JSON pointer into the file)."""


class Doctor(Handle):
    """Examines a .gltf or .glb, by its path or its bytes, as it is before a reader repairs anything."""

    _free, _noun = "weft_doctor_close", "doctor"

    def __init__(self, file: Union[PathLike, bytes], *, name: str = "asset.glb", progress: Progress = None) -> None:
        self._watch = Watch(progress)
        # The library reads both once more when it writes the mended file. What a reader warns of is a finding.
        self._source = file if isinstance(file, bytes) else ctypes.create_string_buffer(path(file, "file"))
        with self._watch:
            if isinstance(self._source, bytes):
                pointer = created(
                    "weft_doctor_open_memory", self._source, len(self._source), text(name, "name"), after=(None,)
                )
            else:
                pointer = created("weft_doctor_open_watched", self._source, self._watch.callback, None, after=(None,))
            super().__init__(pointer)

    @property
    def findings(self) -> list[Finding]:
        """All findings: of the asset, then by material, by mesh and by image."""
        profiles, kinds = names("weft_profile_name"), NAMES["WeftFindingKind"]
        found = []
        with self._use() as pointer:
            for k in range(lib.weft_doctor_count(pointer)):
                source = lib.weft_doctor_finding(pointer, k).contents
                found.append(
                    record(
                        source,
                        Finding,
                        kind=kinds[source.kind],
                        fixable=bool(source.fixable),
                        engines=[p for bit, p in enumerate(profiles) if source.engines >> bit & 1],
                    )
                )
        return found

    @property
    def info(self) -> Record:
        """Counts: `material_count`, `mesh_count`, `image_count`, `sheen_count`."""
        with self._use() as pointer:
            return record(lib.weft_doctor_info(pointer))  # type: ignore[no-any-return]

    def fix(self, file: PathLike) -> None:
        """Writes the asset with all that is fixable fixed, and nothing else changed."""
        with self._use(alone=True) as pointer, self._watch:
            call("weft_doctor_fix", pointer, path(file, "file"))


def doctor(file: Union[PathLike, bytes], *, progress: Progress = None) -> list[Finding]:
    """Returns the findings about a .gltf or .glb."""
    with Doctor(file, progress=progress) as opened:
        found: list[Finding] = opened.findings
        return found


def finding_kinds() -> dict[str, Record]:
    """Returns every kind of finding: `severity`, `fixable` and `help`."""
    severities = NAMES["WeftSeverity"]
    return {
        name: Record(
            severity=severities[lib.weft_finding_severity(k)],
            fixable=bool(lib.weft_finding_fixable(k)),
            help=lib.weft_finding_help(k).decode(),
        )
        for name, k in _abi.ENUMS["WeftFindingKind"].items()
    }


__all__ = ["Doctor", "Finding", "doctor", "finding_kinds"]
