/* kind_loops.h - the loops of a kind: views, f and pdf of wi, samples */
#pragma once

#include "shading/lobe/table.h"

struct KindVertices;
typedef struct KindLoops {
    void (*see)(struct KindVertices *v, TableRef e, int n);
    void (*eval)(struct KindVertices *v, TableRef e, int direction, int n);
    void (*sample)(struct KindVertices *v, TableRef e, int n);
} KindLoops;
