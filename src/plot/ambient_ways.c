#include "plot/ambient_ways.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "scene/light/env_split.h"
#include "scene/light/environment.h"
#include "shading/ambient/ambient.h"
#include "shading/ambient/ambient_fit.h"
#include "shading/catalogue/albedo.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/lobes/ltc_fibre_half.h"
#include "shading/material/choice.h"
#include "shading/material/material_stack.h"

enum { RINGS = 96, SECTORS = 128 }; /* of the reference */
enum { CELLS_WIDTH = 128, CELLS_HEIGHT = 64, SMALL_WIDTH = 256, WEIGHTS = 512, LOOKS = 128, STREAKS = 6 };

/* The lobe that the engines' formulas of E are for. */
static const char of_engines[] = "charlie-neubelt";

/* The profile with the way's formula of E; NULL: E is the lobe's. */
static const struct {
    const char *name, *profile;
} ways[AMBIENT_WAYS] = {
    [WAY_WEFT] = {"weft", NULL},
    [WAY_KHRONOS] = {"khronos", NULL}, /* E of its own lobe, from a table */
    [WAY_FILAMENT] = {"filament", "filament-sheen"},
    [WAY_THREE] = {"three", "three"},
    [WAY_BABYLON] = {"babylon", "babylon"},
    [WAY_MATERIALX] = {"materialx", "materialx"},
    [WAY_BABYLON_OPENPBR] = {"babylon-openpbr", NULL},
};

const char *ambient_way_name(int way) { return ways[way].name; }

/* The filters of look-ups, by the angle to their axis. */
typedef enum AmbientFilter { FILTER_COSINE = 0, FILTER_CHARLIE, FILTER_GGX, FILTER_GGX_FINE, FILTERS } AmbientFilter;

struct AmbientMap {
    Environment environment;
    WeftImage cells, small; /* F32 RGB */
    AmbientParts parts;
};

struct AmbientModel {
    const AmbientMap *map;
    const WeftPlotModel *model;
    Lobe lobe;
    float alpha;
    Stack engines[AMBIENT_WAYS];         /* of the profiles */
    bool own[AMBIENT_WAYS];              /* E is the lobe's own */
    float weights[FILTERS][WEIGHTS + 1]; /* over the cosine from 0 to 1 */
    AmbientFit fit;
    AmbientTable table;
    AlbedoTable albedo; /* E, as a material has it */
};

/* Returns true if all values are finite. */
static bool is_finite(const WeftImage *image) {
    const float *values = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t k = 0; k < count; k++)
        if (!isfinite(values[k])) return false;
    return true;
}

static WeftResult map_fill(const WeftImage *image, AmbientMap *map, WeftError *error) {
    WeftImage *made = &map->environment.image;
    if (image && image->type != WEFT_PIXEL_F32)
        return fail(error, WEFT_MESSAGE_DESC, "plot", "a map has floats, as .hdr and .exr have them");
    WeftResult result = image ? weft_image_convert_f32(image, 0, made, error) : environment_studio(made, error);
    if (result == WEFT_OK && !is_finite(made))
        return fail(error, WEFT_MESSAGE_DESC, "plot", "the map has a value that is not finite");
    if (result == WEFT_OK) result = latlong_resize(made, CELLS_WIDTH, CELLS_HEIGHT, &map->cells, error);
    if (result == WEFT_OK) result = latlong_resize(made, SMALL_WIDTH, SMALL_WIDTH / 2, &map->small, error);
    return result == WEFT_OK ? ambient_split(&map->environment, AMBIENT_LIGHTS, &map->parts, error) : result;
}

