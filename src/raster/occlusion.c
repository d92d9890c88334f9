#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */
#include <string.h>

#include "raster/occlusion.h"

#include "base/cache.h"
#include "base/fail.h"
#include "base/thread.h"
#include "shading/frame.h"
#include "shading/warp.h"
#include "trace/geometry.h"

enum { BLOCK = 256 }; /* vertices in one go */

/* Raised whenever the same scene would give other values. */
enum { LOOK = 5 };

struct Occlusion {
    WeftScene scene; /* as it was, without the meshes of its lights: what its lists hold stays, those of
                        meshes and materials are copies */
    Geometry *geometry;
    float *values;
    float *position, *normal; /* 3 a vertex; a normal of 0 looks nowhere */
    uint32_t *first;          /* vertex of a mesh */
    int rays, threads;
    bool no_cache;
    EnvLight env_lights[OCCLUSION_LIGHTS];
    int env_light_count;
    EnvPoint env_points[AMBIENT_POINTS_MAX + OCCLUSION_LIGHTS];
    int first_point[OCCLUSION_LIGHTS + 1]; /* of a light */
    uint64_t key;                          /* of the values in the cache */
    atomic_int stop, done;
    bool joined;
    pthread_t thread;
};

static Dir dir_of(Vec3 v) { return dir(v.x, v.y, v.z); }

/* Part of a turn by which a vertex's directions differ from others', so that neighbours do not err alike. */
static float turned(uint32_t vertex) { return (float)(vertex * 2654435769u >> 8) * 0x1p-24f; }

/* c_0 + c . w about n, each from -1 to 1. */
typedef struct Ramp {
    float mean, x, y, z;
} Ramp;

static float ramp_at(const Ramp *r, Dir w) {
    return clamp(r->mean + r->x * w.x + r->y * w.y + r->z * (w.z - 0.5f), 0.0f, 1.0f);
}

static Dir sky_ray(int k, int rays, float turn) {
    float v = (float)k * 0.618033989f + turn;
    return warp_uniform(((float)k + 0.5f) / (float)rays, v - floor(v));
}

/* So many times as steep, its mean over the rays as it was when it is cut off. */
static Ramp ramp_steeper(const Occlusion *self, const Ramp *r, float by, const Dir *sky) {
    Ramp out = {r->mean, by * r->x, by * r->y, by * r->z};
    for (int round = 0; round < 4; round++) {
        float mean = 0.0f;
        for (int k = 0; k < self->rays; k++) mean += ramp_at(&out, sky[k]);
        out.mean = clamp(out.mean + r->mean - mean / (float)self->rays, -1.0f, 2.0f);
    }
    return out;
}

/* Nearest to what is seen, V, over the hemisphere, whose x, y, z have the means 0, 0, 1/2 and the variances
 * 1/3, 1/3, 1/12:
 *
 *   mean(V) + 3 mean(V x) x + 3 mean(V y) y + 12 mean(V (z - 1/2)) (z - 1/2)
 *
 * and since V ends at 0 and 1, as many times as steep as is nearest when it is cut off there, and as much
 * higher as cutting it off takes from its mean. */
static void fit_ramp(const Occlusion *self, const bool *seen, const Dir *sky, Ramp *out) {
    static const float steps[] = {1.0f, 1.25f, 1.5f, 2.0f, 2.5f, 3.0f};
    Ramp r = {0.0f, 0.0f, 0.0f, 0.0f};
    float least = INFINITY, share = 1.0f / (float)self->rays;
    for (int k = 0; k < self->rays; k++) {
        Dir w = sky[k];
        if (!seen[k]) continue;
        r.mean += share;
        r.x += 3.0f * share * w.x;
        r.y += 3.0f * share * w.y;
        r.z += 12.0f * share * (w.z - 0.5f);
    }
    *out = r;
    for (size_t n = 0; n < sizeof steps / sizeof steps[0]; n++) {
        Ramp steep = ramp_steeper(self, &r, steps[n], sky);
        float off = 0.0f;
        for (int k = 0; k < self->rays; k++) {
            float d = ramp_at(&steep, sky[k]) - (seen[k] ? 1.0f : 0.0f);
            off += d * d;
        }
        if (off < least) least = off, *out = steep;
    }
}

/* The part of the cosine-weighted sky above n that a point sees, and which. Directions are even over the
 * hemisphere by the golden ratio. */
