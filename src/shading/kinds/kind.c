#include "shading/kinds/kind.h"

#include "shading/kinds/kind_loops.h"

struct StackKind {
    int profile;
    int lobe[5]; /* of each slot; -1: it holds none */
    bool transmits;
    int layer, base_fresnel, albedo;
    const KindLoops *loops;
};

#define K(name, profile, diffuse, specular, sheen, coat, dust, transmits, layer, base_fresnel, albedo)                 \
    extern const KindLoops kind_loops_##name;
#include "shading/kinds.gen.h"
#undef K

#define K(name, profile, diffuse, specular, sheen, coat, dust, transmits, layer, base_fresnel, albedo)                 \
    {profile, {diffuse, specular, sheen, coat, dust}, transmits, layer, base_fresnel, albedo, &kind_loops_##name},
static const StackKind kinds[] = {
#include "shading/kinds.gen.h"
};

static bool same_choices(Choices c, int profile) {
    Choices expected = choices_unmade();
    expected.profile = profile;
    if (c.profile == 0) c.profile = CHOICE_AUTO; /* the first of either list is what auto comes to */
    if (c.workflow == 0) c.workflow = CHOICE_AUTO;
#define SAME_CHOICE(name, help) &&c.name == expected.name
    return true SURFACE_CHOICES(SAME_CHOICE);
}

#define FITS_SLOT(name, NAME, Name, wo)                                                                                \
    fits = fits && (!(m->name.normal > 0.0f) || m->name.lobe.id == *lobe);                                             \
    lobe++;
static bool holds_no_other(const StackKind *kind, const Stack *m) {
    const int *lobe = kind->lobe;
    bool fits = true;
    SLOTS(FITS_SLOT)
    return fits;
}

static bool fits(const StackKind *kind, const Stack *m, const Choices *choices) {
    bool has_e = !HAS_SHEEN(m) || (m->table.kind == TABLE_ROOTS && m->table.tilts == 0);
    return has_e && HAS_TRANSMITTED(m) == kind->transmits && m->layer == kind->layer && m->combine == LAYER_BY_MAX &&
           m->base_fresnel == kind->base_fresnel && m->albedo == kind->albedo && m->view == VIEW_NONE &&
           holds_no_other(kind, m) && same_choices(*choices, kind->profile);
}

const StackKind *stack_kind(const Stack *untextured, const Choices *choices) {
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (fits(&kinds[k], untextured, choices)) return &kinds[k];
    return NULL;
}

/* Returns a table with E = 0, for a stack without a sheen. */
static TableRef dark_table(void) {
    static const float zeros[5];
    TableRef e = {.texels = zeros, .kind = TABLE_ROOTS, .rows = 1, .columns = 4};
    return e;
}

void kind_shade(const StackKind *kind, KindVertices *v, TableRef e, const bool lights[KIND_LIGHTS], int n) {
    const KindLoops *loops = kind->loops;
    if (e.kind != TABLE_ROOTS) e = dark_table();
    loops->see(v, e, n);
    for (int k = 0; k < KIND_LIGHTS; k++)
        if (lights[k]) loops->eval(v, e, k, n);
    loops->sample(v, e, n);
    loops->eval(v, e, KIND_DRAWN, n);
}
