/* doctor_values.c - the numbers of a material: what glTF allows, what switches a texture off, what is
 * plausible */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/asset/material_fields.h"
#include "measure/doctor/doctor.h"
#include "scene/material/set.h"

#define PBR(key) "pbrMetallicRoughness/" key

static double clamped(double value, double low, double high) { return fmin(fmax(value, low), high); }

static void check_range(WeftDoctor *doctor, const Cloth *cloth, const char *path, int count, double low, double high) {
    Repair repair = {.act = count == 1 ? REPAIR_NUMBER : REPAIR_NUMBERS, .count = count};
    double worst = clamped(0.0, low, high), values[4];
    if (!doctor_numbers(cloth->json, path, values, count)) return;
    for (int k = 0; k < count; k++) {
        repair.numbers[k] = clamped(values[k], low, high);
        double off = fabs(repair.numbers[k] - values[k]);
        if (off > fabs(worst - clamped(worst, low, high))) worst = values[k];
    }
    if (worst >= low && worst <= high) return;
    const Place place = {WEFT_OF_MATERIAL, cloth->index, path};
    char limits[48];
    if (high < HUGE_VAL)
        snprintf(limits, sizeof limits, "in %g .. %g", low, high);
    else
        snprintf(limits, sizeof limits, "at least %g", low);
    doctor_found(doctor, WEFT_FINDING_VALUE_RANGE, place, 0, worst, &repair,
                 "%s is %g, but must be %s: some readers refuse the file, some clamp, and some take it as it is",
                 doctor_key(path), worst, limits);
    doctor_advise(doctor, "write %g", clamped(worst, low, high));
}

static const char ior_path[] = "extensions/KHR_materials_ior/ior";

/* Returns true if an ior is present and is neither 0, which stands for a mirror, nor at least 1. */
static bool bad_ior(const Cloth *cloth, double *ior) {
    return doctor_numbers(cloth->json, ior_path, ior, 1) && *ior < 1.0 && fabs(*ior) > 0.0;
}

static void check_ior_range(WeftDoctor *doctor, const Cloth *cloth) {
    double ior;
    if (!bad_ior(cloth, &ior)) return;
    const Repair repair = {.act = REPAIR_NUMBER, .numbers = {1.5}, .count = 1};
    doctor_found(doctor, WEFT_FINDING_VALUE_RANGE, (Place){WEFT_OF_MATERIAL, cloth->index, ior_path}, 0, ior, &repair,
                 "ior is %g, but must be 0 or at least 1: nothing that one meets is optically thinner than air", ior);
    doctor_advise(doctor, "write 1.5, which is a plain dielectric's");
}

static void check_distance_range(WeftDoctor *doctor, const Cloth *cloth, const char *path) {
    double distance;
    if (!doctor_numbers(cloth->json, path, &distance, 1) || distance > 0.0) return;
    const Repair repair = {.act = REPAIR_REMOVE};
    doctor_found(doctor, WEFT_FINDING_VALUE_RANGE, (Place){WEFT_OF_MATERIAL, cloth->index, path}, 0, distance, &repair,
                 "attenuationDistance is %g, but must be above 0: some readers divide by it, and weft takes it as "
                 "infinite",
                 distance);
    doctor_advise(doctor, "leave it out, if nothing is absorbed inside");
}

void check_ranges(WeftDoctor *doctor, const Cloth *cloth) {
    for (const MaterialField *row = material_fields; row->factor; row++) {
        char path[FIELD_PATH];
        material_field_path(row, row->factor, path);
        if (row->input == INPUT_ior)
            check_ior_range(doctor, cloth);
        else if (row->input == INPUT_attenuation_distance)
            check_distance_range(doctor, cloth, path);
        else if (row->low >= 0.0f)
            check_range(doctor, cloth, path, material_field_numbers(row), (double)row->low, (double)row->high);
    }
}

/* Numbers whose default is one in the text of an extension and another in its schema, or in an earlier text. other: the
 * one that weft does not take. */
static const struct {
    InputId input;
    float other;
    const char *where;
} disputed[] = {
    {INPUT_fuzz_roughness, 0.0f, "the extension's text has 0.5, its schema 0"},
    {INPUT_diffuse_roughness, 1.0f, "the extension's text has 0, its first version 1"},
};

