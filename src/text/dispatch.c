#include <stdio.h>
#include <stdlib.h>

#include "text/dispatch.h"

#include "shading/lobe_tables.h"
#include "text/number.h"
#include "text/tables.h"

/* How a lobe's text names its things. */
typedef struct LobeNames {
    const char *prefix, *record, *macros;
} LobeNames;

#define LOBE_NAMES(id, name, Record, NAME) {#name, #Record, #NAME},
static const LobeNames names[LOBE_COUNT] = {WEFT_LOBES(LOBE_NAMES)};

static bool has(int id, unsigned trait) { return weft_lobe_info(id)->traits & trait; }

void text_lobe(Text *text, int id) {
    char file[128];
    if (has(id, TRAIT_TABLE)) {
        lobe_tables_make_for(id);
        text_lobe_tables(text);
    }
    snprintf(file, sizeof file, "shading/lobes/%s.h", names[id].prefix);
    text_include(text, file);
}

/* The lobe's record from the array of parameters, in the order of its table: the table itself says the types.
 */
static void put_record(Text *text, int id) {
    const LobeNames *lobe = &names[id];
    char call[128];
    int size = snprintf(call, sizeof call, "%s_PARAMS(FIELD)", lobe->macros), param = 0;
    Buffer members = {0};
    macro_expand(&text->macros, call, call + size, &members);
    text_line(text, "\n%s %s_record(Lobe m) {\n    %s r;", lobe->record, lobe->prefix, lobe->record);
    const char *c = members.bytes, *end = c ? c + members.size : NULL;
    while (c) {
        Token type = token_solid(&c, end), name = token_solid(&c, end);
        if (name.kind != TOKEN_NAME || !token_is(token_solid(&c, end), ";")) break;
        bool plain = token_is(type, "float");
        char cast[64];
        snprintf(cast, sizeof cast, "%.*s(", (int)type.size, type.at);
        text_line(text, "    r.%.*s = %sm.params[%d]%s;", (int)name.size, name.at, plain ? "" : cast, param++,
                  plain ? "" : ")");
    }
    if (!param) text_line(text, "    r.none = 0.0;");
    text_line(text, "    return r;\n}");
    buffer_free(&members);
}

static void put_default(Text *text, const int *ids, int count) {
    text_line(text, "\nLobe lobe_default(int id) {\n    Lobe m;\n    m.id = id;");
    for (int p = 0; p < LOBE_PARAMS_MAX; p++) text_line(text, "    m.params[%d] = 0.0;", p);
    for (int k = 0; k < count; k++) {
        const WeftLobeInfo *info = weft_lobe_info(ids[k]);
        Lobe lobe = lobe_default(ids[k]);
        if (!info->param_count) continue;
        text_line(text, "    if (id == LOBE_%s) {", names[ids[k]].macros);
        for (int p = 0; p < info->param_count; p++)
            text_line(text, "        m.params[%d] = %s;", p, number(lobe.params[p]).text);
        text_line(text, "    }");
    }
    text_line(text, "    return m;\n}");
}

/* What lobe_rough of registry.c does with that parameter. */
static void put_rough(Text *text, const int *ids, int count) {
    text_line(text, "\nLobe lobe_rough(int id, float roughness) {\n    Lobe m = lobe_default(id);");
    for (int k = 0; k < count; k++) {
        const WeftLobeInfo *info = weft_lobe_info(ids[k]);
        const WeftParamInfo *p = &info->params[0];
        if (!info->param_count || p->choices) continue;
        char value[96] = "roughness";
        if (strcmp(p->name, "alpha") == 0)
            snprintf(value, sizeof value, "roughness * roughness");
        else if (strcmp(p->name, "roughness") != 0)
            snprintf(value, sizeof value, "mix(%s, %s, roughness)", number(p->low).text,
                     number(p->high).text);
        text_line(text, "    if (id == LOBE_%s) m.params[0] = clamp(%s, %s, %s);", names[ids[k]].macros,
                  value, number(p->hard_low).text, number(p->hard_high).text);
    }
    text_line(text, "    return m;\n}");
}

/* What lobe_fibres of registry.c does. */
static void put_fibres(Text *text, const int *ids, int count) {
    static const char *const names_of[] = {"density", "tilt", "azimuth"};
    text_line(text, "\nLobe lobe_fibres(Lobe m, float density, float tilt, float azimuth) {");
    for (int k = 0; k < count; k++)
        for (int n = 0; n < 3; n++) {
            int p = lobe_param(ids[k], names_of[n]);
            if (p < 1) continue; /* the first belongs to the roughness */
            const WeftParamInfo *info = &weft_lobe_info(ids[k])->params[p];
            text_line(text, "    if (m.id == LOBE_%s) m.params[%d] = clamp(%s, %s, %s);",
                      names[ids[k]].macros, p, names_of[n], number(info->hard_low).text,
                      number(info->hard_high).text);
        }
    text_line(text, "    return m;\n}");
}