static float seen_from(const Occlusion *self, Vec3 p, Vec3 n, float reach, uint32_t vertex, float open[4]) {
    bool seen[OCCLUSION_RAYS_MAX];
    Dir sky[OCCLUSION_RAYS_MAX]; /* of a frame whose z is n */
    Frame frame = frame_about(dir_of(n), dir(0.0f, 0.0f, 0.0f), 1.0f);
    Vec3 from = vec3_madd(p, n, reach);
    float sum = 0.0f, turn = turned(vertex);
    Ramp ramp;
    for (int k = 0; k < self->rays; k++) {
        Dir w = sky[k] = sky_ray(k, self->rays, turn), d = frame_from(frame, w);
        Ray ray = {from, vec3(d.x, d.y, d.z), 0.0f, INFINITY, vertex, false};
        seen[k] = !geometry_occluded(self->geometry, ray);
        if (seen[k]) sum += 2.0f * w.z / (float)self->rays;
    }
    fit_ramp(self, seen, sky, &ramp);
    Dir slope = frame_from(frame, dir(ramp.x, ramp.y, ramp.z));
    open[0] = ramp.mean - 0.5f * ramp.z;
    open[1] = slope.x, open[2] = slope.y, open[3] = slope.z;
    return min(sum, 1.0f);
}

static float point_light(const EnvPoint *point) {
    return point->color[0] + point->color[1] + point->color[2];
}

static float fraction(float x) { return x - floor(x); }

/* The part of a light that p sees. Rays are even over the light of its points; about a point that stands for 1 / m of
 * the light they are spread by exp(kappa (mu - 1)), whose mean squared distance 2 / kappa is a share 1 / m of the
 * light's: so they have its shape, as that of a glow along the horizon. */
static float env_light_visibility(const Occlusion *self, int light, Vec3 p, Vec3 n, float reach,
                                  uint32_t vertex) {
    const EnvLight *l = &self->env_lights[light];
    int at = self->first_point[light], end = self->first_point[light + 1];
    int rays = self->rays / 2 > 0 ? self->rays / 2 : 1, seen = 0, above = 0;
    float total = 0.0f, before = 0.0f, spread = l->spread / (float)(end - at), turn = turned(vertex);
    for (int k = at; k < end; k++) total += point_light(&self->env_points[k]);
    if (vec3_dot(l->direction, n) < 0.0f) n = vec3_scale(n, -1.0f);
    Vec3 from = vec3_madd(p, n, reach);
    for (int k = 0; k < rays; k++) {
        float part = total * ((float)k + 0.5f) / (float)rays;
        while (at + 1 < end && before + point_light(&self->env_points[at]) < part)
            before += point_light(&self->env_points[at++]);
        float u = max(fraction((float)k * 0.754877666f + turn), 1e-6f);
        float phi = 2.0f * PI * fraction((float)k * 0.569840291f + turn);
        float mu = max(1.0f + 0.5f * spread * logf(u), -1.0f), s = sqrt(max(1.0f - mu * mu, 0.0f));
        Frame frame = frame_about(dir_of(self->env_points[at].direction), dir(0.0f, 0.0f, 0.0f), 1.0f);
        Dir d = frame_from(frame, dir(s * cos(phi), s * sin(phi), mu));
        Ray ray = {from, vec3(d.x, d.y, d.z), 0.0f, INFINITY, vertex, false};
        if (vec3_dot(ray.direction, n) <= 0.0f) continue;
        above++;
        seen += !geometry_occluded(self->geometry, ray);
    }
    return above ? (float)seen / (float)above : 1.0f;
}

void occlusion_nothing(float values[OCCLUSION_VALUES]) {
    for (int k = 0; k < OCCLUSION_VALUES; k++) values[k] = k < OCCLUSION_LIGHT ? 0.0f : -1.0f;
    values[0] = values[1] = values[OCCLUSION_OPEN] = values[OCCLUSION_OPEN + 4] = 1.0f;
}

static void look(void *user, int item, int thread) {
    Occlusion *self = user;
    const WeftScene *scene = &self->scene;
    uint32_t count = self->first[scene->mesh_count], begin = (uint32_t)item * BLOCK;
    uint32_t end = count - begin < BLOCK ? count : begin + BLOCK;
    float reach = 1e-4f * vec3_length(vec3_sub(scene->high, scene->low));
    int m = 0;
    for (uint32_t k = begin; k < end && !atomic_load(&self->stop); k++) {
        while (self->first[m + 1] <= k) m++;
        const Mesh *mesh = &scene->meshes[m];
        float *to = self->values + OCCLUSION_VALUES * (size_t)k;
        occlusion_nothing(to);
        Vec3 p = vec3_load(self->position + 3 * (size_t)k), n = vec3_load(self->normal + 3 * (size_t)k);
        if (!(vec3_dot(n, n) > 0.0f)) continue;
        to[0] = seen_from(self, p, n, reach, k, to + OCCLUSION_OPEN);
        if (scene->materials[mesh->material].double_sided)
            to[1] = seen_from(self, p, vec3_scale(n, -1.0f), reach, k, to + OCCLUSION_OPEN + 4);
        for (int j = 0; j < self->env_light_count; j++)
            to[OCCLUSION_LIGHT + j] = env_light_visibility(self, j, p, n, reach, k);
    }
}

