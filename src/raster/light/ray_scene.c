#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/light/ray_scene.h"

#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/geometry/ray_tree.h"
#include "raster/gl/gl_check.h"
#include "raster/light/ray_albedos.h"
#include "raster/light/ray_panes.h"
#include "scene/light/pane.h"
#include "scene/material/hair.h"

enum { NODES, TRIANGLES, NORMALS, EMITTERS, MASKS, PANES, KINDS };

/* The place of a triangle, counted through all meshes. */
typedef struct TrianglePlace {
    uint32_t mesh, triangle;
} TrianglePlace;

/* Returns of how many fibres one is to be in the tree. */
static uint32_t share_of(const WeftScene *scene) {
    uint64_t fibres = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (hair_is_mesh(scene, m)) fibres += scene->meshes[m].triangle_count / HAIR_TRIANGLES;
    return (uint32_t)((fibres + RAY_FIBRES_MOST - 1) / RAY_FIBRES_MOST);
}

/* Returns how many triangles of a mesh are in the tree of one fibre in `share`. */
static uint32_t kept_of(const WeftScene *scene, int m, uint32_t share) {
    const uint32_t all = scene->meshes[m].triangle_count;
    return share > 1 && hair_is_mesh(scene, m) ? HAIR_TRIANGLES * ((all / HAIR_TRIANGLES + share - 1) / share) : all;
}

/* Returns the number in its mesh of the k-th triangle of those in the tree. */
static uint32_t kept_at(const WeftScene *scene, int m, uint32_t share, uint32_t k) {
    return share > 1 && hair_is_mesh(scene, m) ? k / HAIR_TRIANGLES * share * HAIR_TRIANGLES + k % HAIR_TRIANGLES : k;
}

static uint32_t count_triangles(const WeftScene *scene, uint32_t share) {
    uint64_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++) count += kept_of(scene, m, share);
    return count < RAY_NUMBER_MOST ? (uint32_t)count : RAY_NUMBER_MOST;
}

static Vec3 corner_of(const WeftScene *scene, int m, uint32_t share, uint32_t triangle, int corner) {
    const Mesh *mesh = &scene->meshes[m];
    const uint32_t vertex = mesh->index[3 * (size_t)triangle + (size_t)corner];
    const Vec3 at = vec3_load(mesh->position + 3 * (size_t)vertex);
    return share > 1 && hair_is_mesh(scene, m) ? vec3_madd(at, hair_across(mesh, vertex), (float)(share - 1)) : at;
}

static bool make_tree(RayScene *self, RayTree *tree, const WeftScene *scene) {
    const uint32_t share = self->hair_share = share_of(scene), count = count_triangles(scene, share);
    RayBox *boxes = alloc_array(count, sizeof *boxes), *to = boxes;
    if (!boxes) return false;
    for (int m = 0; m < scene->mesh_count; m++)
        for (uint32_t k = 0; k < kept_of(scene, m, share); k++) {
            const uint32_t t = kept_at(scene, m, share, k);
            const Vec3 a = corner_of(scene, m, share, t, 0), b = corner_of(scene, m, share, t, 1),
                       c = corner_of(scene, m, share, t, 2);
            *to++ = (RayBox){vec3_least(a, vec3_least(b, c)), vec3_most(a, vec3_most(b, c))};
        }
    const bool made = ray_tree_make(tree, boxes, count);
    free(boxes);
    return made;
}

static void put(float *texel, Vec3 v, float w) { texel[0] = v.x, texel[1] = v.y, texel[2] = v.z, texel[3] = w; }

/* Puts a triangle into the texture. albedos is NULL where nothing bounces. */
static void put_triangle(const RayScene *self, const WeftScene *scene, const RayAlbedo *albedos, TrianglePlace at,
                         float *triangle, float *normals) {
    const Mesh *mesh = &scene->meshes[at.mesh];
    const float side = scene->materials[mesh->material].double_sided ? 0.0f : 4.0f;
    const float last[3] = {side + ray_masks_mean(scene, mesh, at.triangle), 0.0f, 0.0f};
    float albedo[3] = {0.0f, 0.0f, 0.0f};
    if (albedos) ray_albedos_triangle(albedos, scene, mesh, at.triangle, albedo);
    for (int k = 0; k < 3; k++) {
        put(triangle + 4 * k, corner_of(scene, (int)at.mesh, self->hair_share, at.triangle, k), last[k]);
        const uint32_t vertex = mesh->index[3 * (size_t)at.triangle + (size_t)k];
        const Vec3 none = {0.0f, 0.0f, 0.0f};
        put(normals + 4 * k, mesh->normal ? vec3_load(mesh->normal + 3 * (size_t)vertex) : none, albedo[k]);
    }
}

