/* Materials, textures, images and variants. */
#include "reading.h"

#include <webp/encode.h>

#include <math.h>

#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf.h"
#include "image/codec.h"
#include "shading/material/choice.h"

/* PNG, 2 x 1: sRGB bytes 255 128 0, then 0 64 255. */
static const char png[] = "data:image/png;base64,"
                          "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR4nGP4"
                          "38DA4PAfAAoAAr+GE93DAAAAAElFTkSuQmCC";

/* The square with materials[0] = { material }, and before them what comes first: textures and so on. */
static Reading *read_material(const char *first, const char *material) {
    return read_rest(SQUARE_DATA ",%s'materials':[{%s}],'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
                                 ",'material':0}]}],'nodes':[{'mesh':0}]",
                     SQUARE_URI, first, material);
}

static char textures_text[512];

static const char *textures(void) {
    snprintf(textures_text, sizeof textures_text,
             "'images':[{'uri':'%s'}],'samplers':[{'wrapS':33071,'wrapT':33648,'magFilter':9728},{}],"
             "'textures':[{'source':0,'sampler':0},{'source':0,'sampler':1},{'source':0}],",
             png);
    return textures_text;
}

static void assert_input(const Reading *reading, InputId id, float r, float g, float b, int channel) {
    const Input *input = &reading->scene->materials[0].inputs[id];
    const float expected[3] = {r, g, b};
    assert_all_near(input->value, expected, input_infos[id].kind == WEFT_INPUT_COLOR ? 3 : 1, 1e-6f);
    assert_int_equal(input->texture > 0, channel >= 0);
    if (channel >= 0) assert_int_equal(input->channel, channel);
}

static void material_without_members_has_the_defaults(void **state) {
    (void)state;
    Reading *reading = read_material("", "");
    assert_read(reading);
    const Material *m = reading->scene->materials;
    assert_input(reading, INPUT_base_color, 1, 1, 1, -1);
    assert_input(reading, INPUT_opacity, 1, 0, 0, -1);
    assert_input(reading, INPUT_metallic, 1, 0, 0, -1);
    assert_input(reading, INPUT_roughness, 1, 0, 0, -1);
    assert_input(reading, INPUT_emission, 0, 0, 0, -1);
    assert_input(reading, INPUT_emission_strength, 1, 0, 0, -1);
    assert_input(reading, INPUT_ior, 1.5f, 0, 0, -1);
    assert_input(reading, INPUT_specular, 1, 0, 0, -1);
    assert_input(reading, INPUT_specular_color, 1, 1, 1, -1);
    assert_input(reading, INPUT_anisotropy, 0, 0, 0, -1);
    assert_input(reading, INPUT_clearcoat, 0, 0, 0, -1);
    assert_input(reading, INPUT_sheen_color, 0, 0, 0, -1);
    assert_input(reading, INPUT_sheen_roughness, 0, 0, 0, -1);
    assert_int_equal(m->alpha_mode, WEFT_ALPHA_OPAQUE);
    assert_near(m->alpha_cutoff, 0.5f, 0.0f);
    assert_false(m->double_sided);
    assert_false(m->unlit);
    assert_string_equal(reading->scene->material_names[0], "");
    done(reading);
    /* A surface without a material wears these defaults too, in a material behind the file's. */
    reading = read_rest(SQUARE_DATA ",'materials':[{'name':'x'}],'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
                                    "}]}],'nodes':[{'mesh':0}]",
                        SQUARE_URI);
    assert_read(reading);
    assert_int_equal(reading->scene->material_count, 2);
    assert_int_equal(reading->scene->meshes[0].material, 1);
    assert_near(reading->scene->materials[1].inputs[INPUT_metallic].value[0], 1.0f, 0.0f);
    done(reading);
}

/* Extensions that are pull requests yet, with each of their fields. */
static void material_with_coming_extensions_is_read(void **state) {
    (void)state;
    enum { R, G, B, A };
    Reading *reading = read_material(
        textures(),
        "'extensions':{'KHR_materials_fuzz':{'fuzzFactor':0.7,'fuzzTexture':{'index':0},'fuzzColorFactor':[0.2,0.3,"
        "0.4],'fuzzColorTexture':{'index':0},'fuzzRoughnessFactor':0.45,'fuzzRoughnessTexture':{'index':2}},"
        "'KHR_materials_sheen':{'sheenColorFactor':[0.4,0.5,0.6],'sheenRoughnessFactor':0.35},"
        "'KHR_materials_clearcoat':{'clearcoatFactor':0.1,'clearcoatRoughnessFactor':0.9},"
        "'KHR_materials_coat':{'coatFactor':0.8,'coatTexture':{'index':0},'coatRoughnessFactor':0.3,"
        "'coatRoughnessTexture':{'index':0},'coatNormalTexture':{'index':0,'scale':0.5},'coatIor':1.7,"
        "'coatColorFactor':[0.9,0.8,0.7],'coatColorTexture':{'index':0},'coatDarkeningFactor':0.6,"
        "'coatAnisotropyStrength':0.4,'coatAnisotropyRotation':-1,'coatAnisotropyTexture':{'index':0}},"
        "'KHR_materials_diffuse_roughness':{'diffuseRoughnessFactor':0.55,'diffuseRoughnessTexture':{'index':0}},"
        "'KHR_materials_retroreflection':{'retroreflectionFactor':0.65,'retroreflectionTexture':{'index':0}}}");
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    assert_input(reading, INPUT_fuzz, 0.7f, 0, 0, R);
    assert_input(reading, INPUT_fuzz_color, 0.2f, 0.3f, 0.4f, R);
    assert_input(reading, INPUT_fuzz_roughness, 0.45f, 0, 0, A);
    assert_input(reading, INPUT_sheen_color, 0.4f, 0.5f, 0.6f, -1); /* beside the fuzz, for engines without */
    assert_input(reading, INPUT_sheen_roughness, 0.35f, 0, 0, -1);
    assert_input(reading, INPUT_clearcoat, 0.8f, 0, 0, R); /* the coat wins */
    assert_input(reading, INPUT_clearcoat_roughness, 0.3f, 0, 0, G);
    assert_input(reading, INPUT_clearcoat_normal, 0.5f, 0, 0, R);
    assert_input(reading, INPUT_coat_ior, 1.7f, 0, 0, -1);
    assert_input(reading, INPUT_coat_color, 0.9f, 0.8f, 0.7f, R);
    assert_input(reading, INPUT_coat_darkening, 0.6f, 0, 0, -1);
    assert_input(reading, INPUT_coat_anisotropy, 0.4f, 0, 0, B);
    assert_input(reading, INPUT_coat_anisotropy_direction, -1, 0, 0, R);
    assert_input(reading, INPUT_diffuse_roughness, 0.55f, 0, 0, R);
    assert_input(reading, INPUT_retroreflection, 0.65f, 0, 0, R);
    done(reading);
    /* what an empty object says: the text's default of the roughness of fuzz, a coat that darkens */
    reading = read_material("", "'extensions':{'KHR_materials_fuzz':{},'KHR_materials_coat':{},"
                                "'KHR_materials_diffuse_roughness':{},'KHR_materials_retroreflection':{}}");
    assert_read(reading);
    assert_input(reading, INPUT_fuzz, 0, 0, 0, -1);
    assert_input(reading, INPUT_fuzz_color, 1, 1, 1, -1);
    assert_input(reading, INPUT_fuzz_roughness, 0.5f, 0, 0, -1);
    assert_input(reading, INPUT_clearcoat, 0, 0, 0, -1);
    assert_input(reading, INPUT_coat_ior, 1.5f, 0, 0, -1);
    assert_input(reading, INPUT_coat_darkening, 1, 0, 0, -1);
    assert_input(reading, INPUT_diffuse_roughness, 0, 0, 0, -1);
    assert_input(reading, INPUT_retroreflection, 0, 0, 0, -1);
    done(reading);
    /* a clear coat without that extension does not darken */
    reading = read_material("", "'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':1}}");
    assert_input(reading, INPUT_coat_darkening, 0, 0, 0, -1);
    done(reading);
    reading = read_material("", "'extensions':{'KHR_materials_fuzz':{'fuzzFactor':3},"
                                "'KHR_materials_coat':{'coatIor':0.5}}");
    assert_read(reading);
    assert_input(reading, INPUT_fuzz, 1, 0, 0, -1);
    assert_input(reading, INPUT_coat_ior, 1, 0, 0, -1);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 2);
    done(reading);
    assert_refused(read_material("", "'extensions':{'KHR_materials_fuzz':{'fuzzColorFactor':'red'}}"),
                   WEFT_MESSAGE_GLTF_SCHEMA, "fuzzColorFactor");
}