/* Returns true if all materials are opaque. Others hide by their textures, which are too much to hash. */
static bool is_opaque(const WeftScene *scene) {
    bool opaque = true;
    for (int m = 0; m < scene_own_meshes(scene); m++)
        opaque &= scene->materials[scene->meshes[m].material].alpha_mode == WEFT_ALPHA_OPAQUE;
    return opaque;
}

/* All that the values of an opaque scene depend on. */
static uint64_t values_key(const Occlusion *self) {
    const WeftScene *scene = &self->scene;
    const int how[] = {LOOK, self->rays, scene->mesh_count, self->env_light_count};
    uint64_t hash = cache_hash(CACHE_HASH, how, sizeof how);
    for (int k = 0; k < self->env_light_count; k++) {
        hash = cache_hash(hash, &self->env_lights[k].direction, sizeof self->env_lights[k].direction);
        hash = cache_hash(hash, &self->env_lights[k].spread, sizeof self->env_lights[k].spread);
    }
    for (int k = 0; k < self->first_point[self->env_light_count]; k++)
        hash = cache_hash(hash, &self->env_points[k], sizeof self->env_points[k]);
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        const uint32_t what[] = {mesh->vertex_count, mesh->triangle_count, mesh->normal != NULL,
                                 scene->materials[mesh->material].double_sided != 0};
        size_t corners = 3 * (size_t)mesh->vertex_count * sizeof(float);
        hash = cache_hash(hash, what, sizeof what);
        hash = cache_hash(hash, mesh->position, corners);
        if (mesh->normal) hash = cache_hash(hash, mesh->normal, corners);
        hash = cache_hash(hash, mesh->index, 3 * (size_t)mesh->triangle_count * sizeof(uint32_t));
    }
    return hash;
}

static size_t values_count(const Occlusion *self) {
    return OCCLUSION_VALUES * (size_t)self->first[self->scene.mesh_count];
}

/* The sums of fit_ramp are greatest where V is 1 on the side they point to and 0 on the other: 3/4 along the
 * horizon and 3/2 upwards, which is less than 1.7 together, before it makes them up to three times as steep.
 */
static bool in_range(const float *values, size_t count) {
    static const float steepest = 3.0f * 1.7f;
    bool good = true;
    for (size_t k = 0; k < count; k++)
        good &= fabsf(values[k]) <= (k % OCCLUSION_VALUES - OCCLUSION_OPEN < 8 ? steepest : 1.0f);
    return good;
}

static void *work(void *user) {
    Occlusion *self = user;
    uint32_t count = self->first[self->scene.mesh_count];
    thread_step_back(); /* for those who draw meanwhile, or compile programs */
    parallel_for(self->threads, (int)((count + BLOCK - 1) / BLOCK), look, self);
    /* in silence: a log is for the thread that made this */
    if (!self->no_cache && !atomic_load(&self->stop))
        cache_keep(self->key, "sky", self->values, values_count(self) * sizeof(float), NULL);
    atomic_store(&self->done, 1);
    return NULL;
}

static bool copy_scene(Occlusion *self, const WeftScene *scene) {
    size_t meshes = (size_t)scene_own_meshes(scene), materials = (size_t)scene->material_count;
    self->scene = *scene;
    self->scene.mesh_count = scene_own_meshes(scene);
    self->scene.meshes = alloc_array(meshes, sizeof(Mesh));
    self->scene.materials = alloc_array(materials, sizeof(Material));
    if (!self->scene.meshes || !self->scene.materials) return false;
    memcpy(self->scene.meshes, scene->meshes, meshes * sizeof(Mesh));
    memcpy(self->scene.materials, scene->materials, materials * sizeof(Material));
    return true;
}

/* Sums the normals of the triangles about each vertex, weighted by area; 0 where they differ. */
static bool add_face_normals(const RefinedMesh *refined, const float *position, float *normal) {
    float *area = alloc_array(refined->vertex_count, sizeof *area);
    for (size_t k = 0; area && k < 3 * (size_t)refined->triangle_count; k++) {
        const uint32_t *v = refined->index + k / 3 * 3;
        Vec3 a = vec3_load(position + 3 * (size_t)v[0]), b = vec3_load(position + 3 * (size_t)v[1]),
             c = vec3_load(position + 3 * (size_t)v[2]);
        Vec3 face = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        float *n = normal + 3 * (size_t)refined->index[k];
        n[0] += face.x, n[1] += face.y, n[2] += face.z;
        area[refined->index[k]] += vec3_length(face);
    }
    for (size_t k = 0; area && k < refined->vertex_count; k++) {
        Vec3 n = vec3_load(normal + 3 * k);
        float length = vec3_length(n), scale = length > 0.99f * area[k] ? 1.0f / length : 0.0f;
        normal[3 * k] = scale * n.x, normal[3 * k + 1] = scale * n.y, normal[3 * k + 2] = scale * n.z;
    }
    free(area);
    return area != NULL;
}

