#include "shading/layer.h"

#include "weft/lobe.h"

#define LAYER_TEXT(id, name, NAME, help) {id, help},
static const char *const texts[LAYER_COUNT][2] = {WEFT_LAYERS(LAYER_TEXT)};

const char *weft_layer_id(int layer) { return layer >= 0 && layer < LAYER_COUNT ? texts[layer][0] : NULL; }
const char *weft_layer_help(int layer) { return layer >= 0 && layer < LAYER_COUNT ? texts[layer][1] : NULL; }

float layer_base(LayerId layer, Rgb color, float e_o) {
    switch (layer) {
#define LAYER_BASE(id, name, NAME, help)                                                                     \
    case LAYER_##NAME: return name##_base(color, e_o);
        WEFT_LAYERS(LAYER_BASE)
    case LAYER_COUNT: break;
    }
    return 1.0f;
}
