/* random_material.h - material files drawn by chance: every composition, choice and input, with maps, presets and
 * weaves; the same one for the same number */
#ifndef WEFT_TEST_RASTER_RANDOM_MATERIAL_H
#define WEFT_TEST_RASTER_RANDOM_MATERIAL_H

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "shading/cases.h"

#include "scene/record/material.h"
#include "shading/material/choice.h"
#include "weft/weft.h"

enum { MAPS = 4, MAP_SIDE = 16, MATERIAL_TEXT = 16384 };

/* A material file, and what decides how closely the engines can agree on it. */
typedef struct RandomMaterial {
    Random random;
    char text[MATERIAL_TEXT];
    size_t used;
    bool woven, blended, masked;
} RandomMaterial;

/* Returns true with probability p. */
static inline bool random_chance(Random *random, double p) { return (double)random_unit(random) < p; }
static inline int random_below(Random *random, int count) {
    int k = (int)(random_unit(random) * (float)count);
    return k < count ? k : count - 1;
}

/* Appends a key with its value, unless the file has that key. */
__attribute__((format(printf, 3, 4))) static inline void material_key(RandomMaterial *m, const char *key,
                                                                      const char *format, ...) {
    char quoted[64];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    if (strstr(m->text, quoted)) return;
    const char *comma = m->used > 1 ? "," : "";
    m->used += (size_t)snprintf(m->text + m->used, MATERIAL_TEXT - m->used, "%s\n    %s ", comma, quoted);
    assert_true(m->used < MATERIAL_TEXT);
    va_list arguments;
    va_start(arguments, format);
    m->used += (size_t)vsnprintf(m->text + m->used, MATERIAL_TEXT - m->used, format, arguments);
    va_end(arguments);
    assert_true(m->used < MATERIAL_TEXT - 2);
}

/* Begins with a preset, to which other keys may be added, or with nothing. */
static inline void material_begin(RandomMaterial *m) {
    int presets = 0;
    while (weft_preset_name(presets)) presets++;
    bool preset = random_chance(&m->random, 0.12);
    snprintf(m->text, MATERIAL_TEXT, "%s", preset ? weft_preset_text(random_below(&m->random, presets)) : "{");
    m->used = strlen(m->text);
    if (!preset) return;
    while (m->text[m->used - 1] != '}') m->used--;
    m->used--;
    while (strchr(" \n", m->text[m->used - 1])) m->used--;
    m->text[m->used] = '\0';
}

static inline void material_weave(RandomMaterial *m, double share) {
    static const char *const drafts[] = {"plain", "twill 2/2 z", "twill 3/1 s", "satin 5/2"};
    static const char *const yarns[] = {"cotton", "silk", "wool", "linen"};
    Random *r = &m->random;
    if (random_chance(r, share))
        material_key(m, "weave",
                     "{\"draft\": \"%s; warp 1#%02x%02x%02x; weft 1#%02x%02x%02x; sett %d %d\", \"warp\": \"%s\", "
                     "\"weft\": \"%s\", \"metres\": %.3g}",
                     drafts[random_below(r, 4)], random_below(r, 256), random_below(r, 256), random_below(r, 256),
                     random_below(r, 256), random_below(r, 256), random_below(r, 256), 10 + random_below(r, 30),
                     10 + random_below(r, 30), yarns[random_below(r, 4)], yarns[random_below(r, 4)],
                     0.02 + (double)random_unit(r));
    m->woven = strstr(m->text, "\"weave\":") != NULL;
}

/* Returns how often a choice is made; most of the others stay as the workflow or the profile has them. */
static inline double choice_share(ChoiceId choice) {
    switch (choice) {
    case CHOICE_workflow:
    case CHOICE_sheen_lobe:
    case CHOICE_layer: return 0.5;
    case CHOICE_profile: return 0.35;
    case CHOICE_convert: return 0.3;
    default: return 0.15;
    }
}

/* Returns true if a value is drawn: random walks are not, which the raster engine does not take. */
static inline bool choice_drawn(ChoiceId choice, int k) {
    const bool lobe = choice == CHOICE_diffuse || choice == CHOICE_sheen_lobe;
    if (lobe && weft_lobe_info(k)->traits & WEFT_LOBE_REFERENCE) return false;
    if (choice == CHOICE_layer && strcmp(choice_id(choice, k), "stochastic") == 0) return false;
    return choice_fits(choice, k);
}

static inline void material_choice(RandomMaterial *m, ChoiceId choice, const char *name) {
    int count = 0;
    while (choice_id(choice, count)) count++;
    bool made = random_chance(&m->random, choice_share(choice));
    int k = random_below(&m->random, count);
    while (!choice_drawn(choice, k)) k = (k + 1) % count;
    if (made) material_key(m, name, "\"%s\"", choice_id(choice, k));
}

/* Returns how often an input is given. */
static inline double input_share(InputId k) {
    switch (k) {
    case INPUT_emission: /* would light what lies beside it, in the path tracer only */
    case INPUT_normal:
    case INPUT_clearcoat_normal: return 0.0;
    case INPUT_base_color:
    case INPUT_roughness:
    case INPUT_sheen_color:
    case INPUT_sheen_roughness: return 0.8;
    case INPUT_metallic: return 0.4;
    default: return 0.15;
    }
}

/* Returns a number of an input's plausible range, often one of its ends. */
static inline double input_number(RandomMaterial *m, const WeftInputInfo *info) {
    double x = (double)random_unit(&m->random), low = (double)info->low, high = (double)info->high;
    return x < 0.12 ? low : x > 0.88 ? high : low + (high - low) * (double)random_unit(&m->random);
}

