/* A program of one's own with OpenGL: velvet under a rectangular lamp, with the text and the tables that weft
 * made for it when this was built.
 *
 *     velvet OUT.png [POINTS]
 *
 * It needs no window: EGL gives a context by itself. With POINTS the lamp is that many points times that
 * many, each through the exported lobe, which is slow and right: so one sees what the tables are worth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <weft/weft.h>

#include "albedo.h"
#include "amplitude.h"
#include "ltc.h"

enum { WIDTH = 640, HEIGHT = 400, CELLS = 256, SAMPLES = 4 };

static const float eye[3] = {0.5f, 1.9f, 4.3f}, target[3] = {0, 0.22f, 0};
static const float lamp[4][3] = {
    {-1.7f, 0.3f, -0.6f}, {-0.7f, 0.3f, -1.5f}, {-0.7f, 1.1f, -1.5f}, {-1.7f, 1.1f, -0.6f}};

static int context_make(void) {
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    static const EGLint wished[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) return 0;
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wished);
    return context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
}

/* The text of a file, released with free(); NULL where there is none. */
static char *text_read(const char *path) {
    FILE *file = fopen(path, "rb");
    char *text = file ? calloc(1, 1 << 20) : NULL;
    if (text) text[fread(text, 1, (1 << 20) - 1, file)] = '\0';
    if (file) fclose(file);
    return text;
}

/* A shader of the texts of two files, the first of which may be NULL. */
static GLuint shader_make(GLenum kind, const char *before, const char *path) {
    GLint compiled = 0;
    char log[1024], *texts[2] = {before ? text_read(before) : calloc(1, 1), text_read(path)};
    const char *all[3] = {"#version 330 core\n", texts[0] ? texts[0] : "", texts[1] ? texts[1] : ""};
    GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 3, all, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!compiled) fprintf(stderr, "%s: %s\n", path, log);
    free(texts[0]);
    free(texts[1]);
    return compiled ? shader : 0;
}

static GLuint program_make(void) {
    GLint linked = 0;
    GLuint program = glCreateProgram(), vertex = shader_make(GL_VERTEX_SHADER, NULL, TEXT "/velvet.vert"),
           fragment = shader_make(GL_FRAGMENT_SHADER, MADE "/sheen.glsl", TEXT "/velvet.frag");
    if (!vertex || !fragment) return 0;
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked ? program : 0;
}

/* Puts a table of weft's at a texture unit: floats as they are, filtered between texel centres. */
static void table_put(GLuint program, int unit, const char *name, const float *texels, int width, int height,
                      int channels) {
    static const GLenum formats[] = {0, GL_RED, GL_RG, GL_RGB, GL_RGBA};
    static const GLint stored[] = {0, GL_R32F, GL_RG32F, GL_RGB32F, GL_RGBA32F};
    GLuint texture;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, stored[channels], width, height, 0, formats[channels], GL_FLOAT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glUniform1i(glGetUniformLocation(program, name), unit);
}

static void unit_of(float v[3]) {
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) v[k] /= length;
}

/* What the camera does to a point, column after column: it looks from eye to target, +y up, 28 degrees high.
 */
static void camera_make(float m[16]) {
    const float focal = 1 / tanf(14 * 3.14159265f / 180), near = 0.1f, far = 20, *e = eye;
    float z[3] = {e[0] - target[0], e[1] - target[1], e[2] - target[2]};
    unit_of(z);
    float x[3] = {z[2], 0, -z[0]};
    unit_of(x);
    float y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
    const float a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    float moved[3] = {0};
    for (int k = 0; k < 3; k++) {
        moved[0] -= x[k] * e[k], moved[1] -= y[k] * e[k], moved[2] -= z[k] * e[k];
        m[4 * k] = x[k] * focal * HEIGHT / WIDTH, m[4 * k + 1] = y[k] * focal;
        m[4 * k + 2] = z[k] * a, m[4 * k + 3] = -z[k];
    }
    m[12] = moved[0] * focal * HEIGHT / WIDTH, m[13] = moved[1] * focal;
    m[14] = moved[2] * a + b, m[15] = -moved[2];
}

