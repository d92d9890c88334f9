/* ambient - prints how far real-time environment light stays from the truth, for each lobe and strategy:
 *
 *   study_ambient [--lights N] [--quick] [--only LOBE]... [--tables] [--rows] MAP.hdr ...
 *
 * Error: sum |difference| / sum reference over the pixels of a sphere seen from two sides, in hundredths;
 * over roughness 0.1 .. 1 together, and of the default strategy the roughness with the greatest, which for a
 * sheen is where there is least of it. The reference is multiple importance sampling between the lobe's
 * sampler and the map's radiance; the strategies run as the shader has them, with means of radiance by
 * sampling. --tables holds none of them, --rows prints each roughness. Under an even white sky first, then
 * under the maps. `base` is a white dielectric, f0 0.04: lambert under ggx; `brushed` and `disney` are metals
 * of anisotropy 0.9 by lobe ggx and by workflow disney, `satin` lobe silk at its greatest. A sheen's E is of
 * its own table, as in a material. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/pi.h"
#include "base/random.h"
#include "base/thread.h"
#include "scene/light/env_split.h"
#include "scene/record/scene.h"
#include "shading/ambient/ambient.h"
#include "shading/ambient/ambient_fit.h"
#include "shading/catalogue/albedo.h"
#include "shading/material/choice.h"
#include "shading/material/material_stack.h"

enum { LEVELS = 16, AZIMUTHS = 12, SIDES = 2, PIXELS = LEVELS * AZIMUTHS * SIDES, ROUGHNESSES = 10 };
enum { LOBE_DRAWS = 2048, MAP_DRAWS = 2048, CELLS_WIDTH = 256, CELLS_HEIGHT = 128 };
enum { SMALL_WIDTH = 128 };
enum { BASE = LOBE_COUNT, BRUSHED, DISNEY, SATIN, MODELS };

/* A pixel of the sphere: its frame, x towards wo for round lobes; and how much of the picture it is. */
typedef struct Pixel {
    Vec3 x, y, z;
    Dir o;
    double weight;
} Pixel;

static Pixel pixels[PIXELS];
static struct Map *maps;

static void make_pixels(void) {
    const Vec3 eyes[SIDES] = {{0.0f, 0.0f, 1.0f}, {-0.787f, 0.344f, -0.492f}};
    int k = 0;
    for (int side = 0; side < SIDES; side++)
        for (int level = 0; level < LEVELS; level++)
            for (int turn = 0; turn < AZIMUTHS; turn++) {
                float u = ((float)level + 0.5f) / LEVELS, z = u * sqrt(u), s = sqrt(1.0f - z * z);
                float phi = 6.2831853f * ((float)turn + 0.37f * (float)level) / AZIMUTHS;
                Vec3 eye = vec3_normal_or(eyes[side], eyes[0]), up = vec3(0.0f, 1.0f, 0.0f);
                Vec3 right = vec3_normal_or(vec3_cross(up, eye), up), over = vec3_cross(eye, right);
                Pixel *p = &pixels[k++];
                p->z = vec3_madd(vec3_madd(vec3_scale(eye, z), right, s * cos(phi)), over, s * sin(phi));
                p->x = vec3_normal_or(vec3_cross(up, p->z), right);
                p->y = vec3_cross(p->z, p->x);
                p->o = dir(vec3_dot(eye, p->x), vec3_dot(eye, p->y), z);
                p->weight = (double)(z * 1.5f * sqrt(u));
            }
}

static Vec3 to_world(const Pixel *p, Dir w) {
    return vec3_madd(vec3_madd(vec3_scale(p->x, w.x), p->y, w.y), p->z, w.z);
}
static Dir to_local(const Pixel *p, Vec3 w) { return dir(vec3_dot(w, p->x), vec3_dot(w, p->y), vec3_dot(w, p->z)); }

/* One map, with its density for sampling. */
typedef struct Map {
    const char *name;
    Environment environment;
    WeftImage cells, small;
    AmbientParts parts;
    double density[CELLS_WIDTH * CELLS_HEIGHT]; /* 1/sr */
    Vec3 draws[MAP_DRAWS];
} Map;

