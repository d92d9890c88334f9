#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */
#include <string.h>

#include "raster/geometry/occlusion.h"

#include "base/cache.h"
#include "base/fail.h"
#include "base/matrix.h"
#include "base/thread.h"
#include "scene/light/pane.h"
#include "shading/dialect/warp.h"
#include "shading/stack/frame.h"
#include "trace/geometry/geometry.h"

enum { BLOCK = 256 }; /* vertices in one go */

/* One in FIRST rays of a light is sent first; the others follow if these do not agree. */
enum { FIRST = 4 };

/* Edges are halved up to ROUNDS times if the light that their ends see differs by more than the fraction DIFFERENT. */
enum { ROUNDS = 2 };
#define DIFFERENT 0.16f

/* Version of the search: raised whenever the same scene would give other values. */
enum { SEARCH = 9 };

/* All vertices of the refined meshes, and what they see. */
typedef struct Outlook {
    Refinement refinement;
    float *values;    /* OCCLUSION_VALUES a vertex */
    float *position;  /* 3 a vertex */
    float *normal;    /* 3 a vertex; 0: not searched from */
    uint32_t *first;  /* a mesh's first vertex */
    uint32_t *solved; /* number of a mesh's vertices that have values */
} Outlook;

/* Texels along a side of a face of a cube. */
enum { BRIGHT = 16 };

struct Occlusion {
    WeftScene
        scene; /* copy without the meshes of lights; lists of meshes and materials are copies, others are shared */
    Geometry *geometry;
    Outlook at;
    int round, rays, threads;
    Dir *sky;                        /* rays about the normal */
    Dir *toward;                     /* `rays` directions in the world to each light */
    float bright[6][BRIGHT][BRIGHT]; /* cube: radiance of the environment without its lights, mean 1 */
    bool no_cache;
    EnvLight env_lights[OCCLUSION_LIGHTS];
    int env_light_count;
    EnvPoint env_points[AMBIENT_POINTS_MAX + OCCLUSION_LIGHTS];
    int first_point[OCCLUSION_LIGHTS + 1]; /* a light's first point */
    float share[OCCLUSION_LIGHTS];         /* a light's fraction of the light of all */
    uint64_t key;                          /* with the round: of the values in the cache */
    atomic_int stop, done;
    bool joined;
    pthread_t thread;
};

static Dir dir_of(Vec3 v) { return dir(v.x, v.y, v.z); }

/* Returns the face of a cube that a direction meets, and sets the place on it, both coordinates from -1 to 1. */
static int face_of(Dir w, float *u, float *v) {
    float x = abs(w.x), y = abs(w.y), z = abs(w.z);
    if (x >= y && x >= z) return *u = w.y / x, *v = w.z / x, w.x < 0.0f;
    if (y >= z) return *u = w.z / y, *v = w.x / y, 2 + (w.y < 0.0f);
    return *u = w.x / z, *v = w.y / z, 4 + (w.z < 0.0f);
}

static float brightness(const Occlusion *self, Dir w) {
    float u, v;
    int face = face_of(w, &u, &v), x = (int)(0.5f * (u + 1.0f) * BRIGHT), y = (int)(0.5f * (v + 1.0f) * BRIGHT);
    return self->bright[face][y < BRIGHT ? y : BRIGHT - 1][x < BRIGHT ? x : BRIGHT - 1];
}

/* Fills the cube. Dark directions count a little too, since until their own values are found lights are dimmed as the
 * sky is. */
