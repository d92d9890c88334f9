/* Materials as plain numbers: out and back without a change, refusals, and what of them has any influence. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/steady_clock.h"
#include "scene/material/material_numbers.h"
#include "scene/record/scene.h"
#include "shading/material/choice.h"
#include "weft/weft.h"

static WeftScene *load(const char *name) {
    WeftScene *scene = NULL;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static int input_of(const char *name) {
    int k = weft_material_input_find(name);
    assert_true(k >= 0);
    return k;
}

static WeftMaterial plain(void) {
    WeftScene *scene = load("builtin:spheres");
    WeftMaterial material;
    WeftError error;
    scene->materials[0] = material_default();
    assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
    weft_scene_free(scene);
    return material;
}

static void set_choice(WeftMaterial *material, const char *choice, const char *id) {
    for (int k = 0; weft_material_choice_name(k); k++)
        if (strcmp(weft_material_choice_name(k), choice) == 0)
            for (int v = 0; weft_material_choice_value(k, v); v++)
                if (strcmp(weft_material_choice_value(k, v), id) == 0) {
                    weft_material_choose(material, k, v);
                    return;
                }
    fail_msg("%s=%s", choice, id);
}

static void set_value(WeftMaterial *material, const char *input, float value) {
    for (int c = 0; c < 3; c++) material->inputs[input_of(input)].value[c] = value;
}

static void input_infos_are_those_of_the_table(void **state) {
    (void)state;
    WeftInputInfo info;
    for (int k = 0; k < INPUT_COUNT; k++) {
        assert_true(weft_material_input_info(k, &info));
        assert_string_equal(info.name, weft_material_input_name(k));
        assert_true(strlen(weft_material_input_label(k)) > 0);
        assert_true(info.hard_low <= info.low && info.low < info.high && info.high <= info.hard_high);
    }
    assert_false(weft_material_input_info(INPUT_COUNT, &info));
    assert_null(weft_material_input_label(INPUT_COUNT));
    assert_false(weft_material_input_info(-1, &info));
}

static void number_that_is_set_is_read_back(void **state) {
    (void)state;
    WeftError error;
    for (int k = 0; weft_builtin_name(k); k++) {
        char path[64];
        snprintf(path, sizeof path, "builtin:%s", weft_builtin_name(k));
        WeftScene *scene = load(path);
        for (int m = 0; m < scene->material_count; m++) {
            WeftMaterial before, after;
            assert_int_equal(weft_scene_material(scene, m, &before, &error), WEFT_OK);
            assert_int_equal(weft_scene_put_material(scene, m, &before, &error), WEFT_OK);
            assert_int_equal(weft_scene_material(scene, m, &after, &error), WEFT_OK);
            assert_memory_equal(&before, &after, sizeof before);
        }
        weft_scene_free(scene);
    }
}

static void impossible_numbers_are_refused(void **state) {
    (void)state;
    WeftScene *scene = load("builtin:cloth");
    WeftMaterial good, bad, now;
    WeftError error;
    assert_int_equal(weft_scene_material(scene, 0, &good, &error), WEFT_OK);
    assert_int_equal(weft_scene_material(scene, -1, &bad, &error), WEFT_USAGE);
    assert_int_equal(weft_scene_material(scene, scene->material_count, &bad, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_MATERIAL_NAME);
    assert_int_equal(weft_scene_put_material(scene, 99, &good, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_MATERIAL_NAME);
    for (int k = 0; k < 9; k++) {
        bad = good;
        if (k == 0) bad.inputs[0].value[1] = NAN;
        if (k == 1) bad.inputs[3].transform[5] = INFINITY;
        if (k == 2) bad.inputs[3].texture = scene->texture_count + 1;
        if (k == 3) bad.inputs[3].texture = -1;
        if (k == 4) bad.inputs[3].texcoord = 2;
        if (k == 5) bad.inputs[3].channel = 4;
        if (k == 6) bad.choices[CHOICE_diffuse] = weft_lobe_find("ggx"); /* no diffuse term */
        if (k == 7) bad.choices[CHOICE_workflow] = -2;
        if (k == 8) bad.alpha_mode = (WeftAlphaMode)7;
        assert_int_equal(weft_scene_put_material(scene, 0, &bad, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_PARAM_VALUE);
        assert_int_equal(weft_scene_material(scene, 0, &now, &error), WEFT_OK);
        assert_memory_equal(&good, &now, sizeof now);
    }
    /* what is too much is clamped */
    bad = good;
    set_value(&bad, "metallic", 3.0f);
    assert_int_equal(weft_scene_put_material(scene, 0, &bad, &error), WEFT_OK);
    assert_true(scene->materials[0].inputs[INPUT_metallic].value[0] == 1.0f);
    weft_scene_free(scene);
}

