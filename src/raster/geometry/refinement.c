#include "raster/geometry/refinement.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "raster/gl/box.h"

enum { ROUNDS = 24, TRIANGLES_MOST = 1 << 19 };

#define NOT_HALVED UINT32_MAX

static float gap(float low_a, float high_a, float low_b, float high_b) {
    return fmaxf(fmaxf(low_b - high_a, low_a - high_b), 0.0f);
}

static float box_distance(const Box *a, const Box *b) {
    return vec3_length(vec3(gap(a->low.x, a->high.x, b->low.x, b->high.x),
                            gap(a->low.y, a->high.y, b->low.y, b->high.y),
                            gap(a->low.z, a->high.z, b->low.z, b->high.z)));
}

/* Returns the longest edge with its middle in a box that box b allows, before occlusion is considered. */
static float longest(const Box *middle, const Box *b) {
    return fmaxf(0.5f * box_distance(middle, b), box_size(*b) / 24.0f);
}

/* Returns the factor by which an edge that is halved may be shorter. */
static float finer(const EdgeTest *test) { return test ? REFINEMENT_FINER : 1.0f; }

/* A mesh that is being refined. */
typedef struct Refiner {
    RefinedMesh out;
    float *position;
    uint32_t own_count; /* vertices of the mesh itself */
    const Box *near;    /* boxes of the meshes that may halve its edges */
    int near_count;
    const EdgeTest *test; /* NULL: only the boxes decide */
} Refiner;

typedef struct LongEdge {
    uint32_t a, b;   /* a < b */
    uint32_t corner; /* the triangle's corner from which it starts */
} LongEdge;

static Vec3 at(const Refiner *self, uint32_t vertex) { return vec3_load(self->position + 3 * (size_t)vertex); }

static LongEdge edge_from(const uint32_t *index, uint32_t corner) {
    uint32_t a = index[corner], b = index[corner % 3 == 2 ? corner - 2 : corner + 1];
    return a < b ? (LongEdge){a, b, corner} : (LongEdge){b, a, corner};
}

static bool is_too_long(const Refiner *self, const LongEdge *edge) {
    Vec3 a = at(self, edge->a), b = at(self, edge->b), middle = vec3_scale(vec3_add(a, b), 0.5f);
    const Box box = {middle, middle};
    float length = vec3_length(vec3_sub(a, b)) * finer(self->test);
    bool may = false;
    for (int k = 0; k < self->near_count && !may; k++) may = length > longest(&box, &self->near[k]);
    return may && (!self->test || self->test->differ(self->test->user, self->test->mesh, edge->a, edge->b));
}

static int by_ends(const void *x, const void *y) {
    const LongEdge *p = x, *q = y;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return p->b < q->b ? -1 : p->b > q->b;
}

/* Adds the vertex in the middle of each edge that is too long; halves: of each corner, that of the edge from it. */
static bool halve(Refiner *self, LongEdge *edges, uint32_t count, uint32_t *halves) {
    RefinedMesh *out = &self->out;
    qsort(edges, count, sizeof *edges, by_ends);
    uint32_t most = out->vertex_count + count;
    uint32_t(*ends)[2] = realloc_array(out->ends, most - self->own_count, sizeof *ends);
    if (ends) out->ends = ends;
    float *position = realloc_array(self->position, most, 3 * sizeof *position);
    if (position) self->position = position;
    if (!ends || !position) return false;
    for (uint32_t k = 0; k < count; k++) {
        const LongEdge *e = &edges[k];
        if (k == 0 || by_ends(e, e - 1) != 0) {
            uint32_t fresh = out->vertex_count++;
            ends[fresh - self->own_count][0] = e->a;
            ends[fresh - self->own_count][1] = e->b;
            for (size_t c = 0; c < 3; c++)
                position[3 * (size_t)fresh + c] =
                    0.5f * (position[3 * (size_t)e->a + c] + position[3 * (size_t)e->b + c]);
        }
        halves[e->corner] = out->vertex_count - 1;
    }
    return true;
}

static uint32_t *put(uint32_t *to, uint32_t a, uint32_t b, uint32_t c) {
    to[0] = a, to[1] = b, to[2] = c;
    return to + 3;
}

/* Cuts triangle v into one to four. h: the middles of the edges from v[0], v[1] and v[2], or NOT_HALVED. Returns the
 * end of the written indices. */
