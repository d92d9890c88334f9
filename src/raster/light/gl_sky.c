#include "raster/light/gl_sky.h"

#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/gl/gl_check.h"
#include "scene/light/env_split.h"
#include "trace/light/sky.h"

/* Uploads the distributions of a sky. Returns false if memory is short. */
static bool upload(const GlSky *self, const Sky *sky) {
    const size_t width = (size_t)sky->width + 1;
    float *texels = alloc_array(width * (size_t)sky->height, sizeof *texels);
    if (!texels) return false;
    for (int k = 0; k < sky->height; k++) {
        float *row = texels + (size_t)k * width;
        memcpy(row, sky->columns.ends + (size_t)k * sky->stride, (width - 1) * sizeof *row);
        row[width - 1] = sky->rows.ends[k];
    }
    glBindTexture(GL_TEXTURE_2D, self->table);
    texture_unfiltered(GL_TEXTURE_2D);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, (GLsizei)width, sky->height, 0, GL_RED, GL_FLOAT, texels);
    free(texels);
    return true;
}

WeftResult sky_table_make(GlSky *self, const Environment *environment, WeftError *error) {
    if (environment->kind == ENVIRONMENT_CONSTANT || (self->made && self->version == environment->version))
        return WEFT_OK;
    Environment seen = *environment;
    Arena arena = {0};
    WeftImage small = {0};
    Sky sky;
    WeftResult result = WEFT_OK;
    if (seen.image.width > SKY_WIDTH_MOST) {
        result = latlong_resize(&seen.image, SKY_WIDTH_MOST, SKY_WIDTH_MOST / 2, &small, error);
        seen.image = small;
    }
    if (!self->table) glGenTextures(1, &self->table);
    if (result == WEFT_OK && (!sky_make(&sky, &seen, &arena) || !upload(self, &sky)))
        result = fail(error, WEFT_MESSAGE_MEMORY, "an environment", NULL);
    if (result == WEFT_OK) result = gl_check(error, "an environment");
    arena_free(&arena);
    weft_image_free(&small);
    self->made = result == WEFT_OK;
    self->version = environment->version;
    return result;
}

void sky_table_destroy(GlSky *self) {
    glDeleteTextures(1, &self->table);
    *self = (GlSky){0};
}
