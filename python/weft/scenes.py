"""Scenes, their materials and lights, and pictures of them: path traced and drawn by OpenGL."""
from __future__ import annotations

import ctypes
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import _abi
from ._arrays import Array, Arrays
from ._library import (
    INTERRUPTED,
    OK,
    Error,
    Handle,
    PathLike,
    Progress,
    Watch,
    call,
    choice,
    created,
    fill,
    integer,
    lib,
    logged,
    names,
    number,
    owned_text,
    path,
    text,
    triple,
)
from ._records import Record, record
from .images import given as image_given
from .images import seen, taken
from .lobes import _words
from .materials import Material
from .weaves import Cloth, ClothInfo, Draft, Yarn, _yarn_pair

_ALL_CHANGED = 7
_libc = ctypes.CDLL(None)
_libc.malloc.argtypes, _libc.malloc.restype = [ctypes.c_size_t], ctypes.c_void_p


class SceneInfo(Record):
    """Counts and extent: `mesh_count`, `material_count`, `light_count`, `camera_count`, `variant_count`, `image_count`,
    `triangle_count`, and the corners `low` and `high` of the bounding box, m."""


class Light(Record):
    """A light: `kind` ("directional", "point", "spot", "polygon"), `position` (m), `direction` in which light travels,
    `color` (W/m^2 across a beam, W/sr, or radiance), `range`, `inner` and `outer` (degrees), and of a polygon `size`
    (m), `corners`, `roll` (degrees)."""


class Camera(Record):
    """A camera: `eye`, `target`, `up`, and the vertical `fov`, degrees; 0 of an orthographic one."""


