#include "shading/catalogue/registry.h"

#include "shading/lobe/lobe_tables.h"
#include "shading/lobe/terms.h"

#define LOBE_FN /* declared in registry.h */
#include "shading/dispatch.gen.h"

_Static_assert(LOBE_PARAMS_MAX == WEFT_LOBE_PARAMS_MAX, "the text and the public header differ");
#define SAME_TRAIT(NAME)                                                                                               \
    _Static_assert((int)TRAIT_##NAME == (int)WEFT_LOBE_##NAME, "the text and the public header differ")
SAME_TRAIT(RECIPROCAL);
SAME_TRAIT(CONSERVES);
SAME_TRAIT(LOSSLESS);
SAME_TRAIT(TWO_COLORS);
SAME_TRAIT(ANISOTROPIC);
SAME_TRAIT(REFERENCE);
SAME_TRAIT(DIFFUSE);
SAME_TRAIT(TABLE);
SAME_TRAIT(TINTED);

/* The values of a parameter of each type: a number, or an index into these. */
#define choices_float            NULL
#define D_TERM_ID(id, NAME, ...) [NAME] = id,
#define V_TERM_ID(id, NAME, ...) [NAME] = id,
#define F_TERM_ID(id, NAME, ...) [NAME] = id,
static const char *const choices_DTerm[D_COUNT + 1] = {WEFT_D_TERMS(D_TERM_ID)};
static const char *const choices_VTerm[V_COUNT + 1] = {WEFT_V_TERMS(V_TERM_ID)};
static const char *const choices_FTerm[F_COUNT + 1] = {WEFT_F_TERMS(F_TERM_ID)};

#define PARAM_INFO(type, name, def, low, high, hard_low, hard_high, help)                                              \
    {#name, help, def, low, high, hard_low, hard_high, choices_##type},
#include "shading/lobe_infos.gen.h"

int lobe_creases(const Lobe *lobe, float cos_o, float cosines[LOBE_CREASES_MOST]) {
    int count = 0;
    while (count < LOBE_CREASES_MOST && (cosines[count] = crease_of(lobe, cos_o, count)) > 0.0f) count++;
    return count;
}

const char *const *lobe_choices(const char *type) {
    return strcmp(type, "DTerm") == 0   ? choices_DTerm
           : strcmp(type, "VTerm") == 0 ? choices_VTerm
           : strcmp(type, "FTerm") == 0 ? choices_FTerm
                                        : NULL;
}

int weft_lobe_count(void) { return LOBE_COUNT + outside_count(); }

const WeftLobeInfo *weft_lobe_info(int lobe) {
    if (lobe >= 0 && lobe < LOBE_COUNT) return &own_infos[lobe];
    const OutsideLobe *outside = outside_lobe(lobe);
    return outside ? &outside->info : NULL;
}

int weft_lobe_find(const char *id) {
    const WeftLobeInfo *info;
    for (int k = 0; (info = weft_lobe_info(k)); k++)
        if (strcmp(info->id, id) == 0) return k;
    return -1;
}

const LobeNames *lobe_names(int id) { return id < LOBE_COUNT ? &own_names[id] : &outside_lobe(id)->names; }

int weft_lobe_param_find(int lobe, const char *name) {
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    for (int k = 0; info && k < info->param_count; k++)
        if (strcmp(info->params[k].name, name) == 0) return k;
    return -1;
}

void lobe_set(Lobe *lobe, int k, float value) {
    const WeftParamInfo *info = &weft_lobe_info(lobe->id)->params[k];
    lobe->params[k] = clamp(value, info->hard_low, info->hard_high);
}
