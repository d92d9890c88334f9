/* Names of pictures, as libraries of textures, engines and painting programs give them, and the inputs they are for. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "scene/material/map_names.h"
#include "scene/record/scene.h"
#include "scratch.h"
#include "weft/weft.h"

static char folder[SCRATCH_SIZE];

static int begin(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    return scratch_remove(folder) ? 0 : -1;
}

/* Writes uses as "base_color" or "occlusion roughness.g metallic.b", with '-' before an inverted one and the
 * direction of green behind normals. */
static const char *uses_of(const char *file) {
    static const char *const channels[] = {"", ".g", ".b", ".a"}, *const greens[] = {"", "+", "-"};
    static char text[256];
    const MapName name = map_name(file);
    text[0] = '\0';
    for (int k = 0; k < name.count; k++) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s%s%s%s", used ? " " : "", name.uses[k].inverted ? "-" : "",
                 input_infos[name.uses[k].input].name, channels[name.uses[k].channel], greens[name.green]);
    }
    return text;
}

static void names_of_many_makers_are_understood(void **state) {
    (void)state;
    static const struct {
        const char *file, *uses;
    } names[] = {
        /* Poly Haven */
        {"twill_diff_1k.png", "base_color"},
        {"twill_nor_gl_1k.exr", "normal+"},
        {"twill_nor_dx_4k.exr", "normal-"},
        {"twill_rough_2k.jpg", "roughness"},
        {"twill_ao_8k.jpg", "occlusion"},
        {"twill_arm_1k.png", "occlusion roughness.g metallic.b"},
        {"twill_disp_1k.png", ""},
        {"twill_spec_1k.png", "specular_color"},
        /* OpenPBR, and the back of a cloth */
        {"wool_fuzz_color.png", "sheen_color"},
        {"wool_FuzzRoughness_2K.png", "sheen_roughness"},
        {"wool_fuzz_weight.png", "sheen"},
        {"wool_base_diffuse_roughness.png", ""},
        {"wool_back_color.png", ""},
        {"wool_back_normal.png", ""},
        {"wool_comeback_color.png", "base_color"},
        /* Poliigon */
        {"FabricPlain001_COL_VAR1_3K.jpg", "base_color"},
        {"FabricPlain001_NRM_3K.png", "normal"},
        {"FabricPlain001_NRM16_3K.png", "normal"},
        {"FabricPlain001_GLOSS_3K.jpg", "-roughness"},
        {"FabricPlain001_REFL_3K.jpg", "specular_color"},
        {"FabricPlain001_DISP16_3K.png", ""},
        {"Fabric_AO_1K_METALNESS.jpg", "occlusion"},
        {"Fabric_METALNESS_1K_METALNESS.jpg", "metallic"},
        {"Fabric_COL_VAR1_3K_SPECULAR.jpg", "base_color"},
        {"Poliigon_FabricRope_7432_Metallic.jpg", "metallic"},
        {"Poliigon_FabricRope_7432_AmbientOcclusion.jpg", "occlusion"},
        /* ambientCG, and CC0 Textures before it */
        {"Fabric030_1K-PNG_Color.png", "base_color"},
        {"Fabric030_4K-JPG_NormalGL.jpg", "normal+"},
        {"Fabric030_4K-JPG_NormalDX.jpg", "normal-"},
        {"Fabric030_1K-PNG_AmbientOcclusion.png", "occlusion"},
        {"Fabric030_1K_Metalness.png", "metallic"},
        {"Fabric01_rgh.jpg", "roughness"},
        {"Fabric01_met.jpg", "metallic"},
        /* Substance */
        {"sofa_BaseColor.png", "base_color"},
        {"sofa_Base_Color.png", "base_color"},
        {"sofa_OcclusionRoughnessMetallic.png", "occlusion roughness.g metallic.b"},
        {"sofa_Normal_OpenGL.png", "normal+"},
        {"sofa_Normal_DirectX.png", "normal-"},
        {"sofa_Mixed_AO.png", "occlusion"},
        {"sofa_Glossiness.png", "-roughness"},
        {"sofa_BaseColor.1001.png", "base_color"},
        {"sofa_Roughness_1012.png", "roughness"},
        {"sofa_SheenOpacity.png", "sheen"},
        {"sofa_Coat_Normal.png", "clearcoat_normal"},
        /* Unity */
        {"sofa_BaseMap.png", "base_color"},
        {"sofa_BaseColorMap.png", "base_color"},
        {"sofa_MainTex.png", "base_color"},
        {"sofa_MaskMap.png", "metallic occlusion.g -roughness.a"},
        {"sofa_MODS.png", "metallic occlusion.g -roughness.a"},
        {"sofa_MetallicSmoothness.png", "metallic -roughness.a"},
        {"sofa_MetallicGlossMap.png", "metallic -roughness.a"},
        {"sofa_SpecularSmoothness.png", "specular_color -roughness.a"},
        {"sofa_AlbedoTransparency.png", "base_color opacity.a"},
        {"sofa_NormalMap.png", "normal"},
        {"sofa_OcclusionMap.png", "occlusion"},
        {"sofa_EmissionMap.png", "emission"},
        {"sofa_Smoothness.png", "-roughness"},
        /* Megascans */
        {"ugsnf_2K_Albedo.jpg", "base_color"},
        {"ugsnf_2K_Normal_LOD0.jpg", "normal"},
        {"ugsnf_4K_Gloss.jpg", "-roughness"},
        {"ugsnf_4K_Cavity.jpg", ""},
        {"T_ugsnf_2K_B-O.jpg", "base_color opacity.a"},
        {"T_ugsnf_2K_ORDp.jpg", "occlusion roughness.g"},
        /* Unreal */
        {"T_Sofa_BC.tga", "base_color"},
        {"T_Sofa_D.tga", "base_color"},
        {"T_Sofa_N.tga", "normal"},
        {"T_Sofa_ORM.tga", "occlusion roughness.g metallic.b"},
        {"T_Sofa_MRA.tga", "metallic roughness.g occlusion.b"},
        {"T_Sofa_MRAO.tga", "metallic roughness.g occlusion.b"},
        {"T_Sofa_RMA.tga", "roughness metallic.g occlusion.b"},
        {"T_Sofa_E.tga", "emission"},
        {"T_Sofa_R.tga", "roughness"},
        /* textures.com, cgbookcase, 3dtextures, freepbr, Texture Can, ShareTextures */
        {"TexturesCom_Fabric_Plain1_0.5x0.5_1K_albedo.png", "base_color"},
        {"TexturesCom_Fabric_Plain1_1K_normal.png", "normal"},
        {"Fabric12_MR_4K.png", ""},
        {"Fabric12_4K_BaseColor.png", "base_color"},
        {"Fabric_020_ambientOcclusion.jpg", "occlusion"},
        {"Fabric_020_OCC.jpg", "occlusion"},
        {"Fabric_020_SPEC.jpg", "specular_color"},
        {"denim-normal-ogl.png", "normal+"},
        {"denim_normal-dx.png", "normal-"},
        {"fabric_0008_normal_opengl_1k.png", "normal+"},
        {"fabric_0008_normal_directx_1k.png", "normal-"},
        {"fabric_1_ambientocclusion-1K.png", "occlusion"},
        {"wool 2048x2048 roughness 16bit.png", "roughness"},
        {"wool_ROUGHNESS_4096_sRGB_v2.PNG", "roughness"},
        {"wool.Base Colour.png", "base_color"},
        /* glTF, and parts in words */
        {"sofa_metallicRoughness.png", "roughness.g metallic.b"},
        {"sofa_metallic_roughness.png", "roughness.g metallic.b"},
        {"sofa_ao_rough_metal.png", "occlusion roughness.g metallic.b"},
        {"sofaBaseColor.png", "base_color"},
        {"velvet_dust_color.png", "dust_color"},
        /* a noun for the cloth is not a use, and what has none has none */
        {"rusty_metal_roughness_1k.png", "roughness"},
        {"metal_rough_ao_1k.png", "occlusion"},
        {"rusty_metal_rough_1k.png", "roughness"},
        {"Metal032_1K_Roughness.png", "roughness"},
        {"Metal032.png", ""},
        {"Fabric030.png", ""},
        {"Fabric030_1K.png", ""},
        {"n.png", ""},
        {"myroughness2.png", ""},
        {"charm.png", ""},
        {"sofa_DetailNormal.png", ""},
        {"sofa_world_space_normal.png", ""},
        {"sofa_transmission_color.png", ""},
        {"sofa_roughness_metallic.png", ""},
        {"sofa_height.png", ""},
        {"1k.png", ""},
        {".png", ""},
        {"", ""},
    };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp(uses_of(names[k].file), names[k].uses) != 0)
            fail_msg("%s: %s, not %s", names[k].file, uses_of(names[k].file), names[k].uses);
}

