/* layer.h - the rules by which a sheen sits on a base, and what the base loses */
#ifndef WEFT_SHADING_LAYER_H
#define WEFT_SHADING_LAYER_H

#include "shading/layers/additive.h"
#include "shading/layers/albedo_view.h"

/* L(id, functions' prefix, macros' prefix, help) */
#define WEFT_LAYERS(L)                                                                                       \
    L("additive", additive, ADDITIVE, "the base loses nothing; gains energy")                                \
    L("albedo-view", albedo_view, ALBEDO_VIEW, "the base keeps 1 - max3(color) E(wo)")

typedef enum LayerId {
#define LAYER_ENUM(id, name, NAME, help) LAYER_##NAME,
    WEFT_LAYERS(LAYER_ENUM)
#undef LAYER_ENUM
        LAYER_COUNT
} LayerId;

/* What of the base is left under a sheen of that colour, whose E towards wo is e_o. */
float layer_base(LayerId layer, Rgb color, float e_o);

#endif