static void choice_changes_the_defaults_of_untouched_inputs(void **state) {
    (void)state;
    WeftMaterial material = plain(), before = material;
    weft_material_choose(&material, -1, 0);
    weft_material_choose(&material, CHOICE_workflow, 99);
    weft_material_choose(&material, CHOICE_COUNT, 0);
    assert_memory_equal(&material, &before, sizeof before);
    set_choice(&material, "workflow", "disney");
    assert_true(material.inputs[INPUT_specular].value[0] == 0.5f);
    set_choice(&material, "workflow", "specular");
    assert_true(material.inputs[INPUT_specular].value[0] == 1.0f);
    assert_true(material.inputs[INPUT_specular_color].value[1] == 0.03f);
    material.inputs[INPUT_specular_color].given = 1;
    set_choice(&material, "workflow", "metallic");
    assert_true(material.inputs[INPUT_specular_color].value[1] == 0.03f);
}

typedef struct Heard {
    int count;
    char last[256];
} Heard;

static void hear(void *user, WeftMessage message, const char *text) {
    Heard *heard = user;
    (void)message;
    heard->count++;
    snprintf(heard->last, sizeof heard->last, "%s", text);
}

static int said_of(const WeftMaterial *material) {
    Heard heard = {0};
    weft_material_plausible(material, "Cloth", &(WeftLog){hear, &heard});
    if (heard.count) assert_memory_equal(heard.last, "Cloth", 5);
    return heard.count;
}

static void implausible_number_is_a_warning_once(void **state) {
    (void)state;
    WeftMaterial material = plain();
    assert_int_equal(said_of(&material), 0);
    set_value(&material, "metallic", 0.5f);
    assert_int_equal(said_of(&material), 1);
    set_value(&material, "ior", 2.4f);
    assert_int_equal(said_of(&material), 2);
    set_value(&material, "roughness", 1.5f);
    assert_int_equal(said_of(&material), 3);
    set_value(&material, "sheen_roughness", 1.5f); /* of no sheen */
    set_value(&material, "anisotropy_direction", 20.0f);
    assert_int_equal(said_of(&material), 3);
    for (int k = 0; weft_preset_name(k); k++) {
        WeftScene *scene = load("builtin:cloth");
        WeftError error;
        char path[64];
        snprintf(path, sizeof path, "preset:%s", weft_preset_name(k));
        assert_int_equal(weft_scene_assign_material(scene, "0", path, NULL, &error), WEFT_OK);
        assert_int_equal(weft_scene_material(scene, 0, &material, &error), WEFT_OK);
        if (said_of(&material)) fail_msg("%s is hardly real", path);
        weft_scene_free(scene);
    }
    memset(&material, 0xff, sizeof material); /* whatever it is */
    said_of(&material);
}

/* "-" before what must not be read. */
static void assert_reads(const WeftMaterial *material, const char *inputs) {
    char name[64];
    for (int used; sscanf(inputs, " %63s%n", name, &used) == 1; inputs += used) {
        bool wanted = name[0] != '-';
        int input = input_of(wanted ? name : name + 1);
        if ((weft_material_reads(material, input) != 0) != wanted) fail_msg("%s in \"%.30s\"", name, inputs);
    }
}

