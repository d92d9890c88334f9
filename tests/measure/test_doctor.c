/* The doctor: for every finding an asset that has it and nothing else, one that has none; what is fixed stays
 * fixed and nothing else changes; real files and broken ones.
 *
 * Labels: unsanitized */
#include <dirent.h>
#include <math.h>
#include <time.h>
#include <unistd.h>

#include "gltf/reading.h"
#include "image/codec.h"
#include "measure/doctor/doctor.h"
#include "scratch.h"
#include "shading/material/choice.h"
#include "weft/doctor.h"
#include "weft/reflection.h"
#include "weft/save.h"

/* Pictures of 4 x 4 pixels. */
typedef enum Picture { COLORS, ALPHAS, BLACK, GREY, PLAIN, CHROME, LINEAR, DAMAGED, KTX2, BASIS } Picture;

static void paint(Picture picture, WeftImage *image) {
    WeftError error;
    int channels = picture == ALPHAS ? 4 : 3;
    assert_int_equal(weft_image_create(4, 4, channels, WEFT_PIXEL_U8, image, &error), WEFT_OK);
    uint8_t *p = image->pixels;
    for (int k = 0; k < 16; k++)
        for (int c = 0; c < channels; c++) {
            int value = 100 + 8 * k - 30 * c;
            if (picture == GREY) value = 180 + 4 * k;
            if (picture == BLACK) value = 0;
            if (picture == PLAIN) value = 200;
            if (picture == CHROME) value = k < 9 ? 230 : 0; /* the rest is paint */
            if (picture == ALPHAS && c == 3) value = 200 + 3 * k;
            p[channels * k + c] = (uint8_t)value;
        }
}

/* ISO/IEC 15948, annex D: the check of a chunk. */
static uint32_t crc(const unsigned char *bytes, size_t size) {
    uint32_t c = 0xffffffffu;
    for (size_t k = 0; k < size; k++) {
        c ^= bytes[k];
        for (int bit = 0; bit < 8; bit++) c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
    }
    return ~c;
}

/* Puts a chunk gAMA of 1 behind the header of a PNG. */
static void mark_linear(unsigned char *png, size_t *size) {
    enum { AT = 33, CHUNK = 16 };
    unsigned char chunk[CHUNK] = {0, 0, 0, 4, 'g', 'A', 'M', 'A', 0, 1, 0x86, 0xa0};
    uint32_t check = crc(chunk + 4, 8);
    for (int k = 0; k < 4; k++) chunk[12 + k] = (unsigned char)(check >> (24 - 8 * k));
    memmove(png + AT + CHUNK, png + AT, *size - AT);
    memcpy(png + AT, chunk, CHUNK);
    *size += CHUNK;
}

/* One pixel of NumPy's floats that is no number. */
static size_t damaged(unsigned char *out) {
    static const char head[] = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1), }";
    size_t length = 118;
    memcpy(out, "\x93NUMPY\x01\0", 8);
    out[8] = (unsigned char)length;
    out[9] = 0;
    memset(out + 10, ' ', length);
    memcpy(out + 10, head, sizeof head - 1);
    out[10 + length - 1] = '\n';
    memcpy(out + 10 + length, "\0\0\xc0\x7f", 4);
    return 14 + length;
}

static const char *picture_uri(Picture picture) {
    unsigned char bytes[4096];
    char *png = NULL;
    size_t size = 0;
    WeftImage image;
    WeftError error;
    const WeftImageWriting how = {.data = 1};
    if (picture == DAMAGED) return uri(bytes, damaged(bytes));
    if (picture == KTX2) return uri((const unsigned char *)"\xabKTX 20\xbb\r\n\x1a\n and more", 21);
    paint(picture, &image);
    FILE *stream = open_memstream(&png, &size);
    const WeftResult written = picture == BASIS ? image_write_ktx2(stream, "picture", &image, &how, &error)
                                                : image_write_png(stream, "picture", &image, &how, &error);
    assert_int_equal(written, WEFT_OK);
    fclose(stream);
    assert_true(size + 16 < sizeof bytes);
    memcpy(bytes, png, size);
    if (picture == LINEAR) mark_linear(bytes, &size);
    free(png);
    weft_image_free(&image);
    return uri(bytes, size);
}

#define CLOTH     "'pbrMetallicRoughness':{'baseColorFactor':[0.4,0.3,0.3,1],'metallicFactor':0}"
#define SHEEN     "'KHR_materials_sheen':{'sheenColorFactor':[0.5,0.4,0.4],'sheenRoughnessFactor':0.8}"
#define USED      "'KHR_materials_sheen'"
#define ALL       "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2},'indices':3,'material':0"
#define TWO_SIDED "'doubleSided':true,"

/* An asset as text: a square of one material, and what else is at its root. */
typedef struct Case {
    int kind;                            /* of finding; -1: none */
    const char *material;                /* its members */
    const char *used, *primitive, *rest; /* NULL: as usual */
    Picture picture;
} Case;

