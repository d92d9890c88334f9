#include "raster/light/gl_environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/cache.h"
#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "image/half.h"
#include "raster/gl/gl_check.h"
#include "raster/gl/program.h"
#include "raster/light/merged_lights.h"
#include "scene/light/backdrop.h"

/* Raised whenever the same pixels would give other cubes. */
enum { FILTER = 3 };

enum {
    ENVIRONMENT_TEXELS = 6 * (256 * 256 + 128 * 128 + 64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4)
}; /* of the cube */
enum { SOURCE_WIDTH = 512, SOURCE_LEVELS = 5 };

/* Degree 3 of irradiance is nothing and not sent. */
enum { IRRADIANCE_TERMS = 18, DEGREE_3 = 9, DEGREE_4 = 16 };

/* The block Environment, as the shader has it. */
typedef struct Block {
    float place[4], parts[4], terms[IRRADIANCE_TERMS][4], residual[AMBIENT_RESIDUAL_TERMS][4],
        env_lights[2 * AMBIENT_LIGHTS_MAX][4], points[2 * AMBIENT_POINTS_MAX][4], merged[2 * MERGED_LIGHTS][4],
        merged_of[MERGED_LIGHTS][MERGED_OF], merged_count[4];
} Block;

/* One level of a cube, and its source. */
typedef struct Level {
    int level, side;
    int source; /* level of the source texture */
    float kappa;
} Level;

/* Returns level k. The texels of its source are about 0.7 of the filter's width 1 / sqrt(kappa): a sum over such steps
 * is within far less than 1e-6 of the integral (Poisson's formula), and `sharpened` corrects kappa for their blur. */
static Level level_at(int k) {
    int source = k < SOURCE_LEVELS ? k : SOURCE_LEVELS - 1;
    return (Level){k, ENVIRONMENT_SIDE >> k, source, ldexpf(ENVIRONMENT_KAPPA, -2 * k)};
}

/* Returns the kappa to filter by, so that a look-up has the level's kappa: a source texel of height a is a box of
 * variance a^2 / 12 along each axis, and interpolation between texels a distance b apart a tent of variance b^2 / 6; on
 * a face of n by n the mean of b^2 is 4 pi / (6 n^2). */
static float sharpened(const Level *level) {
    float a = 2.0f * PI_FLOAT / (float)(SOURCE_WIDTH >> level->source);
    float b2 = 4.0f * PI_FLOAT / (6.0f * (float)(level->side * level->side));
    return 1.0f / (1.0f / level->kappa - a * a / 12.0f - b2 / 6.0f);
}

static size_t level_texels(const Level *level) { return 6 * (size_t)level->side * (size_t)level->side; }

/* Axes of the faces in the order of the driver: towards the right, down, and out. */
static const float faces[6][9] = {{0, 0, -1, 0, -1, 0, 1, 0, 0}, {0, 0, 1, 0, -1, 0, -1, 0, 0},
                                  {1, 0, 0, 0, 0, 1, 0, 1, 0},   {1, 0, 0, 0, 0, -1, 0, -1, 0},
                                  {1, 0, 0, 0, -1, 0, 0, 0, 1},  {-1, 0, 0, 0, -1, 0, 0, 0, -1}};

/* Returns true if no texel is negative, infinite or no number. */
static bool is_sound(const uint16_t *texels) {
    bool sound = true;
    for (size_t k = 0; k < 3 * (size_t)ENVIRONMENT_TEXELS; k++) sound = sound && texels[k] <= 0x7bffu;
    return sound;
}

/* Returns a hash of everything that the cube depends on: the pixels, or the colour; and the filter. */
static uint64_t cube_key(const Environment *e) {
    const int sizes[] = {FILTER, (int)e->kind == ENVIRONMENT_CONSTANT, e->image.width, e->image.height,
                         e->image.channels};
    uint64_t hash = cache_hash(CACHE_HASH, sizes, sizeof sizes);
    if (e->kind == ENVIRONMENT_CONSTANT) return cache_hash(hash, e->color, sizeof e->color);
    return cache_hash(hash, e->image.pixels,
                      (size_t)e->image.width * (size_t)e->image.height * (size_t)e->image.channels * sizeof(float));
}

static void upload_source(const WeftImage *image, int level) {
    size_t count = (size_t)image->width * (size_t)image->height;
    float *rgba = alloc_array(count, 4 * sizeof *rgba);
    const float *p = image->pixels;
    for (size_t k = 0; rgba && k < count; k++) {
        memcpy(rgba + 4 * k, p + 3 * k, 3 * sizeof *p);
        rgba[4 * k + 3] = 1.0f;
    }
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA32F, image->width, image->height, 0, GL_RGBA, GL_FLOAT, rgba);
    free(rgba);
}

