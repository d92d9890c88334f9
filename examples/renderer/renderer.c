/* A renderer of one's own: a velvet ball on a floor under a lamp, path traced with lobes of libweft.
 *
 *     renderer OUT.png [WIDTH [SAMPLES [mis|light|lobe]]]
 *
 * At each hit light is looked for twice, towards the lamp and where the cloth would send it; multiple
 * importance sampling (Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
 * 1995) weighs the two by pdf. Alone either finds the same light, with more noise: the mean that is printed
 * says so. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <weft/weft.h>

typedef struct Vec {
    float x, y, z;
} Vec;

static Vec vec(float x, float y, float z) { return (Vec){x, y, z}; }
static Vec add(Vec a, Vec b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static Vec sub(Vec a, Vec b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static Vec scale(Vec a, float s) { return vec(a.x * s, a.y * s, a.z * s); }
static Vec times(Vec a, Vec b) { return vec(a.x * b.x, a.y * b.y, a.z * b.z); }
static float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vec unit(Vec a) { return scale(a, 1.0f / sqrtf(dot(a, a))); }
static Vec cross(Vec a, Vec b) { return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

/* PCG (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms", 2014): [0, 1).
 */
static float number(uint32_t *state) {
    uint32_t s = *state = *state * 747796405u + 2891336453u;
    uint32_t w = ((s >> ((s >> 28) + 4)) ^ s) * 277803737u;
    return (float)(((w >> 22) ^ w) >> 8) * 0x1p-24f;
}

/* Cloth: a base, and over it a sheen. The base keeps what the sheen lets through, 1 - E(cos_o), by a table.
 */
enum { COSINES = 64 };
typedef struct Cloth {
    WeftLobe base, sheen;
    bool has_sheen;
    float albedo[COSINES + 1]; /* the largest channel of E, at cos_o = k / COSINES */
} Cloth;

static float cloth_keeps(const Cloth *cloth, float cos_o) {
    if (!cloth->has_sheen) return 1;
    int k = (int)fminf(cos_o * COSINES, COSINES - 1);
    float t = cos_o * COSINES - (float)k;
    return fmaxf(1 - cloth->albedo[k] * (1 - t) - cloth->albedo[k + 1] * t, 0);
}

static Vec cloth_eval(const Cloth *cloth, const float wo[3], const float wi[3]) {
    float f[3], sheen[3] = {0};
    weft_lobe_eval(&cloth->base, wo, wi, f);
    if (cloth->has_sheen) weft_lobe_eval(&cloth->sheen, wo, wi, sheen);
    return add(scale(vec(f[0], f[1], f[2]), cloth_keeps(cloth, wo[2])), vec(sheen[0], sheen[1], sheen[2]));
}

/* One half of the samples each. */
static float cloth_pdf(const Cloth *cloth, const float wo[3], const float wi[3]) {
    float base = weft_lobe_pdf(&cloth->base, wo, wi);
    return cloth->has_sheen ? 0.5f * (base + weft_lobe_pdf(&cloth->sheen, wo, wi)) : base;
}

static float cloth_sample(const Cloth *cloth, const float wo[3], uint32_t *state, float wi[3]) {
    bool sheen = cloth->has_sheen && number(state) < 0.5f;
    float u[2] = {number(state), number(state)};
    float pdf = weft_lobe_sample(sheen ? &cloth->sheen : &cloth->base, wo, u, wi);
    return pdf > 0 ? cloth_pdf(cloth, wo, wi) : 0;
}

/* The world: a unit ball on the plane y = 0, and a square lamp that shines to the side of its normal. */
static const Vec ball = {0, 1, 0}, sky = {0.16f, 0.19f, 0.24f}, glow = {14, 13, 11.5f}, lamp = {-2.2f, 3.6f, 1.6f};
static const float lamp_half = 0.8f;

typedef enum Thing { NOTHING, BALL, FLOOR, LAMP } Thing;

typedef struct Lamp {
    Vec normal, side, up; /* unit */
} Lamp;

static Lamp lamp_frame(void) {
    Lamp l = {.normal = unit(sub(ball, lamp))};
    l.side = unit(cross(vec(0, 1, 0), l.normal));
    l.up = cross(l.normal, l.side);
    return l;
}