static const Case cases[] = {
    {-1, TWO_SIDED CLOTH ",'extensions':{" SHEEN "}", NULL, NULL, NULL, COLORS},
    {-1,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.9,0.8,0.8],'sheenColorTexture':"
                     "{'index':0},'sheenRoughnessFactor':1,'sheenRoughnessTexture':{'index':0}}}",
     NULL, NULL, NULL, ALPHAS},
    {WEFT_FINDING_EXTENSION_REQUIRED, TWO_SIDED CLOTH, NULL, NULL,
     "'extensionsUsed':['SOME_thing'],'extensionsRequired':['SOME_thing'],", COLORS},
    {WEFT_FINDING_EXTENSION_ARCHIVED,
     TWO_SIDED "'extensions':{'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[0.5,0.4,0.4,1],"
               "'specularFactor':[0.04,0.04,0.04],'glossinessFactor':0.2,'diffuseTexture':{'index':0}}}",
     "'KHR_materials_pbrSpecularGlossiness'", NULL, NULL, COLORS},
    {WEFT_FINDING_EXTENSION_IGNORED, TWO_SIDED CLOTH ",'extensions':{'EXT_materials_lustre':{'lustreFactor':1}}",
     "'EXT_materials_lustre'", NULL, NULL, COLORS},
    {WEFT_FINDING_EXTENSION_IGNORED,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_iridescence':{'iridescenceFactor':1}}",
     "'KHR_materials_iridescence'", NULL, NULL, COLORS},
    {WEFT_FINDING_EXTENSION_IGNORED, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_dispersion':{'dispersion':1}}",
     NULL, NULL, "'extensionsUsed':['KHR_materials_dispersion'],'extensionsRequired':['KHR_materials_dispersion'],",
     COLORS},
    {-1,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
                     "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2}}",
     "'KHR_materials_transmission','KHR_materials_volume'", NULL, NULL, COLORS},
    {WEFT_FINDING_VALUE_RANGE, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_volume':{'attenuationDistance':0}}",
     "'KHR_materials_volume'", NULL, NULL, COLORS},
    {-1, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_fuzz':{'fuzzFactor':1,'fuzzRoughnessFactor':0.4}}",
     "'KHR_materials_fuzz'", NULL, NULL, COLORS},
    {WEFT_FINDING_DEFAULT_DISPUTED, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_fuzz':{'fuzzFactor':1}}",
     "'KHR_materials_fuzz'", NULL, NULL, COLORS},
    {WEFT_FINDING_DEFAULT_DISPUTED, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_diffuse_roughness':{}}",
     "'KHR_materials_diffuse_roughness'", NULL, NULL, COLORS},
    {WEFT_FINDING_VALUE_RANGE, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_coat':{'coatFactor':1,'coatIor':0.5}}",
     "'KHR_materials_coat'", NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_UNSHOWN,
     TWO_SIDED "'pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{'index':0,'texCoord':2}},"
               "'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0},'extensions':{'KHR_materials_specular':"
               "{'specularColorTexture':{'index':0,'texCoord':3}}}",
     "'KHR_materials_specular'",
     "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,'TEXCOORD_2':2,'TEXCOORD_3':2},'indices':3,'material':0",
     NULL, COLORS},
    {-1, TWO_SIDED "'pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{'index':0,'texCoord':2}}", NULL,
     "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_2':2},'indices':3,'material':0", NULL, COLORS},
    {WEFT_FINDING_TEXCOORD_MISSING,
     TWO_SIDED "'pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{'index':0,'texCoord':2}}", NULL, NULL,
     NULL, COLORS},
    {WEFT_FINDING_TEXTURE_CHANNEL,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_specular':{'specularTexture':{'index':0}}}",
     "'KHR_materials_specular'", NULL, NULL, GREY},
    {WEFT_FINDING_TEXTURE_CHANNEL,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_diffuse_transmission':{'diffuseTransmissionFactor':0.5,"
                     "'diffuseTransmissionTexture':{'index':0}}}",
     "'KHR_materials_diffuse_transmission'", NULL, NULL, GREY},
    {WEFT_FINDING_TEXTURE_PLAIN,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_specular':{'specularTexture':{'index':0}}}",
     "'KHR_materials_specular'", NULL, NULL, PLAIN},
    {WEFT_FINDING_TEXTURE_PLAIN,
     TWO_SIDED "'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[0.9,0.9,0.9,1],'metallicFactor':0,"
               "'baseColorTexture':{'index':0}}",
     NULL, NULL, NULL, COLORS},
    {-1,
     TWO_SIDED "'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[0.9,0.9,0.9,0.5],'metallicFactor':0,"
               "'baseColorTexture':{'index':0}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_PART_IGNORED, TWO_SIDED CLOTH ",'alphaCutof':0.5", NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_PART_REPAIRED, TWO_SIDED CLOTH ",'alphaMode':'CUTOUT'", NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_REST_POSE, TWO_SIDED CLOTH, NULL, ALL ",'targets':[{'POSITION':0}]", NULL, COLORS},
    {WEFT_FINDING_EXTENSION_UNDECLARED, TWO_SIDED CLOTH ",'extensions':{" SHEEN "}", "'KHR_materials_ior'", NULL, NULL,
     COLORS},
    {WEFT_FINDING_VALUE_RANGE,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.5,1.5,0.5],"
                     "'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_VALUE_RANGE,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.5,0.5,0.5],"
                     "'sheenRoughnessFactor':1.25}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_VALUE_RANGE,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1],'metallicFactor':-0.5}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_VALUE_RANGE, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_ior':{'ior':0.5}}", "'KHR_materials_ior'",
     NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_TIMES_ZERO,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorTexture':{'index':0},"
                     "'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_TIMES_ZERO, TWO_SIDED CLOTH ",'emissiveTexture':{'index':0}", NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_OFF, TWO_SIDED CLOTH ",'emissiveFactor':[0,0,0],'emissiveTexture':{'index':0}", NULL, NULL,
     NULL, COLORS},
    {WEFT_FINDING_TEXTURE_TWO_SPACES,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorTexture':{'index':0},'metallicFactor':0,"
               "'metallicRoughnessTexture':{'index':0}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_SAYS_LINEAR,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1],'sheenColorTexture':{'index':0},"
                     "'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, LINEAR},
    {WEFT_FINDING_TEXTURE_TRANSFORM,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1],'sheenColorTexture':{'index':0,"
                     "'extensions':{'KHR_texture_transform':{'scale':[0,2]}}},'sheenRoughnessFactor':0.8}}",
     "'KHR_materials_sheen','KHR_texture_transform'", NULL, NULL, COLORS},
    {WEFT_FINDING_TEXTURE_TRANSFORM,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':1,'clearcoatTexture':"
                     "{'index':0,'extensions':{'KHR_texture_transform':{'scale':[0,2]}}}}}",
     "'KHR_materials_clearcoat','KHR_texture_transform'", NULL, NULL, COLORS},
    {WEFT_FINDING_TEXCOORD_MISSING, TWO_SIDED CLOTH ",'occlusionTexture':{'index':0}", NULL,
     "'attributes':{'POSITION':0,'NORMAL':1},'indices':3,'material':0", NULL, COLORS},
    {WEFT_FINDING_TEXCOORD_MISSING, TWO_SIDED CLOTH ",'occlusionTexture':{'index':0,'texCoord':1}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_IMAGE_REPAIRED, TWO_SIDED CLOTH ",'occlusionTexture':{'index':0}", NULL, NULL, NULL, DAMAGED},
    {WEFT_FINDING_IMAGE_BASIS, TWO_SIDED "'pbrMetallicRoughness':{'metallicFactor':0,'baseColorTexture':{'index':0}}",
     "'KHR_texture_basisu'", NULL, NULL, BASIS},
    {-1, TWO_SIDED CLOTH ",'occlusionTexture':{'index':0}", "'KHR_texture_basisu'", NULL, NULL, BASIS},
    {WEFT_FINDING_IMAGE_UNREAD, TWO_SIDED CLOTH ",'occlusionTexture':{'index':0}", NULL, NULL, NULL, KTX2},
    {WEFT_FINDING_SHEEN_BLACK, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_TEXTURE_BLACK,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1],'sheenColorTexture':{'index':0},"
                     "'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, BLACK},
    {WEFT_FINDING_SHEEN_ROUGHNESS_CHANNEL,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.4,0.4,0.4],"
                     "'sheenRoughnessTexture':{'index':0},'sheenRoughnessFactor':1}}",
     NULL, NULL, NULL, GREY},
    {WEFT_FINDING_SHEEN_ROUGHNESS_PLAIN,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.4,0.4,0.4],"
                     "'sheenRoughnessTexture':{'index':0},'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, PLAIN},
    {WEFT_FINDING_SHEEN_ROUGHNESS_PLAIN,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.9,0.8,0.8],'sheenColorTexture':"
                     "{'index':0},'sheenRoughnessTexture':{'index':0},'sheenRoughnessFactor':0.8}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_GAINS,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.8,0.8,1],'metallicFactor':0},'extensions':"
               "{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1],'sheenRoughnessFactor':0.45}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_DARKENS,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.8,0,1],'metallicFactor':0},'extensions':"
               "{'KHR_materials_sheen':{'sheenColorFactor':[0,0,1],'sheenRoughnessFactor':0.4}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_ENGINES_DIFFER,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.05,0.05,0.05,1],'metallicFactor':0},'extensions':"
               "{'KHR_materials_sheen':{'sheenColorFactor':[0.3,0.3,0.3],'sheenRoughnessFactor':0.3}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_ON_METAL,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1]},'extensions':{" SHEEN "}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_SHEEN_ON_METAL,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.5,0.5,1],'metallicFactor':0.4},'extensions':{" SHEEN
               "}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_TRANSMISSION,
     TWO_SIDED CLOTH ",'extensions':{" SHEEN ",'KHR_materials_transmission':{'transmissionFactor':0.5}}",
     "'KHR_materials_sheen','KHR_materials_transmission'", NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_BEHIND_GLASS,
     TWO_SIDED CLOTH ",'extensions':{" SHEEN "}},{" CLOTH ",'extensions':{'KHR_materials_transmission':"
                     "{'transmissionFactor':1}}",
     "'KHR_materials_sheen','KHR_materials_transmission'", NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_COAT,
     TWO_SIDED CLOTH ",'extensions':{" SHEEN ",'KHR_materials_clearcoat':{'clearcoatFactor':0.5}}",
     "'KHR_materials_sheen','KHR_materials_clearcoat'", NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_IOR, TWO_SIDED CLOTH ",'extensions':{" SHEEN ",'KHR_materials_ior':{'ior':1.4}}",
     "'KHR_materials_sheen','KHR_materials_ior'", NULL, NULL, COLORS},
    {WEFT_FINDING_SHEEN_EMISSION, TWO_SIDED CLOTH ",'emissiveFactor':[0.1,0,0],'extensions':{" SHEEN "}", NULL, NULL,
     NULL, COLORS},
    {WEFT_FINDING_BASE_DARK,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.001,0.001,0.001,1],'metallicFactor':0}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_BASE_BRIGHT,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.95,0.95,0.95,1],'metallicFactor':0},'extensions':"
               "{'KHR_materials_sheen':{'sheenColorFactor':[0.1,0.1,0.1],'sheenRoughnessFactor':0.9}}",
     NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_METAL_DARK, TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.2,0.2,0.2,1]}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_IMPLAUSIBLE, TWO_SIDED CLOTH ",'extensions':{'KHR_materials_ior':{'ior':3}}", "'KHR_materials_ior'",
     NULL, NULL, COLORS},
    {WEFT_FINDING_IMPLAUSIBLE,
     TWO_SIDED "'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.8,0.8,1],'metallicFactor':0.3}", NULL, NULL, NULL,
     COLORS},
    {WEFT_FINDING_NORMALS_MISSING, TWO_SIDED CLOTH, NULL, "'attributes':{'POSITION':0},'indices':3,'material':0", NULL,
     COLORS},
    {WEFT_FINDING_TANGENTS_MISSING, TWO_SIDED CLOTH ",'normalTexture':{'index':0}", NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_TANGENTS_MISSING,
     TWO_SIDED CLOTH ",'extensions':{'KHR_materials_anisotropy':{'anisotropyStrength':0.5}}",
     "'KHR_materials_anisotropy'", NULL, NULL, COLORS},
    {WEFT_FINDING_SCENE_EMPTY, TWO_SIDED CLOTH, NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_UV_UNEVEN, TWO_SIDED CLOTH ",'extensions':{" SHEEN "}", NULL, NULL, NULL, COLORS},
    {WEFT_FINDING_BACK_MISSING, CLOTH ",'extensions':{" SHEEN "}", NULL, NULL, NULL, COLORS},
};
enum { CASES = sizeof cases / sizeof *cases };

