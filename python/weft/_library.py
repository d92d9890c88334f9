"""The shared library: finding it, calling it, and owning what it makes."""
from __future__ import annotations

import ctypes
import operator
import os
import signal
import sys
import threading
import warnings
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any, Callable, Iterator, Optional, Union

from . import _abi

Progress = Optional[Callable[[float], Any]]
PathLike = Union[str, "os.PathLike[str]"]

RESULTS = {value: name for name, value in _abi.ENUMS["WeftResult"].items()}
MESSAGES = {value: name for name, value in _abi.ENUMS["WeftMessage"].items()}
OK, INTERRUPTED = _abi.ENUMS["WeftResult"]["ok"], _abi.ENUMS["WeftResult"]["interrupted"]


class Error(Exception):
    """A call of the library that failed; `str()` is its one line, "subject: text: detail".

    `code` is the number of the result, the exit code that the program would have: 1 failed, 2 a name or number makes no
    sense, 3 an input cannot be read, 4 memory, disk or device, 130 interrupted. `result` is the result in a word
    ("usage"), `message` the id of the message ("lobe-name", as WEFT_MESSAGE_LOBE_NAME)."""

    def __init__(self, text: str, code: int = 1, message: str = "none") -> None:
        super().__init__(text)
        self.code, self.result, self.message = code, RESULTS.get(code, "failed"), message

    def __reduce__(self) -> Any:
        return Error, (str(self), self.code, self.message)


class WeftWarning(UserWarning):
    """A warning of the library, such as a value that was clamped or an image that was repaired."""


class _Library:
    """The loaded library. A call is bound when it is first used."""

    def __init__(self) -> None:
        name = os.environ.get("WEFT_LIBRARY") or f"libweft.so.{_abi.ABI}"
        try:
            self._dll = ctypes.CDLL(name)
        except OSError as error:
            raise ImportError(
                f"{name}: the library of weft cannot be loaded: {error}. Install the package weft, or set "
                "WEFT_LIBRARY to the path of libweft.so"
            ) from None
        version: bytes = self.weft_version()
        mine = _abi.VERSION.split(".")[:2]
        if version.decode().split(".")[:2] != mine:
            raise ImportError(
                f"{name}: is version {version.decode()} of weft, and this package was made for " f"{'.'.join(mine)}"
            )

    def __getattr__(self, name: str) -> Any:
        if name not in _abi.CALLS:
            raise AttributeError(name)
        result, parameters = _abi.CALLS[name]
        try:
            function = getattr(self._dll, name)
        except AttributeError:
            raise Error(f"{self._dll._name}: lacks {name}: it is older than this package", 4) from None
        function.restype, function.argtypes = result, parameters
        setattr(self, name, function)
        return function


lib = _Library()


# ---- arguments


def text(value: Any, name: str) -> bytes:
    """Returns a text as the library takes it: UTF-8."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: must be a text, not {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"{name}: has a zero in it")
    try:
        return value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{name}: cannot be written as UTF-8") from None


def path(value: Any, name: str = "path") -> bytes:
    """Returns the path of a file as the library takes it."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: must be a path, not {type(value).__name__}")
    encoded = os.fsencode(value)
    if b"\0" in encoded:
        raise ValueError(f"{name}: has a zero in it")
    return encoded


def number(value: Any, name: str) -> float:
    """Returns a real number."""
    if isinstance(value, (str, bytes, bytearray)) or not (hasattr(value, "__float__") or hasattr(value, "__index__")):
        raise TypeError(f"{name}: must be a number, not {type(value).__name__}")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{name}: is too large") from None


def integer(value: Any, name: str, low: int = -(2**31), high: int = 2**31 - 1) -> int:
    """Returns a whole number within a range."""
    try:
        whole = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: must be a whole number, not {type(value).__name__}") from None
    if not low <= whole <= high:
        raise ValueError(f"{name}: is {whole if abs(whole) < 10**20 else 'too large'}, and must be {low} to {high}")
    return whole


def choice(enum: str, value: Any, name: str) -> int:
    """Returns the number of a member of an enumeration by its name."""
    members = _abi.ENUMS[enum]
    if not isinstance(value, str):
        raise TypeError(f"{name}: must be a text, not {type(value).__name__}")
    if value not in members:
        raise ValueError(f"{name}: is {value!r:.40}, and must be one of {', '.join(members)}")
    return members[value]


