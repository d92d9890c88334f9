"""Records of the library as objects of Python."""
from __future__ import annotations

import ctypes
from typing import Any, Optional

from . import _abi
from ._arrays import copied

NAMES = {enum: {value: name for name, value in members.items()} for enum, members in _abi.ENUMS.items()}


def tidy(value: float) -> float:
    """Returns the number of fewest digits that is the same as a float of 32 bits: 0.3 and not 0.30000001192092896."""
    for digits in (6, 7, 8):
        short = float(f"{value:.{digits}g}")
        if ctypes.c_float(short).value == value:
            return short
    return value


class Record:
    """The members of a record of the library, as attributes: numbers, texts, tuples of up to 4 numbers, arrays, and the
    names of choices. `as_dict()` gives them as a dict."""

    def __init__(self, **members: Any) -> None:
        self.__dict__.update(members)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"{type(self).__name__} has no member {name!r}; it has {', '.join(self.__dict__)}")

    def __repr__(self) -> str:
        def short(value: Any) -> str:
            shape = getattr(value, "shape", None)
            return f"<array {'x'.join(map(str, shape))}>" if shape else f"{value!r:.120}"

        return f"{type(self).__name__}({', '.join(f'{k}={short(v)}' for k, v in self.__dict__.items() if k[0] != '_')})"

    def __eq__(self, other: Any) -> bool:
        return type(self) is type(other) and repr(self) == repr(other)

    __hash__ = None  # type: ignore[assignment]

    def as_dict(self) -> dict[str, Any]:
        """Returns the members, those of members that are records too."""

        def plain(value: Any) -> Any:
            if isinstance(value, Record):
                return value.as_dict()
            return [plain(v) for v in value] if isinstance(value, list) else value

        return {name: plain(value) for name, value in self.__dict__.items() if name[0] != "_"}


def _array(value: Any) -> Any:
    """Converts an array of a record: texts, a tuple, an array of numbers, or a list of records."""
    shape: list[int] = []
    kind = type(value)
    while hasattr(kind, "_length_"):
        if kind._type_ is ctypes.c_char:
            return value.value.decode("utf-8", "replace") if not shape else [_array(v) for v in value]
        shape.append(kind._length_)
        kind = kind._type_
    if issubclass(kind, ctypes.Structure):
        return [record(v) for v in value]
    if kind in (ctypes.c_int, ctypes.c_longlong):
        return tuple(value) if len(shape) == 1 else [_array(v) for v in value]
    if len(shape) == 1 and shape[0] <= 4:
        return tuple(map(tidy, value)) if kind is ctypes.c_float else tuple(value)
    if kind is ctypes.c_float:
        return copied(ctypes.addressof(value), "f", tuple(shape))
    return [_array(v) for v in value]


def value_of(owner: Any, field: str, kind: Any) -> Any:
    """Returns one member as an object of Python; addresses are None."""
    value = getattr(owner, field)
    enum: Optional[str] = _abi.CHOICES.get((type(owner).__name__, field))
    if enum:
        return NAMES[enum].get(value, value)
    if hasattr(kind, "_length_"):
        return _array(value) if kind._type_ is not ctypes.c_char else value.decode("utf-8", "replace")
    if kind is ctypes.c_char_p:
        return value.decode("utf-8", "replace") if value is not None else None
    if isinstance(value, ctypes.Structure):
        return record(value)
    return tidy(value) if kind is ctypes.c_float else value


def record(source: Any, cls: type[Record] = Record, leave: tuple[str, ...] = (), **more: Any) -> Any:
    """Returns a record as an object. leave: members that are left out; addresses always are."""
    members = {}
    for entry in source._fields_:
        field, kind = entry[0], entry[1]
        if field in leave or kind is ctypes.c_void_p or issubclass(kind, ctypes._Pointer):
            continue
        members["default" if field == "def" else field] = value_of(source, field, kind)
    members.update(more)
    return cls(**members)


__all__ = ["Record", "record", "tidy"]