static double map_pdf(const Map *map, Vec3 d) {
    int x = (int)((0.5f + atan2f(d.x, -d.z) / 6.2831853f) * CELLS_WIDTH);
    int y = (int)(acosf(fminf(fmaxf(d.y, -1.0f), 1.0f)) / PI_FLOAT * CELLS_HEIGHT);
    x = x < 0 ? 0 : x < CELLS_WIDTH ? x : CELLS_WIDTH - 1;
    y = y < CELLS_HEIGHT ? y : CELLS_HEIGHT - 1;
    return map->density[y * CELLS_WIDTH + x];
}

/* By luminance of the cell and its neighbours, which interpolation mixes in, and 2 % of it everywhere. */
static void prepare_draws(Map *map) {
    static double sums[CELLS_WIDTH * CELLS_HEIGHT];
    const float *p = map->cells.pixels;
    double total = 0.0, mean = 0.0;
    int count = CELLS_WIDTH * CELLS_HEIGHT;
    for (int k = 0; k < 3 * count; k++) mean += (double)p[k] / (3 * count);
    for (int k = 0; k < count; k++) {
        double sum = 0.02 * mean;
        for (int n = 0; n < 9; n++) {
            int x = (k % CELLS_WIDTH + n % 3 + CELLS_WIDTH - 1) % CELLS_WIDTH, y = k / CELLS_WIDTH + n / 3 - 1;
            y = y < 0 ? 0 : y < CELLS_HEIGHT ? y : CELLS_HEIGHT - 1;
            const float *c = p + 3 * (y * CELLS_WIDTH + x);
            sum += (double)(c[0] + c[1] + c[2]) / 27.0;
        }
        map->density[k] = sum;
        total += sum * (sin)(PI_DOUBLE * (k / CELLS_WIDTH + 0.5) / CELLS_HEIGHT) * 19.7392088 / count;
        sums[k] = total;
    }
    for (int k = 0; k < count; k++) map->density[k] /= total;
    for (int n = 0, k = 0; n < MAP_DRAWS; n++) {
        double u = (n + unit_double(hash64((uint64_t)n + 9))) / MAP_DRAWS * total;
        while (k < count - 1 && sums[k] < u) k++;
        double a = unit_double(hash64((uint64_t)n * 7 + 123)), b = unit_double(hash64((uint64_t)n * 13 + 765));
        double row = k / CELLS_WIDTH, top = (cos)(PI_DOUBLE * row / CELLS_HEIGHT);
        double z = top + ((cos)(PI_DOUBLE * (row + 1) / CELLS_HEIGHT) - top) * b;
        map->draws[n] = latlong_direction((k % CELLS_WIDTH + a) / CELLS_WIDTH, acos(z) / PI_DOUBLE);
    }
}

/* What ambient.h asks for, in a pixel's frame. */
typedef struct PixelView {
    const Map *map;
    const Pixel *pixel;
} PixelView;

enum { LOOKS = 128 };

static Rgb look_up(const WeftImage *image, Vec3 d) {
    float c[3];
    latlong_at(image, d, c);
    return rgb(c[0], c[1], c[2]);
}

