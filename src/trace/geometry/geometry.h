/* geometry.h - the scene's triangles behind Embree: nearest hit, occlusion, and what is at a hit */
#pragma once

#include "scene/record/scene.h"
#include "shading/dialect/rgb.h"

typedef struct Geometry Geometry;

/* Builds the acceleration structure over the scene's first `meshes` meshes, whose arrays it shares. */
WeftResult geometry_create(const WeftScene *scene, int meshes, int threads, Geometry **out, WeftError *error);
void geometry_free(Geometry *geometry);

/* Returns true if the acceleration structure is still valid: it depends on the shapes, and on which materials are
 * single-sided, panes (scene/light/pane.h) or have an opacity. */
bool geometry_serves(const Geometry *geometry);

/* Returns true if a mesh is a pane, or if any is. */
bool geometry_is_pane(const Geometry *geometry, uint32_t mesh);
bool geometry_has_panes(const Geometry *geometry);

typedef struct Ray {
    Vec3 origin;
    Vec3 direction;   /* unit */
    float near, far;  /* distances between which hits count */
    uint32_t key;     /* decides, together with the triangle, if a partly transparent surface is hit */
    bool past_lights; /* the ray passes through the shapes of polygon lights */
} Ray;

typedef struct Hit {
    float t;
    uint32_t mesh, triangle;
    float u, v;  /* barycentric weights of the second and third vertex */
    Vec3 facing; /* geometric normal by the winding, not normalised */
} Hit;

/* Finds the nearest hit; returns false if there is none. Rays pass through the backs of single-sided surfaces and
 * through transparent points. */
bool geometry_hit(const Geometry *geometry, Ray ray, Hit *hit);

/* Returns the part of light along a direction that a pane lets through at a hit. */
Rgb geometry_pane(const Geometry *geometry, const Hit *hit, Vec3 direction);

/* Returns a random number in [0, 1) for a ray at a pane. It depends on the place too, as rays of one key may start at one
 * point. */
float geometry_chance(const Hit *hit, uint32_t key);

/* Returns where a ray goes on that has passed a hit at t. */
static inline float geometry_past(float t) { return t + 1e-6f * fabsf(t) + 1e-30f; }

/* Finds the nearest triangle, whatever its side and opacity. */
bool geometry_triangle(const Geometry *geometry, Ray ray, Hit *hit);

/* Returns true if anything lies on the ray between near and far. A pane does by chance, as often as it takes of light. */
bool geometry_occluded(const Geometry *geometry, Ray ray);

/* Rays as arrays, from their origins on. They are traced GEOMETRY_PACKET at a time: the arrays must have the length of
 * a multiple of that. The hit of a ray may differ by rounding with its neighbours. */
enum { GEOMETRY_PACKET = 16 };
typedef struct RayRows {
    const float *o[3], *d[3];
    const float *far; /* NULL: without end */
    const uint32_t *key;
    bool past_lights, coherent; /* coherent: neighbours have similar directions */
} RayRows;

#define GEOMETRY_NOTHING UINT32_MAX

/* Hits of rays; mesh is GEOMETRY_NOTHING if nothing is hit. */
typedef struct HitRows {
    float *t, *u, *v;
    uint32_t *mesh, *triangle;
} HitRows;

/* Finds the nearest hits of `count` rays. */
void geometry_hits(const Geometry *geometry, const RayRows *rays, int count, const HitRows *hits);

/* Sets occluded[k] if anything lies between ray k's origin and its far end, or if the ray is invalid. Panes do not lie
 * there, but through[k] becomes what they let through, unless `through` is NULL: then they do by chance, as above. */
void geometry_occlusions(const Geometry *geometry, const RayRows *rays, int count, bool *occluded, Rgb *through);

/* Returns the normal of a triangle by its winding, not normalised. */
static inline Vec3 geometry_winding(const Mesh *mesh, uint32_t triangle) {
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    Vec3 p[3];
    for (int corner = 0; corner < 3; corner++) p[corner] = vec3_load(mesh->position + 3 * (size_t)index[corner]);
    return vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
}

/* Position and orientation of a hit. */
typedef struct Vertex {
    Vec3 position;
    Vec3 geometric;   /* unit, on the side the triangle winds counter-clockwise */
    Vec3 normal;      /* unit, interpolated; the geometric one if the mesh has none */
    Vec3 tangent;     /* as stored, not normalised; 0 if the mesh has none */
    float handedness; /* of the bitangent */
} Vertex;

Vertex geometry_vertex(const Mesh *mesh, const Hit *hit);

/* Texture coordinates and colour at a hit. */
typedef struct Attributes {
    float uv[2][2];
    float color[4]; /* linear RGBA, white if the mesh has none */
} Attributes;

Attributes geometry_attributes(const Mesh *mesh, const Hit *hit);
