/* MaterialX: what is written has the names and types of the nodes of 1.39, is read back as the same numbers and textures, and
 * says what it lost; documents of others; refusals in one line. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "scene/material/material_file.h"
#include "scene/mtlx/mtlx_nodes.h"
#include "scene/mtlx/xml.h"
#include "scene/record/material_at.h"
#include "scene/record/scene.h"
#include "scratch.h"
#include "weft/weft.h"

static int warnings;
static char said[8192];
static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    assert_null(strchr(text, '\n'));
    if (message == WEFT_MESSAGE_PLAUSIBLE) return;
    const size_t used = strlen(said);
    snprintf(said + used, sizeof said - used, "%s\n", text);
    warnings++;
}
static const WeftLog counting = {.fn = note};

static void quiet(void) {
    warnings = 0;
    said[0] = '\0';
}

static void near(float is, float expected) {
    if (!(fabsf(is - expected) < 2e-6f * fmaxf(1.0f, fabsf(expected))))
        fail_msg("it is %.9g, not %.9g", (double)is, (double)expected);
}

static WeftScene *cloth(void) {
    WeftScene *scene;
    WeftError error;
    assert_int_equal(weft_scene_load("builtin:cloth", &scene, NULL, &error), WEFT_OK);
    return scene;
}

static void set(WeftScene *scene, const char *target, const char *value) {
    WeftError error;
    if (weft_scene_set(scene, target, value, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* Returns the index of the cloth's material. */
static int index_of_cloth(const WeftScene *scene) {
    for (int k = 0; k < scene->material_count; k++)
        if (strcmp(scene->material_names[k], "Cloth") == 0) return k;
    fail_msg("builtin:cloth has no Cloth");
    return 0;
}

static void save(const WeftScene *scene, const char *path, WeftMtlxNode node) {
    WeftError error;
    quiet();
    if (weft_scene_save_mtlx(scene, index_of_cloth(scene), path, node, &counting, &error) != WEFT_OK)
        fail_msg("%s", error.text);
}

static MaterialFile load(const char *path) {
    MaterialFile file;
    WeftError error;
    quiet();
    if (material_file_load(path, &file, &counting, &error) != WEFT_OK) fail_msg("%s", error.text);
    return file;
}

static float value(const MaterialFile *file, InputId id) { return file->material.inputs[id].value[0]; }

/* The inputs of the nodes by type, as libraries/bxdf of MaterialX 1.39 defines them. */
typedef struct Definition {
    const char *node, *floats, *colors, *vectors, *others;
} Definition;
static const Definition definitions[] = {
    {"open_pbr_surface",
     " base_weight base_diffuse_roughness base_metalness specular_weight specular_roughness specular_ior "
     "specular_roughness_anisotropy fuzz_weight fuzz_roughness coat_weight coat_roughness coat_roughness_anisotropy "
     "coat_ior coat_darkening emission_luminance geometry_opacity transmission_weight transmission_depth ",
     " base_color specular_color fuzz_color coat_color emission_color transmission_color ",
     " geometry_normal geometry_coat_normal geometry_tangent geometry_coat_tangent ", " geometry_thin_walled "},
    {"gltf_pbr",
     " metallic roughness occlusion specular ior alpha alpha_cutoff sheen_roughness clearcoat clearcoat_roughness "
     "emissive_strength transmission thickness attenuation_distance ",
     " base_color specular_color sheen_color emissive attenuation_color ", " normal tangent clearcoat_normal ",
     " alpha_mode "},
    {"standard_surface",
     " base diffuse_roughness metalness specular specular_roughness specular_IOR specular_anisotropy sheen "
     "sheen_roughness coat coat_roughness coat_anisotropy coat_IOR emission transmission transmission_depth ",
     " base_color specular_color sheen_color coat_color emission_color opacity transmission_color ",
     " normal tangent coat_normal ", " thin_walled "},
};

static void has_word(const char *list, const char *word) {
    char between[96];
    snprintf(between, sizeof between, " %s ", word);
    if (!strstr(list, between)) fail_msg("%s is none of%s", word, list);
}