static void material_with_every_extension_is_read(void **state) {
    (void)state;
    Reading *reading = read_material(
        textures(), "'name':'velvet','alphaMode':'MASK','alphaCutoff':0.25,'doubleSided':true,"
                    "'pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],'baseColorTexture':{'index':0},"
                    "'metallicFactor':0.5,'roughnessFactor':0.6,'metallicRoughnessTexture':{'index':1,'texCoord':1}},"
                    "'normalTexture':{'index':0,'scale':0.7},'occlusionTexture':{'index':0,'strength':0.8},"
                    "'emissiveFactor':[0.9,0.8,0.7],'emissiveTexture':{'index':0},'extensions':{"
                    "'KHR_materials_emissive_strength':{'emissiveStrength':5},'KHR_materials_ior':{'ior':1.33},"
                    "'KHR_materials_specular':{'specularFactor':0.3,'specularTexture':{'index':0},"
                    "'specularColorFactor':[2,1,0.5],'specularColorTexture':{'index':0}},"
                    "'KHR_materials_anisotropy':{'anisotropyStrength':0.6,'anisotropyRotation':-1,"
                    "'anisotropyTexture':{'index':0}},"
                    "'KHR_materials_clearcoat':{'clearcoatFactor':0.9,'clearcoatTexture':{'index':0},"
                    "'clearcoatRoughnessFactor':0.2,'clearcoatRoughnessTexture':{'index':0},"
                    "'clearcoatNormalTexture':{'index':0,'scale':0.5}},"
                    "'KHR_materials_sheen':{'sheenColorFactor':[0.4,0.5,0.6],'sheenColorTexture':{'index':0},"
                    "'sheenRoughnessFactor':0.35,'sheenRoughnessTexture':{'index':2}},'KHR_materials_unlit':{}}");
    assert_read(reading);
    const Material *m = reading->scene->materials;
    enum { R, G, B, A };
    assert_string_equal(reading->scene->material_names[0], "velvet");
    assert_int_equal(m->alpha_mode, WEFT_ALPHA_MASK);
    assert_near(m->alpha_cutoff, 0.25f, 0.0f);
    assert_true(m->double_sided && m->unlit);
    assert_input(reading, INPUT_base_color, 0.1f, 0.2f, 0.3f, R);
    assert_input(reading, INPUT_opacity, 0.4f, 0, 0, A);
    assert_input(reading, INPUT_metallic, 0.5f, 0, 0, B);
    assert_input(reading, INPUT_roughness, 0.6f, 0, 0, G);
    assert_int_equal(m->inputs[INPUT_roughness].texcoord, 1);
    assert_input(reading, INPUT_normal, 0.7f, 0, 0, R);
    assert_input(reading, INPUT_occlusion, 0.8f, 0, 0, R);
    assert_input(reading, INPUT_emission, 0.9f, 0.8f, 0.7f, R);
    assert_input(reading, INPUT_emission_strength, 5, 0, 0, -1);
    assert_input(reading, INPUT_ior, 1.33f, 0, 0, -1);
    assert_input(reading, INPUT_specular, 0.3f, 0, 0, A);
    assert_input(reading, INPUT_specular_color, 2, 1, 0.5f, R);
    assert_input(reading, INPUT_anisotropy, 0.6f, 0, 0, B);
    assert_input(reading, INPUT_anisotropy_direction, -1, 0, 0, R);
    assert_input(reading, INPUT_clearcoat, 0.9f, 0, 0, R);
    assert_input(reading, INPUT_clearcoat_roughness, 0.2f, 0, 0, G);
    assert_input(reading, INPUT_clearcoat_normal, 0.5f, 0, 0, R);
    assert_input(reading, INPUT_sheen_color, 0.4f, 0.5f, 0.6f, R);
    assert_input(reading, INPUT_sheen_roughness, 0.35f, 0, 0, A);
    /* Three textures of one image, decoded once. */
    assert_int_equal(reading->scene->texture_count, 3);
    assert_int_equal(reading->scene->image_count, 1);
    const Texture *sampled = &reading->scene->textures[m->inputs[INPUT_base_color].texture - 1];
    assert_int_equal(sampled->wrap_u, WRAP_CLAMP);
    assert_int_equal(sampled->wrap_v, WRAP_MIRROR);
    assert_true(sampled->nearest);
    sampled = &reading->scene->textures[m->inputs[INPUT_metallic].texture - 1];
    assert_int_equal(sampled->wrap_u, WRAP_REPEAT);
    assert_false(sampled->nearest);
    const WeftImage *image = reading->scene->images;
    assert_int_equal(image->width, 2);
    assert_int_equal(image->height, 1);
    assert_memory_equal(image->pixels, ((const unsigned char[]){255, 128, 0, 0, 64, 255}), 6);
    done(reading);
}

static void light_through_cloth_is_read(void **state) {
    (void)state;
    enum { R, A = 3 };
    Reading *reading = read_material(
        textures(), "'extensions':{'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':0.4,"
                    "'diffuseTransmissionTexture':{'index':1},'diffuseTransmissionColorFactor':[0.9,0.5,0.25],"
                    "'diffuseTransmissionColorTexture':{'index':1,'texCoord':1}}}");
    assert_read(reading);
    assert_input(reading, INPUT_diffuse_transmission, 0.4f, 0, 0, A);
    assert_input(reading, INPUT_diffuse_transmission_color, 0.9f, 0.5f, 0.25f, R);
    assert_int_equal(reading->scene->materials[0].inputs[INPUT_diffuse_transmission_color].texcoord, 1);
    done(reading);
    reading = read_material("", "'extensions':{'KHR_materials_diffuse_transmission':{}}");
    assert_read(reading);
    assert_input(reading, INPUT_diffuse_transmission, 0, 0, 0, -1);
    assert_input(reading, INPUT_diffuse_transmission_color, 1, 1, 1, -1);
    done(reading);
    assert_refused(
        read_material("", "'extensions':{'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':'thin'}}"),
        WEFT_MESSAGE_GLTF_SCHEMA,
        "materials[0].extensions.KHR_materials_diffuse_transmission.diffuseTransmissionFactor: expected a "
        "number");
}