/* A target of floats, with several samples a pixel or one. */
static GLuint target_make(int samples) {
    GLuint buffers[2], made;
    glGenFramebuffers(1, &made);
    glBindFramebuffer(GL_FRAMEBUFFER, made);
    glGenRenderbuffers(2, buffers);
    static const GLenum kinds[2] = {GL_RGBA32F, GL_DEPTH_COMPONENT24};
    static const GLenum places[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int k = 0; k < 2; k++) {
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[k]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, kinds[k], WIDTH, HEIGHT);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, places[k], GL_RENDERBUFFER, buffers[k]);
    }
    return made;
}

static void draw(GLuint program, int points) {
    float camera[16];
    GLuint vertices;
    camera_make(camera);
    glUniformMatrix4fv(glGetUniformLocation(program, "camera"), 1, GL_FALSE, camera);
    glUniform1i(glGetUniformLocation(program, "cells"), CELLS);
    glUniform1i(glGetUniformLocation(program, "points"), points);
    glUniform3fv(glGetUniformLocation(program, "eye"), 1, eye);
    glUniform3fv(glGetUniformLocation(program, "lamp"), 4, lamp[0]);
    glUniform3f(glGetUniformLocation(program, "lamp_light"), 10, 8.8f, 7.5f);
    glUniform3f(glGetUniformLocation(program, "sun"), 2, 1.1f, -1.2f);
    glUniform3f(glGetUniformLocation(program, "sun_light"), 0.5f, 0.65f, 1.1f);
    glUniform3f(glGetUniformLocation(program, "base"), 0.1f, 0.008f, 0.02f);
    glUniform3f(glGetUniformLocation(program, "sheen"), 0.85f, 0.16f, 0.22f);
    glUniform1f(glGetUniformLocation(program, "roughness"), 0.5f);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glEnable(GL_DEPTH_TEST);
    glViewport(0, 0, WIDTH, HEIGHT);
    glClearColor(0.02f, 0.022f, 0.026f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawArrays(GL_TRIANGLES, 0, 6 * (CELLS * CELLS + 1));
}

/* Makes one sample a pixel of several, and a picture as weft has them: rows from the top. */
static void picture_read(GLuint many, WeftImage *image) {
    GLuint one = target_make(0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, many);
    glBlitFramebuffer(0, 0, WIDTH, HEIGHT, 0, 0, WIDTH, HEIGHT, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, one);
    for (int y = 0; y < HEIGHT; y++)
        glReadPixels(0, HEIGHT - 1 - y, WIDTH, 1, GL_RGB, GL_FLOAT, (float *)image->pixels + 3 * WIDTH * y);
}

static int picture_make(WeftImage *image, int points) {
    if (!context_make()) {
        fprintf(stderr, "velvet: there is no OpenGL 3.3 without a window\n");
        return 0;
    }
    GLuint program = program_make(), many = target_make(SAMPLES);
    if (!program) return 0;
    glUseProgram(program);
    table_put(program, 0, "ltc", table_ltc, table_ltc_width, table_ltc_height, table_ltc_channels);
    table_put(program, 1, "amplitude", table_amplitude, table_amplitude_width, table_amplitude_height,
              table_amplitude_channels);
    table_put(program, 2, "albedo", table_albedo, table_albedo_width, table_albedo_height, table_albedo_channels);
    draw(program, points);
    picture_read(many, image);
    return glGetError() == GL_NO_ERROR;
}

int main(int count, char **arguments) {
    WeftImage linear = {0}, shown = {0};
    WeftError error = {.result = WEFT_USAGE, .text = "velvet OUT.png [POINTS]"};
    if (count > 1 && weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &linear, &error) == WEFT_OK) {
        error = (WeftError){.result = WEFT_RESOURCES, .text = "OpenGL gave up"};
        if (picture_make(&linear, count > 2 ? atoi(arguments[2]) : 0) &&
            weft_image_tonemap(&linear, WEFT_TONEMAP_PBR_NEUTRAL, 0.7f, &shown, &error) == WEFT_OK &&
            weft_image_write(arguments[1], &shown, &error) == WEFT_OK)
            error.result = WEFT_OK;
    }
    if (error.result != WEFT_OK) fprintf(stderr, "velvet: %s\n", error.text);
    weft_image_free(&linear);
    weft_image_free(&shown);
    return (int)error.result;
}