/* Demands that the document is one surface material of that node, with inputs that the node has, of their types. */
static void check_document(const char *path, int node) {
    FileBytes bytes;
    WeftError error;
    Arena arena = {0};
    const XmlElement *root;
    assert_int_equal(file_read(path, 1 << 20, &bytes, &error), WEFT_OK);
    if (xml_read(bytes.data, bytes.size, path, &arena, &root, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_string_equal(root->name, "materialx");
    assert_string_equal(xml_attribute(root, "version"), "1.39");
    const XmlElement *shader = root->first;
    while (shader && strcmp(shader->name, definitions[node].node) != 0) shader = shader->next;
    if (!shader) {
        fail_msg("%s: no <%s>", path, definitions[node].node);
        return;
    }
    assert_string_equal(xml_attribute(shader, "type"), "surfaceshader");
    for (const XmlElement *input = shader->first; input; input = input->next) {
        const char *type = xml_attribute(input, "type"), *name = xml_attribute(input, "name");
        const bool is_float = strcmp(type, "float") == 0, is_color = strcmp(type, "color3") == 0;
        has_word(is_float                       ? definitions[node].floats
                 : is_color                     ? definitions[node].colors
                 : strcmp(type, "vector3") == 0 ? definitions[node].vectors
                                                : definitions[node].others,
                 name);
    }
    assert_string_equal(root->last->name, "surfacematerial");
    assert_string_equal(xml_attribute(root->last->first, "nodename"), xml_attribute(shader, "name"));
    arena_free(&arena);
    free(bytes.data);
}

static void numbers_survive_the_round_trip(void **state) {
    (void)state;
    static const struct {
        InputId input;
        const char *name, *text;
        float is;
    } numbers[] = {{INPUT_base_color, "base_color", "0.1234567", 0.1234567f},
                   {INPUT_metallic, "metallic", "0.3", 0.3f},
                   {INPUT_roughness, "roughness", "0.7", 0.7f},
                   {INPUT_specular, "specular", "0.9", 0.9f},
                   {INPUT_specular_color, "specular_color", "0.25", 0.25f},
                   {INPUT_ior, "ior", "1.45", 1.45f},
                   {INPUT_clearcoat, "clearcoat", "0.5", 0.5f},
                   {INPUT_clearcoat_roughness, "clearcoat_roughness", "0.1", 0.1f},
                   {INPUT_emission, "emission", "0.125", 0.125f},
                   {INPUT_emission_strength, "emission_strength", "3", 3.0f},
                   {INPUT_anisotropy, "anisotropy", "0.6", 0.6f},
                   {INPUT_anisotropy_direction, "anisotropy_direction", "30", 0.523598776f},
                   {INPUT_coat_anisotropy, "coat_anisotropy", "0.4", 0.4f},
                   {INPUT_coat_ior, "coat_ior", "1.7", 1.7f},
                   {INPUT_diffuse_roughness, "diffuse_roughness", "0.8", 0.8f}};
    const char *path = "numbers.mtlx";
    for (int node = 0; node < WEFT_MTLX_NODES; node++) {
        WeftScene *scene = cloth();
        char target[64];
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            snprintf(target, sizeof target, "Cloth.%s", numbers[k].name);
            set(scene, target, numbers[k].text);
        }
        save(scene, path, (WeftMtlxNode)node);
        weft_scene_free(scene);
        check_document(path, node);
        MaterialFile file = load(path);
        if (warnings) fail_msg("%s", said);
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
            if (mtlx_row_of(&mtlx_nodes[node], (int)numbers[k].input))
                near(value(&file, numbers[k].input), numbers[k].is);
        material_file_free(&file);
    }
}

/* Sheen of gltf_pbr and standard_surface is alpha = roughness^2 of a colour, and fuzz of open_pbr_surface is its own. */
static void the_rim_is_that_of_the_node(void **state) {
    (void)state;
    const char *path = "rim.mtlx";
    WeftScene *scene = cloth();
    set(scene, "Cloth.sheen_color", "0.5,0.25,0.125");
    set(scene, "Cloth.sheen_roughness", "0.417");
    set(scene, "Cloth.sheen", "0.8");
    save(scene, path, WEFT_MTLX_STANDARD);
    FileBytes bytes;
    WeftError error;
    assert_int_equal(file_read(path, 1 << 20, &bytes, &error), WEFT_OK);
    const char *text = (const char *)bytes.data;
    assert_non_null(strstr(text, "name=\"sheen\" type=\"float\" value=\"0.4\""));
    assert_non_null(strstr(text, "name=\"sheen_color\" type=\"color3\" value=\"1, 0.5, 0.25\""));
    assert_non_null(strstr(text, "name=\"sheen_roughness\" type=\"float\" value=\"0.173889\"")); /* .417^2 */
    free(bytes.data);
    MaterialFile file = load(path);
    near(value(&file, INPUT_sheen_roughness), 0.417f);
    near(value(&file, INPUT_sheen) * value(&file, INPUT_sheen_color), 0.4f);
    material_file_free(&file);
    save(scene, path, WEFT_MTLX_GLTF);
    file = load(path);
    near(value(&file, INPUT_sheen_roughness), 0.417f);
    near(value(&file, INPUT_sheen_color), 0.4f);
    material_file_free(&file);
    save(scene, path, WEFT_MTLX_OPEN_PBR); /* the sheen of fuzz of roughness .5 has roughness .417 and colour 1.0636 */
    file = load(path);
    near(value(&file, INPUT_fuzz_roughness), 0.5f);
    near(value(&file, INPUT_fuzz), 0.4f / 1.0636f);
    near(file.material.inputs[INPUT_fuzz_color].value[2], 0.25f);
    material_file_free(&file);
    set(scene, "Cloth.fuzz", "0.75");
    set(scene, "Cloth.fuzz_roughness", "0.375");
    save(scene, path, WEFT_MTLX_OPEN_PBR);
    file = load(path);
    near(value(&file, INPUT_fuzz), 0.75f);
    near(value(&file, INPUT_fuzz_roughness), 0.375f);
    material_file_free(&file);
    weft_scene_free(scene);
}

/* Materials of other workflows are written as the numbers of a metallic one. */
static void workflows_become_reflections(void **state) {
    (void)state;
    const char *path = "workflow.mtlx";
    WeftScene *scene = cloth();
    set(scene, "Cloth.workflow", "specular");
    set(scene, "Cloth.specular_color", "0.04,0.02,0.01");
    save(scene, path, WEFT_MTLX_OPEN_PBR);
    MaterialFile file = load(path);
    near(value(&file, INPUT_ior), 1.5f); /* ((1.5 - 1) / (1.5 + 1))^2 = .04 */
    near(file.material.inputs[INPUT_specular_color].value[2], 0.25f);
    material_file_free(&file);
    set(scene, "Cloth.workflow", "disney");
    set(scene, "Cloth.specular", "0.5");
    set(scene, "Cloth.clearcoat", "1");
    set(scene, "Cloth.clearcoat_gloss", "1");
    save(scene, path, WEFT_MTLX_STANDARD);
    file = load(path);
    near(value(&file, INPUT_ior), 1.5f); /* .08 specular */
    near(value(&file, INPUT_clearcoat), 0.25f);
    near(value(&file, INPUT_clearcoat_roughness), 0.0316227766f); /* alpha .001 */
    material_file_free(&file);
    set(scene, "Cloth.workflow", "cloth");
    save(scene, path, WEFT_MTLX_GLTF);
    file = load(path);
    near(value(&file, INPUT_specular), 0.0f);
    material_file_free(&file);
    weft_scene_free(scene);
}

static void every_preset_is_written_as_every_node(void **state) {
    (void)state;
    const char *path = "preset.mtlx";
    int written = 0;
    for (int k = 0; weft_preset_name(k); k++) {
        char name[96];
        WeftError error;
        snprintf(name, sizeof name, "preset:%s", weft_preset_name(k));
        if (strstr(weft_preset_text(k), "\"weave\"")) continue;
        WeftScene *scene = cloth();
        assert_int_equal(weft_scene_assign_material(scene, "Cloth", name, NULL, &error), WEFT_OK);
        for (int node = 0; node < WEFT_MTLX_NODES; node++) {
            save(scene, path, (WeftMtlxNode)node);
            assert_null(strstr(said, "its weave"));
            check_document(path, node);
            MaterialFile file = load(path);
            if (warnings) fail_msg("%s: %s", name, said);
            material_file_free(&file);
            written++;
        }
        weft_scene_free(scene);
    }
    assert_true(written > 60);
}

static void lost_parts_have_a_line_each(void **state) {
    (void)state;
    const char *path = "lost.mtlx";
    WeftScene *scene = cloth();
    WeftError error;
    set(scene, "Cloth.nap", "20");
    set(scene, "Cloth.retroreflection", "0.5");
    set(scene, "Cloth.sheen_lobe", "fibre");
    set(scene, "Cloth.diffuse_roughness", "0.5");
    save(scene, path, WEFT_MTLX_GLTF);
    static const char *const lines[] = {"nap: gltf_pbr has no input for it", "retroreflection: gltf_pbr has no",
                                        "sheen_lobe=fibre: gltf_pbr has formulas",
                                        "diffuse_roughness: gltf_pbr has no"};
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
        if (!strstr(said, lines[k])) fail_msg("\"%s\" is not among %s", lines[k], said);
    assert_int_equal(warnings, 4);
    save(scene, path, WEFT_MTLX_OPEN_PBR);
    assert_null(strstr(said, "diffuse_roughness"));
    assert_int_equal(weft_scene_assign_material(scene, "Cloth", "preset:woven-denim", NULL, &error), WEFT_OK);
    save(scene, path, WEFT_MTLX_OPEN_PBR);
    assert_non_null(strstr(said, "its weave"));
    weft_scene_free(scene);
}

static bool is_workflow_metallic(const MaterialFile *file) {
    const int choice = weft_material_choice_find("workflow");
    const char *id = weft_material_choice_value(choice, file->material.choices[choice]);
    return id && strcmp(id, "metallic") == 0;
}

/* Thin and solid glass, tinted where it enters, absorbing inside, or both, through each node. A node without a thickness
 * has one colour for both. */
static void glass_survives_the_round_trip(void **state) {
    (void)state;
    static const struct {
        const char *share, *thickness, *distance;
        float base[3];
        bool both; /* colours, of which one is lost where the node has one */
    } cases[] = {
        {"1", "0", "0", {0.5f, 0.75f, 0.25f}, false},       {"0.5", "0", "0", {0.5f, 0.75f, 0.25f}, false},
        {"1", "0.02", "0", {0.5f, 0.75f, 0.25f}, false},    {"1", "0.02", "0.125", {1.0f, 1.0f, 1.0f}, false},
        {"1", "0.02", "0.125", {0.5f, 0.75f, 0.25f}, true},
    };
    static const float inside[3] = {0.875f, 0.5f, 0.625f};
    const char *path = "glass.mtlx";
    for (int node = 0; node < WEFT_MTLX_NODES; node++)
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            const bool one_color = node != WEFT_MTLX_GLTF, solid = cases[k].thickness[1] != 0,
                       absorbs = cases[k].distance[1] != 0, base_lost = cases[k].both && one_color;
            char color[64];
            WeftScene *scene = cloth();
            snprintf(color, sizeof color, "%g,%g,%g", (double)cases[k].base[0], (double)cases[k].base[1],
                     (double)cases[k].base[2]);
            set(scene, "Cloth.base_color", color);
            set(scene, "Cloth.transmission", cases[k].share);
            set(scene, "Cloth.thickness", cases[k].thickness);
            set(scene, "Cloth.attenuation_distance", cases[k].distance);
            set(scene, "Cloth.attenuation_color", "0.875,0.5,0.625");
            set(scene, "Cloth.ior", "1.33");
            scene->materials[index_of_cloth(scene)].double_sided = true;
            save(scene, path, (WeftMtlxNode)node);
            assert_int_equal(warnings, (one_color && solid) + base_lost);
            if (one_color && solid) assert_non_null(strstr(said, "thickness: "));
            if (base_lost) assert_non_null(strstr(said, "base_color: the node has one colour for glass"));
            weft_scene_free(scene);
            check_document(path, node);
            MaterialFile file = load(path);
            if (warnings) fail_msg("%s", said);
            const Input *inputs = file.material.inputs;
            assert_int_equal(is_workflow_metallic(&file), node != WEFT_MTLX_OPEN_PBR);
            assert_true(material_has_glass(&file.material));
            near(inputs[INPUT_transmission].value[0], strtof(cases[k].share, NULL));
            near(inputs[INPUT_ior].value[0], 1.33f);
            assert_int_equal(inputs[INPUT_thickness].value[0] > 0.0f, solid);
            if (!one_color) near(inputs[INPUT_thickness].value[0], strtof(cases[k].thickness, NULL));
            near(inputs[INPUT_attenuation_distance].value[0], strtof(cases[k].distance, NULL));
            for (int c = 0; c < 3; c++) {
                near(inputs[INPUT_base_color].value[c], base_lost ? 1.0f : cases[k].base[c]);
                if (absorbs) near(inputs[INPUT_attenuation_color].value[c], inside[c]);
            }
            material_file_free(&file);
        }
}

