"""Records, enumerations and calls of libweft, as ctypes needs them. Made by script/bindings of include/weft/."""
# flake8: noqa
# mypy: ignore-errors
from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int,
                    c_longlong, c_size_t, c_uint, c_uint32, c_uint64, c_void_p)

VERSION = "0.1.0"
ABI = 0

WeftProgress = CFUNCTYPE(c_int, c_void_p, c_double)


class WeftError(Structure):
    _fields_ = [
        ("result", c_int),
        ("message", c_int),
        ("text", (c_char * 512)),
    ]


class WeftLog(Structure):
    _fields_ = [
        ("fn", CFUNCTYPE(None, c_void_p, c_int, c_char_p)),
        ("user", c_void_p),
    ]


class WeftParamInfo(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("def", c_float),
        ("low", c_float),
        ("high", c_float),
        ("hard_low", c_float),
        ("hard_high", c_float),
        ("choices", POINTER(c_char_p)),
    ]


class WeftLobeInfo(Structure):
    _fields_ = [
        ("id", c_char_p),
        ("traits", c_uint),
        ("param_count", c_int),
        ("params", POINTER(WeftParamInfo)),
    ]


class WeftLobe(Structure):
    _fields_ = [
        ("lobe", c_int),
        ("params", (c_float * 8)),
        ("f0", (c_float * 3)),
        ("f90", (c_float * 3)),
    ]


class WeftDirections(Structure):
    _fields_ = [
        ("x", c_void_p),
        ("y", c_void_p),
        ("z", c_void_p),
    ]


class WeftColors(Structure):
    _fields_ = [
        ("r", c_void_p),
        ("g", c_void_p),
        ("b", c_void_p),
    ]


class WeftLobes(Structure):
    _fields_ = [
        ("lobe", WeftLobe),
        ("params", (c_void_p * 8)),
        ("f0", (c_void_p * 3)),
        ("f90", (c_void_p * 3)),
    ]


class WeftImage(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("channels", c_int),
        ("type", c_int),
        ("pixels", c_void_p),
    ]


class WeftImageLayer(Structure):
    _fields_ = [
        ("image", POINTER(WeftImage)),
        ("channels", (c_char_p * 4)),
    ]


class WeftImageText(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("text", c_char_p),
    ]


class WeftImageWriting(Structure):
    _fields_ = [
        ("data", c_int),
        ("single", c_int),
        ("comment", c_char_p),
        ("denoised", c_char_p),
        ("layers", POINTER(WeftImageLayer)),
        ("layer_count", c_int),
        ("texts", POINTER(WeftImageText)),
        ("text_count", c_int),
        ("levels", POINTER(WeftImage)),
        ("level_count", c_int),
        ("isa", c_char_p),
    ]


class WeftTone(Structure):
    _fields_ = [
        ("curve", c_int),
        ("exposure", c_float),
        ("white", (c_float * 2)),
    ]


class WeftTableForm(Structure):
    _fields_ = [
        ("transposed", c_int),
        ("root", c_int),
        ("alpha", c_int),
        ("edges", c_int),
        ("flip_x", c_int),
        ("flip_y", c_int),
        ("total", c_int),
    ]


class WeftBakeKind(Structure):
    _fields_ = [
        ("id", c_char_p),
        ("help", c_char_p),
        ("lobe", c_int),
        ("formed", c_int),
        ("width", c_int),
        ("height", c_int),
    ]


