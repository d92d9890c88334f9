#include "weft/pick.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "scene/record/camera.h"
#include "trace/geometry/geometry.h"

enum { TRIES = 16 }; /* rays with different keys, so that a partly transparent surface is hit, but no hole */

struct WeftPick {
    const WeftScene *scene;
    Geometry *geometry; /* of the scene's own meshes, without those of lights, which may change */
};

WeftResult weft_pick_create(const WeftScene *scene, WeftPick **out, WeftError *error) {
    *out = NULL;
    if (!scene_own_meshes(scene)) return fail(error, WEFT_MESSAGE_SCENE_EMPTY, scene->name, NULL);
    WeftPick *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    self->scene = scene;
    WeftResult result = geometry_create(scene, scene_own_meshes(scene), 0, &self->geometry, error);
    if (result == WEFT_OK)
        *out = self;
    else
        weft_pick_free(self);
    return result;
}

void weft_pick_free(WeftPick *self) {
    if (!self) return;
    geometry_free(self->geometry);
    free(self);
}

static bool nearest(const WeftPick *self, CameraRay through, Hit *hit) {
    bool any = false;
    for (uint32_t k = 0; k < TRIES; k++) {
        Hit found;
        Ray ray = {through.origin, through.direction, 0.0f, INFINITY, k, false};
        if (!geometry_hit(self->geometry, ray, &found) || (any && found.t >= hit->t)) continue;
        *hit = found;
        any = true;
    }
    return any;
}

/* Changes of position with u and with v on a triangle, and the length in UV of a metre. */
typedef struct Stretch {
    Vec3 u, v;
    float uv_per_metre;
} Stretch;

static Stretch stretch_of(const Mesh *mesh, const Hit *hit) {
    static const float none[6];
    const uint32_t *index = mesh->index + 3 * (size_t)hit->triangle;
    const float *p[3], *t[3];
    for (int k = 0; k < 3; k++) {
        p[k] = mesh->position + 3 * (size_t)index[k];
        t[k] = mesh->texcoord[0] ? mesh->texcoord[0] + 2 * (size_t)index[k] : none;
    }
    Vec3 a = vec3_sub(vec3_load(p[1]), vec3_load(p[0])), b = vec3_sub(vec3_load(p[2]), vec3_load(p[0]));
    float ua = t[1][0] - t[0][0], va = t[1][1] - t[0][1], ub = t[2][0] - t[0][0], vb = t[2][1] - t[0][1];
    float twice = ua * vb - ub * va, area = vec3_length(vec3_cross(a, b)), sign = twice < 0.0f ? -1.0f : 1.0f;
    Stretch s = {.uv_per_metre = area > 0.0f ? sqrtf(fabsf(twice) / area) : 0.0f};
    if (!(fabsf(twice) > 0.0f)) return s;
    s.u = vec3_scale(vec3_madd(vec3_scale(a, vb), b, -va), sign);
    s.v = vec3_scale(vec3_madd(vec3_scale(b, ua), a, -ub), sign);
    return s;
}

/* Returns the component of a at right angles to n, normalised. */
static Vec3 beside(Vec3 a, Vec3 n, Vec3 fallback) {
    Vec3 unit = vec3_normal_or(a, fallback);
    return vec3_normal_or(vec3_madd(unit, n, -vec3_dot(unit, n)), fallback);
}

static void store(float to[3], Vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

static void describe(const WeftPick *self, const Hit *hit, Vec3 direction, WeftPicked *out) {
    const Mesh *mesh = &self->scene->meshes[hit->mesh];
    Vertex vertex = geometry_vertex(mesh, hit);
    Attributes at = geometry_attributes(mesh, hit);
    Stretch stretch = stretch_of(mesh, hit);
    float side = vec3_dot(vertex.geometric, direction) > 0.0f ? -1.0f : 1.0f;
    Vec3 n = vec3_scale(vertex.normal, side);
    Vec3 pole = fabsf(n.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    Vec3 t = beside(stretch.u, n, vec3_normal_or(vec3_cross(pole, n), vec3(1.0f, 0.0f, 0.0f)));
    out->mesh = (int)hit->mesh;
    out->material = mesh->material;
    store(out->position, vertex.position);
    store(out->normal, n);
    store(out->tangent, t);
    store(out->bitangent, beside(stretch.v, n, vec3_cross(n, t)));
    memcpy(out->texcoord, at.uv, sizeof out->texcoord);
    out->distance = hit->t;
    out->uv_per_metre = stretch.uv_per_metre;
}

int weft_pick_at(const WeftPick *self, const char *text, int width, int height, float x, float y, WeftPicked *out) {
    Camera camera;
    Hit hit;
    *out = (WeftPicked){0};
    if (width < 1 || height < 1 || !isfinite(x) || !isfinite(y)) return 0;
    float aspect = (float)width / (float)height;
    if (camera_find(self->scene, text, aspect, &camera, NULL) != WEFT_OK) return 0;
    View view = view_of(&camera, aspect);
    CameraRay ray = view_ray(&view, 2.0f * x / (float)width - 1.0f, 1.0f - 2.0f * y / (float)height);
    if (!nearest(self, ray, &hit)) return 0;
    describe(self, &hit, ray.direction, out);
    return 1;
}
