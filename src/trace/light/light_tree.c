#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/light/light_tree.h"

#include "shading/dialect/loop.h"

/* The columns of a node in the table of nodes. The cone of normals has the half angle theta_o. */
enum {
    NODE_CENTRE = 0,
    NODE_RADIUS2 = 3,
    NODE_AXIS = 4,
    NODE_COS = 7, /* of theta_o */
    NODE_SIN,
    NODE_POWER,
    NODE_TWO_SIDED, /* 1, or 0 */
    NODE_FLOATS = 12
};

FN float sin_of(float cosine) { return sqrt(max(1.0f - cosine * cosine, 0.0f)); }

/* ---- building the tree ---- */

/* From this depth on nodes are halved, so that no tree is deeper than 72. */
enum { BINS = 12, DEPTH_BALANCED = 40 };

typedef struct Builder {
    LightTree *tree;
    const LightBounds *lights;
    int *order; /* lights, those of a node side by side */
    int nodes;
} Builder;

typedef struct LightSplit {
    int axis;
    int bin; /* the last one of the first part */
    float cost;
} LightSplit;

static float along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static float centre_of(const LightBounds *light, int axis) {
    return 0.5f * (along(light->low, axis) + along(light->high, axis));
}

/* Returns the bin of a light between the lowest and highest centre. */
static int bin_of(const LightBounds *light, int axis, float low, float high) {
    int bin = (int)(BINS * (centre_of(light, axis) - low) / (high - low));
    return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

/* Tries the planes between bins across an axis. longer: ratio of the box's longest side to that along the axis. */
static void try_axis(const Builder *b, int begin, int end, int axis, float low, float high, float longer,
                     LightSplit *best) {
    LightBounds bins[BINS] = {0}, above[BINS] = {0}, below = {0};
    for (int k = begin; k < end; k++) {
        const LightBounds *light = &b->lights[b->order[k]];
        LightBounds *bin = &bins[bin_of(light, axis, low, high)];
        *bin = light_bounds_join(*bin, *light);
    }
    for (int k = BINS - 1; k > 0; k--) above[k - 1] = light_bounds_join(bins[k], above[k]);
    for (int k = 0; k + 1 < BINS; k++) {
        below = light_bounds_join(below, bins[k]);
        float cost = longer * (light_bounds_cost(&below) + light_bounds_cost(&above[k]));
        bool parts = below.power > 0.0f && above[k].power > 0.0f;
        if (parts && cost < best->cost) *best = (LightSplit){axis, k, cost};
    }
}

/* Sorts the lights of a node into two parts; returns the beginning of the second. */
static int split_lights(const Builder *b, int begin, int end, const LightBounds *all, bool balanced) {
    float low[3], high[3], longest = 0.0f;
    for (int a = 0; a < 3; a++) {
        low[a] = 1e30f, high[a] = -1e30f;
        for (int k = begin; k < end; k++) {
            float place = centre_of(&b->lights[b->order[k]], a);
            low[a] = fminf(low[a], place), high[a] = fmaxf(high[a], place);
        }
        longest = fmaxf(longest, along(all->high, a) - along(all->low, a));
    }
    LightSplit best = {.cost = 1e38f};
    for (int a = 0; a < 3 && !balanced; a++)
        if (high[a] > low[a])
            try_axis(b, begin, end, a, low[a], high[a],
                     longest / fmaxf(along(all->high, a) - along(all->low, a), 1e-3f * longest), &best);
    if (!(best.cost < 1e38f)) return begin + (end - begin) / 2;
    int middle = begin;
    for (int k = begin; k < end; k++) {
        int light = b->order[k];
        if (bin_of(&b->lights[light], best.axis, low[best.axis], high[best.axis]) > best.bin) continue;
        b->order[k] = b->order[middle];
        b->order[middle++] = light;
    }
    return middle;
}

static void put_node(float *node, const LightBounds *bounds) {
    Vec3 centre = vec3_scale(vec3_add(bounds->low, bounds->high), 0.5f);
    Vec3 out = vec3_sub(bounds->high, centre);
    const float numbers[NODE_FLOATS] = {[NODE_CENTRE] = centre.x,
                                        centre.y,
                                        centre.z,
                                        [NODE_RADIUS2] = vec3_dot(out, out),
                                        [NODE_AXIS] = bounds->axis.x,
                                        bounds->axis.y,
                                        bounds->axis.z,
                                        [NODE_COS] = bounds->cos_spread,
                                        [NODE_SIN] = sin_of(bounds->cos_spread),
                                        [NODE_POWER] = bounds->power,
                                        [NODE_TWO_SIDED] = bounds->two_sided ? 1.0f : 0.0f};
    memcpy(node, numbers, sizeof numbers);
}

static void build_node(Builder *b, int node, int begin, int end, int depth) {
    LightTree *tree = b->tree;
    LightBounds all = {0};
    for (int k = begin; k < end; k++) all = light_bounds_join(all, b->lights[b->order[k]]);
    put_node(tree->nodes + (size_t)NODE_FLOATS * (size_t)node, &all);
    if (depth > tree->depth) tree->depth = depth;
    if (end - begin == 1) {
        tree->child[node] = ~b->order[begin];
        tree->leaf[b->order[begin]] = node;
        return;
    }
    int middle = split_lights(b, begin, end, &all, depth >= DEPTH_BALANCED), first = b->nodes;
    b->nodes += 2;
    tree->child[node] = first;
    tree->parent[first] = tree->parent[first + 1] = node;
    build_node(b, first, begin, middle, depth + 1);
    build_node(b, first + 1, middle, end, depth + 1);
}

bool light_tree_make(LightTree *tree, int count, const LightBounds *lights, Arena *arena) {
    size_t most = 2 * (size_t)count;
    Builder b = {.tree = tree, .lights = lights, .nodes = 1};
    *tree = (LightTree){.nodes = arena_array(arena, most * NODE_FLOATS, sizeof(float)),
                        .child = arena_array(arena, most, sizeof(int)),
                        .parent = arena_array(arena, most, sizeof(int)),
                        .leaf = arena_array(arena, (size_t)count, sizeof(int))};
    b.order = alloc_array((size_t)count, sizeof(int));
    bool made = tree->nodes && tree->child && tree->parent && tree->leaf && b.order;
    int emitting = 0;
    for (int k = 0; made && k < count; k++) {
        tree->leaf[k] = -1;
        if (lights[k].power > 0.0f) b.order[emitting++] = k;
    }
    if (made) build_node(&b, 0, 0, emitting, 0);
    free(b.order);
    return made;
}

/* ---- sampling it ---- */

/* Returns cos(max(a - b, 0)), a and b in [0, pi]. */
FN float cos_less(float sin_a, float cos_a, float sin_b, float cos_b) {
    return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
/* Returns sin(max(a - b, 0)), a and b in [0, pi]. */
FN float sin_less(float sin_a, float cos_a, float sin_b, float cos_b) {
    return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

/* Returns I of light_tree.h. theta_u is half the angle under which the sphere is seen. */
FN float importance(const float *nodes, int node, Dir p, Dir n) {
    int k = node * NODE_FLOATS;
    float x = p.x - nodes[k], y = p.y - nodes[k + 1], z = p.z - nodes[k + 2];
    float d2 = x * x + y * y + z * z, r2 = nodes[k + NODE_RADIUS2], r = 1.0f / sqrt(max(d2, 1e-30f));
    bool inside = d2 <= r2;
    float sin_u = inside ? 0.0f : sqrt(r2) * r, cos_u = inside ? -1.0f : sin_of(sin_u);
    float cos_w = (x * nodes[k + NODE_AXIS] + y * nodes[k + NODE_AXIS + 1] + z * nodes[k + NODE_AXIS + 2]) * r;
    float cos_t = clamp(nodes[k + NODE_TWO_SIDED] > 0.0f ? abs(cos_w) : cos_w, -1.0f, 1.0f);
    float sin_t = sin_of(cos_t), sin_o = nodes[k + NODE_SIN], cos_o = nodes[k + NODE_COS];
    float cos_a = cos_less(sin_t, cos_t, sin_o, cos_o), sin_a = sin_less(sin_t, cos_t, sin_o, cos_o);
    float cos_e = cos_less(sin_a, cos_a, sin_u, cos_u);
    float cos_i = clamp(-(x * n.x + y * n.y + z * n.z) * r, -1.0f, 1.0f);
    bool facing = n.x * n.x + n.y * n.y + n.z * n.z > 0.5f;
    float cos_r = facing ? cos_less(sin_of(cos_i), cos_i, sin_u, cos_u) : 1.0f;
    return nodes[k + NODE_POWER] * max(cos_e, 0.0f) * max(cos_r, 0.0f) / max(max(d2, r2), 1e-30f);
}

/* Returns the probability of the first of two children with these importances; 0 if both are 0. */
FN float first_probability(float a, float b) { return a / max(a + b, 1e-38f); }

/* Steps down one level for all points that are not at a leaf. */
LOOP(descend_n,
     (const LightTree *tree, int n, const float *const point[3], const float *const normal[3], float *restrict u,
      int *restrict at, float *restrict probability),
     (tree, n, point, normal, u, at, probability)) {
    const float *nodes = tree->nodes;
    const int *child = tree->child;
    const float *px = point[0], *py = point[1], *pz = point[2], *nx = normal[0], *ny = normal[1], *nz = normal[2];
    EACH(k, (size_t)n) {
        int node = at[k], down = child[node];
        bool leaf = down < 0;
        int first = leaf ? node : down, second = leaf ? node : down + 1;
        Dir p = dir(px[k], py[k], pz[k]), m = dir(nx[k], ny[k], nz[k]);
        float a = importance(nodes, first, p, m), b = importance(nodes, second, p, m);
        float part = first_probability(a, b), x = u[k];
        bool left = x < part;
        float width = left ? part : a + b > 0.0f ? 1.0f - part : 0.0f;
        float rest = (left ? x : x - part) / max(width, 1e-30f);
        at[k] = left ? first : second;
        u[k] = leaf ? x : min(rest, 0x1.fffffep-1f);
        probability[k] = leaf ? probability[k] : probability[k] * width;
    }
}

void light_tree_choose_rows(const LightTree *tree, int n, const float *const point[3], const float *const normal[3],
                            float *u, int *light, float *probability) {
    for (int k = 0; k < n; k++) {
        light[k] = 0;
        probability[k] = 1.0f;
    }
    for (int level = 0; level < tree->depth; level++) descend_n(tree, n, point, normal, u, light, probability);
    for (int k = 0; k < n; k++) light[k] = ~tree->child[light[k]];
}

float light_tree_probability(const LightTree *tree, int light, Vec3 point, Vec3 normal) {
    Dir p = dir(point.x, point.y, point.z), n = dir(normal.x, normal.y, normal.z);
    int node = tree->leaf[light];
    if (node < 0) return 0.0f;
    float probability = 1.0f;
    while (node > 0) {
        int up = tree->parent[node], first = tree->child[up];
        float a = importance(tree->nodes, first, p, n), b = importance(tree->nodes, first + 1, p, n);
        float part = first_probability(a, b);
        probability *= node == first ? part : a + b > 0.0f ? 1.0f - part : 0.0f;
        node = up;
    }
    return probability;
}
