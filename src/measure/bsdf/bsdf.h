/* bsdf.h - the model under test of a passport: a lobe, or a whole material under a profile, behind one interface
 *
 * A BSDF is white, unless it is tinted and `albedo` is less than 1. It has settings: the rows of the passport, then
 * extremes for the sweep. The calls are pointers so that a test can replace them by wrong ones. */
#pragma once

#include "measure/bsdf/weave_sum.h"
#include "weft/measure.h"

typedef struct Bsdf Bsdf;

/* A BSDF at one setting, seen from one direction. */
typedef struct BsdfView {
    const Bsdf *bsdf;
    Dir o;
    Lobe lobe; /* of a lobe */
    float second;
    SeenStack whole[2]; /* of a material, with each of its bases */
} BsdfView;

/* Many directions: structures of arrays. */
typedef struct Dirs {
    size_t n;
    const float *x, *y, *z;
} Dirs;

enum { BSDF_EXTREMES = 64 };

struct Bsdf {
    int rows, row_default;
    float values[WEFT_PASSPORT_ROWS]; /* of the parameter, by row */
    const char *parameter;            /* name of the parameter, "" without one */
    int settings;                     /* rows and extremes */

    Lobe lobe;
    float albedo; /* albedo of a tinted lobe; 1: it is white */
    bool whole;   /* a material */
    WeaveSum sum; /* the base, or two */
    float first;  /* the fraction of the samples that the first of two bases draws */
    Surface surfaces[WEFT_PASSPORT_ROWS + BSDF_EXTREMES];
    Choices choices;
    AlbedoTable *tables; /* of E, released by bsdf_free; table_of: index of the table of a setting */
    int table_of[WEFT_PASSPORT_ROWS + BSDF_EXTREMES];

    void (*prepare)(const Bsdf *bsdf, int setting, Dir o, BsdfView *view); /* o.z > 0 */
    void (*f)(const BsdfView *view, Dirs i, float *f);                     /* 0 below the horizon */
    void (*pdf)(const BsdfView *view, Dirs i, float *pdf);
    Dir (*sample)(const BsdfView *view, float u, float v);
};

/* Makes a BSDF of a lobe: rows run over its parameter 0. */
void bsdf_of_lobe(Bsdf *bsdf, const Lobe *lobe, bool quick);

/* Makes the BSDF of the white velvet of a profile, which the text bsdf_velvet describes. Returns false if
 * memory is short. */
bool bsdf_of_profile(Bsdf *bsdf, int profile, bool quick, int threads);
extern const char bsdf_velvet[];

/* Makes the BSDF of a woven material from afar, in its own colours. Returns false if memory is short. */
bool bsdf_of_weave(Bsdf *bsdf, const WeftMaterial *material, const WeftCloth *cloth, int threads);

void bsdf_free(Bsdf *bsdf);

/* Returns the lobe of a setting. */
Lobe bsdf_lobe(const Bsdf *bsdf, int setting);
