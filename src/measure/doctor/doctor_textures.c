/* doctor_textures.c - images and how they are used: colour spaces, and the channel that holds a sheen's
 * roughness */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "gltf/asset/buffer_views.h"
#include "gltf/asset/material_fields.h"
#include "gltf/save/bundle.h"
#include "measure/doctor/doctor.h"

/* Returns the image of the file that a textureInfo names; -1 if there is none. */
static int file_image(const WeftDoctor *doctor, json_t *info) {
    int texture = doctor_texture(doctor, info);
    return texture < 0 ? -1 : doctor->asset.textures[texture].image;
}

/* The first texture by which an image is decoded from sRGB, and the first by which it is not; NULL if there is none. */
typedef struct FirstUse {
    const char *color, *data;
} FirstUse;

/* Returns the uses of all images of the file; owned by the caller, NULL if memory is short. */
static FirstUse *first_uses(const WeftDoctor *doctor) {
    FirstUse *first = alloc_array(doctor->asset.image_count, sizeof *first);
    for (int m = 0; first && m < (int)doctor->asset.material_count; m++) {
        json_t *material = doctor_item(doctor, "materials", m);
        for (const MaterialField *row = material_fields; row->factor; row++) {
            char path[FIELD_PATH];
            const bool alpha = row->channels == CHANNEL_A || row->channels == CHANNEL_A_GLOSS;
            if (!row->texture || alpha) continue; /* alpha has no encoding */
            material_field_path(row, row->texture, path);
            int image = file_image(doctor, doctor_part(material, path));
            if (image < 0) continue;
            const char **use = material_field_numbers(row) > 1 ? &first[image].color : &first[image].data;
            if (!*use) *use = row->texture;
        }
    }
    return first;
}

/* Returns the encoded bytes of an image of the file. Release with free. */
static Span image_bytes(WeftDoctor *doctor, int image, unsigned char **owned) {
    json_t *item = doctor_item(doctor, "images", image), *view = json_object_get(item, "bufferView");
    const char *uri = json_string_value(json_object_get(item, "uri"));
    WeftResult result = WEFT_OK;
    WeftError error;
    *owned = NULL;
    if (view && (size_t)json_number_value(view) < doctor->asset.view_count)
        return view_bytes(&doctor->asset, (int)json_number_value(view));
    FileBytes bytes = {0};
    if (uri) bytes = bundle_bytes(&doctor->asset, uri, &result, &error);
    *owned = bytes.data;
    return (Span){bytes.data, bytes.size};
}

static bool claims_linear(const unsigned char *name, size_t size) {
    for (size_t k = 0; k + 6 <= size && name[k]; k++)
        if (strncasecmp((const char *)name + k, "linear", 6) == 0) return true;
    return false;
}

/* Returns the chunk by which a PNG declares its numbers linear, or NULL. W3C, "Portable Network Graphics
 * (PNG) Specification (Third Edition)", 2025, section 11.3.2: gAMA holds 100000 times the exponent, iCCP
 * begins with a name, cICP's second byte is the transfer function of ITU-T H.273, of which 8 is linear. */
static const char *png_linear(Span png) {
    size_t at = 8;
    if (!png.data || png.size < 8 || memcmp(png.data, "\x89PNG", 4) != 0) return NULL;
    while (png.size - at >= 12) {
        const unsigned char *c = png.data + at;
        size_t size = (size_t)c[0] << 24 | (size_t)c[1] << 16 | (size_t)c[2] << 8 | (size_t)c[3];
        if (size > png.size - at - 12 || memcmp(c + 4, "IDAT", 4) == 0) return NULL;
        if (memcmp(c + 4, "gAMA", 4) == 0 && size == 4 && memcmp(c + 8, "\0\x01\x86\xa0", 4) == 0)
            return "a chunk gAMA of 1";
        if (memcmp(c + 4, "cICP", 4) == 0 && size == 4 && c[9] == 8) return "a chunk cICP of linear transfer";
        if (memcmp(c + 4, "iCCP", 4) == 0 && claims_linear(c + 8, size)) return "a colour profile called linear";
        at += size + 12;
    }
    return NULL;
}

