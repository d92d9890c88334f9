/* Both engines make the same picture of materials that are drawn by chance, on a ball, a curled sheet that shows both
 * of its sides, and a card. Under a sun, a spot or a point light both leave out shadows; under a polygon the path tracer
 * has them, and pixels in shadow are left out. In a long run, and of a material asked for, the mean of frames under an
 * environment is compared with the path tracer's: of every third material, with normal maps, and metals and woven cloth
 * more often. No emission is drawn.
 *
 * Material NUMBER is random/NUMBER.json, which stays where the engines disagree, beside both pictures and a command that
 * draws them. WEFT_TEST_SEED=NUMBER asks one alone, WEFT_TEST_LONG=1 20,000, or as many as fifty minutes allow. The ten
 * that agree least are in random/worst.png.
 *
 * Labels: slow unsanitized */
#include "raster/random_material.h"

#include "raster/gl.h"
#include "trace/scenes.h"

#include <sys/stat.h>
#include <unistd.h>

#include "base/steady_clock.h"
#include "scene/record/camera.h"
#include "trace/geometry/geometry.h"

enum { WIDTH = 96, HEIGHT = 36, PIXELS = WIDTH * HEIGHT, REGIONS = 9, WORST = 10, SAMPLES = 64, LIGHT_TEXT = 640 };
enum { MAP_SAMPLES = 128, MAP_EVERY = 3 }; /* in a long run, one of so many materials is drawn under a map too */

#define FOLDER "random"
#define CAMERA "0,0,12;0,0,0;11.4"

static const double pixel_most = 0.02, share_most = 0.01, region_most = 0.02;

/* Where the light of a picture is. */
typedef enum Place { POINT_BEFORE, POINT_BEHIND, POLYGON_BEFORE, POLYGON_BEHIND, ALL_AROUND, PLACES } Place;
static bool is_polygon(Place place) { return place == POLYGON_BEFORE || place == POLYGON_BEHIND; }

/* What is seen in each pixel, by the place of the light and for single-sided and double-sided materials: regions of
 * pixels that show one surface, with all neighbours, or -1. Pixels that a part of a polygon does not reach are left out,
 * since the path tracer finds a mirrored polygon only by rays that meet shadows. */
static int region_of[PLACES][2][PIXELS];

/* Materials on which the engines cannot agree as closely, each with its bounds and the reason. */
typedef struct Exception {
    bool (*holds)(const RandomMaterial *material, Place place);
    double share, region;
    const char *why;
} Exception;

static bool is_woven(const RandomMaterial *material, Place place) { return material->woven; }
static bool is_blended(const RandomMaterial *material, Place place) { return material->blended; }
static bool is_masked(const RandomMaterial *material, Place place) { return material->masked; }
static bool has_polygon(const RandomMaterial *material, Place place) { return is_polygon(place); }
static bool is_summed(const RandomMaterial *material, Place place) { return place == ALL_AROUND; }
static bool is_sharp(const RandomMaterial *material, Place place) {
    static const char *const words[] = {"\"clearcoat\":", "burley-coat", "silk"};
    bool found = false;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) found |= strstr(material->text, words[k]) != NULL;
    return is_polygon(place) && found;
}
static bool is_stretched(const RandomMaterial *material, Place place) {
    return is_polygon(place) && strstr(material->text, "\"anisotropy\":");
}
/* Returns true if an input is in the material and is not 0. */
static bool has_some(const RandomMaterial *material, const char *key) {
    const char *at = strstr(material->text, key);
    float value = 1.0f;
    if (at && sscanf(at + strlen(key), " %f", &value) != 1) value = 1.0f; /* a texture */
    return at && value > 0.0f;
}
static bool is_solid(const RandomMaterial *material, Place place) {
    return has_some(material, "\"transmission\":") && has_some(material, "\"thickness\":");
}
static const Exception exceptions[] = {
    {is_woven, 1.0, 0.03, "points of threads are chosen at random, others in each engine: only means agree"},
    {is_blended, 1.0, 0.02,
     "the path tracer takes or leaves each point of partial opacity at random: only means agree"},
    {is_summed, 1.0, 0.02, "frames of a sum have noise, as the path tracer has: only means agree"},
    {is_masked, 0.02, 0.06, "outlines of holes are not left out"},
    {has_polygon, 0.04, 0.05, "24 to 32 points stand for a polygon: 1 to 5 % for highlights (docs/area-lights.md)"},
    {is_sharp, 0.06, 0.15, "the same: up to 14 % for coats and silk"},
    {is_solid, 1.0, 1.0, "the raster engine draws solid glass as a thin sheet (docs/materials.md)"},
    {is_stretched, 1.0, 1.0, "the same: streaks below roughness 0.15 fade, since they are cones"},
};
enum { EXCEPTIONS = sizeof exceptions / sizeof *exceptions };

