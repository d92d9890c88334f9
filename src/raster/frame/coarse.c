#include "raster/frame/coarse.h"

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/gl/gl_check.h"
#include "raster/gl/program.h"

static WeftResult build(Coarse *self, const TextDesc *desc, WeftError *error) {
    static const char *const samplers[] = {"coarse_light", "coarse_polygons", "coarse_guides"};
    const WeftResult result =
        program_on_screen("shadows of a moving picture", "raster/glsl/coarse_filter.glsl", desc, &self->program, error);
    if (result != WEFT_OK) return result;
    glUseProgram(self->program);
    for (int k = 0; k < 3; k++) glUniform1i(glGetUniformLocation(self->program, samplers[k]), k);
    glUniform1i(glGetUniformLocation(self->program, "coarse_side"), COARSE_SIDE);
    return WEFT_OK;
}

static void free_targets(Coarse *self) {
    glDeleteFramebuffers(1, &self->drawn);
    glDeleteFramebuffers(1, &self->smooth);
    glDeleteTextures(COARSE_COUNT, self->textures);
    glDeleteRenderbuffers(1, &self->depth);
    self->width = self->height = 0;
}

static WeftResult make_targets(Coarse *self, WeftError *error) {
    static const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glGenTextures(COARSE_COUNT, self->textures);
    glGenFramebuffers(1, &self->drawn);
    glGenFramebuffers(1, &self->smooth);
    glGenRenderbuffers(1, &self->depth);
    for (int k = 0; k < COARSE_COUNT; k++) {
        glBindTexture(GL_TEXTURE_2D, self->textures[k]);
        texture_unfiltered(GL_TEXTURE_2D);
        const bool packed = k == COARSE_SMOOTH;
        glTexImage2D(GL_TEXTURE_2D, 0, packed ? GL_RGBA32F : GL_RGBA16F, self->width, self->height, 0, GL_RGBA,
                     packed ? GL_FLOAT : GL_HALF_FLOAT, NULL);
        glBindFramebuffer(GL_FRAMEBUFFER, k == COARSE_SMOOTH ? self->smooth : self->drawn);
        glFramebufferTexture2D(GL_FRAMEBUFFER, k == COARSE_SMOOTH ? GL_COLOR_ATTACHMENT0 : buffers[k], GL_TEXTURE_2D,
                               self->textures[k], 0);
    }
    glBindRenderbuffer(GL_RENDERBUFFER, self->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, self->width, self->height);
    glBindFramebuffer(GL_FRAMEBUFFER, self->drawn);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, self->depth);
    glDrawBuffers(3, buffers);
    WeftResult result = gl_check(error, "a moving picture");
    GLenum status = result == WEFT_OK ? glCheckFramebufferStatus(GL_FRAMEBUFFER) : GL_FRAMEBUFFER_COMPLETE;
    if (status == GL_FRAMEBUFFER_COMPLETE && result == WEFT_OK) {
        glBindFramebuffer(GL_FRAMEBUFFER, self->smooth);
        status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    }
    if (status != GL_FRAMEBUFFER_COMPLETE)
        result = fail(error, WEFT_MESSAGE_GL_CONTEXT, "a moving picture", "driver error 0x%x", status);
    return result;
}

WeftResult coarse_begin(Coarse *self, const TextDesc *desc, int width, int height, int rate, WeftError *error) {
    const int columns = (width + rate - 1) / rate, rows = (height + rate - 1) / rate;
    WeftResult result = self->program ? WEFT_OK : build(self, desc, error);
    if (result != WEFT_OK || (self->width == columns && self->height == rows)) return result;
    if (self->width) free_targets(self);
    self->width = columns;
    self->height = rows;
    result = make_targets(self, error);
    if (result != WEFT_OK) free_targets(self);
    return result;
}

static void bind(unsigned texture, int unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, texture);
}

void coarse_filter(const Coarse *self) {
    glBindFramebuffer(GL_FRAMEBUFFER, self->smooth);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glUseProgram(self->program);
    for (int k = COARSE_SMOOTH; k-- > 0;) bind(self->textures[k], k);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEnable(GL_DEPTH_TEST);
}

void coarse_bind(const Coarse *self, int unit) {
    bind(self->textures[COARSE_SMOOTH], unit);
    glActiveTexture(GL_TEXTURE0);
}

void coarse_destroy(Coarse *self) {
    if (self->width) free_targets(self);
    glDeleteProgram(self->program);
    *self = (Coarse){0};
}
