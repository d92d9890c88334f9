#include "scene/light/env_split.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "base/random.h"

enum { SPLIT_WIDTH = 256, ROUNDS = 24, STARTS = 4 };

Vec3 latlong_direction(double u, double v) {
    double phi = (u - 0.5) * 2.0 * PI_DOUBLE, theta = v * PI_DOUBLE;
    return vec3((float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi)));
}

Vec3 latlong_rotated(Vec3 d, float rotation) {
    float c = cosf(rotation), s = sinf(rotation);
    return vec3(d.x * c + d.z * s, d.y, d.z * c - d.x * s);
}

/* Sets the point of the image in a unit direction, u and v in [0, 1]. */
static void latlong_point(Vec3 d, float *u, float *v) {
    *u = 0.5f + atan2f(d.x, -d.z) / (float)(2.0 * PI_DOUBLE);
    *v = acosf(fminf(fmaxf(d.y, -1.0f), 1.0f)) / PI_FLOAT;
}

/* Sets the colour of texel (x, y), not below 0; grey from an image of fewer than three channels. */
static void texel(const WeftImage *image, int x, int y, float color[3]) {
    const float *p =
        (const float *)image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
    for (int c = 0; c < 3; c++) color[c] = fmaxf(p[image->channels >= 3 ? c : 0], 0.0f);
}

void latlong_at(const WeftImage *image, Vec3 d, float color[3]) {
    float u, v;
    latlong_point(d, &u, &v);
    float x = u * (float)image->width - 0.5f, y = v * (float)image->height - 0.5f;
    int x0 = (int)floorf(x), y0 = (int)floorf(y);
    float fx = x - (float)x0, fy = y - (float)y0;
    color[0] = color[1] = color[2] = 0.0f;
    for (int k = 0; k < 4; k++) {
        float c[3], w = (k & 1 ? fx : 1.0f - fx) * (k & 2 ? fy : 1.0f - fy);
        int column = (x0 + (k & 1) + image->width) % image->width, row = y0 + (k >> 1);
        texel(image, column, row < 0 ? 0 : row < image->height ? row : image->height - 1, c);
        for (int j = 0; j < 3; j++) color[j] += w * c[j];
    }
}

static void grow(const WeftImage *image, WeftImage *out) {
    float *p = out->pixels;
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++, p += 3)
            latlong_at(image, latlong_direction((x + 0.5) / out->width, (y + 0.5) / out->height), p);
}

static bool shrink(const WeftImage *image, WeftImage *out) {
    size_t w = (size_t)out->width, h = (size_t)out->height;
    float *solid = alloc_array(w * h, sizeof *solid), *p = out->pixels;
    if (!solid) return false;
    for (int y = 0; y < image->height; y++) {
        float c[3], weight = (float)sin(PI_DOUBLE * (y + 0.5) / image->height);
        size_t row = (size_t)y * h / (size_t)image->height * w;
        for (int x = 0; x < image->width; x++) {
            size_t k = row + (size_t)x * w / (size_t)image->width;
            texel(image, x, y, c);
            for (size_t j = 0; j < 3; j++) p[3 * k + j] += weight * c[j];
            solid[k] += weight;
        }
    }
    for (size_t k = 0; k < 3 * w * h; k++) p[k] /= solid[k / 3];
    free(solid);
    return true;
}