/* Returns the place of each triangle in the order of the meshes; NULL if memory is short. */
static TrianglePlace *find_places(const RayScene *self, const RayTree *tree, const WeftScene *scene) {
    const uint32_t share = self->hair_share;
    TrianglePlace *places = alloc_array(tree->count, sizeof *places), *to = places;
    for (int m = 0; places && m < scene->mesh_count; m++)
        for (uint32_t k = 0; k < kept_of(scene, m, share); k++)
            *to++ = (TrianglePlace){(uint32_t)m, kept_at(scene, m, share, k)};
    return places;
}

/* Notes at each triangle of the texture the emitter that it is. at: where in the tree's order each triangle is. */
static bool put_emitters(const RayScene *self, const WeftScene *scene, const RayEmitters *emitters, const uint32_t *at,
                         float *texels) {
    uint32_t *first = alloc_array((size_t)scene->mesh_count, sizeof *first), count = 0;
    for (int m = 0; first && m < scene->mesh_count; m++) {
        first[m] = count; /* hair does not emit */
        count += kept_of(scene, m, self->hair_share);
    }
    for (int k = 0; first && k < emitters->count; k++) {
        const RayEmitter *emitter = &emitters->all[k];
        float *to = texels + 4 * ((size_t)self->first[EMITTERS] + 4 * (size_t)k);
        put(to, emitter->a, emitter->until);
        put(to + 4, emitter->ab, emitter->two_sided ? 1.0f : 0.0f);
        put(to + 8, emitter->ac, emitter->area);
        put(to + 12, vec3_load(emitter->radiance), emitter->probability);
        const size_t triangle = at[first[emitter->mesh] + emitter->triangle];
        texels[4 * ((size_t)self->first[TRIANGLES] + 3 * triangle + 1) + 3] = (float)(k + 1);
    }
    const bool made = first != NULL;
    free(first);
    return made;
}

/* Returns the number of triangles with a mask. */
static size_t count_masks(const RayScene *self, const WeftScene *scene) {
    float numbers[RAY_MASK_FLOATS];
    size_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (scene->meshes[m].triangle_count && ray_masks_triangle(&self->masks, scene, &scene->meshes[m], 0, numbers))
            count += scene->meshes[m].triangle_count;
    return count;
}

static size_t count_panes(const WeftScene *scene) {
    size_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (scene_is_pane(scene, scene->meshes[m].material)) count += scene->meshes[m].triangle_count;
    return count;
}

/* Puts what the triangles of panes let through, and notes at each where that is. at: as for put_emitters. */
static void put_panes(const RayScene *self, const WeftScene *scene, const uint32_t *at, float *texels) {
    size_t pane = (size_t)self->first[PANES], first = 0;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        const uint32_t count = scene_is_pane(scene, mesh->material) ? mesh->triangle_count : 0; /* hair is none */
        for (uint32_t k = 0; k < count; k++, pane += 2) {
            float facing[3], grazing[3];
            ray_pane_triangle(scene, mesh, k, facing, grazing);
            put(texels + 4 * pane, vec3_load(facing), 0.0f);
            put(texels + 4 * (pane + 1), vec3_load(grazing), 0.0f);
            texels[4 * ((size_t)self->first[TRIANGLES] + 3 * (size_t)at[first + k] + 1) + 3] = -(float)pane;
        }
        first += kept_of(scene, m, self->hair_share);
    }
}

