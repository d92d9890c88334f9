/* Specification: Khronos glTF extension registry, KHR_lights_punctual. */
#include "gltf/read/light.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pi.h"
#include "gltf/asset/field.h"

void lights_count(Asset *asset) {
    Field root = field_root(asset), extension = field_extension(&root, "KHR_lights_punctual"),
          list = field_member(&extension, "lights");
    asset->light_count = field_count(&list);
}

static void cone_read(const Field *field, Light *light) {
    static const char *const keys[] = {"innerConeAngle", "outerConeAngle", "extensions", "extras", NULL};
    Field spot = field_member(field, "spot"), inner_field = field_member(&spot, "innerConeAngle"),
          outer_field = field_member(&spot, "outerConeAngle");
    field_keys(&spot, keys);
    const double right_angle = 0.5 * PI_DOUBLE, narrowest = 1e-3;
    double outer = field_number(&outer_field, 0.5 * right_angle, narrowest, right_angle);
    double inner = field_number(&inner_field, 0.0, 0.0, right_angle);
    if (inner > outer) {
        field_warn(&inner_field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%g is beyond outerConeAngle and taken as %g", inner,
                   outer);
        inner = outer;
    }
    light->cos_inner = (float)cos(inner);
    light->cos_outer = (float)cos(outer);
}

/* Reads a light. Returns false, with a warning, if it is of a type that the extension does not have. */
static bool light_read(const Field *field, const Node *node, Light *light) {
    static const char *const kinds[] = {"directional", "point", "spot", NULL}; /* as LightKind */
    static const char *const keys[] = {"name", "type",       "color",  "intensity", "range",
                                       "spot", "extensions", "extras", NULL};
    Field name_field = field_member(field, "name"), type = field_member(field, "type"),
          color = field_member(field, "color"), intensity = field_member(field, "intensity"),
          range = field_member(field, "range");
    const char *name = field_text(&name_field, "");
    if (!type.json) field_fail(&type, WEFT_MESSAGE_GLTF_SCHEMA, "missing directional, point or spot");
    const int kind = field_choice(&type, kinds, -1, "light");
    const Transform *world = &node->world;
    field_keys(field, keys);
    *light = (Light){.name = asset_text(field->asset, *name ? name : node->name),
                     .kind = kind < 0 ? LIGHT_POINT : (LightKind)kind,
                     .color = {1.0f, 1.0f, 1.0f},
                     .cos_inner = 1.0f};
    field_floats(&color, light->color, 3, 0.0f, 1.0f);
    light->intensity = (float)field_number(&intensity, 1.0, 0.0, 1e30);
    light->range = (float)field_number(&range, 0.0, 0.0, 1e18);
    light->position = (Vec3){(float)world->m[0][3], (float)world->m[1][3], (float)world->m[2][3]};
    if (light->kind != LIGHT_DIRECTIONAL && !within_reach(light->position, SCENE_REACH))
        field_fail(field, WEFT_MESSAGE_GLTF_TOO_LARGE, "its node is too far away");
    if (light->kind == LIGHT_SPOT) cone_read(field, light);
    double x = -world->m[0][2], y = -world->m[1][2], z = -world->m[2][2], size = sqrt(x * x + y * y + z * z);
    if (fabs(size - 1.0) < 5e-7) size = 1.0; /* within float precision, so that a saved light is read back exactly */
    if (size > 0.0 && isfinite(size))
        light->direction = (Vec3){(float)(x / size), (float)(y / size), (float)(z / size)};
    else
        light->direction = (Vec3){0.0f, 0.0f, -1.0f};
    return kind >= 0;
}

void lights_read(Asset *asset) {
    WeftScene *scene = asset->scene;
    Field root = field_root(asset), extension = field_extension(&root, "KHR_lights_punctual"),
          list = field_member(&extension, "lights");
    size_t count = 0;
    for (size_t i = 0; i < asset->node_count; i++)
        count += asset->nodes[i].shown && !asset->nodes[i].hidden && asset->nodes[i].light >= 0;
    scene->lights = asset_array(asset, &scene->arena, count, sizeof *scene->lights);
    for (size_t i = 0; i < asset->node_count && asset->result == WEFT_OK; i++) {
        const Node *node = &asset->nodes[i];
        if (!node->shown || node->hidden || node->light < 0) continue;
        Field field = field_element(&list, (size_t)node->light);
        if (light_read(&field, node, &scene->lights[scene->light_count])) scene->light_count++;
    }
}