/* A function from a lobe to its value, for lobes among these; with pdf, that too. */
static void put_value(Text *text, const char *name, const int *ids, int count, bool pdf) {
    text_line(text,
              "\nLobeValue %s(Lobe m, Angles a) {\n    LobeValue v;\n    v.f = 0.0;\n    v.s = 0.0;\n"
              "    v.pdf = 0.0;\n    v.tint = tint_none();",
              name);
    for (int k = 0; k < count; k++) {
        const LobeNames *lobe = &names[ids[k]];
        text_line(text, "    if (m.id == LOBE_%s) {\n        %s r = %s_record(m);", lobe->macros,
                  lobe->record, lobe->prefix);
        if (has(ids[k], TRAIT_TINTED))
            text_line(text,
                      "        %sReady ready = %s_ready(r);\n        v.f = %s_eval(ready, a);\n"
                      "        v.tint = %s_tint(ready, a);",
                      lobe->record, lobe->prefix, lobe->prefix, lobe->prefix);
        else
            text_line(text, "        v.f = %s_eval(r, a);", lobe->prefix);
        if (has(ids[k], TRAIT_TWO_COLORS)) text_line(text, "        v.s = %s_share(r, a);", lobe->prefix);
        if (pdf) text_line(text, "        v.pdf = %s_pdf(r, a);", lobe->prefix);
        text_line(text, "    }");
    }
    text_line(text, "    return v;\n}");
}

static void put_at(Text *text, const int *ids, int count) {
    put_value(text, "lobe_at", ids, count, true);
    text_line(text, "\nfloat lobe_f(Lobe m, Angles a) { return lobe_at(m, a).f; }\n"
                    "float lobe_share(Lobe m, Angles a) { return lobe_at(m, a).s; }\n"
                    "float lobe_pdf(Lobe m, Angles a) { return lobe_at(m, a).pdf; }");
}

void text_slots(Text *text, const TextSlot slots[TEXT_SLOTS]) {
    static const char *const functions[TEXT_SLOTS] = {"diffuse_at", "specular_at", "sheen_at", "coat_at"};
    text_provide(text, "shading/slots.h");
    for (int k = 0; k < TEXT_SLOTS; k++) put_value(text, functions[k], slots[k].lobes, slots[k].count, false);
}

static void put_second(Text *text, const int *ids, int count) {
    text_line(text, "\nfloat lobe_second(Lobe m, float f0, float f90) {");
    for (int k = 0; k < count; k++) {
        const LobeNames *lobe = &names[ids[k]];
        if (has(ids[k], TRAIT_TWO_COLORS))
            text_line(text, "    if (m.id == LOBE_%s) return %s_second(%s_record(m), f0, f90);", lobe->macros,
                      lobe->prefix, lobe->prefix);
        if (has(ids[k], TRAIT_TINTED)) text_line(text, "    if (m.id == LOBE_%s) return 1.0;", lobe->macros);
    }
    text_line(text, "    return f0;\n}");
}

static void put_sample(Text *text, const int *ids, int count) {
    text_line(text, "\nDir lobe_sample(Lobe m, Dir o, float u, float v) {");
    for (int k = 0; k < count; k++) {
        const LobeNames *lobe = &names[ids[k]];
        text_line(text, "    if (m.id == LOBE_%s) return %s_sample(%s_record(m), o, u, v);", lobe->macros,
                  lobe->prefix, lobe->prefix);
    }
    text_line(text, "    return dir(0.0, 0.0, -1.0);\n}");
}

/* The numbers of all lobes: constants of those that are there; what asks for others gets the bare number. */
static void put_ids(Text *text, const bool there[LOBE_COUNT]) {
    text_line(text, "%s", "");
    for (int id = 0; id < LOBE_COUNT; id++) {
        char name[96], value[16];
        snprintf(name, sizeof name, "LOBE_%s", names[id].macros);
        snprintf(value, sizeof value, "%d", id);
        if (there[id])
            text_line(text, "const int %s = %s;", name, value);
        else
            text_define(text, name, value);
    }
}

/* What stands for shading/dust_lobe.h where its lobe is not there. */
static void put_no_dust(Text *text) {
    if (!text_provide(text, "shading/dust_lobe.h")) return;
    text_line(text,
              "\nfloat dust_weight(float dust, float e_1, float cos_o) { return 0.0; }\n"
              "float dust_albedo(Lobe m, float cos_o) { return 0.0; }\n"
              "LobeValue dust_value(Lobe m, Angles a) {\n    LobeValue v;\n    v.f = 0.0;\n    v.s = 0.0;\n"
              "    v.pdf = 0.0;\n    v.tint = tint_none();\n    return v;\n}");
}

void text_dispatch(Text *text, const int *lobes, int lobe_count) {
    bool there[LOBE_COUNT] = {false};
    int ids[LOBE_COUNT]; /* each once */
    int count = 0;
    for (int k = 0; k < lobe_count; k++) {
        if (!there[lobes[k]]) ids[count++] = lobes[k];
        there[lobes[k]] = true;
    }
    text_include(text, "shading/angles.h");
    text_include(text, "shading/lobe_value.h");
    for (int k = 0; k < count; k++)
        lobe_tables_make_for(ids[k]); /* before the first asks for all there are */
    for (int k = 0; k < count; k++) text_lobe(text, ids[k]);
    text_provide(text, "shading/registry.h");
    char most[16];
    snprintf(most, sizeof most, "%d", LOBE_PARAMS_MAX);
    text_define(text, "LOBE_PARAMS_MAX", most);
    text_line(text, "\nstruct Lobe {\n    int id;\n    float params[%s];\n};", most);
    put_ids(text, there);
    for (int k = 0; k < count; k++) put_record(text, ids[k]);
    put_default(text, ids, count);
    put_rough(text, ids, count);
    put_fibres(text, ids, count);
    put_at(text, ids, count);
    put_second(text, ids, count);
    put_sample(text, ids, count);
    if (!there[LOBE_LTC_FIBRE]) put_no_dust(text);
}
