"""Arrays of numbers that calls read and write: NumPy's where it is installed, else any buffer.

The library takes structures of arrays: all x, then all y, then all z. An array of directions or colours has the shape
(..., 3), and is passed without a copy where it lies in memory like that, as all arrays that this package makes do:
they are views with the last index first. Other layouts and types are copied."""
from __future__ import annotations

import ctypes
from array import array
from math import prod
from typing import TYPE_CHECKING, Any, Optional, Sequence

from ._library import number

try:
    import numpy as np
except ImportError:
    np = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from numpy import typing as npt

    Arrays = npt.ArrayLike
    Floats = npt.NDArray[np.float32]
    Array = npt.NDArray[Any]
else:
    Arrays = Floats = Array = Any

Shape = tuple[int, ...]
_FLOAT = np.dtype(np.float32) if np else None  # of this machine's byte order

HAVE_NUMPY = np is not None
FORMATS = {"B": 1, "H": 2, "f": 4}


def _wrong(name: str, shape: Sequence[int], width: int) -> ValueError:
    wanted = f"(..., {width})" if width else "(...)"
    return ValueError(f"{name}: has the shape {tuple(shape)}, and must have {wanted}")


class Given:
    """An array that a caller gave, checked; `lead` is its shape without the last index of `width` numbers."""

    __slots__ = ("name", "width", "lead", "data")

    def __init__(self, value: Any, name: str, width: int) -> None:
        self.name, self.width = name, width
        shape, self.data = _numpy_floats(value, name) if HAVE_NUMPY else _plain_floats(value, name)
        if width and (not shape or shape[-1] != width):
            raise _wrong(name, shape, width)
        self.lead: Shape = shape[:-1] if width else shape

    def addresses(self, lead: Shape) -> tuple[Sequence[int], Any]:
        """Returns the address of each component of an array of that shape, and what has to live as long."""
        width, data = self.width, self.data
        if HAVE_NUMPY:
            if self.lead != lead:
                data = np.broadcast_to(data, lead + (width,) if width else lead)
            if width:
                data = data.T if len(lead) == 1 else np.moveaxis(data, -1, 0)
            flags = data.flags
            if not (flags.c_contiguous and flags.aligned):
                data = data.copy("C")
            start = data.ctypes.data
        else:
            count = prod(lead)
            if self.lead != lead:
                data = data * count
            if self.width:
                data = sum((data[k::width] for k in range(width)), array("f"))
            start = data.buffer_info()[0]
        return _components(start, width, lead), data


def _components(start: int, width: int, lead: Shape) -> tuple[int, ...]:
    """Returns the addresses of components that lie one after the other: of none, two or three numbers."""
    step = 4 * (lead[0] if len(lead) == 1 else prod(lead))
    return (start, start + step, start + 2 * step)[: width or 1]


def _numpy_floats(value: Any, name: str) -> tuple[Shape, Any]:
    if type(value) is np.ndarray and value.dtype == _FLOAT:
        return value.shape, value
    try:
        found = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name}: is not an array of numbers: {error}") from None
    if found.dtype.kind not in "fiu":
        raise TypeError(f"{name}: must hold real numbers, not {found.dtype}")
    with np.errstate(over="ignore"):
        return found.shape, found.astype(np.float32)


def _plain_floats(value: Any, name: str) -> tuple[Shape, array[float]]:
    """Copies a buffer of floats or integers, a number, or lists of numbers of one length."""
    if isinstance(value, (bytes, bytearray)):
        raise TypeError(f"{name}: must hold real numbers, not {type(value).__name__}")
    try:
        view = memoryview(value)
    except TypeError:
        return _plain_lists(value, name)
    if not view.c_contiguous:
        raise ValueError(f"{name}: is not contiguous")
    if view.format.lstrip("@") not in tuple("fdbBhHiIlLqQ") or view.ndim < 1:
        raise TypeError(f"{name}: must hold real numbers, not the format {view.format!r}")
    shape: Shape = view.shape or ()
    if prod(shape) == 0:
        return shape, array("f")
    flat = view.cast("B")
    if view.format == "f":
        copy = array("f")
        copy.frombytes(flat)
        return shape, copy
    return shape, array("f", flat.cast(view.format.lstrip("@")))


def _plain_lists(value: Any, name: str) -> tuple[Shape, array[float]]:
    shape: list[int] = []
    inner = value
    while isinstance(inner, (list, tuple)):
        shape.append(len(inner))
        inner = inner[0] if inner else 0.0
        if len(shape) > 32:
            raise ValueError(f"{name}: has more than 32 indices")
    flat = array("f")

    def take(part: Any, depth: int) -> None:
        if depth == len(shape):
            flat.append(number(part, name))
        elif not isinstance(part, (list, tuple)) or len(part) != shape[depth]:
            raise ValueError(f"{name}: has rows of unequal length")
        else:
            for item in part:
                take(item, depth + 1)

    take(value, 0)
    return tuple(shape), flat


def common(*given: Given) -> Shape:
    """Returns the shape that all arrays are broadcast to; without NumPy they have one shape, or are single."""
    first = given[0].lead
    for other in given:
        if other.lead != first:
            break
    else:
        return first
    if HAVE_NUMPY:
        try:
            return np.broadcast_shapes(*(g.lead for g in given))
        except ValueError:
            pass
    else:
        leads = {g.lead for g in given if g.lead != ()}
        if len(leads) == 1:
            return leads.pop()
    parts = ", ".join(f"{g.name} {g.lead + ((g.width,) if g.width else ())}" for g in given)
    raise ValueError(f"the arrays do not go together: {parts}")


