"""Scenes, pictures and their differences; the doctor; memory that is freed at the right time."""
import gc
import json
import os
import signal
import threading
import time
import warnings

import pytest
from conftest import close, listed

import weft
from weft import _library as library

SMALL = dict(width=48, height=36)


def mean(picture):
    """Returns the mean of each channel."""
    rows = listed(picture)
    pixels = [p for row in rows for p in row]
    return [sum(p[c] for p in pixels) / len(pixels) for c in range(len(pixels[0]))]


def test_a_picture_is_an_array_and_the_same_twice(cloth):
    first, second = weft.render(cloth, 4, **SMALL), weft.render(cloth, 4, threads=1, **SMALL)
    assert tuple(first.shape) == (36, 48, 4) and listed(first) == listed(second)
    assert listed(weft.render(cloth, 4, seed=1, **SMALL)) != listed(first)
    assert tuple(weft.render(cloth, 1, crop=(8, 4, 16, 12), **SMALL).shape) == (12, 16, 4)


def test_other_pictures_come_beside_it(cloth):
    picture, others = weft.render(cloth, 4, aovs=["albedo", "normal", "depth", "variance", "samples"], **SMALL)
    assert {n: tuple(a.shape) for n, a in others.items()} == {
        "albedo": (36, 48, 3),
        "normal": (36, 48, 3),
        "depth": (36, 48),
        "variance": (36, 48, 3),
        "samples": (36, 48),
    }
    assert all(s == 4 for row in listed(others["samples"]) for s in row)
    with weft.Render(cloth, record=["position", "uv", "object"], **SMALL) as render:
        render.run(2)
        shapes = [tuple(render.aov(n).shape) for n in ("position", "uv", "object", "albedo")]
        assert shapes == [(36, 48, 3), (36, 48, 2), (36, 48, 4), (36, 48, 3)]
        with pytest.raises(weft.Error):
            render.aov("variance")
    turned = weft.turned_camera((0, 1, 3), (0, 1, 0), 40, 1, 4)
    assert close(list(cloth.camera(turned).eye), [3, 1, 0], 1e-4)
    with pytest.raises(ValueError, match="aovs"):
        weft.render(cloth, 1, aovs="beauty", **SMALL)
    assert tuple(weft.render(cloth, 8, denoise="regression", **SMALL).shape) == (36, 48, 4)
    with pytest.raises(ValueError, match="halves"):
        weft.render(cloth, 1, halves="thirds", **SMALL)


def test_samples_are_added_and_a_change_begins_anew():
    scene = weft.Scene()
    with weft.Render(scene, halves=True, **SMALL) as render:
        assert render.noise is None and render.run(4) and render.run(4)
        assert render.info.samples_per_pixel == 8.0 and render.noise > 0
        before = mean(render.image())
        scene.set("*.base_color", 0.02)
        assert render.run(8) and render.info.samples_per_pixel == 8.0
        assert mean(render.image())[0] < before[0]
        render.restart(width=16, height=8)
        assert render.run(1) and tuple(render.image().shape) == (8, 16, 4)
        with pytest.raises(weft.Error):
            render.restart(camera="nobody")
        with pytest.raises(RuntimeError, match="could not be restarted"):
            render.image()
        render.restart(width=16, height=8)
        assert render.run(1)


def test_progress_is_called_and_stops_a_render(cloth):
    calls = []
    with weft.Render(cloth, **SMALL) as render:
        assert render.run(10**6, progress=lambda fraction: calls.append(fraction) or len(calls) > 2) is False
        assert calls and all(0 <= c <= 1 for c in calls)
        assert tuple(render.image().shape) == (36, 48, 4)
        with pytest.raises(RuntimeError, match="is in use"):
            render.run(10**6, progress=lambda fraction: render.image())
        with pytest.raises(TypeError, match="progress"):
            render.run(1, progress=3)


def test_ctrl_c_stops_a_render_and_keeps_its_samples(cloth):
    with weft.Render(cloth, width=160, height=120) as render:
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            render.run(10**8)
        assert time.monotonic() - start < 60
        assert render.info.samples_per_pixel > 0
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_other_threads_run_during_a_render(cloth):
    done = threading.Event()
    with weft.Render(cloth, width=160, height=120) as render:
        worker = threading.Thread(target=lambda: (render.run(10**8, progress=lambda fraction: done.is_set())))
        worker.start()
        time.sleep(0.2)
        with pytest.raises(RuntimeError, match="is in use"):
            render.image()
        render.close()  # freed when the call has returned
        done.set()
        worker.join()
    with pytest.raises(ValueError, match="the render is closed"):
        render.image()