/* A light without points is one point. */
static void copy_env_lights(Occlusion *self, const OcclusionHow *how) {
    int count = 0;
    for (int k = 0; k < self->env_light_count; k++) {
        self->env_lights[k] = how->env_lights[k];
        for (int n = 0; n < how->env_point_count; n++)
            if (how->env_points[n].light == k && count < AMBIENT_POINTS_MAX)
                self->env_points[count++] = how->env_points[n];
        if (count == self->first_point[k])
            self->env_points[count++] = (EnvPoint){how->env_lights[k].direction, {1.0f, 1.0f, 1.0f}, k};
        self->first_point[k + 1] = count;
    }
}

/* Gives the vertices of the refined meshes places and unit normals. */
static bool copy_vertices(Occlusion *self, const Refinement *refinement) {
    size_t count = self->first[self->scene.mesh_count];
    self->position = alloc_array(count, 3 * sizeof(float));
    self->normal = alloc_array(count, 3 * sizeof(float));
    bool held = self->position && self->normal;
    for (int m = 0; held && m < self->scene.mesh_count; m++) {
        const Mesh *mesh = &self->scene.meshes[m];
        const RefinedMesh refined = refinement_mesh(refinement, &self->scene, m);
        float *position = self->position + 3 * (size_t)self->first[m],
              *normal = self->normal + 3 * (size_t)self->first[m];
        refined_fill(&refined, mesh, mesh->position, 3, position);
        if (mesh->normal)
            refined_fill(&refined, mesh, mesh->normal, 3, normal);
        else
            held = add_face_normals(&refined, position, normal);
    }
    for (size_t k = 0; held && k < count; k++) {
        Vec3 n = vec3_normal_or(vec3_load(self->normal + 3 * k), vec3(0.0f, 0.0f, 0.0f));
        self->normal[3 * k] = n.x, self->normal[3 * k + 1] = n.y, self->normal[3 * k + 2] = n.z;
    }
    return held;
}

/* Returns true if the cache of an earlier run has the values. */
static bool known(Occlusion *self, const WeftLog *log) {
    if (self->no_cache) return false;
    size_t count = values_count(self);
    self->key = values_key(self);
    return cache_find(self->key, "sky", self->values, count * sizeof(float), log) &&
           in_range(self->values, count);
}

static WeftResult begin(Occlusion *self, WeftError *error) {
    WeftResult result =
        geometry_create(&self->scene, self->scene.mesh_count, self->threads, &self->geometry, error);
    if (result != WEFT_OK) return result;
    self->joined = pthread_create(&self->thread, NULL, work, self) != 0;
    if (self->joined) work(self); /* no thread to be had: now, then */
    return WEFT_OK;
}

WeftResult occlusion_start(const WeftScene *scene, const Refinement *refinement, const OcclusionHow *how,
                           Occlusion **out, const WeftLog *log, WeftError *error) {
    *out = NULL;
    Occlusion *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    self->rays = how->rays;
    self->no_cache = how->no_cache || !is_opaque(scene);
    self->threads = how->threads ? how->threads : thread_count();
    self->env_light_count = how->env_light_count < OCCLUSION_LIGHTS ? how->env_light_count : OCCLUSION_LIGHTS;
    copy_env_lights(self, how);
    self->joined = true;
    self->first = alloc_array((size_t)scene_own_meshes(scene) + 1, sizeof(uint32_t));
    bool held = self->first && copy_scene(self, scene);
    if (held) {
        for (int m = 0; m < self->scene.mesh_count; m++)
            self->first[m + 1] = self->first[m] + refinement_mesh(refinement, scene, m).vertex_count;
        self->values = alloc_array(values_count(self), sizeof(float));
        held = copy_vertices(self, refinement);
    }
    WeftResult result = WEFT_OK;
    if (!held || !self->values)
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    else if (known(self, log))
        atomic_store(&self->done, 1);
    else
        result = begin(self, error);
    if (result == WEFT_OK)
        *out = self;
    else
        occlusion_free(self);
    return result;
}

const float *occlusion_values(Occlusion *self, bool wait) {
    if (!wait && !atomic_load(&self->done)) return NULL;
    if (!self->joined) pthread_join(self->thread, NULL);
    self->joined = true;
    return self->values;
}

void occlusion_free(Occlusion *self) {
    if (!self) return;
    atomic_store(&self->stop, 1);
    if (!self->joined) pthread_join(self->thread, NULL);
    geometry_free(self->geometry);
    free(self->scene.meshes);
    free(self->scene.materials);
    free(self->values);
    free(self->position);
    free(self->normal);
    free(self->first);
    free(self);
}