/* The nearest thing from o towards d, nearer than *t. */
static Thing trace(const Lamp *l, Vec o, Vec d, float *t) {
    const float near = 1e-4f;
    Thing thing = NOTHING;
    Vec to = sub(o, ball);
    float b = dot(to, d), root = b * b - dot(to, to) + 1, s = -b - sqrtf(fmaxf(root, 0));
    if (root > 0 && s > near && s < *t) *t = s, thing = BALL;
    s = -o.y / d.y;
    if (s > near && s < *t) *t = s, thing = FLOOR;
    s = dot(sub(lamp, o), l->normal) / dot(d, l->normal);
    Vec at = sub(add(o, scale(d, s)), lamp);
    if (s > near && s < *t && dot(d, l->normal) < 0 && fabsf(dot(at, l->side)) < lamp_half &&
        fabsf(dot(at, l->up)) < lamp_half)
        *t = s, thing = LAMP;
    return thing;
}

typedef enum Strategy { MIS, LIGHT, LOBE } Strategy;

/* The weight of a sample of one strategy, whose pdf is a; the other's is b. */
static float weight(Strategy used, Strategy strategy, float a, float b) {
    if (used != MIS) return used == strategy ? 1 : 0;
    return a * a / (a * a + b * b);
}

/* pdf over solid angle of a point of the lamp, seen from o over a distance t along d. */
static float lamp_pdf(const Lamp *l, Vec d, float t) {
    return t * t / (-dot(d, l->normal) * 4 * lamp_half * lamp_half);
}

typedef struct Frame {
    Vec x, y, z;
} Frame;

static Frame frame(Vec n) {
    Vec x = unit(cross(fabsf(n.x) < 0.5f ? vec(1, 0, 0) : vec(0, 1, 0), n));
    return (Frame){x, cross(n, x), n};
}

static void to_local(const Frame *f, Vec v, float out[3]) {
    out[0] = dot(v, f->x), out[1] = dot(v, f->y), out[2] = dot(v, f->z);
}

static Vec to_world(const Frame *f, const float v[3]) {
    return add(add(scale(f->x, v[0]), scale(f->y, v[1])), scale(f->z, v[2]));
}

/* Light that comes straight from the lamp to p and leaves along wo. */
static Vec direct(const Lamp *l, const Cloth *cloth, Vec p, const Frame *f, const float wo[3], Strategy used,
                  uint32_t *state) {
    float a = lamp_half * (2 * number(state) - 1), b = lamp_half * (2 * number(state) - 1);
    Vec to = sub(add(lamp, add(scale(l->side, a), scale(l->up, b))), p), d = unit(to);
    float wi[3], t = INFINITY, pdf = lamp_pdf(l, d, sqrtf(dot(to, to)));
    to_local(f, d, wi);
    if (wi[2] <= 0 || pdf <= 0 || trace(l, p, d, &t) != LAMP) return vec(0, 0, 0);
    return scale(times(cloth_eval(cloth, wo, wi), glow),
                 wi[2] / pdf * weight(used, LIGHT, pdf, cloth_pdf(cloth, wo, wi)));
}

static Vec radiance(const Lamp *l, const Cloth *velvet, const Cloth *floor, Vec o, Vec d, Strategy used,
                    uint32_t *state) {
    Vec sum = vec(0, 0, 0), through = vec(1, 1, 1);
    float pdf = 0; /* of d; 0: from the camera */
    for (int depth = 0; depth < 6; depth++) {
        float t = INFINITY, wo[3], wi[3];
        Thing thing = trace(l, o, d, &t);
        if (thing == NOTHING) return add(sum, times(through, sky));
        if (thing == LAMP) {
            float share = pdf > 0 ? weight(used, LOBE, pdf, lamp_pdf(l, d, t)) : 1;
            return add(sum, scale(times(through, glow), share));
        }
        const Cloth *cloth = thing == BALL ? velvet : floor;
        o = add(o, scale(d, t));
        Frame f = frame(thing == BALL ? unit(sub(o, ball)) : vec(0, 1, 0));
        to_local(&f, scale(d, -1), wo);
        if (wo[2] <= 0) return sum;
        sum = add(sum, times(through, direct(l, cloth, o, &f, wo, used, state)));
        pdf = cloth_sample(cloth, wo, state, wi);
        if (pdf <= 0) return sum;
        through = scale(times(through, cloth_eval(cloth, wo, wi)), wi[2] / pdf);
        d = to_world(&f, wi);
    }
    return sum;
}

