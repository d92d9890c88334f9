/* convert.h - the inputs of one workflow as those of another, at one point
 *
 *   metallic:  d = base_color (1 - metallic)         f = mix(f_d, base_color, metallic)
 *   specular:  d = base_color (1 - max3 f)           f = specular_color specular
 *
 *   d is the colour of the diffuse lobe, f the reflectance at normal incidence, f_d that of the dielectric.
 *   To specular: f and d as they are, base_color = d / (1 - max3 f). Nothing is lost, but f90 becomes 1.
 *   To metallic: six numbers become four. With x the mean over the channels, metallic = m solves
 *   (1 - m) (f_d (1 - m) - x(f)) + m x(d) = 0, which is both lines above with base_color eliminated; then
 *   base_color = mix(d / (1 - m), (f - f_d (1 - m)) / m, m), since a dielectric shows its d and a metal its
 * f. A pair of colours loses what cannot be expressed so: a coloured f beside a d, an f below f_d.
 *
 *   The relation and the blend by m, there m^2: Khronos Group, KHR_materials_pbrSpecularGlossiness, 2017,
 *   example "convert between workflows". */
#pragma once

#include "shading/workflows/metallic.h"

/* Values of choice convert, and the numbers of the two workflows in profile.h. */
#define CONVERT_METALLIC  0
#define CONVERT_SPECULAR  1
#define WORKFLOW_METALLIC 0
#define WORKFLOW_SPECULAR 1

FN Rgb metallic_diffuse(Surface s) { return rgb_scale(s.base_color, 1.0f - s.metallic); }
FN Rgb metallic_normal_f(Surface s) { return rgb_mix(metallic_f0(&s), s.base_color, s.metallic); }

FN Rgb specular_normal_f(Surface s) { return rgb_min(rgb_scale(s.specular_color, s.specular), 1.0f); }
FN Rgb specular_diffuse(Surface s) { return rgb_scale(s.base_color, 1.0f - rgb_max3(specular_normal_f(s))); }

FN Surface convert_to_specular(Surface s) {
    Surface t = s;
    Rgb f = metallic_normal_f(s);
    t.specular_color = f;
    t.specular = 1.0f;
    t.base_color = rgb_scale(metallic_diffuse(s), 1.0f / max(1.0f - rgb_max3(f), 1e-6f));
    return t;
}

/* Returns m of the opening comment, in [0, 1], for means of d and f; 0 if f is no more than a dielectric's. */
FN float convert_metallic(float d, float f, float f_d) {
    if (f <= f_d) return 0.0f;
    /* f_d m^2 + b m + (f_d - f) = 0 with f_d - f < 0: one root above 0, in the form that does not cancel */
    float b = d + f - 2.0f * f_d, below = f - f_d;
    return min(2.0f * below / max(b + sqrt(b * b + 4.0f * f_d * below), 1e-6f), 1.0f);
}

FN Surface convert_to_metallic(Surface s) {
    Surface t = s;
    Rgb d = specular_diffuse(s), f = specular_normal_f(s);
    float f_d = dielectric_f0(&s), m = convert_metallic(rgb_mean(d), rgb_mean(f), f_d);
    Rgb as_diffuse = rgb_scale(d, 1.0f / max(1.0f - m, 1e-6f)), as_metal = d;
    if (m > 0.0f) as_metal = rgb_scale(rgb_add(f, rgb_grey(-f_d * (1.0f - m))), 1.0f / m);
    Rgb base = rgb_min(rgb_mix(as_diffuse, as_metal, m), 1.0f);
    t.base_color = rgb(max(base.r, 0.0f), max(base.g, 0.0f), max(base.b, 0.0f));
    t.metallic = m;
    t.specular = 1.0f;
    t.specular_color = rgb_grey(1.0f);
    return t;
}

/* Returns true if the surface has the other one of the two workflows. A profile has inputs of its own. */
FN bool convert_wanted(Choices c) {
    return c.profile <= 0 && ((c.convert == CONVERT_SPECULAR && c.workflow <= WORKFLOW_METALLIC) ||
                              (c.convert == CONVERT_METALLIC && c.workflow == WORKFLOW_SPECULAR));
}

FN Surface convert_surface(Surface s, Choices c) {
    if (!convert_wanted(c)) return s;
    if (c.convert == CONVERT_SPECULAR) return convert_to_specular(s);
    return convert_to_metallic(s);
}

FN Choices convert_choices(Choices c) {
    Choices d = c;
    if (convert_wanted(c)) d.workflow = c.convert == CONVERT_SPECULAR ? WORKFLOW_SPECULAR : WORKFLOW_METALLIC;
    return d;
}

/* Returns the greatest difference, over the channels, that the conversion makes to d and f. */
FN float convert_loss(Surface s, Choices c) {
    if (!convert_wanted(c)) return 0.0f;
    Surface t = convert_surface(s, c);
    Rgb d = metallic_diffuse(s), f = metallic_normal_f(s), d2 = specular_diffuse(t), f2 = specular_normal_f(t);
    if (c.convert == CONVERT_METALLIC) {
        d = specular_diffuse(s);
        f = specular_normal_f(s);
        d2 = metallic_diffuse(t);
        f2 = metallic_normal_f(t);
    }
    float loss_d = max(abs(d.r - d2.r), max(abs(d.g - d2.g), abs(d.b - d2.b)));
    float loss_f = max(abs(f.r - f2.r), max(abs(f.g - f2.g), abs(f.b - f2.b)));
    return max(loss_d, loss_f);
}