/* Glass that the workflow does not draw is not written. */
static void glass_that_is_not_drawn_is_left_out(void **state) {
    (void)state;
    const char *path = "opaque.mtlx";
    WeftScene *scene = cloth();
    set(scene, "Cloth.transmission", "1");
    set(scene, "Cloth.workflow", "disney");
    for (int node = 0; node < WEFT_MTLX_NODES; node++) {
        save(scene, path, (WeftMtlxNode)node);
        MaterialFile file = load(path);
        near(value(&file, INPUT_transmission), 0.0f);
        material_file_free(&file);
    }
    weft_scene_free(scene);
}

/* Writes a picture of one colour. */
static void picture(const char *path, int r, int g, int b) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(4, 4, 3, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    uint8_t *p = image.pixels;
    for (int k = 0; k < 16; k++) p[3 * k] = (uint8_t)r, p[3 * k + 1] = (uint8_t)g, p[3 * k + 2] = (uint8_t)b;
    assert_int_equal(weft_image_write(path, &image, &error), WEFT_OK);
    weft_image_free(&image);
}

static void put_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void textures_survive_the_round_trip(void **state) {
    (void)state;
    static const char png[] = "a & b.png", mtlx[] = "maps.mtlx", path[] = "maps.json";
    char json[1024];
    picture(png, 200, 100, 50);
    snprintf(json, sizeof json,
             "{\"base_color\":{\"texture\":\"%s\",\"factor\":[0.5,0.25,1],\"scale\":[4,2],\"rotation\":30,"
             "\"offset\":[0.1,0.2],\"wrap\":[\"mirror\",\"clamp\"]},"
             "\"roughness\":{\"texture\":\"%s\",\"channel\":\"g\",\"texcoord\":1},"
             "\"sheen_color\":1,\"sheen_roughness\":{\"texture\":\"%s\",\"channel\":\"b\",\"factor\":0.5},"
             "\"normal\":{\"texture\":\"%s\",\"factor\":0.75,\"nearest\":true},\"alpha_mode\":\"blend\","
             "\"opacity\":{\"texture\":\"%s\",\"channel\":\"r\",\"factor\":0.5}}",
             png, png, png, png, png);
    put_text(path, json);
    for (int node = 0; node < WEFT_MTLX_NODES; node++) {
        WeftScene *scene = cloth();
        WeftError error;
        if (weft_scene_assign_material(scene, "Cloth", path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        const Material given = scene->materials[index_of_cloth(scene)];
        save(scene, mtlx, (WeftMtlxNode)node);
        if (warnings) fail_msg("%s", said);
        weft_scene_free(scene);
        check_document(mtlx, node);
        MaterialFile file = load(mtlx);
        if (warnings) fail_msg("%s", said);
        assert_int_equal(file.image_count, 1);
        static const InputId inputs[] = {INPUT_base_color, INPUT_roughness, INPUT_normal, INPUT_opacity,
                                         INPUT_sheen_roughness};
        for (size_t k = 0; k < sizeof inputs / sizeof *inputs - (node == WEFT_MTLX_OPEN_PBR); k++) {
            const Input *was = &given.inputs[inputs[k]], *is = &file.material.inputs[inputs[k]];
            assert_true(is->texture > 0);
            for (int c = 0; c < input_value_count(inputs[k]); c++) near(is->value[c], was->value[c]);
            for (int c = 0; c < 6; c++) near(is->transform[c], was->transform[c]);
            assert_int_equal(is->channel, was->channel);
            assert_int_equal(is->texcoord, was->texcoord);
        }
        const Texture *base = &file.textures[file.material.inputs[INPUT_base_color].texture - 1];
        assert_int_equal(base->wrap_u, WRAP_MIRROR);
        assert_int_equal(base->wrap_v, WRAP_CLAMP);
        assert_true(file.textures[file.material.inputs[INPUT_normal].texture - 1].nearest);
        assert_int_equal(file.material.alpha_mode, WEFT_ALPHA_BLEND);
        material_file_free(&file);
    }
}

#define SHADER(inputs)                                                                                                 \
    "<materialx version=\"1.39\"><open_pbr_surface name=\"s\" type=\"surfaceshader\">" inputs                          \
    "</open_pbr_surface></materialx>"

/* Glass of other programs: the colour of its walls, of what is inside, of walls that only half the light goes through. */
static void glass_of_others_is_read(void **state) {
    (void)state;
    const char *path = "pane.mtlx";
    picture("pane.png", 200, 100, 50);
    put_text(path, SHADER("<input name=\"transmission_weight\" type=\"float\" value=\"1\"/>"
                          "<input name=\"transmission_color\" type=\"color3\" value=\"0.2,0.4,0.6\"/>"
                          "<input name=\"transmission_scatter\" type=\"color3\" value=\"0,0,0\"/>"
                          "<input name=\"geometry_thin_walled\" type=\"boolean\" value=\"true\"/>"));
    MaterialFile file = load(path);
    near(file.material.inputs[INPUT_base_color].value[2], 0.6f);
    near(value(&file, INPUT_thickness), 0.0f);
    assert_true(file.material.double_sided);
    assert_int_equal(warnings, 0);
    material_file_free(&file);
    put_text(path, SHADER("<input name=\"transmission_weight\" type=\"float\" value=\"0.5\"/>"
                          "<input name=\"transmission_color\" type=\"color3\" value=\"0.2,0.4,0.6\"/>"
                          "<input name=\"transmission_scatter\" type=\"color3\" value=\"0,0.1,0\"/>"));
    file = load(path);
    near(file.material.inputs[INPUT_base_color].value[2], 0.8f);
    assert_true(value(&file, INPUT_thickness) > 0.0f);
    assert_non_null(strstr(said, "transmission_color: light goes through in base_color"));
    assert_non_null(strstr(said, "transmission_scatter: is not shown"));
    assert_int_equal(warnings, 2);
    material_file_free(&file);
    put_text(
        path,
        "<materialx version=\"1.39\"><image name=\"c\" type=\"color3\"><input name=\"file\" type=\"filename\" "
        "value=\"pane.png\" colorspace=\"srgb_texture\"/></image>"
        "<standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"transmission\" type=\"float\" value=\"1\"/>"
        "<input name=\"base\" type=\"float\" value=\"0\"/>"
        "<input name=\"thin_walled\" type=\"boolean\" value=\"true\"/>"
        "<input name=\"transmission_color\" type=\"color3\" nodename=\"c\"/></standard_surface></materialx>");
    file = load(path);
    assert_true(file.material.inputs[INPUT_base_color].texture > 0);
    near(value(&file, INPUT_base_color), 1.0f);
    assert_int_equal(file.material.inputs[INPUT_attenuation_color].texture, 0);
    assert_int_equal(warnings, 0);
    material_file_free(&file);
    /* what lets nothing through has no colour for it */
    put_text(path, SHADER("<input name=\"transmission_color\" type=\"color3\" value=\"0.2,0.4,0.6\"/>"));
    file = load(path);
    near(file.material.inputs[INPUT_attenuation_color].value[0], 1.0f);
    near(file.material.inputs[INPUT_base_color].value[0], 0.8f);
    assert_false(is_workflow_metallic(&file));
    material_file_free(&file);
}

/* A document as libraries of materials have them: tiles, a prefix, a weight beside the colour, packed maps. */
static void documents_of_others_are_read(void **state) {
    (void)state;
    const char *path = "tiled.mtlx";
    picture("mtlx-map.png", 200, 100, 50);
    put_text(
        path,
        "<?xml version=\"1.0\"?><materialx version=\"1.38\" colorspace=\"lin_rec709\" fileprefix=\"mtlx-\">"
        "<tiledimage name=\"c\" type=\"color3\"><input name=\"file\" type=\"filename\" value=\"map.png\" "
        "colorspace=\"srgb_texture\"/><input name=\"uvtiling\" type=\"vector2\" value=\"2, 4\"/></tiledimage>"
        "<image name=\"o\" type=\"vector3\"><input name=\"file\" type=\"filename\" value=\"map.png\"/></image>"
        "<separate3 name=\"p\" type=\"multioutput\"><input name=\"in\" type=\"vector3\" nodename=\"o\"/></separate3>"
        "<standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"base\" type=\"float\" value=\"0.5\"/>"
        "<input name=\"base_color\" type=\"color3\" nodename=\"c\"/>"
        "<input name=\"specular_roughness\" type=\"float\" nodename=\"p\" output=\"outy\"/>"
        "<input name=\"coat\" type=\"float\" nodename=\"nothing\"/>"
        "<input name=\"subsurface\" type=\"float\" value=\"0.5\"/></standard_surface></materialx>");
    MaterialFile file = load(path);
    near(value(&file, INPUT_base_color), 0.5f);
    near(file.material.inputs[INPUT_base_color].transform[0], 2.0f);
    near(file.material.inputs[INPUT_base_color].transform[4], 4.0f);
    near(file.material.inputs[INPUT_base_color].transform[5], -3.0f); /* 1 - 4 (1 - v) = 4 v - 3 */
    assert_int_equal(file.material.inputs[INPUT_roughness].channel, 1);
    assert_int_equal(file.image_count, 1);
    assert_non_null(strstr(said, "coat: its graph is not understood"));
    assert_non_null(strstr(said, "subsurface: is not shown"));
    assert_int_equal(warnings, 2);
    material_file_free(&file);
    /* A weight that is a constant of a graph, and a square of one. */
    put_text(path,
             "<materialx version=\"1.39\" fileprefix=\"mtlx-\"><image name=\"c\" type=\"color3\"><input name=\"file\" "
             "type=\"filename\" value=\"map.png\" colorspace=\"srgb_texture\"/></image>"
             "<constant name=\"w\" type=\"float\"><input name=\"value\" type=\"float\" value=\"0.4\"/></constant>"
             "<multiply name=\"q\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"w\"/>"
             "<input name=\"in2\" type=\"float\" nodename=\"w\"/></multiply>"
             "<standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"base\" type=\"float\" nodename=\"w\"/>"
             "<input name=\"base_color\" type=\"color3\" nodename=\"c\"/>"
             "<input name=\"specular_roughness\" type=\"float\" nodename=\"q\"/></standard_surface></materialx>");
    file = load(path);
    near(value(&file, INPUT_base_color), 0.4f);
    near(value(&file, INPUT_roughness), 0.16f);
    material_file_free(&file);
    put_text(path, SHADER("<input name=\"base_weight\" type=\"float\" value=\"0.5\"/>"
                          "<input name=\"base_color\" type=\"color3\" value=\"0.2,0.4,0.6\"/>"));
    file = load(path);
    near(file.material.inputs[INPUT_base_color].value[2], 0.3f);
    near(value(&file, INPUT_roughness), 0.3f); /* what the node has by default */
    near(value(&file, INPUT_coat_ior), 1.6f);
    assert_string_equal(weft_material_choice_value(weft_material_choice_find("profile"),
                                                   file.material.choices[weft_material_choice_find("profile")]),
                        "openpbr");
    assert_int_equal(warnings, 0);
    material_file_free(&file);
}

static void others_are_refused_in_one_line(void **state) {
    (void)state;
    static const struct {
        const char *text, *why;
    } documents[] = {
        {"", "line 1: no element found"},
        {"<materialx version=\"1.39\"><open_pbr_surface>", "no element found"},
        {"<materialx version=\"1.39\"></nothing>", "mismatched tag"},
        {"<svg/>", "it is <svg> and no <materialx>"},
        {"<materialx version=\"2.0\"/>", "version: expected 1.38 or 1.39, not \"2.0\""},
        {"<materialx version=\"1.39\"/>", "it has no surface"},
        {"<!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
         "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;\">]><materialx version=\"1.39\">&c;</materialx>",
         "a document type (DOCTYPE) is not allowed"},
        {"<materialx version=\"1.39\">&bomb;</materialx>", "undefined entity"},
        {SHADER("<input name=\"base_color\" type=\"float\" value=\"1\"/>"), "base_color: its type must be color3"},
        {SHADER("<input name=\"base_color\" type=\"color3\" value=\"1, 2\"/>"),
         "\"1, 2\" is not a value of type color3"},
        {SHADER("<input name=\"fuzz_weight\" type=\"float\" value=\"nan\"/>"), "\"nan\" is not a value of type float"},
        {SHADER("<input name=\"fuzz_weight\" type=\"float\"/>"), "\"\" is not a value of type float"},
        {SHADER("<input name=\"geometry_thin_walled\" type=\"boolean\" value=\"1\"/>"), "not a value of type boolean"},
        {"<materialx version=\"1.39\"><constant name=\"c\" type=\"integer\"><input name=\"value\" type=\"integer\" "
         "value=\"1000000\"/></constant><gltf_pbr name=\"s\" type=\"surfaceshader\"><input name=\"alpha_mode\" "
         "type=\"integer\" nodename=\"c\"/></gltf_pbr></materialx>",
         "alpha_mode: not 0, 1 or 2"},
        {"<materialx version=\"1.39\"><volume name=\"v\"/><surfacematerial name=\"m\"><input name=\"surfaceshader\" "
         "type=\"surfaceshader\" nodename=\"v\"/></surfacematerial></materialx>",
         "its surface is <volume>: expected open_pbr_surface"},
    };
    const char *path = "bad.mtlx";
    for (size_t k = 0; k < sizeof documents / sizeof *documents; k++) {
        WeftError error;
        MaterialFile file;
        put_text(path, documents[k].text);
        assert_int_equal(material_file_load(path, &file, NULL, &error), WEFT_INPUT);
        if (!strstr(error.text, documents[k].why) || strchr(error.text, '\n'))
            fail_msg("\"%s\" and not \"%s\"", error.text, documents[k].why);
        material_file_free(&file);
    }
}

/* A circle of nodes, and a chain whose steps double, end at once and with a warning. */
static void circles_of_nodes_are_passed_over(void **state) {
    (void)state;
    const char *path = "circle.mtlx";
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "<materialx version=\"1.39\"><image name=\"a0\"><input name=\"file\" value=\"x.png\"/></image>");
    for (int k = 1; k < 24; k++)
        fprintf(out,
                "<multiply name=\"a%d\"><input name=\"in1\" nodename=\"a%d\"/><input name=\"in2\" nodename=\"b%d\"/>"
                "</multiply><multiply name=\"b%d\"><input name=\"in1\" nodename=\"a%d\"/><input name=\"in2\" "
                "nodename=\"b%d\"/></multiply>",
                k, k - 1, k - 1, k, k - 1, k - 1);
    fprintf(out, "<constant name=\"b0\"><input name=\"value\" value=\"1\"/></constant>"
                 "<multiply name=\"c\"><input name=\"in1\" nodename=\"c\"/><input name=\"in2\" value=\"1\"/></multiply>"
                 "<gltf_pbr name=\"s\"><input name=\"roughness\" type=\"float\" nodename=\"c\"/>"
                 "<input name=\"metallic\" type=\"float\" nodename=\"a20\"/></gltf_pbr></materialx>");
    assert_int_equal(fclose(out), 0);
    MaterialFile file = load(path);
    assert_non_null(strstr(said, "roughness: its graph is not understood"));
    assert_non_null(strstr(said, "metallic: its graph is not understood"));
    material_file_free(&file);
}

int main(void) {
    char folder[SCRATCH_SIZE];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_survive_the_round_trip),   cmocka_unit_test(the_rim_is_that_of_the_node),
        cmocka_unit_test(workflows_become_reflections),     cmocka_unit_test(every_preset_is_written_as_every_node),
        cmocka_unit_test(lost_parts_have_a_line_each),      cmocka_unit_test(textures_survive_the_round_trip),
        cmocka_unit_test(documents_of_others_are_read),     cmocka_unit_test(others_are_refused_in_one_line),
        cmocka_unit_test(circles_of_nodes_are_passed_over), cmocka_unit_test(glass_survives_the_round_trip),
        cmocka_unit_test(glass_of_others_is_read),          cmocka_unit_test(glass_that_is_not_drawn_is_left_out),
    };
    if (!scratch_enter(folder)) return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return chdir("/") == 0 && scratch_remove(folder) ? failed : 1;
}