/* However many words a name has, and however long they are. */
static void long_names_are_cut(void **state) {
    (void)state;
    char name[600];
    for (int length = 1; length < 500; length += 7) {
        for (int k = 0; k < length; k++) name[k] = "ab_C."[k % 5];
        strcpy(name + length, "_x.png");
        (void)map_name(name);
        memset(name, 'a', (size_t)length);
        (void)map_name(name);
    }
}

static const char *in_folder(const char *name) {
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

/* A picture of 8 bits whose every texel is rgba; 255 in alpha is left out. */
static void draw(const char *name, int r, int g, int b, int a) {
    WeftImage image;
    WeftError error;
    const int channels = a == 255 ? 3 : 4, rgba[4] = {r, g, b, a};
    assert_int_equal(weft_image_create(8, 8, channels, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    for (int k = 0; k < 64 * channels; k++) ((unsigned char *)image.pixels)[k] = (unsigned char)rgba[k % channels];
    if (weft_image_write_as(in_folder(name), &image, &(WeftImageWriting){.data = 1}, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_image_free(&image);
}

/* The normals of bumps, green up or down. */
static void draw_normals(const char *name, double sign) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(64, 64, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *at = image.pixels;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++, at += 3) {
            const double u = (x + 0.5) / 64.0 * 6.2831853, v = (y + 0.5) / 64.0 * 6.2831853;
            const double p = 0.5 * cos(2.0 * u) * sin(v), q = 0.25 * sin(2.0 * u) * cos(v); /* h: sin 2u sin v / 4 */
            const double length = sqrt(1.0 + p * p + q * q), n[3] = {-p, sign * q, 1.0};
            for (int k = 0; k < 3; k++) at[k] = (unsigned char)(127.5 + 127.5 * n[k] / length + 0.5);
        }
    if (weft_image_write_as(in_folder(name), &image, &(WeftImageWriting){.data = 1}, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    weft_image_free(&image);
}

static char said[2048];
static void keep(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    size_t used = strlen(said);
    snprintf(said + used, sizeof said - used, "%s\n", text);
}

static WeftScene *bound(const char *name, int count) {
    const WeftLog log = {keep, NULL};
    WeftScene *scene = NULL;
    WeftError error;
    int found;
    said[0] = '\0';
    assert_int_equal(weft_scene_load("builtin:ball", &scene, NULL, &error), WEFT_OK);
    if (weft_scene_bind_maps(scene, "*", in_folder(name), &found, &log, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(found, count);
    return scene;
}

static const Input *input_of(const WeftScene *scene, InputId input) { return &scene->materials[0].inputs[input]; }

/* The value that an input reads at the first texel. */
static int texel(const WeftScene *scene, InputId input, int channel) {
    WeftImage image = weft_scene_texture(scene, input_of(scene, input)->texture);
    assert_non_null(image.pixels);
    return ((const unsigned char *)image.pixels)[channel];
}

static void green_up_is_preferred_and_green_down_is_turned(void **state) {
    (void)state;
    assert_int_equal(mkdir(in_folder("a"), 0700), 0);
    draw("a/twill_nor_dx_1k.png", 128, 100, 250, 255);
    WeftScene *scene = bound("a", 1);
    assert_int_equal(texel(scene, INPUT_normal, 1), 155);
    assert_non_null(strstr(said, "twill_nor_dx_1k.png: was repaired: its green points down"));
    /* bound again, as the window does when a file has changed, it is the same texture */
    const WeftLog log = {keep, NULL};
    WeftError error;
    const int images = scene->image_count;
    assert_int_equal(weft_scene_bind_maps(scene, "*", in_folder("a"), NULL, &log, &error), WEFT_OK);
    assert_int_equal(scene->image_count, images);
    assert_int_equal(weft_scene_read_texture(scene, input_of(scene, INPUT_normal)->texture, NULL, &error), WEFT_OK);
    assert_int_equal(texel(scene, INPUT_normal, 1), 155);
    /* the file as it is, on another input, is another texture */
    char file[256];
    snprintf(file, sizeof file, "%s", in_folder("a/twill_nor_dx_1k.png"));
    assert_int_equal(weft_scene_set_texture(scene, "*.roughness.g", file, NULL, &error), WEFT_OK);
    assert_int_equal(texel(scene, INPUT_roughness, 1), 100);
    assert_int_equal(texel(scene, INPUT_normal, 1), 155);
    weft_scene_free(scene);

    draw("a/twill_nor_gl_1k.png", 128, 160, 250, 255);
    scene = bound("a", 1);
    assert_int_equal(texel(scene, INPUT_normal, 1), 160);
    assert_non_null(strstr(said, "twill_nor_dx_1k.png: the map of normal is twill_nor_gl_1k.png"));
    weft_scene_free(scene);
}

/* Of a name that says nothing the slopes tell. */
static void green_of_an_unsaid_normal_map_is_seen(void **state) {
    (void)state;
    assert_int_equal(mkdir(in_folder("n"), 0700), 0);
    draw_normals("n/T_Sofa_N.png", 1.0); /* rows run down: -dh/dy of a picture with green up is +q */
    WeftScene *scene = bound("n", 1);
    const int up = texel(scene, INPUT_normal, 1);
    assert_string_equal(said, "");
    weft_scene_free(scene);
    draw_normals("n/T_Sofa_N.png", -1.0);
    scene = bound("n", 1);
    assert_in_range(texel(scene, INPUT_normal, 1), up - 1, up + 1);
    assert_non_null(strstr(said, "T_Sofa_N.png: was repaired"));
    weft_scene_free(scene);
}

static void gloss_becomes_roughness_and_is_saved_as_such(void **state) {
    (void)state;
    assert_int_equal(mkdir(in_folder("g"), 0700), 0);
    draw("g/Fabric_COL_3K.png", 50, 60, 70, 255);
    draw("g/Fabric_GLOSS_3K.png", 200, 200, 200, 255);
    WeftScene *scene = bound("g", 2), *again = NULL;
    WeftError error;
    char file[256];
    assert_int_equal(texel(scene, INPUT_roughness, 0), 55);
    assert_string_equal(said, "");
    snprintf(file, sizeof file, "%s", in_folder("saved.json"));
    assert_int_equal(weft_scene_save_material(scene, 0, file, &error), WEFT_OK);
    weft_scene_free(scene);
    assert_int_equal(weft_scene_load("builtin:ball", &again, NULL, &error), WEFT_OK);
    assert_int_equal(weft_scene_assign_material(again, "*", file, NULL, &error), WEFT_OK);
    assert_int_equal(texel(again, INPUT_roughness, 0), 55);
    assert_int_equal(texel(again, INPUT_base_color, 0), 50);
    weft_scene_free(again);
    draw("g/Fabric_ROUGHNESS_3K.png", 33, 33, 33, 255); /* one that need not be turned is better */
    scene = bound("g", 2);
    assert_int_equal(texel(scene, INPUT_roughness, 0), 33);
    weft_scene_free(scene);
}

static void mask_map_has_three_inputs(void **state) {
    (void)state;
    assert_int_equal(mkdir(in_folder("u"), 0700), 0);
    draw("u/sofa_BaseMap.png", 50, 60, 70, 255);
    draw("u/sofa_MaskMap.png", 10, 20, 30, 40);
    draw("u/sofa_Height.png", 1, 1, 1, 255);
    FILE *stream = fopen(in_folder("u/sofa_Normal.psd"), "wb");
    assert_true(stream && fputs("8BPS", stream) >= 0 && fclose(stream) == 0);
    WeftScene *scene = bound("u", 2);
    assert_int_equal(texel(scene, INPUT_metallic, 0), 10);
    assert_int_equal(input_of(scene, INPUT_occlusion)->channel, 1);
    assert_int_equal(input_of(scene, INPUT_roughness)->channel, 3);
    assert_int_equal(texel(scene, INPUT_roughness, 3), 215);
    assert_non_null(strstr(said, "no input has a map of this name: sofa_Height.png"));
    assert_non_null(strstr(said, "convert to .png: sofa_Normal.psd"));
    weft_scene_free(scene);
    draw("u/sofa_MaskMap.png", 10, 20, 30, 255); /* without alpha */
    scene = bound("u", 2);
    assert_int_equal(input_of(scene, INPUT_roughness)->texture, 0);
    assert_non_null(strstr(said, "sofa_MaskMap.png: it has no alpha, where by its name the map of roughness is"));
    weft_scene_free(scene);
}

static void sets_that_are_mixed_are_told(void **state) {
    (void)state;
    assert_int_equal(mkdir(in_folder("sets"), 0700), 0);
    draw("sets/red_wool_Albedo.png", 200, 20, 30, 255);
    draw("sets/red_wool_mixed_AO_2K.png", 10, 20, 30, 255);
    WeftScene *scene = bound("sets", 2);
    if (strstr(said, "two sets")) fail_msg("%s", said);
    weft_scene_free(scene);
    draw("sets/blue_silk_Roughness.png", 10, 20, 30, 255);
    scene = bound("sets", 3);
    if (!strstr(said, "blue_silk_Roughness.png and red_wool_Albedo.png seem to be of two sets")) fail_msg("%s", said);
    weft_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_many_makers_are_understood),
        cmocka_unit_test(long_names_are_cut),
        cmocka_unit_test(green_up_is_preferred_and_green_down_is_turned),
        cmocka_unit_test(green_of_an_unsaid_normal_map_is_seen),
        cmocka_unit_test(gloss_becomes_roughness_and_is_saved_as_such),
        cmocka_unit_test(mask_map_has_three_inputs),
        cmocka_unit_test(sets_that_are_mixed_are_told),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
