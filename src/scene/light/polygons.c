#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "scene/light/polygons.h"

#include "scene/record/material_at.h"

bool material_emits(const Material *material) {
    const float *e = material->inputs[INPUT_emission].value;
    return !material->unlit && (e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f) &&
           material->inputs[INPUT_emission_strength].value[0] > 0.0f;
}

/* A polygon that may still grow. Corners are numbers of places, so that two meet where these are equal. */
typedef struct Face {
    uint32_t corners[LIGHT_CORNERS];
    int count; /* 0: it was taken into another */
    Vec3 normal;
    float area, light[3]; /* light: radiance times area */
    int round;            /* in which it grew last */
} Face;

/* The light of one mesh. */
typedef struct Patch {
    const WeftScene *scene;
    const Mesh *mesh;
    uint32_t *place; /* of a vertex: the first vertex at the same position */
    Face *faces;
    size_t face_count, edge_count;
    struct Edge *edges; /* sorted by from, to */
} Patch;

typedef struct Edge {
    uint32_t from, to, face;
} Edge;

static Vec3 place_at(const Patch *patch, uint32_t place) {
    return vec3_load(patch->mesh->position + 3 * (size_t)place);
}

typedef struct Spot {
    float p[3];
    uint32_t vertex;
} Spot;

static int compare_positions(const Spot *s, const Spot *t) {
    for (int c = 0; c < 3; c++)
        if (s->p[c] < t->p[c] || s->p[c] > t->p[c]) return s->p[c] < t->p[c] ? -1 : 1;
    return 0;
}

static int compare_spots(const void *a, const void *b) {
    const Spot *s = a, *t = b;
    int order = compare_positions(s, t);
    return order ? order : s->vertex < t->vertex ? -1 : s->vertex > t->vertex;
}

/* Gives vertices at the same position one place, even if normals or texture coordinates differ. Returns false if memory
 * is short. */
static bool weld(Patch *patch) {
    uint32_t n = patch->mesh->vertex_count;
    Spot *spots = alloc_array(n, sizeof *spots);
    patch->place = alloc_array(n, sizeof *patch->place);
    if (!spots || !patch->place) {
        free(spots);
        return false;
    }
    for (uint32_t v = 0; v < n; v++) {
        memcpy(spots[v].p, patch->mesh->position + 3 * (size_t)v, sizeof spots[v].p);
        spots[v].vertex = v;
    }
    qsort(spots, n, sizeof *spots, compare_spots);
    for (uint32_t k = 0, first = 0; k < n; k++) {
        if (compare_positions(&spots[k], &spots[first]) != 0) first = k;
        patch->place[spots[k].vertex] = spots[first].vertex;
    }
    free(spots);
    return true;
}

/* Returns emission times opacity at a point of a triangle with weights b and c of its second and third corner. */
static Rgb emission_at(const Patch *patch, const uint32_t *index, float b, float c) {
    const Mesh *mesh = patch->mesh;
    const Material *material = &patch->scene->materials[mesh->material];
    float weight[3] = {1.0f - b - c, b, c}, uv[2][2] = {{0.0f, 0.0f}, {0.0f, 0.0f}};
    float color[4] = {0.0f, 0.0f, 0.0f, mesh->color ? 0.0f : 1.0f};
    for (int k = 0; k < 3; k++) {
        for (int set = 0; set < 2; set++)
            for (int n = 0; mesh->texcoord[set] && n < 2; n++)
                uv[set][n] += weight[k] * mesh->texcoord[set][2 * (size_t)index[k] + (size_t)n];
        if (mesh->color) color[3] += weight[k] * mesh->color[4 * (size_t)index[k] + 3];
    }
    float opacity = material_opacity(patch->scene, material, uv, color[3]);
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    Surface s = material_plain(material);
    material_textures(patch->scene, material, uv, white, &s);
    return rgb_scale(s.emission, s.emission_strength * opacity);
}

/* Returns the mean emission of a triangle over the middles of side^2 triangles of equal size. */
static Rgb mean_emission(const Patch *patch, const uint32_t *index) {
    int side = patch->mesh->triangle_count <= 1024 ? 16 : 3;
    float step = 1.0f / (float)side;
    Rgb sum = rgb_grey(0.0f);
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side - i; j++) {
            sum = rgb_add(sum,
                          emission_at(patch, index, ((float)i + 1.0f / 3.0f) * step, ((float)j + 1.0f / 3.0f) * step));
            if (j + 1 < side - i)
                sum = rgb_add(
                    sum, emission_at(patch, index, ((float)i + 2.0f / 3.0f) * step, ((float)j + 2.0f / 3.0f) * step));
        }
    return rgb_scale(sum, step * step);
}