static Exception bounds_of(const RandomMaterial *material, Place place) {
    Exception bounds = {.share = share_most, .region = region_most};
    for (int k = 0; k < EXCEPTIONS; k++) {
        if (!exceptions[k].holds(material, place)) continue;
        bounds.share = fmax(bounds.share, exceptions[k].share);
        bounds.region = fmax(bounds.region, exceptions[k].region);
    }
    return bounds;
}

/* How well the engines agree on a material. */
typedef struct Agreement {
    uint64_t seed;
    double share;  /* of pixels beyond pixel_most */
    double region; /* greatest difference of a region's mean */
    int where;     /* that region, rows from the top */
    Place place;
    Exception bounds;
    WeftImage traced, drawn;
} Agreement;

/* A point of a shape for u and v from 0 to 1. */
static Vec3 ball_at(float u, float v) {
    const float theta = v * PI_FLOAT, phi = u * 2.0f * PI_FLOAT;
    return vec3(-2.13f + (sinf)(theta) * (sinf)(phi), (cosf)(theta), (sinf)(theta) * (cosf)(phi));
}

/* A rippled tube, open towards the camera, whose top leans to it. */
static Vec3 sheet_at(float u, float v) {
    const float phi = 0.9f + u * 4.8f, r = 0.8f + 0.06f * (sinf)(5.0f * phi), y = 0.9f - 1.8f * v;
    return vec3(r * (sinf)(phi), y, r * (cosf)(phi) + 0.35f * y);
}

static Vec3 card_at(float u, float v) {
    const float x = 1.7f * (u - 0.5f), y = 1.7f * (0.5f - v);
    return vec3(2.13f + 0.85f * x, 0.95f * y, 0.5f * x - 0.3f * y);
}

/* Adds a shape of so many columns and rows, with normals, tangents, texture coordinates and, on request, colours. */
static void add_shape(WeftScene *scene, Vec3 (*at)(float u, float v), uint32_t columns, uint32_t rows, bool colored) {
    const float step = 1e-3f;
    Mesh *mesh = test_mesh(scene, (columns + 1) * (rows + 1), 2 * columns * rows);
    mesh->normal = arena_array(&scene->arena, mesh->vertex_count, 3 * sizeof(float));
    mesh->tangent = arena_array(&scene->arena, mesh->vertex_count, 4 * sizeof(float));
    mesh->texcoord[0] = arena_array(&scene->arena, mesh->vertex_count, 2 * sizeof(float));
    if (colored) mesh->color = arena_array(&scene->arena, mesh->vertex_count, 4 * sizeof(float));
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        const uint32_t column = k % (columns + 1), row = k / (columns + 1);
        const float u = (float)column / (float)columns, v = (float)row / (float)rows;
        const float w = min(max(v, 0.01f), 0.99f); /* a pole has no tangent of its own */
        const Vec3 p = at(u, v), along = vec3_sub(at(u + step, w), at(u - step, w)),
                   down = vec3_sub(at(u, w + step), at(u, w - step));
        const Vec3 n = vec3_normal_or(vec3_cross(down, along), vec3(0.0f, 0.0f, 1.0f)),
                   t = vec3_normal_or(along, vec3(1.0f, 0.0f, 0.0f));
        memcpy(mesh->position + 3 * k, &p, sizeof p);
        memcpy(mesh->normal + 3 * k, &n, sizeof n);
        memcpy(mesh->tangent + 4 * k, (const float[4]){t.x, t.y, t.z, 1.0f}, 4 * sizeof(float));
        memcpy(mesh->texcoord[0] + 2 * k, (const float[2]){u, v}, 2 * sizeof(float));
        if (colored)
            memcpy(mesh->color + 4 * k, (const float[4]){1.0f - 0.5f * u, 0.4f + 0.6f * v, 0.9f, 1.0f - 0.4f * u},
                   4 * sizeof(float));
    }
    uint32_t *index = mesh->index;
    for (uint32_t k = 0; k < columns * rows; k++) {
        const uint32_t a = k / columns * (columns + 1) + k % columns, b = a + columns + 1;
        *index++ = a, *index++ = b, *index++ = a + 1;
        *index++ = a + 1, *index++ = b, *index++ = b + 1;
    }
}