static void workflow_reads_only_its_inputs(void **state) {
    (void)state;
    WeftMaterial m = plain();
    assert_reads(&m, "base_color metallic roughness normal occlusion emission -emission_strength reflectance ior "
                     "specular specular_color -specular_tint -subsurface anisotropy -anisotropy_direction "
                     "clearcoat -clearcoat_roughness -clearcoat_gloss -clearcoat_normal -sheen -sheen_tint "
                     "sheen_color -sheen_roughness -sheen_density -nap dust -dust_color -dust_roughness "
                     "-dust_falloff -dust_tilt -dust_direction -dust_noise -dust_scale -opacity -extinction "
                     "-sheen_second -sheen_tail -sheen_rise -diffuse_retro -diffuse_lift diffuse_transmission "
                     "-diffuse_transmission_color");
    m.alpha_mode = WEFT_ALPHA_MASK;
    set_value(&m, "ior", 1.5f);
    set_value(&m, "anisotropy", 0.5f);
    set_value(&m, "clearcoat", 0.5f);
    set_value(&m, "dust", 0.5f);
    set_value(&m, "emission", 0.5f);
    set_value(&m, "sheen_color", 0.5f);
    set_value(&m, "diffuse_transmission", 0.5f);
    assert_reads(&m, "diffuse_transmission_color transmission -thickness -attenuation_distance -attenuation_color");
    WeftMaterial glass = m;
    set_value(&glass, "transmission", 0.5f);
    assert_reads(&glass, "thickness -attenuation_distance -attenuation_color");
    set_value(&glass, "thickness", 0.5f);
    assert_reads(&glass, "attenuation_distance -attenuation_color");
    set_value(&glass, "attenuation_distance", 0.5f);
    assert_reads(&glass, "attenuation_color");
    set_choice(&glass, "workflow", "cloth");
    assert_reads(&glass, "-transmission -thickness -attenuation_distance -attenuation_color");
    assert_reads(&m, "opacity -reflectance anisotropy_direction clearcoat_roughness clearcoat_normal dust_color "
                     "dust_roughness dust_falloff dust_tilt -dust_direction dust_noise -dust_scale "
                     "emission_strength sheen sheen_roughness -nap");
    set_value(&m, "dust_tilt", 0.5f);
    set_value(&m, "dust_noise", 0.5f);
    assert_reads(&m, "dust_direction dust_scale");
    set_choice(&m, "sheen_lobe", "exponential");
    assert_reads(&m, "sheen_beta sheen_roughness");
    set_value(&m, "sheen_beta", 3.0f);
    assert_reads(&m, "sheen_beta -sheen_roughness");
    set_choice(&m, "sheen_lobe", "fibre");
    assert_reads(&m, "sheen_density nap -nap_direction -sheen_beta");
    set_value(&m, "nap", 0.5f);
    assert_reads(&m, "nap_direction");
    set_choice(&m, "layer", "multiplicative");
    assert_reads(&m, "sheen sheen_roughness nap nap_direction sheen_density");
    set_choice(&m, "layer", "stochastic");
    assert_reads(&m, "sheen sheen_roughness nap");
    m = plain();
    set_value(&m, "metallic", 1.0f);
    set_value(&m, "base_color", 0.8f);
    assert_reads(&m, "base_color roughness -ior -reflectance -specular -specular_color");
    m.inputs[input_of("metallic")].texture = 1; /* which is less than 1 somewhere */
    assert_reads(&m, "reflectance specular specular_color");
    set_choice(&m, "workflow", "cloth");
    assert_reads(&m, "base_color -metallic -roughness -reflectance sheen_color -clearcoat -anisotropy");
    set_choice(&m, "diffuse", "oren-nayar");
    assert_reads(&m, "roughness -metallic");
    set_choice(&m, "f", "conductor"); /* of no specular lobe */
    assert_reads(&m, "-extinction");
    set_choice(&m, "workflow", "free");
    assert_reads(&m, "extinction ior reflectance");
}

static void profile_reads_only_its_inputs(void **state) {
    (void)state;
    WeftMaterial m = plain();
    set_choice(&m, "workflow", "disney");
    assert_reads(&m, "diffuse_transmission sheen -sheen_color -sheen_roughness specular -reflectance "
                     "subsurface clearcoat "
                     "-clearcoat_gloss -clearcoat_roughness");
    WeftMaterial published = m;
    set_choice(&published, "profile", "disney-2012");
    assert_reads(&published, "-diffuse_transmission sheen -sheen_color");
    m.inputs[input_of("base_color")].value[0] = 0.1f;
    set_value(&m, "clearcoat", 1.0f);
    set_value(&m, "sheen", 1.0f);
    assert_reads(&m, "specular_tint sheen_tint clearcoat_gloss");
    set_value(&m, "roughness", 0.0f); /* the narrowest highlight */
    assert_reads(&m, "roughness specular");
    set_choice(&m, "workflow", "metallic");
    set_value(&m, "roughness", 0.02f);
    assert_reads(&m, "roughness specular reflectance");
    set_choice(&m, "d", "ggx"); /* which knows no direction */
    set_value(&m, "anisotropy", 0.9f);
    assert_reads(&m, "roughness -anisotropy -anisotropy_direction");
    set_choice(&m, "workflow", "disney");
    assert_reads(&m, "roughness -anisotropy -anisotropy_direction");
    set_choice(&m, "d", "ggx-aniso");
    assert_reads(&m, "roughness anisotropy anisotropy_direction");
    set_choice(&m, "workflow", "metallic");
    set_value(&m, "anisotropy", 0.0f);
    set_value(&m, "sheen_color", 0.5f);
    /* whatever a profile reads, all of them read something of a sheen and of a base */
    for (int k = 1; weft_profile_name(k); k++) {
        WeftMaterial p = m;
        set_choice(&p, "profile", weft_profile_name(k));
        int count = 0;
        for (int i = 0; i < INPUT_COUNT; i++) count += weft_material_reads(&p, i) != 0;
        if (count < 6 || count > 30 || !weft_material_reads(&p, INPUT_base_color))
            fail_msg("%s reads %d", weft_profile_name(k), count);
    }
    m.unlit = 1;
    assert_reads(&m, "base_color -roughness -emission -normal -sheen_color -dust");
    assert_false(weft_material_reads(&m, -1) || weft_material_reads(&m, INPUT_COUNT));
    memset(&m, 0xff, sizeof m);
    for (int i = 0; i < INPUT_COUNT; i++) weft_material_reads(&m, i);
}

