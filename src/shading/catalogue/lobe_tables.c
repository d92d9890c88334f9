#include "shading/lobe/lobe_tables.h"

#include <pthread.h>

#include "shading/catalogue/albedo.h"
#include "shading/lobes/fibre_table.h"
#include "shading/tables/fibre_table.h"
#include "shading/tables/ltc_fibre.h"
#include "shading/tables/ltc_fibre_published.h"
#include "shading/tables/ltc_ggx.h"

TableRef lobe_table_refs[LOBE_TABLE_COUNT];

static AlbedoTable charlie_neubelt;

static TableRef make_charlie_neubelt(void) {
    Lobe lobe = {.id = LOBE_CHARLIE_NEUBELT};
    const WeftParamInfo *alpha = &weft_lobe_info(lobe.id)->params[0];
    albedo_table_fill(&charlie_neubelt, &lobe, alpha->hard_low, alpha->hard_high, 0);
    return albedo_table_ref(&charlie_neubelt);
}

/* Makes a table of a baked one: the channels of a texel become planes below each other, in `planes`. */
static TableRef make_planes(const float *texels, int channels, int rows, int columns, float low, float high,
                            float *planes) {
    for (int c = 0; c < channels; c++)
        for (int k = 0; k < rows * columns; k++) planes[c * rows * columns + k] = texels[k * channels + c];
    return (TableRef){planes, TABLE_PLANES, channels * rows, columns, low, high, 0, 0.0f};
}

#define PLANES(name) name##_channels, name##_height, name##_width
static TableRef make_ltc_fibre(void) {
    static float planes[sizeof table_ltc_fibre / sizeof(float)];
    const WeftParamInfo *alpha = &weft_lobe_info(LOBE_FIBRE)->params[0];
    return make_planes(table_ltc_fibre, PLANES(table_ltc_fibre), sqrt(alpha->low), sqrt(alpha->high), planes);
}

static TableRef make_ltc_fibre_published(void) {
    static float planes[sizeof table_ltc_fibre_published / sizeof(float)];
    return make_planes(table_ltc_fibre_published, PLANES(table_ltc_fibre_published), 0.0f, 1.0f, planes);
}

static TableRef make_ltc_ggx(void) {
    static float planes[sizeof table_ltc_ggx / sizeof(float)];
    const WeftParamInfo *alpha = &weft_lobe_info(LOBE_GGX)->params[0];
    return make_planes(table_ltc_ggx, PLANES(table_ltc_ggx), sqrt(alpha->low), sqrt(alpha->high), planes);
}

static TableRef make_fibre(void) {
    static float planes[sizeof table_fibre_table / sizeof(float)];
    const WeftParamInfo *alpha = &weft_lobe_info(LOBE_FIBRE_TABLE)->params[0];
    return make_planes(table_fibre_table, PLANES(table_fibre_table), log2(alpha->hard_low), log2(alpha->hard_high),
                       planes);
}

static void make_baked(void) {
    lobe_table_refs[LOBE_TABLE_ltc_fibre] = make_ltc_fibre();
    lobe_table_refs[LOBE_TABLE_fibre] = make_fibre();
    lobe_table_refs[LOBE_TABLE_ltc_ggx] = make_ltc_ggx();
    lobe_table_refs[LOBE_TABLE_ltc_fibre_published] = make_ltc_fibre_published();
}

static void make_computed(void) { lobe_table_refs[LOBE_TABLE_charlie_neubelt] = make_charlie_neubelt(); }

/* The lobe that reads the table which takes a while to make. */
static const int computed_for = LOBE_CHARLIE_NEUBELT_NORMALISED;

void lobe_tables_make_for(int id) {
    static pthread_once_t baked = PTHREAD_ONCE_INIT, computed = PTHREAD_ONCE_INIT;
    pthread_once(&baked, make_baked);
    if (id == computed_for) pthread_once(&computed, make_computed);
}

void lobe_tables_make(void) { lobe_tables_make_for(computed_for); }