void check_defaults(WeftDoctor *doctor, const Cloth *cloth) {
    const json_t *extensions = json_object_get(cloth->json, "extensions");
    for (size_t k = 0; k < sizeof disputed / sizeof *disputed; k++) {
        const MaterialField *row = material_field_of(disputed[k].input);
        char path[FIELD_PATH];
        material_field_path(row, row->factor, path);
        if (!json_object_get(extensions, row->object) || doctor_part(cloth->json, path)) continue;
        const Repair repair = {.act = REPAIR_NUMBER, .numbers = {(double)row->absent}, .count = 1};
        doctor_found(doctor, WEFT_FINDING_DEFAULT_DISPUTED, (Place){WEFT_OF_MATERIAL, cloth->index, path}, 0,
                     (double)row->absent, &repair,
                     "%s is not there, and readers do not agree what it then is: %s; weft takes %g, others %g",
                     row->factor, disputed[k].where, (double)row->absent, (double)disputed[k].other);
        doctor_advise(doctor, "write %s %g, so that all take the same", row->factor, (double)row->absent);
    }
}

/* Returns true for a texture that does nothing without its factor. */
static bool is_switched(const MaterialField *row) { return row->texture && row->low >= 0.0f && !(row->absent > 0.0f); }

void check_factors(WeftDoctor *doctor, const Cloth *cloth) {
    for (const MaterialField *row = material_fields; row->factor; row++) {
        char factor[FIELD_PATH], path[FIELD_PATH];
        const char *texture = row->texture;
        const int count = material_field_numbers(row);
        double values[4] = {0.0};
        if (!is_switched(row)) continue;
        material_field_path(row, row->factor, factor);
        material_field_path(row, texture, path);
        if (!doctor_part(cloth->json, path)) continue;
        bool given = doctor_numbers(cloth->json, factor, values, count);
        if (values[0] > 0.0 || values[1] > 0.0 || values[2] > 0.0 || values[0] < 0.0) continue;
        const Place place = {WEFT_OF_MATERIAL, cloth->index, factor};
        if (given) {
            doctor_found(doctor, WEFT_FINDING_TEXTURE_OFF, place, 0, 0.0, NULL,
                         "%s does nothing: it is multiplied by %s, which is set to 0", texture, doctor_key(factor));
            doctor_advise(doctor, "set %s, or drop the texture, which is loaded all the same", doctor_key(factor));
            continue;
        }
        const Repair repair = {
            .act = count == 1 ? REPAIR_NUMBER : REPAIR_NUMBERS, .numbers = {1.0, 1.0, 1.0}, .count = count};
        doctor_found(doctor, WEFT_FINDING_TEXTURE_TIMES_ZERO, place, 0, 0.0, &repair,
                     "%s does nothing: it is multiplied by %s, which is not there and then is 0, not 1", texture,
                     doctor_key(factor));
        doctor_advise(doctor, "write %s%s", doctor_key(factor), count == 1 ? " 1" : " [1, 1, 1]");
    }
}

/* The limits of colours: from coal, or what a screen at sRGB 30 shows, since black cloth is darker than coal,
 * to fresh snow (sRGB 243); of metals from sRGB 180. Sebastien Lagarde and Laurent Harduin, "The art and
 * rendering of Remember Me", GDC Europe 2013, and the chart that Dontnod published after it, 2014. */
static const float CLOTH_LOW = 0.0130f, CLOTH_HIGH = 0.8963f, METAL_LOW = 0.4564f;

static float luminance(const float c[3]) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

/* Returns the textureInfo of the base colour, or NULL. */
static json_t *base_texture(const Cloth *cloth) {
    const MaterialField *row = doctor_row(cloth->json, INPUT_base_color);
    char path[FIELD_PATH];
    material_field_path(row, row->texture, path);
    return doctor_part(cloth->json, path);
}