static void place_brightness(Occlusion *self, const OcclusionHow *how) {
    const float dark = 0.05f;
    float mean = 0.0f;
    for (int k = 0; k < 6 * BRIGHT * BRIGHT; k++) {
        const float u = ((float)(k % BRIGHT) + 0.5f) * 2.0f / BRIGHT - 1.0f,
                    v = ((float)(k / BRIGHT % BRIGHT) + 0.5f) * 2.0f / BRIGHT - 1.0f;
        const int face = k / (BRIGHT * BRIGHT);
        const float side = face % 2 ? -1.0f : 1.0f;
        const Vec3 at[3] = {{side, u, v}, {v, side, u}, {u, v, side}};
        Vec3 w = vec3_normal_or(at[face / 2], vec3(0.0f, 1.0f, 0.0f));
        float l = how->rest ? ambient_rest_at(how->rest, latlong_rotated(w, -how->rotation)) : 1.0f;
        self->bright[face][k / BRIGHT % BRIGHT][k % BRIGHT] = l;
        mean += l / (6 * BRIGHT * BRIGHT);
    }
    for (int k = 0; k < 6 * BRIGHT * BRIGHT; k++) {
        float *l = &self->bright[k / (BRIGHT * BRIGHT)][k / BRIGHT % BRIGHT][k % BRIGHT];
        *l = (mean > 0.0f ? *l / mean : 1.0f) + dark;
    }
}

/* Fits the ramp c . b, b = (1, w.x, w.y, w.z), to the visibility V of the rays: the sum over the rays of g (c . b -
 * V)^2 is least for c = (sum g b b^T)^-1 sum g b V. g = L / (w.z + 0.07), L the radiance, since a sheen reflects light
 * from the horizon. The sums of g c . b and of g V are then equal, so the light of such a lobe is right whatever hides
 * the rest. A ramp fitted with its clamping to 0 and 1 would have less error at a vertex, but be steep, with more error
 * between vertices. */
static void fit_ramp(const Occlusion *self, const float *g, const bool *hidden, double c[4]) {
    double m[4][4] = {{0.0}};
    memset(c, 0, 4 * sizeof *c);
    for (int i = 0; i < 4; i++) m[i][i] = 1e-6 * self->rays; /* m is singular with fewer than four rays */
    for (int k = 0; k < self->rays; k++) {
        Dir w = self->sky[k];
        const double b[4] = {1.0, (double)w.x, (double)w.y, (double)w.z};
        for (int i = 0; i < 4; i++) {
            /* in double: few rays leave next to nothing of m, whose rows are here its columns */
            for (int j = 0; j <= i; j++) m[j][i] += (double)g[k] * b[i] * b[j];
            if (!hidden[k]) c[i] += (double)g[k] * b[i];
        }
    }
    if (matrix_factor(4, m[0], 4) && matrix_solve(4, m[0], 4, 1, c, 4)) return;
    c[0] = 0.5; /* a level ramp, to be shifted */
    c[1] = c[2] = c[3] = 0.0;
}

/* Shifts the ramp by Newton's method so that the sum of g clamp(c . b) over the rays is that of g V, since clamping to
 * 0 and 1 changes the sum. The slope is the fraction of the light where the ramp is not clamped. */
static void shift_ramp(const Occlusion *self, const float *g, const bool *hidden, double c[4]) {
    enum { STEPS = 4 };
    for (int step = 0; step < STEPS; step++) {
        double missing = 0.0, slope = 0.0, all = 1e-9;
        for (int k = 0; k < self->rays; k++) {
            Dir w = self->sky[k];
            const double ramp = c[0] + c[1] * (double)w.x + c[2] * (double)w.y + c[3] * (double)w.z;
            missing += (double)g[k] * ((hidden[k] ? 0.0 : 1.0) - fmin(fmax(ramp, 0.0), 1.0));
            slope += ramp > 0.0 && ramp < 1.0 ? (double)g[k] : 0.0;
            all += (double)g[k];
        }
        c[0] += missing / fmax(slope, 0.1 * all);
    }
}

/* Fills the directions about the normal, even over the hemisphere by the golden ratio. All vertices have the same ones,
 * so that neighbours have nearly the same errors, which do not show. */
static void place_sky(Occlusion *self) {
    for (int k = 0; k < self->rays; k++) {
        float v = (float)k * 0.618033989f;
        self->sky[k] = warp_uniform(((float)k + 0.5f) / (float)self->rays, v - floor(v));
    }
}