/* Uploads the image with mipmaps, for texelFetch alone. */
static WeftResult make_source(const Environment *e, unsigned *texture, WeftError *error) {
    WeftImage now = {0}, next;
    WeftResult result = WEFT_OK;
    glGenTextures(1, texture);
    glBindTexture(GL_TEXTURE_2D, *texture);
    texture_unfiltered(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, SOURCE_LEVELS - 1);
    for (int level = 0; level < SOURCE_LEVELS && result == WEFT_OK; level++) {
        result =
            latlong_resize(level ? &now : &e->image, SOURCE_WIDTH >> level, SOURCE_WIDTH / 2 >> level, &next, error);
        if (result != WEFT_OK) break;
        weft_image_free(&now);
        now = next;
        upload_source(&now, level);
    }
    weft_image_free(&now);
    return result;
}

static unsigned make_cube(const uint16_t *texels) {
    GLuint cube;
    glGenTextures(1, &cube);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cube);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, ENVIRONMENT_LEVELS - 1);
    uint16_t *rgba = texels ? alloc_array((size_t)ENVIRONMENT_SIDE * ENVIRONMENT_SIDE, 4 * sizeof *rgba) : NULL;
    for (int level = 0; level < ENVIRONMENT_LEVELS; level++)
        for (GLuint face = 0; face < 6; face++) {
            int n = ENVIRONMENT_SIDE >> level;
            for (size_t k = 0; rgba && k < (size_t)n * (size_t)n; k++, texels += 3) {
                memcpy(rgba + 4 * k, texels, 3 * sizeof *texels);
                rgba[4 * k + 3] = 0x3c00; /* 1 */
            }
            glTexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, level, GL_RGBA16F, n, n, 0, GL_RGBA, GL_HALF_FLOAT,
                         rgba);
        }
    free(rgba);
    return cube;
}

/* Uploads the map as 16-bit floats, filtered. */
static WeftResult make_map(const WeftImage *image, unsigned *map, WeftError *error) {
    size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    uint16_t *rgba = alloc_array(count, 4 * sizeof *rgba);
    GLint most = 0;
    if (!rgba) return fail(error, WEFT_MESSAGE_MEMORY, "an environment", NULL);
    const float *p = image->pixels;
    for (size_t k = 0; k < 4 * count; k++) {
        size_t c = k % 4;
        rgba[k] = c == 3 ? (uint16_t)0x3c00 : half_bits(fmaxf(p[k / 4 * channels + (channels >= 3 ? c : 0)], 0.0f));
    }
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    glGenTextures(1, map);
    glBindTexture(GL_TEXTURE_2D, *map);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, image->width, image->height, 0, GL_RGBA, GL_HALF_FLOAT, rgba);
    free(rgba);
    if (image->width > most || image->height > most)
        return fail(error, WEFT_MESSAGE_GL_MEMORY, "an environment", "the driver takes up to %d texels", most);
    return gl_check(error, "an environment");
}

static const char vertex_body[] = "void main() {\n"
                                  "    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));\n"
                                  "    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);\n}\n";

static unsigned make_program(const EnvironmentHow *how, WeftError *error) {
    Text vertex, fragment;
    TextDesc desc = {.language = how->language, .folder = how->folder};
    unsigned program = 0;
    text_begin(&vertex, &desc);
    text_line(&vertex, "%s", vertex_body);
    text_begin(&fragment, &desc);
    text_include(&fragment, "raster/glsl/environment_filter.glsl");
    if (text_end(&vertex, error) == WEFT_OK && text_end(&fragment, error) == WEFT_OK)
        program = program_create("environment filter", (ShaderSource){vertex.bytes, &vertex},
                                 (ShaderSource){fragment.bytes, &fragment}, error);
    text_free(&vertex);
    text_free(&fragment);
    return program;
}

/* Draws one level of the cube, and reads it back into texels, which may be NULL. */
static void filter_level(unsigned program, const Level *level, unsigned cube, unsigned source, uint16_t *texels) {
    float kappa = sharpened(level);
    /* a three-thousandth of the weight is beyond: exp(kappa (cos(reach) - 1)) */
    float least = fmaxf(1.0f - 8.0f / kappa, -1.0f);
    size_t count = (size_t)level->side * (size_t)level->side;
    float *rgba = texels ? alloc_array(count, 4 * sizeof *rgba) : NULL;
    glViewport(0, 0, level->side, level->side);
    glBindTexture(GL_TEXTURE_2D, source);
    glUniform4f(glGetUniformLocation(program, "how"), (float)level->side, (float)level->source, kappa, least);
    glUniform1f(glGetUniformLocation(program, "reach"), acosf(least));
    for (GLuint face = 0; face < 6; face++) {
        glUniformMatrix3fv(glGetUniformLocation(program, "face"), 1, GL_FALSE, faces[face]);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_CUBE_MAP_POSITIVE_X + face, cube,
                               level->level);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        if (!rgba) continue;
        glReadPixels(0, 0, level->side, level->side, GL_RGBA, GL_FLOAT, rgba);
        for (size_t k = 0; k < count; k++)
            for (size_t c = 0; c < 3; c++) *texels++ = half_bits(fmaxf(rgba[4 * k + c], 0.0f));
    }
    free(rgba);
}

