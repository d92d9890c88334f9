"""Materials, reflections, passports, matches, fits, tables, exports and figures."""
import pytest
from conftest import close, directions, listed

import weft

WI = directions(30)
UP, ASIDE = [0.0, 0.0, 1.0], [0.6, 0.0, 0.8]


def test_a_material_is_read_and_set_by_name():
    velvet = weft.Material("preset:velvet", profile="three")
    assert velvet["profile"] == "three" and velvet["sheen_roughness"] == 0.35 and len(velvet["base_color"]) == 3
    velvet["sheen_color"] = (1.0, 0.5, 0.25)
    assert velvet["sheen_color"] == (1.0, 0.5, 0.25)
    assert velvet.reads("sheen_roughness")
    velvet["sheen_color"] = 0
    assert not velvet.reads("sheen_roughness")
    with pytest.raises(weft.Error, match="is not a parameter"):
        velvet["shine"] = 1
    with pytest.raises(KeyError):
        velvet["shine"]
    assert velvet.copy() == velvet and "profile='three'" in repr(velvet)
    assert "auto" == weft.Material()["profile"] and "three" in weft.material_choices()["profile"]
    assert weft.material_inputs()["roughness"].high == 1.0


def test_a_reflection_of_a_lobe_is_that_lobe():
    lobe = weft.Lobe("charlie-neubelt", alpha=0.4)
    with weft.Reflection(lobe) as reflection:
        assert close(listed(reflection.eval(ASIDE, WI)), listed(lobe.eval(ASIDE, WI)), 1e-4)
        assert close(listed(reflection.eval([ASIDE] * 30, WI)), listed(lobe.eval(ASIDE, WI)), 1e-4)
        assert close(listed(reflection.albedo([0.5, 1.0])), listed(lobe.albedo([0.5, 1.0])), 1e-4)
        assert reflection.difference(lobe) == 0.0
    with pytest.raises(ValueError, match="the reflection is closed"):
        reflection.albedo(1.0)


def test_parts_of_a_material_sum_to_it():
    with weft.Reflection("khronos") as cloth:
        parts = [listed(cloth.eval(ASIDE, WI, part=p)) for p in ("diffuse", "specular", "sheen", "coat", "dust")]
        whole = listed(cloth.eval(ASIDE, WI))
    assert close([[sum(p[k][c] for p in parts) for c in range(3)] for k in range(30)], whole, 1e-5)


def test_a_measurement_is_written_read_and_fitted(tmp_path):
    file = tmp_path / "ggx.bsdf"
    lobe = weft.Lobe("ggx", alpha=0.5)
    weft.Reflection(lobe).write(file, thetas=16, side=24)
    assert weft.Reflection(str(file)).difference(lobe) < 0.05
    data = weft.Data(file)
    assert 0 < len(data) <= data.read and data.distance(lobe) < 0.05
    assert len(listed(data.samples()[2])) == len(data)


def test_a_fit_finds_the_lobe_that_made_the_data():
    wo, wi = directions(400, 3), directions(400, 4)
    lobe = weft.Lobe("charlie-neubelt", alpha=0.3, color=(0.3, 0.2, 0.1))
    data = weft.Data.of_pairs(wo, wi, lobe.eval(wo, wi), isotropic=True)
    calls = []
    fit = data.fit(base="lambert", only="charlie-neubelt", progress=lambda fraction: calls.append(fraction))
    best = fit.fitted[0]
    assert best.lobe.id == "charlie-neubelt" and best.error < 0.01 and abs(best.lobe["alpha"] - 0.3) < 0.01
    assert fit.baseline.lobe.id == "ggx" and fit.base_alone > best.error and not best.weave
    assert best.reflection().difference(lobe) < 0.02
    assert all(0 <= c <= 1 for c in calls)


def test_a_match_comes_closer_than_a_copy():
    found = weft.match("charlie-neubelt", weft.Lobe("ggx"), "cosine")
    assert found.matched < found.copied and found.model.id == "ggx"
    assert abs(weft.distance(found.model, "charlie-neubelt") - found.matched) < 1e-6
    held = weft.match("charlie-neubelt", weft.Lobe("ggx", alpha=0.2), hold=["alpha", "color"])
    assert held.model["alpha"] == 0.2 and held.model.color == (1.0, 1.0, 1.0)
    cloth = weft.match("khronos", weft.Material.of_profile("three"), "picture", hold="base_color")
    assert cloth.matched <= cloth.copied and cloth.model["base_color"] == (0.2, 0.2, 0.2)
    with pytest.raises(ValueError, match="hold: shine"):
        weft.match("ggx", weft.Lobe("ggx"), hold=["shine"])


def test_a_match_that_progress_stops_is_an_error():
    with pytest.raises(weft.Error, match="stopped by progress") as failure:
        weft.bake("albedo", "charlie-conty-kulla", width=64, height=64, progress=lambda fraction: True)
    assert failure.value.code == 130
    with pytest.raises(ZeroDivisionError):
        weft.bake("albedo", "charlie-conty-kulla", width=64, height=64, progress=lambda fraction: 1 / 0)


def test_a_passport_shows_the_light_from_nothing():
    passport = weft.passport("charlie-neubelt", quick=True)
    assert passport.rows == len(passport.values) and passport.albedo_most > 1.5 and passport.reciprocity < 1e-3
    assert tuple(passport.albedo.shape) == (passport.rows, 21) and 0.0 <= passport.significance <= 1.0
    assert len(passport.furnace) == passport.layers
    held = weft.passport(weft.Lobe("ggx"), quick=True, brief=True)
    assert held.albedo_most <= 1.01


