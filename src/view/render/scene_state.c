#define _POSIX_C_SOURCE 200809L
#include "view/render/scene_state.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct StateMaterial {
    atomic_int users;
    WeftMaterial is;
    int preset;
};

struct BrushedNap {
    atomic_int users;
    int material;
    WeftImage image;
};

static void material_drop(StateMaterial *m) {
    if (m && atomic_fetch_sub(&m->users, 1) == 1) free(m);
}

void nap_free(BrushedNap *nap) {
    if (!nap || atomic_fetch_sub(&nap->users, 1) != 1) return;
    weft_image_free(&nap->image);
    free(nap);
}

static StateMaterial *material_make(const WeftMaterial *is, int preset) {
    StateMaterial *m = calloc(1, sizeof *m);
    if (!m) return NULL;
    atomic_init(&m->users, 1);
    m->is = *is;
    m->preset = preset;
    return m;
}

void folders_keep(Folders *self, const char *path, int material) {
    int k = 0;
    while (k < self->count && self->materials[k] != material) k++;
    if (k == STATE_FOLDERS) return;
    snprintf(self->paths[k], STATE_PATH, "%s", path);
    self->materials[k] = material;
    if (k == self->count) self->count++;
}

static bool read_lights(SceneState *state, const WeftScene *scene) {
    int count = weft_scene_info(scene).light_count;
    state->light_count = count < STATE_LIGHTS ? count : STATE_LIGHTS;
    for (int k = 0; k < state->light_count; k++)
        if (weft_scene_light(scene, k, &state->lights[k], NULL) != WEFT_OK) return false;
    return true;
}

EnvironmentState environment_state_studio(void) {
    return (EnvironmentState){.strength = 1.0f, .ambient = 1.0f, .reflection = 1.0f};
}

bool scene_state_read(SceneState *state, const WeftScene *scene) {
    int count = weft_scene_info(scene).material_count;
    *state = (SceneState){.environment = environment_state_studio(), .variant = weft_scene_variant(scene)};
    state->materials = calloc((size_t)count + 1, sizeof(void *));
    bool whole = state->materials != NULL;
    for (int k = 0; k < count && whole; k++) {
        WeftMaterial is;
        whole = weft_scene_material(scene, k, &is, NULL) == WEFT_OK &&
                (state->materials[k] = material_make(&is, 0)) != NULL;
        state->material_count += whole;
    }
    if (whole) whole = read_lights(state, scene);
    if (!whole) scene_state_free(state);
    return whole;
}

bool scene_state_copy(SceneState *copy, const SceneState *state) {
    StateMaterial **materials = calloc((size_t)state->material_count + 1, sizeof(void *));
    if (!materials) return false;
    for (int k = 0; k < state->material_count; k++) {
        materials[k] = state->materials[k];
        atomic_fetch_add(&materials[k]->users, 1);
    }
    for (int k = 0; k < STATE_NAPS; k++)
        if (state->naps[k]) atomic_fetch_add(&state->naps[k]->users, 1);
    *copy = *state;
    copy->materials = materials;
    return true;
}

void scene_state_free(SceneState *state) {
    for (int k = 0; k < state->material_count && state->materials; k++) material_drop(state->materials[k]);
    for (int k = 0; k < STATE_NAPS; k++) nap_free(state->naps[k]);
    free(state->materials);
    *state = (SceneState){0};
}

/* Compares bytes. The records have no padding and contain no NaN. */
static bool same_bytes(const void *a, const void *b, size_t size) { return memcmp(a, b, size) == 0; }

bool scene_state_same_material(const SceneState *a, const SceneState *b, int k) {
    return a->materials[k] == b->materials[k] ||
           same_bytes(&a->materials[k]->is, &b->materials[k]->is, sizeof a->materials[k]->is);
}

static bool same_lights(const SceneState *a, const SceneState *b) {
    return a->light_count == b->light_count &&
           same_bytes(a->lights, b->lights, (size_t)a->light_count * sizeof *a->lights);
}

bool environment_state_same_source(const EnvironmentState *a, const EnvironmentState *b) {
    return a->kind == b->kind && strcmp(a->path, b->path) == 0 && a->version == b->version &&
           same_bytes(a->color, b->color, sizeof a->color);
}

void environment_state_take_source(EnvironmentState *environment, const EnvironmentState *from) {
    environment->kind = from->kind;
    environment->version = from->version;
    memcpy(environment->path, from->path, sizeof environment->path);
    memcpy(environment->color, from->color, sizeof environment->color);
}