WeftResult latlong_resize(const WeftImage *image, int width, int height, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(width, height, 3, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    if (width > image->width || height > image->height) {
        grow(image, out);
    } else if (!shrink(image, out)) {
        weft_image_free(out);
        return fail(error, WEFT_MESSAGE_MEMORY, "an environment", NULL);
    }
    return WEFT_OK;
}

void ambient_polynomials(Vec3 n, float p[AMBIENT_TERMS]) {
    float x = n.x, y = n.y, z = n.z, x2 = x * x, y2 = y * y, z2 = z * z;
    const float all[AMBIENT_TERMS] = {1.0f,
                                      x,
                                      y,
                                      z,
                                      x * y,
                                      y * z,
                                      z * x,
                                      x2 - y2,
                                      3.0f * z2 - 1.0f,
                                      y * (3.0f * x2 - y2),
                                      x * y * z,
                                      y * (5.0f * z2 - 1.0f),
                                      z * (5.0f * z2 - 3.0f),
                                      x * (5.0f * z2 - 1.0f),
                                      z * (x2 - y2),
                                      x * (x2 - 3.0f * y2),
                                      x * y * (x2 - y2),
                                      y * z * (3.0f * x2 - y2),
                                      x * y * (7.0f * z2 - 1.0f),
                                      y * z * (7.0f * z2 - 3.0f),
                                      z2 * (35.0f * z2 - 30.0f) + 3.0f,
                                      z * x * (7.0f * z2 - 3.0f),
                                      (x2 - y2) * (7.0f * z2 - 1.0f),
                                      z * x * (x2 - 3.0f * y2),
                                      x2 * (x2 - 3.0f * y2) - y2 * (3.0f * x2 - y2)};
    memcpy(p, all, sizeof all);
}

/* Squares of the factors that make the polynomials orthonormal, times 4 pi; the degree of each; and for each degree the
 * cosine's Legendre coefficient over pi. */
static const double squares[AMBIENT_TERMS] = {1.0,       3.0,       3.0,       3.0,       15.0,     15.0,     15.0,
                                              15.0 / 4,  5.0 / 4,   35.0 / 8,  105.0,     21.0 / 8, 7.0 / 4,  21.0 / 8,
                                              105.0 / 4, 35.0 / 8,  315.0 / 4, 315.0 / 8, 45.0 / 4, 45.0 / 8, 9.0 / 64,
                                              45.0 / 8,  45.0 / 16, 315.0 / 8, 315.0 / 64};
static int degree(int k) { return k < 1 ? 0 : k < 4 ? 1 : k < 9 ? 2 : k < 16 ? 3 : 4; }
static const double cosines[5] = {1.0, 2.0 / 3, 1.0 / 4, 0.0, -1.0 / 24};

/* Projects the radiance of an image onto the polynomials. */
static void project(const WeftImage *image, float terms[AMBIENT_TERMS][3]) {
    double sums[AMBIENT_TERMS][3] = {{0.0}};
    const float *p = image->pixels;
    for (int y = 0; y < image->height; y++) {
        double solid = 2.0 * PI_DOUBLE / image->width *
                       (cos(PI_DOUBLE * y / image->height) - cos(PI_DOUBLE * (y + 1) / image->height));
        for (int x = 0; x < image->width; x++, p += 3) {
            float at[AMBIENT_TERMS];
            ambient_polynomials(latlong_direction((x + 0.5) / image->width, (y + 0.5) / image->height), at);
            for (int k = 0; k < AMBIENT_TERMS; k++)
                for (int c = 0; c < 3; c++) sums[k][c] += solid * (double)(p[c] * at[k]);
        }
    }
    for (int k = 0; k < AMBIENT_TERMS; k++)
        for (int c = 0; c < 3; c++) terms[k][c] = (float)(sums[k][c] * squares[k] / (4.0 * PI_DOUBLE));
}

void ambient_rest_about(const AmbientParts *parts, Vec3 w, float kappa, float color[3]) {
    double a[5] = {1.0}, k = (double)kappa;
    memcpy(a, cosines, sizeof a);
    if (kappa > 0.0f) {
        a[1] = 1.0 / tanh(k) - 1.0 / k;
        for (int l = 1; l < 4; l++) a[l + 1] = a[l - 1] - (2 * l + 1) / k * a[l];
    }
    float p[AMBIENT_TERMS];
    ambient_polynomials(w, p);
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int n = 0; n < AMBIENT_RESIDUAL_TERMS; n++)
            sum += a[degree(n)] * (double)(parts->residual_sh[n][c] * p[n]);
        color[c] = (float)fmax(sum, 0.0);
    }
}

static double luminance(const float *p) {
    return 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
}

static void find_rest(const WeftImage *image, AmbientRest *rest) {
    const float *p = image->pixels;
    const int across = image->width / AMBIENT_REST_WIDTH, down = image->height / AMBIENT_REST_HEIGHT;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++, p += 3)
            rest->luminance[y / down][x / across] += (float)(luminance(p) / (across * down));
}

float ambient_rest_at(const AmbientRest *rest, Vec3 d) {
    float u, v;
    latlong_point(d, &u, &v);
    int x = (int)(u * AMBIENT_REST_WIDTH), y = (int)(v * AMBIENT_REST_HEIGHT);
    return rest->luminance[y < AMBIENT_REST_HEIGHT ? y : AMBIENT_REST_HEIGHT - 1][x % AMBIENT_REST_WIDTH];
}

/* The part of a texel that goes to the lights. */
typedef struct Spark {
    Vec3 direction;
    float color[3]; /* irradiance on a plane that faces it */
    float energy;   /* luminance of color */
} Spark;

typedef struct Sparks {
    Spark *list;
    int count;
    double energy;
} Sparks;