/* Returns the frame of a normal with x upwards, which varies little from vertex to vertex, except near the poles. */
static Frame frame_upright(Vec3 n) { return frame_about(dir_of(n), dir(0.0f, 1.0f, 0.0f), 1.0f); }

/* Traces rays from a point; sets hidden[k] if something lies on direction k. */
static void trace_rays(const Occlusion *self, Vec3 from, const Dir *ways, int count, uint32_t vertex, bool *hidden) {
    float o[3][OCCLUSION_RAYS_MAX], d[3][OCCLUSION_RAYS_MAX];
    uint32_t key[OCCLUSION_RAYS_MAX];
    const RayRows rays = {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, NULL, key, false, false};
    for (int k = 0; k < count; k++) {
        o[0][k] = from.x, o[1][k] = from.y, o[2][k] = from.z;
        d[0][k] = ways[k].x, d[1][k] = ways[k].y, d[2][k] = ways[k].z;
        key[k] = vertex;
    }
    geometry_occlusions(self->geometry, &rays, count, hidden, NULL);
}

/* Returns the fraction of the cosine-weighted sky above n that a point sees, and sets the ramp of its visibility. */
static float sky_visibility(const Occlusion *self, Vec3 p, Vec3 n, float reach, uint32_t vertex, float open[4]) {
    bool hidden[OCCLUSION_RAYS_MAX];
    Dir ways[OCCLUSION_RAYS_MAX];
    Frame frame = frame_upright(n);
    float g[OCCLUSION_RAYS_MAX], sum = 0.0f, all = 1e-6f; /* g: of fit_ramp */
    double c[4];
    for (int k = 0; k < self->rays; k++) ways[k] = frame_from(frame, self->sky[k]);
    trace_rays(self, vec3_madd(p, n, reach), ways, self->rays, vertex, hidden);
    for (int k = 0; k < self->rays; k++) {
        const float light = brightness(self, ways[k]), falls = self->sky[k].z * light;
        sum += hidden[k] ? 0.0f : falls;
        all += falls;
        g[k] = light / (self->sky[k].z + 0.07f);
    }
    fit_ramp(self, g, hidden, c);
    shift_ramp(self, g, hidden, c);
    Dir slope = frame_from(frame, dir((float)c[1], (float)c[2], (float)c[3]));
    open[0] = (float)c[0];
    open[1] = slope.x, open[2] = slope.y, open[3] = slope.z;
    return min(sum / all, 1.0f);
}

static float point_light(const EnvPoint *point) { return point->color[0] + point->color[1] + point->color[2]; }

static float fraction(float x) { return x - floor(x); }

static int first_rays(const Occlusion *self) { return (self->rays + FIRST - 1) / FIRST; }

/* Fills rays `begin` to `end` of a light, even over the light of its m points. About a point they have the density
 * exp(kappa (mu - 1)), whose mean squared distance 2 / kappa is 1 / m of the light's: so the rays have the light's
 * shape, such as that of a glow along the horizon. */
static void place_toward(Occlusion *self, int light, int begin, int end) {
    int at = self->first_point[light], last = self->first_point[light + 1] - 1;
    float total = self->share[light], before = 0.0f;
    float spread = self->env_lights[light].spread / (float)(last + 1 - at);
    for (int k = begin; k < end; k++) {
        float part = total * ((float)(k - begin) + 0.5f) / (float)(end - begin);
        while (at < last && before + point_light(&self->env_points[at]) < part)
            before += point_light(&self->env_points[at++]);
        float u = max(fraction(((float)k + 0.5f) * 0.754877666f), 1e-6f);
        float phi = 2.0f * PI * fraction(((float)k + 0.5f) * 0.569840291f);
        float mu = max(1.0f + 0.5f * spread * logf(u), -1.0f), s = sqrt(max(1.0f - mu * mu, 0.0f));
        Frame frame = frame_about(dir_of(self->env_points[at].direction), dir(0.0f, 0.0f, 0.0f), 1.0f);
        self->toward[light * self->rays + k] = frame_from(frame, dir(s * cos(phi), s * sin(phi), mu));
    }
}

