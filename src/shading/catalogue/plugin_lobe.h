/* plugin_lobe.h - makes a plugin of a lobe's file
 *
 * text/plugin/plugin_compile.c puts the file and this one into one text of C, which is compiled twice: with PLUGIN_LOOPS as
 * loops of the catalogue are, else as registry.c is, so that a lobe gives the same numbers here and in lobes.list. */
#pragma once

#include "shading/catalogue/plugin.h"
#include "shading/lobe/each_loop.h"

#define PLUGIN_TAKE(type, name, ...) r.name = (type)m->params[k++];
#define PLUGIN_PARAM(type, name, def, low, high, hard_low, hard_high, help)                                            \
    {#type, #name, help, def, low, high, hard_low, hard_high},

/* The record that both halves begin with. */
#define PLUGIN_RECORD(name, Name, NAME)                                                                                \
    FN Name name##_of(const Lobe *m) {                                                                                 \
        Name r;                                                                                                        \
        int k = 0;                                                                                                     \
        memset(&r, 0, sizeof r);                                                                                       \
        NAME##_PARAMS(PLUGIN_TAKE)(void) k;                                                                            \
        return r;                                                                                                      \
    }

#define PLUGIN_LOOPS_OF(name, Name, NAME, second)                                                                      \
    LOBE_LOOP(f, name, Name)                                                                                           \
    LOBE_LOOP(pdf, name, Name)                                                                                         \
    SHARES_LOOP(name, Name)                                                                                            \
    TINTED_LOOP(name, Name)                                                                                            \
    EACH_LOOPS(name, Name, NAME, second, ITS_ROUNDS)                                                                   \
    const Isa *plugin_isa;                                                                                             \
    static const EachLoops plugin_each = {name##_each_n, name##_drawn_each_n};                                         \
    const LobeLoops weft_lobe_loops = {name##_f_n, name##_pdf_n, name##_shares_n, name##_tinted_n, &plugin_each};

#define PLUGIN_SECOND(name)                                                                                            \
    static float plugin_second(const Lobe *m, float f0, float f90) { return name##_second(name##_of(m), f0, f90); }
#define PLUGIN_STRIP(name)                                                                                             \
    static void plugin_strip(const void *p, const Dir *o, float u, float v, Strip *s) {                                \
        *s = name##_strip(p, *o, u, v);                                                                                \
    }
#define PLUGIN_PROXY(name)                                                                                             \
    static Proxy plugin_proxy(const Lobe *m) { return name##_proxy(name##_of(m)); }

/* second, strip and proxy: plugin_second, plugin_strip and plugin_proxy, or NULL. */
#define PLUGIN_OF(name, Name, NAME, second, strip, proxy)                                                              \
    static const PluginParam plugin_params[] = {                                                                       \
        NAME##_PARAMS(PLUGIN_PARAM){NULL, NULL, NULL, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}};                                  \
    static void plugin_prepare(const Lobe *m, void *p) { name##_prepare(name##_of(m), p); }                            \
    static void plugin_view(const void *p, const Dir *o, void *w) { name##_view(p, *o, w); }                           \
    static void plugin_value(const void *p, const void *w, const Angles *a, LobeValue *v) {                            \
        *v = name##_value(p, w, *a);                                                                                   \
    }                                                                                                                  \
    static void plugin_sample(const void *p, const void *w, const Dir *o, float u, float v, Dir *i) {                  \
        *i = name##_sample(p, w, *o, u, v);                                                                            \
    }                                                                                                                  \
    __attribute__((visibility("default"))) const Plugin *weft_lobe_plugin(const Isa *isa) {                            \
        static const Plugin plugin = {NAME##_TRAITS,                                                                   \
                                      (int)(sizeof plugin_params / sizeof *plugin_params) - 1,                         \
                                      plugin_params,                                                                   \
                                      sizeof(Name##Prepared),                                                          \
                                      sizeof(Name##View),                                                              \
                                      plugin_prepare,                                                                  \
                                      plugin_view,                                                                     \
                                      plugin_value,                                                                    \
                                      plugin_sample,                                                                   \
                                      second,                                                                          \
                                      strip,                                                                           \
                                      proxy,                                                                           \
                                      &weft_lobe_loops};                                                               \
        plugin_isa = isa;                                                                                              \
        return &plugin;                                                                                                \
    }
