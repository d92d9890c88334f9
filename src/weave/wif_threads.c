/* wif_threads.c - the colours, spacings and thicknesses of the threads of a WIF */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/number.h"
#include "weave/wif.h"

/* The sections of either system. */
static const char *const systems[] = {"WARP", "WEFT"}, *const colors[] = {"WARP COLORS", "WEFT COLORS"},
                         *const spacings[] = {"WARP SPACING", "WEFT SPACING"},
                         *const thicknesses[] = {"WARP THICKNESS", "WEFT THICKNESS"};

/* ---- colours ---- */

enum { PALETTE_MAX = 65536 };

typedef struct Palette {
    float low, range; /* of the file's numbers */
    struct {
        float color[3]; /* sRGB-encoded */
        bool given;
    } * entries; /* 1 .. count */
    long count;
} Palette;

/* Encodes three numbers of a line; notes one outside the range. */
static void encode(Wif *wif, const IniLine *line, const Palette *palette, const float values[3], float color[3]) {
    bool clipped = false;
    for (int c = 0; c < 3; c++) {
        const float share = (values[c] - palette->low) / palette->range;
        color[c] = fminf(fmaxf(share, 0.0f), 1.0f);
        clipped |= share < 0.0f || share > 1.0f;
    }
    if (clipped) wif_note(wif, line, WIF_CLIPPED);
}

/* Returns true if all colours of the table are of numbers from 0 to 1, and one of these is no whole number. */
static bool has_fractions(const Wif *wif) {
    bool fractions = false, within = true;
    for (int k = 0; k < wif->ini.count; k++) {
        float values[3];
        const IniLine *line = &wif->ini.lines[k];
        if (strcasecmp(line->section, "COLOR TABLE") != 0 || wif_numbers(line->value, 3, values) != 3) continue;
        for (int c = 0; c < 3; c++) {
            within = within && values[c] >= 0.0f && values[c] <= 1.0f;
            fractions = fractions || (values[c] > 0.0f && values[c] < 1.0f);
        }
    }
    return fractions && within;
}

/* Reads the Range "low,high" of colours. Programs that leave out the lower end mean 0. */
static WeftResult read_range(Wif *wif, Palette *palette) {
    const IniLine *line = ini_find(&wif->ini, "COLOR PALETTE", "Range");
    float ends[2] = {0.0f, 255.0f};
    if ((!line || line->value[0] == '\0') && has_fractions(wif)) {
        ends[1] = 1.0f;
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "[COLOR PALETTE] has no Range and [COLOR TABLE] fractions of 1; 0 to 1 was taken");
    }
    if (line && line->value[0] != '\0') {
        const int count = wif_numbers(line->value, 2, ends);
        if (count == 1 && ends[0] > 0.0f) {
            ends[1] = ends[0];
            ends[0] = 0.0f;
            wif_note(wif, line, WIF_RANGE);
        } else if (count != 2 || !(ends[1] > ends[0]))
            return wif_refuse(wif, line, "two rising numbers are expected");
    }
    palette->low = ends[0];
    palette->range = ends[1] - ends[0];
    return WEFT_OK;
}

/* Reads the colours of the table, of which some may be missing. */
static WeftResult read_palette(Wif *wif, Palette *palette) {
    float values[3];
    WeftResult result = read_range(wif, palette);
    if (result != WEFT_OK) return result;
    for (int k = 0; k < wif->ini.count; k++)
        if (strcasecmp(wif->ini.lines[k].section, "COLOR TABLE") == 0 && ini_index(&wif->ini.lines[k]) > palette->count)
            palette->count = ini_index(&wif->ini.lines[k]);
    if (palette->count > PALETTE_MAX)
        return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "[COLOR TABLE] has a colour above 65536");
    palette->entries = alloc_array((size_t)palette->count + 1, sizeof *palette->entries);
    if (!palette->entries) return wif_memory(wif);
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        if (strcasecmp(line->section, "COLOR TABLE") != 0) continue;
        const long index = ini_index(line);
        if (index && line->value[0] == '\0') continue;
        if (!index || wif_numbers(line->value, 3, values) != 3)
            return wif_refuse(wif, line, "three numbers are expected");
        encode(wif, line, palette, values, palette->entries[index].color);
        palette->entries[index].given = true;
    }
    return WEFT_OK;
}

/* Reads "index", "index,r,g,b" (an older form, whose colour counts only if the palette lacks the index) or "r,g,b".
 * Returns false for an empty value, for anything else, and, with a note, for a colour that is nowhere. */
static bool color_of(Wif *wif, const IniLine *line, const Palette *palette, float color[3]) {
    float values[4];
    const int count = line ? wif_numbers(line->value, 4, values) : 0;
    long index;
    const char *cursor = line ? line->value : "";
    if (count == 3) {
        encode(wif, line, palette, values, color);
        return true;
    }
    if ((count != 1 && count != 4) || wif_next(&cursor, &index) != 1) return false;
    if (index >= 1 && index <= palette->count && palette->entries[index].given)
        memcpy(color, palette->entries[index].color, 3 * sizeof *color);
    else if (count == 4)
        encode(wif, line, palette, values + 1, color);
    else {
        wif_note(wif, line, WIF_COLOR);
        return false;
    }
    return true;
}

