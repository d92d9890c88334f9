#include <embree3/rtcore.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "trace/geometry/geometry.h"
#include "trace/geometry/guard.h"

#include "base/fail.h"
#include "base/random.h"
#include "scene/light/pane.h"
#include "scene/record/material_at.h"
#include "weft/isa.h"

struct Geometry {
    const WeftScene *scene;
    RTCDevice device;
    RTCScene accel;
    unsigned char *checks; /* by mesh, see mesh_checks */
    int meshes, threads;
    unsigned shape_version; /* of the scene then */
    atomic_int error;       /* the first RTCError, which may come from Embree's own threads */
    bool built, panes;      /* panes: a mesh is one */
};

static struct RTCRay to_embree(const Ray *ray) {
    return (struct RTCRay){.org_x = ray->origin.x,
                           .org_y = ray->origin.y,
                           .org_z = ray->origin.z,
                           .tnear = ray->near,
                           .dir_x = ray->direction.x,
                           .dir_y = ray->direction.y,
                           .dir_z = ray->direction.z,
                           .tfar = ray->far,
                           .mask = ~0u,
                           .id = ray->key};
}

/* Returns false for a ray that Embree cannot trace: Debian's build asserts that origin and direction are numbers within
 * RAY_REACH. Such a ray hits nothing, and is occluded. */
static bool is_valid(const Ray *ray) {
    return within_reach(ray->origin, RAY_REACH) && within_reach(ray->direction, RAY_REACH) && ray->near <= ray->far;
}

static Hit from_embree(const struct RTCHit *h, float t) {
    return (Hit){t, h->geomID, h->primID, h->u, h->v, {h->Ng_x, h->Ng_y, h->Ng_z}};
}

/* The data of a material that decide, beside the triangle, if a ray hits, and if light goes straight on there. */
enum { CHECK_SIDE = 1, CHECK_OPACITY = 2, IS_SOLID = 4, IS_PANE = 8 };
static int checks_of(const Material *material, bool solid) {
    const int side = material->double_sided || solid ? 0 : CHECK_SIDE;
    return side + (material->alpha_mode != WEFT_ALPHA_OPAQUE ? CHECK_OPACITY : 0) + (solid ? IS_SOLID : 0);
}

static unsigned char mesh_checks(const WeftScene *scene, int mesh) {
    const int k = scene->meshes[mesh].material;
    const Material *material = &scene->materials[k];
    return (unsigned char)(checks_of(material, material_is_solid(material)) + (scene_is_pane(scene, k) ? IS_PANE : 0));
}

bool geometry_is_pane(const Geometry *geometry, uint32_t mesh) { return (geometry->checks[mesh] & IS_PANE) != 0; }

bool geometry_has_panes(const Geometry *geometry) { return geometry->panes; }

/* Returns true if hits of a mesh may not count. */
static bool is_checked(const Geometry *geometry, uint32_t mesh) {
    return (geometry->checks[mesh] & (CHECK_SIDE + CHECK_OPACITY)) != 0;
}

/* Returns true if a hit counts: the surface has that side, and is not transparent there. Partial opacity is decided by
 * a random number that depends on the ray's key and the triangle. */
static bool hit_counts(const Geometry *geometry, const Hit *hit, Vec3 direction, uint32_t key, bool past_lights) {
    const WeftScene *scene = geometry->scene;
    if (past_lights && hit->mesh >= (uint32_t)scene_light_meshes(scene)) return false;
    const Material *material = &scene->materials[scene->meshes[hit->mesh].material];
    const int checks = checks_of(material, (geometry->checks[hit->mesh] & IS_SOLID) != 0);
    if (checks & CHECK_SIDE && vec3_dot(hit->facing, direction) > 0.0f) return false;
    if (!(checks & CHECK_OPACITY)) return true;
    const Mesh *mesh = &scene->meshes[hit->mesh];
    Attributes at = geometry_attributes(mesh, hit);
    float opacity = material_opacity(scene, material, at.uv, at.color[3]);
    return unit_float(hash_combine(hash_combine(key, hit->mesh), hit->triangle)) < opacity;
}

Rgb geometry_pane(const Geometry *geometry, const Hit *hit, Vec3 direction) {
    const WeftScene *scene = geometry->scene;
    const Mesh *mesh = &scene->meshes[hit->mesh];
    Attributes at = geometry_attributes(mesh, hit);
    const float cosine = fabsf(vec3_dot(geometry_vertex(mesh, hit).normal, direction));
    return pane_transmittance(scene, mesh->material, at.uv, at.color, cosine);
}