def test_a_baked_table_passes_its_audit():
    table = weft.bake("albedo", "charlie-neubelt", width=8, height=8, axes="cos,alpha,centres")
    assert tuple(table.texels.shape) == (8, 8) and table.axes.startswith("cos,alpha")
    audit = weft.audit(table.texels, "charlie-neubelt", axes="cos,alpha,centres")
    assert [f.fault for f in audit.found] == ["none"] and audit.lobe == "charlie-neubelt" and audit.fits
    cosines, values = weft.table_axes("cos,alpha,centres", "charlie-neubelt", 8, 8)
    assert close(listed(cosines)[0], [(k + 0.5) / 8 for k in range(8)])
    e = weft.Lobe("charlie-neubelt", alpha=listed(values)[5][0]).albedo(listed(cosines)[5])
    assert close([c[0] for c in listed(e)], listed(table.texels)[5], 2e-4)
    other = weft.audit(table.texels, "ggx")
    assert other.found[0].fault != "none"
    assert "filament" in weft.table_forms() and "dfg" in [k.id for k in weft.bake_kinds()]


def test_a_closed_form_is_near_the_albedo():
    lobe = weft.Lobe("charlie-neubelt")
    form = weft.bake_form(lobe, lowest=0.4)
    lobe["roughness"] = 0.7
    assert form.error < 0.01 and abs(form.at(0.5, 0.7) - listed(lobe.albedo(0.5))[0]) <= 0.011


def test_linearly_transformed_cosines_integrate_to_one():
    with weft.Ltc("ggx", rows=4, columns=4, cache=False) as table:
        assert tuple(table.channel("z").shape) == (4, 4) and len(table.cosines) == len(table.values) == 4
        lobe = table.at(0.8, 0.5)
        assert lobe.z > 0 and len(listed(lobe.inverse(ASIDE))) == 3
        density = listed(lobe.pdf(ASIDE, WI))
        wi, pdf = lobe.sample(ASIDE, [0.3, 0.6])
        assert close(listed(lobe.pdf(ASIDE, [listed(wi)])), [pdf], 1e-3)
        assert len(density) == 30 and min(density) >= 0
        with pytest.raises(ValueError, match="must be one of z, q"):
            table.channel("x")


@pytest.mark.parametrize("target, words", [("glsl", "vec3"), ("hlsl", "float3"), ("c", "#include"), ("wgsl", "fn ")])
def test_an_export_is_text_of_its_language(target, words):
    assert words in weft.export(["charlie-neubelt", "khronos"] if target != "c" else "ggx", target).text
    tabled = weft.export("charlie-neubelt", target, albedo=True, lut="npy")
    assert all(len(t.texels.shape) == 2 for t in tabled.tables)


def test_a_figure_has_numbers_and_a_picture(tmp_path):
    data = weft.plot_data("cartesian", ["charlie-neubelt", weft.Lobe("ggx", alpha=0.5)], quick=True, views=[45])
    assert data.legend and data.panels[0].series[0].name in data.legend
    assert len(data.panels[0].series[0].x) == len(data.panels[0].series[0].y) > 10
    image = weft.plot("polar", "charlie-neubelt", quick=True)
    assert len(image.shape) == 3 and image.shape[2] == 3
    weft.plot("polar", "charlie-neubelt", tmp_path / "polar.svg", quick=True)
    assert (tmp_path / "polar.svg").read_text().startswith("<?xml")


def test_the_catalogue_has_a_line_on_everything():
    for found in (
        weft.terms("d"),
        weft.layers(),
        weft.workflows(),
        weft.profiles(),
        weft.presets(),
        weft.builtins(),
        weft.aliases(),
        weft.yarns(),
        weft.weaves(),
        weft.preset_groups(),
    ):
        assert found and all(found.values())
    assert '"sheen_color"' in weft.preset_text("velvet")
    with pytest.raises(ValueError, match="must be one of"):
        weft.preset_text("felt-of-lead")
    assert any(e.kind == "metal" and e.name == "gold" for e in weft.chart())
    assert weft.catalogue_text("lobes/ggx.h").startswith("/* ggx")
    with pytest.raises(KeyError):
        weft.catalogue_text("lobes/none.h")
    assert weft.version().count(".") == 2 and weft.isa() in ("sse2", "avx2", "avx512")


def test_a_draft_is_woven():
    draft = weft.Draft("twill 2/2 z")
    assert draft.info.count == (4, 4) and sum(map(sum, listed(draft.up))) == 8
    back = draft.back()
    assert sum(map(sum, listed(back.up))) == 8 and len(draft.threads("warp")) == 4
    changed = draft.copy()
    changed.set_up(0, 0, not listed(draft.up)[0][0])
    assert listed(changed.up) != listed(draft.up)
    changed.set_sett("weft", 2000.0)
    assert abs(changed.threads("weft")[0].spacing - 0.0005) < 1e-6
    cloth = weft.Cloth(draft, (weft.Yarn("silk", crimp=0.2), "wool"), seed=7)
    assert tuple(cloth.draw(32, 4).shape) == (32, 32, 3) and abs(sum(cloth.info.share) - 1) < 0.2
    with pytest.raises(weft.Error):
        weft.Cloth(draft, weft.Yarn("silk", crimp=99.0))
    with pytest.raises(KeyError):
        weft.Yarn("silk", sparkle=1)
    assert "crimp" in weft.Yarn.numbers() and "silk" in weft.yarns()


def test_a_draft_is_written_and_read(tmp_path):
    weft.Draft("satin 5/2").write(tmp_path / "satin.wif")
    assert listed(weft.Draft(tmp_path / "satin.wif").up) == listed(weft.Draft("satin 5/2").up)
    assert listed(weft.Draft((tmp_path / "satin.wif").read_bytes()).up) == listed(weft.parse_draft("satin 5/2").up)