/* By drawing from exp(kappa (mu - 1)). */
static Rgb look_about(const WeftImage *image, Vec3 z, float kappa) {
    Vec3 x = vec3_normal_or(vec3_cross(z, vec3(0.3f, 0.5f, 0.8f)), z), y = vec3_cross(z, x);
    Rgb sum = rgb_grey(0.0f);
    for (int k = 0; k < LOOKS; k++) {
        float u = ((float)k + 0.5f) / LOOKS, phi = 6.2831853f * 0.618033989f * (float)k;
        float t = min(-(logf)(u + (1.0f - u) * (expf)(-2.0f * kappa)) / kappa, 2.0f), s = sqrt(t * (2.0f - t));
        Vec3 d = vec3_madd(vec3_madd(vec3_scale(z, 1.0f - t), x, s * cos(phi)), y, s * sin(phi));
        sum = rgb_add(sum, look_up(image, d));
    }
    return rgb_scale(sum, 1.0f / LOOKS);
}
static Rgb look_radiance(const void *user, Dir w, float kappa) {
    const PixelView *look = user;
    const WeftImage *image = kappa < 40.0f ? &look->map->small : &look->map->environment.image;
    return look_about(image, to_world(look->pixel, w), kappa);
}
static Rgb look_irradiance(const void *user, Dir w) {
    const PixelView *look = user;
    float p[AMBIENT_TERMS], c[3] = {0.0f, 0.0f, 0.0f};
    ambient_polynomials(to_world(look->pixel, w), p);
    for (int k = 0; k < AMBIENT_TERMS; k++)
        for (int j = 0; j < 3; j++) c[j] += look->map->parts.terms[k][j] * p[k];
    return rgb(max(c[0], 0.0f), max(c[1], 0.0f), max(c[2], 0.0f));
}
static Rgb look_rest(const void *user, Dir w, float kappa) {
    const PixelView *look = user;
    float c[3];
    ambient_rest_about(&look->map->parts, to_world(look->pixel, w), kappa, c);
    return rgb(c[0], c[1], c[2]);
}
static AmbientLight look_light(const void *user, int k) {
    const PixelView *look = user;
    const EnvLight *light = &look->map->parts.env_lights[k];
    return (AmbientLight){to_local(look->pixel, light->direction),
                          rgb(light->color[0], light->color[1], light->color[2]), env_light_density(light), k};
}
static AmbientLight look_point(const void *user, int k) {
    const PixelView *look = user;
    const EnvPoint *point = &look->map->parts.points[k];
    AmbientLight l = look_light(user, point->light);
    l.w = to_local(look->pixel, point->direction);
    l.color = rgb(point->color[0], point->color[1], point->color[2]);
    return l;
}

static const char *const own_names[MODELS - BASE] = {"base", "brushed", "disney", "satin"};
static const char *name_of(int model) { return model >= BASE ? own_names[model - BASE] : weft_lobe_info(model)->id; }

/* A white metal, or a dielectric. */
static SeenStack surface_of(int model, float roughness, Dir o) {
    SeenStack m;
    float metal = model == BASE ? 0.0f : 1.0f;
    Surface s = {.base_color = {0.8f, 0.8f, 0.8f},
                 .metallic = metal,
                 .roughness = roughness,
                 .anisotropy = 0.9f * metal,
                 .specular = 1.0f,
                 .sheen = 1.0f - metal};
    Choices c = choices_unmade();
    if (model == DISNEY) c.workflow = choice_find(CHOICE_workflow, "disney");
    s.specular_color = rgb_grey(1.0f);
    s.reflectance = 0.46f; /* f0 0.04 */
    s.nap_direction = s.anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
    seen_make(&m, &s, &c, (TableRef){.kind = TABLE_NONE}, o);
    return m;
}

/* What is looked at; `albedo` may be NULL. */
static SeenStack model_stack(int model, float roughness, Dir o, const AlbedoTable *albedo) {
    if (model >= BASE && model != SATIN) return surface_of(model, roughness, o);
    SeenStack seen;
    Stack *m = &seen.stack;
    stack_clear(m);
    Rgb white = rgb_grey(1.0f);
    Lobe lobe = lobe_rough(model == SATIN ? LOBE_SILK : model, roughness);
    if (model == SATIN) lobe.params[1] = 0.8f;
    slot_even(&m->sheen, lobe, white, white, 1.0f);
    if (albedo) {
        m->albedo = ALBEDO_TABLE;
        m->table = albedo_table_ref(albedo);
        m->albedo_coord = lobe.params[0];
    }
    seen_prepare(&seen, o);
    return seen;
}

static const char *only[MODELS]; /* these models alone, where there are some */
static int only_count;

static bool used(int model) {
    bool named = only_count == 0;
    for (int k = 0; k < only_count; k++) named |= strcmp(only[k], name_of(model)) == 0;
    if (!named) return false;
    return model >= BASE || (model != LOBE_BURLEY_COAT && model != LOBE_COOK_TORRANCE &&
                             !(weft_lobe_info(model)->traits & TRAIT_REFERENCE));
}

