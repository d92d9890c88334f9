"""Pictures and tables as arrays: files, tone mapping, differences, sheets.

An image is an array of rows (from the top), columns and 1 to 4 channels (1: also without the last index): uint8 or
uint16, display-referred, or float32, linear Rec. 709; alpha is straight. Without NumPy it is a memoryview of the
format B, H or f."""
from __future__ import annotations

import ctypes
from typing import Any, Mapping, Optional, Sequence, Union

from . import _abi
from ._arrays import Array, Arrays, Pixels, copied
from ._library import PathLike, call, choice, fill, integer, lib, logged, number, path, text, triple
from ._records import Record, record

_TYPES = {"B": 0, "H": 1, "f": 2}


def taken(image: Any) -> Array:
    """Returns an image of the library as an array, and frees it."""
    try:
        return seen(image)
    finally:
        lib.weft_image_free(ctypes.byref(image))


def seen(image: Any) -> Array:
    """Copies an image of the library."""
    typecode = "BHf"[image.type]
    shape = (image.height, image.width) + ((image.channels,) if image.channels > 1 else ())
    return copied(image.pixels, typecode, shape)  # type: ignore[no-any-return]


def given(value: Any, name: str) -> tuple[Any, Any]:
    """Returns a record of the library around an array, and what has to live as long."""
    pixels = Pixels(value, name)
    height, width, channels = pixels.shape
    return _abi.WeftImage(width, height, channels, _TYPES[pixels.typecode], pixels.address), pixels


def read_image(file: Union[PathLike, bytes], *, name: str = "image") -> Array:
    """Reads a PNG, JPEG, TGA, HDR, EXR, DDS, TIFF or NPY, of a path or of bytes (errors then begin with name)."""
    image = _abi.WeftImage()
    out = ctypes.byref(image)
    if isinstance(file, bytes):
        logged(
            "weft_image_read_memory", file, len(file), text(name, "name"), out, undo=lambda: lib.weft_image_free(out)
        )
    else:
        logged("weft_image_read", path(file, "file"), out, undo=lambda: lib.weft_image_free(out))
    return taken(image)


def read_channels(file: PathLike, channels: Sequence[str]) -> Array:
    """Reads 1 to 4 channels of an .exr by their full names, such as "albedo.R", as the floats of the file."""
    if isinstance(channels, str) or not 1 <= len(channels) <= 4:
        raise ValueError("channels: must be 1 to 4 names")
    names, image = (ctypes.c_char_p * 4)(*(text(c, "channels") for c in channels)), _abi.WeftImage()
    call("weft_image_read_channels", path(file, "file"), names, len(channels), ctypes.byref(image), None)
    return taken(image)


def write_image(
    file: PathLike,
    image: Arrays,
    *,
    data: bool = False,
    single: bool = False,
    comment: Optional[str] = None,
    layers: Optional[Mapping[str, Arrays]] = None,
) -> None:
    """Writes by suffix: .png (uint8, uint16), .exr, .hdr, .npy (float32).

    data: linear data, a .png is not marked sRGB; single: an .exr of 32 bit floats instead of half; comment: a line
    kept in the file; layers: of an .exr, further arrays by name, whose channels are NAME.R, NAME.G and so on (one:
    NAME)."""
    record_, keep = given(image, "image")
    how = fill(_abi.WeftImageWriting(), data=int(bool(data)), single=int(bool(single)), comment=comment)
    kept: list[Any] = []
    if layers:
        if len(layers) > _abi.CONSTANTS["WEFT_IMAGE_LAYERS"]:
            raise ValueError(
                f"layers: are {len(layers)}, and at most {_abi.CONSTANTS['WEFT_IMAGE_LAYERS']} can be written"
            )
        rows = (_abi.WeftImageLayer * len(layers))()
        for row, (name, array) in zip(rows, layers.items()):
            layer, pixels = given(array, name)
            if pixels.typecode != "f" or pixels.shape[:2] != keep.shape[:2]:
                raise ValueError(f"{name}: a layer must be float32, of the picture's size")
            row.image = ctypes.pointer(layer)
            channels = (
                [text(name, "layer")]
                if layer.channels == 1
                else [text(f"{name}.{c}", "layer") for c in "RGBA"[: layer.channels]]
            )
            row.channels[: len(channels)] = channels
            kept += [layer, pixels]
        how.layers, how.layer_count = rows, len(layers)
    call("weft_image_write_as", path(file, "file"), ctypes.byref(record_), ctypes.byref(how))


