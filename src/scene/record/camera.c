#include "scene/record/camera.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/number.h"
#include "base/pi.h"
#include "weft/render.h"

Camera camera_towards(const char *name, Vec3 eye, Vec3 target, float yfov) {
    const Vec3 forward = vec3_normal_or(vec3_sub(target, eye), vec3(0.0f, 0.0f, -1.0f));
    const Vec3 up = fabsf(forward.y) > 0.9999f ? vec3(0.0f, 0.0f, -1.0f) : vec3(0.0f, 1.0f, 0.0f);
    const Vec3 right = vec3_normal_or(vec3_cross(forward, up), vec3(1.0f, 0.0f, 0.0f));
    return (Camera){
        .name = name, .eye = eye, .forward = forward, .right = right, .up = vec3_cross(right, forward), .yfov = yfov};
}

/* Finds the eye from which every vertex is inside the frustum, touching it on at least one pair of sides and
 * centred between the other. In camera axes, z forward, t the slope of a side: x - ex <= t (z - ez) and ex -
 * x <= t (z - ez) for all points give ex and the largest ez from the two extremes of x - t z and -x - t z; y
 * likewise. */
static Camera frame_scene(const WeftScene *scene, float aspect) {
    const float azimuth = 0.61f, elevation = 0.26f, margin = 1.12f; /* 35 and 15 degrees */
    Camera camera =
        camera_towards("auto", vec3(sinf(azimuth) * cosf(elevation), sinf(elevation), cosf(azimuth) * cosf(elevation)),
                       vec3(0.0f, 0.0f, 0.0f), 0.49f); /* 28 degrees, a portrait lens */
    float ty = tanf(0.5f * camera.yfov) / margin, tx = ty * aspect;
    float right = -INFINITY, left = -INFINITY, above = -INFINITY, below = -INFINITY;
    for (int m = 0; m < scene_own_meshes(scene); m++)
        for (uint32_t k = 0; k < scene->meshes[m].vertex_count; k++) {
            Vec3 p = vec3_load(scene->meshes[m].position + 3 * (size_t)k);
            float x = vec3_dot(p, camera.right), y = vec3_dot(p, camera.up), z = vec3_dot(p, camera.forward);
            right = fmaxf(right, x - tx * z), left = fmaxf(left, -x - tx * z);
            above = fmaxf(above, y - ty * z), below = fmaxf(below, -y - ty * z);
        }
    float ez = fminf(-(right + left) / (2.0f * tx), -(above + below) / (2.0f * ty));
    Vec3 across = vec3_scale(camera.right, 0.5f * (right - left));
    Vec3 up = vec3_scale(camera.up, 0.5f * (above - below));
    camera.eye = vec3_add(vec3_add(across, up), vec3_scale(camera.forward, ez));
    if (vec3_length(vec3_sub(scene->high, scene->low)) <= 0.0f) /* a single point: any distance will do */
        camera.eye = vec3_sub(camera.eye, camera.forward);
    return camera;
}

void weft_camera_rotated(const float eye[3], const float target[3], float fov, int index, int count,
                         char text[WEFT_CAMERA_TEXT]) {
    const double angle = 2.0 * PI_DOUBLE * index / count, c = cos(angle), s = sin(angle);
    const double x = (double)eye[0] - (double)target[0], z = (double)eye[2] - (double)target[2];
    snprintf(text, WEFT_CAMERA_TEXT, "%.9g,%.9g,%.9g;%.9g,%.9g,%.9g;%.9g", (double)target[0] + c * x + s * z,
             (double)eye[1], (double)target[2] - s * x + c * z, (double)target[0], (double)target[1], (double)target[2],
             (double)fov);
}

/* Returns true if text has the form "eye;target;fov". *wrong then names what is invalid in it, or is NULL
 * if a camera was made. */
static bool parse_view(const char *text, Camera *camera, const char **wrong) {
    char copy[256];
    if (strlen(text) >= sizeof copy) return false;
    memcpy(copy, text, strlen(text) + 1);
    char *target = strchr(copy, ';'), *fov = target ? strchr(target + 1, ';') : NULL;
    if (!fov) return false;
    *target++ = '\0';
    *fov++ = '\0';
    float e[3], t[3], degrees;
    if (!parse_numbers(copy, ',', 3, e) || !parse_numbers(target, ',', 3, t) || !parse_number(fov, &degrees))
        return false;
    *wrong = !(degrees > 0.01f && degrees < 179.0f)         ? "its field of view is not within 0.01 and 179 degrees"
             : e[0] == t[0] && e[1] == t[1] && e[2] == t[2] ? "its eye is where its target is"
                                                            : NULL;
    if (!within_reach(vec3_load(e), SCENE_REACH) || !within_reach(vec3_load(t), SCENE_REACH))
        *wrong = "its eye or its target is beyond 1e15 m";
    if (*wrong) return true;
    *camera = camera_towards("", vec3_load(e), vec3_load(t), degrees * (PI_FLOAT / 180.0f));
    return true;
}