static bool same_environment(const EnvironmentState *a, const EnvironmentState *b) {
    const float of_a[] = {a->rotation, a->strength, a->ambient, a->reflection},
                of_b[] = {b->rotation, b->strength, b->ambient, b->reflection};
    return environment_state_same_source(a, b) && same_bytes(of_a, of_b, sizeof of_a);
}

bool scene_state_same(const SceneState *a, const SceneState *b) {
    bool same = a->material_count == b->material_count && a->variant == b->variant && same_lights(a, b) &&
                same_environment(&a->environment, &b->environment) && memcmp(a->naps, b->naps, sizeof a->naps) == 0;
    for (int k = 0; same && k < a->material_count; k++) same = scene_state_same_material(a, b, k);
    return same;
}

const WeftMaterial *scene_state_material(const SceneState *state, int k) { return &state->materials[k]->is; }

static bool put_material(SceneState *state, int k, const WeftMaterial *material, int preset) {
    StateMaterial *made = material_make(material, preset);
    if (!made) return false;
    material_drop(state->materials[k]);
    state->materials[k] = made;
    return true;
}

bool scene_state_set_material(SceneState *state, int k, const WeftMaterial *material) {
    const StateMaterial *was = state->materials[k];
    return same_bytes(&was->is, material, sizeof *material) || put_material(state, k, material, was->preset);
}

WeftMaterial material_merged(const WeftMaterial *was, const WeftMaterial *now, const WeftMaterial *made) {
    WeftMaterial merged = *made;
    for (int k = 0; k < WEFT_CHOICES_MAX; k++)
        if (now->choices[k] != was->choices[k]) merged.choices[k] = now->choices[k];
    for (int k = 0; k < WEFT_INPUTS_MAX; k++)
        if (!same_bytes(&now->inputs[k], &was->inputs[k], sizeof now->inputs[k])) merged.inputs[k] = now->inputs[k];
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (!same_bytes(&now->hair[k], &was->hair[k], sizeof now->hair[k])) merged.hair[k] = now->hair[k];
    return merged;
}

int scene_state_preset(const SceneState *state, int k) { return state->materials[k]->preset; }

bool scene_state_set_preset(SceneState *state, int k, int preset) {
    const WeftMaterial is = state->materials[k]->is;
    return scene_state_preset(state, k) == preset || put_material(state, k, &is, preset);
}

bool scene_state_take_presets(SceneState *state, const SceneState *from) {
    bool all = true;
    for (int k = 0; k < state->material_count && k < from->material_count && all; k++)
        all = scene_state_set_preset(state, k, scene_state_preset(from, k));
    return all;
}

static BrushedNap *find_nap(const SceneState *state, int material) {
    for (int k = 0; k < STATE_NAPS; k++)
        if (state->naps[k] && state->naps[k]->material == material) return state->naps[k];
    return NULL;
}

const WeftImage *scene_state_nap(const SceneState *state, int material) {
    const BrushedNap *nap = find_nap(state, material);
    return nap ? &nap->image : NULL;
}

/* Returns the nearest texel, 0 to 1, of a map that repeats. */
static float texel_of(const WeftImage *image, float u, float v, int channel) {
    int x = (int)((u - floorf(u)) * (float)image->width), y = (int)((v - floorf(v)) * (float)image->height);
    x = x < image->width ? x : image->width - 1;
    y = y < image->height ? y : image->height - 1;
    int c = channel < image->channels ? channel : 0;
    size_t k = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels + (size_t)c;
    return image->type == WEFT_PIXEL_U8    ? (float)((const unsigned char *)image->pixels)[k] / 255.0f
           : image->type == WEFT_PIXEL_U16 ? (float)((const uint16_t *)image->pixels)[k] / 65535.0f
                                           : ((const float *)image->pixels)[k];
}

/* Returns the map of an input; without pixels if it has none that can be brushed. */
static WeftImage map_of(const WeftScene *scene, const WeftInput *input) {
    return input->texture && input->texcoord == 0 ? weft_scene_texture(scene, input->texture) : (WeftImage){0};
}

static unsigned char coded(float x) { return (unsigned char)(fminf(fmaxf(x, 0.0f), 1.0f) * 255.0f + 0.5f); }

