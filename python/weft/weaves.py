"""Weaving drafts, yarns, and cloths woven of them."""
from __future__ import annotations

import ctypes
from array import array
from typing import Any, Iterable, Union

from . import _abi
from ._arrays import Array, shaped
from ._library import Handle, PathLike, call, choice, created, integer, lib, names, number, path, text
from ._records import Record, record, tidy
from .images import taken


class Thread(Record):
    """A thread: `color` (r, g, b), sRGB-encoded in [0, 1], `spacing` to the next and `thickness`, metres."""


class DraftInfo(Record):
    """The figures of a draft: `title`, `count` (warp, weft), `shafts`, `treadles`, `size` (m), `warp_share`,
    `longest_float` and `endless` (warp, weft)."""


class ClothInfo(Record):
    """The figures of a cloth: `share` of warp and weft of its area, `size` of the repeat (m), `sett` (threads per cm),
    `metres` that a unit of texture coordinates spans, `automatic`, `rotation` (degrees), `relief` (m), `seed`."""


class Draft(Handle):
    """A weaving draft: one repeat of a cloth, of a file (WIF, DTX, or an image) or of notation such as "twill 2/2 z".
    Warp threads are counted from the left, picks from the bottom."""

    _free, _noun = "weft_draft_free", "draft"

    def __init__(self, what: Union[PathLike, bytes], *, name: str = "draft.wif") -> None:
        if isinstance(what, bytes):
            pointer = created("weft_draft_read_memory", what, len(what), text(name, "name"), free=self._free)
        else:
            pointer = created("weft_draft_read", path(what, "what"), free=self._free)
        super().__init__(pointer)

    @classmethod
    def _of(cls, pointer: Any) -> Draft:
        draft = cls.__new__(cls)
        Handle.__init__(draft, pointer)
        return draft

    def __repr__(self) -> str:
        if self.closed:
            return "<Draft, closed>"
        warp, weft = self.info.count
        return f"<Draft {self.info.title!r} {warp} x {weft}>"

    @property
    def info(self) -> DraftInfo:
        """Its figures."""
        with self._use() as pointer:
            return record(lib.weft_draft_info(pointer), DraftInfo)  # type: ignore[no-any-return]

    @property
    def up(self) -> Array:
        """1 where the warp lies on top, shape (picks, warp threads), uint8; row 0 is the first pick. A copy."""
        with self._use() as pointer:
            warp, weft = lib.weft_draft_info(pointer).count
            cells = array("B", (lib.weft_draft_warp_up(pointer, x, y) for y in range(weft) for x in range(warp)))
        return shaped(cells, (weft, warp))  # type: ignore[no-any-return]

    def set_up(self, warp: int, pick: int, up: bool) -> None:
        """Puts the warp, or the weft, on top at one crossing; indices wrap around."""
        with self._use(alone=True) as pointer:
            lib.weft_draft_set_up(pointer, integer(warp, "warp"), integer(pick, "pick"), int(bool(up)))

    def threads(self, system: str) -> list[Thread]:
        """Returns all threads of "warp" or "weft"."""
        index = choice("WeftThreads", system, "system")
        with self._use() as pointer:
            count = lib.weft_draft_info(pointer).count[index]
            return [record(lib.weft_draft_thread(pointer, index, k), Thread) for k in range(count)]

    def set_sett(self, system: str, per_metre: float) -> None:
        """Sets the number of threads per metre, 1 to 1e6, of "warp" or "weft"."""
        with self._use(alone=True) as pointer:
            call(
                "weft_draft_set_sett", pointer, choice("WeftThreads", system, "system"), number(per_metre, "per_metre")
            )

    def back(self) -> Draft:
        """Returns the draft of the back."""
        with self._use() as pointer:
            return self._of(created("weft_draft_back", pointer))

    def copy(self) -> Draft:
        """Returns a draft that can be changed by itself."""
        with self._use() as pointer:
            return self._of(created("weft_draft_copy", pointer))

    def write(self, file: PathLike) -> None:
        """Writes the draft by suffix: .wif, .png, .svg, .pdf or .txt."""
        with self._use() as pointer:
            call("weft_draft_write", pointer, path(file, "file"))


def _yarn_numbers() -> list[Any]:
    found: list[Any] = []
    while True:
        entry = lib.weft_yarn_number(len(found))
        if not entry:
            return found
        found.append(entry.contents)


def yarns() -> dict[str, str]:
    """Returns the names of yarns, each with a line on it."""
    return dict(zip(names("weft_yarn_name"), names("weft_yarn_help")))


