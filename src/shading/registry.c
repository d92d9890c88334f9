#include "shading/registry.h"

#include "lobes.gen.h"
#include "shading/lobe_tables.h"
#include "shading/terms.h"

/* What a parameter of each type may be: a number, or an index into these. */
#define choices_float                            NULL
#define D_TERM_ID(id, NAME, value, drawn, help)  [NAME] = id,
#define V_TERM_ID(id, NAME, value, help)         [NAME] = id,
#define F_TERM_ID(id, NAME, share, second, help) [NAME] = id,
static const char *const choices_DTerm[D_COUNT + 1] = {WEFT_D_TERMS(D_TERM_ID)};
static const char *const choices_VTerm[V_COUNT + 1] = {WEFT_V_TERMS(V_TERM_ID)};
static const char *const choices_FTerm[F_COUNT + 1] = {WEFT_F_TERMS(F_TERM_ID)};

#define PARAM_INFO(type, name, def, low, high, hard_low, hard_high, help)                                    \
    {#name, help, def, low, high, hard_low, hard_high, choices_##type},
#define LOBE_PARAM_INFOS(id, name, Record, NAME)                                                             \
    static const WeftParamInfo name##_params[] = {NAME##_PARAMS(PARAM_INFO){NULL, NULL, 0, 0, 0, 0, 0, NULL}};
WEFT_LOBES(LOBE_PARAM_INFOS)

#define LOBE_INFO(traits, id, name, NAME)                                                                    \
    {id, traits, (int)(sizeof name##_params / sizeof name##_params[0]) - 1, name##_params},
#define ONE_COLOR_INFO(id, name, Record, NAME) LOBE_INFO(NAME##_TRAITS, id, name, NAME)
#define TWO_COLOR_INFO(id, name, Record, NAME) LOBE_INFO(NAME##_TRAITS | TRAIT_TWO_COLORS, id, name, NAME)
#define TINTED_INFO(id, name, Record, NAME)    LOBE_INFO(NAME##_TRAITS | TRAIT_TINTED, id, name, NAME)
static const WeftLobeInfo infos[LOBE_COUNT] = {WEFT_ONE_COLOR_LOBES(ONE_COLOR_INFO) WEFT_TWO_COLOR_LOBES(
    TWO_COLOR_INFO) WEFT_TINTED_LOBES(TINTED_INFO) WEFT_REFERENCE_LOBES(ONE_COLOR_INFO)};

/* The list and the trait say the same. */
#define IS_TEXT(id, name, Record, NAME)                                                                      \
    _Static_assert(!((NAME##_TRAITS) & TRAIT_REFERENCE), id " is in the wrong list");
#define IS_REFERENCE(id, name, Record, NAME)                                                                 \
    _Static_assert((NAME##_TRAITS) & TRAIT_REFERENCE, id " lacks the trait of its list");
WEFT_TEXT_LOBES(IS_TEXT)
WEFT_REFERENCE_LOBES(IS_REFERENCE)

int weft_lobe_count(void) { return LOBE_COUNT; }

const WeftLobeInfo *weft_lobe_info(int lobe) { return lobe >= 0 && lobe < LOBE_COUNT ? &infos[lobe] : NULL; }

int weft_lobe_find(const char *id) {
    for (int k = 0; k < LOBE_COUNT; k++)
        if (strcmp(infos[k].id, id) == 0) return k;
    return -1;
}

#define PARAM_DEFAULT(type, name, def, low, high, hard_low, hard_high, help) def,
#define LOBE_DEFAULT(id, name, Record, NAME)                                 {LOBE_##NAME, {NAME##_PARAMS(PARAM_DEFAULT) 0.0f}},
static const Lobe defaults[LOBE_COUNT] = {WEFT_LOBES(LOBE_DEFAULT)};

Lobe lobe_default(int id) {
    if (infos[id].traits & TRAIT_TABLE) lobe_tables_make_for(id);
    return defaults[id];
}

/* p is a constant wherever this is called, so nothing is compared when it runs: a path asks at every hit. */
FN Lobe roughened(Lobe lobe, const WeftParamInfo *p, float roughness) {
    if (!p->name || p->choices) return lobe;
    float value = mix(p->low, p->high, roughness);
    if (strcmp(p->name, "alpha") == 0) value = roughness * roughness;
    if (strcmp(p->name, "roughness") == 0) value = roughness;
    lobe.params[0] = clamp(value, p->hard_low, p->hard_high);
    return lobe;
}

Lobe lobe_rough(int id, float roughness) {
    Lobe lobe = lobe_default(id);
    switch (id) {
#define LOBE_ROUGH(text, name, Record, NAME)                                                                 \
    case LOBE_##NAME: return roughened(lobe, &name##_params[0], roughness);
        WEFT_LOBES(LOBE_ROUGH)
    default: return lobe;
    }
}

/* The names are constants here too. */
#define PARAM_FIBRES(type, name, def, low, high, hard_low, hard_high, help)                                  \
    if (strcmp(#name, "density") == 0) lobe.params[k] = clamp(density, hard_low, hard_high);                 \
    if (strcmp(#name, "tilt") == 0) lobe.params[k] = clamp(tilt, hard_low, hard_high);                       \
    if (strcmp(#name, "azimuth") == 0) lobe.params[k] = clamp(azimuth, hard_low, hard_high);                 \
    k++;

Lobe lobe_fibres(Lobe lobe, float density, float tilt, float azimuth) {
    float first = lobe.params[0];
    int k = 0;
#define LOBE_FIBRES(text, name, Record, NAME)                                                                \
    if (lobe.id == LOBE_##NAME) {                                                                            \
        NAME##_PARAMS(PARAM_FIBRES)                                                                          \
    }
    WEFT_LOBES(LOBE_FIBRES)
    lobe.params[0] = first;
    return lobe;
}

int lobe_param(int id, const char *name) {
    for (int k = 0; k < infos[id].param_count; k++)
        if (strcmp(infos[id].params[k].name, name) == 0) return k;
    return -1;
}

void lobe_set(Lobe *lobe, int k, float value) {
    const WeftParamInfo *info = &infos[lobe->id].params[k];
    lobe->params[k] = clamp(value, info->hard_low, info->hard_high);
}

/* The array of parameters as the record that the lobe's text takes. */
#define FROM_ARRAY(type, name, def, low, high, hard_low, hard_high, help) m.name = (type)*p++;
#define LOBE_RECORD(id, name, Record, NAME)                                                                  \
    FN Record name##_record(const float *p) {                                                                \
        Record m = {0};                                                                                      \
        NAME##_PARAMS(FROM_ARRAY)(void) p;                                                                   \
        return m;                                                                                            \
    }
WEFT_LOBES(LOBE_RECORD)

LobeValue lobe_value(const Lobe *lobe, Angles a) {
    switch (lobe->id) {
#define ONE_COLOR_VALUE(id, name, Record, NAME)                                                              \
    case LOBE_##NAME: {                                                                                      \
        Record m = name##_record(lobe->params);                                                              \
        return (LobeValue){name##_eval(m, a), 0.0f, name##_pdf(m, a), tint_none()};                          \
    }
#define TWO_COLOR_VALUE(id, name, Record, NAME)                                                              \
    case LOBE_##NAME: {                                                                                      \
        Record m = name##_record(lobe->params);                                                              \
        return (LobeValue){name##_eval(m, a), name##_share(m, a), name##_pdf(m, a), tint_none()};            \
    }
#define TINTED_VALUE(id, name, Record, NAME)                                                                 \
    case LOBE_##NAME: {                                                                                      \
        Record m = name##_record(lobe->params);                                                              \
        Record##Ready ready = name##_ready(m);                                                               \
        return (LobeValue){name##_eval(ready, a), 0.0f, name##_pdf(m, a), name##_tint(ready, a)};            \
    }
        WEFT_ONE_COLOR_LOBES(ONE_COLOR_VALUE)
        WEFT_TWO_COLOR_LOBES(TWO_COLOR_VALUE)
        WEFT_TINTED_LOBES(TINTED_VALUE)
        WEFT_REFERENCE_LOBES(ONE_COLOR_VALUE)
    case LOBE_COUNT: break;
    }
    return (LobeValue){0.0f, 0.0f, 0.0f, tint_none()};
}

float lobe_second(Lobe lobe, float f0, float f90) {
    switch (lobe.id) {
#define LOBE_SECOND(id, name, Record, NAME)                                                                  \
    case LOBE_##NAME:                                                                                        \
        return name##_second(name##_record(lobe.params), f0, f90);
#define LOBE_WEIGHT(id, name, Record, NAME)                                                                  \
    case LOBE_##NAME: return 1.0f;
        WEFT_TWO_COLOR_LOBES(LOBE_SECOND)
        WEFT_TINTED_LOBES(LOBE_WEIGHT)
    default: return f0;
    }
}

Dir lobe_sample(const Lobe *lobe, Dir o, float u, float v) {
    switch (lobe->id) {
#define LOBE_SAMPLE(id, name, Record, NAME)                                                                  \
    case LOBE_##NAME: return name##_sample(name##_record(lobe->params), o, u, v);
        WEFT_LOBES(LOBE_SAMPLE)
    case LOBE_COUNT: break;
    }
    return dir(0.0f, 0.0f, -1.0f);
}

float lobe_walked_albedo(const Lobe *lobe, Dir o, int walks) {
    switch (lobe->id) {
#define LOBE_WALKED(id, name, Record, NAME)                                                                  \
    case LOBE_##NAME: return name##_albedo(name##_record(lobe->params), o, walks);
        WEFT_REFERENCE_LOBES(LOBE_WALKED)
    default: return 0.0f;
    }
}