static void glass_is_read(void **state) {
    (void)state;
    enum { R, G };
    Reading *reading = read_material(
        textures(), "'extensions':{'KHR_materials_transmission':{'transmissionFactor':0.8,'transmissionTexture':"
                    "{'index':1}},'KHR_materials_volume':{'thicknessFactor':0.2,'thicknessTexture':{'index':1},"
                    "'attenuationDistance':0.5,'attenuationColor':[0.9,0.5,0.25]},'KHR_materials_ior':{'ior':1.33}}");
    assert_read(reading);
    assert_input(reading, INPUT_transmission, 0.8f, 0, 0, R);
    assert_input(reading, INPUT_thickness, 0.2f, 0, 0, G);
    assert_input(reading, INPUT_attenuation_distance, 0.5f, 0, 0, -1);
    assert_input(reading, INPUT_attenuation_color, 0.9f, 0.5f, 0.25f, -1);
    assert_input(reading, INPUT_ior, 1.33f, 0, 0, -1);
    assert_null(strstr(reading->warning, "KHR_materials"));
    done(reading);
    reading = read_material("", "'extensions':{'KHR_materials_transmission':{},'KHR_materials_volume':{}}");
    assert_read(reading);
    assert_input(reading, INPUT_transmission, 0, 0, 0, -1);
    assert_input(reading, INPUT_thickness, 0, 0, 0, -1);
    assert_input(reading, INPUT_attenuation_distance, 0, 0, 0, -1);
    assert_input(reading, INPUT_attenuation_color, 1, 1, 1, -1);
    done(reading);
}

/* Numbers that make no sense: clamped with a line, or refused with one. */
static void wrong_numbers_of_glass_are_named(void **state) {
    (void)state;
    static const struct {
        const char *volume, *warning;
        InputId input;
        float taken;
    } cases[] = {
        {"'attenuationDistance':0", "KHR_materials_volume.attenuationDistance: 0 is taken as infinite",
         INPUT_attenuation_distance, 0.0f},
        {"'attenuationDistance':-2", "KHR_materials_volume.attenuationDistance", INPUT_attenuation_distance, 0.0f},
        {"'thicknessFactor':-1", "KHR_materials_volume.thicknessFactor", INPUT_thickness, 0.0f},
        {"'attenuationColor':[2,1,1]", "KHR_materials_volume.attenuationColor", INPUT_attenuation_color, 1.0f},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char material[256];
        snprintf(material, sizeof material, "'extensions':{'KHR_materials_volume':{%s}}", cases[k].volume);
        Reading *reading = read_material("", material);
        assert_read(reading);
        if (!strstr(reading->warning, cases[k].warning)) fail_msg("%s: %s", cases[k].volume, reading->warning);
        assert_float_equal(reading->scene->materials[0].inputs[cases[k].input].value[0], cases[k].taken, 0.0f);
        done(reading);
    }
    assert_refused(read_material("", "'extensions':{'KHR_materials_transmission':{'transmissionFactor':'clear'}}"),
                   WEFT_MESSAGE_GLTF_SCHEMA,
                   "materials[0].extensions.KHR_materials_transmission.transmissionFactor: expected a number");
}

/* The asset opens even where it requires them, and one line says what is not shown. */
static void extensions_that_are_left_out_say_what_is_lost(void **state) {
    (void)state;
    static const struct {
        const char *name, *lost;
    } cases[] = {{"KHR_materials_iridescence", "KHR_materials_iridescence: the colours of its thin films are left out"},
                 {"KHR_materials_dispersion", "KHR_materials_dispersion: its glass bends all colours alike"}};
    for (size_t k = 0; k < 2; k++) {
        char first[256], material[128];
        snprintf(first, sizeof first, "'extensionsUsed':['%s'],'extensionsRequired':['%s'],", cases[k].name,
                 cases[k].name);
        snprintf(material, sizeof material, "'extensions':{'%s':{}}", cases[k].name);
        Reading *reading = read_material(first, material);
        assert_read(reading);
        assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_EXTENSION], 1);
        if (!strstr(reading->warning, cases[k].lost)) fail_msg("%s", reading->warning);
        done(reading);
    }
}

/* Two texels of RGBA as a data URI. */
static const char *picture(const unsigned char texels[8]) {
    const WeftImageWriting how = {.data = 1};
    WeftImage image;
    WeftError error;
    char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(weft_image_create(2, 1, 4, WEFT_PIXEL_U8, &image, &error), WEFT_OK);
    memcpy(image.pixels, texels, 8);
    FILE *stream = open_memstream(&bytes, &size);
    assert_int_equal(image_write_png(stream, "two texels", &image, &how, &error), WEFT_OK);
    assert_int_equal(fclose(stream), 0);
    const char *text = uri(bytes, size);
    weft_image_free(&image);
    free(bytes);
    return text;
}

/* One number of an input at u, its factor times its picture. */
static float number_at(const Reading *reading, InputId id, int channel, float u) {
    const WeftScene *scene = reading->scene;
    const Input *input = &scene->materials[0].inputs[id];
    const bool color = input_infos[id].kind == WEFT_INPUT_COLOR;
    const SrgbTable srgb = srgb_table();
    if (!input->texture) return input->value[color ? channel : 0];
    const Texel texel =
        texture_fetch(&scene->textures[input->texture - 1], scene->images, color ? &srgb : NULL, u, 0.5f);
    return input->value[color ? channel : 0] * texel.c[color ? channel : input->channel];
}

#define GLOSS(members) "'extensions':{'KHR_materials_pbrSpecularGlossiness':{" members "}}"

/* Diffuse colour and F0 as they are written, and roughness is what glossiness lacks to 1; the fallback for
 * readers without the extension does not count. */
static void glossiness_is_read_as_workflow_specular(void **state) {
    (void)state;
    Reading *reading = read_material(
        "'extensionsUsed':['KHR_materials_pbrSpecularGlossiness'],",
        "'pbrMetallicRoughness':{'baseColorFactor':[1,0,1,1],'roughnessFactor':0.1}," GLOSS(
            "'diffuseFactor':[0.6,0.05,0.04,0.5],'specularFactor':[0.04,0.05,0.06],'glossinessFactor':0.2"));
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    assert_string_equal(choice_id(CHOICE_workflow, reading->scene->materials[0].choices[CHOICE_workflow]), "specular");
    assert_input(reading, INPUT_base_color, 0.6f, 0.05f, 0.04f, -1);
    assert_input(reading, INPUT_opacity, 0.5f, 0, 0, -1);
    assert_input(reading, INPUT_specular_color, 0.04f, 0.05f, 0.06f, -1);
    assert_input(reading, INPUT_roughness, 0.8f, 0, 0, -1);
    assert_input(reading, INPUT_metallic, 0, 0, 0, -1);
    done(reading);
    reading = read_material("", GLOSS(""));
    assert_read(reading);
    assert_input(reading, INPUT_base_color, 1, 1, 1, -1);
    assert_input(reading, INPUT_specular_color, 1, 1, 1, -1);
    assert_input(reading, INPUT_roughness, 0, 0, 0, -1);
    done(reading);
    assert_refused(read_material("", GLOSS("'glossinessFactor':'high'")), WEFT_MESSAGE_GLTF_SCHEMA,
                   "KHR_materials_pbrSpecularGlossiness.glossinessFactor: expected a number");
}

