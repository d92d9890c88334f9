#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/sky.h"

#define TWO_PI 6.28318530717959f

/* The importance map is never finer than this: beyond, a cell has several texels. */
enum { MAP_WIDTH_MAX = 4096, MAP_HEIGHT_MAX = 2048 };

/* acos to 1e-6 and atan to 2e-6: Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical Functions",
 * 1964, 4.4.46 and 4.4.49. A texel of a 16k map spans 4e-4 radians; the library's calls cost more than the
 * rest of a look-up. */
static float fast_acos(float x) {
    float a = abs(x);
    float p = -0.0012624911f;
    p = p * a + 0.0066700901f;
    p = p * a - 0.0170881256f;
    p = p * a + 0.0308918810f;
    p = p * a - 0.0501743046f;
    p = p * a + 0.0889789874f;
    p = p * a - 0.2145988016f;
    p = p * a + 1.5707963050f;
    p *= sqrt(max(1.0f - a, 0.0f));
    return x < 0.0f ? PI - p : p;
}

static float fast_atan2(float y, float x) {
    float ax = abs(x), ay = abs(y), t = min(ax, ay) / max(max(ax, ay), 1e-30f), s = t * t;
    float p = 0.0028662257f;
    p = p * s - 0.0161657367f;
    p = p * s + 0.0429096138f;
    p = p * s - 0.0752896400f;
    p = p * s + 0.1065626393f;
    p = p * s - 0.1420889944f;
    p = p * s + 0.1999355085f;
    p = p * s - 0.3333314528f;
    p = t + t * s * p;
    if (ay > ax) p = 0.5f * PI - p;
    if (x < 0.0f) p = PI - p;
    return y < 0.0f ? -p : p;
}

/* World direction to the image's (u, v), and back. */
static void to_map(const Sky *sky, Vec3 d, float *u, float *v) {
    float x = d.x * sky->cos_turn - d.z * sky->sin_turn, z = d.x * sky->sin_turn + d.z * sky->cos_turn;
    *u = 0.5f + fast_atan2(x, -z) / TWO_PI;
    *v = fast_acos(clamp(d.y, -1.0f, 1.0f)) / PI;
}

static Vec3 from_map(const Sky *sky, float u, float v) {
    float phi = (u - 0.5f) * TWO_PI, theta = v * PI, s = sin(theta);
    float x = s * sin(phi), z = -s * cos(phi);
    return vec3(x * sky->cos_turn + z * sky->sin_turn, cos(theta), -x * sky->sin_turn + z * sky->cos_turn);
}

/* A colour in one register; the fourth lane is idle. */
typedef float Color4 __attribute__((vector_size(16)));
typedef int32_t Bytes4 __attribute__((vector_size(16)));

/* Greg Ward, "Real Pixels", Graphics Gems II, 1991: three mantissas m and one exponent e, m 2^(e - 136). */
static inline Color4 unpack(uint32_t p) {
    uint32_t e = p >> 24, bits = e > 9 ? (e - 9) << 23 : 0;
    float scale;
    memcpy(&scale, &bits, 4);
    Bytes4 m = ((Bytes4){0} + (int32_t)(p & 0xffffffu)) >> (Bytes4){0, 8, 16, 24} & 255;
    return __builtin_convertvector(m, Color4) * scale;
}

static uint32_t pack(const float *c) {
    int e;
    float most = max(c[0], max(c[1], c[2]));
    if (!(most > 0.0f)) return 0;
    frexpf(most, &e);
    if (e + 128 < 10 || e + 128 > 255) return 0;
    uint32_t p = (uint32_t)(e + 128) << 24;
    for (int k = 0; k < 3; k++) p |= ((uint32_t)ldexpf(max(c[k], 0.0f), 8 - e) & 255u) << (8 * k);
    return p;
}

/* The image as RGBE, when every texel comes back as it was (as those of .hdr files do): a third of the memory
 * to go through at each look-up. */
static void pack_image(Sky *sky, Arena *arena) {
    const WeftImage *image = &sky->environment->image;
    size_t count = (size_t)image->width * (size_t)image->height;
    const float *p = image->pixels;
    if (image->channels != 3) return;
    for (size_t k = 0; k < count; k++) {
        Color4 c = unpack(pack(p + 3 * k));
        for (size_t j = 0; j < 3; j++)
            if (c[j] < p[3 * k + j] || c[j] > p[3 * k + j]) return;
    }
    sky->packed = arena_array(arena, count, sizeof(uint32_t));
    for (size_t k = 0; sky->packed && k < count; k++) sky->packed[k] = pack(p + 3 * k);
}

