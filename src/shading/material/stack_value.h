/* stack_value.h - f cos_i and the pdf of a stack in a view of it */
#pragma once

#include "shading/material/stack_view.h"
#include "shading/terms/ggx_lost.h"

/* Sets v to f and the pdf of a slot's lobe. pair: wo and wi in the slot's frame. */
#define SLOT_VALUE(slot, pair)                                                                                         \
    IN_SLOT(slot, reflect)                                                                                             \
    (m->slot.lobe.id, &m->slot##_prepared, &w->slot##_view, pair, &m->slot.f0, &m->slot.f90, &v);

/* Returns f of the diffuse lobe under the interface. through: the transmittance of the interface by a rule that puts it
 * over the sheen too, which applies if below_f. */
FN Rgb stack_under_interface(const Stack *m, const StackView *w, const Angles *a, bool below_f, Rgb through, Rgb f) {
    if (below_f) return rgb_mul(rgb_mul(f, through), w->base_scale);
    if (m->base_fresnel != BASE_FRESNEL_NONE) return rgb_mul(f, stack_base_transmittance(m, w, a));
    return f;
}

/* Returns f of the base under the sheen, for the other rules. */
FN Rgb stack_under_sheen(const Stack *m, const StackView *w, const Angles *a, Rgb f) {
    Rgb base_scale = w->base_scale;
    if (layer_needs_wi(m->layer)) {
        SheenE e_i = sheen_e_of(0.0f);
        Dir at = a->i;
        if (m->layer == LAYER_ALBEDO_HALF) at = a->h;
        if (HAS_SHEEN(m)) e_i = stack_albedo(m, at);
        base_scale = stack_base_scale(m, w, e_i);
    }
    return rgb_mul(f, base_scale);
}

/* Returns f and the pdf of the base, the diffuse and the specular slot, before the layer rule and without retroreflection.
 * below_f: the interface is that of a rule that puts it over the sheen too. */
FN StackValue stack_base_value(const Stack *m, const StackView *w, Slots only, const Angles *a, bool below_f) {
    StackValue base;
    Rgb f = rgb_grey(0.0f), through = f;
    float pdf = 0.0f;
    LobeReflected v;
    if (below_f) through = stack_interface_transmittance(m, w, a);
    if (only.diffuse && HAS_DIFFUSE(m)) {
        SLOT_VALUE(diffuse, a)
        f = rgb_scale(v.f, w->scale.diffuse);
        pdf = w->select_p.diffuse * v.pdf;
        if (HAS_TRANSMITTED(m)) pdf = pdf * (1.0f - m->transmitted_p - m->glass_p);
        f = stack_under_interface(m, w, a, below_f, through, f);
    }
    if (only.specular && HAS_SPECULAR(m)) {
        if (HAS_EXTRA_F(m)) {
            SlotColors c = stack_specular_colors(m, w);
            IN_SLOT(specular, reflect)
            (m->specular.lobe.id, &m->specular_prepared, &w->specular_view, a, &c.f0, &c.f90, &v);
            v.f = rgb_add(v.f, rgb_scale(c.f_quadratic, -v.f_s2));
        } else {
            SLOT_VALUE(specular, a)
        }
        f = rgb_add(f, rgb_scale(v.f, w->scale.specular));
        pdf = pdf + w->select_p.specular * v.pdf;
    }
    base.f_cos = f;
    base.pdf = pdf;
    return base;
}

/* Works as stack_value, for the slots `only`. The other slots still dim them. */
FN StackValue stack_value_of(const Stack *m, const StackView *w, Slots only, const Angles *a, const Angles *coat) {
    bool layered = HAS_LAYERED_SHEEN(m), below_f = IS_BELOW_F(m) && layered;
    StackValue base = stack_base_value(m, w, only, a, below_f);
    if (HAS_RETRO(m)) {
        Angles opposite = angles_between(w->o, dir_opposite(a->i));
        StackValue back = stack_base_value(m, w, only, &opposite, below_f);
        base.f_cos = rgb_add(rgb_scale(base.f_cos, 1.0f - m->retro), rgb_scale(back.f_cos, m->retro));
        base.pdf = base.pdf * (1.0f - m->retro) + back.pdf * m->retro;
    }
    Rgb f = base.f_cos;
    float pdf = base.pdf;
    LobeReflected v;
    if (layered && !below_f) f = stack_under_sheen(m, w, a, f);
    if (only.sheen && HAS_SHEEN(m)) {
        SLOT_VALUE(sheen, a)
        v.f = rgb_scale(v.f, w->scale.sheen);
        if (below_f) v.f = rgb_mul(v.f, stack_interface_transmittance(m, w, a));
        f = rgb_add(f, v.f);
        pdf = pdf + w->select_p.sheen * v.pdf;
    }
    if (only.dust && HAS_DUST(m)) {
        SLOT_VALUE(dust, a)
        f = rgb_add(f, rgb_scale(v.f, w->scale.dust));
        pdf = pdf + w->select_p.dust * v.pdf;
    }
    f = rgb_scale(f, a->i.z);
    if (only.coat && HAS_COAT(m) && coat->o.z > 0.0f && coat->i.z > 0.0f) {
        SLOT_VALUE(coat, coat)
        v.f = rgb_scale(v.f, w->scale.coat * coat->i.z);
        if (m->sheen_over_coat && layered) v.f = stack_under_sheen(m, w, a, v.f);
        f = rgb_add(f, v.f);
        pdf = pdf + w->select_p.coat * v.pdf;
    }
    StackValue sum;
    sum.f_cos = f;
    sum.pdf = pdf;
    return sum;
}

/* Returns f cos_i and the pdf of light from below the surface that cloth lets through. a: of its mirror image above. Of
 * layer rule stochastic it is the first pass. */
FN StackValue stack_transmitted_evenly(const Stack *m, const StackView *w, const Angles *a) {
    bool layered = HAS_LAYERED_SHEEN(m), below_f = IS_BELOW_F(m) && layered;
    float lambert = a->i.z / PI;
    Rgb f = rgb_scale(m->transmitted, w->scale.diffuse), through = f;
    if (below_f) through = stack_interface_transmittance(m, w, a);
    f = stack_under_interface(m, w, a, below_f, through, f);
    if (layered && !below_f) f = stack_under_sheen(m, w, a, f);
    StackValue v;
    v.f_cos = rgb_scale(f, lambert);
    v.pdf = w->select_p.diffuse * m->transmitted_p * lambert;
    return v;
}

/* Returns the colours of the specular lobe that make what its interface lets through of it: tint (1 - F). */
FN SlotColors stack_glass_colors(const Stack *m, const StackView *w) {
    SlotColors c;
    c.f0 = rgb_mul(m->glass_tint, stack_one_minus(w->interface_f0));
    c.f90 = rgb_scale(m->glass_tint, max(1.0f - w->interface_f90, 0.0f));
    c.f_quadratic = rgb_grey(0.0f);
    return c;
}

/* Returns the layer rule's factor on light through glass, with that of dust and coat. */
FN Rgb stack_over_glass(const Stack *m, const StackView *w, const Angles *a) {
    bool layered = HAS_LAYERED_SHEEN(m), below_f = IS_BELOW_F(m) && layered;
    Rgb f = rgb_grey(w->scale.diffuse);
    if (below_f) f = rgb_mul(f, w->base_scale);
    if (layered && !below_f) f = stack_under_sheen(m, w, a, f);
    return f;
}

/* Returns what facets lose of light from wo, 0 where it stays lost. */
FN float stack_glass_lost(const Stack *m, float cosine) {
    float lost = 0.0f;
    if (m->glass_lost > 0.0f) lost = ggx_lost(m->glass_lost, cosine);
    return lost;
}

/* Returns f cos_i and the pdf of light from below the surface that thin glass lets through. a: of its mirror image above;
 * pdf: of stack_draw_glass alone. */
FN StackValue stack_through_glass(const Stack *m, const StackView *w, const Angles *a) {
    SlotColors c = stack_glass_colors(m, w);
    LobeReflected v;
    IN_SLOT(specular, reflect)(m->specular.lobe.id, &m->specular_prepared, &w->specular_view, a, &c.f0, &c.f90, &v);
    float lost_o = stack_glass_lost(m, a->o.z), lost_i = stack_glass_lost(m, a->i.z), lambert = a->i.z / PI;
    Rgb f = v.f;
    if (m->glass_lost > 0.0f)
        f = rgb_add(f, rgb_scale(m->glass_tint, lost_o * lost_i / (PI * ggx_lost_average(m->glass_lost))));
    StackValue g;
    g.f_cos = rgb_scale(rgb_mul(f, stack_over_glass(m, w, a)), a->i.z);
    g.pdf = mix(v.pdf, lambert, lost_o);
    return g;
}

/* Returns what smooth glass lets through of light that goes straight on towards wo: the integral over wi of f cos_i of
 * stack_through_glass as alpha tends to 0,
 *
 *   T(wo) = tint (1 - F(cos_o)), times the factors of the layers. */
FN Rgb stack_glass_straight(const Stack *m, const StackView *w) {
    SlotColors c = stack_glass_colors(m, w);
    Angles a = angles_between(w->o, dir(-w->o.x, -w->o.y, w->o.z));
    return rgb_mul(rgb_mix(c.f0, c.f90, schlick_s(w->o.z)), stack_over_glass(m, w, &a));
}

/* Returns f cos_i and the pdf of light from below the surface that comes through. a: of its mirror image above. */
FN StackValue stack_transmitted(const Stack *m, const StackView *w, const Angles *a) {
    StackValue v = stack_transmitted_evenly(m, w, a);
    if (HAS_GLASS(m)) {
        StackValue g = stack_through_glass(m, w, a);
        v.f_cos = rgb_add(v.f_cos, g.f_cos);
        v.pdf = v.pdf + w->select_p.diffuse * m->glass_p * g.pdf;
    }
    return v;
}

/* Returns f cos_i and the pdf of wi. Both directions are above the horizon. coat: the pair in the coat's frame. */
FN StackValue stack_value(const Stack *m, const StackView *w, const Angles *a, const Angles *coat) {
    Slots only = slots_of(SHOWS_DIFFUSE, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);
    return stack_value_of(m, w, only, a, coat);
}
