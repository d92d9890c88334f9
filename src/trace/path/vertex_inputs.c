/* vertex_inputs.c - a material's inputs at the vertices of a chunk, from its numbers, its textures and vertex
 * colours */
#include "trace/path/chunk.h"

#include "shading/dialect/loop.h"
#include "shading/dialect/texel.h"

/* Interpolates texture coordinates as geometry_attributes does. */
static void gather_texcoords(const Chunk *chunk, const WeftScene *scene, int set, int n, Row uv[2]) {
    for (int k = 0; k < n; k++) {
        const Mesh *mesh = &scene->meshes[chunk->mesh[k]];
        const uint32_t *index = mesh->index + 3 * (size_t)chunk->triangle[k];
        float weight[3] = {1.0f - chunk->u[k] - chunk->v[k], chunk->u[k], chunk->v[k]}, at[2] = {0};
        for (int corner = 0; mesh->texcoord[set] && corner < 3; corner++) {
            const float *of = mesh->texcoord[set] + 2 * (size_t)index[corner];
            for (int a = 0; a < 2; a++) at[a] += of[a] * weight[corner];
        }
        for (int a = 0; a < 2; a++) uv[a][k] = at[a];
    }
}

/* Applies an input's placement, an affine map m, to texture coordinates. */
LOOP(place_uv_n, (const Row uv[2], const float m[6], int n, Row *restrict placed), (uv, m, n, placed)) {
    EACH(k, (size_t)n) {
        float u = uv[0][k], v = uv[1][k];
        placed[0][k] = m[0] * u + m[1] * v + m[2];
        placed[1][k] = m[3] * u + m[4] * v + m[5];
    }
}

/* Finds the levels of a texture in which a viewer looks it up: the longer edge of the pixel is about a texel long. Between
 * two levels one is drawn, so that the mean is that of both. */
static void find_levels(TexelRows *lookup, const Input *input, const WeftImage *image, int most) {
    const float *m = input->transform;
    for (int k = 0; k < lookup->n; k++) {
        float longest = 1e-12f;
        for (int e = 0; e < 2; e++) {
            const float a = lookup->edges[input->texcoord][e][0][k], b = lookup->edges[input->texcoord][e][1][k];
            const float u = (m[0] * a + m[1] * b) * (float)image->width,
                        v = (m[3] * a + m[4] * b) * (float)image->height;
            longest = fmaxf(longest, u * u + v * v);
        }
        const float level = fminf(fmaxf(0.5f * log2f(longest), 0.0f), (float)most);
        const int drawn = (int)(level + lookup->chance[k]);
        lookup->level[k] = drawn < most ? drawn : most;
    }
}

/* Looks up the input's texture, unless the last look-up had the same texels. srgb: how to decode it; NULL: not. */
static void fetch(TexelRows *lookup, const Input *input, const SrgbTable *srgb) {
    const Input *last = lookup->last;
    if (last && lookup->last_srgb == srgb && input_same_texels(last, input)) return;
    const WeftScene *scene = lookup->scene;
    place_uv_n((const Row *)lookup->uv[input->texcoord], input->transform, row_whole(lookup->n), lookup->placed_uv);
    const Texture *texture = &scene->textures[input->texture - 1];
    const TextureLevels *levels = texture_levels(texture);
    if (levels) {
        find_levels(lookup, input, &scene->images[texture->image], levels->count);
        texture_fetch_levels(texture, scene->images, srgb, lookup->n, lookup->placed_uv[0], lookup->placed_uv[1],
                             lookup->level, lookup->texel[0]);
    } else {
        texture_fetch_rows(texture, scene->images, srgb, lookup->n, lookup->placed_uv[0], lookup->placed_uv[1],
                           lookup->texel[0]);
    }
    lookup->last = input;
    lookup->last_srgb = srgb;
}

static void scale(const Row from, float factor, int n, float *restrict to) {
    EACH(k, (size_t)n) { to[k] = factor * from[k]; }
}