static bool cloth_make(Cloth *cloth, const char *base, const char *sheen, const char *alpha, const char *color,
                       WeftError *error) {
    cloth->has_sheen = sheen != NULL;
    if (weft_lobe_init("lambert", &cloth->base, error) != WEFT_OK ||
        weft_lobe_set(&cloth->base, "color", base, NULL, error) != WEFT_OK)
        return false;
    if (!sheen) return true;
    if (weft_lobe_init(sheen, &cloth->sheen, error) != WEFT_OK ||
        weft_lobe_set(&cloth->sheen, "alpha", alpha, NULL, error) != WEFT_OK ||
        weft_lobe_set(&cloth->sheen, "color", color, NULL, error) != WEFT_OK)
        return false;
    for (int k = 0; k <= COSINES; k++) {
        float e[3];
        weft_lobe_albedo(&cloth->sheen, (float)k / COSINES, e);
        cloth->albedo[k] = fmaxf(e[0], fmaxf(e[1], e[2]));
    }
    return true;
}

/* Fills a picture, F32 RGB, and returns its mean. */
static double render(WeftImage *image, const Cloth *velvet, const Cloth *floor, int samples, Strategy used) {
    Lamp l = lamp_frame();
    const Vec eye = vec(0, 1.7f, 6.2f);
    Frame camera = frame(unit(sub(eye, vec(0, 0.85f, 0))));
    camera.x = unit(cross(vec(0, 1, 0), camera.z));
    camera.y = cross(camera.z, camera.x);
    float *pixel = image->pixels;
    double sum = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++, pixel += 3) {
            uint32_t state = (uint32_t)(y * image->width + x) * 2654435761u;
            Vec c = vec(0, 0, 0);
            for (int k = 0; k < samples; k++) {
                float w = (float)image->width, h = (float)image->height;
                float to[3] = {((float)x + number(&state) - 0.5f * w) / h * 0.5f,
                               (0.5f * h - (float)y - number(&state)) / h * 0.5f, -1};
                c = add(c, radiance(&l, velvet, floor, eye, unit(to_world(&camera, to)), used, &state));
            }
            c = scale(c, 1.0f / (float)samples);
            pixel[0] = c.x, pixel[1] = c.y, pixel[2] = c.z;
            sum += (double)(c.x + c.y + c.z) / 3;
        }
    return sum / image->width / image->height;
}

int main(int count, char **arguments) {
    static const char *const names[] = {"mis", "light", "lobe"};
    int width = count > 2 ? atoi(arguments[2]) : 480, samples = count > 3 ? atoi(arguments[3]) : 64, used = 0;
    while (count > 4 && used < 3 && strcmp(arguments[4], names[used]) != 0) used++;
    if (count < 2 || width < 4 || samples < 1 || used == 3) {
        fprintf(stderr, "renderer OUT.png [WIDTH [SAMPLES [mis|light|lobe]]]\n");
        return WEFT_USAGE;
    }
    Cloth velvet, floor;
    WeftImage linear = {0}, shown = {0};
    WeftError error = {0};
    double mean = 0;
    if (cloth_make(&velvet, "0.12,0.01,0.02", "charlie-neubelt-normalised", "0.16", "0.9,0.35,0.4", &error) &&
        cloth_make(&floor, "0.4", NULL, NULL, NULL, &error) &&
        weft_image_create(width, width * 3 / 4, 3, WEFT_PIXEL_F32, &linear, &error) == WEFT_OK) {
        mean = render(&linear, &velvet, &floor, samples, (Strategy)used);
        if (weft_image_tonemap(&linear, WEFT_TONEMAP_PBR_NEUTRAL, 1, &shown, &error) == WEFT_OK)
            weft_image_write(arguments[1], &shown, &error);
    }
    weft_image_free(&linear);
    weft_image_free(&shown);
    if (error.result != WEFT_OK)
        fprintf(stderr, "renderer: %s\n", error.text);
    else
        printf("%s: mean %.4f\n", arguments[1], mean);
    return (int)error.result;
}