static const char *const shapes[] = {FOLDER "/shapes.glb", FOLDER "/colored.glb"};

/* Writes the scenes, without vertex colours and with them. */
static void write_shapes(void) {
    for (int colored = 0; colored < 2; colored++) {
        WeftScene *scene = test_scene();
        WeftError error;
        test_material(scene, 0.5f);
        scene->material_names[0] = "cloth";
        add_shape(scene, ball_at, 192, 96, colored);
        add_shape(scene, sheet_at, 256, 4, colored);
        add_shape(scene, card_at, 1, 1, colored);
        scene_bounds(scene);
        test_environment(scene, 0.0f);
        if (weft_scene_save(scene, shapes[colored], &error) != WEFT_OK) fail_msg("%s", error.text);
        weft_scene_free(scene);
    }
}

static WeftScene *scene_of(const char *path) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(path, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_scene_set_environment_color(scene, (const float[]){0.0f, 0.0f, 0.0f}, &error), WEFT_OK);
    return scene;
}

/* Returns the light of a material's picture, and as the command line has it. */
static WeftLight light_of(uint64_t seed, Place place, char text[LIGHT_TEXT]) {
    const WeftLightKind kinds[] = {WEFT_LIGHT_DIRECTIONAL, WEFT_LIGHT_POINT, WEFT_LIGHT_SPOT};
    const bool polygon = is_polygon(place), behind = place == POINT_BEHIND || place == POLYGON_BEHIND;
    const float z = behind ? -6.0f : 6.0f; /* from behind it shines through cloth */
    WeftLight light = {.kind = polygon ? WEFT_LIGHT_POLYGON : kinds[seed % 3],
                       .position = {2.0f, 4.0f, z},
                       .direction = {-2.0f, -4.0f, -z},
                       .inner = 10.0f,
                       .outer = 40.0f,
                       .size = {4.0f, 4.0f}};
    const float power = polygon ? 10.0f : light.kind == WEFT_LIGHT_DIRECTIONAL ? 3.0f : 170.0f;
    char from[32], to[32], color[48];
    for (int c = 0; c < 3; c++) light.color[c] = power;
    snprintf(from, sizeof from, "2,4,%g", (double)z);
    snprintf(to, sizeof to, "-2,-4,%g", (double)-z);
    snprintf(color, sizeof color, "%g,%g,%g", (double)power, (double)power, (double)power);
    switch (light.kind) {
    case WEFT_LIGHT_DIRECTIONAL: snprintf(text, LIGHT_TEXT, "sun;%s;%s", to, color); break;
    case WEFT_LIGHT_POINT: snprintf(text, LIGHT_TEXT, "point;%s;%s", from, color); break;
    case WEFT_LIGHT_SPOT: snprintf(text, LIGHT_TEXT, "spot;%s;%s;%s;10,40", from, to, color); break;
    case WEFT_LIGHT_POLYGON: snprintf(text, LIGHT_TEXT, "polygon;%s;%s;4,4;%s", from, to, color); break;
    }
    return light;
}

