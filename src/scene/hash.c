/* hash.c - a hash of a scene's contents, by which pictures of two processes are known to be of one scene */
#include <math.h>
#include <string.h>

#include "base/cache.h"
#include "brdf/measured.h"
#include "scene/record/scene.h"
#include "shading/catalogue/outside.h"
#include "shading/catalogue/registry.h"

static uint64_t hash_floats(uint64_t hash, const float *values, size_t count) {
    return cache_hash(cache_hash(hash, &count, sizeof count), values, values ? count * sizeof *values : 0);
}

static uint64_t hash_image(uint64_t hash, const WeftImage *image) {
    static const size_t sizes[] = {[WEFT_PIXEL_U8] = 1, [WEFT_PIXEL_U16] = 2, [WEFT_PIXEL_F32] = 4};
    const int form[] = {image->width, image->height, image->channels, (int)image->type};
    hash = cache_hash(hash, form, sizeof form);
    if (!image->pixels) return hash;
    return cache_hash(hash, image->pixels,
                      (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizes[image->type]);
}

static uint64_t hash_mesh(uint64_t hash, const Mesh *mesh) {
    const size_t n = mesh->vertex_count;
    const bool has[] = {mesh->normal, mesh->tangent, mesh->texcoord[0], mesh->texcoord[1], mesh->color};
    hash = cache_hash(cache_hash(hash, has, sizeof has), &mesh->material, sizeof mesh->material);
    hash = hash_floats(hash, mesh->position, 3 * n);
    if (mesh->normal) hash = hash_floats(hash, mesh->normal, 3 * n);
    if (mesh->tangent) hash = hash_floats(hash, mesh->tangent, 4 * n);
    for (int k = 0; k < 2; k++)
        if (mesh->texcoord[k]) hash = hash_floats(hash, mesh->texcoord[k], 2 * n);
    if (mesh->color) hash = hash_floats(hash, mesh->color, 4 * n);
    return cache_hash(hash, mesh->index, 3 * (size_t)mesh->triangle_count * sizeof *mesh->index);
}

static uint64_t hash_texture(uint64_t hash, const WeftScene *scene, const Texture *texture) {
    const int form[] = {texture->image, (int)texture->wrap_u, (int)texture->wrap_v, texture->nearest,
                        (int)texture->inverted};
    hash = hash_image(cache_hash(hash, form, sizeof form), &scene->images[texture->image]);
    const TextureLevels *levels = texture_levels(texture);
    for (int k = 0; levels && k < levels->count; k++) hash = hash_image(hash, &levels->images[k]);
    return hash;
}

/* Hashes a cloth by its draft, thread by thread, its yarns and its figures. */
static uint64_t hash_cloth(uint64_t hash, const WeftScene *scene, int cloth) {
    WeftYarn yarns[2];
    const WeftDraft *draft = weft_scene_cloth(scene, cloth, yarns);
    const WeftClothInfo info = weft_scene_cloth_info(scene, cloth);
    const WeftDraftInfo repeat = weft_draft_info(draft);
    const float numbers[] = {info.size[0],  info.size[1], info.metres,     (float)info.automatic,
                             info.rotation, info.relief,  (float)info.seed};
    hash = hash_floats(cache_hash(hash, yarns, sizeof yarns), numbers, sizeof numbers / sizeof *numbers);
    for (int system = 0; system < 2; system++)
        for (int k = 0; k < repeat.count[system]; k++) {
            const WeftThread thread = weft_draft_thread(draft, (WeftThreads)system, k);
            hash = cache_hash(hash, &thread, sizeof thread);
        }
    for (int pick = 0; pick < repeat.count[WEFT_WEFT]; pick++)
        for (int warp = 0; warp < repeat.count[WEFT_WARP]; warp++)
            hash = cache_hash(hash, &(unsigned char){(unsigned char)weft_draft_warp_up(draft, warp, pick)}, 1);
    return hash;
}

/* Hashes a measurement by f in some directions. */
static uint64_t hash_measured(uint64_t hash, const Measured *measured) {
    enum { SIDE = 12 };
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int column = k % SIDE, row = k / SIDE;
        const float a = (float)column / SIDE, b = (float)row / SIDE, s = 0.9f * a, t = 0.9f * b;
        float f[3];
        measured_at(measured, (Dir){s, 0.0f, sqrtf(1.0f - s * s)},
                    (Dir){-t * b, t * sqrtf(1.0f - b * b), sqrtf(1.0f - t * t)}, f);
        hash = hash_floats(hash, f, 3);
    }
    return hash;
}

/* Hashes what materials refer to by number. */
static uint64_t hash_surfaces(uint64_t hash, const WeftScene *scene) {
    hash = cache_hash(hash, scene->materials, (size_t)scene_shaded_materials(scene) * sizeof *scene->materials);
    for (int k = 0; k < scene->texture_count; k++) hash = hash_texture(hash, scene, &scene->textures[k]);
    for (int k = 1; k <= scene->cloth_count; k++) hash = hash_cloth(hash, scene, k);
    for (int k = 0; k < scene->measured_count; k++) hash = hash_measured(hash, scene->measured[k]);
    return hash;
}

static uint64_t hash_environment(uint64_t hash, const Environment *e) {
    const float numbers[] = {(float)e->kind, e->color[0], e->color[1], e->color[2],
                             e->rotation,    e->strength, e->ambient,  e->reflection};
    return hash_image(hash_floats(hash, numbers, sizeof numbers / sizeof *numbers), &e->image);
}

/* Hashes the files of lobes from outside the catalogue, which materials name by number. */
static uint64_t hash_outside(uint64_t hash) {
    for (int k = 0; k < outside_count(); k++) {
        const char *text = outside_lobe(LOBE_COUNT + k)->text;
        hash = cache_hash(hash, text, strlen(text));
    }
    return hash;
}

uint64_t weft_scene_hash(const WeftScene *scene) {
    uint64_t hash = hash_outside(CACHE_HASH);
    WeftLight light;
    for (int k = 0; k < scene->mesh_count; k++) hash = hash_mesh(hash, &scene->meshes[k]);
    hash = hash_environment(hash_surfaces(hash, scene), &scene->environment);
    for (int k = 0; weft_scene_light(scene, k, &light, NULL) == WEFT_OK; k++)
        hash = cache_hash(hash, &light, sizeof light);
    for (int k = 0; k < scene->camera_count; k++) {
        const Camera *c = &scene->cameras[k];
        const float numbers[] = {c->eye.x, c->eye.y,     c->eye.z,     c->up.x,      c->up.y,
                                 c->up.z,  c->forward.x, c->forward.y, c->forward.z, (float)c->orthographic,
                                 c->yfov,  c->ymag};
        hash = hash_floats(hash, numbers, sizeof numbers / sizeof *numbers);
    }
    return hash;
}