/* Makes a face of each triangle that has an area and emits light. Returns false if memory is short. */
static bool begin_faces(Patch *patch) {
    const Mesh *mesh = patch->mesh;
    patch->faces = alloc_array(mesh->triangle_count, sizeof *patch->faces);
    if (!patch->faces) return false;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *index = mesh->index + 3 * t;
        Vec3 p[3];
        for (int k = 0; k < 3; k++) p[k] = place_at(patch, index[k]);
        Vec3 ab = vec3_sub(p[1], p[0]), ac = vec3_sub(p[2], p[0]), n = vec3_cross(ab, ac);
        float twice = vec3_length(n), size = vec3_dot(ab, ab) + vec3_dot(ac, ac);
        if (!(twice > 1e-6f * size)) continue; /* a needle has no plane */
        Rgb light = rgb_scale(mean_emission(patch, index), 0.5f * twice);
        if (!(rgb_max3(light) > 0.0f)) continue;
        patch->faces[patch->face_count++] = (Face){
            .corners = {patch->place[index[0]], patch->place[index[1]], patch->place[index[2]]},
            .count = 3,
            .normal = vec3_scale(n, 1.0f / twice),
            .area = 0.5f * twice,
            .light = {light.r, light.g, light.b},
        };
    }
    return true;
}

static int compare_edges(const void *a, const void *b) {
    const Edge *e = a, *f = b;
    if (e->from != f->from) return e->from < f->from ? -1 : 1;
    if (e->to != f->to) return e->to < f->to ? -1 : 1;
    return e->face < f->face ? -1 : e->face > f->face;
}

static void list_edges(Patch *patch) {
    patch->edge_count = 0;
    for (size_t f = 0; f < patch->face_count; f++) {
        const Face *face = &patch->faces[f];
        for (int k = 0; k < face->count; k++)
            patch->edges[patch->edge_count++] =
                (Edge){face->corners[k], face->corners[(k + 1) % face->count], (uint32_t)f};
    }
    qsort(patch->edges, patch->edge_count, sizeof *patch->edges, compare_edges);
}

/* Returns the face across an edge, or NULL if there is none, or more than one. */
static Face *across(const Patch *patch, uint32_t from, uint32_t to) {
    size_t low = 0, high = patch->edge_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const Edge *e = &patch->edges[middle];
        if (e->from < to || (e->from == to && e->to < from))
            low = middle + 1;
        else
            high = middle;
    }
    const Edge *e = patch->edges + low, *end = patch->edges + patch->edge_count;
    if (e == end || e->from != to || e->to != from) return NULL;
    bool several = e + 1 < end && e[1].from == to && e[1].to == from;
    return several ? NULL : &patch->faces[e->face];
}

static bool in_one_plane(const Patch *patch, const Face *a, const Face *b) {
    if (vec3_dot(a->normal, b->normal) < 0.999f) return false;
    Vec3 origin = place_at(patch, a->corners[0]);
    for (int k = 0; k < b->count; k++) {
        Vec3 to = vec3_sub(place_at(patch, b->corners[k]), origin);
        if (fabsf(vec3_dot(to, a->normal)) > 1e-4f * vec3_length(to)) return false;
    }
    return true;
}

/* Removes the corners of a ring that lie on a straight side. Returns their number, or -1 if the ring is not convex. */
static int straighten(const Patch *patch, Vec3 normal, uint32_t *ring, int count) {
    uint32_t kept[2 * LIGHT_CORNERS];
    int n = 0;
    for (int k = 0; k < count; k++) {
        Vec3 at = place_at(patch, ring[k]);
        Vec3 in = vec3_sub(at, place_at(patch, ring[(k + count - 1) % count]));
        Vec3 out = vec3_sub(place_at(patch, ring[(k + 1) % count]), at);
        float sine = vec3_dot(vec3_cross(in, out), normal), most = vec3_length(in) * vec3_length(out);
        if (sine < -1e-4f * most) return -1;
        if (sine > 1e-4f * most)
            kept[n++] = ring[k];
        else if (vec3_dot(in, out) < 0.0f)
            return -1; /* back along itself */
    }
    memcpy(ring, kept, (size_t)n * sizeof *ring);
    return n;
}

/* Makes the ring of face a with face b across its side k. Returns the number of corners, or 0 if it is no convex
 * polygon of at most LIGHT_CORNERS. */
