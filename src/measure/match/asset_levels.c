/* asset_levels.c - mip levels of fine normal maps, whose roughness widens with what they do not resolve */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "gltf/read/gltf.h"
#include "gltf/save/rewrite.h"
#include "image/halve.h"
#include "image/pixel.h"
#include "measure/match/match_factor.h"
#include "measure/match/match_place.h"
#include "measure/match/viewer_reads.h"
#include "scene/record/scene.h"
#include "shading/dialect/texel.h"
#include "weft/deliver.h"

enum { LEVELS_MOST = 17, MAPS = 2, BLOCK = 4 };
static const float SLOPE_MOST = 8.0f; /* of a normal that lies almost in the surface */

/* Four numbers a texel: a normal and alpha^2; slopes, and the sum of their squares; occlusion and metallic. */
typedef enum LevelPlane { PLANE_NORMAL, PLANE_SLOPES, PLANE_REST, PLANES } LevelPlane;

/* The maps of a material while they are made. */
typedef struct FineMaps {
    const WeftScene *scene;
    const Material *material;
    int width, height;
    float scale;                          /* of slopes */
    float *planes[PLANES], *next[PLANES]; /* of a level, and of the one after it */
    WeftImage images[MAPS][LEVELS_MOST];  /* normals; occlusion, roughness and metallic */
    int count;
} FineMaps;

/* Reads the texels of level 0. */
static void texels_read(FineMaps *maps) {
    const Input *rough = &maps->material->inputs[INPUT_roughness];
    for (int k = 0; k < maps->width * maps->height; k++) {
        const int column = k % maps->width, row = k / maps->width;
        const float u = ((float)column + 0.5f) / (float)maps->width, v = ((float)row + 0.5f) / (float)maps->height;
        const Texel t = place_texel(maps->scene, maps->material, INPUT_normal, u, v),
                    r = place_texel(maps->scene, maps->material, INPUT_roughness, u, v);
        const Dir n = texel_normal(t.c[0], t.c[1], t.c[2], 1.0f);
        const float least = 1.0f / SLOPE_MOST, z = n.z > least ? n.z : least;
        const float roughness = r.c[1] * rough->value[0], alpha = roughness * roughness;
        const float x = n.x / z, y = n.y / z;
        const float texel[PLANES][4] = {
            {n.x, n.y, n.z, alpha * alpha}, {x, y, x * x + y * y, 0.0f}, {r.c[0], r.c[2], 0.0f, 0.0f}};
        for (int p = 0; p < PLANES; p++) memcpy(maps->planes[p] + 4 * k, texel[p], sizeof texel[p]);
    }
}

/* Returns how much slopes deviate, with the scale of the map. */
static double deviation(const FineMaps *maps) {
    const int count = maps->width * maps->height;
    double sum[3] = {0.0};
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++) sum[c] += (double)maps->planes[PLANE_SLOPES][4 * k + c] / count;
    return (double)maps->scale * (sqrt)(fmax(sum[2] - sum[0] * sum[0] - sum[1] * sum[1], 0.0));
}

/* Writes the texels of a level into its two pictures. */
static void level_write(FineMaps *maps, int level, int texels) {
    unsigned char *normals = maps->images[0][level].pixels, *rest = maps->images[1][level].pixels;
    for (int k = 0; k < texels; k++, normals += 3, rest += 3) {
        const float *n = maps->planes[PLANE_NORMAL] + 4 * k, *s = maps->planes[PLANE_SLOPES] + 4 * k;
        const float length = fmaxf(sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1e-6f);
        const float away = level ? fmaxf(s[2] - s[0] * s[0] - s[1] * s[1], 0.0f) : 0.0f;
        const float square = n[3] + maps->scale * maps->scale * away;
        for (int c = 0; c < 3; c++) normals[c] = pixel_byte(0.5f + 0.5f * n[c] / length);
        rest[0] = pixel_byte(maps->planes[PLANE_REST][4 * k]);
        rest[1] = pixel_byte(sqrtf(sqrtf(square)));
        rest[2] = pixel_byte(maps->planes[PLANE_REST][4 * k + 1]);
    }
}

/* Makes all levels of level 0. */
static WeftResult levels_make(FineMaps *maps, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int w = maps->width, h = maps->height; maps->count < LEVELS_MOST && result == WEFT_OK;
         w = halved(w), h = halved(h)) {
        for (int m = 0; m < MAPS && result == WEFT_OK; m++)
            result = weft_image_create(w, h, 3, WEFT_PIXEL_U8, &maps->images[m][maps->count], error);
        if (result == WEFT_OK) level_write(maps, maps->count++, w * h);
        if (w == 1 && h == 1) break;
        for (int p = 0; p < PLANES; p++) {
            float *now = maps->planes[p];
            halve_f32(now, w, h, maps->next[p]);
            maps->planes[p] = maps->next[p], maps->next[p] = now;
        }
    }
    return result;
}

static int index_of(const json_t *info) { return info ? (int)json_integer_value(json_object_get(info, "index")) : -1; }