/* Moves the bright part of an image to sparks. */
static void take_sparks(WeftImage *image, Sparks *sparks) {
    double mean = 0.0, all = 0.0;
    float *p = image->pixels;
    for (int y = 0; y < image->height; y++) {
        double solid = 2.0 * PI_DOUBLE / image->width *
                       (cos(PI_DOUBLE * y / image->height) - cos(PI_DOUBLE * (y + 1) / image->height));
        for (int x = 0; x < image->width; x++, p += 3) {
            mean += solid * luminance(p);
            all += solid;
        }
    }
    double clip = AMBIENT_CLIP * mean / all;
    p = image->pixels;
    for (int y = 0; y < image->height; y++) {
        double solid = 2.0 * PI_DOUBLE / image->width *
                       (cos(PI_DOUBLE * y / image->height) - cos(PI_DOUBLE * (y + 1) / image->height));
        for (int x = 0; x < image->width; x++, p += 3) {
            double l = luminance(p), part = l > clip ? clip / l : 1.0;
            if (!(part < 1.0)) continue;
            Spark *spark = &sparks->list[sparks->count++];
            spark->direction = latlong_direction((x + 0.5) / image->width, (y + 0.5) / image->height);
            for (int c = 0; c < 3; c++) {
                spark->color[c] = (float)((double)p[c] * (1.0 - part) * solid);
                p[c] = (float)((double)p[c] * part);
            }
            spark->energy = (float)(l * (1.0 - part) * solid);
            sparks->energy += (double)spark->energy;
        }
    }
}

static int nearest(const Vec3 *centres, int count, Vec3 d, float *cosine_to) {
    int best = 0;
    *cosine_to = -2.0f;
    for (int k = 0; k < count; k++) {
        float c = vec3_dot(centres[k], d);
        if (c > *cosine_to) best = k, *cosine_to = c;
    }
    return best;
}

/* Draws the first centres: each is a spark, drawn by its energy times the squared distance to the centres before it.
 * David Arthur, Sergei Vassilvitskii, "k-means++: The Advantages of Careful Seeding", SODA 2007. */
static void seed(const Sparks *sparks, int count, uint64_t start, Vec3 *centres) {
    uint64_t stream = stream_start(start, 1);
    for (int k = 0; k < count; k++) {
        double total = 0.0, at = 0.0;
        for (int pass = 0; pass < 2; pass++) {
            at = pass ? unit_double(stream_next(&stream)) * total : 0.0;
            for (int n = 0; n < sparks->count; n++) {
                float c = 1.0f;
                if (k) nearest(centres, k, sparks->list[n].direction, &c);
                double weight = (double)sparks->list[n].energy * (k ? fmax(2.0 - 2.0 * (double)c, 0.0) : 1.0);
                if (!pass)
                    total += weight;
                else if ((at -= weight) <= 0.0 || n == sparks->count - 1) {
                    centres[k] = sparks->list[n].direction;
                    break;
                }
            }
        }
    }
}

/* Improves the centres and makes their lights: Stuart Lloyd, "Least Squares Quantization in PCM", IEEE Transactions on
 * Information Theory 28(2), 1982. Returns the remaining sum of energy times squared distance. */
static double assign_texels(const Sparks *sparks, int count, Vec3 *centres, EnvLight *env_lights) {
    double left = 0.0;
    for (int round = 0; round < ROUNDS; round++) {
        Vec3 sums[AMBIENT_POINTS_MAX] = {{0.0f, 0.0f, 0.0f}};
        float energy[AMBIENT_POINTS_MAX] = {0.0f};
        memset(env_lights, 0, (size_t)count * sizeof *env_lights);
        left = 0.0;
        for (int n = 0; n < sparks->count; n++) {
            float c;
            const Spark *spark = &sparks->list[n];
            int k = nearest(centres, count, spark->direction, &c);
            sums[k] = vec3_madd(sums[k], spark->direction, spark->energy);
            float distance = spark->energy * (2.0f - 2.0f * c);
            left += (double)distance;
            env_lights[k].spread += distance;
            energy[k] += spark->energy;
            for (int j = 0; j < 3; j++) env_lights[k].color[j] += spark->color[j];
        }
        for (int k = 0; k < count; k++) {
            centres[k] = vec3_normal_or(sums[k], centres[k]);
            env_lights[k].direction = centres[k];
            env_lights[k].spread = fmaxf(env_lights[k].spread / fmaxf(energy[k], 1e-30f), 0.0f);
        }
    }
    return left;
}