/* The nodes of a case: its square; for texture coordinates of two scales, once more and four times as large. */
static const char *nodes_of(const Case *c) {
    if (c->kind == WEFT_FINDING_UV_UNEVEN) return "{'mesh':0},{'mesh':0,'scale':[4,4,4]}";
    return c->kind == WEFT_FINDING_SCENE_EMPTY ? "{}" : "{'mesh':0}";
}

static char *case_text(const Case *c) {
    char used[300] = "";
    if (!c->rest) snprintf(used, sizeof used, "'extensionsUsed':[%s],", c->used ? c->used : USED);
    return json("{'asset':{'version':'2.0'},%s%s" SQUARE_DATA ",'images':[{'uri':'%s'}],'textures':[{%s}],"
                "'materials':[{%s}],'meshes':[{'primitives':[{%s}]}],'nodes':[%s]}\n",
                used, c->rest ? c->rest : "", SQUARE_URI, picture_uri(c->picture),
                c->picture == BASIS ? "'extensions':{'KHR_texture_basisu':{'source':0}}" : "'source':0", c->material,
                c->primitive ? c->primitive : ALL, nodes_of(c));
}

static WeftDoctor *examine(const char *text) {
    WeftDoctor *doctor;
    WeftError error;
    if (weft_doctor_open_memory(text, strlen(text), "case", &doctor, NULL, &error) != WEFT_OK)
        fail_msg("%s\n%s", error.text, text);
    return doctor;
}

