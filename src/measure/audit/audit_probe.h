/* audit_probe.h - a few texels of a table, and the ways in which they can be read
 *
 * The ways are compared with E at these texels alone, so that each costs little. */
#pragma once

#include "measure/bake/bake_texels.h"

enum { PROBE_SIDE = 8, PROBE_TEXELS = PROBE_SIDE * PROBE_SIDE };

/* Texels of some columns and rows, including the outermost, chosen symmetrically: PROBE_SIDE is even. */
typedef struct TableProbe {
    int width, height; /* size of the table */
    int columns, rows, x[PROBE_SIDE], y[PROBE_SIDE];
    float table[PROBE_TEXELS];
    double step; /* between two neighbouring values of the table's type */
    int threads;
} TableProbe;

/* Takes the texels from `values`, the width * height values of the table's one channel. */
void probe_take(TableProbe *probe, const float *values, int width, int height);

/* A way to read a table (an interpretation). */
typedef struct ProbeReading {
    WeftTableForm form;
    WeftTablePart part;
    Lobe lobe;
    int late;        /* texels, along the parameter */
    bool decoded;    /* from sRGB */
    double factor;   /* multiplies the values */
    double distance; /* mean |value - E|; infinite if no texel can be judged */
} ProbeReading;

/* Finds part and distance of a reading whose other members are given. */
void probe_read(const TableProbe *probe, ProbeReading *reading);

/* Returns the nearest reading in another form, of those that engines use or of all; with `scaled`, each with
 * the factor that brings it nearest. */
ProbeReading probe_best_form(const TableProbe *probe, const ProbeReading *reading, bool engines, bool scaled);

/* Returns the nearest reading with another lobe, its later parameters at their defaults, in the same form, or with
 * `forms` in any form that engines use. */
ProbeReading probe_best_lobe(const TableProbe *probe, const ProbeReading *reading, bool forms);

/* Returns the nearest reading of all lobes, in a form (NULL: in all forms), decoded or not. */
ProbeReading probe_any(const TableProbe *probe, const WeftTableForm *form);

/* Returns the nearest reading of all lobes in all these forms, shifted by a texel along the parameter or times a
 * factor: what hides lobe and axes from probe_any. It takes several times as long. */
ProbeReading probe_any_hidden(const TableProbe *probe, const WeftTableForm *form);

/* Returns the reading with the factor that brings its values nearest to E, in least squares. */
ProbeReading probe_scaled(const TableProbe *probe, const ProbeReading *reading);

/* Returns true if E of the lobe is constant over views and parameters to 1e-3. */
bool probe_flat(const Lobe *lobe, int threads);