static void read_SCALAR(TexelRows *lookup, const Input *input, Row to) {
    fetch(lookup, input, NULL);
    scale(lookup->texel[input->channel], input->value[0], row_whole(lookup->n), to);
}

static void read_ANGLE(TexelRows *lookup, const Input *input, Row to) { read_SCALAR(lookup, input, to); }

static void read_COLOR(TexelRows *lookup, const Input *input, Row to[3]) {
    fetch(lookup, input, &lookup->scene->srgb);
    for (int a = 0; a < 3; a++) scale(lookup->texel[a], input->value[a], row_whole(lookup->n), to[a]);
}

/* Decodes the texels of a normal map. */
LOOP(normals_n, (const Row texel[4], float strength, int n, Row *restrict to), (texel, strength, n, to)) {
    EACH(k, (size_t)n) {
        Dir d = texel_normal(texel[0][k], texel[1][k], texel[2][k], strength);
        to[0][k] = d.x;
        to[1][k] = d.y;
        to[2][k] = d.z;
    }
}

static void read_NORMAL(TexelRows *lookup, const Input *input, Row to[3]) {
    fetch(lookup, input, NULL);
    normals_n((const Row *)lookup->texel, input->value[0], row_whole(lookup->n), to);
}

static void read_DIRECTION(TexelRows *lookup, const Input *input, Row to[3]) {
    fetch(lookup, input, NULL);
    float x = cos(input->value[0]), y = sin(input->value[0]);
    for (int k = 0; k < lookup->n; k++) {
        Dir d = texel_direction(lookup->texel[0][k], lookup->texel[1][k], x, y);
        to[0][k] = d.x;
        to[1][k] = d.y;
        to[2][k] = d.z;
    }
}

/* Multiplies the base colour by the interpolated vertex colour. */
static void tint_base(Chunk *chunk, const WeftScene *scene, int n) {
    SurfaceRows *surface = &chunk->vertices.surface;
    for (int k = 0; k < n; k++) {
        Hit hit = {.t = chunk->t[k],
                   .mesh = chunk->mesh[k],
                   .triangle = chunk->triangle[k],
                   .u = chunk->u[k],
                   .v = chunk->v[k]};
        Attributes at = geometry_attributes(&scene->meshes[hit.mesh], &hit);
        for (int a = 0; a < 3; a++) surface->base_color[a][k] *= at.color[a];
    }
}

/* Fills the rows with the material's inputs without textures. Rows that it filled last are still valid, except that
 * vertex colours change the base colour. */
static void fill_untextured(Chunk *chunk, const ChunkSource *source, int n) {
    const PathMaterial *material = &source->context->materials[source->material];
    int have = chunk->filled_material == source->material + 1 && !material->colored ? chunk->filled_rows : 0;
    for (int k = have; k < n; k++) surface_to_row(&chunk->vertices.surface, (size_t)k, &material->untextured);
    chunk->filled_material = source->material + 1;
    chunk->filled_rows = n > have ? n : have;
}

void chunk_read_inputs(Chunk *chunk, const ChunkSource *source, int n) {
    const WeftScene *scene = source->context->scene;
    const PathMaterial *material = &source->context->materials[source->material];
    const Input *inputs = material->material.inputs;
    fill_untextured(chunk, source, n);
    if (!material->textured) return;
    TexelRows *lookup = &chunk->textures;
    lookup->scene = scene;
    lookup->last = NULL;
    lookup->n = n;
    for (int set = 0; set < 2; set++)
        if (material->texcoords[set]) gather_texcoords(chunk, scene, set, n, lookup->uv[set]);
    for (int set = 0; set < 2; set++)
        if (material->leveled[set]) chunk_find_edges(chunk, source, set, n);
#define READ_INPUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                             \
    if (inputs[INPUT_##name].texture) read_##kind(lookup, &inputs[INPUT_##name], chunk->vertices.surface.name);
    SURFACE_INPUTS(READ_INPUT)
    if (material->colored) tint_base(chunk, scene, n);
}
