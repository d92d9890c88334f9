#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "shading/catalogue/outside.h"

#include "shading/catalogue/registry.h"

static _Atomic(const OutsideLobe *) taken[OUTSIDE_MOST];
static atomic_int taken_count;

int outside_count(void) { return atomic_load(&taken_count); }

const OutsideLobe *outside_lobe(int id) {
    int k = id - LOBE_COUNT;
    return k >= 0 && k < OUTSIDE_MOST ? atomic_load(&taken[k]) : NULL;
}

/* Returns the place of the lobe of that name, or the place where it would be added. */
static int place_of(const char *id) {
    int k = 0;
    while (k < outside_count() && strcmp(outside_lobe(LOBE_COUNT + k)->info.id, id) != 0) k++;
    return k;
}

bool outside_take(OutsideLobe *lobe, int *id) {
    static pthread_mutex_t taking = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&taking);
    int k = place_of(lobe->info.id);
    if (k < OUTSIDE_MOST) {
        lobe->before = atomic_load(&taken[k]);
        atomic_store(&taken[k], lobe);
        if (k == outside_count()) atomic_store(&taken_count, k + 1);
        *id = LOBE_COUNT + k;
    }
    pthread_mutex_unlock(&taking);
    return k < OUTSIDE_MOST;
}

/* Sets the parameters' defaults, which are data and need no plugin function. */

void outside_default(Lobe *m) {
    const OutsideLobe *lobe = outside_lobe(m->id);
    for (int k = 0; lobe && k < lobe->info.param_count; k++) m->params[k] = lobe->info.params[k].def;
}

void outside_rough(Lobe *m, float roughness) {
    const OutsideLobe *lobe = outside_lobe(m->id);
    if (!lobe || !lobe->info.param_count || lobe->info.params[0].choices) return;
    const WeftParamInfo *p = &lobe->info.params[0];
    float value = mix(p->low, p->high, roughness);
    if (strcmp(p->name, "alpha") == 0) value = roughness * roughness;
    if (strcmp(p->name, "roughness") == 0) value = roughness;
    m->params[0] = clamp(value, p->hard_low, p->hard_high);
}

void outside_named(Lobe *m, LobeNamed n) {
#define NAMED_VALUE(name) {#name, n.name},
    const struct {
        const char *name;
        float value;
    } all[] = {LOBE_NAMES(NAMED_VALUE)};
    for (size_t k = 0; outside_lobe(m->id) && k < sizeof all / sizeof *all; k++) {
        bool first = strcmp(all[k].name, "beta") == 0 || strcmp(all[k].name, "wrap") == 0;
        int at = weft_lobe_param_find(m->id, all[k].name);
        if (at > (first ? -1 : 0) && all[k].value >= 0.0f) lobe_set(m, at, all[k].value);
    }
}

static const Plugin *plugin_of(int id) {
    const OutsideLobe *lobe = outside_lobe(id);
    return lobe ? lobe->plugin : NULL;
}

void outside_prepare(Outside m, OutsidePrepared *p) {
    p->by = plugin_of(m->id);
    if (p->by) p->by->prepare(m, p->own);
}

void outside_view(const OutsidePrepared *p, Dir o, OutsideView *w) {
    if (p->by) p->by->view(p->own, &o, w->own);
}

LobeValue outside_value(const OutsidePrepared *p, const OutsideView *w, Angles a) {
    LobeValue v = lobe_value_of(0.0f, 0.0f, 0.0f);
    if (p->by) p->by->value(p->own, w->own, &a, &v);
    return v;
}

Dir outside_sample(const OutsidePrepared *p, const OutsideView *w, Dir o, float u, float v) {
    Dir i = dir(0.0f, 0.0f, -1.0f);
    if (p->by) p->by->sample(p->own, w->own, &o, u, v, &i);
    return i;
}

Strip outside_strips(const Lobe *m, Dir o, float u, float v) {
    Strip s = {.h = dir(0.0f, 0.0f, 1.0f)};
    OutsidePrepared p;
    outside_prepare(m, &p);
    if (p.by && p.by->strip) p.by->strip(p.own, &o, u, v, &s);
    return s;
}

float outside_seconds(const Lobe *m, float f0, float f90) {
    const Plugin *plugin = plugin_of(m->id);
    if (plugin && plugin->traits & TRAIT_TWO_COLORS) return plugin->second ? plugin->second(m, f0, f90) : f90;
    return plugin && plugin->traits & TRAIT_TINTED ? 1.0f : f0;
}

Proxy outside_proxies(const Lobe *m) {
    const Plugin *plugin = plugin_of(m->id);
    return plugin && plugin->proxy ? plugin->proxy(m) : proxy_cosine();
}

/* Fills out with 0: the loop for an id without a lobe. */
static void no_loop(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict out) { memset(out, 0, n * sizeof *out); }
static void no_shares(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s) {
    no_loop(m, n, ox, oy, oz, ix, iy, iz, f);
    no_loop(m, n, ox, oy, oz, ix, iy, iz, s);
}
static void no_tinted(const Lobe *m, const float c[3], size_t n, LOOP_PAIRS, float *restrict r, float *restrict g,
                      float *restrict b) {
    no_loop(m, n, ox, oy, oz, ix, iy, iz, r);
    no_loop(m, n, ox, oy, oz, ix, iy, iz, g);
    no_loop(m, n, ox, oy, oz, ix, iy, iz, b);
}

static void no_each(const Each *e, size_t n) {
    for (int c = 0; c < 3; c++) memset(e->f[c], 0, n * sizeof *e->f[c]);
    memset(e->pdf, 0, n * sizeof *e->pdf);
}
static void no_drawn(const Each *e, size_t n) {
    for (int c = 0; c < 3; c++) memset(e->drawn[c], 0, n * sizeof *e->drawn[c]);
}

const LobeLoops *outside_loops(int id) {
    static const EachLoops each = {no_each, no_drawn};
    static const LobeLoops none = {no_loop, no_loop, no_shares, no_tinted, &each};
    const Plugin *plugin = plugin_of(id);
    return plugin ? plugin->loops : &none;
}
