#include "view/render/orbit.h"

#include "base/pi.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float degree = (float)RADIANS;

static float dot3(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static float length3(const float a[3]) { return sqrtf(dot3(a, a)); }

static void unit(float a[3]) {
    float n = length3(a);
    for (int k = 0; k < 3 && n > 0.0f; k++) a[k] /= n;
}

static void cross3(const float a[3], const float b[3], float c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static float distance(const Orbit *o) {
    float d[3] = {o->target[0] - o->eye[0], o->target[1] - o->eye[1], o->target[2] - o->eye[2]};
    return fmaxf(length3(d), 1e-6f);
}

void orbit_axes(const Orbit *o, float right[3], float up[3], float forward[3]) {
    static const float y[3] = {0.0f, 1.0f, 0.0f};
    for (int k = 0; k < 3; k++) forward[k] = o->target[k] - o->eye[k];
    unit(forward);
    cross3(forward, y, right);
    if (!(length3(right) > 1e-6f)) right[0] = 1.0f, right[1] = right[2] = 0.0f;
    unit(right);
    cross3(right, forward, up);
}

bool orbit_at(Orbit *o, const WeftScene *scene, const char *camera, float aspect) {
    WeftCamera found;
    if (weft_scene_camera(scene, camera, aspect, &found, NULL) != WEFT_OK) return false;
    memcpy(o->eye, found.eye, sizeof o->eye);
    memcpy(o->target, found.target, sizeof o->target);
    o->fov = found.fov > 0.0f ? found.fov : 30.0f;
    snprintf(o->name, sizeof o->name, "%s", camera && !strchr(camera, ';') ? camera : "");
    return true;
}

/* Rotates a direction by angles about +y and about the horizontal; not over the poles. */
static void rotate(float d[3], float across, float down) {
    float flat = sqrtf(d[0] * d[0] + d[2] * d[2]), n = length3(d);
    float yaw = atan2f(d[0], d[2]) - across, pitch = atan2f(d[1], flat) - down;
    pitch = fminf(fmaxf(pitch, -89.0f * degree), 89.0f * degree);
    d[0] = n * cosf(pitch) * sinf(yaw);
    d[1] = n * sinf(pitch);
    d[2] = n * cosf(pitch) * cosf(yaw);
}

void orbit_rotate(Orbit *o, float across, float down) {
    float d[3];
    for (int k = 0; k < 3; k++) d[k] = o->eye[k] - o->target[k];
    rotate(d, across, -down);
    for (int k = 0; k < 3; k++) o->eye[k] = o->target[k] + d[k];
    o->name[0] = '\0';
}

void orbit_look(Orbit *o, float across, float down) {
    float d[3];
    for (int k = 0; k < 3; k++) d[k] = o->target[k] - o->eye[k];
    rotate(d, across, down);
    for (int k = 0; k < 3; k++) o->target[k] = o->eye[k] + d[k];
    o->name[0] = '\0';
}

static void move(Orbit *o, const float d[3]) {
    for (int k = 0; k < 3; k++) {
        if (!(fabsf(o->eye[k] + d[k]) < 1e6f)) continue; /* too far from everything */
        o->eye[k] += d[k];
        o->target[k] += d[k];
    }
    o->name[0] = '\0';
}

void orbit_pan(Orbit *o, float across, float down) {
    float right[3], up[3], forward[3], d[3], height = 2.0f * distance(o) * tanf(0.5f * o->fov * degree);
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++) d[k] = height * (down * up[k] - across * right[k]);
    move(o, d);
}

void orbit_dolly(Orbit *o, float factor) {
    float far = fminf(fmaxf(distance(o) * factor, 1e-3f), 1e5f) / distance(o);
    for (int k = 0; k < 3; k++) o->eye[k] = o->target[k] + far * (o->eye[k] - o->target[k]);
    o->name[0] = '\0';
}

void orbit_fly(Orbit *o, float ahead, float across, float rise) {
    float right[3], up[3], forward[3], d[3];
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++) d[k] = ahead * forward[k] + across * right[k];
    d[1] += rise;
    move(o, d);
}

void orbit_frame(Orbit *o, const float low[3], const float high[3], float aspect) {
    float d[3], radius = 0.0f;
    for (int k = 0; k < 3; k++) {
        d[k] = o->eye[k] - o->target[k];
        radius += 0.25f * (high[k] - low[k]) * (high[k] - low[k]);
    }
    radius = fmaxf(sqrtf(radius), 1e-3f);
    if (!(radius < 1e6f)) return;
    unit(d);
    float half = atanf(tanf(0.5f * o->fov * degree) * fminf(aspect, 1.0f)), far = radius / sinf(half);
    for (int k = 0; k < 3; k++) {
        o->target[k] = 0.5f * (low[k] + high[k]);
        o->eye[k] = o->target[k] + far * d[k];
    }
    o->name[0] = '\0';
}

const char *orbit_text(const Orbit *o, char text[ORBIT_TEXT]) {
    if (o->name[0]) {
        snprintf(text, ORBIT_TEXT, "%s", o->name);
        return text;
    }
    snprintf(text, ORBIT_TEXT, "%.7g,%.7g,%.7g;%.7g,%.7g,%.7g;%.7g", (double)o->eye[0], (double)o->eye[1],
             (double)o->eye[2], (double)o->target[0], (double)o->target[1], (double)o->target[2], (double)o->fov);
    return text;
}

bool orbit_project(const Orbit *o, const float point[3], float aspect, float at[2]) {
    float right[3], up[3], forward[3], d[3], tangent = tanf(0.5f * o->fov * degree);
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++) d[k] = point[k] - o->eye[k];
    float depth = dot3(d, forward);
    if (!(depth > 1e-6f)) return false;
    at[0] = 0.5f + 0.5f * dot3(d, right) / (depth * tangent * aspect);
    at[1] = 0.5f - 0.5f * dot3(d, up) / (depth * tangent);
    return true;
}

void orbit_ray(const Orbit *o, float aspect, float x, float y, float direction[3]) {
    float right[3], up[3], forward[3], tangent = tanf(0.5f * o->fov * degree);
    orbit_axes(o, right, up, forward);
    for (int k = 0; k < 3; k++)
        direction[k] =
            forward[k] + (2.0f * x - 1.0f) * tangent * aspect * right[k] + (1.0f - 2.0f * y) * tangent * up[k];
    unit(direction);
}
