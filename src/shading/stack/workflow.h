/* workflow.h - parts of all workflows: coat, sheen and base from a surface's inputs */
#pragma once

#include "shading/stack/stack.h"
#include "shading/stack/surface.h"

/* Reflectances at normal incidence of real dielectrics, the ends of an artist's slider (the second number is
 * that of most gems): data for warnings too. */
#define DIELECTRIC_LOW  0.017f
#define DIELECTRIC_HIGH 0.067f

/* Returns F0 = ((ior - 1) / (ior + 1))^2, or F0 from the slider `reflectance` if no ior is given. */
FN float dielectric_f0(const Surface *s) {
    float r = (s->ior - 1.0f) / (s->ior + 1.0f);
    return s->ior > 0.0f ? r * r
                         : clamp(DIELECTRIC_LOW + (DIELECTRIC_HIGH - DIELECTRIC_LOW) * s->reflectance, 0.0f, 1.0f);
}

/* Sets the coat of glTF: GGX of ior 1.5 with its own normal, which dims everything below it by 1 - F(cos_o). Khronos
 * Group, KHR_materials_clearcoat, 2020. */
FN void workflow_coat(Stack *m, const Surface *s) {
    if (s->clearcoat <= 0.0f) return;
    stack_coat_frame(m, s->clearcoat_normal);
    m->coat_rule = COAT_SCHLICK;
    m->coat_weight = s->clearcoat;
    Lobe lobe = lobe_rough(LOBE_GGX, s->clearcoat_roughness);
    slot_even(&m->coat, lobe, rgb_grey(1.0f), rgb_grey(1.0f), 1.0f);
}

/* Sets the sheen: any lobe of the catalogue in a colour, under a layer rule. Its E is read from the table of that lobe,
 * by the lobe's first parameter. */
FN void workflow_sheen(Stack *m, Lobe lobe, Rgb color, Rgb second, int layer) {
    m->layer = layer;
    m->color = color;
    m->sheen_color = color;
    m->albedo_coord = lobe.params[0];
    slot_even(&m->sheen, lobe, color, second, 1.0f);
}

/* Sets what the base lets through; weight: of its diffuse light, as the diffuse lobe has it. Khronos Group,
 * KHR_materials_diffuse_transmission, 2025. */
FN void workflow_transmission(Stack *m, const Surface *s, float weight) {
    m->transmission = s->diffuse_transmission;
    m->transmitted = rgb_scale(s->diffuse_transmission_color, s->diffuse_transmission * weight);
}

/* Sets the base: a diffuse lobe of one colour under a GGX of f0 and f90. alpha = roughness^2. */
FN void workflow_base(Stack *m, const Surface *s, Rgb diffuse, Rgb f0, float f90) {
    float mean = rgb_mean(diffuse);
    Lobe lobe = lobe_rough(LOBE_GGX, s->roughness);
    lobe.params[GGX_ANISOTROPY] = s->anisotropy;
    slot_make(&m->specular, lobe, f0, rgb_grey(f90), 1.0f, rgb_mean(f0), f90);
    slot_make(&m->diffuse, lobe_default(LOBE_LAMBERT), diffuse, diffuse, 1.0f,
              mean * (1.0f - rgb_max3(m->interface_f0)), mean * (1.0f - m->interface_f90));
}
