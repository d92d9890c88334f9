#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/frame/sums.h"

#include <epoxy/gl.h>

#include "raster/gl/gl_check.h"
#include "raster/gl/program.h"
#include "trace/path/lens.h"

enum { SUM, START, NEXT };

static WeftResult build(Sums *self, const TextDesc *desc, WeftError *error) {
    const WeftResult result = program_on_screen("sum of frames", "raster/glsl/sum.glsl", desc, &self->program, error);
    if (result != WEFT_OK) return result;
    glUseProgram(self->program);
    glUniform1i(glGetUniformLocation(self->program, "sum_first"), 0);
    glUniform1i(glGetUniformLocation(self->program, "sum_second"), 1);
    self->weights = glGetUniformLocation(self->program, "sum_weights");
    return WEFT_OK;
}

static void free_targets(Sums *self) {
    glDeleteFramebuffers(self->count, self->framebuffers);
    glDeleteTextures(self->count, self->textures);
    target_destroy(&self->frame);
    self->width = self->height = 0;
}

/* Returns true if the driver adds to a texture of 32-bit floats as it draws. */
static bool floats_blend(void) { return epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_float_blend"); }

static WeftResult make_targets(Sums *self, int width, int height, WeftError *error) {
    if (self->width == width && self->height == height) return WEFT_OK;
    if (self->width) free_targets(self);
    self->count = floats_blend() ? NEXT : NEXT + 1;
    glGenTextures(self->count, self->textures);
    glGenFramebuffers(self->count, self->framebuffers);
    for (int k = 0; k < self->count; k++) {
        glBindTexture(GL_TEXTURE_2D, self->textures[k]);
        texture_unfiltered(GL_TEXTURE_2D);
        if (k == START)
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width, height, 0, GL_RGBA, GL_HALF_FLOAT, NULL);
        else
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
        glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffers[k]);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->textures[k], 0);
    }
    WeftResult result = gl_check(error, "a sum of frames");
    if (result == WEFT_OK) result = target_resize(&self->frame, width, height, 1, error);
    self->width = width;
    self->height = height;
    if (result != WEFT_OK) free_targets(self);
    return result;
}

WeftResult sums_begin(Sums *self, const TextDesc *desc, int width, int height, const Target *picture,
                      WeftError *error) {
    WeftResult result = self->program ? WEFT_OK : build(self, desc, error);
    if (result == WEFT_OK) result = make_targets(self, width, height, error);
    if (result != WEFT_OK) return result;
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    for (int k = 0; k < self->count; k++) {
        glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffers[k]);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    self->starts = picture != NULL;
    if (picture) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, picture->resolved);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, self->framebuffers[START]);
        glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    self->done = self->row = 0;
    return gl_check(error, "a sum of frames");
}

/* Returns digit-reversed number k, in [0, 1). John Halton, "On the Efficiency of Certain Quasi-Random Sequences of
 * Points in Evaluating Multi-Dimensional Integrals", 1960. */
static float reversed(int k, int base) {
    float sum = 0.0f, place = 1.0f;
    for (; k > 0; k /= base) {
        place /= (float)base;
        sum += place * (float)(k % base);
    }
    return sum;
}

static float offset_of(const Lens *lens, float u) {
    const float x = u * LENS_STEPS;
    const int k = (int)x;
    return lens->filter[k] + (lens->filter[k + 1] - lens->filter[k]) * (x - (float)k);
}

View sums_view(const Sums *self) {
    Lens lens;
    View view = self->seen;
    lens_make(&lens);
    const float x = 2.0f * offset_of(&lens, reversed(self->done + 1, 2)) / (float)self->width,
                y = 2.0f * offset_of(&lens, reversed(self->done + 1, 3)) / (float)self->height;
    const Vec3 aside = vec3_madd(vec3_scale(view.across, x), view.up, y);
    if (view.orthographic)
        view.eye = vec3_add(view.eye, aside);
    else
        view.forward = vec3_add(view.forward, aside);
    return view;
}

/* Writes the sum of two textures times their weights. */
static void combine(const Sums *self, unsigned to, unsigned first, float weight, unsigned second, float other_weight) {
    glBindFramebuffer(GL_FRAMEBUFFER, to);
    glUniform2f(self->weights, weight, other_weight);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, second);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, first);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

static void swap(unsigned *a, unsigned *b) {
    const unsigned t = *a;
    *a = *b;
    *b = t;
}

/* Adds the frame to the sum. */
static void add_frame(Sums *self) {
    if (self->count > NEXT) {
        combine(self, self->framebuffers[NEXT], self->textures[SUM], 1.0f, self->frame.mean, 1.0f);
        swap(&self->framebuffers[SUM], &self->framebuffers[NEXT]);
        swap(&self->textures[SUM], &self->textures[NEXT]);
        return;
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    combine(self, self->framebuffers[SUM], self->frame.mean, 1.0f, self->frame.mean, 0.0f);
    glDisable(GL_BLEND);
}

void sums_add(Sums *self, const Target *picture) {
    const float n = (float)++self->done, left = 1.0f - 4.0f * n / (float)self->frames;
    const float most = self->view.bounces ? SUMS_START_BOUNCED : SUMS_START;
    const float start = self->starts && left > 0.0f ? most * left : 0.0f;
    self->row = 0;
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glViewport(0, 0, self->width, self->height);
    glUseProgram(self->program);
    add_frame(self);
    combine(self, picture->resolved, self->textures[SUM], 1.0f / (n + start), self->textures[START],
            start / (n + start));
}

void sums_destroy(Sums *self) {
    if (self->width) free_targets(self);
    glDeleteProgram(self->program);
    *self = (Sums){0};
}