static bool is_sheen(int model) {
    return model < BASE && model != LOBE_GGX && model != LOBE_SILK && !(weft_lobe_info(model)->traits & TRAIT_DIFFUSE);
}

typedef struct Draw2 {
    Dir i;
    float f, pdf;
} Draw2;

static double (*results)[ROUGHNESSES][AMBIENT_STRATEGIES][16][2]; /* sum of differences, of the reference */
static int map_count, env_light_count = AMBIENT_LIGHTS, step = 1;

static float radical(uint32_t k) {
    float x = 0.0f;
    for (float place = 0.5f; k; k >>= 1, place *= 0.5f)
        if (k & 1) x += place;
    return x;
}

static Rgb reference(const Map *map, const Pixel *p, const SeenStack *m, const Draw2 *draws, int count) {
    double sum[3] = {0.0};
    for (int k = 0; k < count; k++) {
        float c[3];
        Vec3 d = to_world(p, draws[k].i);
        latlong_at(&map->environment.image, d, c);
        double w = (double)draws[k].f / (LOBE_DRAWS * (double)draws[k].pdf + MAP_DRAWS * map_pdf(map, d));
        for (int j = 0; j < 3; j++) sum[j] += w * (double)c[j];
    }
    for (int k = 0; k < MAP_DRAWS; k++) {
        float c[3];
        Dir i = to_local(p, map->draws[k]);
        if (!(i.z > 0.0f)) continue;
        StackValue x = seen_eval(m, i, 0);
        latlong_at(&map->environment.image, map->draws[k], c);
        double w = (double)x.f_cos.g / (LOBE_DRAWS * (double)x.pdf + MAP_DRAWS * map_pdf(map, map->draws[k]));
        for (int j = 0; j < 3; j++) sum[j] += w * (double)c[j];
    }
    return rgb((float)sum[0], (float)sum[1], (float)sum[2]);
}

static AmbientFit *fits; /* of each lobe */
static bool tables_only; /* nothing is baked */

/* The tables of one model, baked where a shader would hold them. */
typedef struct Baked {
    AmbientWeights polynomials[3 * AMBIENT_BAKED];
    AmbientFit fit;
} Baked;

static AmbientTable table_of(Baked *baked, int slot, const Lobe *lobe) {
    AmbientTable t = ambient_table(&fits[lobe->id], AMBIENT_FITTED);
    if (tables_only) return t;
    ambient_fit(&baked->fit, lobe, lobe->params[0], lobe->params[0], 1);
    ambient_bake(&baked->fit, baked->polynomials + slot * AMBIENT_BAKED);
    t.focus = baked->fit.finest > AMBIENT_CLOSE - AMBIENT_BLEND;
    t.by_azimuth = baked->fit.by_azimuth;
    t.strips = lobe_names(lobe->id)->strips;
    t.lossless = false;
    t.baked = slot * AMBIENT_BAKED;
    return t;
}

static AmbientTables tables_of(Baked *baked, const Stack *m) {
    AmbientTable none = ambient_table(&fits[LOBE_LAMBERT], AMBIENT_FITTED);
    AmbientTables tables = {none, none, none, none, none};
    if (HAS_DIFFUSE(m)) tables.diffuse = table_of(baked, 0, &m->diffuse.lobe);
    if (HAS_SPECULAR(m)) tables.specular = table_of(baked, 1, &m->specular.lobe);
    if (HAS_SHEEN(m)) tables.sheen = table_of(baked, 2, &m->sheen.lobe);
    return tables;
}

static AmbientTables by_strategy(AmbientTables t, int strategy) {
    t.diffuse.strategy = t.specular.strategy = t.sheen.strategy = strategy;
    return t;
}