/* Colours of the picture are decoded from sRGB, its alpha is glossiness, both are times their factors. */
static void picture_of_glossiness_becomes_one_of_roughness(void **state) {
    (void)state;
    static const unsigned char texels[8] = {255, 0, 188, 255, 255, 0, 188, 51};
    char *first = json("'images':[{'uri':'%s'},{'uri':'%s'}],'samplers':[{'magFilter':9728}],"
                       "'textures':[{'source':0,'sampler':0},{'source':1,'sampler':0}],",
                       picture(texels), png);
    Reading *reading = read_material(
        first, GLOSS("'specularFactor':[1,1,0.5],'glossinessFactor':0.5,'specularGlossinessTexture':{'index':0},"
                     "'diffuseTexture':{'index':0}"));
    assert_read(reading);
    assert_int_equal(reading->scene->image_count, 2);
    assert_near(number_at(reading, INPUT_roughness, 0, 0.25f), 0.5f, 1e-4f);
    assert_near(number_at(reading, INPUT_roughness, 0, 0.75f), 0.9f, 1e-4f);
    assert_near(number_at(reading, INPUT_specular_color, 0, 0.75f), 1.0f, 1e-5f);
    assert_near(number_at(reading, INPUT_specular_color, 2, 0.75f), 0.5f * 0.5028865f, 1e-4f);
    assert_near(number_at(reading, INPUT_base_color, 2, 0.25f), 0.5028865f, 1e-4f);
    assert_near(number_at(reading, INPUT_opacity, 0, 0.75f), 0.2f, 1e-4f);
    done(reading);
    /* A picture without alpha has an alpha of 1. */
    reading = read_material(first, GLOSS("'glossinessFactor':0.25,'specularGlossinessTexture':{'index':1}"));
    free(first);
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "specularGlossinessTexture: its picture has no alpha"));
    assert_int_equal(reading->scene->image_count, 1);
    assert_near(number_at(reading, INPUT_roughness, 0, 0.25f), 0.75f, 1e-6f);
    assert_near(number_at(reading, INPUT_specular_color, 0, 0.25f), 1.0f, 1e-6f);
    done(reading);
}

/* extras belong to whoever wrote them; ours are in extras.weft. */
static void nap_of_the_extras_is_read(void **state) {
    (void)state;
    enum { R, G, B };
    Reading *reading = read_material(textures(), "'extras':{'weft':{'sheenDensity':2.5,'nap':0.7,"
                                                 "'napRotation':-1,'napTexture':{'index':1}},'other':[1]}");
    assert_read(reading);
    assert_input(reading, INPUT_sheen_density, 2.5f, 0, 0, -1);
    assert_input(reading, INPUT_nap, 0.7f, 0, 0, B);
    assert_input(reading, INPUT_nap_direction, -1, 0, 0, R);
    assert_int_equal(reading->scene->image_count, 1);
    assert_string_equal(reading->warning, "");
    done(reading);
    static const char *const foreign[] = {"", "'extras':{}", "'extras':'weft'", "'extras':[{'weft':1}]"};
    for (size_t k = 0; k < sizeof foreign / sizeof *foreign; k++) {
        reading = read_material("", foreign[k]);
        assert_read(reading);
        assert_input(reading, INPUT_sheen_density, 1, 0, 0, -1);
        assert_input(reading, INPUT_nap, 0, 0, 0, -1);
        assert_input(reading, INPUT_nap_direction, 0, 0, 0, -1);
        assert_string_equal(reading->warning, "");
        done(reading);
    }
    reading = read_material("", "'extras':{'weft':{'nap':4,'napp':1}}");
    assert_read(reading);
    assert_input(reading, INPUT_nap, 1.57079633f, 0, 0, -1);
    assert_non_null(strstr(reading->warning, "napp"));
    done(reading);
    assert_refused(read_material("", "'extras':{'weft':{'nap':'steep'}}"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "materials[0].extras.weft.nap: expected a number");
    assert_refused(read_material("", "'extras':{'weft':7}"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "materials[0].extras.weft: expected an object");
    assert_refused(read_material("", "'extras':{'weft':{'napTexture':{'index':0}}}"), WEFT_MESSAGE_GLTF_REFERENCE,
                   "napTexture.index: 0 of 0");
}

static void dust_of_the_extras_is_read(void **state) {
    (void)state;
    enum { R };
    Reading *reading = read_material(
        textures(), "'extras':{'weft':{'dust':0.4,'dustTexture':{'index':1},'dustColor':[0.5,0.25,0.125],"
                    "'dustRoughness':0.7,'dustFalloff':3,'dustTilt':0.5,'dustDirection':-2,'dustNoise':0.9,"
                    "'dustScale':0.2}}");
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    assert_input(reading, INPUT_dust, 0.4f, 0, 0, R);
    assert_input(reading, INPUT_dust_color, 0.5f, 0.25f, 0.125f, -1);
    assert_input(reading, INPUT_dust_roughness, 0.7f, 0, 0, -1);
    assert_input(reading, INPUT_dust_falloff, 3, 0, 0, -1);
    assert_input(reading, INPUT_dust_tilt, 0.5f, 0, 0, -1);
    assert_input(reading, INPUT_dust_direction, -2, 0, 0, -1);
    assert_input(reading, INPUT_dust_noise, 0.9f, 0, 0, -1);
    assert_input(reading, INPUT_dust_scale, 0.2f, 0, 0, -1);
    done(reading);
    reading = read_material("", "'extras':{'weft':{'dust':7,'dustTilt':-1,'dustScale':-1,'dusst':1}}");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 3);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    assert_input(reading, INPUT_dust, 1, 0, 0, -1);
    assert_input(reading, INPUT_dust_tilt, 0, 0, 0, -1);
    assert_input(reading, INPUT_dust_scale, 1e-4f, 0, 0, -1);
    assert_input(reading, INPUT_dust_color, 0.6f, 0.6f, 0.6f, -1);
    done(reading);
    assert_refused(read_material("", "'extras':{'weft':{'dustColor':0.5}}"), WEFT_MESSAGE_GLTF_SCHEMA,
                   "materials[0].extras.weft.dustColor");
}

static void texture_transform_is_applied(void **state) {
    (void)state;
    Reading *reading =
        read_material(textures(), "'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'texCoord':1,'extensions':{"
                                  "'KHR_texture_transform':{'offset':[-0.2,-0.1],'rotation':0.3,'scale':[1.5,1.5],"
                                  "'texCoord':0}}}}");
    assert_read(reading);
    /* The corner of the asset TextureTransformTest: (0.43, 0.75) must land on the arrow's tip. */
    for (int id = INPUT_base_color; id <= INPUT_opacity; id++) {
        const Input *input = &reading->scene->materials[0].inputs[id];
        const float *m = input->transform;
        assert_int_equal(input->texcoord, 0);
        assert_near(m[0] * 0.43f + m[1] * 0.75f + m[2], 0.75f, 0.01f);
        assert_near(m[3] * 0.43f + m[4] * 0.75f + m[5], 0.78f, 0.01f);
    }
    done(reading);
}

static void factors_outside_their_range_are_repaired_with_a_warning(void **state) {
    (void)state;
    Reading *reading = read_material("", "'pbrMetallicRoughness':{'roughnessFactor':1.5,'baseColorFactor':"
                                         "[2,-1,0.5,1]},'extensions':{'KHR_materials_ior':{'ior':0.5}}");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_REPAIRED], 4);
    assert_input(reading, INPUT_roughness, 1, 0, 0, -1);
    assert_input(reading, INPUT_base_color, 1, 0, 0.5f, -1);
    assert_input(reading, INPUT_ior, 1, 0, 0, -1);
    done(reading);
    reading = read_material("", "'extensions':{'KHR_materials_ior':{'ior':0}}");
    assert_read(reading);
    float ior = reading->scene->materials[0].inputs[INPUT_ior].value[0];
    assert_near((ior - 1.0f) / (ior + 1.0f), 1.0f, 1e-5f); /* reflects everything */
    done(reading);
    /* of three sets of coordinates the third is dropped */
    reading = read_material(textures(), "'normalTexture':{'index':0,'texCoord':4},'occlusionTexture':{'index':0,"
                                        "'texCoord':1},'emissiveTexture':{'index':0}");
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    assert_int_equal(reading->scene->materials[0].inputs[INPUT_normal].texcoord, 1);
    assert_int_equal(reading->scene->materials[0].inputs[INPUT_occlusion].texcoord, 0);
    assert_input(reading, INPUT_normal, 1, 0, 0, 0);
    assert_input(reading, INPUT_occlusion, 1, 0, 0, 0);
    assert_input(reading, INPUT_emission, 0, 0, 0, -1);
    done(reading);
}