static bool stopped(const EnvironmentHow *how, float done) { return how->progress && how->progress(how->user, done); }

/* Draws all levels of the cube, and reads them back into texels, which may be NULL. */
static WeftResult filter_all(const GlEnvironment *self, const EnvironmentHow *how, unsigned source, uint16_t *texels,
                             WeftError *error) {
    GLuint framebuffer, vertices;
    unsigned program = make_program(how, error);
    if (!program) return error ? error->result : WEFT_RESOURCES;
    WeftResult result = WEFT_OK;
    glGenFramebuffers(1, &framebuffer);
    glGenVertexArrays(1, &vertices);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindVertexArray(vertices);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "source"), 0);
    for (int k = 0; k < ENVIRONMENT_LEVELS && result == WEFT_OK; k++) {
        Level level = level_at(k);
        filter_level(program, &level, self->cube, source, texels);
        if (texels) texels += 3 * level_texels(&level);
        glFinish();
        if (stopped(how, 0.2f + 0.75f * (float)(k + 1) / ENVIRONMENT_LEVELS)) result = WEFT_INTERRUPTED;
    }
    if (result == WEFT_OK) result = gl_check(error, "an environment");
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &vertices);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteProgram(program);
    return result;
}

/* Makes an image of one colour. */
static WeftResult constant_image(const float color[3], WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(2, 1, 3, WEFT_PIXEL_F32, out, error);
    for (int k = 0; result == WEFT_OK && k < 6; k++) ((float *)out->pixels)[k] = color[k % 3];
    return result;
}

static WeftResult filter_cube(GlEnvironment *self, const Environment *environment, const EnvironmentHow *how,
                              uint16_t *texels, WeftError *error) {
    Environment copy = *environment;
    unsigned source = 0;
    bool one = copy.kind == ENVIRONMENT_CONSTANT;
    WeftResult result = one ? constant_image(copy.color, &copy.image, error) : WEFT_OK;
    self->cube = make_cube(NULL);
    if (result == WEFT_OK) result = make_source(&copy, &source, error);
    if (one) weft_image_free(&copy.image);
    if (result == WEFT_OK && stopped(how, 0.2f)) result = WEFT_INTERRUPTED;
    if (result == WEFT_OK) result = filter_all(self, how, source, texels, error);
    glDeleteTextures(1, &source);
    return result;
}

static WeftResult find_cube(GlEnvironment *self, const Environment *environment, const EnvironmentHow *how,
                            const WeftLog *log, WeftError *error) {
    uint64_t key = how->no_cache ? 0 : cube_key(environment);
    const size_t size = 3 * (size_t)ENVIRONMENT_TEXELS * sizeof(uint16_t);
    uint16_t *texels = how->no_cache ? NULL : alloc_array(size, 1);
    WeftResult result = WEFT_OK;
    self->cached = texels && cache_find(key, "env", texels, size, log) && is_sound(texels);
    if (self->cached) {
        self->cube = make_cube(texels);
        result = gl_check(error, "an environment");
    } else {
        result = filter_cube(self, environment, how, texels, error);
        if (result == WEFT_OK && texels) cache_keep(key, "env", texels, size, log);
    }
    free(texels);
    return result;
}

/* Writes two vectors: direction and x, color and 0. */
static void put_light(float to[2][4], Vec3 direction, float x, const float color[3]) {
    const float numbers[8] = {direction.x, direction.y, direction.z, x, color[0], color[1], color[2], 0.0f};
    memcpy(to, numbers, sizeof numbers);
}

/* Writes the lights of a moving picture. */
static void put_merged(const AmbientParts *parts, Block *block) {
    MergedLight merged[MERGED_LIGHTS];
    const int count = merged_lights(parts, merged);
    for (int k = 0; k < count; k++) {
        const EnvLight *light = &merged[k].light;
        put_light(&block->merged[2 * k], light->direction, env_light_density(light), light->color);
        memcpy(block->merged_of[k], merged[k].of, sizeof merged[k].of);
    }
    block->merged_count[0] = (float)count;
}

