"""Cloth shading models, measured and rendered: the library of weft over arrays.

>>> import weft
>>> lobe = weft.Lobe("charlie-neubelt", alpha=0.3)
>>> f = lobe.eval(wo, wi)                          # (n, 3), (n, 3) -> (n, 3), 1/sr, without the cosine
>>> picture = weft.render("builtin:cloth", spp=64, width=320, height=240)

Directions are unit vectors of shape (..., 3) in the shading frame, +z the normal, away from the surface; colours are linear
Rec. 709; lengths are metres. Arrays are NumPy's float32 where it is installed, else any buffer, and memoryviews come back.
A failure of the library is a weft.Error, an argument of the wrong type or shape a TypeError or ValueError, and a warning of
the library a weft.WeftWarning. What owns memory of the library is freed by close() or at the end of a `with`. Long calls
release Python's lock, take a function `progress`, and stop at Ctrl+C where they take one."""
from ._library import Error, Handle, WeftWarning
from ._records import Record
from .catalogue import (ChartEntry, aliases, builtins, catalogue_text, chart, isa, layers, preset_groups, preset_text, presets,
                        profiles, terms, use_isa, use_root, version, workflows)
from .doctors import Doctor, Finding, doctor, finding_kinds
from .exports import Export, export, export_targets
from .images import (Difference, diff, difference_image, heat_image, read_image, sheet, to_linear, tonemap, write_image)
from .lobes import Lobe, LobeInfo, ParamInfo, load_lobe, lobe_info, lobes
from .materials import InputInfo, Material, material_choices, material_inputs
from .measures import Data, Fit, Fitted, Match, Passport, distance, match, match_asset, passport
from .plots import PlotData, PlotPanel, plot, plot_data, plot_kinds, plot_report
from .reflections import Model, Reflection
from .scenes import (Camera, Light, Picked, Picker, Raster, RasterInfo, Render, RenderInfo, Scene, SceneInfo, raster, render)
from .tables import AlbedoForm, Audit, BakeKind, Ltc, LtcLobe, Table, audit, bake, bake_form, bake_kinds, table_axes, table_forms
from .weaves import Cloth, ClothInfo, Draft, DraftInfo, Thread, Yarn, parse_draft, weaves, yarns

__all__ = [
    "AlbedoForm", "Audit", "BakeKind", "Camera", "ChartEntry", "Cloth", "ClothInfo", "Data", "Difference", "Doctor", "Draft",
    "DraftInfo", "Error", "Export", "Finding", "Fit", "Fitted", "Handle", "InputInfo", "Light", "Lobe", "LobeInfo", "Ltc",
    "LtcLobe", "Match", "Material", "Model", "ParamInfo", "Passport", "Picked", "Picker", "PlotData", "PlotPanel", "Raster",
    "RasterInfo", "Record", "Reflection", "Render", "RenderInfo", "Scene", "SceneInfo", "Table", "Thread", "WeftWarning",
    "Yarn", "aliases", "audit", "bake", "bake_form", "bake_kinds", "builtins", "catalogue_text", "chart", "diff",
    "difference_image", "distance", "doctor", "export", "export_targets", "finding_kinds", "heat_image", "isa", "layers",
    "load_lobe", "lobe_info", "lobes", "match", "match_asset", "material_choices", "material_inputs", "parse_draft",
    "passport", "plot", "plot_data", "plot_kinds", "plot_report", "preset_groups", "preset_text", "presets",
    "profiles", "raster", "read_image", "render", "sheet", "table_axes", "table_forms", "terms", "to_linear", "tonemap",
    "use_isa", "use_root", "version", "weaves", "workflows", "write_image", "yarns",
]