WeftResult ambient_map_make(const WeftImage *image, AmbientMap **out, WeftError *error) {
    AmbientMap *map = *out = alloc_array(1, sizeof *map);
    if (!map) return fail(error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    map->environment = (Environment){.kind = ENVIRONMENT_IMAGE, .strength = 1.0f};
    const WeftResult result = map_fill(image, map, error);
    if (result == WEFT_OK) return WEFT_OK;
    ambient_map_free(map);
    *out = NULL;
    return result;
}

void ambient_map_free(AmbientMap *map) {
    if (!map) return;
    weft_image_free(&map->environment.image);
    weft_image_free(&map->cells);
    weft_image_free(&map->small);
    free(map);
}

/* Returns the weight of light at that cosine to the mirror direction where the view is along it too: n . l D(h). */
static float weight_of(AmbientFilter filter, float alpha, float mu) {
    const float sin2 = fmaxf(0.5f * (1.0f - mu), 1e-9f), cos2 = 0.5f * (1.0f + mu), a2 = alpha * alpha;
    const float ggx = a2 / (cos2 * (a2 - 1.0f) + 1.0f);
    switch (filter) {
    case FILTER_CHARLIE: return mu * powf(sin2, 0.5f / alpha);
    case FILTER_GGX: return mu * ggx * ggx;
    default: return mu;
    }
}

static void weights_make(AmbientModel *m) {
    for (int filter = 0; filter < FILTERS; filter++) {
        const bool fine = filter == FILTER_GGX_FINE; /* alpha is the square of the roughness of the fuzz */
        const float alpha = fmaxf(fine ? m->alpha * m->alpha : m->alpha, 0.01f);
        for (int k = 0; k <= WEIGHTS; k++)
            m->weights[filter][k] = weight_of(fine ? FILTER_GGX : (AmbientFilter)filter, alpha, (float)k / WEIGHTS);
    }
}

/* Makes the sheen of an engine, for its formula of E. */
static void engine_make(AmbientModel *m, int way) {
    Surface s = {.roughness = 1.0f, .specular = 1.0f, .sheen = 1.0f, .reflectance = 0.5f};
    Choices c = choices_unmade();
    m->own[way] = !ways[way].profile || strcmp(weft_lobe_info(m->lobe.id)->id, of_engines) != 0;
    if (m->own[way]) return;
    s.sheen_color = s.sheen_second = s.specular_color = rgb_grey(1.0f);
    s.sheen_roughness = sqrtf(m->alpha);
    s.nap_direction = s.anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
    c.profile = choice_find(CHOICE_profile, ways[way].profile);
    stack_make(&m->engines[way], &s, &c, (TableRef){.kind = TABLE_NONE});
}

AmbientModel *ambient_model_make(const AmbientMap *map, const WeftPlotModel *model) {
    AmbientModel *m = alloc_array(1, sizeof *m);
    if (!m) return NULL;
    const int id = model->lobe->lobe;
    m->map = map;
    m->model = model;
    lobe_tables_make_for(LOBE_LTC_FIBRE_HALF);
    lobe_of(model->lobe, &m->lobe);
    m->alpha = fminf(fmaxf(m->lobe.params[0], 0.01f), 1.0f);
    weights_make(m);
    for (int way = 0; way < AMBIENT_WAYS; way++) engine_make(m, way);
    ambient_fit(&m->fit, &m->lobe, m->lobe.params[0], m->lobe.params[0], 0);
    m->table = ambient_table(&m->fit, ambient_strategy(id, m->fit.by_azimuth, m->fit.denser > AMBIENT_DENSER));
    m->table.strips = lobe_names(id)->strips;
    albedo_table_fill(&m->albedo, &m->lobe, m->lobe.params[0], m->lobe.params[0], 0);
    return m;
}

void ambient_model_free(AmbientModel *model) { free(model); }

/* A point of the sphere: its frame, wo in it, and the map. */
typedef struct AmbientSpot {
    const AmbientMap *map;
    Vec3 x, y, z;
    Dir o;
} AmbientSpot;

static Vec3 to_world(const AmbientSpot *p, Dir w) {
    return vec3_madd(vec3_madd(vec3_scale(p->x, w.x), p->y, w.y), p->z, w.z);
}

static Dir to_local(const AmbientSpot *p, Vec3 w) {
    return dir(vec3_dot(w, p->x), vec3_dot(w, p->y), vec3_dot(w, p->z));
}

static Rgb look_up(const WeftImage *image, Vec3 d) {
    float c[3];
    latlong_at(image, d, c);
    return rgb(c[0], c[1], c[2]);
}

/* Returns the mean of the map weighted by exp(kappa (mu - 1)), by drawing from that. */
static Rgb look_radiance(const void *user, Dir w, float kappa) {
    const AmbientSpot *p = user;
    const WeftImage *image = kappa < 40.0f ? &p->map->small : &p->map->environment.image;
    const Vec3 z = to_world(p, w), x = vec3_normal_or(vec3_cross(z, vec3(0.3f, 0.5f, 0.8f)), z), y = vec3_cross(z, x);
    Rgb sum = rgb_grey(0.0f);
    for (int k = 0; k < LOOKS; k++) {
        const float u = ((float)k + 0.5f) / LOOKS, phi = 6.2831853f * 0.618033989f * (float)k;
        const float t = fminf(-logf(u + (1.0f - u) * expf(-2.0f * kappa)) / kappa, 2.0f), s = sqrtf(t * (2.0f - t));
        const Vec3 d = vec3_madd(vec3_madd(vec3_scale(z, 1.0f - t), x, s * cosf(phi)), y, s * sinf(phi));
        sum = rgb_add(sum, look_up(image, d));
    }
    return rgb_scale(sum, 1.0f / LOOKS);
}

static Rgb look_irradiance(const void *user, Dir w) {
    const AmbientSpot *p = user;
    float terms[AMBIENT_TERMS], c[3] = {0.0f, 0.0f, 0.0f};
    ambient_polynomials(to_world(p, w), terms);
    for (int k = 0; k < AMBIENT_TERMS; k++)
        for (int j = 0; j < 3; j++) c[j] += p->map->parts.terms[k][j] * terms[k];
    return rgb(fmaxf(c[0], 0.0f), fmaxf(c[1], 0.0f), fmaxf(c[2], 0.0f));
}

static Rgb look_rest(const void *user, Dir w, float kappa) {
    const AmbientSpot *p = user;
    float c[3];
    ambient_rest_about(&p->map->parts, to_world(p, w), kappa, c);
    return rgb(c[0], c[1], c[2]);
}

static AmbientLight look_light(const void *user, int k) {
    const AmbientSpot *p = user;
    const EnvLight *light = &p->map->parts.env_lights[k];
    return (AmbientLight){to_local(p, light->direction), rgb(light->color[0], light->color[1], light->color[2]),
                          env_light_density(light), k};
}

static AmbientLight look_point(const void *user, int k) {
    const AmbientSpot *p = user;
    const EnvPoint *point = &p->map->parts.points[k];
    AmbientLight l = look_light(user, point->light);
    l.w = to_local(p, point->direction);
    l.color = rgb(point->color[0], point->color[1], point->color[2]);
    return l;
}

/* Returns the light by weft's own way, of a white lobe. */
static Rgb weft_light(const AmbientModel *m, const AmbientSpot *p) {
    const AmbientParts *parts = &p->map->parts;
    const AmbientSourceCalls calls = {.radiance = look_radiance,
                                      .irradiance = look_irradiance,
                                      .residual = look_rest,
                                      .light = look_light,
                                      .user = p,
                                      .count = parts->env_light_count,
                                      .env_light_kappa = parts->env_light_kappa,
                                      .baked = NULL,
                                      .point = look_point,
                                      .point_count = parts->point_count};
    SeenStack seen;
    stack_clear(&seen.stack);
    slot_even(&seen.stack.sheen, m->lobe, rgb_grey(1.0f), rgb_grey(1.0f), 1.0f);
    seen.stack.albedo = ALBEDO_TABLE;
    seen.stack.table = albedo_table_ref(&m->albedo);
    seen.stack.albedo_coord = m->lobe.params[0];
    seen_prepare(&seen, p->o);
    const AmbientTables tables = {m->table, m->table, m->table, m->table, m->table};
    return stack_ambient(&seen.stack, &seen.view, tables, &calls, 1.0f, 1.0f);
}

/* The reference, the lobe's E, and the look-ups about axes: sums. */
typedef struct AmbientSums {
    int axis_count;
    Vec3 axes[3 + STREAKS];
    AmbientFilter filters[3 + STREAKS];
    Rgb light[3 + STREAKS];
    float weight[3 + STREAKS];
    Rgb reference, albedo;
} AmbientSums;

static float weight_at(const float *weights, float mu) {
    const float at = mu * WEIGHTS;
    const int k = at < WEIGHTS - 1 ? (int)at : WEIGHTS - 1;
    return weights[k] + (weights[k + 1] - weights[k]) * (at - (float)k);
}

/* Adds a cell to the look-ups. light: its radiance times its solid angle. */
static void add_looks(const AmbientModel *m, AmbientSums *s, Vec3 w, Rgb light, float angle) {
    for (int k = 0; k < s->axis_count; k++) {
        const float mu = vec3_dot(w, s->axes[k]);
        if (!(mu > 0.0f)) continue;
        const float weight = weight_at(m->weights[s->filters[k]], fminf(mu, 1.0f));
        s->light[k] = rgb_add(s->light[k], rgb_scale(light, weight));
        s->weight[k] += weight * angle;
    }
}

/* Adds directions to the reference and to E. */
static void add_exact(const AmbientModel *m, AmbientSums *s, const AmbientSpot *p, int count, const float (*wi)[3],
                      const Rgb *light, const float *angle) {
    float f[SECTORS][3];
    const float wo[3] = {p->o.x, p->o.y, p->o.z};
    making_eval(m->model, wo, count, wi, 1, f);
    for (int k = 0; k < count; k++) {
        const Rgb f_cos = rgb_scale(rgb(f[k][0], f[k][1], f[k][2]), wi[k][2]);
        s->reference = rgb_add(s->reference, rgb_mul(f_cos, light[k]));
        s->albedo = rgb_add(s->albedo, rgb_scale(f_cos, angle[k]));
    }
}

/* Adds up the look-ups over the cells of the map. */
static void sum_looks(const AmbientModel *m, AmbientSums *s) {
    const float *radiance = m->map->cells.pixels;
    const double step = PI_DOUBLE / CELLS_HEIGHT;
    for (int row = 0; row < CELLS_HEIGHT; row++) {
        const float angle = (float)(((cos)(row * step) - (cos)((row + 1) * step)) * 2.0 * PI_DOUBLE / CELLS_WIDTH);
        for (int k = 0; k < CELLS_WIDTH; k++, radiance += 3) {
            const Vec3 w = latlong_direction((k + 0.5) / CELLS_WIDTH, (row + 0.5) / CELLS_HEIGHT);
            add_looks(m, s, w, rgb_scale(rgb(radiance[0], radiance[1], radiance[2]), angle), angle);
        }
    }
}

/* Adds up the reference over rings about the normal, uniform in the angle to it. */
static void sum_exact(const AmbientModel *m, const AmbientSpot *p, AmbientSums *s) {
    float wi[SECTORS][3], angles[SECTORS];
    Rgb lights[SECTORS];
    for (int ring = 0; ring < RINGS; ring++) {
        const float step = 0.5f * PI_FLOAT / RINGS, theta = ((float)ring + 0.5f) * step, z = cosf(theta),
                    sine = sinf(theta);
        for (int k = 0; k < SECTORS; k++) {
            const float phi = 2.0f * PI_FLOAT * ((float)k + 0.618034f * (float)ring) / SECTORS;
            const Dir i = dir(sine * cosf(phi), sine * sinf(phi), z);
            angles[k] = 2.0f * sinf(0.5f * step) * sine * 2.0f * PI_FLOAT / SECTORS;
            lights[k] = rgb_scale(look_up(&m->map->small, to_world(p, i)), angles[k]);
            wi[k][0] = i.x, wi[k][1] = i.y, wi[k][2] = i.z;
        }
        add_exact(m, s, p, SECTORS, (const float(*)[3])wi, lights, angles);
    }
}

/* Names the look-ups: irradiance, the mirror direction by both filters, and six along the surface within 90 degrees of
 * the viewer's azimuth. */
static void looks_make(const AmbientSpot *p, AmbientSums *s) {
    const Dir mirror = dir(-p->o.x, -p->o.y, p->o.z);
    const float azimuth = atan2f(p->o.y, p->o.x);
    const Dir axes[3] = {dir(0.0f, 0.0f, 1.0f), mirror, mirror};
    *s = (AmbientSums){.axis_count = 3 + STREAKS};
    for (int k = 0; k < s->axis_count; k++) {
        const float phi = azimuth + PI_FLOAT * (((float)(k - 3) + 0.5f) / STREAKS - 0.5f);
        s->axes[k] = to_world(p, k < 3 ? axes[k] : dir(cosf(phi), sinf(phi), 0.0f));
        s->filters[k] = k < 3 ? (AmbientFilter)k : FILTER_GGX_FINE;
    }
}

static Rgb look_mean(const AmbientSums *s, int k) { return rgb_scale(s->light[k], 1.0f / fmaxf(s->weight[k], 1e-20f)); }

static Rgb rgb_least(Rgb a, Rgb b) { return rgb(fminf(a.r, b.r), fminf(a.g, b.g), fminf(a.b, b.b)); }

static Rgb streak_light(const AmbientModel *m, const AmbientSums *s, float cosine) {
    Rgb mean = rgb_grey(0.0f), even = look_mean(s, FILTER_COSINE);
    for (int k = 3; k < s->axis_count; k++) mean = rgb_add(mean, rgb_scale(look_mean(s, k), 1.0f / STREAKS));
    const float rough = m->alpha * m->alpha;
    const float weight = fminf(2.0f * ltc_fibre_half_r(cosine, sqrtf(m->alpha)), 1.0f);
    return rgb_scale(rgb_add(rgb_scale(rgb_least(mean, even), 1.0f - rough), rgb_scale(even, rough)), weight);
}

static void put(Rgb c, float out[3]) {
    out[0] = c.r;
    out[1] = c.g;
    out[2] = c.b;
}

void ambient_model_light(const AmbientModel *m, Vec3 n, float reference[3], float by[AMBIENT_WAYS][3]) {
    static const AmbientFilter filters[AMBIENT_WAYS] = {
        [WAY_KHRONOS] = FILTER_CHARLIE, [WAY_FILAMENT] = FILTER_GGX, [WAY_BABYLON] = FILTER_GGX};
    const float *f0 = m->model->lobe->f0;
    const Rgb color = rgb(f0[0], f0[1], f0[2]);
    const Vec3 eye = vec3(0.0f, 0.0f, 1.0f);
    AmbientSpot p = {.map = m->map, .z = n};
    AmbientSums s;
    p.x = vec3_normal_or(vec3_cross(vec3(0.0f, 1.0f, 0.0f), n), vec3(1.0f, 0.0f, 0.0f));
    p.y = vec3_cross(n, p.x);
    p.o = to_local(&p, eye);
    looks_make(&p, &s);
    sum_looks(m, &s);
    sum_exact(m, &p, &s);
    put(s.reference, reference);
    for (int way = WAY_KHRONOS; way <= WAY_MATERIALX; way++) {
        const Rgb e = m->own[way] ? s.albedo : rgb_scale(color, stack_albedo(&m->engines[way], p.o).e);
        put(rgb_mul(e, look_mean(&s, (int)filters[way])), by[way]);
    }
    put(rgb_mul(color, weft_light(m, &p)), by[WAY_WEFT]);
    put(rgb_mul(color, streak_light(m, &s, p.o.z)), by[WAY_BABYLON_OPENPBR]);
}