float geometry_chance(const Hit *hit, uint32_t key) {
    uint32_t u;
    memcpy(&u, &hit->u, sizeof u);
    return unit_float(hash_combine(hash_combine(hash_combine(key, u), hit->mesh), hit->triangle));
}

/* A call to Embree. */
typedef struct Query {
    struct RTCIntersectContext context; /* the first member: filter casts its address back */
    const Geometry *geometry;
    bool past_lights;
    bool shadow;   /* the rays are those of geometry_occluded and geometry_occlusions */
    bool through;  /* they pass panes */
    bool met_pane; /* becomes true where they do */
} Query;

/* Returns true if a shadow ray ends at a pane. */
static bool pane_hides(Query *query, const Hit *hit, Vec3 direction, uint32_t key) {
    query->met_pane = true;
    return !query->through && geometry_chance(hit, key) >= rgb_mean(geometry_pane(query->geometry, hit, direction));
}

static Query query_of(const Geometry *geometry, bool past_lights) {
    Query query = {.geometry = geometry, .past_lights = past_lights};
    rtcInitIntersectContext(&query.context);
    return query;
}

/* Rays and hits come to a filter as rows of N numbers, in the order of the records' members. */
enum { RAY_DIRECTION = 4, RAY_FAR = 8, RAY_ID = 10 };
enum { HIT_FACING = 0, HIT_U = 3, HIT_V, HIT_TRIANGLE, HIT_MESH };
static float number_at(const void *rows, unsigned n, int row, unsigned k) {
    return ((const float *)rows)[(unsigned)row * n + k];
}
static uint32_t word_at(const void *rows, unsigned n, int row, unsigned k) {
    return ((const uint32_t *)rows)[(unsigned)row * n + k];
}
static Vec3 vector_at(const void *rows, unsigned n, int row, unsigned k) {
    return vec3(number_at(rows, n, row, k), number_at(rows, n, row + 1, k), number_at(rows, n, row + 2, k));
}

/* Rejects candidates that do not count (an Embree filter). */
static void filter(const struct RTCFilterFunctionNArguments *a) {
    Query *query = (Query *)(void *)a->context;
    for (unsigned k = 0, n = a->N; k < n; k++) {
        if (!a->valid[k]) continue;
        Hit hit = {number_at(a->ray, n, RAY_FAR, k),    word_at(a->hit, n, HIT_MESH, k),
                   word_at(a->hit, n, HIT_TRIANGLE, k), number_at(a->hit, n, HIT_U, k),
                   number_at(a->hit, n, HIT_V, k),      vector_at(a->hit, n, HIT_FACING, k)};
        Vec3 direction = vector_at(a->ray, n, RAY_DIRECTION, k);
        const uint32_t key = word_at(a->ray, n, RAY_ID, k);
        bool counts = hit_counts(query->geometry, &hit, direction, key, query->past_lights);
        if (counts && query->shadow && geometry_is_pane(query->geometry, hit.mesh))
            counts = pane_hides(query, &hit, direction, key);
        if (!counts) a->valid[k] = 0;
    }
}

bool geometry_serves(const Geometry *geometry) {
    bool serves = geometry->shape_version == geometry->scene->shape_version;
    for (int k = 0; k < geometry->meshes && serves; k++)
        serves = geometry->checks[k] == mesh_checks(geometry->scene, k);
    return serves;
}

static bool attach(Geometry *geometry, uint32_t id) {
    const Mesh *mesh = &geometry->scene->meshes[id];
    RTCGeometry g = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!g) return false;
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->position, 0, 3 * sizeof(float),
                               mesh->vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->index, 0, 3 * sizeof(uint32_t),
                               mesh->triangle_count);
    if (is_checked(geometry, id) || geometry_is_pane(geometry, id)) rtcSetGeometryOccludedFilterFunction(g, filter);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(geometry->accel, g, id);
    rtcReleaseGeometry(g);
    return true;
}

enum {
    FINE_BUILD_TRIANGLES = 200000, /* up to here the slower build, which traces faster, takes no noticeable time */
    SERIAL_BUILD_TRIANGLES = 4096
};

static void note_error(void *user, enum RTCError code, const char *text) {
    Geometry *geometry = user;
    int none = RTC_ERROR_NONE;
    atomic_compare_exchange_strong(&geometry->error, &none, (int)code);
}

static uint32_t count_triangles(const Geometry *geometry) {
    uint32_t count = 0;
    for (int k = 0; k < geometry->meshes; k++) count += geometry->scene->meshes[k].triangle_count;
    return count;
}