/* The colour of the light through cloth is in RGB and its share in alpha, which no decoding changes. */
static void alpha_of_a_colour_is_no_second_space(void **state) {
    (void)state;
    const Case packed = {.material =
                             TWO_SIDED CLOTH ",'extensions':{'KHR_materials_diffuse_transmission':{"
                                             "'diffuseTransmissionFactor':1,'diffuseTransmissionTexture':{'index':0},"
                                             "'diffuseTransmissionColorTexture':{'index':0}}}",
                         .used = "'KHR_materials_diffuse_transmission'",
                         .picture = ALPHAS};
    char *text = case_text(&packed);
    WeftDoctor *doctor = examine(text);
    assert_int_equal(weft_doctor_count(doctor), 0);
    weft_doctor_close(doctor);
    free(text);
}

/* Chrome beside black paint: the mean of both is darker than metals are, but no texel of metal is. */
static void paint_and_chrome_in_one_map_are_not_a_dark_metal(void **state) {
    (void)state;
    char *chrome = strdup(picture_uri(CHROME));
    for (int dark = 0; dark < 2; dark++) {
        char *text = json("{'asset':{'version':'2.0'}," SQUARE_DATA ",'images':[{'uri':'%s'},{'uri':'%s'}],'textures':"
                          "[{'source':0},{'source':1}],'materials':[{'pbrMetallicRoughness':{'baseColorTexture':"
                          "{'index':0},'metallicRoughnessTexture':{'index':1},'baseColorFactor':[%s,1]}}],"
                          "'meshes':[{'primitives':[{%s}]}],'nodes':[{'mesh':0}]}\n",
                          SQUARE_URI, chrome, chrome, dark ? "0.5,0.5,0.5" : "1,1,1", ALL);
        WeftDoctor *doctor = examine(text);
        int found = 0;
        for (int k = 0; k < weft_doctor_count(doctor); k++)
            found += weft_doctor_finding(doctor, k)->kind == WEFT_FINDING_METAL_DARK;
        assert_int_equal(found, dark);
        weft_doctor_close(doctor);
        free(text);
    }
    free(chrome);
}

static void whole_words(const WeftFinding *finding) {
    assert_true(finding->words[0] && finding->fix[0] && finding->subject[0]);
    assert_true(strlen(finding->words) + 1 < sizeof finding->words);
    assert_true(strlen(finding->fix) + 1 < sizeof finding->fix);
    assert_null(strchr(finding->words, '\n'));
}

static void asset_of_each_fault_has_its_finding_alone(void **state) {
    (void)state;
    for (int k = 0; k < CASES; k++) {
        char *text = case_text(&cases[k]);
        WeftDoctor *doctor = examine(text);
        int count = weft_doctor_count(doctor);
        for (int f = 0; f < count; f++) {
            const WeftFinding *finding = weft_doctor_finding(doctor, f);
            whole_words(finding);
            if ((int)finding->kind != cases[k].kind)
                fail_msg("case %d (%s): found %s: %s", k,
                         cases[k].kind < 0 ? "clean" : weft_finding_name(cases[k].kind),
                         weft_finding_name((int)finding->kind), finding->words);
        }
        if ((count > 0) != (cases[k].kind >= 0))
            fail_msg("case %d: %d findings, not %s", k, count, weft_finding_name(cases[k].kind));
        weft_doctor_close(doctor);
        free(text);
    }
}

/* Each rule of KHR_texture_basisu, by a number of a good file that is changed. */
static void pictures_beyond_basis_universal_are_named(void **state) {
    (void)state;
    enum { DESCRIPTOR = 1000 }; /* stands for the place of the descriptor, which the header has */
    static const struct {
        size_t at;
        unsigned char value;
        const char *words;
    } changes[] = {{DESCRIPTOR + 12, 1, "neither ETC1S nor UASTC"},
                   {20, 3, "3 x 4, are no multiples of 4"},
                   {44, 3, "packed neither by BasisLZ nor by Zstandard"},
                   {32, 2, "not of type 2D"},
                   {36, 6, "not of type 2D"},
                   {DESCRIPTOR + 15, 1, "multiplied by alpha"},
                   {DESCRIPTOR + 14, 2, "that of sRGB, but it is used as occlusion"},
                   {0, 0, "KTXorientation is not rd"},
                   {4, 0, NULL}};
    unsigned char good[4096];
    char *bytes = NULL;
    size_t size = 0;
    WeftImage image;
    WeftError error;
    const WeftImageWriting how = {.data = 1};
    paint(COLORS, &image);
    FILE *stream = open_memstream(&bytes, &size);
    assert_int_equal(image_write_ktx2(stream, "picture", &image, &how, &error), WEFT_OK);
    fclose(stream);
    assert_true(size < sizeof good);
    for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
        memcpy(good, bytes, size);
        size_t at = changes[k].at;
        if (at >= DESCRIPTOR) at = at - DESCRIPTOR + (size_t)good[48] + 256 * (size_t)good[49];
        if (changes[k].words && at) good[at] = changes[k].value;
        for (size_t j = 0; !at && j + 17 < size; j++)
            if (memcmp(good + j, "KTXorientation", 15) == 0) good[j + 16] = 'u';
        char *text =
            json("{'asset':{'version':'2.0'},'extensionsUsed':['KHR_texture_basisu']," SQUARE_DATA
                 ",'images':[{'uri':'%s'}],'textures':[{'extensions':{'KHR_texture_basisu':{'source':0}}}],"
                 "'materials':[{" TWO_SIDED CLOTH ",'occlusionTexture':{'index':0}}],'meshes':[{'primitives':[{" ALL
                 "}]}],'nodes':[{'mesh':0}]}",
                 SQUARE_URI, uri(good, size));
        WeftDoctor *doctor = examine(text);
        const char *words = NULL;
        for (int f = 0; f < weft_doctor_count(doctor); f++)
            if (weft_doctor_finding(doctor, f)->kind == WEFT_FINDING_IMAGE_BASIS)
                words = weft_doctor_finding(doctor, f)->words;
        if ((words != NULL) != (changes[k].words != NULL) || (words && !strstr(words, changes[k].words)))
            fail_msg("%zu: \"%s\", not \"%s\"", k, words ? words : "", changes[k].words ? changes[k].words : "");
        weft_doctor_close(doctor);
        free(text);
    }
    free(bytes);
    weft_image_free(&image);
}

