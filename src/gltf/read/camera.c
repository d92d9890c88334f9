/* camera.c - cameras of glTF nodes
 *
 * Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.10 (cameras). */
#include "gltf/read/gltf_camera.h"

#include <float.h>
#include <math.h>

#include "gltf/asset/field.h"

void cameras_count(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "cameras");
    asset->camera_count = field_count(&list);
}

static Vec3 column(const Transform *t, int c) {
    return (Vec3){(float)t->m[0][c], (float)t->m[1][c], (float)t->m[2][c]};
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Returns true if the columns are orthonormal and right-handed to within float precision. They are then kept,
 * so that a saved camera is read back exactly. */
static bool is_frame(const Transform *t) {
    const double slack = 2e-7;
    bool frame = true;
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            double dot = t->m[0][a] * t->m[0][b] + t->m[1][a] * t->m[1][b] + t->m[2][a] * t->m[2][b];
            frame &= fabs(dot - (a == b ? 1.0 : 0.0)) < slack;
        }
    double across = t->m[1][0] * t->m[2][1] - t->m[2][0] * t->m[1][1];
    return frame && fabs(across - t->m[0][2]) < slack;
}

/* Sets the frame of the camera: at the origin of the node, looking along -z with +y up; scale is ignored.
 * Returns false if the transform has no direction. */
static bool camera_place(const Transform *world, Camera *camera) {
    Transform frame = transform_identity; /* columns right, up, back */
    double back[3], up[3];
    camera->eye = column(world, 3);
    if (is_frame(world)) {
        camera->right = column(world, 0);
        camera->up = column(world, 1);
        camera->forward = vec3_scale(column(world, 2), -1.0f);
        return true;
    }
    for (int i = 0; i < 3; i++) {
        back[i] = world->m[i][2];
        up[i] = world->m[i][1];
    }
    double size = length(back);
    for (int i = 0; i < 3; i++) back[i] /= size > 0.0 ? size : 1.0;
    double slant = up[0] * back[0] + up[1] * back[1] + up[2] * back[2];
    for (int i = 0; i < 3; i++) up[i] -= slant * back[i];
    double height = length(up);
    if (!(size > 0.0) || !(height > 0.0) || !isfinite(size) || !isfinite(height)) return false;
    for (int i = 0; i < 3; i++) {
        up[i] /= height;
        frame.m[i][1] = up[i];
        frame.m[i][2] = -back[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        frame.m[i][0] = up[j] * back[k] - up[k] * back[j];
    }
    camera->right = column(&frame, 0);
    camera->up = column(&frame, 1);
    camera->forward = column(&frame, 2);
    return true;
}

/* Reads a camera. Returns false, with a warning, if it is of a type that glTF does not have. */
static bool camera_read(const Field *field, const Node *node, Camera *camera) {
    static const char *const types[] = {"perspective", "orthographic", NULL};
    static const char *const keys[] = {"name", "type", "perspective", "orthographic", "extensions", "extras", NULL};
    static const char *const lens_keys[] = {"yfov", "aspectRatio", "xmag",   "ymag", "znear",
                                            "zfar", "extensions",  "extras", NULL};
    Field name_field = field_member(field, "name"), type_field = field_member(field, "type"),
          perspective = field_member(field, "perspective"), orthographic = field_member(field, "orthographic");
    Field yfov = field_member(&perspective, "yfov"), ymag = field_member(&orthographic, "ymag");
    const char *name = field_text(&name_field, "");
    if (!type_field.json) field_fail(&type_field, WEFT_MESSAGE_GLTF_SCHEMA, "missing perspective or orthographic");
    const int type = field_choice(&type_field, types, -1, "camera");
    if (type < 0) return false;
    field_keys(field, keys);
    field_keys(&perspective, lens_keys);
    field_keys(&orthographic, lens_keys);
    camera->name = asset_text(field->asset, *name ? name : node->name);
    camera->orthographic = type == 1;
    const Field *needed = camera->orthographic ? &ymag : &yfov;
    if (!needed->json) field_fail(needed, WEFT_MESSAGE_GLTF_SCHEMA, "missing a number");
    /* Files with negative magnifications exist; the sign does not matter here. */
    camera->ymag = (float)fabs(field_number(&ymag, 1.0, -1e15, 1e15));
    camera->yfov = (float)field_number(&yfov, 1.0, 1e-4, 3.1415);
    if (!(camera->ymag > 0.0f)) field_fail(&ymag, WEFT_MESSAGE_GLTF_SCHEMA, "must not be 0");
    return true;
}

void cameras_read(Asset *asset) {
    WeftScene *scene = asset->scene;
    Field root = field_root(asset), list = field_member(&root, "cameras");
    size_t count = 0;
    for (size_t i = 0; i < asset->node_count; i++) count += asset->nodes[i].shown && asset->nodes[i].camera >= 0;
    scene->cameras = asset_array(asset, &scene->arena, count, sizeof *scene->cameras);
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        const Node *node = &asset->nodes[i];
        if (!node->shown || node->camera < 0) continue;
        Field field = field_element(&list, (size_t)node->camera);
        Camera *camera = &scene->cameras[scene->camera_count];
        if (!camera_read(&field, node, camera)) continue;
        bool placed = camera_place(&node->world, camera);
        if (!within_reach(camera->eye, SCENE_REACH))
            field_fail(&field, WEFT_MESSAGE_GLTF_TOO_LARGE, "its node is too far away");
        if (placed)
            scene->camera_count++;
        else
            field_warn(&field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "its node's transform is singular");
    }
}
