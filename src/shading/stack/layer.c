#include "shading/stack/layer.h"

#include "weft/lobe.h"

#define LAYER_TEXT(id, index, base, needs_wi, needs_average, conserves, by, help) [index] = {id, help},
static const char *const texts[LAYER_COUNT][2] = {WEFT_LAYERS(LAYER_TEXT)};

const char *weft_layer_name(int layer) { return layer >= 0 && layer < LAYER_COUNT ? texts[layer][0] : NULL; }
const char *weft_layer_help(int layer) { return layer >= 0 && layer < LAYER_COUNT ? texts[layer][1] : NULL; }
