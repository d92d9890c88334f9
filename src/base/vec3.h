/* vec3.h - three floats in world space */
#pragma once

#include <math.h>

typedef struct Vec3 {
    float x, y, z;
} Vec3;

static inline Vec3 vec3(float x, float y, float z) { return (Vec3){x, y, z}; }
static inline Vec3 vec3_load(const float *p) { return (Vec3){p[0], p[1], p[2]}; }
static inline Vec3 vec3_add(Vec3 a, Vec3 b) { return (Vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline Vec3 vec3_sub(Vec3 a, Vec3 b) { return (Vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline Vec3 vec3_scale(Vec3 a, float s) { return (Vec3){a.x * s, a.y * s, a.z * s}; }
static inline Vec3 vec3_madd(Vec3 a, Vec3 b, float s) { return (Vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s}; }
static inline float vec3_dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline float vec3_length(Vec3 a) { return sqrtf(vec3_dot(a, a)); }

/* Returns the least or the greatest of each number. Starting from infinity, they give the bounding box of points. */
static inline Vec3 vec3_least(Vec3 a, Vec3 b) { return (Vec3){fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)}; }
static inline Vec3 vec3_most(Vec3 a, Vec3 b) { return (Vec3){fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)}; }

static inline Vec3 vec3_cross(Vec3 a, Vec3 b) {
    return (Vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Returns a / |a|, or fallback where a has no direction. */
static inline Vec3 vec3_normal_or(Vec3 a, Vec3 fallback) {
    float s = vec3_dot(a, a);
    return s > 1e-30f && s < 1e30f ? vec3_scale(a, 1.0f / sqrtf(s)) : fallback;
}

static inline Vec3 vec3_lerp3(Vec3 a, Vec3 b, Vec3 c, float wa, float wb, float wc) {
    return vec3_madd(vec3_madd(vec3_scale(a, wa), b, wb), c, wc);
}