/* Finds `count` lights, the best of several starts. */
static void find_some(const Sparks *sparks, int count, AmbientParts *parts) {
    double best = (double)INFINITY;
    for (int start = 0; start < STARTS; start++) {
        Vec3 centres[AMBIENT_LIGHTS_MAX];
        EnvLight env_lights[AMBIENT_LIGHTS_MAX];
        seed(sparks, count, (uint64_t)start, centres);
        double left = assign_texels(sparks, count, centres, env_lights);
        if (left >= best) continue;
        best = left;
        parts->env_light_kappa = (float)log2(2.0 * sparks->energy / fmax(left, 1e-6 * sparks->energy));
        parts->env_light_count = 0;
        for (int k = 0; k < count; k++) {
            const float *c = env_lights[k].color;
            if (c[0] + c[1] + c[2] > 0.0f) parts->env_lights[parts->env_light_count++] = env_lights[k];
        }
    }
}

/* Finds the fewest lights that reach AMBIENT_LIGHT_KAPPA, at most `most`. */
static void find_env_lights(const Sparks *sparks, int most, AmbientParts *parts) {
    if (!sparks->count || !(sparks->energy > 0.0)) return;
    for (int count = 2; count <= most; count++) {
        find_some(sparks, count, parts);
        if (parts->env_light_kappa >= AMBIENT_LIGHT_KAPPA) break;
    }
}

float env_light_density(const EnvLight *light) {
    return 2.0f * (float)light->points / (PI_FLOAT * fmaxf(light->spread, 1e-5f));
}

/* Divides light k, whose sparks are `own`, into points; `all` is the energy of all lights. */
static void divide_light(const Sparks *own, int k, double all, AmbientParts *parts) {
    Vec3 centres[AMBIENT_POINTS_MAX];
    EnvLight found[AMBIENT_POINTS_MAX];
    int count = (int)(AMBIENT_POINTS * own->energy / all + 0.5), first = parts->point_count;
    count = count < 1 ? 1 : count < own->count ? count : own->count;
    seed(own, count, 0, centres);
    assign_texels(own, count, centres, found);
    for (int n = 0; n < count; n++) {
        const float *c = found[n].color;
        EnvPoint point = {found[n].direction, {c[0], c[1], c[2]}, k};
        if (c[0] + c[1] + c[2] > 0.0f) parts->points[parts->point_count++] = point;
    }
    parts->env_lights[k].points = parts->point_count - first;
}

/* Divides all lights into points. Returns false if memory is short. */
static bool find_points(const Sparks *sparks, AmbientParts *parts) {
    Vec3 centres[AMBIENT_LIGHTS_MAX];
    Spark *list = alloc_array((size_t)sparks->count + 1, sizeof *list);
    if (!list) return false;
    for (int k = 0; k < parts->env_light_count; k++) centres[k] = parts->env_lights[k].direction;
    for (int k = 0; k < parts->env_light_count; k++) {
        Sparks own = {.list = list};
        for (int n = 0; n < sparks->count; n++) {
            float c;
            if (nearest(centres, parts->env_light_count, sparks->list[n].direction, &c) != k) continue;
            own.list[own.count++] = sparks->list[n];
            own.energy += (double)sparks->list[n].energy;
        }
        if (own.count) divide_light(&own, k, sparks->energy, parts);
    }
    free(list);
    return true;
}

static WeftResult constant_image(const float color[3], WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(SPLIT_WIDTH, SPLIT_WIDTH / 2, 3, WEFT_PIXEL_F32, out, error);
    float *p = out->pixels;
    for (int k = 0; result == WEFT_OK && k < out->width * out->height * 3; k++) p[k] = color[k % 3];
    return result;
}

WeftResult ambient_split(const Environment *environment, int env_lights, AmbientParts *out, WeftError *error) {
    WeftImage image;
    *out = (AmbientParts){.env_light_kappa = AMBIENT_EVEN_KAPPA};
    WeftResult result = environment->kind == ENVIRONMENT_CONSTANT
                            ? constant_image(environment->color, &image, error)
                            : latlong_resize(&environment->image, SPLIT_WIDTH, SPLIT_WIDTH / 2, &image, error);
    if (result != WEFT_OK) return result;
    Sparks sparks = {.list = alloc_array((size_t)image.width * (size_t)image.height, sizeof(Spark))};
    if (sparks.list) {
        project(&image, out->terms);
        for (int k = 0; k < AMBIENT_TERMS; k++)
            for (int c = 0; c < 3; c++) out->terms[k][c] *= (float)cosines[degree(k)];
        if (env_lights >= 2) take_sparks(&image, &sparks);
        project(&image, out->residual_sh);
        find_rest(&image, &out->rest);
        find_env_lights(&sparks, env_lights < AMBIENT_LIGHTS_MAX ? env_lights : AMBIENT_LIGHTS_MAX, out);
    }
    if (!sparks.list || !find_points(&sparks, out)) result = fail(error, WEFT_MESSAGE_MEMORY, "an environment", NULL);
    free(sparks.list);
    weft_image_free(&image);
    return result;
}
