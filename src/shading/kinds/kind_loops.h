/* kind_loops.h - the loops of a kind: views, f and pdf of wi, samples */
#ifndef WEFT_SHADING_KIND_LOOPS_H
#define WEFT_SHADING_KIND_LOOPS_H

#include "shading/lobe/table.h"

struct KindVertices;
typedef struct KindLoops {
    void (*see)(struct KindVertices *v, TableRef e, int n);
    void (*eval)(struct KindVertices *v, TableRef e, int direction, int n);
    void (*sample)(struct KindVertices *v, TableRef e, int n);
} KindLoops;

#endif