/* Returns true if all of a polygon is seen from a hit: nine of its points. */
static bool sees_polygon(const Geometry *geometry, const WeftLight *light, Vec3 from) {
    const Vec3 n = vec3_normal_or(vec3_load(light->direction), vec3(0.0f, 0.0f, 1.0f)),
               x = vec3_normal_or(vec3_cross(vec3(0.0f, 1.0f, 0.0f), n), n), y = vec3_cross(n, x);
    bool seen = true;
    for (int k = 0; k < 9 && seen; k++) {
        Vec3 at = vec3_madd(vec3_load(light->position), x, 0.5f * light->size[0] * (float)(k % 3 - 1));
        at = vec3_madd(at, y, 0.5f * light->size[1] * (float)(k / 3 - 1));
        const Vec3 to = vec3_sub(at, from);
        const float distance = vec3_length(to);
        seen = !geometry_occluded(geometry, (Ray){.origin = from,
                                                  .direction = vec3_scale(to, 1.0f / distance),
                                                  .near = 2e-3f,
                                                  .far = distance - 1e-3f});
    }
    return seen;
}

/* Finds what the middle of each pixel shows, and from it the regions. */
static void find_regions(Place place, bool double_sided) {
    static Hit hits[PIXELS];
    static CameraRay rays[PIXELS];
    static bool there[PIXELS];
    int *region = region_of[place][double_sided];
    char text[LIGHT_TEXT];
    const WeftLight light = light_of(0, place, text);
    WeftScene *scene = scene_of(shapes[0]);
    Geometry *geometry;
    Camera camera;
    WeftError error;
    scene->materials[0].double_sided = double_sided;
    assert_int_equal(camera_find(scene, CAMERA, (float)WIDTH / HEIGHT, &camera, &error), WEFT_OK);
    assert_int_equal(geometry_create(scene, scene->mesh_count, 1, &geometry, &error), WEFT_OK);
    View view = view_of(&camera, (float)WIDTH / HEIGHT);
    for (int k = 0; k < PIXELS; k++) {
        float x = ((float)(k % WIDTH) + 0.5f) / WIDTH, y = ((float)(k / WIDTH) + 0.5f) / HEIGHT;
        rays[k] = view_ray(&view, 2.0f * x - 1.0f, 1.0f - 2.0f * y);
        there[k] = geometry_hit(geometry, (Ray){rays[k].origin, rays[k].direction, 0.0f, INFINITY, 0, false}, &hits[k]);
    }
    for (int k = 0; k < PIXELS; k++) {
        int x = k % WIDTH, y = k / WIDTH;
        bool inside = there[k] && x > 0 && y > 0 && x < WIDTH - 1 && y < HEIGHT - 1;
        for (int n = 0; inside && n < 9; n++) {
            const Hit *a = &hits[k], *b = &hits[k + n % 3 - 1 + (n / 3 - 1) * WIDTH];
            inside = there[b - hits] && a->mesh == b->mesh && fabsf(a->t - b->t) < 0.25f &&
                     vec3_dot(vec3_normal_or(a->facing, a->facing), vec3_normal_or(b->facing, b->facing)) > 0.6f;
        }
        if (inside && is_polygon(place))
            inside = sees_polygon(geometry, &light, vec3_madd(rays[k].origin, rays[k].direction, hits[k].t));
        region[k] = inside ? 3 * (3 * y / HEIGHT) + 3 * x / WIDTH : -1;
    }
    geometry_free(geometry);
    weft_scene_free(scene);
}

/* Path traces at the middle of pixels, if the only difference between samples could be where they lie. variance: that of
 * the picture's pixels; without an image where there is no noise. */