static void check_bright(WeftDoctor *doctor, const Cloth *cloth, Place place) {
    float most = fmaxf(cloth->base[0], fmaxf(cloth->base[1], cloth->base[2]));
    bool textured = base_texture(cloth) != NULL;
    if (!(luminance(cloth->base) > CLOTH_HIGH) || most > 1.0f) return;
    Repair repair = {.act = REPAIR_NUMBERS, .numbers = {1.0, 1.0, 1.0, 1.0}, .count = 4};
    doctor_numbers(cloth->json, place.path, repair.numbers, 4);
    for (int c = 0; c < 3; c++) repair.numbers[c] *= 0.8 / (double)luminance(cloth->base);
    doctor_found(doctor, WEFT_FINDING_BASE_BRIGHT, place, 0, (double)luminance(cloth->base), &repair,
                 "the base colour%s reflects %.3g, more than fresh snow (%.3g): nothing that a sheen or a highlight "
                 "adds finds room, and light in folds does not fade",
                 textured ? ", in the mean of its texture," : "", (double)luminance(cloth->base), (double)CLOTH_HIGH);
    doctor_advise(doctor, "multiply %s by %.3g: white cotton reflects about 0.8", doctor_key(place.path),
                  0.8 / (double)luminance(cloth->base));
    if (!cloth->sheen) doctor_soften(doctor);
}

/* Returns the mean reflectance of a material where it is metal, 1 if it is metal nowhere. Base colour and metalness are
 * looked up at the same places of an even grid, since a texture may have paint beside chrome, and the mean of
 * both is neither. A texture transform or another set of coordinates would move one against the other: then
 * the means of the whole have to do. */
static float metal_luminance(WeftDoctor *doctor, const Cloth *cloth) {
    enum { SIDE = 128 };
    json_t *base_info = doctor_part(cloth->json, PBR("baseColorTexture")),
           *metal_info = doctor_part(cloth->json, PBR("metallicRoughnessTexture"));
    const WeftImage *base = doctor_image(doctor, base_info), *metal = doctor_image(doctor, metal_info);
    bool moved = json_object_get(base_info, "extensions") || json_object_get(metal_info, "extensions") ||
                 json_object_get(base_info, "texCoord") || json_object_get(metal_info, "texCoord");
    if (!metal || moved) return luminance(cloth->base);
    double metallic = 1.0, factors[3] = {1.0, 1.0, 1.0}, sum = 0.0;
    int texels = 0;
    doctor_numbers(cloth->json, PBR("metallicFactor"), &metallic, 1);
    doctor_numbers(cloth->json, PBR("baseColorFactor"), factors, 3);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int column = k % SIDE, row = k / SIDE;
        const float u = ((float)column + 0.5f) / SIDE, v = ((float)row + 0.5f) / SIDE;
        float color[3] = {1.0f, 1.0f, 1.0f};
        doctor_texel(metal, u, v, color);
        if (!((double)color[2] * metallic > 0.5)) continue;
        if (base) doctor_texel_linear(doctor, base, u, v, color);
        for (int c = 0; c < 3; c++) color[c] = (float)clamped(factors[c], 0.0, 1.0) * (base ? color[c] : 1.0f);
        sum += (double)luminance(color);
        texels++;
    }
    return texels ? (float)(sum / texels) : 1.0f;
}

/* Reports a metal under a sheen, unless another finding has done so. */
static void check_metal_base(WeftDoctor *doctor, const Cloth *cloth, Place place) {
    if (cloth->sheen) return;
    float y = metal_luminance(doctor, cloth);
    if (y >= METAL_LOW || y < 0.0f) return;
    doctor_found(doctor, WEFT_FINDING_METAL_DARK, place, 0, (double)y, NULL,
                 "a metal (metallic %.3g) whose reflectance is %.3g; metals have %.3g and more",
                 (double)cloth->metallic, (double)y, (double)METAL_LOW);
    doctor_advise(doctor, "brighten it; or if it is no metal, write metallicFactor 0: left out it is 1");
}

static bool glows(json_t *material) {
    double glow[3] = {0.0};
    doctor_numbers(material, "emissiveFactor", glow, 3);
    return glow[0] > 0.0 || glow[1] > 0.0 || glow[2] > 0.0;
}