static void measure(void *user, int item, int thread) {
    (void)user, (void)thread;
    int model = item / ROUGHNESSES, r = item % ROUGHNESSES;
    if (!used(model) || r % step != step - 1) return;
    Draw2 *draws = alloc_array(LOBE_DRAWS, sizeof *draws);
    Baked *baked = alloc_array(1, sizeof *baked);
    AlbedoTable *albedo = is_sheen(model) ? alloc_array(1, sizeof *albedo) : NULL;
    float roughness = 0.1f * (float)(r + 1);
    if (albedo) {
        Lobe lobe = lobe_rough(model, roughness);
        albedo_table_fill(albedo, &lobe, lobe.params[0], lobe.params[0], 1);
    }
    SeenStack some = model_stack(model, roughness, dir(0.0f, 0.0f, 1.0f), albedo);
    AmbientTables tables = tables_of(baked, &some.stack);
    for (int n = 0; n < PIXELS; n++) {
        const Pixel *p = &pixels[n];
        SeenStack m = model_stack(model, roughness, p->o, albedo);
        int count = 0;
        for (int k = 0; k < LOBE_DRAWS; k++) {
            Dir i = seen_sample(&m, ((float)k + 0.5f) / LOBE_DRAWS, radical((uint32_t)k));
            if (!(i.z > 0.0f)) continue;
            StackValue x = seen_eval(&m, i, 0);
            if (x.pdf > 0.0f) draws[count++] = (Draw2){i, x.f_cos.g, x.pdf};
        }
        for (int k = 0; k < map_count; k++) {
            PixelView look = {&maps[k], p};
            AmbientSourceCalls calls = {look_radiance,
                                        look_irradiance,
                                        look_rest,
                                        look_light,
                                        &look,
                                        maps[k].parts.env_light_count,
                                        maps[k].parts.env_light_kappa,
                                        baked->polynomials,
                                        look_point,
                                        maps[k].parts.point_count};
            Rgb expected = reference(&maps[k], p, &m, draws, count);
            for (int s = 0; s < AMBIENT_STRATEGIES; s++) {
                Rgb got = stack_ambient(&m.stack, &m.view, by_strategy(tables, s), &calls, 1.0f, 1.0f);
                double *sum = results[model][r][s][k];
                sum[0] +=
                    p->weight * (double)(abs(got.r - expected.r) + abs(got.g - expected.g) + abs(got.b - expected.b));
                sum[1] += p->weight * (double)(expected.r + expected.g + expected.b);
            }
        }
    }
    free(albedo);
    free(baked);
    free(draws);
}

/* Sums of differences and of the reference. */
typedef struct Error {
    double off, all;
} Error;

static void error_add(Error *to, const double sum[2]) {
    to->off += sum[0];
    to->all += sum[1];
}
static double error_part(Error e) { return 100.0 * e.off / fmax(e.all, 1e-30); }

/* The default strategy at that roughness. */
static int best_of(int model, int r) {
    static AmbientFit fit;
    Stack m = model_stack(model, 0.1f * (float)(r + 1), dir(0.0f, 0.0f, 1.0f), NULL).stack;
    Lobe lobe = HAS_SHEEN(&m) ? m.sheen.lobe : m.specular.lobe;
    ambient_fit(&fit, &lobe, lobe.params[0], lobe.params[0], 0);
    return ambient_strategy(lobe.id, fit.by_azimuth, fit.denser > AMBIENT_DENSER);
}

static bool by_row; /* one line a roughness */

static void print_row(int model, int k, int r, int best) {
    printf("%27.1f", 0.1 * (r + 1));
    for (int s = 0; s <= AMBIENT_STRATEGIES; s++) {
        Error error = {0.0, 0.0};
        error_add(&error, results[model][r][s < AMBIENT_STRATEGIES ? s : best][k]);
        printf(" %10.1f", error_part(error));
    }
    printf("\n");
}

