#include "scene/builtin/builtin.h"

#include "scene/builtin/bend_scene.h"
#include "scene/builtin/lampshade.h"
#include "scene/builtin/loom_scene.h"
#include "scene/builtin/spheres.h"
#include "scene/builtin/swatch_scene.h"

extern const unsigned char embedded_cloth_glb[], embedded_cloth_glb_end[], embedded_sewing_glb[],
    embedded_sewing_glb_end[];

static const Builtin builtins[] = {
    {"ball", "one ball in velvet on a floor, to look at one material", NULL, NULL, ball_make},
    {"bend", "a cloth over a bend of 150 degrees and nothing else, as weft deliver hands it over", NULL, NULL,
     bend_make},
    {"cloth", "velvet draped over a form on a plinth, under a soft box", embedded_cloth_glb, embedded_cloth_glb_end,
     NULL},
    {"lampshade", "a lit lamp before a curtain: light through cloth", NULL, NULL, lampshade_make},
    {"loom", "swatches woven of drafts, and denim over a bar: from 5 threads to 5,000", NULL, NULL, loom_make},
    {"sewing", "an old sewing machine that has gathered dust, cloth under its needle", embedded_sewing_glb,
     embedded_sewing_glb_end, NULL},
    {"spheres", "sheen roughness 0.1 to 1 in five steps, over a dark and a light base", NULL, NULL, spheres_make},
    {"swatch", "a cloth over a bend, so near that its threads are seen: the window's pictures of presets", NULL, NULL,
     swatch_make},
};

const Builtin *builtin_at(int index) {
    return index >= 0 && index < (int)(sizeof builtins / sizeof *builtins) ? &builtins[index] : NULL;
}

const char *weft_builtin_name(int index) { return builtin_at(index) ? builtin_at(index)->name : NULL; }
const char *weft_builtin_help(int index) { return builtin_at(index) ? builtin_at(index)->help : NULL; }