static void every_finding_has_a_case(void **state) {
    (void)state;
    for (int kind = 0; kind < WEFT_FINDING_COUNT; kind++) {
        bool tried = strncmp(weft_finding_name(kind), "u3m-", 4) == 0; /* by measure/doctor_u3m */
        for (int k = 0; k < CASES; k++) tried |= cases[k].kind == kind;
        if (!tried) fail_msg("%s: no asset has it", weft_finding_name(kind));
        assert_non_null(weft_finding_help(kind));
    }
    assert_null(weft_finding_name(-1));
    assert_null(weft_finding_name(WEFT_FINDING_COUNT));
    assert_string_equal(weft_severity_name(WEFT_SEVERITY_NOTE), "note");
    assert_string_equal(weft_severity_name(WEFT_SEVERITY_ERROR), "error");
    assert_null(weft_severity_name((WeftSeverity)(WEFT_SEVERITY_ERROR + 1)));
    assert_null(weft_severity_name((WeftSeverity)-1));
}

static json_t *load(const char *path) {
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    if (!root) fail_msg("%s: %s", path, error.text);
    return root;
}

/* Values that are in one document and not, or otherwise, in the other. */
static int differences(json_t *a, json_t *b) {
    int count = 0;
    const char *key;
    json_t *value;
    if (json_equal(a, b)) return 0;
    if (json_is_object(a) && json_is_object(b)) {
        json_object_foreach(a, key, value) { count += differences(value, json_object_get(b, key)); }
        json_object_foreach(b, key, value) { count += !json_object_get(a, key); }
        return count;
    }
    if (!json_is_array(a) || !json_is_array(b) || json_array_size(a) > json_array_size(b)) return 1;
    for (size_t k = 0; k < json_array_size(a); k++) count += differences(json_array_get(a, k), json_array_get(b, k));
    return count + (int)(json_array_size(b) - json_array_size(a));
}

