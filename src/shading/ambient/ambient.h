/* ambient.h - image-based lighting (IBL): the light of an environment map (HDRI) that a material reflects
 *
 * Each lobe of the stack reflects light as ambient_lobe.h describes. The environment's lights that a lobe has not
 * included are then added as directional lights, evaluated with the whole stack.
 *
 * Departure: look-ups have no single wi. So a layer rule that needs E(wi) uses the cosine average of E
 * instead, and a Fresnel factor that needs wi uses its own cosine average. Directional lights are dimmed
 * exactly. */
#pragma once

#include "shading/ambient/ambient_lobe.h"
#include "shading/material/stack_value.h"

/* Returns what one channel of a slot reflects. The term f_quadratic takes the second colour's share from the
 * light of the whole lobe, not per direction. The light of a tinted lobe has its colour already. */
FN float ambient_apply_channel(SheenE e, float f0, float f90, float f_quadratic, float first, float second) {
    if (IS_TINTED(e.tint)) return first * f90;
    return f0 * first + f90 * second - f_quadratic * first * second / max(first + second, 1e-30f);
}
FN Rgb ambient_apply_colors(SlotColors s, SheenE e, LobeLight p) {
    return rgb(ambient_apply_channel(e, s.f0.r, s.f90.r, s.f_quadratic.r, p.first.r, p.second.r),
               ambient_apply_channel(e, s.f0.g, s.f90.g, s.f_quadratic.g, p.first.g, p.second.g),
               ambient_apply_channel(e, s.f0.b, s.f90.b, s.f_quadratic.b, p.first.b, p.second.b));
}

/* Returns how a sheen of these colours tints. */
FN AmbientTint ambient_tint(SheenE e, SlotColors s) {
    AmbientTint t = ambient_untinted();
    if (!IS_TINTED(e.tint)) return t;
    t.whole = e.tint;
    t.flakes = rgb(s.f0.r / max(s.f90.r, 1e-30f), s.f0.g / max(s.f90.g, 1e-30f), s.f0.b / max(s.f90.b, 1e-30f));
    return t;
}

/* Returns the cosine average over wi of schlick_s(min(cos_o, cos_i)); wi . h is never less than this minimum.
 * So the integrand is (1 - cos_i)^5 for cos_i < cos_o, otherwise (1 - cos_o)^5. */
FN float ambient_schlick_least(float cos_o) {
    float q = 1.0f - cos_o, q2 = q * q, q5 = q2 * q2 * q;
    return q5 * (1.0f - cos_o * cos_o) + 2.0f * ((1.0f - q5 * q) / 6.0f - (1.0f - q5 * q2) / 7.0f);
}

/* Returns the cosine average over wi of schlick_s at wi . h: own fit, within 0.001. */
FN float ambient_schlick_half(float cos_o) {
    float q2 = (1.0f - cos_o) * (1.0f - cos_o);
    return q2 * (0.02f + 0.008f * q2);
}

/* Returns the transmittance of the specular interface for the diffuse lobe, averaged over wi with the cosine. */
FN Rgb ambient_base_transmittance(const Stack *m, const StackView *w) {
    float cos_o = w->o.z;
    Rgb f = rgb_grey(0.0f);
    if (m->base_fresnel == BASE_FRESNEL_HALF || m->base_fresnel == BASE_FRESNEL_GAUSSIAN)
        f = rgb_mix(w->interface_f0, rgb_grey(w->interface_f90), ambient_schlick_half(cos_o));
    if (m->base_fresnel == BASE_FRESNEL_LEAST)
        f = rgb_grey(rgb_max3(rgb_mix(w->interface_f0, rgb_grey(w->interface_f90), ambient_schlick_least(cos_o))));
    return stack_one_minus(f);
}
FN Rgb ambient_interface_transmittance(const Stack *m, const StackView *w) {
    float s = ambient_schlick_least(w->o.z);
    if (m->layer == LAYER_SEED) s = ambient_schlick_half(w->o.z);
    return stack_interface_at(m, w, s);
}

/* The transmittance of the layers above three slots, averaged over wi with the cosine. */
STRUCT(AmbientTransmittance) { Rgb diffuse, specular, sheen; };

FN AmbientTransmittance ambient_transmittance(const Stack *m, const StackView *w) {
    AmbientTransmittance t;
    bool layered = HAS_LAYERED_SHEEN(m);
    t.sheen = rgb_grey(1.0f);
    t.specular = t.sheen;
    if (layered) t.specular = stack_base_scale(m, w, m->e_avg);
    if (IS_BELOW_F(m) && layered) {
        t.sheen = ambient_interface_transmittance(m, w);
        t.diffuse = rgb_mul(t.specular, t.sheen);
        t.specular = rgb_grey(1.0f);
    } else {
        t.diffuse = rgb_mul(t.specular, ambient_base_transmittance(m, w));
    }
    return t;
}

/* One slot of a stack under an environment. */
STRUCT(AmbientSlot) {
    Rgb reflected;      /* the light towards wo, before the slots above dim it */
    float lights_scale; /* factor on the lights still to be added, 0 for none */
};

