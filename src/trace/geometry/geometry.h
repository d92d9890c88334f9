/* geometry.h - the scene's triangles behind Embree: nearest hit, occlusion, and what is at a hit */
#pragma once

#include "scene/record/scene.h"

typedef struct Geometry Geometry;

/* Builds the acceleration structure over the scene's first `meshes` meshes, whose arrays it shares. */
WeftResult geometry_create(const WeftScene *scene, int meshes, int threads, Geometry **out, WeftError *error);
void geometry_free(Geometry *geometry);

/* Returns true if the acceleration structure is still valid: it depends on the shapes, and on which materials are
 * single-sided or have an opacity. */
bool geometry_serves(const Geometry *geometry);

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

/* Finds the nearest triangle, whatever its side and opacity. */
bool geometry_triangle(const Geometry *geometry, Ray ray, Hit *hit);

/* Returns true if anything lies on the ray between near and far. */
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

/* Sets occluded[k] if anything lies between ray k's origin and its far end, or if the ray is invalid. */
void geometry_occlusions(const Geometry *geometry, const RayRows *rays, int count, bool *occluded);

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