static void check_space(WeftDoctor *doctor, int image, FirstUse use) {
    const Place place = {WEFT_OF_IMAGE, image, NULL};
    if (use.color && use.data) {
        doctor_found(doctor, WEFT_FINDING_TEXTURE_TWO_SPACES, place, 0, (double)NAN, NULL,
                     "it is used as %s, which is decoded from sRGB, and as %s, which is not: one of the "
                     "two is wrong in every engine",
                     use.color, use.data);
        doctor_advise(doctor, "give each use an image of its own");
    }
    if (!use.color && !use.data) return;
    unsigned char *owned;
    const Span file = image_bytes(doctor, image, &owned);
    const char *how = use.color ? png_linear(file) : NULL;
    check_basis(doctor, image, file, use.color, use.data);
    free(owned);
    if (!how) return;
    doctor_found(doctor, WEFT_FINDING_TEXTURE_SAYS_LINEAR, place, doctor_engines(), (double)NAN, NULL,
                 "it is used as %s and has %s; glTF ignores that and decodes sRGB, so that colours "
                 "become too dark",
                 use.color, how);
    doctor_advise(doctor, "export the image in sRGB, without the chunk");
}

void check_spaces(WeftDoctor *doctor) {
    FirstUse *first = first_uses(doctor);
    doctor->failed |= !first;
    for (int k = 0; first && k < (int)doctor->asset.image_count; k++) check_space(doctor, k, first[k]);
    free(first);
}

void check_black(WeftDoctor *doctor, const Cloth *cloth) {
    static const char path[] = "extensions/KHR_materials_sheen/sheenColorTexture";
    json_t *info = json_object_get(cloth->sheen, "sheenColorTexture");
    const Pixels *pixels = doctor_pixels(doctor, info);
    double factor[3] = {0.0};
    bool given = doctor_numbers(cloth->sheen, "sheenColorFactor", factor, 3);
    bool zero = !(factor[0] > 0.0 || factor[1] > 0.0 || factor[2] > 0.0);
    if (pixels && !zero && fmaxf(pixels->high[0], fmaxf(pixels->high[1], pixels->high[2])) < 1.5f / 255.0f) {
        doctor_found(doctor, WEFT_FINDING_SHEEN_TEXTURE_BLACK, (Place){WEFT_OF_MATERIAL, cloth->index, path}, 0, 0.0,
                     NULL, "every pixel of sheenColorTexture is black: there is no sheen in any engine");
        doctor_advise(doctor, "export the texture again: exporters leave it black where they cannot bake the colour");
    }
    if (!cloth->sheen || info || !zero) return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_BLACK,
                 (Place){WEFT_OF_MATERIAL, cloth->index, "extensions/KHR_materials_sheen/sheenColorFactor"}, 0, 0.0,
                 NULL,
                 "KHR_materials_sheen is there, but its colour is black%s: nothing of it is seen, and it is paid for",
                 given ? "" : " since sheenColorFactor is left out");
    doctor_advise(doctor, "write sheenColorFactor, or drop the extension");
}

/* Returns the channel that an image of roughness was painted in: any of a grey one; else green, where glTF's
 * other roughness is. */
static int painted_channel(const Pixels *pixels) {
    bool grey = true;
    for (int c = 1; c < 3; c++)
        grey &= fabsf(pixels->mean[c] - pixels->mean[0]) < 0.01f && fabsf(pixels->high[c] - pixels->high[0]) < 0.02f;
    return grey ? 0 : 1;
}

/* Returns the texture of the colour beside a number in one extension, or NULL: both may share an image. */
static json_t *color_beside(const Cloth *cloth, const MaterialField *row) {
    char path[FIELD_PATH];
    for (const MaterialField *other = material_fields; other->factor; other++) {
        if (!material_fields_share(other, row) || other->channels != CHANNELS_COLOR || !other->texture) continue;
        material_field_path(other, other->texture, path);
        return doctor_part(cloth->json, path);
    }
    return NULL;
}