static inline Color4 lerp(Color4 a, Color4 b, float t) { return a + (b - a) * t; }

/* Bilinear: columns wrap, rows end. */
static Rgb image_at(const Sky *sky, float u, float v) {
    const Environment *e = sky->environment;
    const WeftImage *image = &e->image;
    if (!sky->packed) {
        static const Texture latlong = {.wrap_u = WRAP_REPEAT, .wrap_v = WRAP_CLAMP};
        Texel t = texture_fetch(&latlong, image, NULL, u, v);
        return (Rgb){t.c[0] * e->strength, t.c[1] * e->strength, t.c[2] * e->strength};
    }
    float x = u * (float)image->width - 0.5f, y = v * (float)image->height - 0.5f, fx = floor(x),
          fy = floor(y);
    int x0 = (int)fx, y0 = (int)fy, x1 = x0 + 1, y1 = y0 + 1;
    if (x0 < 0) x0 += image->width;
    if (x1 >= image->width) x1 -= image->width;
    y0 = y0 < 0 ? 0 : y0;
    y1 = y1 >= image->height ? image->height - 1 : y1;
    const uint32_t *above = sky->packed + (size_t)y0 * (size_t)image->width;
    const uint32_t *below = sky->packed + (size_t)y1 * (size_t)image->width;
    Color4 upper = lerp(unpack(above[x0]), unpack(above[x1]), x - fx);
    Color4 lower = lerp(unpack(below[x0]), unpack(below[x1]), x - fx);
    Color4 c = lerp(upper, lower, y - fy) * e->strength;
    return (Rgb){c[0], c[1], c[2]};
}

static Rgb constant(const Environment *e) {
    return (Rgb){e->color[0] * e->strength, e->color[1] * e->strength, e->color[2] * e->strength};
}

static Distribution columns_of(const Sky *sky, int row) {
    return distribution_beside(sky->columns, (size_t)row * sky->stride);
}

/* Density over the sphere at a point of cell (row, column), from that on the unit square. */
static float map_pdf(const Sky *sky, int row, int column, float sin_theta) {
    const Distribution columns = columns_of(sky, row);
    float square = distribution_probability(&sky->rows, row) * distribution_probability(&columns, column) *
                   (float)(sky->height * sky->width);
    return square / (TWO_PI * PI * max(sin_theta, 1e-7f));
}

SkyPoint sky_at(const Sky *sky, Vec3 direction) {
    const Environment *e = sky->environment;
    if (e->kind == ENVIRONMENT_CONSTANT) return (SkyPoint){direction, constant(e), 1.0f / (2.0f * TWO_PI)};
    float u, v;
    to_map(sky, direction, &u, &v);
    int column = (int)clamp(u * (float)sky->width, 0.0f, (float)(sky->width - 1));
    int row = (int)clamp(v * (float)sky->height, 0.0f, (float)(sky->height - 1));
    float sin_theta = sqrt(direction.x * direction.x + direction.z * direction.z);
    return (SkyPoint){direction, image_at(sky, u, v), map_pdf(sky, row, column, sin_theta)};
}

SkyPoint sky_sample(const Sky *sky, float u, float v) {
    const Environment *e = sky->environment;
    if (e->kind == ENVIRONMENT_CONSTANT) {
        float z = 1.0f - 2.0f * u, r = sqrt(max(1.0f - z * z, 0.0f));
        return sky_at(sky, vec3(r * cos(TWO_PI * v), r * sin(TWO_PI * v), z));
    }
    Choice row = distribution_choose(&sky->rows, v);
    const Distribution columns = columns_of(sky, row.index);
    Choice column = distribution_choose(&columns, u);
    float mu = ((float)column.index + column.rest) / (float)sky->width;
    float mv = ((float)row.index + row.rest) / (float)sky->height;
    SkyPoint point = {.direction = from_map(sky, mu, mv), .radiance = image_at(sky, mu, mv)};
    Vec3 d = point.direction;
    float sin_theta = sqrt(d.x * d.x + d.z * d.z);
    point.pdf = map_pdf(sky, row.index, column.index, sin_theta);
    return point;
}

static double sin_of_row(int y, int height) { return (sin)(3.14159265358979 * (y + 0.5) / height); }

static float luminance_of(const WeftImage *image, int x, int y) {
    size_t channels = (size_t)image->channels;
    const float *p = (const float *)image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * channels;
    float luminance = channels >= 3 ? 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] : p[0];
    return max(luminance, 0.0f); /* a file may hold negative colours */
}

