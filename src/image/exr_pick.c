#include "image/exr_pick.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Names of the colours of a picture. The first set is the format's own, which needs no words. */
static const struct ColorSet {
    const char *names[3]; /* one: grey */
    bool all;             /* a part of them is no picture */
    bool xyz;
} color_sets[] = {
    {{"R", "G", "B"}, false, false},
    {{"red", "green", "blue"}, false, false},
    {{"X", "Y", "Z"}, true, true},
    {{"Y"}, true, false},
    {{"V"}, true, false},
    {{"luminance"}, true, false},
    {{"grey"}, true, false},
    {{"gray"}, true, false},
};
enum { COLOR_SETS = sizeof color_sets / sizeof *color_sets };

size_t exr_layer_length(const char *channel) {
    const char *dot = strrchr(channel, '.');
    return dot ? (size_t)(dot - channel) + 1 : 0;
}

/* Returns the index of channel `name`, as it is written or else in any case, in the layer named by the first `length`
 * characters of `of`; or -1. */
static int channel_find(const exr_attr_chlist_t *channels, const char *of, size_t length, const char *name) {
    for (int exact = 1; exact >= 0; exact--)
        for (int i = 0; i < channels->num_channels; i++) {
            const char *full = channels->entries[i].name.str;
            if (strncmp(full, of, length) != 0) continue;
            if ((exact ? strcmp(full + length, name) : strcasecmp(full + length, name)) == 0) return i;
        }
    return -1;
}

/* Appends printable characters of a name of the file. */
static void add_name(char *words, size_t size, const char *name, size_t length) {
    size_t used = strlen(words);
    for (size_t k = 0; k < length && used + 1 < size; k++) {
        const unsigned char c = (unsigned char)name[k];
        words[used++] = (char)(c < 0x20 || c >= 0x7f ? '?' : c);
    }
    words[used] = '\0';
}

static void add_text(ExrPick *pick, const char *text) { add_name(pick->words, sizeof pick->words, text, strlen(text)); }

/* Says what was taken, unless it is all of R G B, or Y, without a layer. */
static void say(const exr_attr_chlist_t *channels, size_t length, int found, bool plain, ExrPick *pick) {
    const bool grey = pick->count <= 2, whole = grey || found == 3;
    if (plain && whole && !length) return;
    add_text(pick, found > 1 ? "channels" : "channel");
    for (int c = 0; c < 3; c++) {
        if (c >= pick->count || pick->from[c] < 0 || (grey && c > 0)) continue;
        const char *name = channels->entries[pick->from[c]].name.str;
        add_text(pick, " ");
        add_name(pick->words, sizeof pick->words, name, strlen(name) < 40 ? strlen(name) : 40);
    }
    add_text(pick, pick->xyz ? ", as CIE XYZ" : grey ? ", as grey" : "");
    if (!whole) add_text(pick, "; the colour that it lacks is 0");
}

/* Picks one set of colours of a layer; returns false if the layer lacks it. */
static bool set_pick(const exr_attr_chlist_t *channels, const char *of, size_t length, int set, ExrPick *pick) {
    const struct ColorSet *colors = &color_sets[set];
    const int most = colors->names[1] ? 3 : 1;
    int found = 0, last = -1;
    bool plain = set == 0 || strcmp(colors->names[0], "Y") == 0;
    *pick = (ExrPick){.from = {-1, -1, -1, -1}, .count = most, .xyz = colors->xyz};
    for (int c = 0; c < most; c++) {
        pick->from[c] = channel_find(channels, of, length, colors->names[c]);
        if (pick->from[c] < 0) continue;
        found++;
        last = pick->from[c];
        plain &= strcmp(channels->entries[last].name.str + length, colors->names[c]) == 0;
    }
    if (!found || (colors->all && found < most)) return false;
    if (found == 1 && most == 3) { /* one colour is a picture of numbers */
        pick->from[0] = last;
        pick->from[1] = pick->from[2] = -1;
        pick->count = 1;
        plain = false;
    }
    const int colors_count = pick->count;
    pick->from[colors_count] = channel_find(channels, of, length, "A");
    if (pick->from[colors_count] < 0) pick->from[colors_count] = channel_find(channels, of, length, "alpha");
    if (pick->from[colors_count] >= 0) pick->count++;
    say(channels, length, found, plain, pick);
    return true;
}

static bool layer_pick(const exr_attr_chlist_t *channels, const char *of, size_t length, ExrPick *pick) {
    bool picked = false;
    for (int set = 0; set < COLOR_SETS && !picked; set++) picked = set_pick(channels, of, length, set, pick);
    return picked;
}

bool exr_pick(const exr_attr_chlist_t *channels, ExrPick *pick) {
    bool picked = layer_pick(channels, "", 0, pick);
    for (int i = 0; !picked && i < channels->num_channels; i++) {
        const char *name = channels->entries[i].name.str;
        picked = layer_pick(channels, name, exr_layer_length(name), pick);
    }
    return picked;
}
