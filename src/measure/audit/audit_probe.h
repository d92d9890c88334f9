/* audit_probe.h - a few texels of a table, read in all ways it may be meant in
 *
 * The ways are compared with E at those texels alone, so that trying them costs little. */
#ifndef WEFT_MEASURE_AUDIT_PROBE_H
#define WEFT_MEASURE_AUDIT_PROBE_H

#include "measure/bake/bake_texels.h"

enum { PROBE_SIDE = 8, PROBE_TEXELS = PROBE_SIDE * PROBE_SIDE };

/* Texels of some columns and rows, the outermost among them, the same ones from either end: PROBE_SIDE is
 * even. */
typedef struct TableProbe {
    int width, height; /* of the table */
    int columns, rows, x[PROBE_SIDE], y[PROBE_SIDE];
    float table[PROBE_TEXELS];
    double step; /* between two values that the table's type can hold */
    int threads;
} TableProbe;

/* values: of the table's one channel, width * height. */
void probe_take(TableProbe *probe, const float *values, int width, int height);

/* A way to read a table. */
typedef struct ProbeReading {
    WeftTableForm form;
    WeftTablePart part;
    Lobe lobe;
    int late;        /* texels, along the parameter */
    bool decoded;    /* from sRGB */
    double factor;   /* multiplies the values */
    double distance; /* mean |value - E|; infinite where no texel can be judged */
} ProbeReading;

/* Finds part and distance of a reading whose other members are given. */
void probe_read(const TableProbe *probe, ProbeReading *reading);

/* The nearest reading of those in other forms, which engines use or which there are; where `scaled`, each
 * with the factor that brings it nearest. */
ProbeReading probe_best_form(const TableProbe *probe, const ProbeReading *reading, bool engines, bool scaled);

/* The nearest reading with another lobe of one parameter, or none, in the same form; where `forms`, in any
 * form that engines use. */
ProbeReading probe_best_lobe(const TableProbe *probe, const ProbeReading *reading, bool forms);

/* The nearest reading of all lobes of one parameter, or none, in a form (NULL: in all that there are),
 * decoded or not. */
ProbeReading probe_any(const TableProbe *probe, const WeftTableForm *form);

/* The reading with the factor that brings its values nearest to E, in least squares. */
ProbeReading probe_scaled(const TableProbe *probe, const ProbeReading *reading);

/* Returns true if E of the lobe is constant over views and parameters to 1e-3. */
bool probe_flat(const Lobe *lobe, int threads);

#endif
