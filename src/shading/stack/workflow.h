/* workflow.h - parts of all workflows: coat, sheen, fuzz and base from a surface's inputs */
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

/* Values of choice rim. */
#define RIM_SHEEN 0
#define RIM_FUZZ  1

/* Clears a stack for a surface of these choices. */
FN void workflow_begin(Stack *m, Choices c) {
    stack_clear(m);
    m->has_fuzz = c.rim == RIM_FUZZ;
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

/* Returns what solid glass leaves of light after `path` metres inside: T = c^(path / d), Beer's law. Khronos Group,
 * KHR_materials_volume, 2021. Johann Heinrich Lambert, "Photometria", 1760; August Beer, 1852. */
FN Rgb glass_left(const Surface *s, float path) {
    Rgb c = s->attenuation_color, left = rgb_grey(1.0f);
    float x = path / max(s->attenuation_distance, 1e-6f);
    bool absorbs = s->attenuation_distance > 0.0f && path > 0.0f;
    if (absorbs) left = rgb(pow(max(c.r, 1e-6f), x), pow(max(c.g, 1e-6f), x), pow(max(c.b, 1e-6f), x));
    return left;
}

/* Lets light through as glass does, in the base colour; weight: of what is below the interface, as the diffuse lobe has it
 * already. Called once the highlight is set. Thick glass is here a thin sheet that absorbs as much as its thickness
 * does. Khronos Group, KHR_materials_transmission, 2021. */
FN void workflow_glass(Stack *m, const Surface *s, float weight) {
    if (s->transmission <= 0.0f) return;
    float share = s->transmission * weight;
    m->glass = share;
    m->glass_taken = s->transmission;
    m->glass_tint = rgb_scale(rgb_mul(s->base_color, glass_left(s, s->thickness)), share);
    m->glass_lost = m->specular.lobe.params[0]; /* alpha of ggx, or of cook-torrance */
    m->transmitted = rgb_scale(m->transmitted, 1.0f - s->transmission);
    m->specular.normal = max(m->specular.normal, 1e-30f); /* glass takes its lobe even where it is black */
}

/* Sets the matt roughness of the diffuse lobe: EON of Jamie Portsmouth, Peter Kutz, Stephen Hill, JCGT 14(1), 2025, as
 * KHR_materials_diffuse_roughness has it (glTF pull request 2481); its alpha is the roughness itself. */
FN void workflow_matt(Stack *m, const Surface *s) {
    if (s->diffuse_roughness <= 0.0f) return;
    Rgb color = m->diffuse.f0;
    Lobe lobe = lobe_default(LOBE_EON);
    lobe.params[0] = s->diffuse_roughness;
    slot_make(&m->diffuse, lobe, color, color, 1.0f, m->diffuse.normal, m->diffuse.grazing);
}

/* Scales what is below the coat by a colour. */
FN void workflow_tint_below(Stack *m, Rgb t) {
    m->diffuse.f0 = rgb_mul(m->diffuse.f0, t);
    m->diffuse.f90 = rgb_mul(m->diffuse.f90, t);
    m->specular.f0 = rgb_mul(m->specular.f0, t);
    m->specular.f90 = rgb_mul(m->specular.f90, t);
    m->extra_f0 = rgb_mul(m->extra_f0, t);
    m->extra_f90 = rgb_mul(m->extra_f90, t);
    m->extra_f_quadratic = rgb_mul(m->extra_f_quadratic, t);
    m->transmitted = rgb_mul(m->transmitted, t);
    m->glass_tint = rgb_mul(m->glass_tint, t);
    if (m->sheen_over_coat) return;
    m->sheen.f0 = rgb_mul(m->sheen.f0, t);
    m->sheen.f90 = rgb_mul(m->sheen.f90, t);
}

/* Returns 1 - a (1 - kept / (1 - e (1 - kept))): what a base of albedo e keeps, by the amount a, under a coat that lets
 * the share `kept` of its light out and throws the rest back to it. */
FN float workflow_darkened(float a, float kept, float e) {
    float albedo = min(e, 1.0f);
    return 1.0f - a * (1.0f - kept / ((1.0f - albedo) + albedo * kept));
}

/* Gives the coat that workflow_coat set its index of refraction, stretch, colour and darkening, which is done last.
 * KHR_materials_coat (glTF pull request 2534), with the numbers of AcademySoftwareFoundation/OpenPBR,
 * reference/open_pbr_surface.mtlx: kept is (1 - F0) / ior^2. Colour and darkening act by the amount of the coat. */
FN void workflow_coat_whole(Stack *m, const Surface *s) {
    if (s->clearcoat <= 0.0f) return;
    float ior = max(s->coat_ior, 1.0f), root = (ior - 1.0f) / (ior + 1.0f);
    m->coat_f0 = root * root;
    if (s->coat_anisotropy > 0.0f) {
        Dir x = m->coat_x, y = m->coat_y, d = s->coat_anisotropy_direction;
        m->coat.lobe.params[GGX_ANISOTROPY] = s->coat_anisotropy;
        m->coat_x = dir(x.x * d.x + y.x * d.y, x.y * d.x + y.y * d.y, x.z * d.x + y.z * d.y);
        m->coat_y = dir(y.x * d.x - x.x * d.y, y.y * d.x - x.y * d.y, y.z * d.x - x.z * d.y);
    }
    float kept = (1.0f - m->coat_f0) / (ior * ior), a = s->clearcoat * s->coat_darkening;
    Rgb e = s->base_color;
    /* a sum, since a mix of 1 and a dark colour keeps few digits of the colour */
    Rgb tint = rgb_add(rgb_grey(1.0f - s->clearcoat), rgb_scale(s->coat_color, s->clearcoat));
    workflow_tint_below(m, rgb_mul(tint, rgb(workflow_darkened(a, kept, e.r), workflow_darkened(a, kept, e.g),
                                             workflow_darkened(a, kept, e.b))));
}

/* Puts fuzz in the place of the sheen, on the coat: E tints nothing and takes from what is below even where the fuzz is
 * black. lobe: one whose first parameter is alpha. A material without fuzz has that of its sheen's numbers.
 * KHR_materials_fuzz (glTF pull request 2538); AcademySoftwareFoundation/OpenPBR, reference/open_pbr_surface.mtlx. */
FN void workflow_fuzz(Stack *m, const Surface *s, Lobe lobe) {
    float weight = min(s->sheen, 1.0f), roughness = s->sheen_roughness;
    Rgb color = s->sheen_color;
    Lobe fibres = lobe;
    if (m->has_fuzz) {
        weight = s->fuzz;
        roughness = s->fuzz_roughness;
        color = s->fuzz_color;
        m->sheen_over_coat = true;
    }
    weight = max(weight, 0.0f);
    fibres.params[0] = clamp(roughness, 0.05f, 1.0f);
    workflow_sheen(m, fibres, rgb_scale(color, weight), s->sheen_second, LAYER_ALBEDO_VIEW);
    m->color = rgb_grey(weight);
    m->albedo = ALBEDO_TABLE;
    if (weight > 0.0f) m->sheen.normal = max(m->sheen.normal, 1e-30f); /* black fuzz takes from the base too */
}

/* Turns a share of the base's light back. KHR_materials_retroreflection (glTF pull request 2610); Portsmouth, Raab,
 * Belcour, Liu, JCGT 15(1), 2026. */
FN void workflow_retro(Stack *m, const Surface *s) { m->retro = clamp(s->retroreflection, 0.0f, 1.0f); }

/* Adds what glTF's coming extensions say of the base and its coat, after everything else is set. */
FN void workflow_coming(Stack *m, const Surface *s) {
    workflow_matt(m, s);
    workflow_retro(m, s);
    workflow_coat_whole(m, s);
}