bool nap_own(const WeftScene *scene, const WeftMaterial *material, WeftImage *out) {
    const WeftInput *way = &material->inputs[weft_material_input_find("nap_direction")],
                    *lean = &material->inputs[weft_material_input_find("nap")];
    const WeftImage ways = map_of(scene, way), leans = map_of(scene, lean);
    if (weft_image_create(NAP_SIDE, NAP_SIDE, 3, WEFT_PIXEL_U8, out, NULL) != WEFT_OK) return false;
    unsigned char *p = out->pixels;
    float c = cosf(way->value[0]), s = sinf(way->value[0]);
    for (int k = 0; k < NAP_SIDE * NAP_SIDE; k++, p += 3) {
        int column = k % NAP_SIDE, row = k / NAP_SIDE;
        float u = ((float)column + 0.5f) / NAP_SIDE, v = ((float)row + 0.5f) / NAP_SIDE;
        const float *m = way->transform, *n = lean->transform;
        float x = 1.0f, y = 0.0f, much = lean->value[0] > 0.0f ? 1.0f : 0.0f;
        if (ways.pixels) {
            float at = m[0] * u + m[1] * v + m[2], down = m[3] * u + m[4] * v + m[5];
            x = 2.0f * texel_of(&ways, at, down, 0) - 1.0f;
            y = 2.0f * texel_of(&ways, at, down, 1) - 1.0f;
        }
        if (leans.pixels)
            much *= texel_of(&leans, n[0] * u + n[1] * v + n[2], n[3] * u + n[4] * v + n[5], lean->channel);
        p[0] = coded(0.5f + 0.5f * (c * x - s * y));
        p[1] = coded(0.5f + 0.5f * (s * x + c * y));
        p[2] = coded(much);
    }
    return true;
}

BrushedNap *nap_copy(const SceneState *state, int material, const WeftImage *own, WeftImage **image) {
    const BrushedNap *old = find_nap(state, material);
    const WeftImage *from = old ? &old->image : own;
    BrushedNap *nap = from ? calloc(1, sizeof *nap) : NULL;
    if (!nap || weft_image_create(NAP_SIDE, NAP_SIDE, 3, WEFT_PIXEL_U8, &nap->image, NULL) != WEFT_OK) {
        free(nap);
        return NULL;
    }
    atomic_init(&nap->users, 1);
    nap->material = material;
    memcpy(nap->image.pixels, from->pixels, (size_t)3 * NAP_SIDE * NAP_SIDE);
    *image = &nap->image;
    return nap;
}

bool scene_state_set_nap(SceneState *state, BrushedNap *nap) {
    for (int pass = 0; pass < 2; pass++) /* its own slot, else a free one */
        for (int k = 0; k < STATE_NAPS; k++) {
            bool its = state->naps[k] && state->naps[k]->material == nap->material;
            if (!(its || (pass && !state->naps[k]))) continue;
            nap_free(state->naps[k]);
            state->naps[k] = nap;
            return true;
        }
    nap_free(nap);
    return false;
}

void scene_state_take_naps(SceneState *state, const SceneState *from) {
    for (int k = 0; k < STATE_NAPS; k++) {
        bool its = from->naps[k] && from->naps[k]->material < state->material_count;
        nap_free(state->naps[k]);
        state->naps[k] = its ? from->naps[k] : NULL;
        if (its) atomic_fetch_add(&state->naps[k]->users, 1);
    }
}

static int texture_of(const BoundNaps *naps, int material) {
    for (int k = 0; k < naps->count; k++)
        if (naps->materials[k] == material) return naps->textures[k];
    return 0;
}

static WeftResult bind_nap(const BrushedNap *nap, BoundNaps *naps, WeftScene *scene, WeftError *error) {
    WeftImage copy;
    WeftResult result = weft_image_create(NAP_SIDE, NAP_SIDE, 3, WEFT_PIXEL_U8, &copy, error);
    if (result != WEFT_OK) return result;
    memcpy(copy.pixels, nap->image.pixels, (size_t)3 * NAP_SIDE * NAP_SIDE);
    int texture = texture_of(naps, nap->material);
    if (texture) {
        result = weft_scene_put_texture(scene, texture, &copy, error);
    } else if (naps->count < STATE_NAPS) {
        texture = weft_scene_add_texture(scene, &copy, error);
        if (texture) {
            naps->materials[naps->count] = nap->material;
            naps->textures[naps->count++] = texture;
        } else {
            result = WEFT_RESOURCES;
        }
    }
    weft_image_free(&copy);
    return result;
}