/* Fills all rays to lights, and each light's share of the light of all. */
static void place_lights(Occlusion *self) {
    float total = 0.0f;
    for (int k = 0; k < self->env_light_count; k++) {
        self->share[k] = 0.0f;
        for (int n = self->first_point[k]; n < self->first_point[k + 1]; n++)
            self->share[k] += point_light(&self->env_points[n]);
        place_toward(self, k, 0, first_rays(self));
        place_toward(self, k, first_rays(self), self->rays);
        total += self->share[k];
    }
    for (int k = 0; k < self->env_light_count && total > 0.0f; k++) self->share[k] /= total;
}

/* Returns the visible fraction of a light's part above the horizon of n; 1 if all of it is below. */
static float env_light_visibility(const Occlusion *self, int light, Vec3 p, Vec3 n, float reach, uint32_t vertex) {
    const Dir *toward = self->toward + light * self->rays;
    int seen = 0, above = 0;
    Vec3 from = vec3_madd(p, n, reach);
    for (int begin = 0, end = first_rays(self); begin < end; begin = end, end = self->rays) {
        bool hidden[OCCLUSION_RAYS_MAX];
        Dir ways[OCCLUSION_RAYS_MAX];
        int count = 0;
        for (int k = begin; k < end; k++)
            if (dir_dot(toward[k], dir_of(n)) > 0.0f) ways[count++] = toward[k];
        trace_rays(self, from, ways, count, vertex, hidden);
        for (int k = 0; k < count; k++) seen += !hidden[k];
        above += count;
        if (above && (seen == 0 || seen == above)) break;
    }
    return above ? (float)seen / (float)above : 1.0f;
}

/* Writes the values of a vertex that sees the whole sky and has no values for lights. */
static void see_all(float values[OCCLUSION_VALUES]) {
    for (int k = 0; k < OCCLUSION_VALUES; k++) values[k] = k < OCCLUSION_LIGHT ? 0.0f : -1.0f;
    values[0] = values[1] = values[OCCLUSION_OPEN] = values[OCCLUSION_OPEN + 4] = 1.0f;
}

/* Finds the values of a block of vertices. */
static void search_block(void *user, int item, int thread) {
    Occlusion *self = user;
    const WeftScene *scene = &self->scene;
    const Outlook *at = &self->at;
    uint32_t count = at->first[scene->mesh_count], begin = (uint32_t)item * BLOCK;
    uint32_t end = count - begin < BLOCK ? count : begin + BLOCK;
    float reach = 1e-4f * vec3_length(vec3_sub(scene->high, scene->low));
    int m = 0;
    for (uint32_t k = begin; k < end && !atomic_load(&self->stop); k++) {
        while (at->first[m + 1] <= k) m++;
        if (k - at->first[m] < at->solved[m]) continue;
        bool two_sided = scene->materials[scene->meshes[m].material].double_sided;
        float *to = at->values + OCCLUSION_VALUES * (size_t)k;
        see_all(to);
        Vec3 p = vec3_load(at->position + 3 * (size_t)k), n = vec3_load(at->normal + 3 * (size_t)k);
        if (!(vec3_dot(n, n) > 0.0f)) continue;
        Vec3 back = vec3_scale(n, -1.0f);
        to[0] = sky_visibility(self, p, n, reach, k, to + OCCLUSION_OPEN);
        if (two_sided) to[1] = sky_visibility(self, p, back, reach, k, to + OCCLUSION_OPEN + 4);
        for (int j = 0; j < self->env_light_count; j++) {
            bool behind = two_sided && vec3_dot(self->env_lights[j].direction, n) < 0.0f;
            to[OCCLUSION_LIGHT + j] = env_light_visibility(self, j, p, behind ? back : n, reach, k);
        }
    }
}

