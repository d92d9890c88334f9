/* half.c - the shading texts compiled for half floats. -Wpedantic, -Wdouble-promotion and the like are off
 * for this file (CMakeLists.txt): _Float16 is no C11, integer rows of parameter tables become halves, and
 * that floors such as 1e-30 vanish is what is looked for. */
#include "measure/half.h"

#include "weft/lobe.h"

#ifdef WEFT_HALF

#define lobe_table_refs half_table_refs
#include "half/lobes.gen.h"
#include "half/shading/lobe_tables.h"
#include "half/shading/registry.h"

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

#define FROM_ARRAY(type, name, def, low, high, hard_low, hard_high, help) m.name = (type)*p++;
#define HALF_RECORD(Record, NAME)                                                                            \
    Record m = {0};                                                                                          \
    NAME##_PARAMS(FROM_ARRAY)(void) p;
#define HALF_ONE(id, name, Record, NAME)                                                                     \
    static Half name##_half(const Single *p, Angles a) {                                                     \
        HALF_RECORD(Record, NAME)                                                                            \
        return name##_eval(m, a);                                                                            \
    }
#define HALF_TWO(id, name, Record, NAME)                                                                     \
    static Half name##_half(const Single *p, Angles a) {                                                     \
        HALF_RECORD(Record, NAME)                                                                            \
        return name##_eval(m, a) * half_mix(1.0f16, name##_second(m, 1.0f16, 1.0f16), name##_share(m, a));   \
    }
/* In a middle colour: white would not ask for the tint. */
#define HALF_TINTED(id, name, Record, NAME)                                                                  \
    static Half name##_half(const Single *p, Angles a) {                                                     \
        HALF_RECORD(Record, NAME)                                                                            \
        Record##Ready ready = name##_ready(m);                                                               \
        return name##_eval(ready, a) * tint_color(name##_tint(ready, a), 0.5f16);                            \
    }
WEFT_ONE_COLOR_LOBES(HALF_ONE)
WEFT_TWO_COLOR_LOBES(HALF_TWO)
WEFT_TINTED_LOBES(HALF_TINTED)

#define HALF_CALL(id, name, Record, NAME) [LOBE_##NAME] = name##_half,
static Half (*const evals[LOBE_COUNT])(const Single *, Angles) = {WEFT_TEXT_LOBES(HALF_CALL)};

void half_eval(int lobe, const Single *params, size_t n, const Single *ox, const Single *oy, const Single *oz,
               const Single *ix, const Single *iy, const Single *iz, Single *f) {
    for (size_t k = 0; k < n; k++) {
        Dir o = {(Half)ox[k], (Half)oy[k], (Half)oz[k]}, i = {(Half)ix[k], (Half)iy[k], (Half)iz[k]};
        f[k] = (Single)evals[lobe](params, angles_between(o, i));
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
