#include "raster/geometry/ray_tree.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { BINS = 16, DEEP = 48 /* from this depth on nodes are halved by number, so that recursion ends */ };

typedef struct RayTreeBuilder {
    const RayBox *boxes;
    RayTree *tree;
} RayTreeBuilder;

static const RayBox nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static RayBox join(RayBox a, RayBox b) { return (RayBox){vec3_least(a.low, b.low), vec3_most(a.high, b.high)}; }

static float half_area(RayBox b) {
    Vec3 d = vec3_sub(b.high, b.low);
    return d.x < 0.0f ? 0.0f : d.x * d.y + d.y * d.z + d.z * d.x;
}

static float axis_of(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static float middle_of(const RayBox *b, int axis) {
    return 0.5f * axis_of(b->low, axis) + 0.5f * axis_of(b->high, axis);
}

/* A plane between two bins of an axis, and what it costs to split there. */
typedef struct RaySplit {
    int axis, bin; /* boxes of the bins up to `bin` are on the first side */
    float cost;    /* area times number, of both sides */
} RaySplit;

/* The bins along an axis, between the least and the greatest middle of the boxes. */
typedef struct Bins {
    float low, scale;
    RayBox box[BINS];
    int count[BINS];
} Bins;

static int bin_of(const Bins *bins, const RayBox *box, int axis) {
    int k = (int)((middle_of(box, axis) - bins->low) * bins->scale);
    return k < 0 ? 0 : k < BINS ? k : BINS - 1;
}

/* Returns false if all middles are at one place. */
static bool fill_bins(const RayTreeBuilder *self, uint32_t first, uint32_t end, int axis, Bins *bins) {
    float low = INFINITY, high = -INFINITY;
    const uint32_t *order = self->tree->order;
    for (uint32_t k = first; k < end; k++) {
        const float at = middle_of(&self->boxes[order[k]], axis);
        low = fminf(low, at);
        high = fmaxf(high, at);
    }
    if (!(high > low)) return false;
    *bins = (Bins){.low = low, .scale = BINS / (high - low)};
    if (!(bins->scale < INFINITY)) return false;
    for (int k = 0; k < BINS; k++) bins->box[k] = nothing;
    for (uint32_t k = first; k < end; k++) {
        const RayBox *box = &self->boxes[order[k]];
        const int bin = bin_of(bins, box, axis);
        bins->box[bin] = join(bins->box[bin], *box);
        bins->count[bin]++;
    }
    return true;
}

/* Improves the split by the planes of one axis. */
static void try_planes(const Bins *bins, int axis, RaySplit *best) {
    float right_cost[BINS];
    RayBox box = nothing;
    int count = 0;
    for (int k = BINS - 1; k > 0; k--) {
        box = join(box, bins->box[k]);
        count += bins->count[k];
        right_cost[k] = half_area(box) * (float)count;
    }
    box = nothing;
    count = 0;
    for (int k = 0; k < BINS - 1; k++) {
        box = join(box, bins->box[k]);
        count += bins->count[k];
        const float cost = half_area(box) * (float)count + right_cost[k + 1];
        if (count && cost < best->cost) *best = (RaySplit){axis, k, cost};
    }
}

/* Moves the boxes of the first side to the front; returns where the other side begins. */
static uint32_t part(const RayTreeBuilder *self, uint32_t first, uint32_t end, const Bins *bins, RaySplit split) {
    uint32_t *order = self->tree->order, middle = first;
    for (uint32_t k = first; k < end; k++) {
        const uint32_t box = order[k];
        if (bin_of(bins, &self->boxes[box], split.axis) > split.bin) continue;
        order[k] = order[middle];
        order[middle++] = box;
    }
    return middle;
}

/* Returns where the second child of a node begins, or `first` if it is to be a leaf. */
static uint32_t split_node(const RayTreeBuilder *self, RayBox box, uint32_t first, uint32_t end, int depth) {
    Bins bins[3];
    const uint32_t count = end - first, half = first + count / 2;
    const float area = half_area(box);
    RaySplit best = {-1, 0, INFINITY};
    if (count == 1) return first;
    for (int axis = 0; axis < 3 && depth < DEEP; axis++)
        if (fill_bins(self, first, end, axis, &bins[axis])) try_planes(&bins[axis], axis, &best);
    const bool pays = best.axis >= 0 && best.cost + area < area * (float)count;
    if (!pays && count <= RAY_LEAF_MOST) return first;
    if (best.axis < 0) return half;
    const uint32_t middle = part(self, first, end, &bins[best.axis], best);
    return middle > first && middle < end ? middle : half;
}

static void build(const RayTreeBuilder *self, uint32_t first, uint32_t end, int depth) {
    RayTree *tree = self->tree;
    RayBox box = nothing;
    for (uint32_t k = first; k < end; k++) box = join(box, self->boxes[tree->order[k]]);
    RayNode *node = &tree->nodes[tree->node_count++];
    const uint32_t middle = split_node(self, box, first, end, depth);
    *node = (RayNode){{box.low.x, box.low.y, box.low.z}, 0.0f, {box.high.x, box.high.y, box.high.z}, -1.0f};
    if (middle == first) {
        node->first = (float)first;
        node->skip = (float)(end - first);
        return;
    }
    build(self, first, middle, depth + 1);
    build(self, middle, end, depth + 1);
    node->skip = (float)tree->node_count;
}

bool ray_tree_make(RayTree *tree, const RayBox *boxes, uint32_t count) {
    *tree = (RayTree){.count = count};
    tree->nodes = alloc_array(2 * (size_t)count, sizeof *tree->nodes);
    tree->order = alloc_array(count, sizeof *tree->order);
    if (!tree->nodes || !tree->order) {
        ray_tree_free(tree);
        return false;
    }
    for (uint32_t k = 0; k < count; k++) tree->order[k] = k;
    const RayTreeBuilder builder = {boxes, tree};
    if (count) build(&builder, 0, count, 0);
    return true;
}

void ray_tree_free(RayTree *tree) {
    free(tree->nodes);
    free(tree->order);
    *tree = (RayTree){0};
}
