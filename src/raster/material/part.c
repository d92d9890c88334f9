#include "raster/material/part.h"

/* A part of the light with the macro of its slot, or a property with its expression in glsl/forward.glsl. */
typedef struct PartView {
    const char *name, *slot, *property;
} PartView;

static const PartView parts[WEFT_PART_COUNT] = {
    [WEFT_PART_ALL] = {"all", NULL, NULL},
    [WEFT_PART_DIFFUSE] = {"diffuse", "SHOWS_DIFFUSE", NULL},
    [WEFT_PART_SPECULAR] = {"specular", "SHOWS_SPECULAR", NULL},
    [WEFT_PART_SHEEN] = {"sheen", "SHOWS_SHEEN", NULL},
    [WEFT_PART_COAT] = {"coat", "SHOWS_COAT", NULL},
    [WEFT_PART_DUST] = {"dust", "SHOWS_DUST", NULL},
    [WEFT_PART_BASE_COLOR] = {"base-color", NULL, "vec_of(s.base_color)"},
    [WEFT_PART_NORMAL] = {"normal", NULL, "(0.5 + 0.5 * vec_of_dir(f.z))"},
    [WEFT_PART_ROUGHNESS] = {"roughness", NULL, "vec3(s.roughness)"},
    [WEFT_PART_SHEEN_COLOR] = {"sheen-color", NULL, "vec_of(s.sheen_color)"},
    [WEFT_PART_SHEEN_ROUGHNESS] = {"sheen-roughness", NULL, "vec3(s.sheen_roughness)"},
    [WEFT_PART_TEXCOORD] = {"texcoord", NULL, "vec3(fract(texcoord_0), 0.0)"},
};

const char *weft_part_name(int part) { return part >= 0 && part < WEFT_PART_COUNT ? parts[part].name : NULL; }

bool part_is_property(int part) { return parts[part].property != NULL; }

void part_text(int part, Text *text) {
    for (int k = 0; k < WEFT_PART_COUNT; k++)
        if (parts[k].slot) text_define(text, parts[k].slot, part == WEFT_PART_ALL || part == k ? "true" : "false");
    text_define(text, "SHOWS_EMISSION", part == WEFT_PART_ALL ? "1.0" : "0.0");
    if (parts[part].property) text_define(text, "PROPERTY", parts[part].property);
}
