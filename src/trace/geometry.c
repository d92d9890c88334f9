#include <embree3/rtcore.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "trace/geometry.h"
#include "trace/guard.h"

#include "base/fail.h"
#include "base/random.h"
#include "scene/shade.h"

struct Geometry {
    const WeftScene *scene;
    RTCDevice device;
    RTCScene accel;
    bool *asked; /* of a mesh: see is_asked */
    int meshes, threads;
    atomic_int complaint; /* an RTCError: Embree's first; its own threads complain too */
    bool built;
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

/* Returns false for a ray of which Embree would make no sense: Debian's asserts that origin and direction are
 * numbers within RAY_REACH. Such a ray meets nothing and sees no light. */
static bool is_sound(const Ray *ray) {
    return within_reach(ray->origin, RAY_REACH) && within_reach(ray->direction, RAY_REACH) &&
           ray->near <= ray->far;
}

static Hit from_embree(const struct RTCHit *h, float t) {
    return (Hit){t, h->geomID, h->primID, h->u, h->v, {h->Ng_x, h->Ng_y, h->Ng_z}};
}

/* A hit may only count when the surface is there for that ray, from that side and, by a coin that is a
 * function of ray and triangle, not transparent. */
static bool present(const WeftScene *scene, const Hit *hit, Vec3 direction, uint32_t key, bool past_lights) {
    if (past_lights && hit->mesh >= (uint32_t)scene_own_meshes(scene)) return false;
    const Mesh *mesh = &scene->meshes[hit->mesh];
    const Material *material = &scene->materials[mesh->material];
    if (!material->double_sided && vec3_dot(hit->facing, direction) > 0.0f) return false;
    if (material->alpha_mode == WEFT_ALPHA_OPAQUE) return true;
    Attributes at = geometry_attributes(mesh, hit);
    float opacity = material_opacity(scene, material, at.uv, at.color[3]);
    return unit_float(hash_combine(hash_combine(key, hit->mesh), hit->triangle)) < opacity;
}

typedef struct Query {
    struct RTCIntersectContext context; /* first: Embree hands back its address */
    const WeftScene *scene;
    bool past_lights;
} Query;

static Query query_of(const Geometry *geometry, const Ray *ray) {
    Query query = {.scene = geometry->scene, .past_lights = ray->past_lights};
    rtcInitIntersectContext(&query.context);
    return query;
}

/* Refuses candidates that are not there. Only single rays get here, so N is 1 and the records are plain ones.
 */
static void filter(const struct RTCFilterFunctionNArguments *a) {
    const struct RTCRay *r = (const struct RTCRay *)(const void *)a->ray;
    Hit hit = from_embree((const struct RTCHit *)(const void *)a->hit, r->tfar);
    const Query *query = (const Query *)(const void *)a->context;
    if (!present(query->scene, &hit, (Vec3){r->dir_x, r->dir_y, r->dir_z}, r->id, query->past_lights))
        a->valid[0] = 0;
}

/* Returns true if a shadow ray must examine its hits on this mesh. */
static bool is_asked(const WeftScene *scene, int mesh) {
    const Material *material = &scene->materials[scene->meshes[mesh].material];
    return !material->double_sided || material->alpha_mode != WEFT_ALPHA_OPAQUE;
}

bool geometry_serves(const Geometry *geometry) {
    bool serves = true;
    for (int k = 0; k < geometry->meshes && serves; k++)
        serves = geometry->asked[k] == is_asked(geometry->scene, k);
    return serves;
}

static bool attach(Geometry *geometry, uint32_t id) {
    const Mesh *mesh = &geometry->scene->meshes[id];
    RTCGeometry g = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!g) return false;
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->position, 0,
                               3 * sizeof(float), mesh->vertex_count);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->index, 0,
                               3 * sizeof(uint32_t), mesh->triangle_count);
    if (geometry->asked[id]) rtcSetGeometryOccludedFilterFunction(g, filter);
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(geometry->accel, g, id);
    rtcReleaseGeometry(g);
    return true;
}

