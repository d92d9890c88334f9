/* yarns.c - the named yarns, and the numbers of a yarn */
#include <stddef.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "weft/weave.h"

#define DEGREES ((float)RADIANS)

/* Y(name, help, alpha, crimp, roundness, twist, white, width, bulge, floats, streaks, dye, slub, wander, hairiness,
 * slub_length, barre, barre_width, uneven, uneven_size, core), crimp and twist in degrees, lengths in millimetres. */
#define YARNS(Y)                                                                                                       \
    Y("cotton", "spun, matt, slightly uneven", 0.4f, 25, 0.95f, -24, 0.04f, 0.96f, 0.1f, 1.2f, 0.25f, 0.12f, 0.3f,     \
      0.35f, 0.7f, 12, 0.06f, 25, 0.06f, 90, 0.6f)                                                                     \
    Y("linen", "dry and straight, with slubs and small gaps", 0.3f, 20, 0.95f, -12, 0.05f, 0.86f, 0.05f, 1.2f, 0.3f,   \
      0.16f, 0.9f, 0.7f, 0.5f, 30, 0.12f, 12, 0.08f, 120, 0.5f)                                                        \
    Y("wool", "soft and full", 0.5f, 26, 0.9f, -28, 0.03f, 1.02f, 0.2f, 1.2f, 0.35f, 0.12f, 0.35f, 0.5f, 1.0f, 20,     \
      0.05f, 30, 0.06f, 120, 0.5f)                                                                                     \
    Y("silk", "filament with hardly any twist", 0.12f, 22, 0.9f, 0, 0.12f, 1.0f, 0.55f, 1.6f, 0.1f, 0.05f, 0.06f,      \
      0.15f, 0.0f, 40, 0.05f, 15, 0.03f, 150, 0.7f)                                                                    \
    Y("dupion", "raw silk of uneven thickness", 0.14f, 24, 0.95f, -4, 0.12f, 0.95f, 0.2f, 1.4f, 0.2f, 0.1f, 1.3f,      \
      0.6f, 0.1f, 40, 0.15f, 10, 0.05f, 120, 0.6f)                                                                     \
    Y("polyester", "smooth filament", 0.16f, 20, 0.9f, 0, 0.1f, 0.98f, 0.35f, 1.5f, 0.06f, 0.02f, 0.03f, 0.08f, 0.0f,  \
      60, 0.04f, 20, 0.02f, 200, 0.75f)

static const struct {
    const char *name, *help;
    WeftYarn yarn;
} yarns[] = {
#define ROW(name, help, alpha, crimp, roundness, twist, white, width, bulge, floats, streaks, dye, slub, wander,       \
            hairiness, slub_length, barre, barre_width, uneven, uneven_size, core)                                     \
    {name,                                                                                                             \
     help,                                                                                                             \
     {alpha, (crimp)*DEGREES, roundness, (twist)*DEGREES, white, width, bulge, floats, streaks, dye, slub, wander,     \
      hairiness, slub_length, barre, barre_width, uneven, uneven_size, core}},
    YARNS(ROW)
#undef ROW
};

const char *weft_yarn_name(int index) {
    return index >= 0 && index < (int)(sizeof yarns / sizeof *yarns) ? yarns[index].name : NULL;
}

const char *weft_yarn_help(int index) { return weft_yarn_name(index) ? yarns[index].help : NULL; }

WeftResult weft_yarn_find(const char *name, WeftYarn *out, WeftError *error) {
    for (size_t k = 0; k < sizeof yarns / sizeof *yarns; k++)
        if (strcmp(yarns[k].name, name) == 0) {
            *out = yarns[k].yarn;
            return WEFT_OK;
        }
    return fail(error, WEFT_MESSAGE_YARN_NAME, name, "cotton, linen, wool, silk, dupion, polyester");
}

static const WeftYarnNumber numbers[] = {
#define NUMBER(name, low, high, angle, help)                                                                           \
    { #name, help, offsetof(WeftYarn, name), low, high, angle }
    NUMBER(alpha, 0.05f, 1.0f, 0, "Width of the highlight across the fibres: silk 0.1, cotton 0.4, wool 0.5."),
    NUMBER(crimp, 0.0f, 1.2f, 1, "Steepest angle of the thread along itself, where it dives below another."),
    NUMBER(roundness, 0.0f, 1.5f, 0, "Slope at the edges of a thread: a flat ribbon has 0."),
    NUMBER(twist, -1.5f, 1.5f, 1, "Of the fibres about the thread: 0 filament, below 0 as in a Z, above as in an S."),
    NUMBER(white, 0.0f, 1.0f, 0, "Share of light that a fibre reflects without its dye."),
    NUMBER(width, 0.05f, 2.0f, 0, "Of a thread, in parts of the draft's: below 1 there are gaps."),
    NUMBER(bulge, 0.0f, 1.0f, 0, "How much wider the middle of a long float is."),
    NUMBER(floats, 0.0f, 8.0f, 0, "How level a long float lies."),
    NUMBER(streaks, 0.0f, 2.0f, 0, "Slope at the edges of a fibre, which also turns and takes more or less dye."),
    NUMBER(dye, 0.0f, 1.0f, 0, "How far colour varies from thread to thread, and along each."),
    NUMBER(slub, 0.0f, 2.0f, 0, "How far thickness varies along a thread."),
    NUMBER(wander, 0.0f, 2.0f, 0, "How far a thread strays from its place."),
    NUMBER(hairiness, 0.0f, 1.0f, 0, "Loose fibres on the cloth: 1 is about one for each crossing."),
    NUMBER(slub_length, 2.0f, 500.0f, 0, "Along a thread from a thin place to a thick one, millimetres."),
    NUMBER(barre, 0.0f, 0.5f, 0, "How far colour varies from lot to lot of the yarn: bars of many threads (barre)."),
    NUMBER(barre_width, 2.0f, 500.0f, 0, "Of the widest bars, millimetres."),
    NUMBER(uneven, 0.0f, 0.5f, 0, "How unevenly the cloth took its dye, in patches."),
    NUMBER(uneven_size, 2.0f, 1000.0f, 0, "Of the largest patches, millimetres."),
    NUMBER(core, 0.0f, 1.0f, 0, "Reflectance inside the thread, seen where wear has taken the dye off."),
#undef NUMBER
};

const WeftYarnNumber *weft_yarn_number(int index) {
    return index >= 0 && index < (int)(sizeof numbers / sizeof *numbers) ? &numbers[index] : NULL;
}