def test_a_scene_lives_as_long_as_its_pictures():
    render = weft.Render(weft.Scene(), **SMALL)
    gc.collect()
    assert render.run(1)
    scene = weft.Scene()
    other = weft.Render(scene, **SMALL)
    scene.close()
    with pytest.raises(ValueError, match="the scene is closed"):
        other.run(1)
    with pytest.raises(ValueError, match="the scene is closed"):
        scene.info
    other.close()
    other.close()
    for handle in (weft.Scene(), weft.Draft("plain"), weft.Reflection("lambert")):
        with handle:
            pass
        assert handle.closed
        with pytest.raises(ValueError):
            handle.__enter__()
        with pytest.raises(TypeError, match="cannot be copied"):
            __import__("copy").copy(handle)


def test_a_scene_is_not_changed_while_it_is_read(cloth):
    scene = weft.Scene()
    with weft.Render(scene, **SMALL) as render:
        with pytest.raises(RuntimeError, match="the scene is in use"):
            render.run(10**6, progress=lambda fraction: scene.set("*.roughness", 0.5))


def test_materials_lights_and_cameras_are_read_and_put():
    scene = weft.Scene()
    assert scene.used("Cloth") and scene.stage is None
    assert scene.materials[0] == "Cloth" and scene.info.material_count == len(scene.materials)
    material = scene.material("Cloth")
    material["base_color"] = (0.5, 0.1, 0.1)
    scene.put_material("Cloth", material)
    assert scene.material(0)["base_color"] == (0.5, 0.1, 0.1)
    scene.add_light("point", position=(0, 2, 0), color=(5, 5, 5))
    scene.put_light(0, scene.lights[0], color=(1, 2, 3))
    assert scene.lights[0].color == (1.0, 2.0, 3.0) and scene.lights[0].kind == "point"
    scene.remove_light(0)
    assert scene.lights == []
    for wrong in (lambda: scene.add_light("sun"), lambda: scene.put_light(4, {"kind": "point"})):
        with pytest.raises((ValueError, weft.Error)):
            wrong()
    with pytest.raises(TypeError, match="glow: is not a member"):
        scene.add_light("point", glow=1)
    with pytest.raises(ValueError, match="is not a material of this scene"):
        scene.material("Glass")
    with pytest.raises(weft.Error):
        scene.material(99)
    camera = scene.camera("0,1,3;0,1,0;40")
    assert close(list(camera.eye), [0, 1, 3]) and close(camera.fov, 40, 1e-4)
    before = scene.hash
    assert before == scene.hash
    scene.assign("preset:velvet")
    assert before != scene.hash
    scene.set_environment((1, 1, 1), rotation=90, strength=2)
    scene.set_environment("studio", ambient=0.5)
    with pytest.raises(weft.Error):
        scene.set_environment("no-such.hdr")
    picker = weft.Picker(scene)
    hit = picker.at(24, 18, **SMALL)
    assert hit is None or scene.materials[hit.material] is not None


def test_textures_are_arrays(tmp_path):
    scene = weft.Scene()
    picture = weft.tonemap(weft.render(scene, 1, width=16, height=8))
    weft.write_image(tmp_path / "map.png", picture)
    scene.set_texture("Cloth.base_color", tmp_path / "map.png")
    number = scene.material("Cloth").texture("base_color")
    assert number > 0 and listed(scene.texture(number)) == listed(picture)
    assert scene.texture(99) is None and scene.add_texture(picture) > number
    scene.put_texture(number, picture)
    with pytest.raises(weft.Error):
        scene.put_texture(99, picture)


def test_a_woven_material_has_its_cloth():
    scene = weft.Scene("builtin:loom")
    woven = [k for k in range(len(scene.materials)) if scene.weave(k)]
    draft, yarns, info = scene.weave(woven[0])
    assert draft.info.count[0] > 0 and len(yarns) == 2 and info.size[0] > 0
    material = scene.material(woven[0])
    assert material.cloth is not None and weft.Reflection(material).albedo(0.5) is not None
    scene.set_weave(woven[0], "plain", ("wool", "wool"))
    assert scene.weave(woven[0])[0].info.count == (2, 2)
    scene.set_weave_key("warp", "silk", scene.materials[woven[0]] or str(woven[0]))
    assert '"draft"' in scene.weave_text(woven[0])


def test_images_are_written_and_read(tmp_path):
    picture = weft.render(spp=1, **SMALL)
    weft.write_image(tmp_path / "a.exr", picture, single=True, layers={"depth": weft.to_linear(picture)})
    assert close(listed(weft.read_image(tmp_path / "a.exr")), listed(picture), 1e-5)
    assert listed(weft.read_channels(tmp_path / "a.exr", ["depth.R", "depth.A"])) == [
        [[p[0], p[3]] for p in row] for row in listed(picture)
    ]
    with pytest.raises(weft.Error, match="it has no channel Z"):
        weft.read_channels(tmp_path / "a.exr", ["Z"])
    warm, metered = weft.tonemap(picture, white=3000), weft.tonemap(picture, "agx", exposure="auto", white="auto")
    assert mean(warm)[2] > mean(weft.tonemap(picture))[2] and tuple(metered.shape) == (36, 48, 4)
    for wrong in (900, "noon", (1, 2, 3)):
        with pytest.raises(ValueError, match="white"):
            weft.tonemap(picture, white=wrong)
    shown = weft.tonemap(picture, background=(1, 1, 1), exposure=1)
    weft.write_image(tmp_path / "a.png", shown, comment="a test")
    assert listed(weft.read_image(tmp_path / "a.png")) == listed(shown)
    assert listed(weft.read_image((tmp_path / "a.png").read_bytes())) == listed(shown)
    with pytest.raises(weft.Error, match="is not an image"):
        weft.read_image(b"nothing of the kind")
    with pytest.raises(weft.Error, match="suffix"):
        weft.write_image(tmp_path / "a.gif", shown)
    with pytest.raises(weft.Error):
        weft.write_image(tmp_path / "b.png", picture)