/* Up to here the slower build that traces faster takes less than the eye notices. */
enum { FINE_BUILD_TRIANGLES = 200000 };
enum { SERIAL_BUILD_TRIANGLES = 4096 };

static void note_error(void *user, enum RTCError code, const char *text) {
    Geometry *geometry = user;
    int none = RTC_ERROR_NONE;
    atomic_compare_exchange_strong(&geometry->complaint, &none, (int)code);
}

static uint32_t count_triangles(const Geometry *geometry) {
    uint32_t count = 0;
    for (int k = 0; k < geometry->meshes; k++) count += geometry->scene->meshes[k].triangle_count;
    return count;
}

/* Makes what Embree holds; `built` where all of it stands. */
static void build(void *user) {
    Geometry *geometry = user;
    const WeftScene *scene = geometry->scene;
    const uint32_t triangles = count_triangles(geometry);
    char config[64];
    /* Few triangles are not worth threads: and where memory runs out, tasks of Embree's may outlive the call
     * that started them. */
    snprintf(config, sizeof config, "threads=%d,set_affinity=0",
             triangles <= SERIAL_BUILD_TRIANGLES ? 1 : geometry->threads);
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
    geometry->built = geometry->complaint == RTC_ERROR_NONE;
}

static void release(void *user) {
    const Geometry *geometry = user;
    rtcReleaseScene(geometry->accel);
    rtcReleaseDevice(geometry->device);
}

