#include "raster/gl/target.h"

#include <epoxy/gl.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "raster/gl/gl_check.h"

#include <stdlib.h>

/* Returns the wanted number of samples, or the most that the driver has. */
static int available_samples(int wanted) {
    GLint most = 1;
    glGetInternalformativ(GL_RENDERBUFFER, GL_RGBA16F, GL_SAMPLES, 1, &most); /* the most come first */
    return wanted < most ? wanted : most > 1 ? most : 1;
}

static void make_mean(Target *self) {
    glGenTextures(1, &self->mean);
    glBindTexture(GL_TEXTURE_2D, self->mean);
    texture_unfiltered(GL_TEXTURE_2D);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, self->width, self->height, 0, GL_RGBA, GL_HALF_FLOAT, NULL);
    glGenFramebuffers(1, &self->resolved);
    glBindFramebuffer(GL_FRAMEBUFFER, self->resolved);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->mean, 0);
}

static void make_drawn(Target *self) {
    int samples = self->samples > 1 ? self->samples : 0;
    if (samples) {
        glGenFramebuffers(1, &self->drawn);
        glBindFramebuffer(GL_FRAMEBUFFER, self->drawn);
        glGenRenderbuffers(1, &self->color);
        glBindRenderbuffer(GL_RENDERBUFFER, self->color);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA16F, self->width, self->height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, self->color);
    } else {
        self->drawn = self->resolved;
    }
    glGenRenderbuffers(1, &self->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, self->depth);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT32F, self->width, self->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, self->depth);
}

WeftResult target_resize(Target *self, int width, int height, int samples, WeftError *error) {
    samples = samples > 1 ? available_samples(samples) : 1;
    if (self->drawn && self->width == width && self->height == height && self->samples == samples) return WEFT_OK;
    target_destroy(self);
    *self = (Target){.width = width, .height = height, .samples = samples};
    make_mean(self);
    make_drawn(self);
    WeftResult result = gl_check(error, "a picture");
    GLenum status = result == WEFT_OK ? glCheckFramebufferStatus(GL_FRAMEBUFFER) : GL_FRAMEBUFFER_COMPLETE;
    if (status != GL_FRAMEBUFFER_COMPLETE)
        result = fail(error, WEFT_MESSAGE_GL_CONTEXT, "a picture of 16-bit floats", "driver error 0x%x", status);
    if (result != WEFT_OK) target_destroy(self);
    return result;
}

void target_destroy(Target *self) {
    if (self->drawn != self->resolved) glDeleteFramebuffers(1, &self->drawn);
    glDeleteFramebuffers(1, &self->resolved);
    glDeleteRenderbuffers(1, &self->color);
    glDeleteRenderbuffers(1, &self->depth);
    glDeleteTextures(1, &self->mean);
    *self = (Target){0};
}

void target_keep_mean(Target *self) {
    if (self->drawn == self->resolved) {
        glBindFramebuffer(GL_FRAMEBUFFER, self->resolved);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, 0);
    } else {
        glDeleteFramebuffers(1, &self->drawn);
    }
    glDeleteRenderbuffers(1, &self->color);
    glDeleteRenderbuffers(1, &self->depth);
    self->drawn = self->color = self->depth = 0;
}

void target_resolve(const Target *self, const int box[4]) {
    if (self->drawn == self->resolved) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, self->drawn);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, self->resolved);
    int right = box[0] + box[2], top = box[1] + box[3];
    glBlitFramebuffer(box[0], box[1], right, top, box[0], box[1], right, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

/* Flips the rows, which the driver has from the bottom. */
static void put_upright(float *pixels, int width, int height) {
    size_t row = 4 * (size_t)width;
    for (int y = 0; y < height / 2; y++) {
        float *a = pixels + (size_t)y * row, *b = pixels + (size_t)(height - 1 - y) * row;
        for (size_t k = 0; k < row; k++) {
            float t = a[k];
            a[k] = b[k];
            b[k] = t;
        }
    }
}

WeftResult target_read(const Target *self, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(self->width, self->height, 4, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *pixels = out->pixels;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, self->resolved);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, self->width, self->height, GL_RGBA, GL_FLOAT, pixels);
    result = gl_check(error, "reading a picture");
    if (result != WEFT_OK) {
        weft_image_free(out);
        return result;
    }
    put_upright(pixels, self->width, self->height);
    for (size_t k = 0; k < (size_t)self->width * (size_t)self->height; k++, pixels += 4) {
        float alpha = pixels[3];
        for (int c = 0; c < 3; c++) pixels[c] = alpha > 0.0f ? pixels[c] / alpha : 0.0f;
    }
    return WEFT_OK;
}
