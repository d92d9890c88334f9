/* geometry.h - the scene's triangles behind Embree: nearest hit, occlusion, and what is at a hit */
#ifndef WEFT_TRACE_GEOMETRY_H
#define WEFT_TRACE_GEOMETRY_H

#include "scene/record/scene.h"

typedef struct Geometry Geometry;

/* Builds the acceleration structure over the scene's first `meshes` meshes, whose arrays it shares. */
WeftResult geometry_create(const WeftScene *scene, int meshes, int threads, Geometry **out, WeftError *error);
void geometry_free(Geometry *geometry);

/* Returns true if the acceleration structure still suits the materials, as far as it depends on them. */
bool geometry_serves(const Geometry *geometry);

typedef struct Ray {
    Vec3 origin, direction; /* unit */
    float near, far;
    uint32_t key;     /* decides, together with the triangle, whether a half-transparent surface is there */
    bool past_lights; /* the shapes of polygon lights are not there for it */
} Ray;

typedef struct Hit {
    float t;
    uint32_t mesh, triangle;
    float u, v;  /* barycentric weights of the second and third vertex */
    Vec3 facing; /* geometric normal by the winding, not normalised */
} Hit;

/* The nearest surface that is there: not the back of a single-sided one, not a transparent point. */
bool geometry_hit(const Geometry *geometry, Ray ray, Hit *hit);

/* Returns true if anything lies on the ray between near and far. */
bool geometry_occluded(const Geometry *geometry, Ray ray);

/* Rays as arrays, from their origins on. They are traced GEOMETRY_PACKET at a time: the arrays must have room
 * up to a multiple of that. What a ray finds may differ by rounding with those beside it. */
enum { GEOMETRY_PACKET = 16 };
typedef struct RayRows {
    const float *o[3], *d[3];
    const float *far; /* NULL: without end */
    const uint32_t *key;
    bool past_lights, coherent; /* coherent: neighbours go the same way */
} RayRows;

#define GEOMETRY_NOTHING UINT32_MAX

/* The ends of rays; mesh is GEOMETRY_NOTHING if nothing is hit. */
typedef struct HitRows {
    float *t, *u, *v;
    uint32_t *mesh, *triangle;
} HitRows;

void geometry_hits(const Geometry *geometry, const RayRows *rays, int count, const HitRows *hits);

/* Sets hidden[k] if anything lies between ray k's origin and its far end, or the ray is not sound. */
void geometry_occlusions(const Geometry *geometry, const RayRows *rays, int count, bool *hidden);

/* The point and orientation at which a triangle was hit. */
typedef struct Vertex {
    Vec3 position;
    Vec3 geometric;   /* unit, on the side the triangle winds counter-clockwise */
    Vec3 normal;      /* unit, interpolated; the geometric one where the mesh has none */
    Vec3 tangent;     /* as stored, not normalised; 0 where the mesh has none */
    float handedness; /* of the bitangent */
} Vertex;

Vertex geometry_vertex(const Mesh *mesh, const Hit *hit);

/* The texture coordinates and other attributes at a hit. */
typedef struct Attributes {
    float uv[2][2];
    float color[4]; /* linear RGBA, white where the mesh has none */
} Attributes;

Attributes geometry_attributes(const Mesh *mesh, const Hit *hit);

#endif
