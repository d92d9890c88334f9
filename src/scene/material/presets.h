/* presets.h - the materials that need no file: scenes/presets/NAME.json, embedded */
#pragma once

/* The groups of presets, in the order in which they are shown: name, and what such presets have in common. */
#define PRESET_GROUPS(G)                                                                                               \
    G("woven", "cloth with threads, each of a draft and two yarns; seen from near and far")                            \
    G("published", "cloth with threads by the numbers of a paper, to be compared with ours")                           \
    G("pile", "cloth with upright fibres, as a surface without threads")                                               \
    G("smooth", "cloth without pile, as a surface without threads")                                                    \
    G("measured", "fits of measured fabrics")                                                                          \
    G("hard", "metal and plastic, to stand beside cloth")

typedef struct Preset {
    const char *name, *group, *help;
    const char *text; /* a material file, zero-terminated */
} Preset;

/* Returns the preset at index, or NULL past the end. The function is generated. */
const Preset *preset_at(int index);