/* Applies the colours of a slot to its light. scale: view.scale of the slot. factor: ambient_diffuse or
 * ambient_reflection of the source. */
FN AmbientSlot ambient_slot(SlotColors colors, SheenE e, float scale, SlotLight light, float factor) {
    AmbientSlot a;
    a.reflected = rgb_scale(rgb_scale(ambient_apply_colors(colors, e, light.reflected), scale), factor);
    a.lights_scale = scale * light.light_fraction * factor;
    return a;
}

/* Returns the environment's directional lights as the slots in `only` reflect them. view: the stack's view,
 * with each slot's scale replaced by its lights_scale. */
FN Rgb ambient_reflect_lights(const Stack *m, const StackView *view, Slots only, AmbientSource s, float occlusion) {
    Rgb sum = rgb_grey(0.0f);
    int count = ambient_light_count(s);
    for (int k = 0; k < count; k++) {
        AmbientLight l = ambient_light(s, k);
        float visibility = l.w.z > 0.0f ? ambient_light_visibility(s, k, occlusion) : 0.0f;
        if (visibility > 0.0f) {
            Angles a = angles_between(view->o, l.w), coat = a;
            if (only.coat) coat = angles_between(view->coat_o, stack_to_coat(m, l.w));
            StackValue value = stack_value_of(m, view, only, &a, &coat);
            sum = rgb_add(sum, rgb_scale(rgb_mul(l.color, value.f_cos), visibility));
        }
    }
    return sum;
}

/* Returns the light of an environment that comes through glass, all of it straight ahead: its radiance about -wo, as
 * concentrated as the specular lobe (half of a lobe of alpha lies within the 2 alpha^2 of 1 - cosine that half of
 * exp(kappa (cosine - 1)) has), times what F at cos_o lets through. What is behind the glass does not occlude it, nor does
 * a solid bend it. over: what the layers above leave. */
FN Rgb ambient_glass(const Stack *m, const StackView *w, AmbientSource s, Rgb over) {
    Proxy p = lobe_proxy(&m->specular.lobe);
    float kappa = 0.35f / max(p.ax * p.ay, 1e-4f);
    SlotColors c = stack_glass_colors(m, w);
    Rgb passed = rgb_scale(rgb_mix(c.f0, c.f90, schlick_s(w->o.z)), w->scale.diffuse * ambient_reflection(s));
    return rgb_mul(rgb_mul(over, passed), ambient_radiance(s, dir(-w->o.x, -w->o.y, -w->o.z), kappa));
}

/* Returns the mean radiance of an environment behind the surface, weighted by the cosine. Each light has its own
 * visibility: what hides a window hides more than its part of the sky. open: the visible part of the sky there. */
FN Rgb ambient_behind(AmbientSource s, float open) {
    Rgb sum = rgb_scale(ambient_residual(s, dir(0.0f, 0.0f, -1.0f), 0.0f), open);
    int count = ambient_light_count(s);
    for (int k = 0; k < count; k++) {
        AmbientLight l = ambient_light(s, k);
        float seen = l.w.z < 0.0f ? ambient_light_behind(s, k, open) : 0.0f;
        sum = rgb_add(sum, rgb_scale(l.color, seen * max(-l.w.z, 0.0f) * (1.0f / PI)));
    }
    return sum;
}

/* Returns what a stack reflects towards wo of an environment without its lights, and what comes through. t: the tables
 * of its lobes. occlusion, occlusion_behind: the visible part of the cosine-weighted sky on either side, 0 to 1. lights:
 * gets the view with scales for the lights still to be added, by the slots in only. It is linear in the diffuse lobe's
 * colours. */
