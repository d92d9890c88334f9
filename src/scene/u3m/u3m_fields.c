#include "scene/u3m/u3m_fields.h"

#include <math.h>
#include <stddef.h>

/* The gloss of a principled coat stands for 1 - roughness: its alpha is .001 where the roughness is 0 and .1 where it is
 * 1 (shading/workflows/disney.h). */
static const U3mField fields[] = {
    {"basecolor", U3M_COLOR, INPUT_base_color, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f},
    {"alpha", U3M_NUMBER, INPUT_opacity, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f},
    {"metalness", U3M_NUMBER, INPUT_metallic, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f},
    {"roughness", U3M_NUMBER, INPUT_roughness, 0.7f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"normal", U3M_NORMAL, INPUT_normal, 0.0f, -1.0f, 1.0f, 1.0f, 0.0f},
    {"specular_value", U3M_NUMBER, INPUT_specular, 0.5f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"specular_tint", U3M_NUMBER, INPUT_specular_tint, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"sheen_value", U3M_NUMBER, INPUT_sheen, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"sheen_tint", U3M_NUMBER, INPUT_sheen_tint, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"anisotropy_value", U3M_NUMBER, INPUT_anisotropy, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"anisotropy_rotation", U3M_NUMBER, INPUT_anisotropy_direction, 0.0f, 0.0f, 1.0f, 360.0f, 0.0f},
    {"clearcoat_value", U3M_NUMBER, INPUT_clearcoat, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"clearcoat_roughness", U3M_NUMBER, INPUT_clearcoat_gloss, 0.0f, -INFINITY, INFINITY, -1.0f, 1.0f},
    {"clearcoat_roughness", U3M_NUMBER, INPUT_clearcoat_roughness, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"clearcoat_normal", U3M_NORMAL, INPUT_clearcoat_normal, 0.0f, -1.0f, 1.0f, 1.0f, 0.0f},
    {"subsurface_value", U3M_NUMBER, INPUT_subsurface, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"subsurface_color", U3M_COLOR, -1, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f},
    {"subsurface_radius", U3M_NUMBER, -1, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"transmission", U3M_NUMBER, INPUT_diffuse_transmission, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f},
    {"ior", U3M_NUMBER, -1, 1.4f, -INFINITY, INFINITY, 1.0f, 0.0f},
    {"displacement", U3M_NUMBER, -1, 0.0f, -INFINITY, INFINITY, 1.0f, 0.0f},
};

const U3mField *u3m_field(int index) {
    return index >= 0 && index < (int)(sizeof fields / sizeof *fields) ? &fields[index] : NULL;
}