static void print_model(int model, int k) {
    Error sums[AMBIENT_STRATEGIES + 1] = {{0.0, 0.0}};
    double worst = 0.0;
    int at = 0, best[ROUGHNESSES];
    for (int r = 0; r < ROUGHNESSES; r++) {
        Error own = {0.0, 0.0};
        best[r] = best_of(model, r);
        for (int s = 0; s < AMBIENT_STRATEGIES; s++) error_add(&sums[s], results[model][r][s][k]);
        error_add(&sums[AMBIENT_STRATEGIES], results[model][r][best[r]][k]);
        error_add(&own, results[model][r][best[r]][k]);
        if (error_part(own) > worst) worst = error_part(own), at = r;
    }
    printf("%-27s", name_of(model));
    for (int s = 0; s <= AMBIENT_STRATEGIES; s++) printf(" %10.1f", error_part(sums[s]));
    printf("  %.1f at %.1f\n", worst, 0.1 * (at + 1));
    for (int r = 0; by_row && r < ROUGHNESSES; r++)
        if (results[model][r][0][k][1] > 0.0) print_row(model, k, r, best[r]);
}

static void print_results(void) {
    for (int k = 0; k < map_count; k++) {
        printf("\n%s, %d lights\n%-27s", maps[k].name, maps[k].parts.env_light_count, "lobe");
        printf(" irradiance     mirror     fitted    sampled    default  worst\n");
        for (int model = 0; model < MODELS; model++)
            if (used(model)) print_model(model, k);
    }
}

/* NULL: a white sky. */
static bool load(Map *map, const char *path) {
    WeftError error;
    WeftScene *scene = scene_create("ambient");
    if (scene && !path) {
        scene->environment.kind = ENVIRONMENT_IMAGE;
        if (weft_image_create(2, 1, 3, WEFT_PIXEL_F32, &scene->environment.image, &error) != WEFT_OK) return false;
        for (int k = 0; k < 6; k++) ((float *)scene->environment.image.pixels)[k] = 1.0f;
    } else if (!scene || weft_scene_set_environment_file(scene, path, NULL, &error) != WEFT_OK) {
        fprintf(stderr, "study_ambient: %s\n", scene ? error.text : "out of memory");
        return false;
    }
    const char *slash = path ? strrchr(path, '/') : NULL;
    map->name = slash ? slash + 1 : path ? path : "a white sky";
    map->environment = scene->environment; /* stays until the end */
    if (latlong_resize(&map->environment.image, CELLS_WIDTH, CELLS_HEIGHT, &map->cells, &error) != WEFT_OK ||
        latlong_resize(&map->environment.image, SMALL_WIDTH, SMALL_WIDTH / 2, &map->small, &error) != WEFT_OK ||
        ambient_split(&map->environment, env_light_count, &map->parts, &error) != WEFT_OK)
        return false;
    prepare_draws(map);
    return true;
}

int main(int argc, char **argv) {
    maps = calloc(16, sizeof *maps);
    fits = calloc(LOBE_COUNT, sizeof *fits);
    results = calloc(MODELS, sizeof *results);
    if (!maps || !fits || !results) return 4;
    if (!load(&maps[map_count++], NULL)) return 4;
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "--rows") == 0)
            by_row = true;
        else if (strcmp(argv[k], "--quick") == 0)
            step = 3;
        else if (strcmp(argv[k], "--tables") == 0)
            tables_only = true;
        else if (strcmp(argv[k], "--lights") == 0 && k + 1 < argc)
            env_light_count = atoi(argv[++k]);
        else if (strcmp(argv[k], "--only") == 0 && k + 1 < argc && only_count < MODELS)
            only[only_count++] = argv[++k];
        else if (map_count < 16 && !load(&maps[map_count++], argv[k]))
            return 3;
    }
    make_pixels();
    for (int lobe = 0; lobe < LOBE_COUNT; lobe++) {
        Lobe at = lobe_default(lobe);
        float a = lobe_rough(lobe, 0.1f).params[0], b = lobe_rough(lobe, 1.0f).params[0];
        if (used(lobe) || lobe == LOBE_LAMBERT || lobe == LOBE_GGX)
            ambient_fit(&fits[lobe], &at, min(a, b), max(a, b), 0);
    }
    parallel_for(0, MODELS * ROUGHNESSES, measure, NULL);
    print_results();
    return 0;
}
