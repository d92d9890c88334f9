/* plugin.h - a lobe behind pointers: what the machine's compiler makes of a lobe's file (plugin_lobe.h) */
#pragma once

#include <stddef.h>

#include "shading/dialect/isa.h"
#include "shading/lobe/loops.h"
#include "shading/lobe/traits.h"
#include "shading/terms/d_ggx.h"

/* One line of a lobe's table. */
typedef struct PluginParam {
    const char *type, *name, *help;
    float def, low, high, hard_low, hard_high;
} PluginParam;

/* p and w are records of the lobe's own, of these sizes; the calls are those of lobe.h. */
typedef struct Plugin {
    unsigned traits;
    int param_count;
    const PluginParam *params;
    size_t prepared_size, view_size;
    void (*prepare)(const Lobe *m, void *p);
    void (*view)(const void *p, const Dir *o, void *w);
    void (*value)(const void *p, const void *w, const Angles *a, LobeValue *v);
    void (*sample)(const void *p, const void *w, const Dir *o, float u, float v, Dir *i);
    float (*second)(const Lobe *m, float f0, float f90);                    /* NULL: it is f90 */
    void (*strip)(const void *p, const Dir *o, float u, float v, Strip *s); /* NULL: it has none */
    Proxy (*proxy)(const Lobe *m);                                          /* NULL: a cosine */
    const LobeLoops *loops;
} Plugin;

/* The type of weft_lobe_plugin, the only name that a plugin exports. It returns the plugin, whose loops run with the
 * instructions that *isa contains at each call. */
typedef const Plugin *PluginEntry(const Isa *isa);
#define PLUGIN_ENTRY "weft_lobe_plugin"
PluginEntry weft_lobe_plugin;
extern const LobeLoops weft_lobe_loops;
extern const Isa *plugin_isa;