static void check_channel(WeftDoctor *doctor, const Cloth *cloth, const MaterialField *row) {
    static const char *const channels[] = {"grey", "green"};
    char path[FIELD_PATH];
    material_field_path(row, row->texture, path);
    json_t *info = doctor_part(cloth->json, path);
    const Pixels *pixels = doctor_pixels(doctor, info);
    const Place place = {WEFT_OF_MATERIAL, cloth->index, path};
    const bool sheen = row->input == INPUT_sheen_roughness;
    const unsigned engines = sheen ? doctor_engines() : 0;
    if (!pixels || pixels->low[3] < 0.995f) return;
    const int channel = painted_channel(pixels);
    const bool shared = file_image(doctor, info) == file_image(doctor, color_beside(cloth, row));
    float spread = pixels->high[channel] - pixels->low[channel];
    if (spread > 4.0f / 255.0f && !shared) {
        const Repair repair = {.act = REPAIR_ALPHA, .texture = doctor_texture(doctor, info), .channel = channel};
        doctor_found(
            doctor, sheen ? WEFT_FINDING_SHEEN_ROUGHNESS_CHANNEL : WEFT_FINDING_TEXTURE_CHANNEL, place, engines,
            (double)pixels->mean[channel], &repair,
            "%s is read from alpha, which is 1 everywhere; what was painted (%.2g .. %.2g) is in its %s channel "
            "and not seen",
            row->texture, (double)pixels->low[channel], (double)pixels->high[channel], channels[channel]);
        doctor_advise(doctor, "move %s to alpha", sheen ? "the roughness" : "it");
        return;
    }
    const Repair repair = {.act = REPAIR_REMOVE};
    doctor_found(doctor, sheen ? WEFT_FINDING_SHEEN_ROUGHNESS_PLAIN : WEFT_FINDING_TEXTURE_PLAIN, place, engines, 1.0,
                 &repair, "the alpha of %s, which is all that is read of it, is 1 everywhere: the %s is %s alone",
                 row->texture, sheen ? "roughness" : "number", row->factor);
    doctor_advise(doctor, "drop %s: the picture stays the same", row->texture);
}

/* Returns true if vertices of the material have colours, whose alpha counts too. */
static bool has_vertex_colors(const WeftDoctor *doctor, int material) {
    for (size_t m = 0; m < doctor->asset.mesh_count; m++)
        for (size_t k = 0; k < doctor->asset.meshes[m].primitive_count; k++) {
            const Primitive *p = &doctor->asset.meshes[m].primitives[k];
            if (p->material == material && p->color >= 0) return true;
        }
    return false;
}

/* Reports a material that is mixed or cut by its alpha, where alpha is 1 everywhere. */
static void check_opacity(WeftDoctor *doctor, const Cloth *cloth) {
    const MaterialField *row = doctor_row(cloth->json, INPUT_base_color);
    const char *mode = json_string_value(json_object_get(cloth->json, "alphaMode"));
    char path[FIELD_PATH], factor[FIELD_PATH];
    double numbers[4] = {1.0, 1.0, 1.0, 1.0};
    material_field_path(row, row->texture, path);
    material_field_path(row, row->factor, factor);
    const Pixels *pixels = doctor_pixels(doctor, doctor_part(cloth->json, path));
    doctor_numbers(cloth->json, factor, numbers, 4);
    if (!mode || (strcmp(mode, "MASK") != 0 && strcmp(mode, "BLEND") != 0)) return;
    if (!pixels || pixels->low[3] < 0.995f || numbers[3] < 1.0 || has_vertex_colors(doctor, cloth->index)) return;
    doctor_found(doctor, WEFT_FINDING_TEXTURE_PLAIN, (Place){WEFT_OF_MATERIAL, cloth->index, path}, 0, 1.0, NULL,
                 "alphaMode is %s, but the alpha of %s is 1 everywhere, or missing: nothing shows through", mode,
                 row->texture);
    doctor_advise(doctor, "give the picture its alpha, or write alphaMode OPAQUE, which is faster");
    doctor_soften(doctor);
}

void check_channels(WeftDoctor *doctor, const Cloth *cloth) {
    check_opacity(doctor, cloth);
    for (const MaterialField *row = material_fields; row->factor; row++)
        if (row->texture && row->channels == CHANNEL_A) check_channel(doctor, cloth, row);
}