def triple(value: Any, name: str, count: int = 3) -> list[float]:
    """Returns so many real numbers; one number stands for all of them."""
    if hasattr(value, "__float__") and not hasattr(value, "__len__"):
        return [number(value, name)] * count
    try:
        values = [number(v, name) for v in value]
    except TypeError:
        raise TypeError(f"{name}: must be {count} numbers") from None
    if len(values) != count:
        raise ValueError(f"{name}: has {len(values)} numbers, and must have {count}")
    return values


def _member(record: ctypes.Structure, field: str, kind: Any, value: Any) -> Any:
    enum = _abi.CHOICES.get((type(record).__name__, field))
    if enum:
        return choice(enum, value, field)
    if kind is ctypes.c_int:
        return integer(value, field)
    if kind in (ctypes.c_uint, ctypes.c_uint32):
        return integer(value, field, 0, 2**32 - 1)
    if kind in (ctypes.c_float, ctypes.c_double):
        return number(value, field)
    if kind is ctypes.c_char_p:
        return text(value, field)
    if hasattr(kind, "_length_"):
        values = triple(value, field, kind._length_)
        whole = kind._type_ is ctypes.c_int
        return kind(*([integer(int(v) if v.is_integer() else None, field) for v in values] if whole else values))
    return value


def fill(record: Any, **members: Any) -> Any:
    """Sets members of a record after checking type and range of each; None leaves one as it is."""
    kinds = {field[0]: field[1] for field in record._fields_}
    for field, value in members.items():
        if value is not None:
            setattr(record, field, _member(record, field, kinds[field], value))
    return record


# ---- calls


def raise_error(error: Any) -> None:
    """Raises what the library says of a call that failed."""
    raise Error(error.text.decode("utf-8", "replace"), error.result, MESSAGES.get(error.message, "none"))


def call(name: str, *arguments: Any) -> None:
    """Makes a call whose last parameter is a WeftError."""
    error = _abi.WeftError()
    if getattr(lib, name)(*arguments, ctypes.byref(error)):
        raise_error(error)


def logged(name: str, *arguments: Any, undo: Optional[Callable[[], Any]] = None) -> None:
    """Makes a call whose last parameters are a WeftLog and a WeftError; its warnings become Python's. undo frees what the
    call made, where a warning is an exception (`python -W error`)."""
    made = False
    try:
        with Log() as log:
            call(name, *arguments, log.pointer)
            made = True
    except BaseException:
        if made and undo:
            undo()
        raise


class Log:
    """Collects the warnings of calls, which may come from other threads, and issues them afterwards."""

    def __init__(self) -> None:
        self._texts: list[str] = []
        self._record = _abi.WeftLog()
        kind: Any = _abi.WeftLog._fields_[0][1]
        self._fn = kind(self._take)
        self._record.fn = self._fn
        self.pointer = ctypes.byref(self._record)

    def _take(self, user: Any, message: int, words: bytes) -> None:
        self._texts.append(words.decode("utf-8", "replace"))

    def __enter__(self) -> Log:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Optional[TracebackType]) -> None:
        for words in self._texts:
            warnings.warn(words, WeftWarning, stacklevel=_depth())


def _depth() -> int:
    """Returns how far up the first frame outside of this package is, for warnings.warn."""
    folder, depth = os.path.dirname(__file__), 1
    frame: Optional[FrameType] = sys._getframe(1)
    while frame and os.path.dirname(frame.f_code.co_filename) == folder:
        frame, depth = frame.f_back, depth + 1
    return depth