def tonemap(
    image: Arrays,
    curve: str = "pbr-neutral",
    *,
    exposure: Union[float, str] = 0.0,
    white: Union[None, str, float, Sequence[float]] = None,
    background: Optional[Sequence[float]] = None,
) -> Array:
    """Returns a linear picture of 3 or 4 channels for display: uint8, sRGB-encoded.

    curve: "pbr-neutral", "aces", "agx" or "none"; exposure in stops, or "auto", which shows the mean as middle grey;
    white: the light that shows as white, kelvin (1700 to 25000), chromaticity x and y, or "auto", which estimates it;
    background: light of the display, linear in [0, 1], behind what is transparent."""
    source, keep = given(image, "image")
    tone = _abi.WeftTone(curve=choice("WeftTonemap", curve, "curve"))
    if exposure == "auto":
        tone.exposure = lib.weft_image_meter(ctypes.byref(source)) if keep.typecode == "f" else 0.0
    else:
        tone.exposure = number(exposure, "exposure")
    _white(tone, source, white, keep.typecode)
    behind = (ctypes.c_float * 3)(*triple(background, "background")) if background is not None else None
    out = _abi.WeftImage()
    call("weft_image_show", ctypes.byref(source), ctypes.byref(tone), behind, ctypes.byref(out))
    return taken(out)


def _white(tone: Any, source: Any, white: Any, typecode: str) -> None:
    """Sets the light that shows as white."""
    if white is None:
        return
    if isinstance(white, str):
        if white != "auto":
            raise ValueError(f"white: is {white!r:.40}, and must be kelvin, x and y, or auto")
        if typecode == "f":
            lib.weft_image_find_white(ctypes.byref(source), tone.white)
    elif hasattr(white, "__len__") and not hasattr(white, "__index__"):
        tone.white[:] = triple(white, "white", 2)
    else:
        kelvin = number(white, "white")
        if not 1700.0 <= kelvin <= 25000.0:
            raise ValueError(f"white: is {kelvin:g} K, and must be 1700 to 25000")
        lib.weft_white(kelvin, 0.0, tone.white)


def to_linear(image: Arrays, *, srgb: bool = True) -> Array:
    """Returns an image as float32: integers in [0, 1], colours decoded from sRGB unless srgb is False."""
    source, keep = given(image, "image")
    out = _abi.WeftImage()
    call("weft_image_convert_f32", ctypes.byref(source), int(bool(srgb)), ctypes.byref(out))
    del keep
    return taken(out)


class Difference(Record):
    """The difference of two images: `value` by the metric, `worst` with `worst_x` and `worst_y`, `high` (99 of 100
    pixels are no worse), `exposures` with `exposure_low` and `exposure_high` (stops), and `map`, an array of every
    pixel's."""

    def beyond(self, limit: float) -> float:
        """Returns the fraction of pixels, 0 to 1, that are worse than limit."""
        source, keep = given(self.map, "map")
        found: float = lib.weft_diff_beyond(
            ctypes.byref(source), choice("WeftMetric", self.metric, "metric"), number(limit, "limit")
        )
        del keep
        return found


