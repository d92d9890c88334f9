#include "scene/light/pane.h"

#include "scene/light/polygons.h"
#include "scene/record/material_at.h"
#include "shading/material/dust.h"
#include "shading/stack/frame.h"

/* The roughness of the least alpha of lobe ggx, .001. Profiles with a greater least one shade smoother glass by that, and
 * rays go straight through it all the same. */
static const float PANE_ROUGHNESS = 0.0317f;

/* Returns true if a material may be a pane by its inputs alone. */
static bool is_thin(const Material *material, const Surface *s) {
    const bool other = material->measured || material->unlit || material_emits(material) || dust_settles(*s);
    const bool uneven = material->inputs[INPUT_normal].texture || !(s->roughness <= PANE_ROUGHNESS) ||
                        s->anisotropy < 0.0f || s->anisotropy > 0.0f;
    return s->transmission > 0.0f && !(s->thickness > 0.0f) && !other && !uneven;
}

bool scene_is_pane(const WeftScene *scene, int k) {
    if (k >= scene_own_materials(scene) || scene_back(scene, k) >= 0) return false; /* nor is hair one */
    const Material *material = &scene->materials[k];
    if (!(material->inputs[INPUT_transmission].value[0] > 0.0f)) return false;
    const Choices choices = material_choices(material);
    Surface s = material_plain(material);
    Stack stack;
    if (!is_thin(material, &s)) return false;
    if (material->inputs[INPUT_metallic].texture) s.metallic = 0.0f;
    stack_make(&stack, &s, &choices, (TableRef){.kind = TABLE_NONE});
    const bool bare = !HAS_SHEEN(&stack) && !HAS_LAYERED_SHEEN(&stack);
    return stack.glass > 0.0f && stack.glass_lost > 0.0f && bare; /* another lobe has no glass_lost */
}

Rgb pane_transmittance(const WeftScene *scene, int k, float uv[2][2], const float color[4], float cosine) {
    const Material *material = &scene->materials[k];
    const Choices choices = material_choices(material);
    const float c = clamp(cosine, 1e-4f, 1.0f);
    const Dir o = dir(sqrt(1.0f - c * c), 0.0f, c);
    Surface s = material_plain(material);
    Stack stack;
    StackView view;
    if (uv) material_textures(scene, material, uv, color, &s);
    s = frame_surface(s);
    stack_make(&stack, &s, &choices, (TableRef){.kind = TABLE_NONE});
    if (!HAS_GLASS(&stack)) return rgb_grey(0.0f);
    stack_see(&stack, &o, &view);
    return stack_straight(&stack, &view);
}