class Made:
    """An array that a call fills: a new one, or the caller's `out`."""

    __slots__ = ("addresses", "_data", "_lead", "_width", "_out", "_view")

    def __init__(self, lead: Shape, width: int, out: Any = None, name: str = "out", given: Sequence[Any] = ()) -> None:
        self._lead, self._width, self._out = lead, width, None
        data: Any = None
        if HAVE_NUMPY:
            if out is not None:
                data = self._numpy_out(out, name, given)
            if data is None:
                data = np.empty((width,) + lead if width else lead, _FLOAT)
            start = data.ctypes.data
        else:
            data = array("f", bytes(4 * prod(lead) * (width or 1)))
            if out is not None:
                self._out = out
                self._view = self._plain_out(out, name)
            start = data.buffer_info()[0]
        self._data = data
        self.addresses = _components(start, width, lead)

    def _shape(self) -> Shape:
        return self._lead + ((self._width,) if self._width else ())

    def _numpy_out(self, out: Any, name: str, given: Sequence[Any]) -> Any:
        """Checks the caller's array. Returns it, components first, if the call can write into it."""
        if not isinstance(out, np.ndarray) or out.dtype != np.float32:
            kind = out.dtype if isinstance(out, np.ndarray) else type(out).__name__
            raise TypeError(f"{name}: must be an array of float32, not {kind}")
        if out.shape != self._shape():
            raise ValueError(f"{name}: has the shape {out.shape}, and must have {self._shape()}")
        if not out.flags.writeable:
            raise ValueError(f"{name}: is read-only")
        if any(np.may_share_memory(out, g) for g in given):
            raise ValueError(f"{name}: overlaps an array that is read")
        self._out = out
        first = np.moveaxis(out, -1, 0) if self._width else out
        return first if first.flags.c_contiguous and first.flags.aligned and first.dtype.isnative else None

    def _plain_out(self, out: Any, name: str) -> memoryview:
        try:
            view = memoryview(out)
        except TypeError:
            raise TypeError(f"{name}: must be a buffer of floats, not {type(out).__name__}") from None
        if view.format != "f":
            raise TypeError(f"{name}: must be a buffer of floats, not of the format {view.format!r}")
        if view.shape != self._shape():
            raise ValueError(f"{name}: has the shape {view.shape}, and must have {self._shape()}")
        if view.readonly or not view.c_contiguous:
            raise ValueError(f"{name}: is {'read-only' if view.readonly else 'not contiguous'}")
        return view

    def result(self) -> Any:
        """Returns the array as the caller gets it."""
        if HAVE_NUMPY:
            if not self._width:
                made = self._data
            elif len(self._lead) == 1:
                made = self._data.T
            else:
                made = np.moveaxis(self._data, 0, -1)
            if self._out is None:
                return made if self._shape() else made[()]
            if not np.may_share_memory(made, self._out):
                self._out[...] = made
            return self._out
        flat: array[float] = self._data
        if self._width:
            flat, count = array("f", bytes(4 * len(flat))), prod(self._lead)
            for k in range(self._width):
                flat[k :: self._width] = self._data[k * count : (k + 1) * count]
        if self._out is not None:
            if len(flat):
                self._view.cast("B")[:] = memoryview(flat).cast("B")
            return self._out
        return shaped(flat, self._shape())


def shaped(flat: array[Any], shape: Shape) -> Any:
    """Returns numbers under a shape: an array, a memoryview without NumPy, or a number where there are no indices."""
    if not shape:
        return flat[0]
    if HAVE_NUMPY:
        return np.array(flat, flat.typecode).reshape(shape)
    if prod(shape) == 0 or len(shape) == 1:
        return memoryview(flat)
    return memoryview(flat).cast("B").cast(flat.typecode, shape)


def copied(address: Optional[int], typecode: str, shape: Shape) -> Any:
    """Copies numbers that the library owns."""
    size = FORMATS[typecode] * prod(shape)
    flat = array(typecode)
    flat.frombytes(ctypes.string_at(address, size) if size and address else b"")
    return shaped(flat, shape)


class Pixels:
    """An image that a caller gave: rows, columns and 1 to 4 channels of uint8, uint16 or float32 (float64 is
    converted)."""

    __slots__ = ("shape", "typecode", "address", "_keep")
    _keep: Any

    def __init__(self, value: Any, name: str) -> None:
        kind: Any
        if HAVE_NUMPY:
            found = np.asarray(value)
            kind = {"u1": "B", "u2": "H", "f2": "f", "f4": "f", "f8": "f"}.get(found.dtype.str[1:])
            if kind is None:
                raise TypeError(f"{name}: must be of uint8, uint16 or float, not {found.dtype}")
            shape: Shape = found.shape
            with np.errstate(over="ignore"):
                self._keep = np.require(found, kind, ["C", "A"])
            self.address = self._keep.ctypes.data
        else:
            try:
                view = memoryview(value)
            except TypeError:
                raise TypeError(f"{name}: must be a buffer of pixels, not {type(value).__name__}") from None
            kind = view.format.lstrip("@")
            if kind not in FORMATS:
                raise TypeError(f"{name}: must have the format B, H or f, not {view.format!r}")
            if not view.c_contiguous:
                raise ValueError(f"{name}: is not contiguous")
            shape = view.shape or ()
            copy = array(kind, view.tobytes())
            self._keep, self.address = copy, copy.buffer_info()[0]
        if len(shape) == 2:
            shape += (1,)
        if len(shape) != 3 or not 1 <= shape[2] <= 4 or not (1 <= shape[0] <= 65536 and 1 <= shape[1] <= 65536):
            raise ValueError(f"{name}: has the shape {shape}, and must have (rows, columns) or (rows, columns, 1 to 4)")
        self.shape, self.typecode = shape, kind