class Scene(Handle):
    """A scene of a .gltf or .glb, of "builtin:NAME", or of the bytes of a .glb. World space is right-handed, +y up,
    metres.

    MATERIAL is a name, an index as a text, "*" for all, or None for the cloth of the scene: what has a sheen or, where
    nothing has, all that does not emit. A change while another call uses the scene is a RuntimeError."""

    _free, _noun = "weft_scene_free", "scene"

    def __init__(
        self, file: Union[PathLike, bytes] = "builtin:cloth", *, name: str = "scene.glb", progress: Progress = None
    ) -> None:
        if isinstance(file, bytes):
            super().__init__(
                created("weft_scene_load_memory", file, len(file), text(name, "name"), free=self._free)
            )
        else:
            with Watch(progress) as watch:  # which may raise, and so frees, what there is
                super().__init__(
                    created("weft_scene_load_watched", path(file, "file"), watch.callback, None, free=self._free)
                )
        self._revision = 0

    def __repr__(self) -> str:
        return "<Scene, closed>" if self.closed else f"<Scene {self.info!r}>"

    def _change(self, name: str, *arguments: Any, log: bool = True) -> None:
        """Makes a call that changes the scene, after which pictures of it are begun anew."""
        with self._use(alone=True) as pointer:
            self._revision += 1
            if log:
                logged(name, pointer, *arguments)
            else:
                call(name, pointer, *arguments)

    @property
    def info(self) -> SceneInfo:
        """Its counts and extent."""
        with self._use() as pointer:
            return record(lib.weft_scene_info(pointer), SceneInfo)  # type: ignore[no-any-return]

    @property
    def hash(self) -> int:
        """A hash of all that pictures of it depend on, as it is now."""
        with self._use() as pointer:
            return int(lib.weft_scene_hash(pointer))

    def _names(self, call_name: str) -> list[str]:
        with self._use() as pointer:
            return names(call_name, pointer)

    @property
    def materials(self) -> list[str]:
        """Names of its materials; "" where the file gives none."""
        return self._names("weft_scene_material_name")

    @property
    def cameras(self) -> list[str]:
        """Names of its cameras."""
        return self._names("weft_scene_camera_name")

    @property
    def variants(self) -> list[str]:
        """Names of its variants of KHR_materials_variants."""
        return self._names("weft_scene_variant_name")

    @property
    def variant(self) -> Optional[str]:
        """The present variant; None: none. Can be set."""
        with self._use() as pointer:
            index: int = lib.weft_scene_variant(pointer)
        return self.variants[index] if index >= 0 else None

    @variant.setter
    def variant(self, name: Optional[str]) -> None:
        self._change("weft_scene_set_variant", None if name is None else text(name, "variant"), log=False)

    # ---- materials

    def _index(self, material: Union[int, str]) -> int:
        if isinstance(material, str):
            if material not in self.materials:
                raise ValueError(f"material: {material!r:.60} is not a material of this scene")
            return self.materials.index(material)
        return integer(material, "material")

    def set(self, target: str, value: Any) -> None:
        """Sets "MATERIAL.INPUT" to a number, three of them or a choice, and drops its texture."""
        self._change("weft_scene_set", text(target, "target"), _words(value, "value"))

    def assign(
        self, file: Union[PathLike, bytes], material: Optional[str] = None, *, name: str = "material.json"
    ) -> None:
        """Replaces materials by that of a file, of "preset:NAME", or of the bytes of a material file."""
        which = None if material is None else text(material, "material")
        if isinstance(file, bytes):
            self._change("weft_scene_assign_material_memory", which, file, len(file), text(name, "name"))
        else:
            self._change("weft_scene_assign_material", which, path(file, "file"))

    def material(self, material: Union[int, str] = 0) -> Material:
        """Returns a material by index or name, a copy; textures are numbers of this scene."""
        index, out, pair = self._index(material), _abi.WeftMaterial(), (_abi.WeftYarn * 2)()
        with self._use() as pointer:
            call("weft_scene_material", pointer, index, ctypes.byref(out))
            draft = lib.weft_scene_cloth(pointer, out.cloth, pair)
            seed = lib.weft_scene_cloth_info(pointer, out.cloth).seed
            made = created("weft_cloth_create", draft, pair, seed & 0xFFFFFFFF) if draft else None
        return Material._of(out, Cloth._of(made) if made else None)

    def put_material(self, material: Union[int, str], new: Material) -> None:
        """Replaces a material by index or name. Its textures and its cloth are those of this scene, by number."""
        if not isinstance(new, Material):
            raise TypeError(f"new: must be a Material, not {type(new).__name__}")
        self._change("weft_scene_put_material", self._index(material), ctypes.byref(new._material), log=False)

    def used(self, material: Union[int, str]) -> bool:
        """Returns True if any surface has that material in the present variant."""
        index = self._index(material)
        with self._use() as pointer:
            return bool(lib.weft_scene_material_used(pointer, index))

    def put_measured(self, material: Union[int, str], file: PathLike) -> None:
        """Gives a material a measurement, which the path tracer evaluates in place of its lobes."""
        self._change("weft_scene_put_measured", self._index(material), path(file, "file"), log=False)

    def convert(self, workflow: str) -> list[float]:
        """Converts materials between workflows "metallic" and "specular". Returns of each the greatest change of a
        colour, or -1 (another workflow) or -2 (it is that one already) where it stays."""
        losses = (ctypes.c_float * max(self.info.material_count, 1))()
        self._change("weft_scene_convert", text(workflow, "workflow"), losses, log=False)
        return list(losses)[: self.info.material_count]

    def save(self, file: PathLike) -> None:
        """Writes the scene as .glb, or as .gltf with files beside it."""
        with self._use() as pointer:
            call("weft_scene_save", pointer, path(file, "file"))

    def save_material(self, material: Union[int, str], file: PathLike) -> None:
        """Writes a material as a file of JSON, and its textures beside it."""
        index = self._index(material)
        with self._use() as pointer:
            call("weft_scene_save_material", pointer, index, path(file, "file"))

    # ---- textures

    def set_texture(self, target: str, file: PathLike) -> None:
        """Reads an image as the texture of "MATERIAL.INPUT", or of "MATERIAL.INPUT.r" to use one channel."""
        self._change("weft_scene_set_texture", text(target, "target"), path(file, "file"))

    def texture(self, number: int) -> Optional[Array]:
        """Returns the pixels of a texture, counted from 1, a copy; None where there is none."""
        with self._use() as pointer:
            image = lib.weft_scene_texture(pointer, integer(number, "number"))
            return seen(image) if image.pixels else None

    def add_texture(self, image: Arrays) -> int:
        """Adds a texture of an array, which repeats, and returns its number, counted from 1."""
        copy = _owned(image)
        error = _abi.WeftError()
        with self._use(alone=True) as pointer:
            self._revision += 1
            found: int = lib.weft_scene_add_texture(pointer, ctypes.byref(copy), ctypes.byref(error))
        if not found:
            lib.weft_image_free(ctypes.byref(copy))
            raise Error(error.text.decode("utf-8", "replace"), error.result)
        return found

    def put_texture(self, number: int, image: Arrays) -> None:
        """Replaces the pixels of a texture, counted from 1."""
        copy = _owned(image)
        try:
            self._change("weft_scene_put_texture", integer(number, "number"), ctypes.byref(copy), log=False)
        finally:
            lib.weft_image_free(ctypes.byref(copy))

    def bind_maps(self, folder: PathLike, material: Optional[str] = None) -> int:
        """Reads the maps in a folder onto materials, by file name; returns how many there were."""
        count = ctypes.c_int()
        self._change(
            "weft_scene_bind_maps",
            None if material is None else text(material, "material"),
            path(folder, "folder"),
            ctypes.byref(count),
        )
        return count.value

    # ---- weave

    def weave(self, material: Union[int, str] = 0) -> Optional[tuple[Draft, tuple[Yarn, Yarn], ClothInfo]]:
        """Returns the draft, the yarns of warp and weft and the figures of a woven material; None where it is not
        woven."""
        number, pair = self.material(material)._material.cloth, (_abi.WeftYarn * 2)()
        with self._use() as pointer:
            draft = lib.weft_scene_cloth(pointer, number, pair)
            if not draft:
                return None
            return (
                Draft._of(created("weft_draft_copy", draft)),
                (Yarn._of(pair[0]), Yarn._of(pair[1])),
                record(lib.weft_scene_cloth_info(pointer, number), ClothInfo),
            )

    def set_weave(self, material: Union[int, str], draft: Union[Draft, str], yarns: Any) -> None:
        """Weaves a new cloth for a material that is woven."""
        index, pair = self._index(material), _yarn_pair(yarns)
        made = Draft(draft) if isinstance(draft, str) else draft
        if not isinstance(made, Draft):
            raise TypeError(f"draft: must be a Draft or its notation, not {type(draft).__name__}")
        with made._use() as pointer:
            self._change("weft_scene_set_weave", index, pointer, pair, log=False)

    def set_weave_key(self, key: str, value: Any, material: Optional[str] = None) -> None:
        """Sets a key of the weave, such as "draft", "sett" or "warp.alpha"; what is not woven becomes plain cotton
        first. An empty key takes the whole weave, as the JSON of weave_text() or a draft."""
        self._change(
            "weft_scene_weave",
            None if material is None else text(material, "material"),
            text(key, "key"),
            _words(value, "value"),
        )

    def weave_text(self, material: Union[int, str] = 0) -> Optional[str]:
        """Returns the weave of a material as JSON; None where it is not woven."""
        number = self.material(material)._material.cloth
        with self._use() as pointer:
            found = lib.weft_scene_weave_text(pointer, number)
        return owned_text(found) if found else None

    # ---- light and camera

    def set_environment(
        self,
        light: Any = None,
        *,
        rotation: Optional[float] = None,
        strength: Optional[float] = None,
        ambient: Optional[float] = None,
        reflection: Optional[float] = None,
    ) -> None:
        """Lights the scene. light: the path of a lat-long image or a cube; three numbers, uniform radiance; "studio";
        None: what there is. rotation about +y in degrees and strength are both set where one is given (0, 1); ambient
        and reflection scale the environment's light at its first reflection by diffuse and by other lobes."""
        if isinstance(light, str) and light == "studio":
            self._change("weft_scene_set_environment_studio", log=False)
        elif light is not None and (isinstance(light, (str, bytes)) or hasattr(light, "__fspath__")):
            self._change("weft_scene_set_environment_file", path(light, "light"))
        elif light is not None:
            self._change("weft_scene_set_environment_color", (ctypes.c_float * 3)(*triple(light, "light")), log=False)
        if rotation is not None or strength is not None:
            self._change(
                "weft_scene_set_environment_placement",
                number(rotation or 0.0, "rotation"),
                number(1.0 if strength is None else strength, "strength"),
                log=False,
            )
        if ambient is not None or reflection is not None:
            self._change(
                "weft_scene_set_environment_parts",
                number(1.0 if ambient is None else ambient, "ambient"),
                number(1.0 if reflection is None else reflection, "reflection"),
                log=False,
            )

    @property
    def stage(self) -> Optional[tuple[float, float]]:
        """The floor (reflectance, roughness) that suits a scene which came with neither light nor floor; else None."""
        with self._use() as pointer:
            floor = lib.weft_scene_stage(pointer)
        return (floor.reflection, floor.roughness) if floor.on else None

    @property
    def lights(self) -> list[Light]:
        """Its lights: first those of the file, then those that were added. Copies."""
        found = []
        with self._use() as pointer:
            for k in range(lib.weft_scene_info(pointer).light_count):
                light = _abi.WeftLight()
                call("weft_scene_light", pointer, k, ctypes.byref(light))
                found.append(record(light, Light))
        return found

    def add_light(self, kind: str, **members: Any) -> None:
        """Adds a light, with the members of Light."""
        self._change("weft_scene_add_light", ctypes.byref(_light(kind=kind, **members)), log=False)

    def put_light(self, index: int, light: Union[Light, Mapping[str, Any]], **members: Any) -> None:
        """Replaces a light by index."""
        values = dict(light.as_dict() if isinstance(light, Record) else light, **members)
        self._change("weft_scene_put_light", integer(index, "index"), ctypes.byref(_light(**values)), log=False)

    def remove_light(self, index: int) -> None:
        """Removes a light by index."""
        self._change("weft_scene_remove_light", integer(index, "index"), log=False)

    def camera(self, camera: Optional[str] = None, *, aspect: float = 4 / 3) -> Camera:
        """Returns a camera in numbers: of the file by name or index, "eye;target;fov", or None, which frames the
        scene."""
        out = _abi.WeftCamera()
        with self._use() as pointer:
            call(
                "weft_scene_camera",
                pointer,
                None if camera is None else text(camera, "camera"),
                number(aspect, "aspect"),
                ctypes.byref(out),
            )
        return record(out, Camera)  # type: ignore[no-any-return]