static uint32_t *cut(const uint32_t v[3], const uint32_t h[3], uint32_t *to) {
    int halved = 0, first = 0;
    for (int k = 0; k < 3; k++) halved += h[k] != NOT_HALVED;
    if (halved == 0) return put(to, v[0], v[1], v[2]);
    /* the corners are rotated so that a single middle is the first, and with two the last is missing */
    while (halved < 3 && !(h[first] != NOT_HALVED && (h[(first + 2) % 3] == NOT_HALVED))) first++;
    uint32_t a = v[first], b = v[(first + 1) % 3], c = v[(first + 2) % 3];
    uint32_t ab = h[first], bc = h[(first + 1) % 3], ca = h[(first + 2) % 3];
    to = halved == 1 ? put(to, ab, b, c) : put(put(to, ab, b, bc), ab, bc, halved == 2 ? c : ca);
    if (halved < 3) return put(to, a, ab, c);
    return put(put(to, a, ab, ca), ca, bc, c);
}

/* Halves each edge that is too long once, and sets *any if there was one. Returns false if memory is short. */
static bool refine_once(Refiner *self, bool *any) {
    RefinedMesh *out = &self->out;
    uint32_t corners = 3 * out->triangle_count, long_count = 0;
    *any = false;
    for (uint32_t k = 0; k < corners; k++) {
        LongEdge e = edge_from(out->index, k);
        long_count += is_too_long(self, &e);
    }
    if (long_count == 0 || out->triangle_count + long_count > TRIANGLES_MOST) return true;
    LongEdge *edges = alloc_array(long_count, sizeof *edges);
    uint32_t *halves = alloc_array(corners, sizeof *halves);
    uint32_t *index = alloc_array(out->triangle_count + long_count, 3 * sizeof *index), *to = index;
    bool made = edges && halves && index;
    for (uint32_t k = 0, n = 0; made && k < corners; k++) {
        LongEdge e = edge_from(out->index, k);
        halves[k] = NOT_HALVED;
        if (is_too_long(self, &e)) edges[n++] = e;
    }
    made = made && halve(self, edges, long_count, halves);
    for (uint32_t k = 0; made && k < corners; k += 3) to = cut(out->index + k, halves + k, to);
    if (made) {
        out->triangle_count += long_count;
        free(out->index);
        out->index = index;
        *any = true;
    } else {
        free(index);
    }
    free(edges);
    free(halves);
    return made;
}

static float longest_edge(const Mesh *mesh) {
    float most = 0.0f;
    for (uint32_t k = 0; k < 3 * mesh->triangle_count; k++) {
        LongEdge e = edge_from(mesh->index, k);
        Vec3 a = vec3_load(mesh->position + 3 * (size_t)e.a), b = vec3_load(mesh->position + 3 * (size_t)e.b);
        most = fmaxf(most, vec3_length(vec3_sub(a, b)));
    }
    return most;
}

/* Refines mesh m further in at most `rounds` rounds, and sets *any if it was cut. boxes: of all meshes; near: scratch
 * space of as many. Returns false if memory is short. */
static bool refine(const WeftScene *scene, int m, const Box *boxes, Box *near, const EdgeTest *test, int rounds,
                   RefinedMesh *refined, bool *any) {
    const Mesh *mesh = &scene->meshes[m];
    const uint32_t *index = refined->index ? refined->index : mesh->index;
    Refiner self = {.out = *refined, .own_count = mesh->vertex_count, .near = near, .test = test};
    float most = longest_edge(mesh) * finer(test);
    for (int k = 0; k < scene_own_meshes(scene); k++)
        if (k != m && most > longest(&boxes[m], &boxes[k])) near[self.near_count++] = boxes[k];
    if (self.near_count == 0) return true;
    size_t corners = 3 * (size_t)self.out.triangle_count;
    self.position = alloc_array(self.out.vertex_count, 3 * sizeof(float));
    if (!refined->index) self.out.index = alloc_array(corners, sizeof(uint32_t));
    bool made = self.position && self.out.index, more = made;
    if (made) refined_fill(refined, mesh, mesh->position, 3, self.position);
    if (made && !refined->index) memcpy(self.out.index, index, corners * sizeof(uint32_t));
    for (int round = 0; more && made && round < rounds; round++) {
        made = refine_once(&self, &more);
        *any |= more;
    }
    free(self.position);
    if (self.out.vertex_count == mesh->vertex_count) free(self.out.index), self.out.index = NULL;
    *refined = self.out;
    return made;
}