class Watch:
    """The progress of one long call, which Ctrl+C stops. Python's own handler would raise inside the callback, where an
    exception is lost: for the time of the call a press is noted, and KeyboardInterrupt is raised after it."""

    def __init__(self, progress: Progress) -> None:
        if progress is not None and not callable(progress):
            raise TypeError("progress: must be a function of one number")
        self._progress, self._earlier = progress, None  # type: Progress, Any
        self._failure: Optional[BaseException] = None
        self._pressed = self.stopped = False
        self.callback = _abi.WeftProgress(self._report)

    def _report(self, user: Any, fraction: float) -> int:
        try:
            if self._progress is not None and not self._pressed and self._progress(fraction):
                self.stopped = True
        except BaseException as failure:  # raised again when the call has returned
            self._failure = failure
        return int(self._pressed or self.stopped or self._failure is not None)

    def _note(self, number: int, frame: Optional[FrameType]) -> None:
        if self._pressed:
            raise KeyboardInterrupt
        self._pressed = True

    def __enter__(self) -> Watch:
        self._failure, self._pressed, self.stopped, self._earlier = None, False, False, None
        if (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        ):
            self._earlier = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: Any, error: Any, trace: Optional[TracebackType]) -> None:
        if self._earlier is not None:
            signal.signal(signal.SIGINT, self._earlier)
        if self._failure is not None:
            raise self._failure from None
        if self._pressed:
            raise KeyboardInterrupt from None
        if self.stopped and isinstance(error, Error):
            raise Error("stopped by progress", INTERRUPTED) from None


class Handle:
    """Owns what the library made. Freed by close(), at the end of a `with`, or when nothing refers to it; while a call
    uses it, or while something made of it lives, it is freed after that. Use of a closed one is a ValueError."""

    _free = ""
    _noun = "object"

    def __init__(self, pointer: Any, *made_of: Handle) -> None:
        self._lock = threading.RLock()
        self._pointer, self._users, self._holders, self._closed = pointer, 0, 0, False
        self._made_of = made_of
        for other in made_of:
            other._hold()

    def _hold(self) -> None:
        with self._lock:
            self._holders += 1

    def _release(self) -> None:
        with self._lock:
            self._holders -= 1
        self._settle()

    def _settle(self) -> None:
        with self._lock:
            if not self._closed or self._users or self._holders or not self._pointer:
                return
            pointer, self._pointer = self._pointer, None
        getattr(lib, self._free)(pointer)
        for other in self._made_of:
            other._release()

    def close(self) -> None:
        """Frees it. May be called more than once."""
        if hasattr(self, "_closed"):
            self._closed = True
            self._settle()

    @property
    def closed(self) -> bool:
        """True after close()."""
        return self._closed

    @contextmanager
    def _use(self, alone: bool = False) -> Iterator[Any]:
        """Gives the pointer for the time of a call. alone: no other call may use it at the same time."""
        with self._lock:
            if self._closed:
                raise ValueError(f"the {self._noun} is closed")
            if self._users < 0 or (alone and self._users):
                raise RuntimeError(f"the {self._noun} is in use by a call that has not returned")
            self._users = -1 if alone else self._users + 1
        try:
            yield self._pointer
        finally:
            with self._lock:
                self._users = 0 if alone else self._users - 1
            self._settle()

    def __enter__(self) -> Any:
        if self._closed:
            raise ValueError(f"the {self._noun} is closed")
        return self

    def __exit__(self, kind: Any, error: Any, trace: Optional[TracebackType]) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()

    def __copy__(self) -> Any:
        raise TypeError(f"a {self._noun} cannot be copied")

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError(f"a {self._noun} cannot be copied or pickled")


def created(name: str, *arguments: Any, free: str = "", after: tuple[Any, ...] = ()) -> Any:
    """Makes a call that fills a handle, which stands before `after` and the WeftError; returns the handle. free, the call
    that frees it, is named where there is a WeftLog before the WeftError."""
    out = ctypes.c_void_p()
    if free:
        logged(name, *arguments, ctypes.byref(out), *after, undo=lambda: getattr(lib, free)(out))
    else:
        call(name, *arguments, ctypes.byref(out), *after)
    return out.value


def owned_text(pointer: Any) -> str:
    """Returns a text that the library made, and frees it."""
    try:
        return ctypes.string_at(pointer).decode()
    finally:
        _libc.free(pointer)


_libc = ctypes.CDLL(None)
_libc.free.argtypes, _libc.free.restype = [ctypes.c_void_p], None


def names(call_name: str, *arguments: Any) -> list[str]:
    """Returns what a call by index says, until it says NULL."""
    found: list[str] = []
    function = getattr(lib, call_name)
    while (name := function(*arguments, len(found))) is not None:
        found.append(name.decode())
    return found


def index_of(call_name: str, value: Any, what: str) -> int:
    """Returns the index of a name in a list of the library."""
    text(value, what)
    known = names(call_name)
    if value not in known:
        raise ValueError(f"{what}: is {value!r:.40}, and must be one of {', '.join(known)}")
    return known.index(value)