def _light(**members: Any) -> Any:
    known = {f[0] for f in _abi.WeftLight._fields_}
    for name in members:
        if name not in known:
            raise TypeError(f"{name}: is not a member of a light; it has {', '.join(sorted(known))}")
    return fill(_abi.WeftLight(), **members)


def _owned(image: Arrays) -> Any:
    """Returns an image whose pixels the library may free."""
    source, pixels = image_given(image, "image")
    size = source.width * source.height * source.channels * (1, 2, 4)[source.type]
    memory = _libc.malloc(size)
    if not memory:
        raise MemoryError
    ctypes.memmove(memory, pixels.address, size)
    return _abi.WeftImage(source.width, source.height, source.channels, source.type, memory)


# ---- pictures


def _background(desc: Any, background: Any) -> None:
    """Sets a background by its name, or to a colour."""
    if background is None:
        return
    if isinstance(background, str):
        fill(desc, background=background)
    else:
        fill(desc, background="color", background_color=background)


def _floor(desc: Any, floor: Any) -> None:
    """Sets the floor: True, or its mirror reflectance and roughness."""
    if floor is None or floor is False:
        return
    values = [0.0, 0.0] if floor is True else triple(floor, "floor", 2)
    desc.floor.on, desc.floor.reflection, desc.floor.roughness = 1, values[0], values[1]