/* Lets a material name the new maps: where it had no map of roughness it gets one in the place of the normal map. */
static void maps_name(json_t *material, const int textures[MAPS]) {
    json_t *normal = json_object_get(material, "normalTexture"),
           *occlusion = json_object_get(material, "occlusionTexture");
    json_t *base = factor_home(material, pbr_object), *rough = json_object_get(base, "metallicRoughnessTexture");
    const bool shared = rough && occlusion && index_of(rough) == index_of(occlusion);
    if (!rough) {
        json_object_set_new(base, "metallicRoughnessTexture", json_deep_copy(normal));
        rough = json_object_get(base, "metallicRoughnessTexture");
        json_object_del(rough, "scale");
    }
    json_object_set_new(normal, "index", json_integer(textures[0]));
    json_object_set_new(rough, "index", json_integer(textures[1]));
    if (shared) json_object_set_new(occlusion, "index", json_integer(textures[1]));
    json_object_set_new(base, "roughnessFactor", json_real(1.0)); /* the map has all of it */
}

/* Returns true if an input has a map with more texels along a side than an image, which would lose them there. */
static bool is_finer(const WeftScene *scene, const Input *input, const WeftImage *than) {
    if (!input->texture) return false;
    const WeftImage *image = &scene->images[scene->textures[input->texture - 1].image];
    return image->width > than->width || image->height > than->height;
}

/* Returns true if the maps of a material can have levels of their own, without loss. */
static bool is_suited(const WeftScene *scene, const Material *material, const json_t *object) {
    const Input *normal = &material->inputs[INPUT_normal], *rough = &material->inputs[INPUT_roughness];
    if (!normal->texture || material->unlit || !json_object_get(object, "normalTexture")) return false;
    if (json_object_get(json_object_get(object, "extensions"), gloss_object)) return false;
    const Texture *texture = &scene->textures[normal->texture - 1];
    const WeftImage *image = &scene->images[texture->image];
    const bool sides = image->width % BLOCK == 0 && image->height % BLOCK == 0;
    return sides && !texture->levels && !texture->nearest && (!rough->texture || place_same(normal, rough)) &&
           !is_finer(scene, rough, image);
}

static WeftResult material_level(Rewrite *rewrite, const WeftScene *scene, int index, json_t *object, bool *changed,
                                 WeftError *error) {
    const Material *material = &scene->materials[index];
    *changed = false;
    if (!is_suited(scene, material, object)) return WEFT_OK;
    const Input *normal = &material->inputs[INPUT_normal];
    const WeftImage *image = &scene->images[scene->textures[normal->texture - 1].image];
    FineMaps maps = {.scene = scene,
                     .material = material,
                     .width = image->width,
                     .height = image->height,
                     .scale = normal->value[0]};
    bool room = true;
    for (int p = 0; p < PLANES; p++) {
        maps.planes[p] = alloc_array(4 * (size_t)image->width * (size_t)image->height, sizeof(float));
        maps.next[p] = alloc_array(4 * (size_t)image->width * (size_t)image->height, sizeof(float));
        room = room && maps.planes[p] && maps.next[p];
    }
    WeftResult result = room ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
    if (room) texels_read(&maps);
    if (room && deviation(&maps) > WEFT_FINE_SLOPES) {
        int textures[MAPS] = {-1, -1};
        const int like = index_of(json_object_get(object, "normalTexture"));
        result = levels_make(&maps, error);
        for (int m = 0; m < MAPS && result == WEFT_OK; m++)
            result = rewrite_image(rewrite, maps.images[m], maps.count, true, like, &textures[m], error);
        if (result == WEFT_OK) maps_name(object, textures);
        *changed = result == WEFT_OK;
    }
    for (int p = 0; p < PLANES; p++) free(maps.planes[p]), free(maps.next[p]);
    for (int k = 0; k < MAPS * LEVELS_MOST; k++) weft_image_free(&maps.images[k / LEVELS_MOST][k % LEVELS_MOST]);
    return result;
}

/* Gives levels to each material that they serve, counts these, and lists the extensions that the file then uses. */
static WeftResult materials_level(Rewrite *rewrite, const WeftScene *scene, WeftDelivery *delivery, int *count,
                                  WeftError *error) {
    WeftResult result = WEFT_OK;
    json_t *object, *materials = json_object_get(rewrite->root, "materials");
    size_t k;
    json_array_foreach(materials, k, object) {
        bool changed = false;
        if (result == WEFT_OK && (int)k < weft_scene_info(scene).material_count)
            result = material_level(rewrite, scene, (int)k, object, &changed, error);
        *count += changed;
    }
    if (result != WEFT_OK || !delivery) return result;
    char *extensions = viewer_extensions_text(rewrite->root);
    if (!extensions) return fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
    free(delivery->extensions);
    delivery->extensions = extensions;
    return WEFT_OK;
}

WeftResult weft_deliver_levels(const char *path, const char *out, WeftDelivery *delivery, int *count,
                               WeftError *error) {
    WeftError own;
    WeftScene *scene = NULL;
    Asset asset = {.error = error ? error : &own};
    Rewrite rewrite;
    int changed = 0;
    WeftResult result = weft_scene_load(path, &scene, NULL, error);
    if (count) *count = 0;
    if (result != WEFT_OK) return result;
    gltf_open(&asset, path, NULL, 0);
    result = asset.result == WEFT_OK ? rewrite_begin(&rewrite, &asset, error) : asset.result;
    if (result == WEFT_OK) {
        result = materials_level(&rewrite, scene, delivery, &changed, error);
        if (result == WEFT_OK) result = rewrite_save(&rewrite, out, error);
        rewrite_end(&rewrite);
    }
    gltf_close(&asset);
    weft_scene_free(scene);
    if (count) *count = changed;
    return result;
}