/* The luminance of a row of texels, and the same on average over each texel of what is looked up bilinearly
 * along the row: 3/4 of a texel's own and 1/8 of either neighbour's. */
static void blur_row(const WeftImage *image, int y, float *row) {
    int w = image->width;
    float first = luminance_of(image, 0, y), left = luminance_of(image, w - 1, y), own = first;
    for (int x = 0; x < w; x++) {
        float right = x + 1 < w ? luminance_of(image, x + 1, y) : first;
        row[x] = 0.75f * own + 0.125f * (left + right);
        left = own;
        own = right;
    }
}

/* Adds to the cells of row y's texels their luminance as it is looked up, times their solid angle; rows:
 * those above, at and below y as blur_row has them. */
static void add_row(Sky *sky, int y, float *const rows[3], float *cells) {
    const WeftImage *image = &sky->environment->image;
    float solid = (float)sin_of_row(y, image->height);
    float *row = cells + (size_t)((long long)y * sky->height / image->height) * (size_t)sky->width;
    double sum = 0.0;
    for (int x = 0; x < image->width; x++) {
        float light = (0.75f * rows[1][x] + 0.125f * (rows[0][x] + rows[2][x])) * solid;
        row[(long long)x * sky->width / image->width] += light;
        sum += (double)light;
    }
    sky->mean += sum;
}

/* Light over solid angle in each cell of the map, and its mean; lines: room for three rows of texels. */
static void sum_cells(Sky *sky, float *lines, float *cells) {
    const WeftImage *image = &sky->environment->image;
    int last = image->height - 1;
    size_t w = (size_t)image->width;
    float *rows[3] = {lines, lines + w, lines + 2 * w};
    double whole = 0.0;
    blur_row(image, 0, rows[0]);
    blur_row(image, 0, rows[1]);
    for (int y = 0; y <= last; y++) {
        blur_row(image, y < last ? y + 1 : last, rows[2]);
        add_row(sky, y, rows, cells);
        whole += sin_of_row(y, image->height) * image->width;
        float *above = rows[0];
        rows[0] = rows[1], rows[1] = rows[2], rows[2] = above;
    }
    sky->mean /= whole;
}

/* Every cell gets a little on top of its own, so that none with any light in it is hardly ever chosen. */
static void distribute(Sky *sky, float *cells, float *weights, float *rows, float *columns) {
    const WeftImage *image = &sky->environment->image;
    double texels = (double)image->width * image->height / ((double)sky->width * sky->height);
    for (int r = 0; r < sky->height; r++) {
        float *row = cells + (size_t)r * (size_t)sky->width;
        float least = (float)(0.02 * sky->mean * sin_of_row(r, sky->height) * texels);
        for (int c = 0; c < sky->width; c++) row[c] += least;
        Distribution made;
        weights[r] = (float)distribution_make(&made, sky->width, row, columns + (size_t)r * sky->stride);
        if (r == 0) sky->columns = made;
    }
    distribution_make(&sky->rows, sky->height, weights, rows);
}

static bool map_make(Sky *sky, Arena *arena) {
    const WeftImage *image = &sky->environment->image;
    sky->width = image->width < MAP_WIDTH_MAX ? image->width : MAP_WIDTH_MAX;
    sky->height = image->height < MAP_HEIGHT_MAX ? image->height : MAP_HEIGHT_MAX;
    size_t w = (size_t)sky->width, h = (size_t)sky->height;
    sky->stride = distribution_size(sky->width);
    float *rows = distribution_room(arena, distribution_size(sky->height));
    float *columns = distribution_room(arena, h * sky->stride);
    float *cells = alloc_array(w * h, sizeof(float)), *weights = alloc_array(h, sizeof(float));
    float *lines = alloc_array((size_t)image->width, 3 * sizeof(float));
    bool made = rows && columns && cells && weights && lines;
    if (made) sum_cells(sky, lines, cells);
    if (made) distribute(sky, cells, weights, rows, columns);
    free(lines);
    free(weights);
    free(cells);
    return made;
}

bool sky_make(Sky *sky, const Environment *environment, Arena *arena) {
    *sky = (Sky){.environment = environment,
                 .cos_turn = cos(environment->rotation),
                 .sin_turn = sin(environment->rotation)};
    if (environment->kind == ENVIRONMENT_CONSTANT) {
        const float *c = environment->color;
        sky->mean = (double)(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]);
        return true;
    }
    if (!map_make(sky, arena)) return false;
    pack_image(sky, arena);
    return true;
}
