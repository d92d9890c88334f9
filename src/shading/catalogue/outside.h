/* outside.h - lobes from outside the catalogue: their functions, behind the ids after LOBE_COUNT
 *
 * In the dispatch they are one lobe more, `outside`, whose records hold those of any plugin (plugin.h). A
 * shader has them by name: text/assemble/dispatch.h. */
#pragma once

#include "shading/catalogue/plugin.h"
#include "shading/lobe_ids.gen.h"

/* The greatest number of such lobes, and the capacity of the records of one, floats. */
#define OUTSIDE_MOST            8
#define OUTSIDE_PREPARED_FLOATS 168
#define OUTSIDE_VIEW_FLOATS     24
#define LOBE_MOST               (LOBE_COUNT + OUTSIDE_MOST)
#define OUTSIDE_LABELS                                                                                                 \
    case LOBE_COUNT:                                                                                                   \
    case LOBE_COUNT + 1:                                                                                               \
    case LOBE_COUNT + 2:                                                                                               \
    case LOBE_COUNT + 3:                                                                                               \
    case LOBE_COUNT + 4:                                                                                               \
    case LOBE_COUNT + 5:                                                                                               \
    case LOBE_COUNT + 6:                                                                                               \
    case LOBE_COUNT + 7:
#define OUTSIDE_LOBES(X) X(OUTSIDE_LABELS, outside, Outside)

/* The lobe itself, which its plugin decodes. */
typedef const Lobe *Outside;
static inline Outside outside_of(const Lobe *m) { return m; }

/* An outside lobe keeps its functions: if its file is loaded again, lobes that are prepared do not change. */
typedef struct OutsidePrepared {
    const Plugin *by; /* NULL: no such lobe, which reflects nothing */
    float own[OUTSIDE_PREPARED_FLOATS];
} OutsidePrepared;
typedef struct OutsideView {
    float own[OUTSIDE_VIEW_FLOATS];
} OutsideView;

void outside_default(Lobe *m);
void outside_rough(Lobe *m, float roughness);
void outside_named(Lobe *m, LobeNamed n);
void outside_prepare(Outside m, OutsidePrepared *p);
void outside_view(const OutsidePrepared *p, Dir o, OutsideView *w);
LobeValue outside_value(const OutsidePrepared *p, const OutsideView *w, Angles a);
Dir outside_sample(const OutsidePrepared *p, const OutsideView *w, Dir o, float u, float v);
Strip outside_strips(const Lobe *m, Dir o, float u, float v);
float outside_seconds(const Lobe *m, float f0, float f90);
Proxy outside_proxies(const Lobe *m);

/* Returns the loops of that lobe; if there is none, loops that write zeros. */
const LobeLoops *outside_loops(int id);