static void material_members_of_wrong_type_are_named(void **state) {
    (void)state;
    static const struct {
        const char *material;
        WeftMessage message;
        const char *part;
    } cases[] = {
        {"'pbrMetallicRoughness':{'roughnessFactor':'1'}", WEFT_MESSAGE_GLTF_SCHEMA,
         "materials[0].pbrMetallicRoughness.roughnessFactor: expected a number, not \"1\""},
        {"'pbrMetallicRoughness':{'baseColorFactor':[1,1,1]}", WEFT_MESSAGE_GLTF_SCHEMA,
         "materials[0].pbrMetallicRoughness.baseColorFactor: expected an array of 4 numbers"},
        {"'pbrMetallicRoughness':{'baseColorFactor':[1,1,null,1]}", WEFT_MESSAGE_GLTF_SCHEMA,
         "baseColorFactor[2]: expected a number"},
        {"'pbrMetallicRoughness':3", WEFT_MESSAGE_GLTF_SCHEMA, "pbrMetallicRoughness: expected an object"},
        {"'alphaMode':7", WEFT_MESSAGE_GLTF_SCHEMA, "materials[0].alphaMode: expected a string, not 7"},
        {"'doubleSided':1", WEFT_MESSAGE_GLTF_SCHEMA, "materials[0].doubleSided: expected true or false"},
        {"'name':7", WEFT_MESSAGE_GLTF_SCHEMA, "materials[0].name: expected a string"},
        {"'normalTexture':{}", WEFT_MESSAGE_GLTF_SCHEMA, "materials[0].normalTexture.index: missing"},
        {"'normalTexture':{'index':0}", WEFT_MESSAGE_GLTF_REFERENCE, "materials[0].normalTexture.index: 0 of 0"},
        {"'extensions':{'KHR_materials_sheen':[]}", WEFT_MESSAGE_GLTF_SCHEMA,
         "materials[0].extensions.KHR_materials_sheen: expected an object"},
        {"'extensions':{'KHR_materials_sheen':{'sheenColorFactor':1}}", WEFT_MESSAGE_GLTF_SCHEMA,
         "materials[0].extensions.KHR_materials_sheen.sheenColorFactor: expected an array of 3"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_refused(read_material("", cases[i].material), cases[i].message, cases[i].part);
    assert_refused(read_material("'samplers':[{'wrapS':'clamp'}],", ""), WEFT_MESSAGE_GLTF_SCHEMA,
                   "samplers[0].wrapS: expected an integer from 0, not \"clamp\"");
    assert_refused(read_material("'textures':[{'source':3}],", ""), WEFT_MESSAGE_GLTF_REFERENCE,
                   "textures[0].source: 3 of 0");
}

/* A value that is read, but is none of those that glTF has, is named with its place; so is a name that means nothing.
 * The rest is shown. */
static void unknown_values_are_named_in_a_warning(void **state) {
    (void)state;
    static const struct {
        const char *first, *material, *warning;
    } cases[] = {
        {"", "'alphaMode':'CUTOUT'",
         "materials[0].alphaMode: \"CUTOUT\" is none of OPAQUE, MASK, BLEND; it is taken as OPAQUE"},
        {"", "'alphaMde':'MASK'", "materials[0].alphaMde"},
        {"", "'pbrMetallicRoughness':{'metalicFactor':0}", "materials[0].pbrMetallicRoughness.metalicFactor"},
        {"", "'extensions':{'KHR_materials_sheen':{'sheenColour':[1,1,1]}}",
         "materials[0].extensions.KHR_materials_sheen.sheenColour"},
        {"", "'extensions':{'EXT_materials_lustre':{}}", "ignored: EXT_materials_lustre"},
        {"'textures':[{}],", "'emissiveTexture':{'index':0}",
         "materials[0].emissiveTexture: textures[0] has no picture"},
        {"'samplers':[{'wrapS':1}],", "", "samplers[0].wrapS: 1 is no value of glTF's; it is taken as 10497"},
        {"'samplers':[{'wrapT':33070}],", "", "samplers[0].wrapT: 33070"},
        {"'samplers':[{'magFilter':9984}],", "", "samplers[0].magFilter: 9984"},
        {"'samplers':[{'minFilter':1}],", "", "samplers[0].minFilter: 1"},
        {"'samplers':[{'wrapR':10497}],", "", "samplers[0].wrapR"},
        {"", "'extras':{'weft':{'choices':{'colour':'red'}}}", "materials[0].extras.weft.choices.colour"},
        {"", "'extras':{'weft':{'choices':{'workflow':'glossy'}}}", "\"glossy\" means nothing"},
        {"", "'extras':{'weft':{'inputs':{'colour':{}}}}", "materials[0].extras.weft.inputs.colour"},
        {"", "'extras':{'weft':{'inputs':{'nap':{'values':[1]}}}}", "materials[0].extras.weft.inputs.nap.values"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Reading *reading = read_material(cases[k].first, cases[k].material);
        assert_read(reading);
        if (!strstr(reading->warning, cases[k].warning))
            fail_msg("\"%s\" is not \"%s\"", reading->warning, cases[k].warning);
        done(reading);
    }
    Reading *reading =
        read_material("'samplers':[{'wrapS':10497,'wrapT':33648,'magFilter':9728,'minFilter':9987}],",
                      "'alphaMode':'BLEND','extras':{'whatever':1},'extensions':{'KHR_materials_ior':{}}");
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    done(reading);
}

#define MAPPED "'normalTexture':{'index':0}"

/* Read, with a last warning that has this part, and without textures; then done. */
static void assert_unread(Reading *reading, const char *part) {
    assert_read(reading);
    if (!strstr(reading->warning, part)) fail_msg("%s", reading->warning);
    assert_int_equal(reading->scene->image_count, 0);
    assert_int_equal(reading->scene->texture_count, 0);
    assert_int_equal(reading->scene->materials[0].inputs[INPUT_normal].texture, 0);
    done(reading);
}

static void images_in_views_uris_and_files_are_found(void **state) {
    (void)state;
    /* In a buffer view. */
    static const unsigned char bytes[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
        0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00,
        0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x10, 0x04, 0x00, 0x00, 0x13, 0x00, 0x12,
        0xa6, 0x0c, 0xbe, 0xd5, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    char *whole = json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':%zu,'uri':'%s'},"
                       "{'byteLength':48,'uri':'%s'}],'bufferViews':[{'buffer':0,'byteLength':%zu},"
                       "{'buffer':1,'byteLength':48}],'accessors':[{'bufferView':1,'componentType':5126,"
                       "'count':4,'type':'VEC3'}],'images':[{'bufferView':0}],'textures':[{'source':0}],"
                       "'materials':[{" MAPPED "}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                       "'mode':5,'material':0}]}],'nodes':[{'mesh':0}]}",
                       sizeof bytes, uri(bytes, sizeof bytes), SQUARE_URI, sizeof bytes);
    Reading *reading = read_gltf("view", whole, strlen(whole));
    free(whole);
    assert_read(reading);
    assert_int_equal(reading->scene->images[0].channels, 1);
    done(reading);
    /* Two images that are one are decoded once. */
    whole = json("{'asset':{'version':'2.0'},'buffers':[{'byteLength':%zu,'uri':'%s'},"
                 "{'byteLength':48,'uri':'%s'}],'bufferViews':[{'buffer':0,'byteLength':%zu},"
                 "{'buffer':1,'byteLength':48}],'accessors':[{'bufferView':1,'componentType':5126,"
                 "'count':4,'type':'VEC3'}],'images':[{'bufferView':0},{'bufferView':0}],"
                 "'textures':[{'source':0},{'source':1}],'materials':[{'normalTexture':{'index':0},"
                 "'occlusionTexture':{'index':0},'emissiveTexture':{'index':1}}],"
                 "'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                 "'mode':5,'material':0}]}],'nodes':[{'mesh':0}]}",
                 sizeof bytes, uri(bytes, sizeof bytes), SQUARE_URI, sizeof bytes);
    reading = read_gltf("view", whole, strlen(whole));
    free(whole);
    assert_read(reading);
    assert_int_equal(reading->scene->texture_count, 2);
    assert_int_equal(reading->scene->image_count, 1);
    done(reading);
    /* A URI that is not in base64 holds it too, unless it is damaged. */
    whole = json("'images':[{'uri':'%s'}],'textures':[{'source':0}],", percent_uri(bytes, sizeof bytes));
    reading = read_material(whole, MAPPED);
    free(whole);
    assert_read(reading);
    assert_int_equal(reading->scene->image_count, 1);
    assert_int_equal(reading->scene->images[0].channels, 1);
    done(reading);
    assert_unread(read_material("'images':[{'uri':'data:image/png,%89PN%4'}],'textures':[{'source':0}],", MAPPED),
                  "percent-encoding is damaged at character 5");
    /* One that does not decode is named, where it is needed; else nobody looks. */
    static const char bad[] = "'images':[{'uri':'data:image/png;base64,AAAAAAAA'}],'textures':[{'source':0}],";
    reading = read_material(bad, MAPPED);
    assert_unread(reading, "memory: images[0]");
    reading = read_material(bad, "");
    assert_read(reading);
    assert_int_equal(reading->scene->image_count, 0);
    done(reading);
    assert_refused(read_material("'images':[{}],'textures':[{'source':0}],", MAPPED), WEFT_MESSAGE_GLTF_SCHEMA,
                   "images[0]: it has neither");
    assert_unread(read_material("'images':[{'uri':'a.png'}],'textures':[{'source':0}],", MAPPED), "in memory");
}