def weaves() -> dict[str, str]:
    """Returns the words by which notation names a weave, each with what may follow it."""
    return dict(zip(names("weft_weave_name"), names("weft_weave_help")))


class Yarn:
    """The yarn of one system, as it lies in a cloth, by name; keyword arguments change its numbers, such as `alpha`
    (of its fibres), `crimp` and `twist` (radians), `roundness`, `dye`, `slub`, `hairiness`. `Yarn.numbers()` has all
    of them, with their ranges."""

    __slots__ = ("_yarn",)

    def __init__(self, name: str = "cotton", **numbers: float) -> None:
        self._yarn = _abi.WeftYarn()
        call("weft_yarn_find", text(name, "name"), ctypes.byref(self._yarn))
        for member, value in numbers.items():
            self[member] = value

    @classmethod
    def _of(cls, source: Any) -> Yarn:
        yarn = cls.__new__(cls)
        yarn._yarn = _abi.WeftYarn.from_buffer_copy(source)
        return yarn

    @staticmethod
    def numbers() -> dict[str, Record]:
        """Returns the numbers of a yarn by name: `help`, and the range `low` to `high`."""
        return {n.name.decode(): record(n, leave=("offset",)) for n in _yarn_numbers()}

    def _number(self, name: str) -> str:
        if name not in (field[0] for field in _abi.WeftYarn._fields_):
            raise KeyError(name)
        return name

    def __getitem__(self, name: str) -> float:
        return tidy(getattr(self._yarn, self._number(name)))

    def __setitem__(self, name: str, value: float) -> None:
        setattr(self._yarn, self._number(name), number(value, name))

    def __repr__(self) -> str:
        return f"Yarn({', '.join(f'{f[0]}={self[f[0]]:g}' for f in _abi.WeftYarn._fields_)})"


def _yarn_pair(given: Any) -> Any:
    if isinstance(given, (str, Yarn)):
        given = (given, given)
    pair = [Yarn(y) if isinstance(y, str) else y for y in given] if isinstance(given, Iterable) else []
    if len(pair) != 2 or not all(isinstance(y, Yarn) for y in pair):
        raise TypeError("yarns: must be a Yarn or its name, or two of them: warp and weft")
    return (_abi.WeftYarn * 2)(*(y._yarn for y in pair))


class Cloth(Handle):
    """A draft woven of yarns: one for both systems, or a pair (warp, weft), as names or Yarn. seed selects the
    variation."""

    _free, _noun = "weft_cloth_free", "cloth"

    def __init__(self, draft: Union[Draft, str], yarns: Any = "cotton", *, seed: int = 0) -> None:
        pair = _yarn_pair(yarns)
        if isinstance(draft, str):
            draft = Draft(draft)
        if not isinstance(draft, Draft):
            raise TypeError(f"draft: must be a Draft or its notation, not {type(draft).__name__}")
        with draft._use() as pointer:
            made = created("weft_cloth_create", pointer, pair, integer(seed, "seed", 0, 2**32 - 1))
        super().__init__(made)

    @classmethod
    def _of(cls, pointer: Any) -> Cloth:
        cloth = cls.__new__(cls)
        Handle.__init__(cloth, pointer)
        return cloth

    @property
    def info(self) -> ClothInfo:
        """Its figures."""
        with self._use() as pointer:
            return record(lib.weft_cloth_info(pointer), ClothInfo)  # type: ignore[no-any-return]

    def draw(self, pixels: int = 512, threads: float = 16.0) -> Array:
        """Draws a square from above, so many warp threads over so many pixels: shape (pixels, pixels, 3), uint8."""
        image = _abi.WeftImage()
        with self._use() as pointer:
            call("weft_cloth_draw", pointer, integer(pixels, "pixels"), number(threads, "threads"), ctypes.byref(image))
        return taken(image)

    def bake(self, folder: PathLike, *, pixels: int = 1024, metres: float = 1.0) -> None:
        """Writes tiling textures and a material file into a folder; metres: that one unit of texture coordinates
        spans."""
        with self._use() as pointer:
            call(
                "weft_cloth_bake", pointer, integer(pixels, "pixels"), number(metres, "metres"), path(folder, "folder")
            )


def parse_draft(notation: str) -> Draft:
    """Makes a draft of notation alone, never of a file of that name."""
    return Draft._of(created("weft_draft_parse", text(notation, "notation")))


__all__ = ["Cloth", "ClothInfo", "Draft", "DraftInfo", "Thread", "Yarn", "parse_draft", "weaves", "yarns"]