static WeftResult apply_materials(const SceneState *state, const SceneState *is, BoundNaps *naps, WeftScene *scene,
                                  unsigned *changed, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < STATE_NAPS && result == WEFT_OK; k++)
        if (state->naps[k] && state->naps[k] != find_nap(is, state->naps[k]->material)) {
            result = bind_nap(state->naps[k], naps, scene, error);
            *changed |= WEFT_CHANGED_MATERIALS;
        }
    for (int k = 0; k < state->material_count && result == WEFT_OK; k++) {
        const BrushedNap *nap = find_nap(state, k), *was = find_nap(is, k);
        if (scene_state_same_material(state, is, k) && !nap == !was) continue;
        WeftMaterial m = state->materials[k]->is;
        if (nap) {
            WeftInput *direction = &m.inputs[weft_material_input_find("nap_direction")],
                      *angle = &m.inputs[weft_material_input_find("nap")];
            static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
            direction->texture = angle->texture = texture_of(naps, k);
            direction->texcoord = angle->texcoord = 0;
            memcpy(direction->transform, identity, sizeof identity);
            memcpy(angle->transform, identity, sizeof identity);
            direction->value[0] = 0.0f;
            angle->channel = 2;
        }
        result = weft_scene_put_material(scene, k, &m, error);
        *changed |= WEFT_CHANGED_MATERIALS | WEFT_CHANGED_LIGHTS;
    }
    return result;
}

static WeftResult apply_lights(const SceneState *state, const SceneState *is, WeftScene *scene, unsigned *changed,
                               WeftError *error) {
    WeftResult result = WEFT_OK;
    if (same_lights(state, is)) return WEFT_OK;
    *changed |= WEFT_CHANGED_LIGHTS;
    for (int k = 0; k < state->light_count || k < is->light_count; k++) {
        bool shape = (k < state->light_count && state->lights[k].kind == WEFT_LIGHT_POLYGON) ||
                     (k < is->light_count && is->lights[k].kind == WEFT_LIGHT_POLYGON);
        if (shape) *changed |= WEFT_CHANGED_SHAPES | WEFT_CHANGED_MATERIALS;
    }
    for (int k = is->light_count; k > state->light_count && result == WEFT_OK; k--)
        result = weft_scene_remove_light(scene, k - 1, error);
    for (int k = 0; k < state->light_count && result == WEFT_OK; k++)
        if (k >= is->light_count)
            result = weft_scene_add_light(scene, &state->lights[k], error);
        else if (!same_bytes(&state->lights[k], &is->lights[k], sizeof *state->lights))
            result = weft_scene_put_light(scene, k, &state->lights[k], error);
    return result;
}

WeftResult environment_state_apply(const EnvironmentState *a, const EnvironmentState *is, WeftScene *scene,
                                   unsigned *changed, const WeftLog *log, WeftError *error) {
    WeftResult result = WEFT_OK;
    if (same_environment(a, is)) return WEFT_OK;
    if (!environment_state_same_source(a, is)) {
        if (a->kind == ENVIRONMENT_FILE)
            result = weft_scene_set_environment_file(scene, a->path, log, error);
        else if (a->kind == ENVIRONMENT_COLOR)
            result = weft_scene_set_environment_color(scene, a->color, error);
        else
            result = weft_scene_set_environment_studio(scene, error);
    }
    if (result != WEFT_OK) return result;
    *changed |= WEFT_CHANGED_LIGHTS;
    result = weft_scene_set_environment_placement(scene, a->rotation, a->strength, error);
    return result == WEFT_OK ? weft_scene_set_environment_parts(scene, a->ambient, a->reflection, error) : result;
}

static WeftResult apply_variant(const SceneState *state, const SceneState *is, WeftScene *scene, unsigned *changed,
                                WeftError *error) {
    if (state->variant == is->variant) return WEFT_OK;
    *changed |= ~0u;
    return weft_scene_set_variant(scene, weft_scene_variant_name(scene, state->variant), error);
}

WeftResult scene_state_apply(const SceneState *state, const SceneState *is, BoundNaps *naps, WeftScene *scene,
                             unsigned *changed, WeftError *error) {
    WeftResult result = apply_variant(state, is, scene, changed, error);
    if (result == WEFT_OK) result = apply_materials(state, is, naps, scene, changed, error);
    return result == WEFT_OK ? apply_lights(state, is, scene, changed, error) : result;
}