static void check_base(WeftDoctor *doctor, const Cloth *cloth) {
    const MaterialField *row = doctor_row(cloth->json, INPUT_base_color);
    char path[FIELD_PATH];
    material_field_path(row, row->factor, path);
    const Place place = {WEFT_OF_MATERIAL, cloth->index, path};
    json_t *texture = base_texture(cloth);
    float y = luminance(cloth->base);
    if (doctor_part(cloth->json, "extensions/KHR_materials_unlit")) return;
    if (texture && !doctor_pixels(doctor, texture)) return; /* without its picture the colour is not known */
    if (cloth->metallic > 0.5f) {
        check_metal_base(doctor, cloth, place);
        return;
    }
    check_bright(doctor, cloth, place);
    if (y >= CLOTH_LOW || y < 0.0f || glows(cloth->json)) return;
    doctor_found(doctor, WEFT_FINDING_BASE_DARK, place, 0, (double)y, NULL,
                 "the base colour reflects %.2g, less than black cloth (%.2g): folds and shadows show nothing but "
                 "highlights",
                 (double)y, (double)CLOTH_LOW);
    doctor_advise(doctor,
                  "begin at %.2g; velvet is dark because its sheen is at the rim, not because its base is "
                  "black",
                  (double)CLOTH_LOW);
}

typedef struct Hearing {
    WeftDoctor *doctor;
    const Cloth *cloth;
} Hearing;

static bool begins(const char *words, const char *with) { return strncmp(words, with, strlen(with)) == 0; }

/* Returns true where another check of the doctor, which looks at textures too, says the same. */
static bool said_elsewhere(const Cloth *cloth, const char *words) {
    double ior;
    if (begins(words, "between")) return cloth_shows(cloth);
    if (begins(words, "reflectance of a dielectric")) return bad_ior(cloth, &ior);
    return begins(words, "reflectance of a metal") || begins(words, "diffuse colour");
}

/* Turns a warning of plausible.c into a finding, without the names of the material and the message. */
static void hear_plausible(void *user, WeftMessage message, const char *text) {
    const Hearing *to = user;
    const char *words = strstr(text, weft_message_text(message));
    words = words ? words + strlen(weft_message_text(message)) : text;
    while (*words == ':' || *words == ' ') words++;
    if (said_elsewhere(to->cloth, words)) return;
    doctor_found(to->doctor, WEFT_FINDING_IMPLAUSIBLE, (Place){WEFT_OF_MATERIAL, to->cloth->index, NULL}, 0,
                 (double)NAN, NULL, "%s", words);
    doctor_advise(to->doctor, "%s",
                  begins(words, "between") ? "write metallicFactor 0 or 1: what is between is for the pixels at edges"
                  : begins(words, "coloured") ? "write a grey specularColorFactor"
                                              : "take an ior from 1.3 to 1.7, 1.5 where KHR_materials_ior is "
                                                "not there, and a specularFactor of 1");
    if (!to->cloth->sheen) doctor_soften(to->doctor);
}

void check_plausible(WeftDoctor *doctor, const Cloth *cloth) {
    Hearing hearing = {doctor, cloth};
    const WeftLog log = {hear_plausible, &hearing};
    plausible_check_all(&doctor->scene->materials[cloth->index], "material", &log);
    check_base(doctor, cloth);
}

/* Finds textures of a material whose transform has a scale of 0. */
void check_transforms(WeftDoctor *doctor, const Cloth *cloth) {
    for (const MaterialField *row = material_fields; row->factor; row++) {
        char path[FIELD_PATH], scale[2 * FIELD_PATH];
        double values[2];
        if (!row->texture || material_field_repeats(row)) continue;
        material_field_path(row, row->texture, path);
        snprintf(scale, sizeof scale, "%s/extensions/KHR_texture_transform/scale", path);
        if (!doctor_numbers(cloth->json, scale, values, 2)) continue;
        if (fabs(values[0]) > 1e-6 && fabs(values[1]) > 1e-6) continue;
        doctor_found(doctor, WEFT_FINDING_TEXTURE_TRANSFORM, (Place){WEFT_OF_MATERIAL, cloth->index, scale}, 0, 0.0,
                     NULL, "the transform of %s has the scale %g, %g: one line of the image is all that is seen",
                     row->texture, values[0], values[1]);
        doctor_advise(doctor, "write a scale that is not 0, or drop the transform");
    }
}