/* Builds Embree's scene; sets `built` on success. */
static void build(void *user) {
    Geometry *geometry = user;
    const WeftScene *scene = geometry->scene;
    const uint32_t triangles = count_triangles(geometry);
    char config[96];
    /* Few triangles need no threads, and if memory runs out, tasks of Embree's may outlive the call that started
     * them. */
    snprintf(config, sizeof config, "threads=%d,set_affinity=0,isa=%s",
             triangles <= SERIAL_BUILD_TRIANGLES ? 1 : geometry->threads, weft_isa());
    geometry->device = rtcNewDevice(config);
    if (!geometry->device) {
        note_error(geometry, rtcGetDeviceError(NULL), NULL);
        return;
    }
    rtcSetDeviceErrorFunction(geometry->device, note_error, geometry);
    geometry->accel = rtcNewScene(geometry->device);
    bool made = geometry->accel != NULL;
    for (int k = 0; made && k < geometry->meshes; k++) {
        if (!scene->meshes[k].triangle_count) continue;
        made = attach(geometry, (uint32_t)k);
    }
    if (!made) return;
    rtcSetSceneFlags(geometry->accel, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    if (triangles <= FINE_BUILD_TRIANGLES) rtcSetSceneBuildQuality(geometry->accel, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(geometry->accel);
    note_error(geometry, rtcGetDeviceError(geometry->device), NULL);
    geometry->built = geometry->error == RTC_ERROR_NONE;
}

static void release(void *user) {
    const Geometry *geometry = user;
    rtcReleaseScene(geometry->accel);
    rtcReleaseDevice(geometry->device);
}

WeftResult geometry_create(const WeftScene *scene, int meshes, int threads, Geometry **out, WeftError *error) {
    Geometry *geometry = alloc_array(1, sizeof *geometry);
    if (!geometry) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    *geometry = (Geometry){.scene = scene, .meshes = meshes, .threads = threads, .shape_version = scene->shape_version};
    geometry->checks = alloc_array((size_t)meshes, sizeof *geometry->checks);
    if (!geometry->checks) {
        free(geometry);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    for (int k = 0; k < meshes; k++) {
        geometry->checks[k] = mesh_checks(scene, k);
        geometry->panes |= geometry_is_pane(geometry, (uint32_t)k);
    }
    bool starved;
    if (guarded(build, geometry, &starved) && geometry->built) {
        *out = geometry;
        return WEFT_OK;
    }
    starved |= geometry->error == RTC_ERROR_OUT_OF_MEMORY;
    geometry_free(geometry);
    return fail(error, starved ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_RENDER_DEVICE, scene->name, NULL);
}

void geometry_free(Geometry *geometry) {
    if (!geometry) return;
    /* Embree ends the program if it has to release a scene whose build failed: that one stays allocated */
    bool starved;
    if (geometry->built) guarded(release, geometry, &starved);
    free(geometry->checks);
    free(geometry);
}

static bool intersect(const Geometry *geometry, const Ray *ray, Query *query, Hit *hit) {
    struct RTCRayHit r = {.ray = to_embree(ray), .hit.geomID = RTC_INVALID_GEOMETRY_ID};
    rtcIntersect1(geometry->accel, &query->context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *hit = from_embree(&r.hit, r.ray.tfar);
    return true;
}

/* Finds the nearest hit. Nearly every one counts. For the rest Embree filters all candidates, since another may be as
 * near. */
bool geometry_hit(const Geometry *geometry, Ray ray, Hit *hit) {
    Query query = query_of(geometry, ray.past_lights);
    if (!is_valid(&ray)) return false;
    if (!intersect(geometry, &ray, &query, hit)) return false;
    if (hit_counts(geometry, hit, ray.direction, ray.key, ray.past_lights)) return true;
    query.context.filter = filter;
    return intersect(geometry, &ray, &query, hit);
}

bool geometry_triangle(const Geometry *geometry, Ray ray, Hit *hit) {
    Query query = query_of(geometry, ray.past_lights);
    return is_valid(&ray) && intersect(geometry, &ray, &query, hit);
}

bool geometry_occluded(const Geometry *geometry, Ray ray) {
    if (!is_valid(&ray)) return true;
    Query query = query_of(geometry, ray.past_lights);
    query.shadow = true;
    struct RTCRay r = to_embree(&ray);
    rtcOccluded1(geometry->accel, &query.context, &r);
    return r.tfar < 0.0f;
}

/* Sets the members that all rays have in common. */
static void start_packet(struct RTCRay16 *q) {
    for (int k = 0; k < GEOMETRY_PACKET; k++) {
        q->tnear[k] = 0.0f;
        q->time[k] = 0.0f;
        q->mask[k] = ~0u;
        q->flags[k] = 0;
    }
}

/* Fills a packet with the rays from `first` on, `left` of them or as many as it takes. Invalid ones are idle, and are
 * replaced, since with AVX2 Embree asserts idle rays too. The loop is one of vectors. */
static void fill_packet(const RayRows *rays, int first, int left, int *restrict valid, struct RTCRay16 *restrict q) {
    const float *ox = rays->o[0] + first, *oy = rays->o[1] + first, *oz = rays->o[2] + first;
    const float *dx = rays->d[0] + first, *dy = rays->d[1] + first, *dz = rays->d[2] + first;
    const uint32_t *key = rays->key + first;
    for (int k = 0; k < GEOMETRY_PACKET; k++) q->tfar[k] = rays->far ? rays->far[first + k] : INFINITY;
    for (int k = 0; k < GEOMETRY_PACKET; k++) {
        bool usable = (k < left) & (q->tfar[k] >= 0.0f) & (fabsf(ox[k]) <= RAY_REACH) & (fabsf(oy[k]) <= RAY_REACH) &
                      (fabsf(oz[k]) <= RAY_REACH) & (fabsf(dx[k]) <= RAY_REACH) & (fabsf(dy[k]) <= RAY_REACH) &
                      (fabsf(dz[k]) <= RAY_REACH);
        valid[k] = usable ? -1 : 0;
        q->org_x[k] = usable ? ox[k] : 0.0f;
        q->org_y[k] = usable ? oy[k] : 0.0f;
        q->org_z[k] = usable ? oz[k] : 0.0f;
        q->dir_x[k] = usable ? dx[k] : 0.0f;
        q->dir_y[k] = usable ? dy[k] : 0.0f;
        q->dir_z[k] = usable ? dz[k] : 1.0f;
        q->tfar[k] = usable ? q->tfar[k] : 0.0f;
        q->id[k] = key[k];
    }
}

static Query packet_query(const Geometry *geometry, const RayRows *rays) {
    Query query = query_of(geometry, rays->past_lights);
    query.context.flags = rays->coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return query;
}

static Vec3 direction_at(const RayRows *rays, int k) { return vec3(rays->d[0][k], rays->d[1][k], rays->d[2][k]); }

/* Returns a ray without its far end. */
static Ray ray_at(const RayRows *rays, int k) {
    return (Ray){vec3(rays->o[0][k], rays->o[1][k], rays->o[2][k]),
                 direction_at(rays, k),
                 0.0f,
                 INFINITY,
                 rays->key[k],
                 rays->past_lights};
}

static void put_hit(const HitRows *hits, int k, const Hit *hit) {
    hits->t[k] = hit->t;
    hits->u[k] = hit->u;
    hits->v[k] = hit->v;
    hits->mesh[k] = hit->mesh;
    hits->triangle[k] = hit->triangle;
}

/* Stores the hits of a packet. One that does not count is replaced by the next that does. */
static void put_hits(const Geometry *geometry, const RayRows *rays, const struct RTCHit16 *h, const float *t, int first,
                     int left, const HitRows *hits) {
    for (int k = 0; k < GEOMETRY_PACKET && k < left; k++) {
        Hit hit = {t[k], h->geomID[k], h->primID[k], h->u[k], h->v[k], {h->Ng_x[k], h->Ng_y[k], h->Ng_z[k]}};
        put_hit(hits, first + k, &hit);
        if (hit.mesh == GEOMETRY_NOTHING || (!is_checked(geometry, hit.mesh) && !rays->past_lights)) continue;
        const Vec3 direction = direction_at(rays, first + k);
        if (hit_counts(geometry, &hit, direction, rays->key[first + k], rays->past_lights)) continue;
        if (!geometry_hit(geometry, ray_at(rays, first + k), &hit)) hit.mesh = GEOMETRY_NOTHING;
        put_hit(hits, first + k, &hit);
    }
}

void geometry_hits(const Geometry *geometry, const RayRows *rays, int count, const HitRows *hits) {
    Query query = packet_query(geometry, rays);
    struct RTCRayHit16 q;
    _Alignas(64) int valid[GEOMETRY_PACKET];
    start_packet(&q.ray);
    for (int first = 0; first < count; first += GEOMETRY_PACKET) {
        fill_packet(rays, first, count - first, valid, &q.ray);
        for (int k = 0; k < GEOMETRY_PACKET; k++) q.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect16(valid, geometry->accel, &query.context, &q);
        put_hits(geometry, rays, &q.hit, q.ray.tfar, first, count - first, hits);
    }
}

/* Returns what the panes on a ray that nothing hides let through, one after the other. Those a millionth of the way apart
 * are one: the two triangles of a pane, where the ray meets their edge. */
static Rgb panes_along(const Geometry *geometry, Ray ray) {
    enum { PANES = 256 };
    Rgb through = rgb_grey(1.0f);
    Hit hit;
    for (int k = 0; k < PANES && geometry_triangle(geometry, ray, &hit);) {
        ray.near = geometry_past(hit.t);
        if (!geometry_is_pane(geometry, hit.mesh)) continue;
        if (!hit_counts(geometry, &hit, ray.direction, ray.key, ray.past_lights)) continue;
        through = rgb_mul(through, geometry_pane(geometry, &hit, ray.direction));
        k++;
    }
    return through;
}

/* Sets what panes let through of the rays of a packet. */
static void put_through(const Query *query, const RayRows *rays, int first, int left, const bool *occluded,
                        Rgb *through) {
    for (int k = first; k < first + GEOMETRY_PACKET && k < first + left; k++) {
        Ray ray = ray_at(rays, k);
        if (rays->far) ray.far = rays->far[k];
        through[k] = query->met_pane && !occluded[k] ? panes_along(query->geometry, ray) : rgb_grey(1.0f);
    }
}

void geometry_occlusions(const Geometry *geometry, const RayRows *rays, int count, bool *occluded, Rgb *through) {
    Query query = packet_query(geometry, rays);
    query.shadow = true;
    query.through = through != NULL;
    struct RTCRay16 q;
    _Alignas(64) int valid[GEOMETRY_PACKET];
    start_packet(&q);
    for (int first = 0; first < count; first += GEOMETRY_PACKET) {
        fill_packet(rays, first, count - first, valid, &q);
        query.met_pane = false;
        rtcOccluded16(valid, geometry->accel, &query.context, &q);
        for (int k = 0; k < GEOMETRY_PACKET && first + k < count; k++)
            occluded[first + k] = !valid[k] || q.tfar[k] < 0.0f;
        if (through) put_through(&query, rays, first, count - first, occluded, through);
    }
}

static Vec3 blend(const float *attribute, const uint32_t *index, float w, float u, float v) {
    return vec3_lerp3(vec3_load(attribute + 3 * (size_t)index[0]), vec3_load(attribute + 3 * (size_t)index[1]),
                      vec3_load(attribute + 3 * (size_t)index[2]), w, u, v);
}

Vertex geometry_vertex(const Mesh *mesh, const Hit *hit) {
    const uint32_t *index = mesh->index + 3 * (size_t)hit->triangle;
    float w = 1.0f - hit->u - hit->v, weight[3] = {w, hit->u, hit->v};
    Vertex vertex = {.position = blend(mesh->position, index, w, hit->u, hit->v)};
    vertex.geometric = vec3_normal_or(hit->facing, vec3(0.0f, 1.0f, 0.0f));
    vertex.normal = vertex.geometric;
    if (mesh->normal) vertex.normal = vec3_normal_or(blend(mesh->normal, index, w, hit->u, hit->v), vertex.geometric);
    if (mesh->tangent)
        for (int k = 0; k < 3; k++) {
            const float *t = mesh->tangent + 4 * (size_t)index[k];
            vertex.tangent = vec3_madd(vertex.tangent, vec3_load(t), weight[k]);
            vertex.handedness = t[3];
        }
    return vertex;
}

Attributes geometry_attributes(const Mesh *mesh, const Hit *hit) {
    const uint32_t *index = mesh->index + 3 * (size_t)hit->triangle;
    float weight[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    Attributes at = {.color = {1.0f, 1.0f, 1.0f, 1.0f}};
    for (int set = 0; set < 2; set++)
        for (int k = 0; mesh->texcoord[set] && k < 3; k++) {
            const float *uv = mesh->texcoord[set] + 2 * (size_t)index[k];
            at.uv[set][0] += uv[0] * weight[k];
            at.uv[set][1] += uv[1] * weight[k];
        }
    if (mesh->color)
        for (int c = 0; c < 4; c++) {
            at.color[c] = 0.0f;
            for (int k = 0; k < 3; k++) at.color[c] += mesh->color[4 * (size_t)index[k] + (size_t)c] * weight[k];
        }
    return at;
}