View view_of(const Camera *camera, float aspect) {
    float half = camera->orthographic ? camera->ymag : tanf(0.5f * camera->yfov);
    return (View){.eye = camera->eye,
                  .forward = camera->forward,
                  .across = vec3_scale(camera->right, half * aspect),
                  .up = vec3_scale(camera->up, half),
                  .orthographic = camera->orthographic};
}

/* Returns true if all rays of a picture start within reach. */
static bool starts_within_reach(const Camera *camera, float aspect) {
    View view = view_of(camera, aspect);
    Vec3 beside = view.orthographic ? vec3_add(view.across, view.up) : vec3(0.0f, 0.0f, 0.0f);
    return within_reach(vec3_add(view.eye, beside), RAY_REACH) && within_reach(vec3_sub(view.eye, beside), RAY_REACH);
}

/* Returns the scene's camera of that name or index, or NULL. */
static const Camera *own_camera(const WeftScene *scene, const char *text) {
    for (int k = 0; k < scene->camera_count; k++) {
        char index[16];
        snprintf(index, sizeof index, "%d", k);
        if (strcmp(scene->cameras[k].name, text) == 0 || strcmp(index, text) == 0) return &scene->cameras[k];
    }
    return NULL;
}

WeftResult camera_find(const WeftScene *scene, const char *text, float aspect, Camera *out, WeftError *error) {
    char names[NAMES_SIZE];
    bool framed = !text || strcmp(text, "auto") == 0;
    const Camera *own = framed ? NULL : own_camera(scene, text);
    const char *wrong = NULL;
    if (framed && scene->low.x > scene->high.x) return fail(error, WEFT_MESSAGE_SCENE_EMPTY, scene->name, NULL);
    if (framed)
        *out = frame_scene(scene, aspect);
    else if (own)
        *out = *own;
    else if (!parse_view(text, out, &wrong))
        return fail(error, WEFT_MESSAGE_CAMERA_NAME, text, "%s; else write auto or \"eye;target;fov\"",
                    scene_names(scene, weft_scene_camera_name, names));
    if (!wrong && !starts_within_reach(out, aspect)) wrong = "a picture of this shape is seen from beyond 1e18 m";
    return wrong ? fail(error, WEFT_MESSAGE_CAMERA_NAME, framed ? "auto" : text, "%s", wrong) : WEFT_OK;
}

void camera_describe(const WeftScene *scene, const Camera *camera, float eye[3], float target[3], float *fov) {
    Vec3 middle = vec3_scale(vec3_add(scene->low, scene->high), 0.5f);
    float depth = fmaxf(vec3_dot(vec3_sub(middle, camera->eye), camera->forward), 1e-3f);
    Vec3 at = vec3_madd(camera->eye, camera->forward, depth);
    const float e[3] = {camera->eye.x, camera->eye.y, camera->eye.z}, t[3] = {at.x, at.y, at.z};
    memcpy(eye, e, sizeof e);
    memcpy(target, t, sizeof t);
    *fov = camera->yfov * (180.0f / PI_FLOAT);
}

WeftResult weft_scene_camera(const WeftScene *scene, const char *text, float aspect, WeftCamera *out,
                             WeftError *error) {
    Camera camera = {0};
    *out = (WeftCamera){0};
    if (!(aspect > 0.0f && isfinite(aspect)))
        return fail(error, WEFT_MESSAGE_DESC, "camera", "aspect %g", (double)aspect);
    WeftResult result = camera_find(scene, text, aspect, &camera, error);
    if (result != WEFT_OK) return result;
    camera_describe(scene, &camera, out->eye, out->target, &out->fov);
    const float up[3] = {camera.up.x, camera.up.y, camera.up.z};
    memcpy(out->up, up, sizeof up);
    if (camera.orthographic) out->fov = 0.0f;
    return WEFT_OK;
}