/* A file is written, and examined again: what could be fixed is gone, and nothing but that place differs. */
static void fixed_asset_has_no_finding_left_to_fix(void **state) {
    (void)state;
    for (int k = 0; k < CASES; k++) {
        char *text = case_text(&cases[k]);
        FILE *stream = fopen("case.gltf", "w");
        assert_non_null(stream);
        fputs(text, stream);
        fclose(stream);
        WeftDoctor *doctor, *again;
        WeftError error;
        assert_int_equal(weft_doctor_open("case.gltf", &doctor, NULL, &error), WEFT_OK);
        int fixable = 0, count = weft_doctor_count(doctor);
        for (int f = 0; f < count; f++) {
            const WeftFinding *finding = weft_doctor_finding(doctor, f);
            fixable += finding->fixable;
            assert_true(weft_finding_fixable((int)finding->kind) || !finding->fixable);
        }
        if (weft_doctor_fix(doctor, "fixed.gltf", &error) != WEFT_OK) fail_msg("%s", error.text);
        if (weft_doctor_open("fixed.gltf", &again, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
        for (int f = 0; f < weft_doctor_count(again); f++)
            if (weft_doctor_finding(again, f)->fixable)
                fail_msg("case %d: %s is there still", k, weft_doctor_finding(again, f)->words);
        if (weft_doctor_count(again) != count - fixable)
            fail_msg("case %d: %d findings after %d of %d were fixed", k, weft_doctor_count(again), fixable, count);
        json_t *was = load("case.gltf"), *now = load("fixed.gltf");
        int different = differences(was, now), most = 3 * fixable; /* of a colour, three numbers; of a picture: */
        if (cases[k].kind == WEFT_FINDING_SHEEN_ROUGHNESS_CHANNEL) most = 3; /* image, texture, index */
        if (different > most || (fixable && !different))
            fail_msg("case %d: %d values differ, %d fixed", k, different, fixable);
        json_decref(was);
        json_decref(now);
        weft_doctor_close(doctor);
        weft_doctor_close(again);
        free(text);
    }
}

static const Case *case_of(int kind) {
    for (int k = 0; k < CASES; k++)
        if (cases[k].kind == kind) return &cases[k];
    return NULL;
}

/* The new picture holds as alpha what was painted as grey. */
static void fix_moves_sheen_roughness_to_alpha(void **state) {
    (void)state;
    char *text = case_text(case_of(WEFT_FINDING_SHEEN_ROUGHNESS_CHANNEL));
    WeftDoctor *doctor = examine(text);
    WeftError error;
    WeftScene *scene;
    assert_int_equal(weft_doctor_fix(doctor, "alpha.glb", &error), WEFT_OK);
    assert_int_equal(weft_scene_load("alpha.glb", &scene, NULL, &error), WEFT_OK);
    int input = weft_material_input_find("sheen_roughness");
    const Input *roughness = &scene->materials[0].inputs[input];
    assert_int_equal(roughness->channel, 3);
    const WeftImage *image = &scene->images[scene->textures[roughness->texture - 1].image];
    assert_int_equal(image->channels, 2);
    for (int k = 0; k < 16; k++) assert_int_equal(((uint8_t *)image->pixels)[2 * k + 1], 180 + 4 * k);
    weft_scene_free(scene);
    weft_doctor_close(doctor);
    free(text);
}

/* Materials that shared a picture share the one that takes its place; of another sampler they have another.
 */
static void fix_keeps_a_shared_roughness_shared(void **state) {
    (void)state;
    static const int expected[] = {3, 3, 3, 4};
#define ROUGH(texture)                                                                                                 \
    "{" CLOTH ",'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.4,0.4,0.4],"                                \
    "'sheenRoughnessTexture':{'index':" #texture "},'sheenRoughnessFactor':1}}}"
    char *text = json("{'asset':{'version':'2.0'},'extensionsUsed':[" USED "],'images':[{'uri':'%s'}],"
                      "'samplers':[{'wrapS':33071}],"
                      "'textures':[{'source':0},{'source':0},{'source':0,'sampler':0}],"
                      "'materials':[" ROUGH(0) "," ROUGH(0) "," ROUGH(1) "," ROUGH(2) "]}",
                      picture_uri(GREY));
#undef ROUGH
    WeftDoctor *doctor = examine(text);
    WeftError error;
    assert_int_equal(weft_doctor_count(doctor), 4);
    assert_int_equal(weft_doctor_fix(doctor, "shared.gltf", &error), WEFT_OK);
    json_t *now = load("shared.gltf"), *material;
    size_t k;
    assert_int_equal(json_array_size(json_object_get(now, "images")), 3);
    assert_int_equal(json_array_size(json_object_get(now, "textures")), 5);
    json_array_foreach(json_object_get(now, "materials"), k, material) {
        json_t *info = doctor_part(material, "extensions/KHR_materials_sheen/sheenRoughnessTexture/index");
        assert_int_equal(json_integer_value(info), expected[k]);
    }
    json_decref(now);
    weft_doctor_close(doctor);
    free(text);
}

/* Findings that differ in nothing but where they are. */
static void assert_same_words(const WeftFinding *a, const WeftFinding *b) {
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->engines, b->engines);
    assert_string_equal(a->words, b->words);
    assert_string_equal(a->fix, b->fix);
}

/* What is known of a material holds for its like, and for no other: not for one whose highlight alone
 * differs, nor for one of another sheen or another base. */
static void equal_materials_are_measured_once(void **state) {
    (void)state;
    static const char *const kinds[] = {"0.8,0.8,0.8,1],'roughnessFactor':1", "0.8,0.8,0.8,1],'roughnessFactor':0.3",
                                        "0.8,0.8,0.8,1],'roughnessFactor':1", "0.7,0.7,0.7,1],'roughnessFactor':1"};
    static const double roughness[] = {0.45, 0.45, 0.35, 0.45};
    enum { KINDS = 4 };
    WeftDoctor *alone[KINDS];
    char members[KINDS][400], all[4000] = "";
    for (int round = 0; round < 2; round++)
        for (int k = 0; k < KINDS; k++) {
            snprintf(members[k], sizeof members[k],
                     "'pbrMetallicRoughness':{'baseColorFactor':[%s,'metallicFactor':0},'extensions':"
                     "{'KHR_materials_sheen':{'sheenColorFactor':[1,1,1],'sheenRoughnessFactor':%g}}",
                     kinds[k], roughness[k]);
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s{%s}", all[0] ? "," : "", members[k]);
        }
    for (int k = 0; k < KINDS; k++) {
        char *text = json("{'asset':{'version':'2.0'},'extensionsUsed':[" USED "],'materials':[{%s}]}", members[k]);
        alone[k] = examine(text);
        assert_int_equal(weft_doctor_count(alone[k]), 1);
        for (int other = 0; other < k; other++)
            assert_string_not_equal(weft_doctor_finding(alone[k], 0)->words,
                                    weft_doctor_finding(alone[other], 0)->words);
        free(text);
    }
    char *text = json("{'asset':{'version':'2.0'},'extensionsUsed':[" USED "],'materials':[%s]}", all);
    WeftDoctor *together = examine(text);
    assert_int_equal(weft_doctor_count(together), 2 * KINDS);
    assert_int_equal(together->energy_count, KINDS);
    for (int k = 0; k < 2 * KINDS; k++)
        assert_same_words(weft_doctor_finding(together, k), weft_doctor_finding(alone[k % KINDS], 0));
    for (int k = 0; k < KINDS; k++) weft_doctor_close(alone[k]);
    weft_doctor_close(together);
    free(text);
}

/* The gain is what weft_reflection_albedo says of the same material, and the roughness that is advised has
 * none. */
/* A thousand sheens, none like another: two seconds of a processor are the goal, and a slower machine is
 * given three times that; it was twenty-five. */
static void doctor_of_a_thousand_sheens_takes_seconds(void **state) {
    (void)state;
    enum { SHEENS = 1000, ROOM = 400 };
    const char *shorter = getenv("WEFT_TEST_SHORT");
    char *all = calloc(SHEENS, ROOM);
    size_t used = 0;
    for (int k = 0; k < SHEENS; k++)
        used += (size_t)snprintf(all + used, ROOM,
                                 "%s{'pbrMetallicRoughness':{'baseColorFactor':[%.4f,0.3,0.3,1],'metallicFactor':0},"
                                 "'extensions':{'KHR_materials_sheen':{'sheenColorFactor':[0.5,%.4f,0.4],"
                                 "'sheenRoughnessFactor':%.4f}}}",
                                 k ? "," : "", 0.05 + 0.0007 * k, 0.9 - 0.0005 * k, 0.3 + 0.0005 * k);
    size_t size = used + 200;
    char *text = malloc(size);
    snprintf(text, size, "{'asset':{'version':'2.0'},'extensionsUsed':[" USED "],'materials':[%s]}", all);
    for (char *c = text; *c; c++)
        if (*c == '\'') *c = '"';
    const clock_t start = clock();
    WeftDoctor *doctor = examine(text);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    print_message("%d sheens: %.2f s\n", SHEENS, seconds);
    assert_true(weft_doctor_count(doctor) > 10);
    if (!shorter) assert_true(seconds < 6.0); /* sanitizers have no say in it */
    weft_doctor_close(doctor);
    free(text);
    free(all);
}

/* What the doctor makes of slices of light is what the material as a whole returns. */
static void slices_of_light_sum_to_the_albedo_of_the_material(void **state) {
    (void)state;
    static const char *const forms[] = {"'baseColorFactor':[0.8,0.5,0.2,1],'metallicFactor':0,'roughnessFactor':0.9",
                                        "'baseColorFactor':[0.6,0.6,0.6,1],'metallicFactor':1,'roughnessFactor':0.4",
                                        "'baseColorFactor':[0.9,0.9,0.9,1],'metallicFactor':0,'roughnessFactor':0.2"};
    for (size_t k = 0; k < sizeof forms / sizeof *forms; k++)
        for (int coat = 0; coat < 2; coat++) {
            char *text = json("{'asset':{'version':'2.0'},'materials':[{'pbrMetallicRoughness':{%s},'extensions':{%s"
                              "'KHR_materials_sheen':{'sheenColorFactor':[1,0.8,0.9],'sheenRoughnessFactor':0.437}}}]}",
                              forms[k], coat ? "'KHR_materials_clearcoat':{'clearcoatFactor':0.5}," : "");
            WeftDoctor *doctor = examine(text);
            const Cloth cloth = doctor_cloth(doctor, 0);
            for (int r = 0; doctor_readers[r]; r++)
                for (int c = 0; c < 3; c++) {
                    static const float cosines[] = {0.8f, 0.3f, 0.05f};
                    WeftMaterial material;
                    WeftReflection *reflection;
                    WeftError error;
                    float e[3], most = 0.0f;
                    assert_int_equal(weft_scene_material(doctor->scene, 0, &material, &error), WEFT_OK);
                    material.choices[CHOICE_profile] = choice_find(CHOICE_profile, doctor_readers[r]);
                    assert_int_equal(weft_reflection_create(&material, &reflection, &error), WEFT_OK);
                    weft_reflection_albedo(reflection, WEFT_PART_ALL, cosines[c], e);
                    for (int channel = 0; channel < 3; channel++) most = fmaxf(most, e[channel]);
                    const float got = doctor_albedo(doctor, &cloth, r, cosines[c]);
                    if (fabsf(got - most) > 0.015f * fmaxf(most, 1.0f))
                        fail_msg("%s, base %zu%s, cosine %g: %g, not %g", doctor_readers[r], k, coat ? ", coat" : "",
                                 (double)cosines[c], (double)got, (double)most);
                    weft_reflection_free(reflection);
                }
            weft_doctor_close(doctor);
            free(text);
        }
}

static void gain_of_a_sheen_is_measured(void **state) {
    (void)state;
    char *text = case_text(case_of(WEFT_FINDING_SHEEN_GAINS));
    WeftDoctor *doctor = examine(text);
    const WeftFinding *finding = weft_doctor_finding(doctor, 0);
    assert_int_equal(finding->engines, 1u << choice_find(CHOICE_profile, "three"));
    assert_true(finding->figure > 1.1 && finding->figure < 1.3);
    assert_string_equal(finding->place, "/materials/0/extensions/KHR_materials_sheen/sheenRoughnessFactor");
    weft_doctor_close(doctor);
    free(text);
}

/* Saved scenes of weft's own, as they come. */
static void built_in_scenes_have_no_errors(void **state) {
    (void)state;
    for (int k = 0; weft_builtin_name(k); k++) {
        char name[64];
        WeftScene *scene;
        WeftDoctor *doctor;
        WeftError error;
        snprintf(name, sizeof name, "builtin:%s", weft_builtin_name(k));
        assert_int_equal(weft_scene_load(name, &scene, NULL, &error), WEFT_OK);
        assert_int_equal(weft_scene_save(scene, "scene.glb", &error), WEFT_OK);
        assert_int_equal(weft_doctor_open("scene.glb", &doctor, NULL, &error), WEFT_OK);
        for (int f = 0; f < weft_doctor_count(doctor); f++) {
            const WeftFinding *finding = weft_doctor_finding(doctor, f);
            if (finding->severity == WEFT_SEVERITY_ERROR) fail_msg("%s: %s", name, finding->words);
        }
        weft_doctor_close(doctor);
        weft_scene_free(scene);
    }
}

/* Every file of a folder of the shared data is examined or refused in one line. */
static void examine_folder(const char *path, int depth, int *files) {
    DIR *listing = opendir(path);
    for (struct dirent *entry; listing && (entry = readdir(listing));) {
        char name[4096];
        const char *dot = strrchr(entry->d_name, '.');
        snprintf(name, sizeof name, "%.3800s/%.255s", path, entry->d_name);
        if (entry->d_name[0] == '.') continue;
        if (depth < 2 && !dot) examine_folder(name, depth + 1, files);
        if (!dot || (strcmp(dot, ".gltf") != 0 && strcmp(dot, ".glb") != 0)) continue;
        WeftDoctor *doctor;
        WeftError error;
        ++*files;
        if (weft_doctor_open(name, &doctor, NULL, &error) != WEFT_OK) {
            if (!error.text[0] || strchr(error.text, '\n')) fail_msg("%s: \"%s\"", name, error.text);
            continue;
        }
        for (int f = 0; f < weft_doctor_count(doctor); f++) whole_words(weft_doctor_finding(doctor, f));
        weft_doctor_close(doctor);
    }
    if (listing) closedir(listing);
}

static void sample_assets_of_the_shared_data_are_examined(void **state) {
    (void)state;
    const char *named = getenv("WEFT_DATA");
    char path[1024];
    int files = 0;
    snprintf(path, sizeof path, "%s", named ? named : WEFT_SOURCE_DIR "/../shared/data");
    examine_folder(path, 0, &files);
    if (files) return;
    print_message("no sample assets: set WEFT_DATA\n");
    skip();
}

static void doctor_refuses_broken_files(void **state) {
    (void)state;
    static const struct {
        const char *text;
        WeftMessage message;
    } broken[] = {{"", WEFT_MESSAGE_SCENE_KIND},
                  {"{", WEFT_MESSAGE_GLTF_JSON},
                  {"{}", WEFT_MESSAGE_GLTF_VERSION},
                  {"{\"asset\":{\"version\":\"2.0\"},\"materials\":[3]}", WEFT_MESSAGE_GLTF_SCHEMA},
                  {"{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":{"
                   "\"POSITION\":7}}]}]}",
                   WEFT_MESSAGE_GLTF_REFERENCE}};
    for (size_t k = 0; k < sizeof broken / sizeof *broken; k++) {
        WeftDoctor *doctor;
        WeftError error;
        WeftResult result =
            weft_doctor_open_memory(broken[k].text, strlen(broken[k].text), "broken", &doctor, NULL, &error);
        assert_int_equal(result, WEFT_INPUT);
        assert_int_equal(error.message, broken[k].message);
        assert_null(doctor);
    }
}

/* The warnings that a read gives, each with its id. */
typedef struct Told {
    WeftMessage messages[400];
    char words[400][512];
    int count;
} Told;

static void keep(void *user, WeftMessage message, const char *text) {
    Told *told = user;
    const char *words = strstr(text, weft_message_text(message));
    if (told->count == 400) return;
    assert_non_null(words);
    words += strlen(weft_message_text(message));
    told->messages[told->count] = message;
    snprintf(told->words[told->count++], 512, "%s", *words == ':' ? words + 2 : words);
}

/* Whether a finding has the words, or is about the number, by its place, that the words are about. */
static bool is_found(const WeftDoctor *doctor, const char *words) {
    char pointer[512] = "/";
    size_t used = 1;
    for (const char *c = words; *c && *c != ' '; c++) {
        if (*c == ']' || *c == ':') continue;
        pointer[used++] = *c == '[' || *c == '.' ? '/' : *c;
    }
    pointer[used] = 0;
    for (int k = 0; k < weft_doctor_count(doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(doctor, k);
        const bool ranged =
            finding->kind == WEFT_FINDING_VALUE_RANGE && strncmp(pointer, finding->place, strlen(finding->place)) == 0;
        if (ranged || strstr(finding->words, words)) return true;
    }
    return false;
}

static int compare_read(const char *path) {
    Told *told = calloc(1, sizeof *told);
    const WeftLog log = {keep, told};
    WeftScene *scene = NULL;
    WeftDoctor *doctor = NULL;
    WeftError error;
    if (weft_scene_load(path, &scene, &log, &error) == WEFT_OK) {
        assert_int_equal(weft_doctor_open(path, &doctor, NULL, &error), WEFT_OK);
        for (int k = 0; k < told->count; k++)
            if (!is_found(doctor, told->words[k])) fail_msg("%s: the doctor does not say: %s", path, told->words[k]);
    }
    const int count = told->count;
    weft_doctor_close(doctor);
    weft_scene_free(scene);
    free(told);
    return count;
}

/* Compares every .gltf and .glb below a folder; returns how many warnings there were. */
static int compare_below(const char *below) {
    int count = 0;
    DIR *entries = opendir(below);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        const char *suffix = strrchr(entry->d_name, '.');
        char path[4096];
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%.2000s/%s", below, entry->d_name);
        if (suffix && (strcmp(suffix, ".gltf") == 0 || strcmp(suffix, ".glb") == 0))
            count += compare_read(path);
        else if (!suffix)
            count += compare_below(path);
    }
    if (entries) closedir(entries);
    return count;
}

/* Whatever a read of the sample assets, sound or malformed, warns of is a finding too. */
static void warnings_of_sample_assets_are_findings(void **state) {
    (void)state;
    const char *named = getenv("WEFT_DATA");
    char path[2048];
    int count = 0;
    for (int k = 0; k < 2; k++) {
        snprintf(path, sizeof path, "%s/%s", named ? named : WEFT_SOURCE_DIR "/../shared/data",
                 k ? "malformed" : "gltf");
        count += compare_below(path);
    }
    if (count) return;
    print_message("no sample assets: set WEFT_DATA\n");
    skip();
}

/* An extension whose name looks like a line of the reader is said as any other that weft does not read. */
static void name_with_a_colon_is_a_name(void **state) {
    (void)state;
    char *text = json("{'asset':{'version':'2.0'},'extensionsUsed':['EXT_odd: name']," SQUARE_DATA
                      ",'materials':[{}],'meshes':[{'primitives':[{%s}]}],'nodes':[{'mesh':0}]}\n",
                      SQUARE_URI, ALL);
    WeftDoctor *doctor = examine(text);
    bool said = false;
    for (int k = 0; k < weft_doctor_count(doctor); k++)
        said |=
            strstr(weft_doctor_finding(doctor, k)->words, "EXT_odd: name is used, which weft does not read") != NULL;
    assert_true(said);
    weft_doctor_close(doctor);
    free(text);
}

/* Each kind of warning, in one asset: extensions, sets of coordinates, pictures, unknown values and numbers. */
static void warnings_of_a_read_are_findings(void **state) {
    (void)state;
    char *text =
        json("{'asset':{'version':'2.0'},'extensionsUsed':['EXT_materials_lustre','EXT_texture_avif'],'animations':[{}]"
             "," SQUARE_DATA ",'images':[{'uri':'%s'}],'samplers':[{'wrapS':7}],'textures':[{'source':0,'sampler':0},"
             "{'extensions':{'EXT_texture_avif':{'source':0}}},{'source':0,'extensions':{'MSFT_texture_dds':{'source'"
             ":0}}}],"
             "'materials':[{'alphaMode':'FOO','what':1,'pbrMetallicRoughness':{'roughnessFactor':2,'baseColorFactor':"
             "[0.4,3,0.4,1],'baseColorTexture':{'index':1},'metallicRoughnessTexture':{'index':2}},'emissiveTexture':"
             "{'index':0,'texCoord':4},'extensions':{'EXT_materials_lustre':{},'KHR_materials_ior':{'ior':0.5},"
             "'KHR_other':{}}}],'meshes':[{'primitives':[{%s,'targets':[{'POSITION':0}]},{'attributes':{'POSITION':0,"
             "'UV':2},'mode':0}]}],'nodes':[{'mesh':0}]}\n",
             SQUARE_URI, picture_uri(COLORS), ALL);
    Told *told = calloc(1, sizeof *told);
    const WeftLog log = {keep, told};
    WeftScene *scene;
    WeftError error;
    WeftDoctor *doctor = examine(text);
    if (weft_scene_load_memory(text, strlen(text), "case", &scene, &log, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(told->count >= 15);
    for (int k = 0; k < told->count; k++)
        if (!is_found(doctor, told->words[k])) fail_msg("the doctor does not say: %s", told->words[k]);
    bool placed = false;
    for (int k = 0; k < weft_doctor_count(doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(doctor, k);
        placed |= finding->kind == WEFT_FINDING_TEXTURE_UNSHOWN &&
                  strstr(finding->words, "base color has no picture") &&
                  strcmp(finding->place, "/materials/0/pbrMetallicRoughness/baseColorTexture") == 0;
    }
    assert_true(placed);
    weft_doctor_close(doctor);
    weft_scene_free(scene);
    free(told);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(asset_of_each_fault_has_its_finding_alone),
        cmocka_unit_test(pictures_beyond_basis_universal_are_named),
        cmocka_unit_test(every_finding_has_a_case),
        cmocka_unit_test(alpha_of_a_colour_is_no_second_space),
        cmocka_unit_test(paint_and_chrome_in_one_map_are_not_a_dark_metal),
        cmocka_unit_test(fixed_asset_has_no_finding_left_to_fix),
        cmocka_unit_test(fix_moves_sheen_roughness_to_alpha),
        cmocka_unit_test(fix_keeps_a_shared_roughness_shared),
        cmocka_unit_test(equal_materials_are_measured_once),
        cmocka_unit_test(gain_of_a_sheen_is_measured),
        cmocka_unit_test(doctor_of_a_thousand_sheens_takes_seconds),
        cmocka_unit_test(slices_of_light_sum_to_the_albedo_of_the_material),
        cmocka_unit_test(built_in_scenes_have_no_errors),
        cmocka_unit_test(sample_assets_of_the_shared_data_are_examined),
        cmocka_unit_test(name_with_a_colon_is_a_name),
        cmocka_unit_test(warnings_of_a_read_are_findings),
        cmocka_unit_test(warnings_of_sample_assets_are_findings),
        cmocka_unit_test(doctor_refuses_broken_files),
    };
    return cmocka_run_group_tests(tests, scratch_group_begin, scratch_group_end);
}