def _render_desc(
    *,
    width: int = 0,
    height: int = 0,
    crop: Optional[Sequence[int]] = None,
    max_depth: int = 0,
    seed: int = 0,
    threads: int = 0,
    camera: Optional[str] = None,
    background: Any = None,
    sampling: str = "mis",
    pixel_centre: bool = False,
    roulette: bool = True,
    shadows: bool = True,
    floor: Any = None,
    hide_lights: bool = False,
    halves: Union[bool, str] = False,
    first_hits: bool = False,
    noise: float = 0.0,
    stages: bool = False,
    lift: bool = True,
    record: Iterable[str] = (),
) -> Any:
    desc = fill(
        _abi.WeftRenderDesc(),
        width=width,
        height=height,
        crop=crop,
        max_depth=max_depth,
        seed=seed,
        threads=threads,
        camera=camera,
        sampling=sampling,
        pixel_centre=int(bool(pixel_centre)),
        no_roulette=int(not roulette),
        no_shadows=int(not shadows),
        hide_lights=int(bool(hide_lights)),
        halves=_halves(halves),
        first_hits=int(bool(first_hits)),
        noise=noise,
        stages=int(bool(stages)),
        no_lift=int(not lift),
    )
    _background(desc, background)
    _floor(desc, floor)
    aovs = [record] if isinstance(record, str) else list(record)
    lib.weft_render_record(ctypes.byref(desc), sum({1 << choice("WeftAov", name, "record") for name in aovs}))
    return desc


