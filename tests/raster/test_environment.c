/* The environment on the GPU: cubes beside sums over all texels, in both languages; terms, lights and
 * rotation; the cache; the whole of shading/ambient/ambient.h beside C; and how many samplers that takes */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "raster/gl/context.h"
#include "raster/gl/program.h"
#include "raster/light/gl_environment.h"
#include "raster/material/gl_tables.h"
#include "shading/ambient/ambient.h"
#include "shading/ambient/ambient_fit.h"
#include "shading/material/material_stack.h"
#include "text/assemble/dispatch.h"

enum { POINTS = 256, MAP_WIDTH = 128, MAP_HEIGHT = 64 };

static const TextLanguage languages[] = {TEXT_GLSL_330, TEXT_GLSL_ES_300};
enum { LANGUAGES = 2 };

/* A dim sky, a bright box and a small light, in different colours. */
static Environment sharp_environment(void) {
    Environment e = {.kind = ENVIRONMENT_IMAGE, .rotation = 0.7f, .strength = 2.0f};
    assert_int_equal(weft_image_create(MAP_WIDTH, MAP_HEIGHT, 3, WEFT_PIXEL_F32, &e.image, NULL), WEFT_OK);
    float *p = e.image.pixels;
    for (int y = 0; y < MAP_HEIGHT; y++)
        for (int x = 0; x < MAP_WIDTH; x++, p += 3) {
            bool box = x > 20 && x < 32 && y > 12 && y<24, light = x> 90 && x < 94 && y > 28 && y < 31;
            float sky = 0.2f + 0.3f * (float)(MAP_HEIGHT - y) / MAP_HEIGHT;
            p[0] = sky + (box ? 6.0f : 0.0f) + (light ? 60.0f : 0.0f);
            p[1] = sky + (box ? 5.0f : 0.0f) + (light ? 40.0f : 0.0f);
            p[2] = 1.2f * sky + (box ? 4.0f : 0.0f) + (light ? 20.0f : 0.0f);
        }
    return e;
}

/* Direction k of a spiral, as the shader has it too. */
static Vec3 point(int k) {
    float y = 1.0f - 2.0f * ((float)k + 0.5f) / POINTS, s = sqrtf(1.0f - y * y), a = 2.39996323f * (float)k;
    return vec3(s * cosf(a), y, s * sinf(a));
}

/* Into the image, as trace/light/sky.h has it. */
static Vec3 turned(const Environment *e, Vec3 d) {
    float c = cosf(e->rotation), s = sinf(e->rotation);
    return vec3(d.x * c - d.z * s, d.y, d.x * s + d.z * c);
}

/* Mean over all texels, each split into 4 by 4, by a weight of the cosine to d. */
static void brute(const Environment *e, Vec3 d, float kappa, double mean[3]) {
    enum { WIDTH = 4 * MAP_WIDTH, HEIGHT = 4 * MAP_HEIGHT };
    static Vec3 directions[WIDTH * HEIGHT];
    double sum = 0.0;
    Vec3 n = turned(e, d);
    if (directions[0].y < 0.5f)
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            directions[k] = latlong_direction((k % WIDTH + 0.5) / WIDTH, (k / WIDTH + 0.5) / HEIGHT);
    mean[0] = mean[1] = mean[2] = 0.0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        float mu = vec3_dot(n, directions[k]), rest = kappa * (mu - 1.0f), y = directions[k].y;
        if (kappa > 0.0f ? rest < -16.0f : mu <= 0.0f) continue;
        double w = kappa > 0.0f ? (exp)((double)rest) : (double)mu;
        const float *p = (const float *)e->image.pixels + 3 * (k / WIDTH / 4 * MAP_WIDTH + k % WIDTH / 4);
        w *= (double)sqrtf(1.0f - y * y);
        sum += w;
        for (int c = 0; c < 3; c++) mean[c] += w * (double)(p[c] * e->strength);
    }
    for (int c = 0; c < 3; c++) mean[c] /= sum;
}

static GlContext *context_or_skip(TextLanguage language) {
    GlContext *context;
    WeftError error = {0};
    if (context_create(language, &context, &error) == WEFT_OK) return context;
    assert_int_equal(error.message, WEFT_MESSAGE_GL_CONTEXT);
    print_message("%s\n", error.text);
    skip();
    return NULL;
}

enum { CUBE = 3, TABLES = 5, BLOCK = 2 };

