#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/light/sky.h"

#include "base/pi.h"
#include "shading/dialect/loop.h"
#include "shading/dialect/rgb.h"

#define TWO_PI 6.28318530717959f

/* The importance map is never finer than this: a cell of a larger image has several texels. */
enum { MAP_WIDTH_MAX = 4096, MAP_HEIGHT_MAX = 2048 };

/* Returns acos to 1e-6. Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical Functions", 1964, 4.4.46. A texel
 * of a 16k map spans 4e-4 radians; the library's calls cost more than the rest of a look-up. */
FN float fast_acos(float x) {
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

/* Returns atan2 to 2e-6, by 4.4.49 there. */
FN float fast_atan2(float y, float x) {
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

/* Converts a world direction to the image's (u, v). */
FN void to_map(const Sky *sky, Vec3 d, float *u, float *v) {
    float x = d.x * sky->cos_rotation - d.z * sky->sin_rotation, z = d.x * sky->sin_rotation + d.z * sky->cos_rotation;
    *u = 0.5f + fast_atan2(x, -z) / TWO_PI;
    *v = fast_acos(clamp(d.y, -1.0f, 1.0f)) / PI;
}

/* Converts the image's (u, v) to a world direction. */
static Vec3 from_map(const Sky *sky, float u, float v) {
    float phi = (u - 0.5f) * TWO_PI, theta = v * PI, s = sin(theta);
    float x = s * sin(phi), z = -s * cos(phi);
    return vec3(x * sky->cos_rotation + z * sky->sin_rotation, cos(theta),
                -x * sky->sin_rotation + z * sky->cos_rotation);
}

/* Decodes RGBE: three mantissas m and one exponent e, m 2^(e - 136). Greg Ward, "Real Pixels", Graphics Gems II,
 * 1991. */
FN Rgb unpack(uint32_t p) {
    uint32_t e = p >> 24, bits = e > 9 ? (e - 9) << 23 : 0;
    float scale;
    memcpy(&scale, &bits, 4);
    return (Rgb){(float)(int32_t)(p & 255u) * scale, (float)(int32_t)((p >> 8) & 255u) * scale,
                 (float)(int32_t)((p >> 16) & 255u) * scale};
}

/* Encodes RGBE. */
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

/* Encodes the image as RGBE if every texel is the same after decoding, as those of .hdr files are. A look-up then reads
 * a third of the memory. */
static void pack_image(Sky *sky, Arena *arena) {
    const WeftImage *image = &sky->environment->image;
    size_t count = (size_t)image->width * (size_t)image->height;
    const float *p = image->pixels;
    if (image->channels != 3) return;
    for (size_t k = 0; k < count; k++) {
        Rgb c = unpack(pack(p + 3 * k));
        const float same[3] = {c.r, c.g, c.b};
        for (size_t j = 0; j < 3; j++)
            if (same[j] < p[3 * k + j] || same[j] > p[3 * k + j]) return;
    }
    sky->packed = arena_array(arena, count, sizeof(uint32_t));
    for (size_t k = 0; sky->packed && k < count; k++) sky->packed[k] = pack(p + 3 * k);
}

/* The image as a look-up reads it. */
typedef struct SkyTexels {
    const uint32_t *packed; /* RGBE; NULL: floats are read */
    const float *floats;
    int width, height;
    int stride;      /* floats a texel */
    int green, blue; /* offsets of their floats; 0 in an image of one channel */
    float strength;
} SkyTexels;

static SkyTexels sky_texels(const Sky *sky) {
    const WeftImage *image = &sky->environment->image;
    int colors = image->channels >= 3;
    return (SkyTexels){sky->packed,     image->pixels, image->width, image->height,
                       image->channels, colors,        2 * colors,   sky->environment->strength};
}

FN Rgb texel_at(SkyTexels t, bool packed, int k) {
    if (packed) return unpack(t.packed[k]);
    return (Rgb){t.floats[k * t.stride], t.floats[k * t.stride + t.green], t.floats[k * t.stride + t.blue]};
}

/* Interpolates the image bilinearly; columns wrap around, rows are clamped. */
FN Rgb image_at(SkyTexels t, bool packed, float u, float v) {
    float x = u * (float)t.width - 0.5f, y = v * (float)t.height - 0.5f, fx = floor(x), fy = floor(y);
    int x0 = (int)fx, y0 = (int)fy, x1 = x0 + 1, y1 = y0 + 1;
    x0 = x0 < 0 ? t.width - 1 : x0;
    x1 = x1 >= t.width ? 0 : x1;
    y0 = (y0 < 0 ? 0 : y0) * t.width;
    y1 = (y1 >= t.height ? t.height - 1 : y1) * t.width;
    Rgb above = rgb_mix(texel_at(t, packed, y0 + x0), texel_at(t, packed, y0 + x1), x - fx);
    Rgb below = rgb_mix(texel_at(t, packed, y1 + x0), texel_at(t, packed, y1 + x1), x - fx);
    return rgb_scale(rgb_mix(above, below, y - fy), t.strength);
}

static Rgb constant(const Environment *e) {
    return (Rgb){e->color[0] * e->strength, e->color[1] * e->strength, e->color[2] * e->strength};
}

/* Returns the distribution of the columns of a row. */
static Distribution columns_of(const Sky *sky, int row) {
    return distribution_offset(sky->columns, (size_t)row * sky->stride);
}

/* Returns the density over the sphere, 1/sr, at a point of cell (row, column), from that on the unit square. */
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
    return (SkyPoint){direction, image_at(sky_texels(sky), sky->packed, u, v), map_pdf(sky, row, column, sin_theta)};
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
    SkyPoint point = {.direction = from_map(sky, mu, mv), .radiance = image_at(sky_texels(sky), sky->packed, mu, mv)};
    Vec3 d = point.direction;
    float sin_theta = sqrt(d.x * d.x + d.z * d.z);
    point.pdf = map_pdf(sky, row.index, column.index, sin_theta);
    return point;
}

/* Cells of the importance map. */
typedef struct Cells {
    int row[ROW_CAPACITY], column[ROW_CAPACITY];
} Cells;

/* Chooses cells with (u, v). Each pass over a level prefetches the memory of the next. */
static void choose_cells(const Sky *sky, int n, const float *u, const float *v, Cells *cells) {
    const Distribution columns = sky->columns;
    int top = columns.levels - 1;
    for (int k = 0; k < n; k++) {
        int row = cells->row[k] = distribution_choose(&sky->rows, v[k]).index;
        cells->column[k] = 0;
        __builtin_prefetch(columns.ends + (size_t)row * sky->stride + columns.first[top]);
    }
    for (int level = top; level >= 0; level--)
        for (int k = 0; k < n; k++) {
            const float *ends = columns.ends + (size_t)cells->row[k] * sky->stride;
            int node = DISTRIBUTION_FAN * cells->column[k];
            node += distribution_count(ends + columns.first[level] + node, u[k]);
            cells->column[k] = node;
            if (level > 0) __builtin_prefetch(ends + columns.first[level - 1] + DISTRIBUTION_FAN * node);
        }
}

/* Prefetches the texels about each cell, if cells have the size of texels. */
static void prefetch_texels(const Sky *sky, int n, const Cells *cells) {
    SkyTexels t = sky_texels(sky);
    if (!t.packed || sky->width != t.width || sky->height != t.height) return;
    for (int k = 0; k < n; k++) {
        const uint32_t *p = t.packed + (size_t)cells->row[k] * (size_t)t.width + (size_t)cells->column[k];
        __builtin_prefetch(p);
        __builtin_prefetch(cells->row[k] + 1 < t.height ? p + t.width : p);
    }
}

/* Samples directions in cells that were chosen with (u, v). */
FN void sample_cells(const Sky *sky, SkyTexels t, bool packed, int n, const float *u, const float *v,
                     const Cells *cells, LightRows *restrict s) {
    const float *ends = sky->columns.ends, *row_ends = sky->rows.ends;
    const int *rows = cells->row, *columns = cells->column;
    int stride = (int)sky->stride;
    float width = (float)sky->width, height = (float)sky->height;
    float cos_rotation = sky->cos_rotation, sin_rotation = sky->sin_rotation, scale = width * height / (TWO_PI * PI);
    EACH(k, (size_t)n) {
        int row = rows[k], column = columns[k];
        int leaf = row * stride + column;
        float begin = ends[leaf - 1], wide = ends[leaf] - begin, top = row_ends[row - 1], high = row_ends[row] - top;
        float mu = ((float)column + min((u[k] - begin) / wide, 0x1.fffffep-1f)) / width;
        float mv = ((float)row + min((v[k] - top) / high, 0x1.fffffep-1f)) / height;
        float phi = (mu - 0.5f) * TWO_PI, theta = mv * PI, sine = sin(theta), x = sine * sin(phi), z = -sine * cos(phi);
        Rgb c = image_at(t, packed, mu, mv);
        s->wi[0][k] = x * cos_rotation + z * sin_rotation;
        s->wi[1][k] = cos(theta);
        s->wi[2][k] = z * cos_rotation - x * sin_rotation;
        s->radiance[0][k] = c.r;
        s->radiance[1][k] = c.g;
        s->radiance[2][k] = c.b;
        s->pdf[k] = wide * high * scale / max(abs(sine), 1e-7f);
        s->distance[k] = LIGHT_FAR;
    }
}

/* Samples cells of a packed image. A loop of vectors has no branch between the forms of texels. */
LOOP(sample_packed_n, (const Sky *sky, int n, const float *u, const float *v, const Cells *cells, LightRows *s),
     (sky, n, u, v, cells, s)) {
    sample_cells(sky, sky_texels(sky), true, n, u, v, cells, s);
}
/* Samples cells of an image of floats. */
LOOP(sample_floats_n, (const Sky *sky, int n, const float *u, const float *v, const Cells *cells, LightRows *s),
     (sky, n, u, v, cells, s)) {
    sample_cells(sky, sky_texels(sky), false, n, u, v, cells, s);
}

/* Samples an environment of one colour. */
static void sample_constant(const Sky *sky, int n, const float *u, const float *v, LightRows *s) {
    for (int k = 0; k < n; k++) {
        SkyPoint p = sky_sample(sky, u[k], v[k]);
        s->wi[0][k] = p.direction.x, s->wi[1][k] = p.direction.y, s->wi[2][k] = p.direction.z;
        s->radiance[0][k] = p.radiance.r, s->radiance[1][k] = p.radiance.g, s->radiance[2][k] = p.radiance.b;
        s->pdf[k] = p.pdf;
        s->distance[k] = LIGHT_FAR;
    }
}

static bool has_map(const Sky *sky) { return sky->environment->kind != ENVIRONMENT_CONSTANT; }

void sky_sample_rows(const Sky *sky, int n, const float *u, const float *v, LightRows *samples) {
    Cells cells;
    if (!has_map(sky)) {
        sample_constant(sky, n, u, v, samples);
        return;
    }
    choose_cells(sky, n, u, v, &cells);
    prefetch_texels(sky, n, &cells);
    (sky->packed ? sample_packed_n : sample_floats_n)(sky, n, u, v, &cells, samples);
}

/* Image coordinates of directions, and the cells there. */
typedef struct Places {
    float u[ROW_CAPACITY], v[ROW_CAPACITY];
    Cells cells;
} Places;

LOOP(find_places_n, (const Sky *sky, int n, const float *x, const float *y, const float *z, Places *restrict at),
     (sky, n, x, y, z, at)) {
    const Sky s = {.cos_rotation = sky->cos_rotation, .sin_rotation = sky->sin_rotation};
    float width = (float)sky->width, height = (float)sky->height;
    EACH(k, (size_t)n) {
        float u, v;
        to_map(&s, vec3(x[k], y[k], z[k]), &u, &v);
        at->u[k] = u;
        at->v[k] = v;
        at->cells.column[k] = (int)clamp(u * width, 0.0f, width - 1.0f);
        at->cells.row[k] = (int)clamp(v * height, 0.0f, height - 1.0f);
    }
}

/* Fills radiance and pdf at places. x, z: of the directions. */
FN void look_up(const Sky *sky, bool packed, int n, const float *x, const float *z, const Places *at,
                LightRows *restrict found) {
    const float *ends = sky->columns.ends, *row_ends = sky->rows.ends;
    const int *rows = at->cells.row, *columns = at->cells.column;
    SkyTexels t = sky_texels(sky);
    int stride = (int)sky->stride;
    float scale = (float)sky->width * (float)sky->height / (TWO_PI * PI);
    EACH(k, (size_t)n) {
        int row = rows[k];
        int leaf = row * stride + columns[k];
        Rgb c = image_at(t, packed, at->u[k], at->v[k]);
        found->radiance[0][k] = c.r;
        found->radiance[1][k] = c.g;
        found->radiance[2][k] = c.b;
        found->pdf[k] = (ends[leaf] - ends[leaf - 1]) * (row_ends[row] - row_ends[row - 1]) * scale /
                        max(sqrt(x[k] * x[k] + z[k] * z[k]), 1e-7f);
    }
}
LOOP(look_up_packed_n, (const Sky *sky, int n, const float *x, const float *z, const Places *at, LightRows *found),
     (sky, n, x, z, at, found)) {
    look_up(sky, true, n, x, z, at, found);
}
LOOP(look_up_floats_n, (const Sky *sky, int n, const float *x, const float *z, const Places *at, LightRows *found),
     (sky, n, x, z, at, found)) {
    look_up(sky, false, n, x, z, at, found);
}

void sky_at_rows(const Sky *sky, int n, const float *const d[3], LightRows *found) {
    Places at;
    if (has_map(sky)) {
        find_places_n(sky, n, d[0], d[1], d[2], &at);
        prefetch_texels(sky, n, &at.cells);
        (sky->packed ? look_up_packed_n : look_up_floats_n)(sky, n, d[0], d[2], &at, found);
        return;
    }
    for (int k = 0; k < n; k++) {
        SkyPoint p = sky_at(sky, vec3(d[0][k], d[1][k], d[2][k]));
        found->radiance[0][k] = p.radiance.r;
        found->radiance[1][k] = p.radiance.g;
        found->radiance[2][k] = p.radiance.b;
        found->pdf[k] = p.pdf;
    }
}

static double sin_of_row(int y, int height) { return (sin)(PI_DOUBLE * (y + 0.5) / height); }

static float luminance_of(const WeftImage *image, int x, int y) {
    size_t channels = (size_t)image->channels;
    const float *p = (const float *)image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * channels;
    float luminance = channels >= 3 ? 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] : p[0];
    return max(luminance, 0.0f); /* a file may contain negative colours */
}

/* Fills a row with the mean over each texel of the luminance interpolated along it: 3/4 of the texel's own, and 1/8 of
 * either neighbour's. */
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

/* Adds the interpolated luminance of row y's texels times their solid angle to their cells. rows: those of blur_row
 * above, at and below y. */
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

/* Adds up luminance times solid angle in each cell, and its mean. lines: storage for three rows of texels. */
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

/* Makes the distributions of rows and columns. Each cell gets 2 % of the mean in addition, so that no cell with any
 * light has too small a density. */
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
    float *rows = distribution_alloc(arena, distribution_size(sky->height));
    float *columns = distribution_alloc(arena, h * sky->stride);
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
                 .cos_rotation = cos(environment->rotation),
                 .sin_rotation = sin(environment->rotation)};
    if (environment->kind == ENVIRONMENT_CONSTANT) {
        const float *c = environment->color;
        sky->mean = (double)(0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]);
        return true;
    }
    if (!map_make(sky, arena)) return false;
    pack_image(sky, arena);
    return true;
}