/* One picture of two is missing: the asset opens with the other, and what the first fed is its factor. */
static void textures_whose_picture_cannot_be_read_are_left_out(void **state) {
    (void)state;
    char *first = json("'images':[{'uri':'data:image/png;base64,AAAAAAAA'},{'uri':'%s'}],"
                       "'textures':[{'source':0},{'source':1}],",
                       png);
    Reading *reading = read_material(first, "'pbrMetallicRoughness':{'baseColorFactor':[0.25,0.5,0.75,1],"
                                            "'baseColorTexture':{'index':0},'metallicRoughnessTexture':{'index':1}}");
    free(first);
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "memory: images[0]: is not an image"));
    assert_non_null(strstr(reading->warning, "; its textures are left out"));
    assert_int_equal(reading->scene->image_count, 1);
    assert_int_equal(reading->scene->texture_count, 1);
    assert_non_null(reading->scene->images[0].pixels);
    const Input *inputs = reading->scene->materials[0].inputs;
    assert_int_equal(inputs[INPUT_base_color].texture, 0);
    assert_int_equal(inputs[INPUT_opacity].texture, 0);
    assert_int_equal(inputs[INPUT_roughness].texture, 1);
    assert_near(inputs[INPUT_base_color].value[2], 0.75f, 1e-6f);
    done(reading);
}

/* Headers that together promise 2 GiB, each within what is believed of one: refused before any is decoded. */
static void images_of_too_many_pixels_together_are_refused(void **state) {
    (void)state;
    static const unsigned char header[] = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00,
                                           0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00,
                                           0x40, 0x00, 0x08, 0x06, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00};
    static const unsigned char frame[] = {0xff, 0xd8, 0xff, 0xe0, 0x00, 0x04, 0x00, 0x00, 0xff, 0xff, 0xc2, 0x00,
                                          0x11, 0x08, 0x40, 0x00, 0x40, 0x00, 0x03, 0x00, 0x00, 0x00, 0x00};
    static const unsigned char targa[] = {0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0x40, 32, 0};
    static const struct {
        const unsigned char *bytes;
        size_t size;
        const char *decoded;
    } cases[] = {{header, sizeof header, "decode to 1073741824"},
                 {frame, sizeof frame, "decode to 1610612736"},
                 {targa, sizeof targa, "decode to 2147483648"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *images = json("'images':[{'uri':'%s'},{'uri':'%s'}],'textures':[{'source':0},{'source':1}],",
                            uri(cases[i].bytes, cases[i].size), uri(cases[i].bytes, cases[i].size));
        assert_refused(read_material(images, MAPPED ",'emissiveTexture':{'index':1}"), WEFT_MESSAGE_GLTF_TOO_LARGE,
                       cases[i].decoded);
        free(images);
    }
}