/* Runs `lines`, which set vec3 c from Dir d and Frame f, at every point; returns the number of samplers. */
static int draw(TextLanguage language, const GlEnvironment *env, Text *text, const char *lines, unsigned tables,
                float out[POINTS][4]) {
    char vertex[512];
    WeftError error = {0};
    GLuint target, framebuffer, vertices;
    snprintf(vertex, sizeof vertex,
             "%s\nvoid main() { vec2 c = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));\n"
             "gl_Position = vec4(c * 2.0 - 1.0, 0.0, 1.0); }\n",
             language == TEXT_GLSL_ES_300 ? "#version 300 es" : "#version 330 core");
    text_line(text, "out highp vec4 fragment;\nvoid main() {\n    float k = floor(gl_FragCoord.x);");
    text_line(text, "    float y = 1.0 - 2.0 * (k + 0.5) / %d.0, s = sqrt(1.0 - y * y), a = 2.39996323 * k;", POINTS);
    text_line(text, "    Frame f;\n    f.x = dir(1.0, 0.0, 0.0);\n    f.y = dir(0.0, 1.0, 0.0);\n    f.z = dir(0.0, "
                    "0.0, 1.0);\n    Dir d = dir(s * cos(a), y, s * sin(a));\n    vec3 c = vec3(0.0);");
    text_line(text, "%s\n    fragment = vec4(c, 1.0);\n}", lines);
    if (text_end(text, &error) != WEFT_OK) fail_msg("%s", error.text);
    GLuint program = program_create("a test", (ShaderSource){vertex, NULL}, (ShaderSource){text->bytes, text}, &error);
    if (!program) fail_msg("%s\n%s", error.text, text->bytes);
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, POINTS, 1, 0, GL_RGBA, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    glViewport(0, 0, POINTS, 1);
    environment_program(program, CUBE, BLOCK);
    environment_bind(env, CUBE, BLOCK);
    glUseProgram(program);
    if (tables) {
        glActiveTexture(GL_TEXTURE0 + TABLES);
        glBindTexture(GL_TEXTURE_2D_ARRAY, tables);
        glActiveTexture(GL_TEXTURE0);
        glUniform1i(glGetUniformLocation(program, "weft_tables"), TABLES);
    }
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, POINTS, 1, GL_RGBA, GL_FLOAT, out);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    GLint uniforms = 0, samplers = 0;
    glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &uniforms);
    for (GLint k = 0; k < uniforms; k++) {
        GLint size;
        GLenum type;
        char name[64];
        glGetActiveUniform(program, (GLuint)k, sizeof name, NULL, &size, &type, name);
        samplers += type == GL_SAMPLER_CUBE || type == GL_SAMPLER_2D_ARRAY ? size : 0;
    }
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteProgram(program);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &target);
    glDeleteVertexArrays(1, &vertices);
    return samplers;
}

static void make(TextLanguage language, const Environment *e, bool no_cache, int env_lights, GlEnvironment *env) {
    WeftError error = {0};
    EnvironmentHow how = {.language = language, .no_cache = no_cache, .env_lights = env_lights};
    if (environment_create(e, &how, env, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static void begin(Text *text, TextLanguage language) {
    text_begin(text, &(TextDesc){.language = language, .tables = true});
    environment_text(text);
}

static void look_ups_are_sums(TextLanguage language) {
    GlContext *context = context_or_skip(language);
    GlOuter outer;
    assert_true(context_enter(context, &outer));
    Environment e = sharp_environment();
    GlEnvironment env;
    make(language, &e, true, 0, &env);
    const float kappas[] = {3200.0f, 800.0f, 200.0f, 50.0f, 12.5f, 3.125f, 0.78125f, 0.0f};
    for (size_t k = 0; k < sizeof kappas / sizeof kappas[0]; k++) {
        static float out[POINTS][4];
        char lines[128];
        double off = 0.0, all = 0.0;
        Text text;
        begin(&text, language);
        snprintf(lines, sizeof lines,
                 kappas[k] > 0.0f ? "Rgb l = ambient_radiance(f, d, %.6f); c = vec3(l.r, l.g, l.b);"
                                  : "Rgb l = ambient_irradiance(f, d); c = vec3(l.r, l.g, l.b);",
                 (double)kappas[k]);
        draw(language, &env, &text, lines, 0, out);
        text_free(&text);
        for (int n = 0; n<POINTS; n += kappas[k]> 100.0f ? 1 : 8) {
            double mean[3];
            brute(&e, point(n), kappas[k], mean);
            for (int c = 0; c < 3; c++) {
                off += fabs((double)out[n][c] - mean[c]);
                all += mean[c];
            }
        }
        print_message("kappa %g: %.2f %%\n", (double)kappas[k], 100.0 * off / all);
        /* the light is two and a half texels of the finest level wide, a delta to it */
        assert_true(off / all < (kappas[k] > 1000.0f ? 0.03 : kappas[k] > 0.0f ? 0.01 : 0.015));
    }
    environment_destroy(&env);
    weft_image_free(&e.image);
    context_leave(context, &outer);
    context_destroy(context);
}

/* Compares the residual of a shader with that of C. */
static void rest_is_that_of_c(TextLanguage language) {
    GlContext *context = context_or_skip(language);
    GlOuter outer;
    assert_true(context_enter(context, &outer));
    Environment e = sharp_environment();
    GlEnvironment env;
    make(language, &e, true, 0, &env);
    const float kappas[] = {0.0f, 0.5f, 3.125f, 12.5f, 150.0f};
    for (size_t k = 0; k < sizeof kappas / sizeof kappas[0]; k++) {
        static float out[POINTS][4];
        char lines[128];
        Text text;
        begin(&text, language);
        snprintf(lines, sizeof lines, "Rgb l = ambient_residual(f, d, %.6f); c = vec3(l.r, l.g, l.b);",
                 (double)kappas[k]);
        draw(language, &env, &text, lines, 0, out);
        text_free(&text);
        for (int n = 0; n < POINTS; n++) {
            float c[3];
            ambient_rest_about(&env.parts, turned(&e, point(n)), kappas[k], c);
            for (int j = 0; j < 3; j++) {
                assert_true(c[j] > 0.05f);
                assert_float_equal(out[n][j], e.strength * c[j], 2e-4f * e.strength * c[j]);
            }
        }
    }
    environment_destroy(&env);
    weft_image_free(&e.image);
    context_leave(context, &outer);
    context_destroy(context);
}

static void residual_is_that_of_c(void **state) {
    (void)state;
    for (int k = 0; k < LANGUAGES; k++) rest_is_that_of_c(languages[k]);
}

static void environment_lookups_are_sums_of_texels(void **state) {
    (void)state;
    for (int k = 0; k < LANGUAGES; k++) look_ups_are_sums(languages[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(environment_lookups_are_sums_of_texels),
                                       cmocka_unit_test(residual_is_that_of_c)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
