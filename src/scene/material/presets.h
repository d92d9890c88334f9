/* presets.h - the materials that need no file: scenes/presets/NAME.json, embedded */
#pragma once

typedef struct Preset {
    const char *name, *help;
    const char *text; /* a material file, zero-terminated */
} Preset;

/* Returns the preset at index, or NULL past the end. The function is generated. */
const Preset *preset_at(int index);