def _halves(halves: Union[bool, str]) -> int:
    """Returns how samples are divided: True is independent."""
    ways: dict[Any, str] = {True: "INDEPENDENT", "independent": "INDEPENDENT", "shared": "SHARED"}
    if not halves:
        return 0
    if halves not in ways:
        raise ValueError(f"halves: is {halves!r:.40}, and must be False, True, independent or shared")
    return _abi.CONSTANTS["WEFT_HALVES_" + ways[halves]]


class RenderInfo(Record):
    """Progress and costs: `samples_per_pixel`, `rays`, `non_finite`, `build_seconds`, `render_seconds`, and the camera:
    `camera_eye`, `camera_target`, `camera_fov`."""


class Render(Handle):
    """A path-traced picture in progress, which more samples can be added to.

    >>> with Render(scene, width=320, height=240, halves=True) as render:
    ...     render.run(64)
    ...     picture = render.image()              # shape (240, 320, 4), float32, linear

    Keyword arguments, each with a default: width and height (960 x 720); crop (x, y, width, height); max_depth (9);
    seed; threads (all); camera (None frames the scene; a name or index; "eye;target;fov"); background ("auto",
    "environment", "transparent", "blurred", or three numbers); sampling ("mis", "light", "lobe"); pixel_centre,
    roulette, shadows, lift; floor (True, or reflectance and roughness of its mirror, such as Scene.stage);
    hide_lights; halves, for noise, "variance" and denoised() (True, or "shared" where only the last needs them: the
    picture is then as without); first_hits, which denoised() needs too; record, the names of the AOVs that are wanted,
    which sets what they need; noise, the relMSE at which run() stops; stages.

    After a change of the scene the next run() begins anew. The same arguments give the same bytes, on any number of
    threads."""

    _free, _noun = "weft_render_free", "render"

    def __init__(self, scene: Scene, **options: Any) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {type(scene).__name__}")
        self._scene, self._desc = scene, _render_desc(**options)
        with scene._use() as pointer:
            made = created("weft_render_create", pointer, ctypes.byref(self._desc))
            self._revision = scene._revision
        super().__init__(made, scene)
        self._broken = False

    def _refresh(self, pointer: Any, changed: int) -> None:
        self._broken = True
        call("weft_render_restart", pointer, ctypes.byref(self._desc), changed)
        self._broken, self._revision = False, self._scene._revision

    def run(self, spp: int, *, seconds: float = 0.0, progress: Progress = None) -> bool:
        """Adds up to spp samples to every pixel; stops early after so many seconds (0: no limit), or when progress,
        called with the finished fraction, returns True. Returns False where progress stopped it. The samples are kept,
        after Ctrl+C too."""
        spp, seconds = integer(spp, "spp", 1), number(seconds, "seconds")
        with self._use(alone=True) as pointer, self._scene._use():
            if self._broken or self._revision != self._scene._revision:
                self._refresh(pointer, _ALL_CHANGED)
            with Watch(progress) as watch:
                result: int = lib.weft_render_run(pointer, spp, seconds, watch.callback, None)
        if result not in (OK, INTERRUPTED):
            raise Error("the render failed", result)
        return result == OK

    def restart(self, **options: Any) -> None:
        """Discards all samples, and takes other options."""
        desc = _render_desc(**options)
        with self._use(alone=True) as pointer, self._scene._use():
            self._desc = desc
            changed = _ALL_CHANGED if self._broken or self._revision != self._scene._revision else 0
            self._refresh(pointer, changed)

    def _read(self, name: str, *arguments: Any) -> Array:
        image = _abi.WeftImage()
        with self._use(alone=True) as pointer:
            if self._broken:
                raise RuntimeError("the render could not be restarted: run it, or restart it with other options")
            call(name, pointer, *arguments, ctypes.byref(image))
        return taken(image)

    def image(self) -> Array:
        """Returns the picture so far: shape (height, width, 4), float32, linear, straight alpha."""
        return self._read("weft_render_image")

    def aov(self, name: str) -> Array:
        """Returns what was recorded: "albedo", "normal", "depth" (m), "variance", "position" (m), "uv", "object" or
        "material" (id and coverage of the first two, as a Cryptomatte), each with the channels last; or "samples"."""
        return self._read("weft_render_aov", choice("WeftAov", name, "name"))

    def denoised(self, denoiser: str = "regression") -> Array:
        """Returns the picture without most of its noise, to look at, never to measure. Needs halves and first_hits."""
        return self._read("weft_render_denoised", choice("WeftDenoiser", denoiser, "denoiser"))

    @property
    def noise(self) -> Optional[float]:
        """The estimated relMSE against a converged picture; None without halves or enough samples."""
        with self._use(alone=True) as pointer:
            found: float = lib.weft_render_noise(pointer)
        return found if found >= 0.0 else None

    @property
    def info(self) -> RenderInfo:
        """Its progress and costs."""
        with self._use(alone=True) as pointer:
            return record(lib.weft_render_info(pointer), RenderInfo)  # type: ignore[no-any-return]

    @property
    def stages(self) -> list[Record]:
        """`name`, `seconds` of all threads and `embree` of each stage; seconds are 0 without stages=True."""
        found: list[Record] = []
        out = _abi.WeftRenderStage()
        with self._use(alone=True) as pointer:
            while lib.weft_render_stage(pointer, len(found), ctypes.byref(out)):
                found.append(record(out))
        return found


