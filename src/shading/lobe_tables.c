#include "shading/lobe_tables.h"

#include <pthread.h>

#include "shading/albedo.h"

TableRef lobe_table_refs[1];

static AlbedoTable charlie_neubelt;

static void make(void) {
    Lobe lobe = {.id = LOBE_CHARLIE_NEUBELT};
    const WeftParamInfo *alpha = &weft_lobe_info(lobe.id)->params[0];
    albedo_table_fill(&charlie_neubelt, &lobe, alpha->hard_low, alpha->hard_high, 0);
    lobe_table_refs[0] = albedo_table_ref(&charlie_neubelt);
}

void lobe_tables_make(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make);
}