static int joined(const Patch *patch, const Face *a, int k, const Face *b, uint32_t *ring) {
    int n = 0, at = 0;
    while (at < b->count && b->corners[at] != a->corners[k]) at++;
    for (int c = 1; c <= a->count; c++) ring[n++] = a->corners[(k + c) % a->count];
    for (int c = 1; c + 1 < b->count; c++) ring[n++] = b->corners[(at + c) % b->count];
    n = straighten(patch, a->normal, ring, n);
    return n >= 3 && n <= LIGHT_CORNERS ? n : 0;
}

typedef struct Join {
    Face *other;
    int count;
    float side; /* length of the side in common */
    uint32_t ring[2 * LIGHT_CORNERS];
} Join;

/* Finds the neighbour with which a face has the fewest corners, and among those the longest common side, so that
 * triangles become the squares that they were cut from. Neighbours that grew in this round are left out, since their
 * sides changed. */
static Join best_join(const Patch *patch, const Face *face, int round) {
    Join best = {.count = LIGHT_CORNERS + 1};
    for (int k = 0; k < face->count; k++) {
        uint32_t from = face->corners[k], to = face->corners[(k + 1) % face->count];
        Join join = {.other = across(patch, from, to)};
        if (!join.other || join.other == face || join.other->round == round || !in_one_plane(patch, face, join.other))
            continue;
        join.count = joined(patch, face, k, join.other, join.ring);
        join.side = vec3_length(vec3_sub(place_at(patch, to), place_at(patch, from)));
        if (join.count && (join.count < best.count || (join.count == best.count && join.side > best.side))) best = join;
    }
    return best;
}

/* Joins each face with at most one other, so that faces grow alike: triangles to squares, squares to rows, rows to
 * grids. Returns false if none was joined. */
static bool grow(Patch *patch, int round) {
    bool any = false;
    list_edges(patch);
    for (size_t f = 0; f < patch->face_count; f++) {
        Face *face = &patch->faces[f];
        if (!face->count || face->round == round) continue;
        Join join = best_join(patch, face, round);
        if (!join.other) continue;
        memcpy(face->corners, join.ring, sizeof face->corners);
        face->count = join.count;
        face->area += join.other->area;
        for (int c = 0; c < 3; c++) face->light[c] += join.other->light[c];
        join.other->count = 0;
        face->round = join.other->round = round;
        any = true;
    }
    return any;
}

static LightPolygon finish(const Patch *patch, const Face *face) {
    LightPolygon light = {.count = face->count, .normal = face->normal, .area = face->area};
    light.two_sided = patch->scene->materials[patch->mesh->material].double_sided;
    for (int k = 0; k < face->count; k++) light.corners[k] = place_at(patch, face->corners[k]);
    for (int c = 0; c < 3; c++) light.radiance[c] = face->light[c] / face->area;
    Rgb radiance = rgb(light.radiance[0], light.radiance[1], light.radiance[2]);
    light.power = PI * face->area * rgb_luminance(radiance) * (light.two_sided ? 2.0f : 1.0f);
    return light;
}

static bool find_in_mesh(LightPolygons *lights, const WeftScene *scene, const Mesh *mesh) {
    Patch patch = {.scene = scene, .mesh = mesh};
    LightPolygon *items = NULL;
    bool ok = weld(&patch) && begin_faces(&patch) &&
              (patch.edges = alloc_array(patch.face_count, LIGHT_CORNERS * sizeof *patch.edges));
    for (int round = 1; ok && grow(&patch, round); round++) {
    }
    if (ok) items = realloc_array(lights->items, (size_t)lights->found + patch.face_count, sizeof *items);
    if (items) lights->items = items;
    for (size_t f = 0; items && f < patch.face_count; f++)
        if (patch.faces[f].count) items[lights->found++] = finish(&patch, &patch.faces[f]);
    free(patch.place);
    free(patch.faces);
    free(patch.edges);
    return items != NULL;
}

static int stronger_first(const void *a, const void *b) {
    const LightPolygon *s = a, *t = b;
    return s->power > t->power ? -1 : s->power < t->power;
}

bool light_polygons_find(LightPolygons *lights, const WeftScene *scene, int most) {
    *lights = (LightPolygons){0};
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        if (!material_emits(&scene->materials[mesh->material]) || !mesh->triangle_count) continue;
        bool many = mesh->triangle_count > 1u << 24 || lights->found > 1 << 24;
        if (many || !find_in_mesh(lights, scene, mesh)) {
            light_polygons_free(lights);
            return false;
        }
    }
    if (lights->found) qsort(lights->items, (size_t)lights->found, sizeof *lights->items, stronger_first);
    lights->count = lights->found < most ? lights->found : most;
    return true;
}

void light_polygons_free(LightPolygons *lights) {
    free(lights->items);
    *lights = (LightPolygons){0};
}