def turned_camera(eye: Sequence[float], target: Sequence[float], fov: float, index: int, count: int) -> str:
    """Returns the camera of picture `index` of `count` on a circle about the vertical through target, from that of eye
    and target, m, and the vertical fov, degrees."""
    out = ctypes.create_string_buffer(_abi.CONSTANTS["WEFT_CAMERA_TEXT"])
    lib.weft_camera_rotated(
        (ctypes.c_float * 3)(*triple(eye, "eye")),
        (ctypes.c_float * 3)(*triple(target, "target")),
        number(fov, "fov"),
        integer(index, "index"),
        integer(count, "count", 1),
        out,
    )
    return out.value.decode()


def _scene(scene: Union[Scene, PathLike]) -> tuple[Scene, bool]:
    return (scene, False) if isinstance(scene, Scene) else (Scene(scene), True)


def render(
    scene: Union[Scene, PathLike] = "builtin:cloth",
    spp: int = 64,
    *,
    seconds: float = 0.0,
    aovs: Iterable[str] = (),
    denoise: Optional[str] = None,
    progress: Progress = None,
    **options: Any,
) -> Any:
    """Path traces a scene, or the file of one, and returns the picture, shape (height, width, 4), float32, linear;
    with aovs a pair of it and a dict of them by name. Options are those of Render; denoise: "regression" or "oidn".
    Where progress stops it, what there is is returned."""
    wanted = [aovs] if isinstance(aovs, str) else list(aovs)
    for name in wanted:
        choice("WeftAov", name, "aovs")
    options["record"] = wanted
    if denoise:
        options["first_hits"] = True
    if options.get("noise"):
        options["halves"] = True
    elif denoise and "variance" not in wanted:
        options.setdefault("halves", "shared")
    loaded, mine = _scene(scene)
    try:
        with Render(loaded, **options) as picture:
            picture.run(spp, seconds=seconds, progress=progress)
            image = picture.denoised(denoise) if denoise else picture.image()
            return (image, {name: picture.aov(name) for name in wanted}) if wanted else image
    finally:
        if mine:
            loaded.close()


class RasterInfo(Record):
    """The state of a raster: `driver`, `programs`, `compiled`, `samples`, `compile_seconds`, `complaint` and others of
    include/weft/raster.h."""