def diff(
    image: Arrays,
    reference: Arrays,
    metric: str = "relmse",
    *,
    pixels_per_degree: float = 0.0,
    tonemap: str = "pbr-neutral",
    exposure: Optional[float] = None,
    threads: int = 0,
) -> Difference:
    """Measures the difference of two images of one size by "relmse" (0: equal), "flip" (0: equal, 1) or "ssim" (1:
    equal).

    flip: pixels_per_degree of sight, 0: 67; two linear pictures are compared over a range of exposures, or at
    `exposure` stops where that is given."""
    a, keep_a = given(image, "image")
    b, keep_b = given(reference, "reference")
    if keep_a.shape[:2] != keep_b.shape[:2]:
        raise ValueError(
            f"image: has {keep_a.shape[1]} x {keep_a.shape[0]} pixels, and reference {keep_b.shape[1]} x "
            f"{keep_b.shape[0]}"
        )
    desc = fill(
        _abi.WeftDiffDesc(),
        metric=metric,
        pixels_per_degree=pixels_per_degree,
        tonemap=tonemap,
        exposure=exposure,
        exposed=int(exposure is not None),
        threads=threads,
    )
    desc.image, desc.reference = ctypes.pointer(a), ctypes.pointer(b)
    found, map_ = _abi.WeftDiff(), _abi.WeftImage()
    call("weft_diff", ctypes.byref(desc), ctypes.byref(found), ctypes.byref(map_))
    return record(found, Difference, metric=metric, map=taken(map_))  # type: ignore[no-any-return]


def difference_image(image: Arrays, reference: Arrays, scale: float) -> Array:
    """Draws how two linear pictures differ, uint8: red where image is brighter, blue where darker, full at scale."""
    a, keep_a = given(image, "image")
    b, keep_b = given(reference, "reference")
    out = _abi.WeftImage()
    call("weft_difference_image", ctypes.byref(a), ctypes.byref(b), number(scale, "scale"), ctypes.byref(out))
    del keep_a, keep_b
    return taken(out)


def heat_image(map: Arrays, none: float, most: float) -> Array:
    """Draws a map of one channel, uint8: black at none, yellow at most."""
    source, keep = given(map, "map")
    out = _abi.WeftImage()
    call("weft_heat_image", ctypes.byref(source), number(none, "none"), number(most, "most"), ctypes.byref(out))
    del keep
    return taken(out)


def sheet(
    images: Sequence[Arrays],
    titles: Optional[Sequence[str]] = None,
    *,
    notes: Optional[Sequence[str]] = None,
    columns: int = 0,
    caption: Optional[str] = None,
) -> Array:
    """Composes uint8 pictures of 3 or 4 channels on one labelled sheet, row after row; columns 0: all in one row."""
    count = len(images)
    if not 1 <= count <= _abi.CONSTANTS["WEFT_SHEET_PANELS_MAX"]:
        raise ValueError(f"images: are {count}, and must be 1 to {_abi.CONSTANTS['WEFT_SHEET_PANELS_MAX']}")
    panels, kept = (_abi.WeftPanel * count)(), []
    for words, name in ((titles, "titles"), (notes, "notes")):
        if words is not None and (isinstance(words, str) or len(words) != count):
            raise ValueError(f"{name}: must be a text for each of {count} images")
    for k, image in enumerate(images):
        source, keep = given(image, f"images[{k}]")
        fill(panels[k], title=titles[k] if titles else None, note=notes[k] if notes else None)
        panels[k].image = ctypes.pointer(source)
        kept += [source, keep]
    desc = fill(
        _abi.WeftSheetDesc(), caption=caption, columns=integer(columns, "columns", 0, count) or count, count=count
    )
    desc.panels = panels
    out = _abi.WeftImage()
    call("weft_sheet_compose", ctypes.byref(desc), ctypes.byref(out))
    return taken(out)


__all__ = [
    "Difference",
    "diff",
    "difference_image",
    "heat_image",
    "read_channels",
    "read_image",
    "sheet",
    "to_linear",
    "tonemap",
    "write_image",
]
