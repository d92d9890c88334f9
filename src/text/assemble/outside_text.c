#include <stdio.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "text/assemble/outside_text.h"

#include "shading/catalogue/registry.h"
#include "text/assemble/dispatch.h"
#include "text/source/number_text.h"

/* Writes the functions that make a lobe's record from its array of parameters, and fill the array with defaults. */
static void put_params(const OutsideLobe *lobe, Buffer *out) {
    const char *name = lobe->names.prefix, *record = lobe->names.record;
    buffer_print(out, "FN %s %s_of(const Lobe *m) {\n    %s r;\n", record, name, record);
    for (int k = 0; k < lobe->info.param_count; k++)
        buffer_print(out, "    r.%s = %s(m->params[%d]);\n", lobe->info.params[k].name,
                     lobe->info.params[k].choices ? "to_int" : "to_float", k);
    if (!lobe->info.param_count) buffer_print(out, "    r.none = 0.0f;\n");
    buffer_print(out, "    return r;\n}\nFN void %s_default(Lobe *m) {\n", name);
    for (int k = 0; k < lobe->info.param_count; k++)
        buffer_print(out, "    m->params[%d] = %sf;\n", k, number(lobe->info.params[k].def).text);
    buffer_print(out, "}\n");
}

static void put_clamped(const WeftParamInfo *p, int k, const char *value, Buffer *out) {
    buffer_print(out, "    m->params[%d] = clamp(%s, %sf, %sf);\n", k, value, number(p->hard_low).text,
                 number(p->hard_high).text);
}

/* Writes the functions that set a lobe's parameters from a roughness and from common names, as cmake/lobes.cmake
 * does. */
static void put_common(const OutsideLobe *lobe, Buffer *out) {
#define NAME_AND_BLANK(name) #name " "
    static const char every[] = " " LOBE_NAMES(NAME_AND_BLANK);
    const WeftParamInfo *p = lobe->info.params;
    char mixed[120];
    buffer_print(out, "FN void %s_rough(Lobe *m, float roughness) {\n", lobe->names.prefix);
    if (lobe->info.param_count && !p->choices) {
        snprintf(mixed, sizeof mixed, "mix(%sf, %sf, roughness)", number(p->low).text, number(p->high).text);
        put_clamped(p, 0,
                    strcmp(p->name, "alpha") == 0       ? "roughness * roughness"
                    : strcmp(p->name, "roughness") == 0 ? "roughness"
                                                        : mixed,
                    out);
    }
    buffer_print(out, "}\nFN void %s_named(Lobe *m, LobeNamed n) {\n", lobe->names.prefix);
    for (int k = 0; k < lobe->info.param_count; k++) {
        snprintf(mixed, sizeof mixed, " %s ", p[k].name);
        if (!strstr(k ? every : " beta wrap ", mixed)) continue;
        snprintf(mixed, sizeof mixed, "n.%s", p[k].name);
        buffer_print(out, "    if (%s >= 0.0f)\n    ", mixed);
        put_clamped(&p[k], k, mixed, out);
    }
    buffer_print(out, "}\n");
}

static void put_strips(const OutsideLobe *lobe, Buffer *out) {
    const char *name = lobe->names.prefix;
    buffer_print(out, "FN Strip %s_strips(const Lobe *m, Dir o, float u, float v) {\n", name);
    if (lobe->names.strips)
        buffer_print(out, "    %sPrepared p;\n    %s_prepare(%s_of(m), &p);\n    return %s_strip(&p, o, u, v);\n}\n",
                     lobe->names.record, name, name, name);
    else
        buffer_print(out, "    Strip none;\n    none.h = dir(0.0f, 0.0f, 1.0f);\n    none.density = 0.0f;\n"
                          "    return none;\n}\n");
}

static void put_seconds(const OutsideLobe *lobe, Buffer *out) {
    const char *name = lobe->names.prefix;
    buffer_print(out, "FN float %s_seconds(const Lobe *m, float f0, float f90) {\n    return ", name);
    if (lobe->info.traits & TRAIT_TWO_COLORS && lobe->plugin->second)
        buffer_print(out, "%s_second(%s_of(m), f0, f90)", name, name);
    else if (lobe->info.traits & TRAIT_TWO_COLORS)
        buffer_print(out, "f90");
    else
        buffer_print(out, "%s", lobe->info.traits & TRAIT_TINTED ? "1.0f" : "f0");
    buffer_print(out, ";\n}\n");
}

static void put_proxies(const OutsideLobe *lobe, Buffer *out) {
    const char *name = lobe->names.prefix;
    buffer_print(out, "FN Proxy %s_proxies(const Lobe *m) {\n    return ", name);
    if (lobe->plugin->proxy)
        buffer_print(out, "%s_proxy(%s_of(m));\n}\n", name, name);
    else
        buffer_print(out, "proxy_cosine();\n}\n");
}

void text_outside(Text *text, const bool there[LOBE_MOST]) {
    text_provide(text, "shading/catalogue/outside.h");
    for (int id = LOBE_COUNT; id < LOBE_MOST; id++) {
        const OutsideLobe *lobe = outside_lobe(id);
        if (!lobe || !there[id]) continue;
        Buffer rows = {0};
        text_include(text, "shading/terms/d_ggx.h");
        text_include(text, "shading/dialect/proxy.h");
        text_lobe(text, id);
        buffer_print(&rows, "#define LOBE_%s %d\n", lobe->names.macros, id);
        put_params(lobe, &rows);
        put_common(lobe, &rows);
        put_strips(lobe, &rows);
        put_seconds(lobe, &rows);
        put_proxies(lobe, &rows);
        text_source(text, "shading/catalogue/outside.h", &rows);
        buffer_free(&rows);
    }
}

void text_outside_lines(Text *text, const bool there[LOBE_MOST]) {
    Buffer lines = {0};
    for (int id = LOBE_COUNT; id < LOBE_MOST; id++) {
        const OutsideLobe *lobe = outside_lobe(id);
        if (lobe && there[id])
            buffer_print(&lines, " X(case LOBE_%s:, %s, %s)", lobe->names.macros, lobe->names.prefix,
                         lobe->names.record);
    }
    text_define(text, "OUTSIDE_LOBES(X)", lines.bytes ? lines.bytes : "");
    buffer_free(&lines);
}