/* Returns true if all materials are opaque and none a pane. What others hide depends on their textures, which are too
 * large to hash. */
static bool is_opaque(const WeftScene *scene) {
    bool opaque = true;
    for (int m = 0; m < scene_own_meshes(scene); m++)
        opaque &= scene->materials[scene->meshes[m].material].alpha_mode == WEFT_ALPHA_OPAQUE &&
                  !scene_is_pane(scene, scene->meshes[m].material);
    return opaque;
}

/* Returns a hash of everything that the values of an opaque scene depend on. */
static uint64_t values_key(const Occlusion *self) {
    const WeftScene *scene = &self->scene;
    const int how[] = {SEARCH, self->rays, scene->mesh_count, self->env_light_count};
    uint64_t hash = cache_hash(CACHE_HASH, how, sizeof how);
    for (int k = 0; k < self->env_light_count; k++) {
        hash = cache_hash(hash, &self->env_lights[k].direction, sizeof self->env_lights[k].direction);
        hash = cache_hash(hash, &self->env_lights[k].spread, sizeof self->env_lights[k].spread);
    }
    for (int k = 0; k < self->first_point[self->env_light_count]; k++)
        hash = cache_hash(hash, &self->env_points[k], sizeof self->env_points[k]);
    hash = cache_hash(hash, self->bright, sizeof self->bright);
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

static bool in_range(const float *values, size_t count) {
    const float most = 16.0f; /* several times the largest number of a ramp */
    bool good = true;
    for (size_t k = 0; k < count; k++)
        good &= fabsf(values[k]) <= (k % OCCLUSION_VALUES - OCCLUSION_OPEN < 8 ? most : 1.0f);
    return good;
}

/* Allocates space for the values of all unsolved vertices, and sets its number of floats. Returns NULL if memory is
 * short. The caller frees it. */
static float *fresh_values(const Occlusion *self, size_t *count) {
    const Outlook *at = &self->at;
    size_t vertices = 0;
    for (int m = 0; m < self->scene.mesh_count; m++) vertices += at->first[m + 1] - at->first[m] - at->solved[m];
    *count = vertices * OCCLUSION_VALUES;
    return alloc_array(*count, sizeof(float));
}

/* Copies the values of unsolved vertices from `fresh`, or to it. */
static void move_fresh(Occlusion *self, float *fresh, bool put) {
    const Outlook *at = &self->at;
    for (int m = 0; m < self->scene.mesh_count; m++) {
        size_t begin = at->first[m] + at->solved[m], floats = (at->first[m + 1] - begin) * OCCLUSION_VALUES;
        float *own = at->values + begin * OCCLUSION_VALUES;
        memcpy(put ? own : fresh, put ? fresh : own, floats * sizeof(float));
        fresh += floats;
    }
}

static uint64_t round_key(const Occlusion *self) { return cache_hash(self->key, &self->round, sizeof self->round); }

/* Reads the values of unsolved vertices from the user's cache. Returns false if it does not have them. */
static bool find(Occlusion *self, const WeftLog *log) {
    size_t count;
    if (self->no_cache) return false;
    float *fresh = fresh_values(self, &count);
    bool found =
        fresh && cache_find(round_key(self), "sky", fresh, count * sizeof(float), log) && in_range(fresh, count);
    if (found) move_fresh(self, fresh, true);
    free(fresh);
    return found;
}

/* Writes the new values to the user's cache. Warnings are dropped, since only the thread that made this may use the
 * log. */
static void keep(Occlusion *self) {
    size_t count;
    if (self->no_cache || atomic_load(&self->stop)) return;
    float *fresh = fresh_values(self, &count);
    if (fresh) move_fresh(self, fresh, false);
    if (fresh) cache_keep(round_key(self), "sky", fresh, count * sizeof(float), NULL);
    free(fresh);
}

static bool copy_scene(Occlusion *self, const WeftScene *scene) {
    size_t meshes = (size_t)scene_own_meshes(scene), materials = (size_t)scene_own_materials(scene);
    self->scene = *scene;
    self->scene.mesh_count = scene_own_meshes(scene);
    self->scene.material_count = scene_own_materials(scene);
    self->scene.polygon_light_count = self->scene.hair_count = self->scene.back_count = 0;
    self->scene.meshes = alloc_array(meshes, sizeof(Mesh));
    self->scene.materials = alloc_array(materials, sizeof(Material));
    if (!self->scene.meshes || !self->scene.materials) return false;
    memcpy(self->scene.meshes, scene->meshes, meshes * sizeof(Mesh));
    memcpy(self->scene.materials, scene->materials, materials * sizeof(Material));
    return true;
}

/* Sets the normal of each vertex to the mean of its triangles' normals, weighted by area; to 0 if these differ. */
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

/* Copies the lights with their points; a light without points becomes one point. */
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

static void outlook_free(Outlook *at) {
    refinement_free(&at->refinement);
    free(at->values);
    free(at->position);
    free(at->normal);
    free(at->first);
    free(at->solved);
    *at = (Outlook){0};
}

/* Sets positions and unit normals of the refined meshes' vertices. Returns false if memory is short. */
static bool place_vertices(const WeftScene *scene, Outlook *at) {
    size_t count = at->first[scene->mesh_count];
    bool made = true;
    for (int m = 0; made && m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        const RefinedMesh refined = refinement_mesh(&at->refinement, scene, m);
        float *position = at->position + 3 * (size_t)at->first[m], *normal = at->normal + 3 * (size_t)at->first[m];
        refined_fill(&refined, mesh, mesh->position, 3, position);
        if (mesh->normal)
            refined_fill(&refined, mesh, mesh->normal, 3, normal);
        else
            made = add_face_normals(&refined, position, normal);
    }
    for (size_t k = 0; made && k < count; k++) {
        Vec3 n = vec3_normal_or(vec3_load(at->normal + 3 * k), vec3(0.0f, 0.0f, 0.0f));
        at->normal[3 * k] = n.x, at->normal[3 * k + 1] = n.y, at->normal[3 * k + 2] = n.z;
    }
    return made;
}

/* Makes the vertices of a refinement, with the values of `before`, which may be NULL, as the only ones solved. Takes
 * over the refinement, in any case. Returns false if memory is short. */
static bool outlook_make(const WeftScene *scene, const Refinement *refinement, const Outlook *before, Outlook *at) {
    *at = (Outlook){.refinement = *refinement};
    at->first = alloc_array((size_t)scene->mesh_count + 1, sizeof(uint32_t));
    at->solved = alloc_array((size_t)scene->mesh_count, sizeof(uint32_t));
    if (!at->first || !at->solved) return false;
    for (int m = 0; m < scene->mesh_count; m++) {
        at->first[m + 1] = at->first[m] + refinement_mesh(refinement, scene, m).vertex_count;
        if (before) at->solved[m] = before->first[m + 1] - before->first[m];
    }
    size_t count = at->first[scene->mesh_count];
    at->values = alloc_array(count, OCCLUSION_VALUES * sizeof(float));
    at->position = alloc_array(count, 3 * sizeof(float));
    at->normal = alloc_array(count, 3 * sizeof(float));
    if (!at->values || !at->position || !at->normal) return false;
    for (int m = 0; before && m < scene->mesh_count; m++)
        memcpy(at->values + (size_t)OCCLUSION_VALUES * at->first[m],
               before->values + (size_t)OCCLUSION_VALUES * before->first[m],
               (size_t)at->solved[m] * OCCLUSION_VALUES * sizeof(float));
    return place_vertices(scene, at);
}

/* Returns true if the rim of a shadow lies between two vertices: if their fractions of the sky, or of lights, differ. A
 * light counts by its share and by its cosine at the end where that is greater, so that copies of an edge at a seam are
 * cut alike. */
static bool differ(const void *user, int mesh, uint32_t a, uint32_t b) {
    const Occlusion *self = user;
    const Outlook *at = &self->at;
    size_t one = (size_t)at->first[mesh] + a, two = (size_t)at->first[mesh] + b;
    const float *p = at->values + OCCLUSION_VALUES * one, *q = at->values + OCCLUSION_VALUES * two;
    bool two_sided = self->scene.materials[self->scene.meshes[mesh].material].double_sided;
    Vec3 n = vec3_load(at->normal + 3 * one), o = vec3_load(at->normal + 3 * two);
    float lights = 0.0f;
    for (int k = 0; k < self->env_light_count; k++) {
        float cn = vec3_dot(n, self->env_lights[k].direction), co = vec3_dot(o, self->env_lights[k].direction);
        float falls = two_sided ? max(fabsf(cn), fabsf(co)) : max(max(cn, co), 0.0f);
        lights += self->share[k] * falls * fabsf(p[OCCLUSION_LIGHT + k] - q[OCCLUSION_LIGHT + k]);
    }
    return max(lights, max(fabsf(p[0] - q[0]), fabsf(p[1] - q[1]))) > DIFFERENT;
}

/* Halves edges whose ends see different light. Returns false if no vertex was added. */
static bool cut(Occlusion *self) {
    const EdgeTest test = {.differ = differ, .user = self};
    Refinement finer;
    Outlook next;
    if (self->round == ROUNDS || !refinement_halve(&self->scene, &self->at.refinement, &test, &finer)) return false;
    self->round++;
    bool made = outlook_make(&self->scene, &finer, &self->at, &next);
    if (made) {
        outlook_free(&self->at);
        self->at = next;
    } else {
        outlook_free(&next);
    }
    return made;
}

static void *work(void *user) {
    Occlusion *self = user;
    thread_step_back(); /* lets threads that draw or compile go first */
    do {
        uint32_t count = self->at.first[self->scene.mesh_count];
        parallel_for(self->threads, (int)((count + BLOCK - 1) / BLOCK), search_block, self);
        keep(self);
    } while (!atomic_load(&self->stop) && cut(self));
    atomic_store(&self->done, 1);
    return NULL;
}

static WeftResult begin(Occlusion *self, WeftError *error) {
    WeftResult result = geometry_create(&self->scene, self->scene.mesh_count, self->threads, &self->geometry, error);
    if (result != WEFT_OK) return result;
    self->joined = pthread_create(&self->thread, NULL, work, self) != 0;
    if (self->joined) work(self); /* no thread could be made */
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
    place_brightness(self, how);
    self->joined = true;
    self->sky = alloc_array((size_t)self->rays, sizeof(Dir));
    self->toward = alloc_array((size_t)self->rays * OCCLUSION_LIGHTS, sizeof(Dir));
    Refinement own;
    bool made = self->sky && self->toward && copy_scene(self, scene) && refinement_copy(scene, refinement, &own) &&
                outlook_make(&self->scene, &own, NULL, &self->at);
    if (!made) {
        occlusion_free(self);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    place_sky(self);
    place_lights(self);
    if (!self->no_cache) self->key = values_key(self);
    bool found = find(self, log);
    while (found && cut(self)) found = find(self, log);
    WeftResult result = WEFT_OK;
    if (found)
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
    return self->at.values;
}

Refinement occlusion_take_refinement(Occlusion *self) {
    Refinement taken = self->at.refinement;
    self->at.refinement = (Refinement){0};
    return taken;
}

void occlusion_free(Occlusion *self) {
    if (!self) return;
    atomic_store(&self->stop, 1);
    if (!self->joined) pthread_join(self->thread, NULL);
    geometry_free(self->geometry);
    free(self->scene.meshes);
    free(self->scene.materials);
    outlook_free(&self->at);
    free(self->sky);
    free(self->toward);
    free(self);
}
