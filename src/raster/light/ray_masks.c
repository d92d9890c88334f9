#include "raster/light/ray_masks.h"

#include <stdlib.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/gl/gl_check.h"
#include "weave/weft_cloth.h"

/* Returns the opacity of a material that has a map of it, or NULL. */
static const Input *mapped_opacity(const Material *material) {
    const Input *input = &material->inputs[INPUT_opacity];
    return material->alpha_mode != WEFT_ALPHA_OPAQUE && input->texture ? input : NULL;
}

/* Returns the layer of an input's map, or -1. */
static int find(const RayMasks *self, const Input *input) {
    for (int k = 0; k < self->count; k++)
        if (self->all[k].texture == input->texture - 1 && self->all[k].channel == input->channel) return k;
    return -1;
}

static void collect(RayMasks *self, const WeftScene *scene) {
    self->count = 0;
    for (int k = 0; k < scene->material_count; k++) {
        const Input *input = mapped_opacity(&scene->materials[k]);
        if (input && find(self, input) < 0 && self->count < RAY_MASKS_MOST)
            self->all[self->count++] = (RayMask){input->texture - 1, input->channel};
    }
}

static int side_of(const RayMasks *self, const WeftScene *scene) {
    int side = 1;
    for (int k = 0; k < self->count; k++) {
        const WeftImage *image = &scene->images[scene->textures[self->all[k].texture].image];
        if (image->width > side) side = image->width;
        if (image->height > side) side = image->height;
    }
    return side < RAY_MASK_SIDE ? side : RAY_MASK_SIDE;
}

static void fill(const WeftScene *scene, const RayMask *mask, int side, unsigned char *texels) {
    for (int k = 0; k < side * side; k++) {
        const int column = k % side, row = k / side;
        const float u = ((float)column + 0.5f) / (float)side, v = ((float)row + 0.5f) / (float)side;
        const Texel t = texture_fetch(&scene->textures[mask->texture], scene->images, NULL, u, v);
        texels[k] = (unsigned char)(fminf(fmaxf(t.c[mask->channel], 0.0f), 1.0f) * 255.0f + 0.5f);
    }
}

WeftResult ray_masks_make(RayMasks *self, const WeftScene *scene, WeftError *error) {
    collect(self, scene);
    if (!self->count) return WEFT_OK;
    const int side = side_of(self, scene);
    unsigned char *texels = alloc_array((size_t)side * (size_t)side, 1);
    if (!texels) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (!self->texture) glGenTextures(1, &self->texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->texture);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R8, side, side, self->count, 0, GL_RED, GL_UNSIGNED_BYTE, NULL);
    for (int k = 0; k < self->count; k++) {
        fill(scene, &self->all[k], side, texels);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, k, side, side, 1, GL_RED, GL_UNSIGNED_BYTE, texels);
    }
    free(texels);
    return gl_check(error, "maps of opacity");
}

void ray_masks_destroy(RayMasks *self) {
    glDeleteTextures(1, &self->texture);
    *self = (RayMasks){0};
}

static float alpha_at(const Mesh *mesh, uint32_t vertex) {
    return mesh->color ? mesh->color[4 * (size_t)vertex + 3] : 1.0f;
}

bool ray_masks_triangle(const RayMasks *self, const WeftScene *scene, const Mesh *mesh, uint32_t triangle,
                        float numbers[RAY_MASK_FLOATS]) {
    const Material *material = &scene->materials[mesh->material];
    const Input *input = mapped_opacity(material);
    const int layer = input ? find(self, input) : -1;
    if (layer < 0) return false;
    const Texture *texture = &scene->textures[input->texture - 1];
    const float *m = input->transform, *uv = mesh->texcoord[input->texcoord];
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = mesh->index[3 * (size_t)triangle + (size_t)k];
        const float u = uv ? uv[2 * (size_t)vertex] : 0.0f, v = uv ? uv[2 * (size_t)vertex + 1] : 0.0f;
        numbers[2 * k] = m[0] * u + m[1] * v + m[2];
        numbers[2 * k + 1] = m[3] * u + m[4] * v + m[5];
        numbers[6 + k] = alpha_at(mesh, vertex);
    }
    numbers[9] = input->value[0];
    numbers[10] = material->alpha_mode == WEFT_ALPHA_MASK ? material->alpha_cutoff : -1.0f;
    numbers[11] = (float)(layer + RAY_MASKS_MOST * ((int)texture->wrap_u + 3 * (int)texture->wrap_v));
    return true;
}

float ray_masks_mean(const WeftScene *scene, const Mesh *mesh, uint32_t triangle) {
    const Material *material = &scene->materials[mesh->material];
    if (material->alpha_mode == WEFT_ALPHA_OPAQUE) return 1.0f;
    float alpha = 0.0f, covered = 1.0f;
    for (int k = 0; k < 3; k++) alpha += alpha_at(mesh, mesh->index[3 * (size_t)triangle + (size_t)k]) / 3.0f;
    if (material->cloth) {
        const Weave *weave = &scene->cloths[material->cloth - 1]->weave;
        covered = fminf(weave->warp_far.share + weave->weft_far.share, 1.0f);
    }
    const float opacity = material->inputs[INPUT_opacity].value[0] * alpha;
    const bool mask = material->alpha_mode == WEFT_ALPHA_MASK;
    return covered * (mask ? (opacity >= material->alpha_cutoff ? 1.0f : 0.0f) : fminf(fmaxf(opacity, 0.0f), 1.0f));
}
