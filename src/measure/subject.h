/* subject.h - what a passport is made of: a lobe, or a whole material under a profile, behind one signature
 *
 * A subject is white, unless it is tinted and `albedo` says otherwise. It has settings: the rows of the
 * passport, then extremes for the sweep. The calls are pointers so that a test can put a wrong one in. */
#ifndef WEFT_MEASURE_SUBJECT_H
#define WEFT_MEASURE_SUBJECT_H

#include "shading/material_stack.h"
#include "weft/measure.h"

typedef struct Subject Subject;

/* A subject at one setting, seen from one direction. */
typedef struct View {
    const Subject *subject;
    Dir o;
    Lobe lobe; /* of a lobe */
    float second;
    SeenStack whole; /* of a material */
} View;

/* Many directions: structures of arrays. */
typedef struct Dirs {
    size_t n;
    const float *x, *y, *z;
} Dirs;

enum { SUBJECT_EXTREMES = 64 };

struct Subject {
    int rows, row_default;
    float values[WEFT_PASSPORT_ROWS]; /* of the parameter */
    const char *parameter;            /* its name, "" without one */
    int settings;                     /* rows and extremes */

    Lobe lobe;
    float albedo; /* what a tinted lobe is made of; 1: it is white */
    bool whole;   /* a material: */
    Surface surfaces[WEFT_PASSPORT_ROWS + SUBJECT_EXTREMES];
    Choices choices;
    AlbedoTable *tables; /* of E, released by subject_free; that of a setting: */
    int table_of[WEFT_PASSPORT_ROWS + SUBJECT_EXTREMES];

    void (*look)(const Subject *subject, int setting, Dir o, View *view); /* o.z > 0 */
    void (*f)(const View *view, Dirs i, float *f);                        /* 0 below the horizon */
    void (*pdf)(const View *view, Dirs i, float *pdf);
    Dir (*sample)(const View *view, float u, float v);
};

/* The lobe as it is given: rows run over its parameter 0. */
void subject_of_lobe(Subject *subject, const Lobe *lobe, bool quick);

/* The white velvet of a profile (subject_velvet says it in words). False when memory is short. */
bool subject_of_profile(Subject *subject, int profile, bool quick, int threads);
extern const char subject_velvet[];

void subject_free(Subject *subject);

/* The lobe of a setting. */
Lobe subject_lobe(const Subject *subject, int setting);

#endif