/* Containers that cannot be read are offers: the plain source counts. */
static void texture_of_an_unreadable_container_falls_back_to_its_source(void **state) {
    (void)state;
    char *first = json("'extensionsUsed':['MSFT_texture_dds'],'images':[{'uri':'%s'},{'uri':'x.dds'}],"
                       "'textures':[{'source':0,'extensions':{'MSFT_texture_dds':{'source':1}}}],",
                       png);
    Reading *reading = read_material(first, MAPPED);
    free(first);
    assert_read(reading);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_EXTENSION], 1);
    assert_int_equal(reading->warnings[WEFT_MESSAGE_GLTF_WARN_IGNORED], 1);
    assert_int_equal(reading->scene->image_count, 1);
    done(reading);
    reading = read_material("'textures':[{'extensions':{'EXT_texture_avif':{'source':1}}}],", MAPPED);
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "EXT_texture_avif"));
    assert_input(reading, INPUT_normal, 1, 0, 0, -1);
    done(reading);
}

/* Where the picture of an extension cannot be read the plain one beside it is taken, once for all textures of it. */
static void plain_picture_is_taken_where_another_cannot_be_read(void **state) {
    (void)state;
    char *first = json("'images':[{'uri':'data:image/webp;base64,AAAAAAAA'},{'uri':'%s'}],"
                       "'textures':[{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}},"
                       "{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}],",
                       png);
    Reading *reading = read_material(first, MAPPED ",'emissiveTexture':{'index':1}");
    assert_read(reading);
    assert_non_null(strstr(reading->warning, "memory: images[0]: is not an image"));
    assert_non_null(strstr(reading->warning, "; the plain picture beside it is shown"));
    assert_int_equal(reading->scene->image_count, 1);
    assert_non_null(reading->scene->images[0].pixels);
    assert_int_equal(reading->scene->texture_count, 2);
    assert_int_equal(reading->scene->textures[1].image, 0);
    done(reading);
    free(first);
    /* Neither can be read. */
    reading = read_material("'images':[{'uri':'data:image/webp;base64,AAAAAAAA'},{'uri':'data:image/png;base64,AAAA'}],"
                            "'textures':[{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}],",
                            MAPPED);
    assert_unread(reading, "images[1]");
}

/* The picture of EXT_texture_webp is taken in place of the plain one, and may be required. */
static void pictures_of_webp_are_read(void **state) {
    (void)state;
    static const unsigned char texels[] = {10, 200, 30, 40, 50, 250};
    unsigned char *webp = NULL;
    const size_t size = WebPEncodeLosslessRGB(texels, 2, 1, 6, &webp);
    assert_true(size > 0);
    char *first = json("'extensionsUsed':['EXT_texture_webp'],'extensionsRequired':['EXT_texture_webp'],"
                       "'images':[{'uri':'%s'},{'uri':'%s'}],"
                       "'textures':[{'source':0,'extensions':{'EXT_texture_webp':{'source':1}}}],",
                       png, uri(webp, size));
    Reading *reading = read_material(first, MAPPED);
    free(first);
    WebPFree(webp);
    assert_read(reading);
    assert_string_equal(reading->warning, "");
    assert_int_equal(reading->scene->image_count, 1);
    assert_memory_equal(reading->scene->images[0].pixels, texels, 6);
    done(reading);
    first = json("'images':[{'uri':'%s'}],'textures':[{'extensions':{'EXT_texture_webp':{'source':1}}}],", png);
    assert_refused(read_material(first, MAPPED), WEFT_MESSAGE_GLTF_REFERENCE, "EXT_texture_webp.source: 1 of 1");
    free(first);
}

