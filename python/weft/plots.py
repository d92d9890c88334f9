"""Figures of models: drawn, written, or as the numbers that they show."""
from __future__ import annotations

import ctypes
from contextlib import ExitStack
from typing import Any, Optional, Sequence, Union

from . import _abi
from ._arrays import Array, copied
from ._library import PathLike, call, fill, lib, names, path, triple
from ._records import Record, record
from .images import taken
from .lobes import Lobe
from .reflections import Model, Reflection, reflection


class PlotPanel(Record):
    """One panel: `form` ("curves", "rose", "map", "surface", "picture"), `title`, the axes `x`, `y`, `z` (`label`,
    `unit`, `low`, `high`, `logarithmic`), `series` of curves (`name`, `x`, `y`; NaN is a gap), `values` of a grid of
    shape (rows, columns) or (rows, columns, 3), and others of include/weft/plot.h."""


class PlotData(Record):
    """A figure in numbers: `title`, `panels`, `legend`, `note`."""


def plot_kinds() -> list[str]:
    """Returns the kinds of figures."""
    return names("weft_plot_kind_name")


class _Figure:
    """A description of a figure, and what it points to."""

    def __init__(
        self, kind: str, models: Any, labels: Optional[Sequence[str]], views: Sequence[float], members: Any
    ) -> None:
        given = list(models) if isinstance(models, (list, tuple)) else [models]
        if not 1 <= len(given) <= _abi.CONSTANTS["WEFT_PLOT_MODELS_MAX"]:
            raise ValueError(f"models: are {len(given)}, and must be 1 to {_abi.CONSTANTS['WEFT_PLOT_MODELS_MAX']}")
        if labels is not None and (isinstance(labels, str) or len(labels) != len(given)):
            raise ValueError(f"labels: must be a text for each of {len(given)} models")
        if len(views) > _abi.CONSTANTS["WEFT_PLOT_VIEWS_MAX"]:
            raise ValueError(f"views: are {len(views)}, and at most {_abi.CONSTANTS['WEFT_PLOT_VIEWS_MAX']}")
        self.reflections = [reflection(m) for m in given]
        self.rows = (_abi.WeftPlotModel * len(given))()
        self._keep: list[Any] = []
        for k, (row, one) in enumerate(zip(self.rows, self.reflections)):
            self._model(row, one)
            label = labels[k] if labels is not None else _label(given[k], one)
            fill(row, label=label)
        self.desc = fill(_abi.WeftPlotDesc(), kind=kind, view_count=len(views), **members)
        self.desc.views[: len(views)] = triple(views, "views", len(views))
        self.desc.models, self.desc.count = self.rows, len(given)

    def _model(self, row: Any, one: Reflection) -> None:
        model = one.model
        if isinstance(model, Lobe):
            self._keep.append(_abi.WeftLobe.from_buffer_copy(model._lobe))
            row.lobe = ctypes.pointer(self._keep[-1])
        elif model is not None and model.cloth is None:
            self._keep.append(_abi.WeftMaterial.from_buffer_copy(model._material))
            row.material = ctypes.pointer(self._keep[-1])

    def call(self, name: str, *arguments: Any) -> None:
        """Makes a call with the figure, while its reflections are held."""

        with ExitStack() as stack:
            for row, one in zip(self.rows, self.reflections):
                row.reflection = stack.enter_context(one._use())
            call(name, ctypes.byref(self.desc), *arguments)


def _label(given: Any, one: Reflection) -> Optional[str]:
    if isinstance(given, str):
        return given
    return one.model.id if isinstance(one.model, Lobe) else None


def _members(
    logarithmic: bool, quick: bool, cosine: bool, channel: str, title: Optional[str], width: int, height: int
) -> dict[str, Any]:
    return dict(
        logarithmic=int(bool(logarithmic)),
        quick=int(bool(quick)),
        cosine=int(bool(cosine)),
        channel=channel,
        title=title,
        width=width,
        height=height,
    )


def plot(
    kind: str,
    models: Union[Model, Sequence[Model]],
    file: Optional[PathLike] = None,
    *,
    labels: Optional[Sequence[str]] = None,
    views: Sequence[float] = (),
    logarithmic: bool = False,
    quick: bool = False,
    cosine: bool = False,
    channel: str = "luminance",
    title: Optional[str] = None,
    width: int = 0,
    height: int = 0,
) -> Optional[Array]:
    """Draws a figure of one to eight models: an array of uint8, shape (height, width, 3); with file, written by suffix
    (.png, .svg, .pdf) instead.

    kind: a name of plot_kinds(), such as "polar", "albedo" or "sphere"; views: theta_o in degrees; channel:
    "luminance", "red", "green", "blue"; quick: fewer values."""
    figure = _Figure(kind, models, labels, views, _members(logarithmic, quick, cosine, channel, title, width, height))
    if file is not None:
        figure.call("weft_plot_write", path(file, "file"))
        return None
    image = _abi.WeftImage()
    figure.call("weft_plot_image", ctypes.byref(image))
    return taken(image)


def plot_report(
    models: Union[Model, Sequence[Model]],
    file: PathLike,
    *,
    labels: Optional[Sequence[str]] = None,
    quick: bool = False,
) -> None:
    """Writes a page of HTML with every kind of figure."""
    figure = _Figure("polar", models, labels, (), dict(quick=int(bool(quick))))
    figure.call("weft_plot_report", path(file, "file"))


def plot_data(
    kind: str,
    models: Union[Model, Sequence[Model]],
    *,
    labels: Optional[Sequence[str]] = None,
    views: Sequence[float] = (),
    logarithmic: bool = False,
    quick: bool = False,
    cosine: bool = False,
    channel: str = "luminance",
) -> PlotData:
    """Returns the numbers that a figure shows; arguments are those of plot."""
    figure = _Figure(kind, models, labels, views, _members(logarithmic, quick, cosine, channel, None, 0, 0))
    data = _abi.WeftPlotData()
    figure.call("weft_plot_data", ctypes.byref(data))
    try:
        legend = [row.value.decode("utf-8", "replace") for row in data.legend[: data.legend_count]]
        panels = [_panel(data.panels[k], legend) for k in range(data.count)]
        return PlotData(
            title=data.title.decode("utf-8", "replace"),
            columns=data.columns,
            panels=panels,
            legend=legend,
            note=data.note.decode("utf-8", "replace"),
        )
    finally:
        lib.weft_plot_data_free(ctypes.byref(data))


def _panel(source: Any, legend: list[str]) -> PlotPanel:
    series = []
    for k in range(source.series_count):
        one = source.series[k]
        name = legend[one.entry] if 0 <= one.entry < len(legend) else ""
        series.append(Record(name=name, x=copied(one.x, "f", (one.count,)), y=copied(one.y, "f", (one.count,))))
    values = None
    if source.values:
        shape = (source.rows, source.columns) + ((source.channels,) if source.channels > 1 else ())
        values = copied(source.values, "f", shape)
    panel: PlotPanel = record(
        source,
        PlotPanel,
        leave=("series_count", "figure_count", "mark_count", "cell_count"),
        series=series,
        values=values,
    )
    panel.__dict__["figures"] = [record(f) for f in source.figures[: source.figure_count]]
    panel.__dict__["marks"] = [record(m) for m in source.marks[: source.mark_count]]
    panel.__dict__["cells"] = [c.value.decode("utf-8", "replace") for c in source.cells[: source.cell_count]]
    return panel


__all__ = ["PlotData", "PlotPanel", "plot", "plot_data", "plot_kinds", "plot_report"]