/* Refines all meshes. test, without its mesh, decides together with the boxes; may be NULL. Returns false if memory is
 * short. */
static bool refine_all(const WeftScene *scene, Refinement *self, const EdgeTest *test, int rounds, bool *any) {
    int count = scene_own_meshes(scene);
    Box *boxes = alloc_array((size_t)count, 2 * sizeof *boxes);
    bool made = boxes != NULL;
    for (int m = 0; made && m < count; m++) boxes[m] = mesh_box(&scene->meshes[m]);
    for (int m = 0; made && m < count; m++) {
        EdgeTest own = test ? *test : (EdgeTest){0};
        own.mesh = m;
        made = refine(scene, m, boxes, boxes + count, test ? &own : NULL, rounds, &self->meshes[m], any);
    }
    free(boxes);
    return made;
}

/* Makes a refinement that leaves all meshes as they are. Returns false if memory is short. */
static bool start(const WeftScene *scene, Refinement *out) {
    int count = scene_own_meshes(scene);
    *out = (Refinement){alloc_array((size_t)count, sizeof(RefinedMesh)), count};
    for (int m = 0; out->meshes && m < count; m++)
        out->meshes[m] = (RefinedMesh){scene->meshes[m].vertex_count, scene->meshes[m].triangle_count, NULL, NULL};
    return out->meshes != NULL;
}

WeftResult refinement_make(const WeftScene *scene, Refinement *out, WeftError *error) {
    bool any = false;
    if (start(scene, out) && refine_all(scene, out, NULL, ROUNDS, &any)) return WEFT_OK;
    refinement_free(out);
    return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

/* Copies a refined mesh. Returns false if memory is short. */
static bool copy(const RefinedMesh *from, uint32_t own_count, RefinedMesh *to) {
    size_t added = from->vertex_count - own_count, corners = 3 * (size_t)from->triangle_count;
    *to = (RefinedMesh){from->vertex_count, from->triangle_count, NULL, NULL};
    if (!from->index) return true;
    to->ends = alloc_array(added, sizeof *to->ends);
    to->index = alloc_array(corners, sizeof *to->index);
    if (!to->ends || !to->index) return false;
    memcpy(to->ends, from->ends, added * sizeof *to->ends);
    memcpy(to->index, from->index, corners * sizeof *to->index);
    return true;
}

bool refinement_copy(const WeftScene *scene, const Refinement *from, Refinement *out) {
    bool made = start(scene, out);
    for (int m = 0; made && m < from->count; m++)
        made = copy(&from->meshes[m], scene->meshes[m].vertex_count, &out->meshes[m]);
    if (!made) refinement_free(out);
    return made;
}

bool refinement_halve(const WeftScene *scene, const Refinement *from, const EdgeTest *test, Refinement *out) {
    bool any = false;
    if (!refinement_copy(scene, from, out)) return false;
    if (refine_all(scene, out, test, 1, &any) && any) return true;
    refinement_free(out);
    return false;
}

void refinement_free(Refinement *refinement) {
    for (int m = 0; refinement->meshes && m < refinement->count; m++) {
        free(refinement->meshes[m].ends);
        free(refinement->meshes[m].index);
    }
    free(refinement->meshes);
    *refinement = (Refinement){0};
}

RefinedMesh refinement_mesh(const Refinement *refinement, const WeftScene *scene, int m) {
    const Mesh *mesh = &scene->meshes[m];
    RefinedMesh refined = {mesh->vertex_count, mesh->triangle_count, NULL, NULL};
    if (m < refinement->count) refined = refinement->meshes[m];
    if (!refined.index) refined.index = mesh->index;
    return refined;
}

void refined_fill(const RefinedMesh *refined, const Mesh *mesh, const float *own, size_t width, float *to) {
    memcpy(to, own, mesh->vertex_count * width * sizeof *to);
    for (uint32_t k = mesh->vertex_count; k < refined->vertex_count; k++) {
        const uint32_t *ends = refined->ends[k - mesh->vertex_count];
        for (size_t c = 0; c < width; c++)
            to[k * width + c] = 0.5f * (to[ends[0] * width + c] + to[ends[1] * width + c]);
    }
}