static void query_of_read_inputs_takes_microseconds(void **state) {
    (void)state;
    WeftMaterial m = plain();
    set_value(&m, "sheen_color", 0.5f);
    set_value(&m, "dust", 0.5f);
    double start = clock_now();
    for (int k = 0; k < 10 * INPUT_COUNT; k++) weft_material_reads(&m, k % INPUT_COUNT);
    double each = 1e6 * (clock_now() - start);
    print_message("[  FIGURES ] whether an input is read: %.0f us\n", each / (10.0 * INPUT_COUNT));
}

static void count_fitted(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_PARAM_FITTED);
    assert_non_null(strstr(text, "cloth"));
    assert_non_null(strstr(text, "0.38"));
    ++*(int *)user;
}

/* Fibres that lean were not fitted below alpha 0.38: a material that asks for them is named, whatever makes
 * it do so; a texture may be as dark as it likes. */
static void sharp_leaning_fibres_are_a_warning(void **state) {
    (void)state;
    int told = 0;
    const WeftLog log = {.fn = count_fitted, .user = &told};
    WeftMaterial m = plain();
    set_choice(&m, "sheen_lobe", "fibre");
    set_value(&m, "sheen_color", 0.8f);
    set_value(&m, "sheen_roughness", 0.4f);
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 0); /* upright */
    set_value(&m, "nap", 0.4f);
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 1);
    set_value(&m, "sheen_roughness", 0.7f);
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 1); /* rough enough */
    m.inputs[input_of("sheen_roughness")].texture = 1;
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 2);
    set_value(&m, "sheen_color", 0.0f);
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 2); /* no sheen */
    set_choice(&m, "sheen_lobe", "fibre-walk");
    set_value(&m, "sheen_color", 0.8f);
    weft_material_fitted(&m, "cloth", &log);
    assert_int_equal(told, 2);
}

/* A material with transmission is opaque by profiles and workflows that have none, and each says so: once, and not of
 * metal, which lets nothing through. */
static void glass_that_is_not_shown_is_a_warning(void **state) {
    (void)state;
    static const char *const silent[] = {"profile none",      "profile khronos",        "profile three",
                                         "profile babylon",   "profile filament-sheen", "profile khr-fuzz",
                                         "profile openpbr",   "profile khr-fuzz-exact", "profile babylon-openpbr",
                                         "workflow metallic", "workflow specular"};
    int shown = 0, hidden = 0;
    for (int choice = 0; choice < 2; choice++) {
        const char *name = choice ? "workflow" : "profile";
        for (int k = 0; weft_material_choice_value(weft_material_choice_find(name), k); k++) {
            char words[96];
            snprintf(words, sizeof words, "%s %s", name,
                     weft_material_choice_value(weft_material_choice_find(name), k));
            bool quiet = false;
            for (size_t j = 0; j < sizeof silent / sizeof *silent; j++) quiet |= strcmp(words, silent[j]) == 0;
            Heard told = {0}, of_metal = {0}, without = {0};
            WeftMaterial m = plain();
            weft_material_choose(&m, weft_material_choice_find(name), k);
            weft_material_fitted(&m, "pane", &(WeftLog){hear, &without});
            set_value(&m, "transmission", 0.7f);
            weft_material_fitted(&m, "pane", &(WeftLog){hear, &told});
            set_value(&m, "metallic", 1.0f);
            weft_material_fitted(&m, "pane", &(WeftLog){hear, &of_metal});
            if (told.count != !quiet || (!quiet && !strstr(told.last, words))) fail_msg("%s: \"%s\"", words, told.last);
            assert_int_equal(without.count, 0);
            assert_int_equal(of_metal.count, 0);
            *(quiet ? &shown : &hidden) += 1;
        }
    }
    assert_int_equal(shown, sizeof silent / sizeof *silent);
    assert_int_equal(hidden, 14);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(input_infos_are_those_of_the_table),
        cmocka_unit_test(number_that_is_set_is_read_back),
        cmocka_unit_test(impossible_numbers_are_refused),
        cmocka_unit_test(choice_changes_the_defaults_of_untouched_inputs),
        cmocka_unit_test(implausible_number_is_a_warning_once),
        cmocka_unit_test(workflow_reads_only_its_inputs),
        cmocka_unit_test(profile_reads_only_its_inputs),
        cmocka_unit_test(query_of_read_inputs_takes_microseconds),
        cmocka_unit_test(sharp_leaning_fibres_are_a_warning),
        cmocka_unit_test(glass_that_is_not_shown_is_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