WeftResult geometry_create(const WeftScene *scene, int meshes, int threads, Geometry **out,
                           WeftError *error) {
    Geometry *geometry = alloc_array(1, sizeof *geometry);
    if (!geometry) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    *geometry = (Geometry){.scene = scene, .meshes = meshes, .threads = threads};
    geometry->asked = alloc_array((size_t)meshes, sizeof *geometry->asked);
    if (!geometry->asked) {
        free(geometry);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    for (int k = 0; k < meshes; k++) geometry->asked[k] = is_asked(scene, k);
    bool starved;
    if (guarded(build, geometry, &starved) && geometry->built) {
        *out = geometry;
        return WEFT_OK;
    }
    starved |= geometry->complaint == RTC_ERROR_OUT_OF_MEMORY;
    geometry_free(geometry);
    return fail(error, starved ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_RENDER_DEVICE, scene->name, NULL);
}

void geometry_free(Geometry *geometry) {
    if (!geometry) return;
    /* Embree ends the program where it is to release a scene whose building broke off: that is left to it */
    bool starved;
    if (geometry->built) guarded(release, geometry, &starved);
    free(geometry->asked);
    free(geometry);
}

static bool intersect(const Geometry *geometry, const Ray *ray, Query *query, Hit *hit) {
    struct RTCRayHit r = {.ray = to_embree(ray), .hit.geomID = RTC_INVALID_GEOMETRY_ID};
    rtcIntersect1(geometry->accel, &query->context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    *hit = from_embree(&r.hit, r.ray.tfar);
    return true;
}

/* Nearly every nearest hit is there. For the rest every candidate is asked, since another may lie at the same
 * place. */
bool geometry_hit(const Geometry *geometry, Ray ray, Hit *hit) {
    Query query = query_of(geometry, &ray);
    if (!is_sound(&ray)) return false;
    if (!intersect(geometry, &ray, &query, hit)) return false;
    if (present(geometry->scene, hit, ray.direction, ray.key, ray.past_lights)) return true;
    query.context.filter = filter;
    return intersect(geometry, &ray, &query, hit);
}

void geometry_hit_packet(const Geometry *geometry, int count, const Ray *rays, Hit *hits) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    struct RTCRayHit16 q;
    _Alignas(64) int valid[GEOMETRY_PACKET];
    /* with AVX2 Embree makes sure of idle rays too */
    static const Ray harmless = {.direction = {0.0f, 0.0f, 1.0f}};
    for (int k = 0; k < GEOMETRY_PACKET; k++) {
        valid[k] = k < count && is_sound(&rays[k]) ? -1 : 0;
        const Ray *ray = valid[k] ? &rays[k] : &harmless;
        q.ray.org_x[k] = ray->origin.x, q.ray.org_y[k] = ray->origin.y, q.ray.org_z[k] = ray->origin.z;
        q.ray.dir_x[k] = ray->direction.x, q.ray.dir_y[k] = ray->direction.y,
        q.ray.dir_z[k] = ray->direction.z;
        q.ray.tnear[k] = ray->near, q.ray.tfar[k] = ray->far;
        q.ray.time[k] = 0.0f, q.ray.mask[k] = ~0u, q.ray.flags[k] = 0, q.ray.id[k] = 0;
        q.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, geometry->accel, &context, &q);
    for (int k = 0; k < count; k++) {
        hits[k].t = -1.0f;
        if (q.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
        hits[k] = (Hit){q.ray.tfar[k], q.hit.geomID[k], q.hit.primID[k],
                        q.hit.u[k],    q.hit.v[k],      {q.hit.Ng_x[k], q.hit.Ng_y[k], q.hit.Ng_z[k]}};
        if (!present(geometry->scene, &hits[k], rays[k].direction, rays[k].key, rays[k].past_lights) &&
            !geometry_hit(geometry, rays[k], &hits[k]))
            hits[k].t = -1.0f;
    }
}

bool geometry_occluded(const Geometry *geometry, Ray ray) {
    if (!is_sound(&ray)) return true;
    Query query = query_of(geometry, &ray);
    struct RTCRay r = to_embree(&ray);
    rtcOccluded1(geometry->accel, &query.context, &r);
    return r.tfar < 0.0f;
}

static Vec3 blend(const float *attribute, const uint32_t *index, float w, float u, float v) {
    return vec3_lerp3(vec3_load(attribute + 3 * (size_t)index[0]),
                      vec3_load(attribute + 3 * (size_t)index[1]),
                      vec3_load(attribute + 3 * (size_t)index[2]), w, u, v);
}

Vertex geometry_vertex(const Mesh *mesh, const Hit *hit) {
    const uint32_t *index = mesh->index + 3 * (size_t)hit->triangle;
    float w = 1.0f - hit->u - hit->v, weight[3] = {w, hit->u, hit->v};
    Vertex vertex = {.position = blend(mesh->position, index, w, hit->u, hit->v)};
    vertex.geometric = vec3_normal_or(hit->facing, vec3(0.0f, 1.0f, 0.0f));
    vertex.normal = vertex.geometric;
    if (mesh->normal)
        vertex.normal = vec3_normal_or(blend(mesh->normal, index, w, hit->u, hit->v), vertex.geometric);
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
            for (int k = 0; k < 3; k++)
                at.color[c] += mesh->color[4 * (size_t)index[k] + (size_t)c] * weight[k];
        }
    return at;
}

/* The mean of the point's projections onto the tangent planes of the vertices, outward only. Johannes Hanika,
 * "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021. */
Vec3 geometry_lift(const Mesh *mesh, const Hit *hit, const Vertex *vertex, float side) {
    Vec3 p = vertex->position, lifted = p;
    if (!mesh->normal) return p;
    const uint32_t *index = mesh->index + 3 * (size_t)hit->triangle;
    float weight[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    for (int k = 0; k < 3; k++) {
        Vec3 n = vec3_scale(vec3_load(mesh->normal + 3 * (size_t)index[k]), side);
        float below = fminf(vec3_dot(vec3_sub(p, vec3_load(mesh->position + 3 * (size_t)index[k])), n), 0.0f);
        lifted = vec3_madd(lifted, n, -below * weight[k]);
    }
    return lifted;
}
