#include "raster/material/cloths.h"

#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/memory.h"
#include "raster/gl/gl_check.h"
#include "shading/weave/weave_light.h"
#include "weave/weft_cloth.h"

/* Returns the rows of texels that so many threads take. */
static int rows_for(int threads, int width) { return (threads + width - 1) / width; }

static bool upload_cells(const WeftCloth *cloth, unsigned texture) {
    const Weave *m = &cloth->weave;
    const int threads = m->warps + m->picks, rows = m->picks + rows_for(threads, m->warps);
    const size_t cells = (size_t)m->warps * (size_t)m->picks;
    float *texels = alloc_array((size_t)rows * (size_t)m->warps, 4 * sizeof(float));
    if (!texels) return false;
    memcpy(texels, cloth->runs, 4 * cells * sizeof(float));
    for (int k = 0; k < threads; k++)
        memcpy(texels + 4 * (cells + (size_t)k), cloth->albedos + 3 * (size_t)k, 3 * sizeof(float));
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, m->warps, rows, 0, GL_RGBA, GL_FLOAT, texels);
    texture_unfiltered(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    free(texels);
    return true;
}

static void upload_colors(const ClothFar *far, unsigned texture) {
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    for (int level = 0; level < far->levels; level++) {
        int width, height;
        const float *texels = cloth_far_level(far, level, &width, &height);
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_RGBA16F, width, height, FAR_LAYERS, 0, GL_RGBA, GL_FLOAT, texels);
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, far->levels - 1);
}

/* Returns the place of a cloth by its number: the other face of a cloth, whose number is below 0, comes behind it. */
static int place_of(int number) { return number > 0 ? 2 * number - 2 : -2 * number - 1; }

/* Uploads a cloth unless it was. cloth: NULL for a face that there is not. Returns false if memory is short. */
static bool upload(GlCloth *one, const WeftCloth *cloth) {
    if (!cloth || one->cloth) return true;
    one->cloth = cloth;
    glGenTextures(1, &one->cells);
    glGenTextures(1, &one->colors);
    upload_colors(&cloth->far, one->colors);
    return upload_cells(cloth, one->cells);
}

WeftResult cloths_update(GlCloths *self, const WeftScene *scene, WeftError *error) {
    const int count = 2 * scene->cloth_count;
    if (self->count < count) {
        GlCloth *all = realloc_array(self->all, (size_t)count, sizeof *all);
        if (!all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
        memset(all + self->count, 0, (size_t)(count - self->count) * sizeof *all);
        self->all = all;
        self->count = count;
    }
    bool made = true;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (int k = 0; k < scene->cloth_count && made; k++)
        made = upload(&self->all[2 * k], scene->cloths[k]) && upload(&self->all[2 * k + 1], scene->cloths[k]->other);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    return made ? gl_check(error, "cloths") : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

void cloths_bind(const GlCloths *self, int cloth, int cells_unit, int colors_unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)cells_unit);
    glBindTexture(GL_TEXTURE_2D, self->all[place_of(cloth)].cells);
    glActiveTexture(GL_TEXTURE0 + (GLenum)colors_unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->all[place_of(cloth)].colors);
    glActiveTexture(GL_TEXTURE0);
}

void cloths_destroy(GlCloths *self) {
    for (int k = 0; k < self->count; k++) {
        glDeleteTextures(1, &self->all[k].cells);
        glDeleteTextures(1, &self->all[k].colors);
    }
    free(self->all);
    *self = (GlCloths){0};
}

void cloth_numbers(const WeftCloth *cloth, float numbers[CLOTH_NUMBERS]) {
    const Weave *m = &cloth->weave;
    const float rest[] = {m->seed,
                          m->low,
                          m->high,
                          m->openness,
                          (float)m->warps,
                          (float)m->picks,
                          (float)cloth->far.width,
                          (float)cloth->far.height,
                          cloth->per_uv[WEFT_WARP],
                          cloth->per_uv[WEFT_WEFT],
                          cloth->rotation_parts[0],
                          cloth->rotation_parts[1]};
    enum { AFAR = 84 }; /* index of the numbers of far.woven: CLOTH_AFAR of glsl/weave.glsl */
    _Static_assert((2 * sizeof(WeaveYarn) + 2 * sizeof(WeaveFar) + sizeof rest + 3 * sizeof(float)) /
                           (4 * sizeof(float)) ==
                       AFAR / 4,
                   "all of them");
    _Static_assert((AFAR * sizeof(float) + sizeof cloth->far.woven + 3 * sizeof(float)) / (4 * sizeof(float)) ==
                       CLOTH_NUMBERS / 4,
                   "all of them");
    memcpy(numbers + AFAR, cloth->far.woven, sizeof cloth->far.woven);
    memcpy(numbers, &m->warp, sizeof m->warp), numbers += sizeof m->warp / sizeof(float);
    memcpy(numbers, &m->weft, sizeof m->weft), numbers += sizeof m->weft / sizeof(float);
    memcpy(numbers, &m->warp_far, sizeof m->warp_far), numbers += sizeof m->warp_far / sizeof(float);
    memcpy(numbers, &m->weft_far, sizeof m->weft_far), numbers += sizeof m->weft_far / sizeof(float);
    memcpy(numbers, rest, sizeof rest);
}
