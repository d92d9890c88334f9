#include "gltf/read/coordinates.h"

#include <stdio.h>

#include "gltf/read/mesh.h"

void coordinates_begin(Asset *asset, size_t material) {
    asset->sets = asset->material_sets[material];
    asset->sets[0] = asset->sets[1] = -1;
}

int coordinates_choose(Asset *asset, int n) {
    const int first = n < 2 ? n : 1;
    for (int k = 0; k < 2; k++)
        if (asset->sets[k] == n) return k;
    for (int k = 0; k < 2; k++) {
        const int slot = k ? 1 - first : first;
        if (asset->sets[slot] >= 0) continue;
        asset->sets[slot] = n;
        return slot;
    }
    return -1;
}

/* Gives a primitive the sets of one of its materials, where it has none yet. Returns false if it has others. */
static bool sets_take(const Asset *asset, int material, Primitive *p) {
    bool agree = true;
    for (int k = 0; k < 2; k++) {
        const int set = asset->material_sets[material][k];
        if (set < 0) continue;
        if (p->set[k] < 0) p->set[k] = set;
        agree = agree && p->set[k] == set;
    }
    return agree;
}

void coordinates_read(const Field *attributes, size_t count, Primitive *p) {
    const Asset *asset = attributes->asset;
    bool agree = true;
    p->set[0] = p->set[1] = -1;
    sets_take(asset, p->material, p);
    for (int v = 0; v < asset->scene->variant_count && p->variant_material; v++)
        if (p->variant_material[v] >= 0) agree = sets_take(asset, p->variant_material[v], p) && agree;
    for (int k = 0; k < 2; k++) {
        char name[24];
        if (p->set[k] < 0) p->set[k] = k;
        snprintf(name, sizeof name, "TEXCOORD_%d", p->set[k]);
        p->texcoord[k] = attribute_read(attributes, name, 2, 2, count);
        snprintf(name, sizeof name, "TEXCOORD_%d", k);
        if (p->set[k] != k) attribute_read(attributes, name, 2, 2, count); /* is checked, though nothing shows it */
    }
    if (!agree)
        field_warn(attributes, WEFT_MESSAGE_GLTF_WARN_IGNORED,
                   "materials of its variants need more sets of coordinates than two; TEXCOORD_%d and TEXCOORD_%d are "
                   "read",
                   p->set[0], p->set[1]);
}