/* The picture of KHR_texture_basisu is taken in place of the plain one, and may be required; a damaged one is named. */
static void pictures_of_ktx2_are_read(void **state) {
    (void)state;
    static const unsigned char texel[] = {10, 200, 30};
    WeftImage image;
    char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(weft_image_create(8, 4, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    for (size_t n = 0; n < 32; n++) memcpy((unsigned char *)image.pixels + 3 * n, texel, 3);
    FILE *stream = open_memstream(&bytes, &size);
    assert_non_null(stream);
    assert_int_equal(image_write_ktx2(stream, "made", &image, &(WeftImageWriting){0}, NULL), WEFT_OK);
    assert_int_equal(fclose(stream), 0);
    static const char form[] = "'extensionsUsed':['KHR_texture_basisu'],'extensionsRequired':['KHR_texture_basisu'],"
                               "'images':[{'uri':'%s'},{'uri':'%s'}],"
                               "'textures':[{'source':0,'extensions':{'KHR_texture_basisu':{'source':1}}}],";
    for (int damaged = 0; damaged < 2; damaged++) {
        char *first = json(form, png, uri((unsigned char *)bytes, damaged ? 150 : size));
        Reading *reading = read_material(first, MAPPED);
        free(first);
        assert_read(reading);
        assert_int_equal(reading->scene->image_count, 1);
        assert_int_equal(reading->scene->images[0].width, damaged ? 2 : 8);
        if (damaged)
            assert_non_null(strstr(reading->warning, "images[1]"));
        else
            assert_memory_equal(reading->scene->images[0].pixels, image.pixels, 96);
        done(reading);
    }
    free(bytes);
    weft_image_free(&image);
}

static void material_variants_are_read(void **state) {
    (void)state;
    static const char form[] =
        SQUARE_DATA ",'extensions':{'KHR_materials_variants':{'variants':[{'name':'Mango'},{'name':'Peacock'},"
                    "{'name':'Plain'}]}},'materials':[{},{},{" MAPPED
                    "}],'textures':[{}],'meshes':[{'primitives':[{" SQUARE_PRIMITIVE
                    ",'material':0,'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,"
                    "'variants':[0]},{'material':%d,'variants':[%d]}]}}}]}],'nodes':[{'mesh':0}]";
    Reading *reading = read_rest(form, SQUARE_URI, 2, 2);
    assert_read(reading);
    assert_int_equal(reading->scene->variant_count, 3);
    assert_string_equal(reading->scene->variants[1], "Peacock");
    const Mesh *mesh = reading->scene->meshes;
    assert_int_equal(mesh->material, 0);
    assert_memory_equal(mesh->variant_material, ((const int[]){1, -1, 2}), 3 * sizeof(int));
    assert_non_null(mesh->tangent); /* which only the variant needs */
    done(reading);
    assert_refused(read_rest(form, SQUARE_URI, 3, 2), WEFT_MESSAGE_GLTF_REFERENCE, "mappings[1].material: 3 of 3");
    assert_refused(read_rest(form, SQUARE_URI, 2, 3), WEFT_MESSAGE_GLTF_REFERENCE, "variants[0]: 3 of 3");
}

/* What weft_scene_save writes: whole inputs and choices, kept within what they may be. */
static void saved_material_reads_as_it_was(void **state) {
    (void)state;
    Reading *reading = read_material(
        textures(), "'extras':{'weft':{'choices':{'workflow':'cloth','layer':'of the future','nothing':'x'},"
                    "'inputs':{'base_color':{'value':[0.1,0.2,0.3],'texture':1,'texCoord':1,'given':true,"
                    "'transform':[1,2,3,4,5,6]},'roughness':{'value':[9],'channel':2},"
                    "'nap':{'value':[1e300]},'normal':{},'nothing':{'value':7}},'alphaCutoff':0.25}}");
    assert_read(reading);
    const Material *m = reading->scene->materials;
    assert_int_equal(m->choices[CHOICE_workflow], 3);
    assert_int_equal(m->choices[CHOICE_layer], -1);
    assert_input(reading, INPUT_base_color, 0.1f, 0.2f, 0.3f, 0);
    assert_true(m->inputs[INPUT_base_color].given && m->inputs[INPUT_base_color].texcoord == 1);
    assert_near(m->inputs[INPUT_base_color].transform[5], 6.0f, 0.0f);
    assert_near(m->inputs[INPUT_roughness].value[0], 2.0f, 0.0f);
    assert_int_equal(m->inputs[INPUT_roughness].channel, 2);
    assert_near(m->inputs[INPUT_nap].value[0], 1.5707963f, 1e-6f);
    assert_near(m->alpha_cutoff, 0.25f, 0.0f);
    done(reading);
    static const struct {
        const char *weft, *text;
    } wrong[] = {
        {"'choices':7", "materials[0].extras.weft.choices: expected an object"},
        {"'choices':{'workflow':7}", "materials[0].extras.weft.choices.workflow: expected a string"},
        {"'inputs':[]", "materials[0].extras.weft.inputs: expected an object"},
        {"'inputs':{'nap':7}", "materials[0].extras.weft.inputs.nap: expected an object"},
        {"'inputs':{'nap':{'value':7}}", "materials[0].extras.weft.inputs.nap.value: expected an array"},
        {"'inputs':{'nap':{'value':[1,2]}}", "materials[0].extras.weft.inputs.nap.value: expected an array"},
        {"'inputs':{'nap':{'channel':4}}", "materials[0].extras.weft.inputs.nap.channel: expected an integer"},
        {"'inputs':{'nap':{'texCoord':-1}}", "materials[0].extras.weft.inputs.nap.texCoord: expected an integer"},
        {"'inputs':{'nap':{'transform':[1]}}", "materials[0].extras.weft.inputs.nap.transform: expected an array"},
        {"'alphaCutoff':'x'", "materials[0].extras.weft.alphaCutoff: expected a number"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char extras[160];
        snprintf(extras, sizeof extras, "'extras':{'weft':{%s}}", wrong[k].weft);
        assert_refused(read_material("", extras), WEFT_MESSAGE_GLTF_SCHEMA, wrong[k].text);
    }
    assert_refused(read_material("", "'extras':{'weft':{'inputs':{'nap':{'texture':3}}}}"), WEFT_MESSAGE_GLTF_REFERENCE,
                   "materials[0].extras.weft.inputs.nap.texture: 3 of 0");
}

static int rows_of(int input) {
    int rows = 0;
    for (const MaterialField *row = material_fields; row->factor; row++)
        rows += row->input == input && !material_field_replaces(row);
    return rows;
}

/* Readers, the writer and the doctor rely on this order. */
static void fields_of_an_object_and_of_a_texture_follow_one_another(void **state) {
    (void)state;
    for (const MaterialField *a = material_fields; a->factor; a++) {
        bool apart = false, other = false;
        for (const MaterialField *b = a + 1; b->factor; b++) {
            apart |= !material_fields_share(a, b);
            other |= !material_field_repeats(b);
            if (apart && material_fields_share(a, b)) fail_msg("%s and %s are apart", a->factor, b->factor);
            if (other && a->texture && b->texture && strcmp(a->texture, b->texture) == 0)
                fail_msg("%s: %s and %s are apart", a->texture, a->factor, b->factor);
        }
        assert_true(a->low < a->high && a->absent >= a->low && a->absent <= a->high);
        if (a->input == NO_INPUT) continue;
        const bool only_replaces = material_field_replaces(material_field_of((InputId)a->input));
        assert_int_equal(rows_of(a->input), only_replaces ? 0 : 1);
        if (!material_field_replaces(a)) assert_ptr_equal(material_field_of((InputId)a->input), a);
        if (material_field_extends(a)) assert_true(gltf_supports(a->object));
    }
    assert_false(gltf_supports("KHR_materials_iridescence"));
    assert_false(gltf_supports(pbr_object));
}

/* The channels of a row as docs/gltf.md writes them. */
static const char *const channel_words[] = {"R", "G", "B", "A", "A", "RGB", "RGB, A", "RGB", "RG"};

/* The page has a line for each texture that is read, with its channels. */
static void page_lists_the_channels_of_every_texture(void **state) {
    (void)state;
    FILE *file = fopen(WEFT_SOURCE_DIR "/docs/gltf.md", "r");
    assert_non_null(file);
    char line[512], name[128];
    for (const MaterialField *row = material_fields; row->factor; row++) {
        bool listed = false;
        if (row->input == NO_INPUT || !row->texture) continue;
        snprintf(name, sizeof name, "`%s`", row->texture);
        rewind(file);
        while (!listed && fgets(line, sizeof line, file)) {
            const char *cell = line[0] == '|' && strstr(line, name) ? strchr(line + 1, '|') : NULL;
            listed = cell && strstr(cell, channel_words[row->channels]) != NULL;
        }
        if (!listed)
            fail_msg("docs/gltf.md: %s is not said to be read from %s", row->texture, channel_words[row->channels]);
    }
    fclose(file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(material_without_members_has_the_defaults),
        cmocka_unit_test(material_with_every_extension_is_read),
        cmocka_unit_test(material_with_coming_extensions_is_read),
        cmocka_unit_test(texture_transform_is_applied),
        cmocka_unit_test(factors_outside_their_range_are_repaired_with_a_warning),
        cmocka_unit_test(material_members_of_wrong_type_are_named),
        cmocka_unit_test(unknown_values_are_named_in_a_warning),
        cmocka_unit_test(images_in_views_uris_and_files_are_found),
        cmocka_unit_test(images_of_too_many_pixels_together_are_refused),
        cmocka_unit_test(textures_whose_picture_cannot_be_read_are_left_out),
        cmocka_unit_test(plain_picture_is_taken_where_another_cannot_be_read),
        cmocka_unit_test(pictures_of_webp_are_read),
        cmocka_unit_test(pictures_of_ktx2_are_read),
        cmocka_unit_test(texture_of_an_unreadable_container_falls_back_to_its_source),
        cmocka_unit_test(material_variants_are_read),
        cmocka_unit_test(light_through_cloth_is_read),
        cmocka_unit_test(glass_is_read),
        cmocka_unit_test(wrong_numbers_of_glass_are_named),
        cmocka_unit_test(extensions_that_are_left_out_say_what_is_lost),
        cmocka_unit_test(glossiness_is_read_as_workflow_specular),
        cmocka_unit_test(picture_of_glossiness_becomes_one_of_roughness),
        cmocka_unit_test(nap_of_the_extras_is_read),
        cmocka_unit_test(dust_of_the_extras_is_read),
        cmocka_unit_test(saved_material_reads_as_it_was),
        cmocka_unit_test(page_lists_the_channels_of_every_texture),
        cmocka_unit_test(fields_of_an_object_and_of_a_texture_follow_one_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
