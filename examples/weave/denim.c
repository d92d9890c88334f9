/* A program of one's own with OpenGL: woven denim from near and from afar, by the text and the tables that weft made of it
 * when this was built.
 *
 *     denim OUT.png [POINTS]
 *
 * Each pixel has one point, or the mean of so many. The program needs no window: EGL gives a context by itself. */
#include <stdio.h>
#include <stdlib.h>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <weft/weft.h>

#include "denim.weft_texels_albedos.h"
#include "denim.weft_texels_colors.h"
#include "denim.weft_texels_runs.h"

enum { WIDTH = 640, HEIGHT = 240 };

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

/* Adds a shader of the texts of two files to a program; the first may be "". */
static int shader_add(GLuint program, GLenum kind, const char *before, const char *path) {
    GLint compiled = 0;
    char log[1024], *texts[2] = {*before ? text_read(before) : calloc(1, 1), text_read(path)};
    const char *all[3] = {"#version 330 core\n", texts[0] ? texts[0] : "", texts[1] ? texts[1] : ""};
    GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 3, all, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!compiled) fprintf(stderr, "%s: %s\n", path, log);
    glAttachShader(program, shader);
    free(texts[0]);
    free(texts[1]);
    return compiled;
}

/* Puts a table at a texture unit: the text fetches its texels one by one. */
static void table_put(GLuint program, GLint unit, const char *name, const float *texels, int width, int height) {
    GLuint texture;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, width, height, 0, GL_RED, GL_FLOAT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glUniform1i(glGetUniformLocation(program, name), unit);
}

#define TABLE_PUT(program, unit, name)                                                                                 \
    table_put(program, unit, "weft_texels_" #name, table_denim_weft_texels_##name,                                     \
              table_denim_weft_texels_##name##_width, table_denim_weft_texels_##name##_height)

static int picture_make(WeftImage *image, int points) {
    GLint linked = 0;
    GLuint buffer, target, vertices;
    if (!context_make()) return 0;
    GLuint program = glCreateProgram();
    if (!shader_add(program, GL_VERTEX_SHADER, "", TEXT "/denim.vert") ||
        !shader_add(program, GL_FRAGMENT_SHADER, MADE "/denim.glsl", TEXT "/denim.frag"))
        return 0;
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) return 0;
    glUseProgram(program);
    TABLE_PUT(program, 0, runs);
    TABLE_PUT(program, 1, albedos);
    TABLE_PUT(program, 2, colors);
    glUniform2f(glGetUniformLocation(program, "size"), WIDTH, HEIGHT);
    glUniform1i(glGetUniformLocation(program, "points"), points);

    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, WIDTH, HEIGHT);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glViewport(0, 0, WIDTH, HEIGHT);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    for (int y = 0; y < HEIGHT; y++) /* rows from the top, as weft has them */
        glReadPixels(0, HEIGHT - 1 - y, WIDTH, 1, GL_RGB, GL_FLOAT, (float *)image->pixels + 3 * WIDTH * y);
    return glGetError() == GL_NO_ERROR;
}

int main(int count, char **arguments) {
    WeftImage linear = {0}, shown = {0};
    WeftError error = {.result = WEFT_USAGE, .text = "denim OUT.png [POINTS, 1 to 256]"};
    const int points = count > 2 ? atoi(arguments[2]) : 1;
    if (count > 1 && points >= 1 && points <= 256 &&
        weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &linear, &error) == WEFT_OK) {
        error = (WeftError){.result = WEFT_RESOURCES, .text = "OpenGL gave up"};
        if (picture_make(&linear, points) &&
            weft_image_tonemap(&linear, WEFT_TONEMAP_PBR_NEUTRAL, 0.7f, &shown, &error) == WEFT_OK &&
            weft_image_write(arguments[1], &shown, &error) == WEFT_OK)
            error.result = WEFT_OK;
    }
    if (error.result != WEFT_OK) fprintf(stderr, "denim: %s\n", error.text);
    weft_image_free(&linear);
    weft_image_free(&shown);
    return (int)error.result;
}