class WeftBakeDesc(Structure):
    _fields_ = [
        ("kind", c_char_p),
        ("lobe", POINTER(WeftLobe)),
        ("width", c_int),
        ("height", c_int),
        ("form", WeftTableForm),
        ("tolerance", c_double),
        ("threads", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
        ("log", POINTER(WeftLog)),
    ]


class WeftBakeInfo(Structure):
    _fields_ = [
        ("words", (c_char * 160)),
        ("channels", (c_char * 80)),
        ("error", c_double),
        ("unmet", c_longlong),
        ("beyond", c_longlong),
        ("low", c_float),
        ("high", c_float),
    ]


class WeftFibreModelDesc(Structure):
    _fields_ = [
        ("rounds", c_int),
        ("threads", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftAuditDesc(Structure):
    _fields_ = [
        ("image", POINTER(WeftImage)),
        ("channel", c_int),
        ("lobe", POINTER(WeftLobe)),
        ("form", POINTER(WeftTableForm)),
        ("scale", c_double),
        ("most", c_double),
        ("tolerance", c_double),
        ("threads", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftTablePlace(Structure):
    _fields_ = [
        ("x", c_int),
        ("y", c_int),
        ("cos_o", c_float),
        ("value", c_float),
        ("table", c_float),
        ("albedo", c_float),
    ]


class WeftAudit_found(Structure):
    _fields_ = [
        ("fault", c_int),
        ("text", (c_char * 320)),
    ]


class WeftAudit(Structure):
    _fields_ = [
        ("form", WeftTableForm),
        ("fits", c_int),
        ("part", c_int),
        ("texels", c_longlong),
        ("left_out", c_longlong),
        ("largest", c_double),
        ("place", WeftTablePlace),
        ("rms", c_double),
        ("mean", c_double),
        ("beyond", c_double),
        ("together", c_double),
        ("step", c_double),
        ("error", c_double),
        ("faults", c_int),
        ("found", (WeftAudit_found * 6)),
        ("other", c_int),
        ("lobe", c_int),
    ]


class WeftAlbedoForm(Structure):
    _fields_ = [
        ("exponential", c_int),
        ("root", c_int),
        ("across", c_int),
        ("along", c_int),
        ("terms", (c_float * 49)),
        ("error", c_double),
        ("cos_o", c_float),
        ("roughness", c_float),
    ]


class WeftAlbedoFormDesc(Structure):
    _fields_ = [
        ("lobe", POINTER(WeftLobe)),
        ("part", c_int),
        ("error", c_double),
        ("lowest", c_double),
        ("threads", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftChartEntry(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("source", c_char_p),
        ("kind", c_int),
        ("base_color", (c_float * 3)),
        ("f0", (c_float * 3)),
        ("ior", c_float),
    ]


class WeftLoss(Structure):
    _fields_ = [
        ("material", c_int),
        ("name", (c_char * 64)),
        ("what", (c_char * 64)),
        ("why", (c_char * 256)),
    ]


class WeftLosses(Structure):
    _fields_ = [
        ("items", POINTER(WeftLoss)),
        ("count", c_int),
    ]


class WeftMoment(Structure):
    _fields_ = [
        ("animation", c_char_p),
        ("time", c_double),
    ]


class WeftSceneInfo(Structure):
    _fields_ = [
        ("mesh_count", c_int),
        ("material_count", c_int),
        ("light_count", c_int),
        ("camera_count", c_int),
        ("variant_count", c_int),
        ("image_count", c_int),
        ("triangle_count", c_longlong),
        ("low", (c_float * 3)),
        ("high", (c_float * 3)),
    ]


class WeftLight(Structure):
    _fields_ = [
        ("kind", c_int),
        ("position", (c_float * 3)),
        ("direction", (c_float * 3)),
        ("color", (c_float * 3)),
        ("range", c_float),
        ("inner", c_float),
        ("outer", c_float),
        ("size", (c_float * 2)),
        ("corners", c_int),
        ("roll", c_float),
    ]


class WeftCamera(Structure):
    _fields_ = [
        ("eye", (c_float * 3)),
        ("target", (c_float * 3)),
        ("up", (c_float * 3)),
        ("fov", c_float),
    ]


class WeftThread(Structure):
    _fields_ = [
        ("color", (c_float * 3)),
        ("spacing", c_float),
        ("thickness", c_float),
    ]


class WeftDraftInfo(Structure):
    _fields_ = [
        ("title", (c_char * 128)),
        ("count", (c_int * 2)),
        ("shafts", c_int),
        ("treadles", c_int),
        ("size", (c_float * 2)),
        ("warp_share", c_float),
        ("longest_float", (c_int * 2)),
        ("endless", (c_int * 2)),
    ]


class WeftYarn(Structure):
    _fields_ = [
        ("alpha", c_float),
        ("crimp", c_float),
        ("roundness", c_float),
        ("twist", c_float),
        ("white", c_float),
        ("width", c_float),
        ("bulge", c_float),
        ("floats", c_float),
        ("streaks", c_float),
        ("dye", c_float),
        ("slub", c_float),
        ("wander", c_float),
        ("hairiness", c_float),
        ("slub_length", c_float),
        ("barre", c_float),
        ("barre_width", c_float),
        ("uneven", c_float),
        ("uneven_size", c_float),
        ("core", c_float),
    ]


class WeftYarnNumber(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("offset", c_size_t),
        ("low", c_float),
        ("high", c_float),
        ("angle", c_int),
    ]


class WeftClothInfo(Structure):
    _fields_ = [
        ("share", (c_float * 2)),
        ("size", (c_float * 2)),
        ("sett", (c_float * 2)),
        ("metres", c_float),
        ("automatic", c_int),
        ("rotation", c_float),
        ("relief", c_float),
        ("seed", c_int),
    ]


class WeftInputInfo(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("kind", c_int),
        ("initial", c_float),
        ("low", c_float),
        ("high", c_float),
        ("hard_low", c_float),
        ("hard_high", c_float),
    ]


class WeftInput(Structure):
    _fields_ = [
        ("value", (c_float * 3)),
        ("texture", c_int),
        ("texcoord", c_int),
        ("channel", c_int),
        ("given", c_int),
        ("transform", (c_float * 6)),
    ]


class WeftMaterial(Structure):
    _fields_ = [
        ("alpha_mode", c_int),
        ("alpha_cutoff", c_float),
        ("double_sided", c_int),
        ("unlit", c_int),
        ("cloth", c_int),
        ("measured", c_int),
        ("hair", (c_float * 3)),
        ("choices", (c_int * 16)),
        ("inputs", (WeftInput * 64)),
    ]


class WeftBsdfDesc(Structure):
    _fields_ = [
        ("thetas", c_int),
        ("phis", c_int),
        ("side", c_int),
        ("comment", c_char_p),
        ("threads", c_int),
    ]


class WeftMatch(Structure):
    _fields_ = [
        ("copied", c_double),
        ("matched", c_double),
        ("evaluations", c_longlong),
    ]


class WeftMatchJob(Structure):
    _fields_ = [
        ("from", c_void_p),
        ("is_lobe", c_int),
        ("hold", c_uint),
        ("held", c_void_p),
        ("lobe", WeftLobe),
        ("material", WeftMaterial),
        ("found", WeftMatch),
        ("result", c_int),
    ]


class WeftAssetMatch(Structure):
    _fields_ = [
        ("name", (c_char * 64)),
        ("changed", c_int),
        ("clipped", c_int),
        ("search", c_int),
        ("maps", c_uint64),
        ("found", WeftMatch),
        ("copied", WeftMaterial),
        ("matched", WeftMaterial),
    ]


class WeftBaking(Structure):
    _fields_ = [
        ("pixels", c_int),
        ("metres", c_double),
        ("profile", c_char_p),
        ("levels", c_int),
        ("one_face", c_int),
        ("losses", POINTER(WeftLosses)),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftBaked(Structure):
    _fields_ = [
        ("copied", c_double),
        ("fitted", c_double),
        ("sky", c_double),
        ("contrast", c_double),
        ("levels", c_double),
    ]


class WeftTarget(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("profile", c_char_p),
        ("levels", c_int),
        ("fit", c_char_p),
    ]


class WeftDelivered(Structure):
    _fields_ = [
        ("name", (c_char * 64)),
        ("found", WeftMatch),
        ("even_sky", c_double),
    ]


class WeftDelivery(Structure):
    _fields_ = [
        ("materials", POINTER(WeftDelivered)),
        ("material_count", c_int),
        ("extensions", c_void_p),
        ("losses", WeftLosses),
    ]


class WeftDiffDesc(Structure):
    _fields_ = [
        ("image", POINTER(WeftImage)),
        ("reference", POINTER(WeftImage)),
        ("metric", c_int),
        ("pixels_per_degree", c_float),
        ("tonemap", c_int),
        ("exposure", c_float),
        ("exposed", c_int),
        ("threads", c_int),
    ]


class WeftDiff(Structure):
    _fields_ = [
        ("value", c_double),
        ("worst", c_float),
        ("worst_x", c_int),
        ("worst_y", c_int),
        ("high", c_float),
        ("exposures", c_int),
        ("exposure_low", c_float),
        ("exposure_high", c_float),
    ]


class WeftFinding(Structure):
    _fields_ = [
        ("kind", c_int),
        ("severity", c_int),
        ("of", c_int),
        ("index", c_int),
        ("subject", (c_char * 96)),
        ("engines", c_uint),
        ("words", (c_char * 400)),
        ("fix", (c_char * 280)),
        ("fixable", c_int),
        ("figure", c_double),
        ("place", (c_char * 160)),
    ]


class WeftDoctorInfo(Structure):
    _fields_ = [
        ("material_count", c_int),
        ("mesh_count", c_int),
        ("image_count", c_int),
        ("sheen_count", c_int),
    ]


class WeftExportDesc(Structure):
    _fields_ = [
        ("lobe", POINTER(WeftLobe)),
        ("right", POINTER(WeftLobe)),
        ("profile", c_char_p),
        ("material", POINTER(WeftMaterial)),
        ("name", c_char_p),
        ("target", c_int),
        ("lut", c_int),
        ("albedo", c_int),
        ("fold_pi", c_int),
        ("prefix", c_char_p),
        ("call", c_char_p),
        ("ambient", c_int),
        ("cloth", c_void_p),
    ]


class WeftExportTable(Structure):
    _fields_ = [
        ("name", (c_char * 96)),
        ("texels", WeftImage),
        ("scale", c_float),
        ("offset", c_float),
    ]


class WeftExport(Structure):
    _fields_ = [
        ("text", c_void_p),
        ("size", c_size_t),
        ("tables", (WeftExportTable * 32)),
        ("table_count", c_int),
    ]


class WeftDataLobe(Structure):
    _fields_ = [
        ("error", c_double),
        ("f0", (c_float * 3)),
        ("f90", (c_float * 3)),
    ]


class WeftFitted(Structure):
    _fields_ = [
        ("lobe", WeftLobe),
        ("base", WeftLobe),
        ("numbers", c_int),
        ("error", c_double),
        ("free_error", c_double),
        ("albedo", c_float),
        ("evaluations", c_longlong),
    ]


class WeftFit(Structure):
    _fields_ = [
        ("count", c_int),
        ("fitted", (WeftFitted * 768)),
        ("baseline", WeftFitted),
        ("base_alone", c_double),
    ]


class WeftFitDesc(Structure):
    _fields_ = [
        ("metric", c_int),
        ("chosen", c_int),
        ("base", c_char_p),
        ("only", c_char_p),
        ("free", c_int),
        ("expressible", c_int),
        ("threads", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftFloor(Structure):
    _fields_ = [
        ("on", c_int),
        ("reflection", c_float),
        ("roughness", c_float),
    ]


class WeftRenderDesc(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("crop", (c_int * 4)),
        ("max_depth", c_int),
        ("seed", c_uint32),
        ("threads", c_int),
        ("camera", c_char_p),
        ("background", c_int),
        ("background_color", (c_float * 3)),
        ("sampling", c_int),
        ("pixel_centre", c_int),
        ("no_roulette", c_int),
        ("no_shadows", c_int),
        ("floor", WeftFloor),
        ("hide_lights", c_int),
        ("halves", c_int),
        ("first_hits", c_int),
        ("places", c_int),
        ("mattes", c_int),
        ("slots", c_int),
        ("noise", c_float),
        ("stages", c_int),
        ("no_lift", c_int),
    ]


class WeftRenderInfo(Structure):
    _fields_ = [
        ("samples_per_pixel", c_double),
        ("rays", c_longlong),
        ("non_finite", c_longlong),
        ("build_seconds", c_double),
        ("render_seconds", c_double),
        ("camera_eye", (c_float * 3)),
        ("camera_target", (c_float * 3)),
        ("camera_fov", c_float),
    ]


class WeftRenderStage(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("seconds", c_double),
        ("embree", c_int),
    ]


class WeftRenderLayers(Structure):
    _fields_ = [
        ("layers", POINTER(WeftImageLayer)),
        ("layer_count", c_int),
        ("texts", POINTER(WeftImageText)),
        ("text_count", c_int),
    ]


class WeftJudgeDesc(Structure):
    _fields_ = [
        ("render", WeftRenderDesc),
        ("spp", c_int),
        ("tolerance", c_double),
        ("spread", c_double),
        ("explained", c_double),
    ]


class WeftJudgeInfo(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("object_count", c_int),
        ("left_out", c_int),
        ("spp", c_int),
        ("desc", WeftJudgeDesc),
        ("camera_eye", (c_float * 3)),
        ("camera_target", (c_float * 3)),
        ("camera_fov", c_float),
    ]


class WeftJudgeObject(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("material", c_char_p),
        ("mesh", c_int),
        ("material_index", c_int),
        ("pixels", c_int),
        ("x", c_float),
        ("y", c_float),
        ("value", (c_float * 3)),
        ("noise", (c_float * 3)),
    ]


class WeftCause(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("help", c_char_p),
        ("kind", c_int),
    ]


class WeftJudgePicture(Structure):
    _fields_ = [
        ("image", POINTER(WeftImage)),
        ("tone", WeftTone),
        ("linear_integers", c_int),
    ]


class WeftCauseShare(Structure):
    _fields_ = [
        ("cause", c_int),
        ("share", c_double),
    ]


class WeftVerdictObject(Structure):
    _fields_ = [
        ("value", (c_float * 3)),
        ("expected", (c_float * 3)),
        ("off", (c_float * 3)),
        ("spread", c_double),
        ("failed", c_int),
        ("cause", WeftCauseShare),
    ]


class WeftVerdict(Structure):
    _fields_ = [
        ("objects", POINTER(WeftVerdictObject)),
        ("object_count", c_int),
        ("failed", c_int),
        ("causes", POINTER(WeftCauseShare)),
        ("cause_count", c_int),
        ("explained", c_int),
    ]


class WeftLtcDesc(Structure):
    _fields_ = [
        ("rows", c_int),
        ("columns", c_int),
        ("low", c_float),
        ("high", c_float),
        ("f0", c_float),
        ("f90", c_float),
        ("norm", c_int),
        ("level", c_int),
        ("threads", c_int),
        ("no_cache", c_int),
        ("progress", CFUNCTYPE(c_int, c_void_p, c_double)),
        ("user", c_void_p),
    ]


class WeftLtcInfo(Structure):
    _fields_ = [
        ("rows", c_int),
        ("columns", c_int),
        ("low", c_float),
        ("high", c_float),
        ("cached", c_int),
        ("seconds", c_double),
        ("mean_error", c_float),
        ("worst_error", c_float),
        ("worst_cos_o", c_float),
        ("worst_value", c_float),
    ]


class WeftLtcLobe(Structure):
    _fields_ = [
        ("z", c_float),
        ("q", c_float),
        ("b", c_float),
        ("r", c_float),
        ("amplitude", c_float),
        ("amplitude_f90", c_float),
    ]


class WeftPlace(Structure):
    _fields_ = [
        ("value", c_float),
        ("cos_o", c_float),
        ("cos_i", c_float),
        ("phi", c_float),
    ]


class WeftPassport(Structure):
    _fields_ = [
        ("id", (c_char * 64)),
        ("profile", c_int),
        ("woven", c_int),
        ("traits", c_uint),
        ("parameter", (c_char * 64)),
        ("surface", (c_char * 256)),
        ("rows", c_int),
        ("row_default", c_int),
        ("values", (c_float * 11)),
        ("cosines", (c_float * 21)),
        ("albedo", ((c_float * 21) * 11)),
        ("albedo_most", c_float),
        ("albedo_place", WeftPlace),
        ("albedo_above", c_int),
        ("albedo_half", ((c_float * 21) * 11)),
        ("reciprocity", c_float),
        ("reciprocity_place", WeftPlace),
        ("views", (c_float * 5)),
        ("layers", c_int),
        ("sheens", (c_float * 3)),
        ("furnace", (((c_float * 5) * 3) * 16)),
        ("furnace_noise", (((c_float * 5) * 3) * 16)),
        ("furnace_most", c_float),
        ("pdf_most", c_float),
        ("pdf_place", WeftPlace),
        ("tests", c_int),
        ("p", c_double),
        ("p_place", WeftPlace),
        ("stray", c_int),
        ("missed", c_float),
        ("missed_place", WeftPlace),
        ("variance", ((c_float * 5) * 11)),
        ("variance_cosine", ((c_float * 5) * 11)),
        ("variance_ratio", c_float),
        ("variance_worst", c_float),
        ("variance_value", c_float),
        ("sweep_count", c_longlong),
        ("sweep_infinite", c_longlong),
        ("sweep_negative", c_longlong),
        ("sweep_below", c_longlong),
        ("half_measured", c_int),
        ("half_count", c_longlong),
        ("half_bad", c_longlong),
        ("half_floor", (c_int * 11)),
        ("half_place", WeftPlace),
        ("half_parameter", c_float),
        ("half_whole", c_int),
        ("half_cosine", c_int),
        ("half_zero", (c_float * 11)),
        ("half_off", (c_float * 11)),
        ("parity_measured", c_int),
        ("parity_worst", c_float),
        ("parity_beyond", c_float),
        ("parity_words", (c_char * 160)),
    ]


class WeftPassportDesc(Structure):
    _fields_ = [
        ("id", c_char_p),
        ("lobe", POINTER(WeftLobe)),
        ("material", POINTER(WeftMaterial)),
        ("cloth", c_void_p),
        ("threads", c_int),
        ("quick", c_int),
        ("no_gpu", c_int),
        ("brief", c_int),
    ]


class WeftPicked(Structure):
    _fields_ = [
        ("mesh", c_int),
        ("material", c_int),
        ("position", (c_float * 3)),
        ("normal", (c_float * 3)),
        ("tangent", (c_float * 3)),
        ("bitangent", (c_float * 3)),
        ("texcoord", ((c_float * 2) * 2)),
        ("distance", c_float),
        ("uv_per_metre", c_float),
    ]


class WeftPlotModel(Structure):
    _fields_ = [
        ("reflection", c_void_p),
        ("lobe", POINTER(WeftLobe)),
        ("material", POINTER(WeftMaterial)),
        ("label", c_char_p),
    ]


class WeftPlotDesc(Structure):
    _fields_ = [
        ("kind", c_int),
        ("models", POINTER(WeftPlotModel)),
        ("count", c_int),
        ("views", (c_float * 6)),
        ("view_count", c_int),
        ("logarithmic", c_int),
        ("quick", c_int),
        ("cosine", c_int),
        ("channel", c_int),
        ("title", c_char_p),
        ("width", c_int),
        ("height", c_int),
        ("environment", POINTER(WeftImage)),
    ]


class WeftPlotAxis(Structure):
    _fields_ = [
        ("label", (c_char * 64)),
        ("unit", (c_char * 16)),
        ("low", c_float),
        ("high", c_float),
        ("logarithmic", c_int),
    ]


class WeftPlotSeries(Structure):
    _fields_ = [
        ("entry", c_int),
        ("count", c_int),
        ("x", c_void_p),
        ("y", c_void_p),
    ]


class WeftPlotFigure(Structure):
    _fields_ = [
        ("name", (c_char * 48)),
        ("unit", (c_char * 16)),
        ("value", c_double),
    ]


class WeftPlotMark(Structure):
    _fields_ = [
        ("label", (c_char * 16)),
        ("x", c_float),
    ]


class WeftPlotPanel(Structure):
    _fields_ = [
        ("form", c_int),
        ("title", (c_char * 192)),
        ("x", WeftPlotAxis),
        ("y", WeftPlotAxis),
        ("z", WeftPlotAxis),
        ("series_count", c_int),
        ("series", POINTER(WeftPlotSeries)),
        ("columns", c_int),
        ("rows", c_int),
        ("channels", c_int),
        ("values", c_void_p),
        ("colored", c_int),
        ("exposure", c_float),
        ("center", c_float),
        ("view", c_float),
        ("entry", c_int),
        ("figure_count", c_int),
        ("mark_count", c_int),
        ("figures", (WeftPlotFigure * 8)),
        ("marks", (WeftPlotMark * 4)),
        ("cell_count", c_int),
        ("cells", ((c_char * 32) * 12)),
    ]


class WeftPlotData(Structure):
    _fields_ = [
        ("title", (c_char * 192)),
        ("columns", c_int),
        ("count", c_int),
        ("panels", POINTER(WeftPlotPanel)),
        ("legend_count", c_int),
        ("legend", ((c_char * 128) * 24)),
        ("note", (c_char * 256)),
        ("owned", c_void_p),
    ]


class WeftRasterDesc(Structure):
    _fields_ = [
        ("gl", c_int),
        ("adopt", c_int),
        ("shader_dir", c_char_p),
        ("threads", c_int),
        ("occlusion", c_int),
        ("no_cache", c_int),
        ("progress", WeftProgress),
        ("user", c_void_p),
    ]


class WeftRasterView(Structure):
    _fields_ = [
        ("width", c_int),
        ("height", c_int),
        ("samples", c_int),
        ("camera", c_char_p),
        ("background", c_int),
        ("background_color", (c_float * 3)),
        ("ambient", c_int),
        ("polygons", c_int),
        ("no_shadows", c_int),
        ("part", c_int),
        ("crop", (c_int * 4)),
        ("plain_textures", c_int),
        ("floor", WeftFloor),
        ("hide_lights", c_int),
        ("bounces", c_int),
        ("shading_rate", c_int),
    ]


class WeftRasterShow(Structure):
    _fields_ = [
        ("framebuffer", c_uint),
        ("x", c_int),
        ("y", c_int),
        ("width", c_int),
        ("height", c_int),
        ("clip", (c_int * 4)),
        ("background", (c_float * 3)),
        ("tonemap", c_int),
        ("exposure", c_float),
        ("white", (c_float * 2)),
    ]


class WeftRasterInfo(Structure):
    _fields_ = [
        ("driver", c_char_p),
        ("programs", c_int),
        ("compiled", c_int),
        ("samplers", c_int),
        ("samples", c_int),
        ("compile_seconds", c_double),
        ("making", c_int),
        ("made", c_int),
        ("camera_eye", (c_float * 3)),
        ("camera_target", (c_float * 3)),
        ("camera_fov", c_float),
        ("complaint", (c_char * 512)),
    ]


class WeftTextile(Structure):
    _fields_ = [
        ("draft", c_void_p),
        ("yarns", (c_char_p * 2)),
        ("metres", c_double),
    ]


class WeftPanel(Structure):
    _fields_ = [
        ("image", POINTER(WeftImage)),
        ("title", c_char_p),
        ("note", c_char_p),
        ("scale", c_float),
        ("none", c_float),
        ("most", c_float),
    ]


class WeftSheetDesc(Structure):
    _fields_ = [
        ("caption", c_char_p),
        ("panels", POINTER(WeftPanel)),
        ("count", c_int),
        ("columns", c_int),
    ]


class WeftDifference(Structure):
    _fields_ = [
        ("mean", c_double),
        ("relmse", c_double),
        ("high", c_float),
    ]


CONSTANTS = {
    "WEFT_LOBE_PARAMS_MAX": 8,
    "WEFT_LOBE_RECIPROCAL": 1,
    "WEFT_LOBE_CONSERVES": 2,
    "WEFT_LOBE_LOSSLESS": 4,
    "WEFT_LOBE_TWO_COLORS": 8,
    "WEFT_LOBE_ANISOTROPIC": 16,
    "WEFT_LOBE_REFERENCE": 32,
    "WEFT_LOBE_DIFFUSE": 64,
    "WEFT_LOBE_TABLE": 128,
    "WEFT_LOBE_TINTED": 256,
    "WEFT_LOBE_SYSTEM": 512,
    "WEFT_IMAGE_LAYERS": 32,
    "WEFT_THREADS_MAX": 256,
    "WEFT_TABLE_FORM_TEXT": 80,
    "WEFT_BAKE_TEXELS_MAX": 16777216,
    "WEFT_AUDIT_FINDINGS": 6,
    "WEFT_AUDIT_TEXT": 320,
    "WEFT_FORM_TERMS": 49,
    "WEFT_DRAFT_SIDE_MAX": 8192,
    "WEFT_DRAFT_CELLS_MAX": 16777216,
    "WEFT_INPUTS_MAX": 64,
    "WEFT_CHOICES_MAX": 16,
    "WEFT_HAIR_LENGTH": 0,
    "WEFT_HAIR_DENSITY": 1,
    "WEFT_HAIR_THICKNESS": 2,
    "WEFT_HAIR_NUMBERS": 3,
    "WEFT_HOLD_COLOR": 256,
    "WEFT_HOLD_COLOR_2": 512,
    "WEFT_EXPORT_MODELS_MAX": 16,
    "WEFT_EXPORT_TABLES_MAX": 32,
    "WEFT_EXPORT_NAME": 96,
    "WEFT_FITTED_NOTHING": 1,
    "WEFT_FITTED_BRIGHT": 2,
    "WEFT_FITTED_EDGE": 4,
    "WEFT_FITTED_GAINS": 8,
    "WEFT_FITTED_MOST": 768,
    "WEFT_FITTED_BASES": 16,
    "WEFT_HALVES_INDEPENDENT": 1,
    "WEFT_HALVES_SHARED": 2,
    "WEFT_CAMERA_TEXT": 256,
    "WEFT_CHANGED_MATERIALS": 1,
    "WEFT_CHANGED_LIGHTS": 2,
    "WEFT_CHANGED_SHAPES": 4,
    "WEFT_RENDER_TILE": 16,
    "WEFT_RENDER_BLOCK": 16,
    "WEFT_RENDER_TILE_HEAD": 3,
    "WEFT_RENDER_NUMBERS": 104,
    "WEFT_JUDGE_MARGIN": 2,
    "WEFT_JUDGE_CELL": 4,
    "WEFT_JUDGE_PIXELS_LEAST": 16,
    "WEFT_PASSPORT_ROWS": 11,
    "WEFT_PASSPORT_COSINES": 21,
    "WEFT_PASSPORT_VIEWS": 5,
    "WEFT_PASSPORT_LAYERS": 16,
    "WEFT_PASSPORT_SHEENS": 3,
    "WEFT_HALF_FREE": 25,
    "WEFT_HALF_MOST": 7,
    "WEFT_PLOT_MODELS_MAX": 8,
    "WEFT_PLOT_VIEWS_MAX": 6,
    "WEFT_PLOT_SIDE_MAX": 8192,
    "WEFT_PLOT_FIGURES_MAX": 8,
    "WEFT_PLOT_MARKS_MAX": 4,
    "WEFT_PLOT_LEGEND_MAX": 24,
    "WEFT_RASTER_POLYGONS": 8,
    "WEFT_RASTER_FRAMES_MOST": 1048576,
    "WEFT_SHEET_PANELS_MAX": 256,
}

# The names of an enumeration's members, and the members of records that hold one.
ENUMS = {
    "WeftResult": {
        "ok": 0,
        "failed": 1,
        "usage": 2,
        "input": 3,
        "resources": 4,
        "interrupted": 130,
    },
    "WeftMessage": {
        "none": 0,
        "memory": 1,
        "file-open": 2,
        "file-read": 3,
        "file-large": 4,
        "file-write": 5,
        "output-suffix": 6,
        "image-format": 7,
        "image-size": 8,
        "cubemap": 9,
        "image-damaged": 10,
        "image-unsupported": 11,
        "image-repaired": 12,
        "gltf-json": 13,
        "gltf-container": 14,
        "gltf-version": 15,
        "gltf-schema": 16,
        "gltf-reference": 17,
        "gltf-bounds": 18,
        "gltf-uri": 19,
        "gltf-extension": 20,
        "gltf-cycle": 21,
        "gltf-parents": 22,
        "gltf-too-large": 23,
        "gltf-decode": 24,
        "gltf-warn-extension": 25,
        "gltf-warn-ignored": 26,
        "gltf-warn-rest-pose": 27,
        "gltf-warn-repaired": 28,
        "scene-name": 29,
        "scene-empty": 30,
        "scene-kind": 31,
        "camera-name": 32,
        "variant-name": 33,
        "material-name": 34,
        "preset-name": 35,
        "material-file": 36,
        "param-name": 37,
        "param-value": 38,
        "param-range": 39,
        "param-fitted": 40,
        "plausible": 41,
        "lobe-name": 42,
        "export-lobe": 43,
        "ltc-lobe": 44,
        "cache-ignored": 45,
        "layer-name": 46,
        "check-name": 47,
        "measured": 48,
        "bsdf": 49,
        "utia": 50,
        "brdf-table": 51,
        "bake-kind": 52,
        "table-form": 53,
        "desc": 54,
        "render-device": 55,
        "text-name": 56,
        "text-dialect": 57,
        "textures-scaled": 58,
        "gl-context": 59,
        "gl-compile": 60,
        "gl-memory": 61,
        "draft": 62,
        "draft-notation": 63,
        "draft-completed": 64,
        "lobe-file": 65,
        "lobe-compile": 66,
        "compiler": 67,
        "yarn-name": 68,
        "image-denoised": 69,
        "denoiser": 70,
        "isa-name": 71,
        "isa": 72,
    },
    "WeftTermKind": {
        "d": 0,
        "v": 1,
        "f": 2,
    },
    "WeftPixelType": {
        "u8": 0,
        "u16": 1,
        "f32": 2,
    },
    "WeftTonemap": {
        "pbr-neutral": 0,
        "aces": 1,
        "none": 2,
        "agx": 3,
    },
    "WeftTableFault": {
        "none": 0,
        "constant": 1,
        "form": 2,
        "late": 3,
        "clipped": 4,
        "scaled": 5,
        "encoded": 6,
        "other-lobe": 7,
        "biased": 8,
        "noisy": 9,
        "corner": 10,
    },
    "WeftTablePart": {
        "sum": 0,
        "f0": 1,
        "f90": 2,
    },
    "WeftChartKind": {
        "opaque": 0,
        "clear": 1,
        "gem": 2,
        "metal": 3,
    },
    "WeftLightKind": {
        "directional": 0,
        "point": 1,
        "spot": 2,
        "polygon": 3,
    },
    "WeftThreads": {
        "warp": 0,
        "weft": 1,
    },
    "WeftInputKind": {
        "scalar": 0,
        "color": 1,
        "normal": 2,
        "direction": 3,
        "angle": 4,
    },
    "WeftAlphaMode": {
        "opaque": 0,
        "mask": 1,
        "blend": 2,
    },
    "WeftPart": {
        "all": 0,
        "diffuse": 1,
        "specular": 2,
        "sheen": 3,
        "coat": 4,
        "dust": 5,
        "base-color": 6,
        "normal": 7,
        "roughness": 8,
        "sheen-color": 9,
        "sheen-roughness": 10,
        "texcoord": 11,
    },
    "WeftBrdfMetric": {
        "cosine": 0,
        "log": 1,
        "picture": 2,
    },
    "WeftMetric": {
        "relmse": 0,
        "flip": 1,
        "ssim": 2,
    },
    "WeftSeverity": {
        "note": 0,
        "warning": 1,
        "error": 2,
    },
    "WeftFindingKind": {
        "extension-required": 0,
        "extension-undeclared": 1,
        "value-range": 2,
        "default-disputed": 3,
        "texture-times-zero": 4,
        "texture-off": 5,
        "texture-two-spaces": 6,
        "texture-says-linear": 7,
        "texture-transform": 8,
        "texcoord-missing": 9,
        "image-repaired": 10,
        "sheen-black": 11,
        "sheen-texture-black": 12,
        "sheen-roughness-channel": 13,
        "sheen-roughness-plain": 14,
        "sheen-gains": 15,
        "sheen-darkens": 16,
        "engines-differ": 17,
        "sheen-on-metal": 18,
        "sheen-transmission": 19,
        "sheen-behind-glass": 20,
        "sheen-coat": 21,
        "sheen-ior": 22,
        "sheen-emission": 23,
        "base-dark": 24,
        "base-bright": 25,
        "metal-dark": 26,
        "implausible": 27,
        "normals-missing": 28,
        "tangents-missing": 29,
        "back-missing": 30,
        "image-unread": 31,
        "extension-archived": 32,
        "extension-ignored": 33,
        "texture-unshown": 34,
        "texture-channel": 35,
        "texture-plain": 36,
        "part-ignored": 37,
        "part-repaired": 38,
        "rest-pose": 39,
        "scene-empty": 40,
        "uv-uneven": 41,
        "u3m-member": 42,
        "u3m-size": 43,
        "u3m-dpi": 44,
        "u3m-repeat": 45,
        "u3m-constant": 46,
        "u3m-mode": 48,
        "u3m-gloss": 49,
        "u3m-specular": 50,
        "u3m-tint": 51,
        "u3m-coat-normal": 52,
        "u3m-green": 53,
        "u3m-normal-space": 54,
        "image-basis": 55,
    },
    "WeftFindingOf": {
        "asset": 0,
        "material": 1,
        "mesh": 2,
        "image": 3,
    },
    "WeftExportTarget": {
        "glsl": 0,
        "essl": 1,
        "hlsl": 2,
        "c": 3,
        "shadertoy": 4,
        "wgsl": 5,
        "godot": 6,
        "unity": 7,
        "unreal": 8,
    },
    "WeftExportLut": {
        "c": 0,
        "png16": 1,
        "exr": 2,
        "dds": 3,
        "npy": 4,
    },
    "WeftBackground": {
        "auto": 0,
        "environment": 1,
        "transparent": 2,
        "color": 3,
        "blurred": 4,
    },
    "WeftSampling": {
        "mis": 0,
        "light": 1,
        "lobe": 2,
    },
    "WeftAov": {
        "albedo": 0,
        "normal": 1,
        "depth": 2,
        "variance": 3,
        "samples": 4,
        "position": 5,
        "uv": 6,
        "object": 7,
        "material": 8,
        "diffuse": 9,
        "specular": 10,
        "sheen": 11,
        "coat": 12,
        "dust": 13,
        "other": 14,
    },
    "WeftDenoiser": {
        "regression": 0,
        "oidn": 1,
    },
    "WeftCauseKind": {
        "term": 0,
        "engine": 1,
        "light": 2,
        "picture": 3,
    },
    "WeftLtcChannel": {
        "z": 0,
        "q": 1,
        "b": 2,
        "r": 3,
        "amplitude": 4,
        "amplitude-f90": 5,
        "error": 6,
    },
    "WeftPlotKind": {
        "polar": 0,
        "lobe3d": 1,
        "cartesian": 2,
        "albedo": 3,
        "furnace": 4,
        "slice": 5,
        "sphere": 6,
        "samples": 7,
        "difference": 8,
        "ambient": 9,
    },
    "WeftPlotChannel": {
        "luminance": 0,
        "red": 1,
        "green": 2,
        "blue": 3,
    },
    "WeftPlotForm": {
        "curves": 0,
        "rose": 1,
        "map": 2,
        "surface": 3,
        "picture": 4,
    },
    "WeftGl": {
        "desktop": 0,
        "es": 1,
    },
    "WeftAmbient": {
        "best": 0,
        "irradiance": 1,
        "mirror": 2,
        "fitted": 3,
        "none": 4,
    },
    "WeftMtlxNode": {
        "open-pbr": 0,
        "gltf": 1,
        "standard": 2,
        "nodes": 3,
    },
}

CHOICES = {
    ("WeftError", "result"): "WeftResult",
    ("WeftError", "message"): "WeftMessage",
    ("WeftImage", "type"): "WeftPixelType",
    ("WeftTone", "curve"): "WeftTonemap",
    ("WeftAudit", "part"): "WeftTablePart",
    ("WeftAudit_found", "fault"): "WeftTableFault",
    ("WeftAlbedoFormDesc", "part"): "WeftTablePart",
    ("WeftChartEntry", "kind"): "WeftChartKind",
    ("WeftLight", "kind"): "WeftLightKind",
    ("WeftInputInfo", "kind"): "WeftInputKind",
    ("WeftMaterial", "alpha_mode"): "WeftAlphaMode",
    ("WeftMatchJob", "result"): "WeftResult",
    ("WeftDiffDesc", "metric"): "WeftMetric",
    ("WeftDiffDesc", "tonemap"): "WeftTonemap",
    ("WeftFinding", "kind"): "WeftFindingKind",
    ("WeftFinding", "severity"): "WeftSeverity",
    ("WeftFinding", "of"): "WeftFindingOf",
    ("WeftExportDesc", "target"): "WeftExportTarget",
    ("WeftExportDesc", "lut"): "WeftExportLut",
    ("WeftFitDesc", "metric"): "WeftBrdfMetric",
    ("WeftRenderDesc", "background"): "WeftBackground",
    ("WeftRenderDesc", "sampling"): "WeftSampling",
    ("WeftCause", "kind"): "WeftCauseKind",
    ("WeftPlotDesc", "kind"): "WeftPlotKind",
    ("WeftPlotDesc", "channel"): "WeftPlotChannel",
    ("WeftPlotPanel", "form"): "WeftPlotForm",
    ("WeftRasterDesc", "gl"): "WeftGl",
    ("WeftRasterView", "background"): "WeftBackground",
    ("WeftRasterView", "ambient"): "WeftAmbient",
    ("WeftRasterView", "part"): "WeftPart",
    ("WeftRasterShow", "tonemap"): "WeftTonemap",
}

# The result and the parameters of a call.
CALLS = {
    "weft_version": (c_char_p, ()),
    "weft_message_text": (c_char_p, (c_int,)),
    "weft_lobe_count": (c_int, ()),
    "weft_lobe_info": (POINTER(WeftLobeInfo), (c_int,)),
    "weft_lobe_find": (c_int, (c_char_p,)),
    "weft_lobe_param_find": (c_int, (c_int, c_char_p,)),
    "weft_lobe_load": (c_int, (c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_layer_name": (c_char_p, (c_int,)),
    "weft_layer_help": (c_char_p, (c_int,)),
    "weft_term_name": (c_char_p, (c_int, c_int,)),
    "weft_term_help": (c_char_p, (c_int, c_int,)),
    "weft_workflow_name": (c_char_p, (c_int,)),
    "weft_workflow_help": (c_char_p, (c_int,)),
    "weft_profile_name": (c_char_p, (c_int,)),
    "weft_profile_help": (c_char_p, (c_int,)),
    "weft_alias_name": (c_char_p, (c_int,)),
    "weft_alias_help": (c_char_p, (c_int,)),
    "weft_catalogue_text": (c_char_p, (c_char_p,)),
    "weft_lobe_init": (c_int, (c_char_p, POINTER(WeftLobe), POINTER(WeftError),)),
    "weft_lobe_set": (c_int, (POINTER(WeftLobe), c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_lobe_fitted": (None, (POINTER(WeftLobe), c_char_p, POINTER(WeftLog),)),
    "weft_lobe_eval": (None, (POINTER(WeftLobe), c_void_p, c_void_p, c_void_p,)),
    "weft_lobe_pdf": (c_float, (POINTER(WeftLobe), c_void_p, c_void_p,)),
    "weft_lobe_sample": (c_float, (POINTER(WeftLobe), c_void_p, c_void_p, c_void_p,)),
    "weft_lobe_albedo": (None, (POINTER(WeftLobe), c_float, c_void_p,)),
    "weft_eval_n": (c_int, (POINTER(WeftLobe), c_size_t, WeftDirections, WeftDirections, WeftColors, POINTER(WeftError),)),
    "weft_pdf_n": (c_int, (POINTER(WeftLobe), c_size_t, WeftDirections, WeftDirections, c_void_p, POINTER(WeftError),)),
    "weft_sample_n": (c_int, (POINTER(WeftLobe), c_size_t, WeftDirections, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_albedo_n": (c_int, (POINTER(WeftLobe), c_size_t, c_void_p, WeftColors, POINTER(WeftError),)),
    "weft_eval_each": (c_int, (POINTER(WeftLobes), c_size_t, WeftDirections, WeftDirections, WeftColors, c_void_p, POINTER(WeftError),)),
    "weft_sample_each": (c_int, (POINTER(WeftLobes), c_size_t, WeftDirections, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_image_create": (c_int, (c_int, c_int, c_int, c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_image_free": (None, (POINTER(WeftImage),)),
    "weft_image_read": (c_int, (c_char_p, POINTER(WeftImage), POINTER(WeftLog), POINTER(WeftError),)),
    "weft_image_read_memory": (c_int, (c_void_p, c_size_t, c_char_p, POINTER(WeftImage), POINTER(WeftLog), POINTER(WeftError),)),
    "weft_image_read_channels": (c_int, (c_char_p, c_void_p, c_int, POINTER(WeftImage), c_void_p, POINTER(WeftError),)),
    "weft_image_write": (c_int, (c_char_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_image_write_as": (c_int, (c_char_p, POINTER(WeftImage), POINTER(WeftImageWriting), POINTER(WeftError),)),
    "weft_image_suffix_known": (c_int, (c_char_p,)),
    "weft_image_suffix_linear": (c_int, (c_char_p,)),
    "weft_image_convert_f32": (c_int, (POINTER(WeftImage), c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_tonemap_name": (c_char_p, (c_int,)),
    "weft_image_show": (c_int, (POINTER(WeftImage), POINTER(WeftTone), c_void_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_image_tonemap": (c_int, (POINTER(WeftImage), c_int, c_float, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_image_tonemap_over": (c_int, (POINTER(WeftImage), c_int, c_float, c_void_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_image_meter": (c_float, (POINTER(WeftImage),)),
    "weft_image_find_white": (None, (POINTER(WeftImage), c_void_p,)),
    "weft_white": (None, (c_float, c_float, c_void_p,)),
    "weft_white_matrix": (None, (c_void_p, c_void_p,)),
    "weft_table_form_name": (c_char_p, (c_int,)),
    "weft_table_form_help": (c_char_p, (c_int,)),
    "weft_table_form_at": (WeftTableForm, (c_int,)),
    "weft_table_form_find": (c_int, (POINTER(WeftTableForm),)),
    "weft_table_form_parse": (c_int, (c_char_p, POINTER(WeftTableForm), POINTER(WeftError),)),
    "weft_table_form_text": (c_void_p, (POINTER(WeftTableForm), c_void_p,)),
    "weft_table_form_texel": (None, (POINTER(WeftTableForm), c_int, c_int, c_int, c_int, c_int, c_void_p, c_void_p,)),
    "weft_bake_kind": (POINTER(WeftBakeKind), (c_int,)),
    "weft_bake": (c_int, (POINTER(WeftBakeDesc), POINTER(WeftBakeInfo), POINTER(WeftImage), POINTER(WeftError),)),
    "weft_bake_fibre_model": (c_int, (POINTER(WeftFibreModelDesc), c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_table_fault_name": (c_char_p, (c_int,)),
    "weft_audit": (c_int, (POINTER(WeftAuditDesc), POINTER(WeftAudit), POINTER(WeftImage), POINTER(WeftError),)),
    "weft_bake_form": (c_int, (POINTER(WeftAlbedoFormDesc), POINTER(WeftAlbedoForm), POINTER(WeftError),)),
    "weft_form_at": (c_float, (POINTER(WeftAlbedoForm), c_float, c_float,)),
    "weft_chart": (POINTER(WeftChartEntry), (c_int,)),
    "weft_losses_add": (c_int, (POINTER(WeftLosses), c_int, c_char_p, c_char_p, c_char_p,)),
    "weft_losses_hear": (c_int, (POINTER(WeftLosses), c_int, c_char_p, c_char_p, c_int, c_char_p,)),
    "weft_losses_free": (None, (POINTER(WeftLosses),)),
    "weft_scene_load": (c_int, (c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_load_watched": (c_int, (c_char_p, WeftProgress, c_void_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_load_moment": (c_int, (c_char_p, POINTER(WeftMoment), WeftProgress, c_void_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_load_memory": (c_int, (c_void_p, c_size_t, c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_free": (None, (c_void_p,)),
    "weft_builtin_name": (c_char_p, (c_int,)),
    "weft_builtin_help": (c_char_p, (c_int,)),
    "weft_scene_info": (WeftSceneInfo, (c_void_p,)),
    "weft_scene_hash": (c_uint64, (c_void_p,)),
    "weft_scene_material_name": (c_char_p, (c_void_p, c_int,)),
    "weft_scene_camera_name": (c_char_p, (c_void_p, c_int,)),
    "weft_scene_variant_name": (c_char_p, (c_void_p, c_int,)),
    "weft_scene_material_used": (c_int, (c_void_p, c_int,)),
    "weft_scene_set_variant": (c_int, (c_void_p, c_char_p, POINTER(WeftError),)),
    "weft_scene_variant": (c_int, (c_void_p,)),
    "weft_scene_set": (c_int, (c_void_p, c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_assign_material": (c_int, (c_void_p, c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_assign_material_memory": (c_int, (c_void_p, c_char_p, c_void_p, c_size_t, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_preset_name": (c_char_p, (c_int,)),
    "weft_preset_group": (c_char_p, (c_int,)),
    "weft_preset_help": (c_char_p, (c_int,)),
    "weft_preset_text": (c_char_p, (c_int,)),
    "weft_preset_group_name": (c_char_p, (c_int,)),
    "weft_preset_group_help": (c_char_p, (c_int,)),
    "weft_scene_convert": (c_int, (c_void_p, c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_material_input_name": (c_char_p, (c_int,)),
    "weft_material_input_help": (c_char_p, (c_int,)),
    "weft_material_input_label": (c_char_p, (c_int,)),
    "weft_material_input_find": (c_int, (c_char_p,)),
    "weft_material_choice_name": (c_char_p, (c_int,)),
    "weft_material_choice_find": (c_int, (c_char_p,)),
    "weft_material_choice_help": (c_char_p, (c_int,)),
    "weft_material_choice_value": (c_char_p, (c_int, c_int,)),
    "weft_material_choice_fits": (c_int, (c_int, c_int,)),
    "weft_scene_set_environment_file": (c_int, (c_void_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_set_environment_color": (c_int, (c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_scene_set_environment_studio": (c_int, (c_void_p, POINTER(WeftError),)),
    "weft_scene_set_environment_placement": (c_int, (c_void_p, c_float, c_float, POINTER(WeftError),)),
    "weft_scene_set_environment_parts": (c_int, (c_void_p, c_float, c_float, POINTER(WeftError),)),
    "weft_scene_add_light": (c_int, (c_void_p, POINTER(WeftLight), POINTER(WeftError),)),
    "weft_scene_light": (c_int, (c_void_p, c_int, POINTER(WeftLight), POINTER(WeftError),)),
    "weft_scene_put_light": (c_int, (c_void_p, c_int, POINTER(WeftLight), POINTER(WeftError),)),
    "weft_scene_remove_light": (c_int, (c_void_p, c_int, POINTER(WeftError),)),
    "weft_scene_camera": (c_int, (c_void_p, c_char_p, c_float, POINTER(WeftCamera), POINTER(WeftError),)),
    "weft_draft_read": (c_int, (c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_draft_read_memory": (c_int, (c_void_p, c_size_t, c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_draft_parse": (c_int, (c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_weave_name": (c_char_p, (c_int,)),
    "weft_weave_help": (c_char_p, (c_int,)),
    "weft_draft_back": (c_int, (c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_draft_copy": (c_int, (c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_draft_free": (None, (c_void_p,)),
    "weft_draft_info": (WeftDraftInfo, (c_void_p,)),
    "weft_draft_warp_up": (c_int, (c_void_p, c_int, c_int,)),
    "weft_draft_set_up": (None, (c_void_p, c_int, c_int, c_int,)),
    "weft_draft_thread": (WeftThread, (c_void_p, c_int, c_int,)),
    "weft_draft_set_sett": (c_int, (c_void_p, c_int, c_float, POINTER(WeftError),)),
    "weft_draft_write": (c_int, (c_void_p, c_char_p, POINTER(WeftError),)),
    "weft_draft_suffix_known": (c_int, (c_char_p,)),
    "weft_yarn_name": (c_char_p, (c_int,)),
    "weft_yarn_help": (c_char_p, (c_int,)),
    "weft_yarn_find": (c_int, (c_char_p, POINTER(WeftYarn), POINTER(WeftError),)),
    "weft_yarn_number": (POINTER(WeftYarnNumber), (c_int,)),
    "weft_cloth_create": (c_int, (c_void_p, c_void_p, c_uint, c_void_p, POINTER(WeftError),)),
    "weft_cloth_free": (None, (c_void_p,)),
    "weft_scene_cloth": (c_void_p, (c_void_p, c_int, c_void_p,)),
    "weft_scene_cloth_copy": (c_int, (c_void_p, c_int, c_void_p, POINTER(WeftError),)),
    "weft_scene_set_weave": (c_int, (c_void_p, c_int, c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_scene_weave": (c_int, (c_void_p, c_char_p, c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_weave_text": (c_void_p, (c_void_p, c_int,)),
    "weft_cloth_info": (WeftClothInfo, (c_void_p,)),
    "weft_scene_cloth_info": (WeftClothInfo, (c_void_p, c_int,)),
    "weft_cloth_bake": (c_int, (c_void_p, c_int, c_double, c_char_p, POINTER(WeftError),)),
    "weft_cloth_draw": (c_int, (c_void_p, c_int, c_float, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_material_input_info": (c_int, (c_int, POINTER(WeftInputInfo),)),
    "weft_material_hair_info": (c_int, (c_int, POINTER(WeftInputInfo),)),
    "weft_material_hair_name": (c_char_p, (c_int,)),
    "weft_material_hair_help": (c_char_p, (c_int,)),
    "weft_material_default": (None, (POINTER(WeftMaterial),)),
    "weft_material_read": (c_int, (c_char_p, POINTER(WeftMaterial), POINTER(WeftLog), POINTER(WeftError),)),
    "weft_material_read_woven": (c_int, (c_char_p, POINTER(WeftMaterial), c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_material_set": (c_int, (POINTER(WeftMaterial), c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_material_set_number": (c_int, (POINTER(WeftMaterial), c_int, c_void_p, POINTER(WeftError),)),
    "weft_scene_material": (c_int, (c_void_p, c_int, POINTER(WeftMaterial), POINTER(WeftError),)),
    "weft_scene_put_material": (c_int, (c_void_p, c_int, POINTER(WeftMaterial), POINTER(WeftError),)),
    "weft_scene_put_measured": (c_int, (c_void_p, c_int, c_char_p, POINTER(WeftError),)),
    "weft_material_choose": (None, (POINTER(WeftMaterial), c_int, c_int,)),
    "weft_material_plausible": (None, (POINTER(WeftMaterial), c_char_p, POINTER(WeftLog),)),
    "weft_material_fitted": (None, (POINTER(WeftMaterial), c_char_p, POINTER(WeftLog),)),
    "weft_material_reads": (c_int, (POINTER(WeftMaterial), c_int,)),
    "weft_scene_set_texture": (c_int, (c_void_p, c_char_p, c_char_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_texture_path": (c_char_p, (c_void_p, c_int,)),
    "weft_scene_put_texture": (c_int, (c_void_p, c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_scene_read_texture": (c_int, (c_void_p, c_int, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_texture": (WeftImage, (c_void_p, c_int,)),
    "weft_scene_add_texture": (c_int, (c_void_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_scene_bind_maps": (c_int, (c_void_p, c_char_p, c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_part_name": (c_char_p, (c_int,)),
    "weft_reflection_create": (c_int, (POINTER(WeftMaterial), c_void_p, POINTER(WeftError),)),
    "weft_reflection_create_woven": (c_int, (POINTER(WeftMaterial), c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_reflection_of_lobe": (c_int, (POINTER(WeftLobe), c_void_p, POINTER(WeftError),)),
    "weft_reflection_read": (c_int, (c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_reflection_readable": (c_int, (c_char_p,)),
    "weft_reflection_write": (c_int, (c_void_p, c_char_p, POINTER(WeftBsdfDesc), POINTER(WeftError),)),
    "weft_reflection_distance": (c_double, (c_void_p, c_void_p,)),
    "weft_reflection_free": (None, (c_void_p,)),
    "weft_reflection_eval": (None, (c_void_p, c_int, c_void_p, c_int, c_void_p, c_void_p,)),
    "weft_reflection_albedo": (None, (c_void_p, c_int, c_float, c_void_p,)),
    "weft_reflection_sphere": (c_int, (c_void_p, c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_brdf_metric_name": (c_char_p, (c_int,)),
    "weft_brdf_distance": (c_int, (c_void_p, c_void_p, c_int, c_int, c_void_p, POINTER(WeftError),)),
    "weft_match_lobe": (c_int, (c_void_p, c_int, c_uint, POINTER(WeftLobe), POINTER(WeftMatch), POINTER(WeftError),)),
    "weft_match_material": (c_int, (c_void_p, c_int, c_void_p, POINTER(WeftMaterial), POINTER(WeftMatch), POINTER(WeftError),)),
    "weft_match_is_free": (c_int, (POINTER(WeftMaterial), c_int,)),
    "weft_match_many": (c_int, (POINTER(WeftMatchJob), c_int, c_int, c_int, WeftProgress, c_void_p, POINTER(WeftError),)),
    "weft_match_asset": (c_int, (c_char_p, c_char_p, c_int, c_int, c_int, WeftProgress, c_void_p, c_void_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_match_report_free": (None, (POINTER(WeftAssetMatch),)),
    "weft_material_bake": (c_int, (POINTER(WeftMaterial), c_void_p, POINTER(WeftBaking), c_char_p, POINTER(WeftBaked), POINTER(WeftError),)),
    "weft_scene_bake": (c_int, (c_void_p, c_int, POINTER(WeftBaking), c_char_p, POINTER(WeftBaked), POINTER(WeftError),)),
    "weft_target_info": (c_int, (c_int, POINTER(WeftTarget),)),
    "weft_deliver": (c_int, (c_char_p, c_char_p, c_int, c_int, c_int, WeftProgress, c_void_p, POINTER(WeftDelivery), POINTER(WeftLog), POINTER(WeftError),)),
    "weft_deliver_levels": (c_int, (c_char_p, c_char_p, POINTER(WeftDelivery), c_void_p, POINTER(WeftError),)),
    "weft_delivery_free": (None, (POINTER(WeftDelivery),)),
    "weft_metric_name": (c_char_p, (c_int,)),
    "weft_diff": (c_int, (POINTER(WeftDiffDesc), POINTER(WeftDiff), POINTER(WeftImage), POINTER(WeftError),)),
    "weft_diff_beyond": (c_double, (POINTER(WeftImage), c_int, c_double,)),
    "weft_finding_name": (c_char_p, (c_int,)),
    "weft_finding_help": (c_char_p, (c_int,)),
    "weft_finding_severity": (c_int, (c_int,)),
    "weft_finding_fixable": (c_int, (c_int,)),
    "weft_severity_name": (c_char_p, (c_int,)),
    "weft_doctor_open": (c_int, (c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_doctor_open_watched": (c_int, (c_char_p, WeftProgress, c_void_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_doctor_open_memory": (c_int, (c_void_p, c_size_t, c_char_p, c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_doctor_close": (None, (c_void_p,)),
    "weft_doctor_count": (c_int, (c_void_p,)),
    "weft_doctor_finding": (POINTER(WeftFinding), (c_void_p, c_int,)),
    "weft_doctor_info": (WeftDoctorInfo, (c_void_p,)),
    "weft_doctor_fix": (c_int, (c_void_p, c_char_p, POINTER(WeftError),)),
    "weft_export_target_name": (c_char_p, (c_int,)),
    "weft_export_target_help": (c_char_p, (c_int,)),
    "weft_export_lut_name": (c_char_p, (c_int,)),
    "weft_export": (c_int, (POINTER(WeftExportDesc), POINTER(WeftExport), POINTER(WeftError),)),
    "weft_export_all": (c_int, (POINTER(WeftExportDesc), c_int, POINTER(WeftExport), POINTER(WeftError),)),
    "weft_export_free": (None, (POINTER(WeftExport),)),
    "weft_data_read": (c_int, (c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_data_read_memory": (c_int, (c_void_p, c_size_t, c_char_p, c_void_p, POINTER(WeftError),)),
    "weft_data_create": (c_int, (c_int, c_void_p, c_void_p, c_void_p, c_int, c_void_p, POINTER(WeftError),)),
    "weft_data_free": (None, (c_void_p,)),
    "weft_data_count": (c_int, (c_void_p, c_void_p,)),
    "weft_data_sample": (None, (c_void_p, c_int, c_void_p, c_void_p, c_void_p,)),
    "weft_data_lobe": (c_int, (c_void_p, c_char_p, c_char_p, c_void_p, POINTER(WeftDataLobe), POINTER(WeftError),)),
    "weft_fitted_notes": (c_uint, (POINTER(WeftFitted),)),
    "weft_fit": (c_int, (c_void_p, POINTER(WeftFitDesc), POINTER(WeftFit), POINTER(WeftError),)),
    "weft_fit_material": (c_int, (c_void_p, POINTER(WeftFitDesc), POINTER(WeftMaterial), POINTER(WeftMatch), POINTER(WeftError),)),
    "weft_data_distance": (c_int, (c_void_p, POINTER(WeftFitDesc), c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_fitted_is_weave": (c_int, (POINTER(WeftFitted),)),
    "weft_fitted_reflection": (c_int, (POINTER(WeftFitted), c_void_p, POINTER(WeftError),)),
    "weft_fitted_material": (c_int, (POINTER(WeftFitted), POINTER(WeftMaterial),)),
    "weft_isa_name": (c_char_p, (c_int,)),
    "weft_isa": (c_char_p, ()),
    "weft_isa_use": (c_int, (c_char_p, POINTER(WeftError),)),
    "weft_scene_stage": (WeftFloor, (c_void_p,)),
    "weft_camera_rotated": (None, (c_void_p, c_void_p, c_float, c_int, c_int, c_void_p,)),
    "weft_render_create": (c_int, (c_void_p, POINTER(WeftRenderDesc), c_void_p, POINTER(WeftError),)),
    "weft_render_restart": (c_int, (c_void_p, POINTER(WeftRenderDesc), c_uint, POINTER(WeftError),)),
    "weft_render_free": (None, (c_void_p,)),
    "weft_render_run": (c_int, (c_void_p, c_int, c_double, WeftProgress, c_void_p,)),
    "weft_render_samples": (c_int, (c_void_p,)),
    "weft_render_tile_count": (c_int, (c_void_p,)),
    "weft_render_tiles_run": (c_int, (c_void_p, c_void_p, c_int, WeftProgress, c_void_p,)),
    "weft_render_tile_numbers": (c_int, (c_void_p,)),
    "weft_render_tile": (None, (c_void_p, c_int, c_void_p,)),
    "weft_render_tile_set": (c_int, (c_void_p, c_int, c_void_p, POINTER(WeftError),)),
    "weft_render_info": (WeftRenderInfo, (c_void_p,)),
    "weft_render_stage": (c_int, (c_void_p, c_int, POINTER(WeftRenderStage),)),
    "weft_render_image": (c_int, (c_void_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_render_noise": (c_double, (c_void_p,)),
    "weft_aov_name": (c_char_p, (c_int,)),
    "weft_render_record": (None, (POINTER(WeftRenderDesc), c_uint,)),
    "weft_render_aov": (c_int, (c_void_p, c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_render_layers": (c_int, (c_void_p, c_uint, POINTER(WeftRenderLayers), POINTER(WeftError),)),
    "weft_render_layers_free": (None, (POINTER(WeftRenderLayers),)),
    "weft_denoiser_name": (c_char_p, (c_int,)),
    "weft_denoiser_check": (c_int, (c_int, POINTER(WeftError),)),
    "weft_render_denoised": (c_int, (c_void_p, c_int, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_judge_create": (c_int, (c_void_p, POINTER(WeftJudgeDesc), WeftProgress, c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_judge_free": (None, (c_void_p,)),
    "weft_judge_info": (WeftJudgeInfo, (c_void_p,)),
    "weft_judge_object": (c_int, (c_void_p, c_int, POINTER(WeftJudgeObject),)),
    "weft_judge_reference": (POINTER(WeftImage), (c_void_p,)),
    "weft_cause_kind_name": (c_char_p, (c_int,)),
    "weft_judge_cause": (WeftCause, (c_int,)),
    "weft_judge_pictures": (c_int, (c_void_p, POINTER(WeftJudgePicture), c_int, WeftProgress, c_void_p, POINTER(WeftVerdict), POINTER(WeftError),)),
    "weft_verdict_free": (None, (POINTER(WeftVerdict),)),
    "weft_ltc_channel_name": (c_char_p, (c_int,)),
    "weft_ltc_create": (c_int, (POINTER(WeftLobe), POINTER(WeftLtcDesc), c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_ltc_free": (None, (c_void_p,)),
    "weft_ltc_info": (WeftLtcInfo, (c_void_p,)),
    "weft_ltc_channel": (c_void_p, (c_void_p, c_int,)),
    "weft_ltc_cos_o": (c_float, (c_void_p, c_int,)),
    "weft_ltc_value": (c_float, (c_void_p, c_int,)),
    "weft_ltc_at": (WeftLtcLobe, (c_void_p, c_float, c_float,)),
    "weft_ltc_inverse": (None, (POINTER(WeftLtcLobe), c_void_p, c_void_p,)),
    "weft_ltc_pdf": (c_float, (POINTER(WeftLtcLobe), c_void_p, c_void_p,)),
    "weft_ltc_sample": (c_float, (POINTER(WeftLtcLobe), c_void_p, c_void_p, c_void_p,)),
    "weft_passport_measure": (c_int, (POINTER(WeftPassportDesc), POINTER(WeftPassport), POINTER(WeftError),)),
    "weft_passport_significance": (c_double, (c_double, c_int,)),
    "weft_pick_create": (c_int, (c_void_p, c_void_p, POINTER(WeftError),)),
    "weft_pick_free": (None, (c_void_p,)),
    "weft_pick_at": (c_int, (c_void_p, c_char_p, c_int, c_int, c_float, c_float, POINTER(WeftPicked),)),
    "weft_plot_kind_name": (c_char_p, (c_int,)),
    "weft_plot_kind_help": (c_char_p, (c_int,)),
    "weft_plot_data": (c_int, (POINTER(WeftPlotDesc), POINTER(WeftPlotData), POINTER(WeftError),)),
    "weft_plot_data_free": (None, (POINTER(WeftPlotData),)),
    "weft_plot_image": (c_int, (POINTER(WeftPlotDesc), POINTER(WeftImage), POINTER(WeftError),)),
    "weft_plot_suffix_known": (c_int, (c_char_p,)),
    "weft_plot_write": (c_int, (POINTER(WeftPlotDesc), c_char_p, POINTER(WeftError),)),
    "weft_plot_report": (c_int, (POINTER(WeftPlotDesc), c_char_p, POINTER(WeftError),)),
    "weft_raster_create": (c_int, (c_void_p, POINTER(WeftRasterDesc), c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_raster_free": (None, (c_void_p,)),
    "weft_raster_update": (c_int, (c_void_p, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_raster_draw": (c_int, (c_void_p, POINTER(WeftRasterView), POINTER(WeftError),)),
    "weft_raster_accumulate_begin": (c_int, (c_void_p, POINTER(WeftRasterView), c_int, POINTER(WeftError),)),
    "weft_raster_accumulate": (c_int, (c_void_p, c_double, c_void_p, POINTER(WeftError),)),
    "weft_raster_ready": (c_int, (c_void_p, POINTER(WeftRasterView),)),
    "weft_raster_wait": (c_int, (c_void_p, POINTER(WeftError),)),
    "weft_raster_image": (c_int, (c_void_p, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_raster_show": (c_int, (c_void_p, POINTER(WeftRasterShow), POINTER(WeftError),)),
    "weft_raster_refresh": (c_int, (c_void_p,)),
    "weft_raster_finish": (None, (c_void_p,)),
    "weft_raster_return_memory": (None, ()),
    "weft_raster_rest": (None, (c_void_p,)),
    "weft_raster_info": (WeftRasterInfo, (c_void_p,)),
    "weft_root_use": (c_int, (c_char_p, POINTER(WeftError),)),
    "weft_scene_save_material": (c_int, (c_void_p, c_int, c_char_p, POINTER(WeftError),)),
    "weft_mtlx_node_name": (c_char_p, (c_int,)),
    "weft_scene_save_mtlx": (c_int, (c_void_p, c_int, c_char_p, c_int, POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_save_u3m": (c_int, (c_void_p, c_int, c_char_p, POINTER(WeftTextile), POINTER(WeftLog), POINTER(WeftError),)),
    "weft_scene_save": (c_int, (c_void_p, c_char_p, POINTER(WeftError),)),
    "weft_sheet_compose": (c_int, (POINTER(WeftSheetDesc), POINTER(WeftImage), POINTER(WeftError),)),
    "weft_difference": (c_int, (POINTER(WeftImage), POINTER(WeftImage), POINTER(WeftDifference), POINTER(WeftError),)),
    "weft_difference_image": (c_int, (POINTER(WeftImage), POINTER(WeftImage), c_float, POINTER(WeftImage), POINTER(WeftError),)),
    "weft_heat_image": (c_int, (POINTER(WeftImage), c_float, c_float, POINTER(WeftImage), POINTER(WeftError),)),
}