static inline void material_input(RandomMaterial *m, InputId k) {
    static const char *const wraps[] = {"repeat", "mirror", "clamp"};
    const WeftInputInfo *info = &input_infos[k];
    Random *r = &m->random;
    const bool color = info->kind == WEFT_INPUT_COLOR, number = info->kind == WEFT_INPUT_SCALAR;
    if (!random_chance(r, input_share(k))) return;
    double x = input_number(m, info), y = input_number(m, info), z = input_number(m, info);
    char value[96];
    snprintf(value, sizeof value, color ? "[%.4g, %.4g, %.4g]" : "%.4g", x, y, z);
    if (!(color || number) || !random_chance(r, 0.15)) {
        material_key(m, info->name, "%s", value);
        return;
    }
    char channel[32] = "";
    if (number) snprintf(channel, sizeof channel, "\"channel\": \"%c\", ", "rgba"[random_below(r, 4)]);
    material_key(m, info->name,
                 "{\"texture\": \"map-%d.png\", %s\"factor\": %s, \"scale\": %.3g, \"rotation\": %.3g, "
                 "\"wrap\": \"%s\", \"nearest\": %s}",
                 random_below(r, MAPS), channel, value, 0.5 + 2.0 * (double)random_unit(r),
                 360.0 * (double)random_unit(r), wraps[random_below(r, 3)], random_chance(r, 0.2) ? "true" : "false");
}

/* Puts the way in which a surface covers what is behind it. */
static inline void material_coverage(RandomMaterial *m) {
    Random *r = &m->random;
    double mode = (double)random_unit(r);
    material_key(m, "double_sided", random_chance(r, 0.6) ? "true" : "false");
    if (mode < 0.12) material_key(m, "alpha_cutoff", "%.3g", (double)random_unit(r));
    if (mode < 0.30) material_key(m, "alpha_mode", mode < 0.12 ? "\"mask\"" : "\"blend\"");
    if (mode > 0.24 && mode < 0.30) material_key(m, "opacity", "1");
    if (random_chance(r, 0.03)) material_key(m, "unlit", "true");
    material_input(m, INPUT_opacity);
}

/* Adds what only light from all around asks: a normal map, and metal. */
static inline void material_around(RandomMaterial *m, uint64_t seed) {
    Random r = {seed * 0x9e3779b97f4a7c15u};
    if (random_chance(&r, 0.6))
        material_key(m, "normal", "{\"texture\": \"bumps.png\", \"factor\": %.3g, \"scale\": %.3g}",
                     0.3 + 0.7 * (double)random_unit(&r), 1.0 + 3.0 * (double)random_unit(&r));
    if (random_chance(&r, 0.3)) material_key(m, "metallic", "1");
}

/* Draws material number `seed`. around: for light from all around. */
static inline void random_material(RandomMaterial *m, uint64_t seed, bool around) {
    *m = (RandomMaterial){.random = {seed * 0x2545f4914f6cdd1du}};
    material_begin(m);
    if (around) material_around(m, seed);
    material_weave(m, around ? 0.25 : 0.06);
    material_coverage(m);
#define MATERIAL_CHOICE(name, help) material_choice(m, CHOICE_##name, #name);
    SURFACE_CHOICES(MATERIAL_CHOICE)
    for (int k = 0; k < INPUT_COUNT; k++)
        if (k != INPUT_opacity) material_input(m, (InputId)k);
    m->used += (size_t)snprintf(m->text + m->used, MATERIAL_TEXT - m->used, "\n}\n");
    m->blended = strstr(m->text, "\"alpha_mode\": \"blend\"") != NULL;
    m->masked = strstr(m->text, "\"alpha_mode\": \"mask\"") != NULL;
}

/* Writes a normal map of round bumps. */
static inline void random_bumps_write(const char *folder) {
    WeftImage image;
    char path[96];
    assert_int_equal(weft_image_create(MAP_SIDE, MAP_SIDE, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    for (int k = 0; k < MAP_SIDE * MAP_SIDE; k++) {
        const float step = 2.0f * 3.14159265f / MAP_SIDE, x = 0.5f * (sinf)(step * (float)(k % MAP_SIDE)),
                    y = 0.5f * (sinf)(step * (float)(k / MAP_SIDE)), n = 1.0f / (sqrtf)(1.0f + x * x + y * y);
        const float normal[3] = {x * n, y * n, n};
        for (int c = 0; c < 3; c++) ((uint8_t *)image.pixels)[3 * k + c] = (uint8_t)(127.5f + 127.5f * normal[c]);
    }
    snprintf(path, sizeof path, "%s/bumps.png", folder);
    assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
    weft_image_free(&image);
}

/* Writes the maps that the files name: blotches, a ramp, checks and stripes, each different in every channel. */
static inline void random_maps_write(const char *folder) {
    for (int map = 0; map < MAPS; map++) {
        WeftImage image;
        char path[96];
        Random random = {(uint64_t)map};
        assert_int_equal(weft_image_create(MAP_SIDE, MAP_SIDE, 4, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
        for (int k = 0; k < MAP_SIDE * MAP_SIDE * 4; k++) {
            const int x = k / 4 % MAP_SIDE, y = k / 4 / MAP_SIDE, c = k % 4;
            const int values[MAPS] = {80 + random_below(&random, 176), 75 + 12 * (c % 2 ? x : y),
                                      ((x / (2 + c) + y / 4) % 2) ? 230 : 80, (x + c * 4) % 8 < 3 ? 255 : 90};
            ((uint8_t *)image.pixels)[k] = (uint8_t)values[map];
        }
        snprintf(path, sizeof path, "%s/map-%d.png", folder, map);
        assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
        weft_image_free(&image);
    }
}

#endif