/* Returns the thread from 0 that a line of a section is about, or -1; notes one beyond the threads. */
static int thread_of(Wif *wif, const IniLine *line, const char *section, int count) {
    if (strcasecmp(line->section, section) != 0) return -1;
    const long index = ini_index(line);
    if (index < 1)
        wif_note(wif, line, WIF_VALUE);
    else if (index > count)
        wif_note(wif, line, WIF_BEYOND);
    return index < 1 || index > count ? -1 : (int)index - 1;
}

/* Reads the colours of a system. A thread without a line gets the colour of [WARP] or [WEFT], or else that of the
 * thread before. */
static WeftResult read_system(Wif *wif, WeftDraft *draft, WeftThreads threads, const Palette *palette) {
    float color[3];
    const bool has_common = color_of(wif, ini_find(&wif->ini, systems[threads], "Color"), palette, color);
    WeftThread *of = draft->threads[threads];
    const int count = draft->count[threads];
    unsigned char *given = alloc_array((size_t)count, 1);
    int missing = 0;
    if (!given) return wif_memory(wif);
    for (int k = 0; has_common && k < count; k++) memcpy(of[k].color, color, sizeof color);
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        const int thread = thread_of(wif, line, colors[threads], count);
        if (thread < 0 || !color_of(wif, line, palette, color)) continue;
        memcpy(of[thread].color, color, sizeof color);
        given[thread] = 1;
    }
    for (int k = 0; !has_common && k < count; k++) {
        if (!given[k] && k > 0) memcpy(of[k].color, of[k - 1].color, sizeof color);
        missing += !given[k];
    }
    if (missing && missing < count)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "%d of %d threads of [%s] have no colour and take that of the thread before", missing, count,
             systems[threads]);
    free(given);
    return WEFT_OK;
}

WeftResult wif_read_colors(Wif *wif, WeftDraft *draft) {
    Palette palette = {0};
    WeftResult result = read_palette(wif, &palette);
    for (int t = 0; result == WEFT_OK && t < 2; t++) result = read_system(wif, draft, (WeftThreads)t, &palette);
    free(palette.entries);
    return result;
}

/* ---- lengths ---- */

/* Reads a length in metres; returns false, with a note, unless it is a micrometre to a metre, and false for an empty
 * value, for one that is no number, and where the unit is not known, which is 0. */
static bool length_of(Wif *wif, const IniLine *line, double unit, float *length) {
    float value;
    if (!line || wif_numbers(line->value, 1, &value) != 1 || !(unit > 0.0)) return false;
    const double metres = (double)value * unit;
    const bool is_length = metres >= 1e-6 && metres <= 1.0;
    if (is_length)
        *length = (float)metres;
    else
        wif_note(wif, line, WIF_LENGTH);
    return is_length;
}

/* Returns the metres of one unit of a system's lengths, 0 for a unit that nobody knows. Lengths without a unit are
 * centimetres, with a note. */
static double unit_of(Wif *wif, WeftThreads threads) {
    const char *const lengths[][2] = {{systems[threads], "Spacing"},
                                      {systems[threads], "Thickness"},
                                      {spacings[threads], NULL},
                                      {thicknesses[threads], NULL}};
    const IniLine *line = ini_find(&wif->ini, systems[threads], "Units");
    double metres;
    if (line && line->value[0] != '\0') return wif_unit(line->value, &metres) ? metres : 0.0;
    for (int k = 0; k < 4; k++) {
        const IniLine *length = ini_find(&wif->ini, lengths[k][0], lengths[k][1]);
        if (!length || length->value[0] == '\0') continue;
        wif_note(wif, length, WIF_UNIT_MISSING);
        break;
    }
    return 0.01;
}

/* Says what is taken where a file does not say how far apart threads are. */
static void tell_of_spacing(const Wif *wif) {
    bool missing[2];
    for (int t = 0; t < 2; t++) {
        const IniLine *common = ini_find(&wif->ini, systems[t], "Spacing");
        missing[t] = (!common || common->value[0] == '\0') && !ini_find(&wif->ini, spacings[t], NULL);
    }
    if (missing[WEFT_WARP] || missing[WEFT_WEFT])
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name, "%s no Spacing: 20 threads a centimetre were taken",
             missing[WEFT_WARP] && missing[WEFT_WEFT] ? "[WARP] and [WEFT] have"
             : missing[WEFT_WARP]                     ? "[WARP] has"
                                                      : "[WEFT] has");
}

void wif_read_lengths(Wif *wif, WeftDraft *draft) {
    tell_of_spacing(wif);
    for (int t = 0; t < 2; t++) {
        const double unit = unit_of(wif, (WeftThreads)t);
        float spacing = DRAFT_SPACING, thickness = 0.0f;
        length_of(wif, ini_find(&wif->ini, systems[t], "Spacing"), unit, &spacing);
        if (!length_of(wif, ini_find(&wif->ini, systems[t], "Thickness"), unit, &thickness)) thickness = spacing;
        WeftThread *of = draft->threads[t];
        for (int k = 0; k < draft->count[t]; k++) of[k].spacing = spacing, of[k].thickness = thickness;
        for (int k = 0; k < wif->ini.count; k++) {
            const IniLine *line = &wif->ini.lines[k];
            const int spaced = thread_of(wif, line, spacings[t], draft->count[t]),
                      thick = thread_of(wif, line, thicknesses[t], draft->count[t]);
            if (spaced >= 0) length_of(wif, line, unit, &of[spaced].spacing);
            if (thick >= 0) length_of(wif, line, unit, &of[thick].thickness);
        }
    }
}