/* Fills the texels. Returns false if memory is short. */
static bool fill(const RayScene *self, const RayTree *tree, const WeftScene *scene, const SheenTables *sheens,
                 const RayEmitters *emitters, float *texels) {
    RayAlbedo *albedos = sheens ? ray_albedos_make(scene, sheens) : NULL;
    TrianglePlace *places = find_places(self, tree, scene);
    uint32_t *at = alloc_array(tree->count, sizeof *at);
    const bool made = places && at && (albedos || !sheens);
    size_t masks = 0;
    memcpy(texels, tree->nodes, tree->node_count * sizeof *tree->nodes);
    for (uint32_t k = 0; made && k < tree->count; k++) {
        const TrianglePlace place = places[tree->order[k]];
        float *triangle = texels + 4 * ((size_t)self->first[TRIANGLES] + 3 * (size_t)k);
        at[tree->order[k]] = k;
        put_triangle(self, scene, albedos, place, triangle,
                     texels + 4 * ((size_t)self->first[NORMALS] + 3 * (size_t)k));
        if (ray_masks_triangle(&self->masks, scene, &scene->meshes[place.mesh], place.triangle,
                               texels + 4 * ((size_t)self->first[MASKS] + 3 * masks)))
            triangle[11] = (float)++masks;
    }
    const bool lit = made && put_emitters(self, scene, emitters, at, texels);
    if (lit) put_panes(self, scene, at, texels);
    free(albedos);
    free(places);
    free(at);
    return lit;
}

/* Uploads texels into the texture, which keeps its size if that is enough. */
static WeftResult upload(RayScene *self, int rows, const float *texels, WeftError *error) {
    const bool fresh = !self->texture || rows != self->rows;
    if (!self->texture) glGenTextures(1, &self->texture);
    glBindTexture(GL_TEXTURE_2D, self->texture);
    texture_unfiltered(GL_TEXTURE_2D);
    if (fresh)
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, RAY_ROW, rows, 0, GL_RGBA, GL_FLOAT, texels);
    else
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, RAY_ROW, rows, GL_RGBA, GL_FLOAT, texels);
    self->rows = rows;
    return gl_check(error, "triangles for rays");
}

static WeftResult fill_texture(RayScene *self, const RayTree *tree, const WeftScene *scene, const SheenTables *sheens,
                               WeftError *error) {
    RayEmitters emitters;
    GLint most = 0;
    if (!ray_emitters_find(&emitters, scene)) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    const size_t sizes[] = {2 * (size_t)tree->node_count, 3 * (size_t)tree->count,      3 * (size_t)tree->count,
                            4 * (size_t)emitters.count,   3 * count_masks(self, scene), 2 * count_panes(scene)};
    size_t texels = 0;
    for (int k = 0; k < KINDS; k++) {
        self->first[k] = (int)texels;
        texels += sizes[k];
    }
    self->emitters = emitters.count;
    const size_t rows = (texels + RAY_ROW - 1) / RAY_ROW;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    WeftResult result = WEFT_OK;
    if (texels > RAY_NUMBER_MOST || rows > (size_t)most)
        result = fail(error, WEFT_MESSAGE_GL_MEMORY, scene->name, "too many triangles to trace rays in a shader");
    float *all = result == WEFT_OK ? alloc_array(rows * RAY_ROW, 4 * sizeof *all) : NULL;
    if (result == WEFT_OK && (!all || !fill(self, tree, scene, sheens, &emitters, all)))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK) result = upload(self, (int)rows, all, error);
    free(all);
    ray_emitters_free(&emitters);
    self->filled = result == WEFT_OK;
    self->shape_version = scene->shape_version;
    self->nodes = tree->node_count;
    self->bounces = sheens != NULL;
    return result;
}

WeftResult ray_scene_make(RayScene *self, const WeftScene *scene, const SheenTables *sheens, WeftError *error) {
    RayTree tree = {0}; /* only the texture keeps it */
    if (self->filled && (self->bounces || !sheens) && self->shape_version == scene->shape_version) return WEFT_OK;
    if (count_triangles(scene, share_of(scene)) >= RAY_NUMBER_MOST / 2)
        return fail(error, WEFT_MESSAGE_GL_MEMORY, scene->name, "too many triangles to trace rays in a shader");
    WeftResult result = ray_masks_make(&self->masks, scene, error);
    if (result != WEFT_OK) return result;
    result = make_tree(self, &tree, scene) ? fill_texture(self, &tree, scene, sheens, error)
                                           : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    ray_tree_free(&tree);
    return result;
}

void ray_scene_destroy(RayScene *self) {
    glDeleteTextures(1, &self->texture);
    ray_masks_destroy(&self->masks);
    *self = (RayScene){0};
}

void ray_scene_bind(const RayScene *self, int unit, int masks_unit) {
    glActiveTexture((GLenum)(GL_TEXTURE0 + unit));
    glBindTexture(GL_TEXTURE_2D, self->texture);
    glActiveTexture((GLenum)(GL_TEXTURE0 + masks_unit));
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->masks.texture);
    glActiveTexture(GL_TEXTURE0);
}