FN Rgb ambient_smooth(const Stack *m, const StackView *w, AmbientTables t, AmbientSource s, float occlusion,
                      float occlusion_behind, StackView *lights, Slots *only) {
    Rgb sum = rgb_grey(0.0f);
    *lights = *w;
    *only = slots_of(false, false, false, false, false);
    AmbientView v = ambient_view(w->o, dir(1.0f, 0.0f, 0.0f), dir(0.0f, 1.0f, 0.0f), dir(0.0f, 0.0f, 1.0f),
                                 clamp(occlusion, 0.0f, 1.0f));
    AmbientLookups residual = ambient_residual_lookups(s, v);
    AmbientTransmittance through = ambient_transmittance(m, w);
    SheenE untinted = sheen_e_of(0.0f);
    float diffuse_factor = ambient_diffuse(s), reflection_factor = ambient_reflection(s);
    if (HAS_DIFFUSE(m)) {
        SlotLight light = LIGHT_OF_SLOT(diffuse)(t.diffuse, s, v, residual, m->diffuse.lobe, ambient_untinted(), -1.0f);
        AmbientSlot a = ambient_slot(slot_colors(&m->diffuse), untinted, w->scale.diffuse, light, diffuse_factor);
        if (SHOWS_DIFFUSE) sum = rgb_mul(through.diffuse, a.reflected);
        lights->scale.diffuse = a.lights_scale;
        only->diffuse = SHOWS_DIFFUSE && a.lights_scale > 0.0f;
    }
    if (HAS_TRANSMITTED(m) && SHOWS_DIFFUSE) {
        Rgb light =
            rgb_scale(ambient_behind(s, clamp(occlusion_behind, 0.0f, 1.0f)), w->scale.diffuse * diffuse_factor);
        sum = rgb_add(sum, rgb_mul(through.diffuse, rgb_mul(m->transmitted, light)));
    }
    if (HAS_GLASS(m) && SHOWS_DIFFUSE) sum = rgb_add(sum, ambient_glass(m, w, s, through.specular));
    if (HAS_SPECULAR(m)) {
        SlotLight light =
            LIGHT_OF_SLOT(specular)(t.specular, s, v, residual, m->specular.lobe, ambient_untinted(), -1.0f);
        if (HAS_RETRO(m)) {
            AmbientView b = ambient_view(dir_opposite(w->o), dir(1.0f, 0.0f, 0.0f), dir(0.0f, 1.0f, 0.0f),
                                         dir(0.0f, 0.0f, 1.0f), v.occlusion);
            SlotLight back = LIGHT_OF_SLOT(specular)(t.specular, s, b, ambient_residual_lookups(s, b), m->specular.lobe,
                                                     ambient_untinted(), -1.0f);
            light.reflected = lobe_light_mix(light.reflected, back.reflected, m->retro);
            light.light_fraction = mix(light.light_fraction, back.light_fraction, m->retro);
        }
        AmbientSlot a =
            ambient_slot(stack_specular_colors(m, w), untinted, w->scale.specular, light, reflection_factor);
        if (SHOWS_SPECULAR) sum = rgb_add(sum, rgb_mul(through.specular, a.reflected));
        lights->scale.specular = a.lights_scale;
        only->specular = SHOWS_SPECULAR && a.lights_scale > 0.0f;
    }
    if (HAS_SHEEN(m)) {
        AmbientView along = v;
        if (m->nap.tilt > 0.0f) along.heading = v.tx * m->nap.x + v.ty * m->nap.y;
        /* The sheen's own albedo table interpolates E better than the table of the fit, unless E depends on the heading
         * and it does not. */
        bool better = m->albedo == ALBEDO_TABLE && m->table.kind != TABLE_NONE &&
                      (!t.sheen.by_azimuth || SHEEN_TILTS(m->table) > 0);
        float albedo = better ? w->e_o.e : -1.0f;
        SlotColors colors = slot_colors(&m->sheen);
        AmbientTint tint = ambient_tint(w->e_o, colors);
        SlotLight light = LIGHT_OF_SLOT(sheen)(t.sheen, s, along, residual, m->sheen.lobe, tint, albedo);
        AmbientSlot a = ambient_slot(colors, w->e_o, w->scale.sheen, light, reflection_factor);
        if (SHOWS_SHEEN) sum = rgb_add(sum, rgb_mul(through.sheen, a.reflected));
        lights->scale.sheen = a.lights_scale;
        only->sheen = SHOWS_SHEEN && a.lights_scale > 0.0f;
    }
    if (HAS_COAT(m)) {
        if (w->coat_o.z > 0.0f) {
            AmbientView c = ambient_view(w->coat_o, m->coat_x, m->coat_y, m->coat_z, v.occlusion);
            SlotLight light = LIGHT_OF_SLOT(coat)(t.coat, s, c, ambient_residual_lookups(s, c), m->coat.lobe,
                                                  ambient_untinted(), -1.0f);
            AmbientSlot a = ambient_slot(slot_colors(&m->coat), untinted, w->scale.coat, light, reflection_factor);
            if (m->sheen_over_coat) a.reflected = rgb_mul(a.reflected, through.specular);
            if (SHOWS_COAT) sum = rgb_add(sum, a.reflected);
            lights->scale.coat = a.lights_scale;
            only->coat = SHOWS_COAT && a.lights_scale > 0.0f;
        }
    }
    if (HAS_DUST(m)) {
        SlotLight light = LIGHT_OF_SLOT(dust)(t.dust, s, v, residual, m->dust.lobe, ambient_untinted(), -1.0f);
        AmbientSlot a = ambient_slot(slot_colors(&m->dust), untinted, w->scale.dust, light, diffuse_factor);
        if (SHOWS_DUST) sum = rgb_add(sum, a.reflected);
        lights->scale.dust = a.lights_scale;
        only->dust = SHOWS_DUST && a.lights_scale > 0.0f;
    }
    return sum;
}

/* Returns the light that a stack reflects towards wo, and what comes through: of ambient_smooth and of lights. */
FN Rgb stack_ambient(const Stack *m, const StackView *w, AmbientTables t, AmbientSource s, float occlusion,
                     float occlusion_behind) {
    StackView lights;
    Slots only;
    Rgb sum = ambient_smooth(m, w, t, s, occlusion, occlusion_behind, &lights, &only);
    if (only.diffuse || only.specular || only.sheen || only.coat || only.dust)
        sum = rgb_add(sum, ambient_reflect_lights(m, &lights, only, s, clamp(occlusion, 0.0f, 1.0f)));
    return sum;
}
