/* chart.h - reference materials: base colour and reflectance that were measured and published, of dielectrics
 * and metals, to compare a material with
 *
 *   const WeftChartEntry *entry;
 *   for (int k = 0; (entry = weft_chart(k)); k++) draw_swatch(entry->name, entry->base_color, entry->f0);
 *
 * Colours are linear Rec. 709. docs/chart.md shows all of it, `weft models chart:` prints it. */
#ifndef WEFT_CHART_H
#define WEFT_CHART_H

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* METAL: base_color equals f0, metallic is 1. OPAQUE: a dielectric with a diffuse colour. CLEAR: a dielectric
 * without one, such as glass or an undyed fibre; base_color is then white. GEM: clear, and of an index of
 * refraction that no other dielectric of the chart has. */
typedef enum WeftChartKind { WEFT_CHART_OPAQUE = 0, WEFT_CHART_CLEAR, WEFT_CHART_GEM, WEFT_CHART_METAL } WeftChartKind;

/* A material of the chart. */
typedef struct WeftChartEntry {
    const char *name;   /* an id, "gold"; unique in the chart */
    const char *help;   /* a note beside the name, or "" */
    const char *source; /* author, title, year */
    WeftChartKind kind; /* what base_color means */
    /* 0 .. 1, for the input base_color; in workflow specular a metal has f0 as specular_color and base_color black */
    float base_color[3];
    float f0[3]; /* reflectance at normal incidence, 0 .. 1; equal channels unless METAL */
    float ior;   /* index of refraction, from which f0 follows; 0 of a METAL */
} WeftChartEntry;

/* Returns the entry at index; NULL out of range. Entries are ordered by kind and then from dark to bright, by the
 * luminance of base_color, or of f0 where base_color is white. An entry lives as long as the program. */
WEFT_API const WeftChartEntry *weft_chart(int index);

#ifdef __cplusplus
}
#endif

#endif