static void make_buffer(GlEnvironment *self) {
    Block block = {.place = {0}}; /* and parts: environment_place */
    for (int k = 0; k < IRRADIANCE_TERMS; k++)
        memcpy(block.terms[k], self->parts.terms[k < DEGREE_3 ? k : k - DEGREE_3 + DEGREE_4], 3 * sizeof(float));
    for (int k = 0; k < AMBIENT_RESIDUAL_TERMS; k++)
        memcpy(block.residual[k], self->parts.residual_sh[k], 3 * sizeof(float));
    for (int k = 0; k < self->parts.env_light_count; k++) {
        const EnvLight *light = &self->parts.env_lights[k];
        put_light(&block.env_lights[2 * k], light->direction, env_light_density(light), light->color);
    }
    for (int k = 0; k < self->parts.point_count; k++) {
        const EnvPoint *point = &self->parts.points[k];
        put_light(&block.points[2 * k], point->direction, (float)point->light, point->color);
    }
    put_merged(&self->parts, &block);
    block.terms[0][3] = self->parts.env_light_kappa;
    glGenBuffers(1, &self->buffer);
    glBindBuffer(GL_UNIFORM_BUFFER, self->buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STATIC_DRAW);
}

WeftResult environment_create(const Environment *environment, const EnvironmentHow *how, GlEnvironment *out,
                              const WeftLog *log, WeftError *error) {
    int env_lights = how->env_lights ? how->env_lights > 0 ? how->env_lights : 0 : AMBIENT_LIGHTS;
    WeftError local = {0};
    *out = (GlEnvironment){0};
    glActiveTexture(GL_TEXTURE0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (epoxy_is_desktop_gl()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    WeftResult result = ambient_split(environment, env_lights, &out->parts, &local);
    if (result == WEFT_OK && stopped(how, 0.1f)) result = WEFT_INTERRUPTED;
    if (result == WEFT_OK) result = find_cube(out, environment, how, log, &local);
    if (result == WEFT_OK && environment->kind != ENVIRONMENT_CONSTANT)
        result = make_map(&environment->image, &out->map, &local);
    if (result == WEFT_OK) {
        make_buffer(out);
        environment_place(out, environment);
        result = gl_check(&local, "an environment");
    }
    if (result == WEFT_OK) return WEFT_OK;
    environment_destroy(out);
    if (error) *error = local;
    return result;
}

WeftResult environment_blur(GlEnvironment *self, const Environment *environment, WeftError *error) {
    WeftImage image;
    if (self->blurred) return WEFT_OK;
    WeftResult result = backdrop_blurred(environment, &image, error);
    if (result == WEFT_OK) result = make_map(&image, &self->blurred, error);
    weft_image_free(&image);
    return result;
}

void environment_destroy(GlEnvironment *self) {
    glDeleteTextures(1, &self->cube);
    glDeleteTextures(1, &self->map);
    glDeleteTextures(1, &self->blurred);
    glDeleteBuffers(1, &self->buffer);
    *self = (GlEnvironment){0};
}

void environment_place(const GlEnvironment *self, const Environment *e) {
    const float env_lights = (float)self->parts.env_light_count;
    const float place[2][4] = {{cosf(e->rotation), sinf(e->rotation), e->strength, env_lights},
                               {e->ambient, e->reflection, (float)self->parts.point_count}};
    glBindBuffer(GL_UNIFORM_BUFFER, self->buffer);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof place, place);
}

int environment_lights(const GlEnvironment *self, float rotation, EnvLight env_lights[AMBIENT_LIGHTS_MAX]) {
    for (int k = 0; k < self->parts.env_light_count; k++) {
        env_lights[k] = self->parts.env_lights[k];
        env_lights[k].direction = latlong_rotated(env_lights[k].direction, rotation);
    }
    return self->parts.env_light_count;
}

int environment_points(const GlEnvironment *self, float rotation, EnvPoint env_points[AMBIENT_POINTS_MAX]) {
    for (int k = 0; k < self->parts.point_count; k++) {
        env_points[k] = self->parts.points[k];
        env_points[k].direction = latlong_rotated(env_points[k].direction, rotation);
    }
    return self->parts.point_count;
}

void environment_text(Text *text) {
    text_provide(text, "shading/ambient/ambient_source.h");
    text_define(text, "AmbientSource", "Frame");
    text_include(text, "raster/glsl/environment.glsl");
}

void environment_program(unsigned program, int cube, int block) {
    GLint previous, at;
    GLuint index = glGetUniformBlockIndex(program, "Environment");
    glGetIntegerv(GL_CURRENT_PROGRAM, &previous);
    glUseProgram(program);
    if ((at = glGetUniformLocation(program, "environment_cube")) >= 0) glUniform1i(at, cube);
    if (index != GL_INVALID_INDEX) glUniformBlockBinding(program, index, (GLuint)block);
    glUseProgram((GLuint)previous);
}

void environment_bind(const GlEnvironment *self, int cube, int block) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)cube);
    glBindTexture(GL_TEXTURE_CUBE_MAP, self->cube);
    glBindBufferBase(GL_UNIFORM_BUFFER, (GLuint)block, self->buffer);
    glActiveTexture(GL_TEXTURE0);
}
