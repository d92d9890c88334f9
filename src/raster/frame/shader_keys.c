#include <string.h>

#include "raster/frame/picture_block.h"
#include "raster/frame/shader_keys.h"
#include "raster/material/part.h"
#include "scene/light/environment.h"

bool is_coarse(const WeftRasterView *view) { return view->shading_rate > 1 && !part_is_property((int)view->part); }

bool is_still(const ShaderKey *key) {
    return !key->depth && !key->coarse && !key->resolve && !key->floor && !key->reference;
}

/* Returns a key without any input but those of coverage. */
static ShaderKey coverage_key(const ShaderKey *key) {
    ShaderKey depth;
    memset(&depth, 0, sizeof depth);
    depth.alpha_mode = key->alpha_mode;
    for (int k = 0; k < INPUT_COUNT; k++) depth.inputs[k].like = -1;
    for (int k = 0; k < INPUT_COUNT; k++) depth.inputs[k].state = INPUT_ZERO;
    if (key->alpha_mode == WEFT_ALPHA_OPAQUE) return depth;
    depth.colored = key->colored;
    depth.woven = key->woven;
    depth.inputs[INPUT_opacity] = key->inputs[INPUT_opacity];
    depth.inputs[INPUT_opacity].like = -1;
    return depth;
}

ShaderKey depth_key(const ShaderKey *key) {
    ShaderKey depth = coverage_key(key);
    depth.depth = 1;
    return depth;
}

/* Returns the key of a material's pixels in a moving picture. */
static ShaderKey resolve_key(const ShaderKey *key) {
    ShaderKey resolve = coverage_key(key);
    resolve.resolve = 1;
    resolve.hairy = key->hairy;
    return resolve;
}

/* Sets the members of a key that describe lights and their shadow maps. */
static void add_lights(const WeftRaster *self, const WeftRasterView *view, ShaderKey *key) {
    const WeftScene *scene = self->scene;
    key->shadowed = !view->no_shadows && self->shadows.count;
    key->lights = scene->light_count < PICTURE_LIGHTS ? scene->light_count : PICTURE_LIGHTS;
    for (int k = 0; k < key->lights && key->lights <= SHADER_LIGHTS; k++) {
        key->light_kind[k] = (int16_t)scene->lights[k].kind;
        key->light_map[k] = -1;
        for (int j = 0; j < self->shadows.count && key->shadowed; j++)
            if (self->shadows.of_light[j] == k) key->light_map[k] = (int16_t)j;
    }
    bool ambient = self->environment_lit && view->ambient != WEFT_AMBIENT_NONE;
    key->ambient = ambient ? (int)view->ambient + 1 : 0;
    key->polygons = view->polygons < self->polygons.count ? view->polygons : self->polygons.count;
    for (int k = 0; k < key->polygons; k++) {
        key->polygon_corners[k] = (int16_t)self->polygons.items[k].count;
        key->polygon_two_sided[k] = self->polygons.items[k].two_sided;
        key->polygon_map[k] = -1;
        for (int j = 0; j < self->shadows.count && key->shadowed; j++)
            if (self->shadows.of_polygon[j] == k) key->polygon_map[k] = (int16_t)j;
    }
}

ShaderKey floor_key(const WeftRaster *self, const WeftRasterView *view) {
    ShaderKey key;
    memset(&key, 0, sizeof key);
    add_lights(self, view, &key);
    key.floor = 1;
    key.ambient = 0;
    return key;
}

ShaderKey lit_key(const WeftRaster *self, const WeftRasterView *view, const GlMaterial *material) {
    if (self->coarse.resolving) return resolve_key(&material->key);
    ShaderKey key = material->key;
    key.part = (int)view->part;
    if (part_is_property(key.part)) return key;
    if (self->summing) {
        key.reference = environment_in_parts(&self->scene->environment) ? 2 : 1;
        key.bounces = view->bounces;
        key.panes = self->materials.panes;
        return key;
    }
    add_lights(self, view, &key);
    key.coarse = is_coarse(view);
    if (key.coarse && key.ambient == WEFT_AMBIENT_BEST + 1)
        key.ambient = WEFT_AMBIENT_FITTED + 1; /* samples take long */
    if (key.ambient) material_in_light(material, self->environment.parts.env_light_kappa, &key);
    return key;
}

bool all_keys(WeftRaster *self, const WeftRasterView *view, bool with_floor,
              bool (*test)(Programs *programs, const ShaderKey *key)) {
    bool all = true, shadows = self->shadows.count && !self->shadows.drawn && !view->no_shadows && !self->summing;
    for (int k = 0; k < self->materials.count && all; k++) {
        if (!self->materials.all[k].used) continue;
        const GlMaterial *material = &self->materials.all[k];
        ShaderKey key = lit_key(self, view, material), depth = depth_key(&material->key);
        all = test(&self->programs, &key);
        if (shadows) all = all && test(&self->programs, &depth);
        const ShaderKey resolve = resolve_key(&material->key);
        if (is_coarse(view) && !self->summing) all = all && test(&self->programs, &resolve);
    }
    const ShaderKey floor = floor_key(self, view);
    return all && (!with_floor || test(&self->programs, &floor));
}
