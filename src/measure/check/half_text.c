/* half_text.c - the shading texts compiled for half floats
 *
 * -Wpedantic, -Wdouble-promotion and others are off for this file (CMakeLists.txt): _Float16 is not in C11, integer
 * rows of parameter tables become halves, and that floors such as 1e-30 vanish is what the check is for. */
#include "measure/check/half_precision.h"

#include "weft/lobe.h"

#ifdef WEFT_HALF

#define lobe_table_refs half_table_refs
#include "half/shading/lobe/lobe_tables.h"
#include "half/shading/lobe/terms.h"
#include "shading/lobe_ids.gen.h"

#include "half/shading/lobes.gen.h"

#include "half/shading/dispatch.gen.h"

__typeof__(half_table_refs) half_table_refs;
enum { TABLES = sizeof half_table_refs / sizeof half_table_refs[0] };

bool half_here(void) { return true; }

void half_tables(const HalfTable *tables, int count) {
    for (int k = 0; k < count && k < TABLES; k++)
        half_table_refs[k] = (TableRef){.texels = tables[k].texels,
                                        .kind = tables[k].kind,
                                        .rows = tables[k].rows,
                                        .columns = tables[k].columns,
                                        .low = (Half)tables[k].low,
                                        .high = (Half)tables[k].high};
}

/* Evaluates a tinted lobe in a middle colour, since a white one would not use the tint. */
void half_eval(int lobe, const Single *params, size_t n, const Single *ox, const Single *oy, const Single *oz,
               const Single *ix, const Single *iy, const Single *iz, Single *f) {
    Lobe m = {.id = lobe};
    for (int k = 0; k < weft_lobe_info(lobe)->param_count; k++) m.params[k] = (Half)params[k];
    Half first = weft_lobe_info(lobe)->traits & WEFT_LOBE_TINTED ? 0.5f16 : 1.0f16;
    Half second = lobe_second(&m, first, 1.0f16);
    for (size_t k = 0; k < n; k++) {
        Dir o = {(Half)ox[k], (Half)oy[k], (Half)oz[k]}, i = {(Half)ix[k], (Half)iy[k], (Half)iz[k]};
        Angles a = angles_between(o, i);
        LobeValue v = lobe_value(&m, a);
        f[k] = (Single)(v.f * lobe_color(v, first, second));
    }
}

#else

bool half_here(void) { return false; }

void half_tables(const HalfTable *tables, int count) {}

void half_eval(int lobe, const float *params, size_t n, const float *ox, const float *oy, const float *oz,
               const float *ix, const float *iy, const float *iz, float *f) {
    for (size_t k = 0; k < n; k++) f[k] = 0.0f;
}

#endif