def test_differences_are_measured():
    a, b = weft.render(spp=1, **SMALL), weft.render(spp=16, **SMALL)
    for metric, equal in (("relmse", 0.0), ("flip", 0.0), ("ssim", 1.0)):
        same, other = weft.diff(b, b, metric), weft.diff(a, b, metric)
        assert abs(same.value - equal) < 1e-6 and abs(other.value - equal) > abs(same.value - equal)
        assert tuple(other.map.shape) == (36, 48) and 0 <= other.beyond(0.5) <= 1
    assert tuple(weft.heat_image(other.map, 1.0, 0.0).shape) == (36, 48, 3)
    assert tuple(weft.difference_image(a, b, 0.5).shape) == (36, 48, 3)
    shown = weft.tonemap(a)
    assert weft.sheet([shown, shown], ["one", "two"], caption="both").shape[1] > 96
    with pytest.raises(ValueError, match="pixels"):
        weft.diff(a, weft.render(spp=1, width=8, height=8))


def test_the_doctor_finds_and_mends(tmp_path):
    scene = weft.Scene()
    scene.save(tmp_path / "cloth.glb")
    text = (tmp_path / "cloth.glb").read_bytes()
    with weft.Doctor(tmp_path / "cloth.glb") as doctor:
        kinds = [f.kind for f in doctor.findings]
        assert doctor.info.material_count == 4
    assert [f.kind for f in weft.doctor(text)] == kinds
    scene.save(tmp_path / "cloth.gltf")
    broken = (tmp_path / "cloth.gltf").read_text().replace('"roughnessFactor"', '"roughnessFactor": 7, "x"', 1)
    (tmp_path / "cloth.gltf").write_text(broken)
    with weft.Doctor(tmp_path / "cloth.gltf") as doctor:
        finding = next(f for f in doctor.findings if f.kind == "value-range")
        assert finding.severity == "error" and finding.fixable and finding.place.startswith("/materials")
        doctor.fix(tmp_path / "mended.glb")
    assert "value-range" not in [f.kind for f in weft.doctor(tmp_path / "mended.glb")]
    assert weft.finding_kinds()["sheen-gains"].severity == "warning"
    with pytest.raises(weft.Error):
        weft.doctor(b"{}")


def test_opengl_draws_the_scene(cloth):
    try:
        drawn = weft.Raster(weft.Scene())
    except weft.Error as error:
        if error.message in ("gl-context", "gl-memory"):
            pytest.skip(str(error))
        raise
    with drawn:
        picture = drawn.draw(**SMALL)
        assert tuple(picture.shape) == (36, 48, 4) and drawn.info.driver
        drawn._scene.set("*.base_color", 0.02)
        assert mean(drawn.draw(**SMALL))[0] < mean(picture)[0]
        with pytest.raises(weft.Error):
            drawn.draw(width=-1)
        lit, traced = drawn.draw(frames=16, **SMALL), weft.render(drawn._scene, 64, max_depth=1, **SMALL)
        assert close(mean(lit), mean(traced), 0.05)
        with pytest.raises(ValueError, match="frames"):
            drawn.draw(frames=-1)


def handles_freed(monkeypatch, name):
    """Counts the calls of a function that frees."""
    calls, real = [], getattr(library.lib, name)
    monkeypatch.setattr(library.lib, name, lambda *arguments: (calls.append(1), real(*arguments))[1])
    return calls


def glossy(tmp_path):
    """Writes a scene with a roughness that is clamped with a warning."""
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 7}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [
            {
                "byteLength": 36,
                "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA",
            }
        ],
    }
    file = tmp_path / "glossy.gltf"
    file.write_text(json.dumps(document))
    return file


def test_what_a_call_made_is_freed_where_a_warning_is_an_exception(tmp_path, monkeypatch):
    freed, file = handles_freed(monkeypatch, "weft_scene_free"), glossy(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for source in (file, file.read_bytes()):
            with pytest.raises(weft.WeftWarning):
                weft.Scene(source)
    gc.collect()
    assert len(freed) == 2
    with pytest.warns(weft.WeftWarning):
        weft.Scene(file).close()
    assert len(freed) == 3
