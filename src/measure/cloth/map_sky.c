#include "measure/cloth/map_sky.h"

#include <math.h>

#include "shading/workflows/metallic.h"
#include "weft/bake.h"

enum { SIDE = 32, CHANNELS = 2 };

/* The split sum at a view: the parts of F0 and of F90, and their sum. */
typedef struct SkySplit {
    float a, b, e;
} SkySplit;

/* Holds the numbers of a surface that count in a channel. */
typedef struct SkyBase {
    float f0, color, metallic, specular; /* f0: of dielectrics */
} SkyBase;

static float three_facets(SkySplit s, float f0, float f90) {
    const float single = f0 * s.a + f90 * s.b, mean = f0 + (1.0f - f0) / 21.0f, lost = 1.0f - s.e;
    return single * (1.0f + lost * mean / (1.0f - lost * mean));
}

static float three_base(SkySplit s, SkyBase b) {
    const float f90 = mix(b.specular, 1.0f, b.metallic), plain = three_facets(s, b.f0, f90);
    return mix(plain, three_facets(s, b.color, f90), b.metallic) + (1.0f - b.metallic) * b.color * (1.0f - plain);
}

/* Adds the light between facets to what they reflect, as Filament does. */
static float facets_all(SkySplit s, float f0, float single) { return single * (1.0f + f0 * (1.0f / s.e - 1.0f)); }

static float filament_base(SkySplit s, SkyBase b) {
    const float f0 = mix(b.f0, b.color, b.metallic), single = f0 * s.a + s.b;
    return facets_all(s, f0, single) + (1.0f - b.metallic) * b.color * (1.0f - single);
}

static float babylon_base(SkySplit s, SkyBase b) {
    const float f0 = mix(b.f0, b.color, b.metallic), f90 = mix(b.specular, 1.0f, b.metallic);
    const float most = mix(b.f0, 1.0f, b.metallic), taken = facets_all(s, most, most * s.a + f90 * s.b);
    return facets_all(s, f0, f0 * s.a + f90 * s.b) + b.color * (1.0f - fminf(taken, 1.0f));
}

static const struct SkyViewer {
    int view;
    float (*base)(SkySplit split, SkyBase base);
} viewers[] = {{VIEW_THREE, three_base}, {VIEW_FILAMENT, filament_base}, {VIEW_BABYLON, babylon_base}};
enum { VIEWERS = sizeof viewers / sizeof *viewers };

/* Returns the viewer of a stack; NULL: it is none of these. */
static const struct SkyViewer *viewer_of(const Stack *stack) {
    for (int k = 0; k < VIEWERS; k++)
        if (viewers[k].view == stack->view) return &viewers[k];
    return NULL;
}

bool map_sky_is_own(const Stack *stack) { return viewer_of(stack) != NULL; }

WeftResult map_sky_create(MapSky *out, WeftError *error) {
    const WeftBakeDesc desc = {.kind = "dfg", .width = SIDE, .height = SIDE, .form = {.edges = 1}};
    return weft_bake(&desc, NULL, &out->split, error);
}

void map_sky_free(MapSky *sky) { weft_image_free(&sky->split); }

/* Returns the part of F90 there, between four texels. */
static float bias_at(const MapSky *sky, float cosine, float roughness) {
    const float *texels = sky->split.pixels;
    const float x = clamp(cosine, 0.0f, 1.0f) * (SIDE - 1), y = clamp(roughness, 0.0f, 1.0f) * (SIDE - 1);
    const int left = (int)fminf(x, SIDE - 2), top = (int)fminf(y, SIDE - 2);
    const float *at = texels + CHANNELS * (top * SIDE + left) + 1;
    return mix(mix(at[0], at[CHANNELS], x - (float)left),
               mix(at[CHANNELS * SIDE], at[CHANNELS * (SIDE + 1)], x - (float)left), y - (float)top);
}

Rgb map_sky_light(const MapSky *sky, const SeenStack *seen, const Surface *surface) {
    const float cosine = seen->view.o.z, e = 1.0f / (1.0f + seen->view.extra);
    const float b = fminf(bias_at(sky, cosine, seen->stack.gloss), e);
    const SkySplit split = {.a = e - b, .b = b, .e = e};
    const Rgb f0 = metallic_f0(surface), color = surface->base_color;
    const Rgb sheen = rgb_scale(surface->sheen_color, surface->sheen);
    const float rim = HAS_SHEEN(&seen->stack) ? seen->view.e_o.e : 0.0f;
    const float keep = fmaxf(1.0f - rgb_max3(sheen) * rim, 0.0f);
    const float f0s[3] = {f0.r, f0.g, f0.b}, colors[3] = {color.r, color.g, color.b};
    const struct SkyViewer *viewer = viewer_of(&seen->stack);
    float light[3] = {0.0f, 0.0f, 0.0f};
    for (int c = 0; c < 3 && viewer; c++)
        light[c] = keep * viewer->base(split, (SkyBase){f0s[c], colors[c], surface->metallic, surface->specular});
    return rgb_add(rgb_scale(sheen, rim), rgb(light[0], light[1], light[2]));
}