static void trace(const WeftScene *scene, Place place, int samples, bool woven, WeftImage *out, WeftImage *variance) {
    WeftRender *render;
    WeftError error;
    const bool noisy = samples > 1, around = place == ALL_AROUND;
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1,
                                 .threads = 1,
                                 .camera = CAMERA,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .pixel_centre = !woven && !around,
                                 .no_shadows = !is_polygon(place) && !around,
                                 .no_roulette = 1,
                                 .hide_lights = 1,
                                 .halves = noisy};
    *variance = (WeftImage){0};
    if (weft_render_create(scene, &desc, &render, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_render_run(render, samples, 0.0, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_render_image(render, out, &error), WEFT_OK);
    if (noisy) assert_int_equal(weft_render_aov(render, WEFT_AOV_VARIANCE, variance, &error), WEFT_OK);
    weft_render_free(render);
}

/* Draws one picture, or under an environment the mean of as many frames as the path tracer has samples. */
static void draw(const WeftScene *scene, Place place, WeftGl gl, WeftImage *out) {
    WeftRaster *raster;
    WeftError error;
    const WeftRasterView view = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .samples = 1,
                                 .camera = CAMERA,
                                 .background = WEFT_BACKGROUND_COLOR,
                                 .no_shadows = place != ALL_AROUND,
                                 .plain_textures = 1,
                                 .hide_lights = 1};
    int done = 0;
    if (weft_raster_create(scene, &(WeftRasterDesc){.gl = gl, .occlusion = 1, .threads = 1}, &raster, NULL, &error) !=
        WEFT_OK)
        fail_msg("%s", error.text);
    WeftResult result = place == ALL_AROUND ? weft_raster_accumulate_begin(raster, &view, MAP_SAMPLES, &error)
                                            : weft_raster_draw(raster, &view, &error);
    while (result == WEFT_OK && place == ALL_AROUND && done < MAP_SAMPLES)
        result = weft_raster_accumulate(raster, 1.0, &done, &error);
    if (result != WEFT_OK || weft_raster_image(raster, out, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    weft_raster_free(raster);
}

/* Returns what a difference is relative to where both are dark: a hundredth of the brightest pixel, but no more than a
 * tenth of the mean, so that a small highlight does not hide the rest. */
static double dark_of(const WeftImage *image, const int *region) {
    const float *p = image->pixels;
    double most = 0.0, sum = 0.0;
    int count = 0;
    for (int k = 0; k < 4 * PIXELS; k++) {
        if (k % 4 == 3 || region[k / 4] < 0) continue;
        most = fmax(most, (double)p[k]);
        sum += (double)p[k];
        count++;
    }
    return fmax(fmin(0.01 * most, 0.1 * sum / (count + 1)), 1e-5);
}

/* Sums over a region. */
typedef struct RegionSums {
    double traced[3], drawn[3];
    double variance[3]; /* of the path tracer's noise */
    double squares[3];  /* of the differences */
    int count;
} RegionSums;

static void sum_regions(const WeftImage *traced, const WeftImage *drawn, const WeftImage *variance, const int *region,
                        RegionSums sums[REGIONS]) {
    const float *p = traced->pixels, *q = drawn->pixels, *v = variance->pixels;
    memset(sums, 0, REGIONS * sizeof *sums);
    for (int k = 0; k < PIXELS; k++) {
        if (region[k] < 0) continue;
        RegionSums *r = &sums[region[k]];
        for (int c = 0; c < 3; c++) {
            r->traced[c] += (double)p[4 * k + c];
            r->drawn[c] += (double)q[4 * k + c];
            if (v) r->variance[c] += (double)v[3 * k + c];
            const double off = (double)p[4 * k + c] - (double)q[4 * k + c];
            r->squares[c] += off * off;
        }
        r->count++;
    }
}

/* Sets share and region of an agreement. Noise counts by four standard deviations. both: the raster engine has noise
 * too, of which the differences tell. */
static void measure(Agreement *a, const WeftImage *variance, bool both, const int *region) {
    const float *p = a->traced.pixels, *q = a->drawn.pixels;
    const double dark = dark_of(&a->traced, region), sigmas = 4.0;
    RegionSums sums[REGIONS];
    int all = 0, beyond = 0;
    sum_regions(&a->traced, &a->drawn, variance, region, sums);
    for (int k = 0; k < PIXELS; k++) {
        bool off = false;
        if (region[k] < 0) continue;
        for (int c = 0; c < 3; c++) {
            const RegionSums *r = &sums[region[k]];
            const double x = (double)p[4 * k + c], y = (double)q[4 * k + c];
            const double noise = sigmas * (sqrt)(fmax(r->variance[c], 0.0) / r->count);
            off |= !(fabs(x - y) <= pixel_most * fmax(fmax(x, y), dark) + noise);
        }
        all++;
        beyond += off;
    }
    a->share = all ? (double)beyond / all : 0.0;
    a->region = 0.0;
    for (int k = 0; k < REGIONS; k++) {
        const RegionSums *r = &sums[k];
        for (int c = 0; c < 3 && r->count; c++) {
            const double noise = sigmas * (sqrt)(fmax(both ? r->squares[c] : r->variance[c], 0.0));
            const double off = fabs(r->traced[c] - r->drawn[c]) - noise;
            const double relative = off / fmax(fmax(r->traced[c], r->drawn[c]), dark * r->count);
            if (!(relative <= a->region)) a->region = relative, a->where = k;
        }
    }
}

/* Returns how far an agreement is from its bounds: above 1 it is none. */
static double badness(const Agreement *a) { return fmax(a->share / a->bounds.share, a->region / a->bounds.region); }

static void write_picture(uint64_t seed, const char *engine, const WeftImage *image) {
    char path[64];
    WeftError error;
    snprintf(path, sizeof path, FOLDER "/%llu-%s.exr", (unsigned long long)seed, engine);
    if (weft_image_write(path, image, &error) != WEFT_OK) fail_msg("%s", error.text);
}

/* The maps that are there: one of a sky, a window and a small bright light, written here, and those of the data. */
static const char *maps[3] = {FOLDER "/around.exr"};
static int map_count = 1;

static void write_map(void) {
    enum { COLUMNS = 64, ROWS = 32 };
    static char found[2][512];
    static const char *const names[] = {"studio_small_03_1k", "venice_sunset_1k"};
    WeftImage image;
    assert_int_equal(weft_image_create(COLUMNS, ROWS, 3, WEFT_PIXEL_F32, &image, NULL), WEFT_OK);
    for (int k = 0; k < COLUMNS * ROWS; k++) {
        const int x = k % COLUMNS, y = k / COLUMNS;
        const bool window = x >= 20 && x < 28 && y >= 6 && y < 14, sun = x >= 44 && x < 46 && y >= 8 && y < 10;
        const float height = 1.0f - (float)y / ROWS, light = sun ? 120.0f : window ? 6.0f : 0.0f;
        const float sky[3] = {0.3f * height, 0.5f * height, 0.9f * height}, ground[3] = {0.25f, 0.18f, 0.1f};
        for (int c = 0; c < 3; c++) ((float *)image.pixels)[3 * k + c] = light + (y < ROWS / 2 ? sky[c] : ground[c]);
    }
    assert_int_equal(weft_image_write(maps[0], &image, NULL), WEFT_OK);
    weft_image_free(&image);
    for (int k = 0; k < 2; k++) {
        snprintf(found[k], sizeof found[k], "%s/../shared/data/env/%s.hdr", WEFT_SOURCE_DIR, names[k]);
        if (access(found[k], R_OK) == 0) maps[map_count++] = found[k];
    }
    print_message("%d maps\n", map_count);
}

/* Puts the light of a place into a scene. light: as the command line has it. */
static void put_light(WeftScene *scene, uint64_t seed, Place place, char light[LIGHT_TEXT]) {
    WeftError error;
    if (place != ALL_AROUND) {
        const WeftLight lamp = light_of(seed, place, light);
        assert_int_equal(weft_scene_add_light(scene, &lamp, &error), WEFT_OK);
        return;
    }
    const char *map = maps[seed % (uint64_t)map_count];
    if (weft_scene_set_environment_file(scene, map, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    snprintf(light, LIGHT_TEXT, "none' --env '%s' --accumulate '%d", map, MAP_SAMPLES);
}

/* Draws a material by both engines, under a light or an environment. Returns false, with a line that tells how to repeat
 * it, if they disagree. */
static bool agrees(uint64_t seed, bool around, Agreement *a) {
    static RandomMaterial material;
    char path[64], light[LIGHT_TEXT];
    WeftError error;
    WeftImage variance;
    const char *shape = shapes[seed % 5 == 0];
    random_material(&material, seed, around);
    const bool polygon = !material.blended && !material.masked && seed % 4 == 3;
    const bool behind = !material.woven && seed % 7 == 0; /* of woven cloth only the gaps would shine */
    const Place place = around ? ALL_AROUND : (Place)(2 * polygon + behind);
    snprintf(path, sizeof path, FOLDER "/%llu.json", (unsigned long long)seed);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(material.text, file);
    assert_int_equal(fclose(file), 0);
    WeftScene *scene = scene_of(shape);
    if (weft_scene_assign_material(scene, "cloth", path, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    put_light(scene, seed, place, light);
    const bool double_sided = scene->materials[0].double_sided;
    const bool noisy = is_polygon(place) || material.woven || material.blended;
    *a = (Agreement){.seed = seed, .place = place, .bounds = bounds_of(&material, place)};
    trace(scene, place, around ? MAP_SAMPLES : noisy ? SAMPLES : 1, material.woven, &a->traced, &variance);
    draw(scene, place, seed % 2 ? WEFT_GL_ES : WEFT_GL_DESKTOP, &a->drawn);
    measure(a, &variance, material.woven || around, region_of[place][double_sided]);
    weft_image_free(&variance);
    weft_scene_free(scene);
    if (badness(a) <= 1.0) {
        remove(path);
        return true;
    }
    write_picture(seed, "traced", &a->traced);
    write_picture(seed, "drawn", &a->drawn);
    print_message("material %llu: %.1f %% of the pixels, region %d by %.1f %%\n    weft render %s --material cloth=%s "
                  "--env 0 --light '%s' --camera '" CAMERA "' --max-depth 1 --engine both -o %llu.png\n",
                  (unsigned long long)seed, 100.0 * a->share, a->where, 100.0 * a->region, shape, path, light,
                  (unsigned long long)seed);
    return false;
}

static const char *under(Place place) {
    return place == ALL_AROUND ? " under a map" : is_polygon(place) ? " under a polygon" : "";
}

static void agreement_free(Agreement *a) {
    weft_image_free(&a->traced);
    weft_image_free(&a->drawn);
    *a = (Agreement){0};
}

/* Keeps an agreement if it is among the worst, of which the first is the worst; frees the one that it replaces. */
static void keep_worst(Agreement worst[WORST], Agreement a) {
    for (int k = 0; k < WORST; k++) {
        if (worst[k].traced.pixels && badness(&worst[k]) >= badness(&a)) continue;
        const Agreement next = worst[k];
        worst[k] = a;
        a = next;
    }
    agreement_free(&a);
}

/* Shows an F32 image three times as large. */
static WeftImage enlarged(const WeftImage *image) {
    WeftImage shown, out;
    const int scale = 3;
    assert_int_equal(weft_image_tonemap(image, WEFT_TONEMAP_NONE, 0.0f, &shown, NULL), WEFT_OK);
    assert_int_equal(weft_image_create(WIDTH * scale, HEIGHT * scale, 4, WEFT_PIXEL_U8, &out, NULL), WEFT_OK);
    for (int k = 0; k < WIDTH * HEIGHT * scale * scale; k++) {
        const int x = k % (WIDTH * scale) / scale, y = k / (WIDTH * scale) / scale;
        memcpy((uint8_t *)out.pixels + 4 * k, (uint8_t *)shown.pixels + 4 * (y * WIDTH + x), 4);
    }
    weft_image_free(&shown);
    return out;
}

/* Writes the worst as a sheet: drawn, traced, and ten times their difference about grey. */
static void write_worst(const Agreement worst[WORST]) {
    WeftPanel panels[3 * WORST];
    WeftImage images[3 * WORST], sheet;
    char titles[WORST][64];
    int count = 0;
    for (; count < WORST && worst[count].traced.pixels; count++) {
        WeftImage difference;
        const Agreement *a = &worst[count];
        assert_int_equal(weft_image_create(WIDTH, HEIGHT, 4, WEFT_PIXEL_F32, &difference, NULL), WEFT_OK);
        for (int k = 0; k < 4 * PIXELS; k++) {
            const float off = ((float *)a->drawn.pixels)[k] - ((float *)a->traced.pixels)[k];
            ((float *)difference.pixels)[k] = k % 4 == 3 ? 1.0f : 0.2f + 10.0f * off;
        }
        images[3 * count] = enlarged(&a->drawn);
        images[3 * count + 1] = enlarged(&a->traced);
        images[3 * count + 2] = enlarged(&difference);
        weft_image_free(&difference);
        snprintf(titles[count], sizeof titles[count], "%llu%s: %.1f %%, region %.1f %%", (unsigned long long)a->seed,
                 under(a->place), 100.0 * a->share, 100.0 * a->region);
        const char *const words[] = {titles[count], "traced", "ten times the difference"};
        for (int k = 0; k < 3; k++)
            panels[3 * count + k] = (WeftPanel){.image = &images[3 * count + k], .title = words[k]};
    }
    const WeftSheetDesc desc = {.caption = "raster, traced", .panels = panels, .count = 3 * count, .columns = 3};
    assert_int_equal(weft_sheet_compose(&desc, &sheet, NULL), WEFT_OK);
    assert_int_equal(weft_image_write(FOLDER "/worst.png", &sheet, NULL), WEFT_OK);
    weft_image_free(&sheet);
    for (int k = 0; k < 3 * count; k++) weft_image_free(&images[k]);
}

static void engines_agree_on_random_materials(void **state) {
    (void)state;
    need_gl();
    Agreement worst[WORST] = {0};
    const char *asked = getenv("WEFT_TEST_SEED");
    const uint64_t first = asked ? strtoull(asked, NULL, 10) : 0, count = asked ? 1 : test_long() ? 20000 : 200;
    const bool under_maps = asked || test_long();
    const double start = clock_now(), patience = 3000.0; /* seconds */
    int bad = 0;
    uint64_t seed = first;
    mkdir(FOLDER, 0777);
    random_maps_write(FOLDER);
    write_shapes();
    random_bumps_write(FOLDER);
    write_map();
    for (int k = 0; k < 2 * PLACES; k++) find_regions((Place)(k / 2), k % 2);
    for (; seed < first + count && clock_now() - start < patience; seed++) {
        const bool also = under_maps && (asked || seed % MAP_EVERY == 0);
        for (int around = 0; around < (also ? 2 : 1); around++) {
            Agreement a;
            bad += !agrees(seed, around, &a);
            keep_worst(worst, a);
        }
    }
    print_message("%llu materials, of which the worst are\n", (unsigned long long)(seed - first));
    for (int k = 0; k < WORST && worst[k].traced.pixels; k++)
        print_message("%llu%s: %.2f %% of the pixels, region %d by %.2f %%\n", (unsigned long long)worst[k].seed,
                      under(worst[k].place), 100.0 * worst[k].share, worst[k].where, 100.0 * worst[k].region);
    write_worst(worst);
    for (int k = 0; k < WORST; k++) agreement_free(&worst[k]);
    if (bad) fail_msg("the engines disagree on %d materials: see " FOLDER "/worst.png", bad);
}

static int begin(void **state) {
    /* as in test_agreement.c */
    setenv("GALLIVM_PERF", "no_aos_sampling,nopt", 1);
    return gl_begin(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(engines_agree_on_random_materials)};
    return cmocka_run_group_tests(tests, begin, NULL);
}