class Raster(Handle):
    """A scene uploaded to OpenGL, in a context of its own. Takes up changes of the scene at the next picture.

    shader_dir: a folder whose files replace the library's shader text; occlusion: rays a vertex, traced for its
    visibility of the sky; es: OpenGL ES 3.0; cache: of the user's folder; threads: 0: all."""

    _free, _noun = "weft_raster_free", "raster"

    def __init__(
        self,
        scene: Scene,
        *,
        shader_dir: Optional[PathLike] = None,
        threads: int = 0,
        occlusion: int = 0,
        es: bool = False,
        cache: bool = True,
        progress: Progress = None,
    ) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {type(scene).__name__}")
        desc = fill(
            _abi.WeftRasterDesc(),
            gl="es" if es else "desktop",
            threads=threads,
            occlusion=occlusion,
            no_cache=int(not cache),
        )
        if shader_dir is not None:
            desc.shader_dir = path(shader_dir, "shader_dir")
        self._scene, self._watch = scene, Watch(progress)
        desc.progress = self._watch.callback
        with scene._use() as pointer, self._watch:
            super().__init__(created("weft_raster_create", pointer, ctypes.byref(desc), free=self._free), scene)
            self._revision = scene._revision

    def draw(
        self,
        *,
        width: int = 0,
        height: int = 0,
        samples: int = 0,
        camera: Optional[str] = None,
        background: Any = None,
        ambient: str = "best",
        polygons: int = 0,
        shadows: bool = True,
        part: str = "all",
        crop: Optional[Sequence[int]] = None,
        plain_textures: bool = False,
        floor: Any = None,
        hide_lights: bool = False,
        wait: bool = True,
        frames: int = 0,
    ) -> Array:
        """Draws a picture: shape (height, width, 4), float32, linear. part: "all", "diffuse", "sheen", "normal" and so
        on; ambient: "best", "irradiance", "mirror", "fitted", "none"; samples a pixel 1 to 8; wait: for occlusion;
        frames: the mean of so many frames with random samples of the light, which converges to the path tracer's
        direct light."""
        frames = integer(frames, "frames", 0, _abi.CONSTANTS["WEFT_RASTER_FRAMES_MOST"])
        view = fill(
            _abi.WeftRasterView(),
            width=width,
            height=height,
            samples=samples,
            camera=camera,
            ambient=ambient,
            polygons=polygons,
            no_shadows=int(not shadows),
            part=part,
            crop=crop,
            plain_textures=int(bool(plain_textures)),
            hide_lights=int(bool(hide_lights)),
        )
        _background(view, background)
        _floor(view, floor)
        image = _abi.WeftImage()
        with self._use(alone=True) as pointer, self._scene._use(), self._watch:
            if self._revision != self._scene._revision:
                logged("weft_raster_update", pointer)
                self._revision = self._scene._revision
            if wait:
                call("weft_raster_wait", pointer)
            if frames:
                self._accumulate(pointer, view, frames)
            else:
                call("weft_raster_draw", pointer, ctypes.byref(view))
            call("weft_raster_image", pointer, ctypes.byref(image))
        return taken(image)

    @staticmethod
    def _accumulate(pointer: Any, view: Any, frames: int) -> None:
        """Draws frames, a tenth of a second a call, so that Ctrl+C is heard between two."""
        done = ctypes.c_int()
        call("weft_raster_accumulate_begin", pointer, ctypes.byref(view), frames)
        while done.value < frames:
            call("weft_raster_accumulate", pointer, 0.1, ctypes.byref(done))

    @property
    def info(self) -> RasterInfo:
        """Its state."""
        with self._use(alone=True) as pointer:
            return record(lib.weft_raster_info(pointer), RasterInfo)  # type: ignore[no-any-return]


def raster(scene: Union[Scene, PathLike] = "builtin:cloth", **options: Any) -> Array:
    """Draws a scene, or the file of one, by OpenGL, and returns the picture; options are those of Raster.draw."""
    loaded, mine = _scene(scene)
    try:
        with Raster(loaded) as drawn:
            picture: Array = drawn.draw(**options)
            return picture
    finally:
        if mine:
            loaded.close()


class Picked(Record):
    """A point of a surface: `mesh`, `material`, `position`, `normal`, `tangent`, `bitangent`, `texcoord`, `distance`
    (m), `uv_per_metre`."""


class Picker(Handle):
    """Finds what is under a pixel. Keeps the shapes of the moment when it was made."""

    _free, _noun = "weft_pick_free", "picker"

    def __init__(self, scene: Scene) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {type(scene).__name__}")
        self._scene = scene
        with scene._use() as pointer:
            made = created("weft_pick_create", pointer)
        super().__init__(made, scene)

    def at(self, x: float, y: float, *, width: int, height: int, camera: Optional[str] = None) -> Optional[Picked]:
        """Returns the surface at a point of a picture of that size, pixels from the top left; None where there is
        none."""
        out, where = _abi.WeftPicked(), None if camera is None else text(camera, "camera")
        with self._use(alone=True) as pointer, self._scene._use():
            hit = lib.weft_pick_at(
                pointer,
                where,
                integer(width, "width", 1, 65536),
                integer(height, "height", 1, 65536),
                number(x, "x"),
                number(y, "y"),
                ctypes.byref(out),
            )
        return record(out, Picked) if hit else None


__all__ = [
    "Camera",
    "Light",
    "Picked",
    "Picker",
    "Raster",
    "RasterInfo",
    "Render",
    "RenderInfo",
    "Scene",
    "SceneInfo",
    "raster",
    "render",
    "turned_camera",
]
