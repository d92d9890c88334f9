/* compose.h - the stack of a surface and its choices
 *
 * A profile, or else a workflow, makes the stack. The choices of a material then replace the parts of it that
 * they name. */
#pragma once

#include "shading/dialect/azimuth.h"
#include "shading/lobes/cook_torrance.h"
#include "shading/material/convert.h"
#include "shading/material/dust.h"
#include "shading/material/dust_lobe.h"
#include "shading/material/profile.h"

/* Returns true if the source of E, `albedo`, reads the table of the sheen's own lobe. */
#define ALBEDO_OWN_TABLE(name, index, own_table, formula) || (albedo == index && own_table)
FN bool albedo_is_own(int albedo) { return albedo == ALBEDO_TABLE WEFT_ALBEDO_FORMULAS(ALBEDO_OWN_TABLE); }

/* Returns the index of refraction. If none is given, it follows from the reflectance at normal incidence. */
FN float compose_ior(const Surface *s) {
    float root = sqrt(dielectric_f0(s));
    return s->ior > 0.0f ? max(s->ior, 1.0f) : (1.0f + root) / max(1.0f - root, 0.1f);
}

/* Returns a microfacet lobe as a cook-torrance lobe of the same alphas, whose terms can then be replaced. Other
 * lobes stay as they are. */
FN Lobe compose_facets(Lobe lobe) {
    Proxy p = lobe_proxy(&lobe);
    if (lobe_is_composed(lobe.id) || p.fit != PROXY_FACETS) return lobe;
    Lobe m = lobe_rough(LOBE_COOK_TORRANCE, sqrt(p.ay));
    if (p.ax < p.ay || p.ax > p.ay) {
        m.params[COOK_TORRANCE_D] = to_float(D_GGX_ANISO);
        m.params[COOK_TORRANCE_V] = to_float(V_SMITH_GGX_ANISO);
    }
    m.params[COOK_TORRANCE_STRETCH] = clamp(p.ax / p.ay, 0.01f, 100.0f); /* alpha has a floor, above that of ggx */
    return m;
}

/* Replaces the terms of a cook-torrance lobe; a negative number leaves a term as it is. */
FN Lobe compose_terms(Lobe lobe, int d, int v, int f, const Surface *s) {
    Lobe m = lobe;
    if (d >= 0) m.params[COOK_TORRANCE_D] = to_float(d);
    if (v >= 0) m.params[COOK_TORRANCE_V] = to_float(v);
    if (f >= 0) m.params[COOK_TORRANCE_F] = to_float(f);
    m.params[COOK_TORRANCE_IOR] = compose_ior(s);
    m.params[COOK_TORRANCE_K] = s->extinction;
    return m;
}

/* Returns true if an isotropic D is chosen for the highlight. compose_surface then sets anisotropy to 0, so that
 * roughness alone sets alpha. In workflow disney, that alpha is sqrt(alpha_x alpha_y). */
FN bool compose_evens(Choices c) { return c.d >= 0 && c.d != D_GGX_ANISO; }
FN void compose_surface(Surface *s, Choices c) {
    if (compose_evens(c)) s->anisotropy = 0.0f;
}

/* Returns true if the choices name a D, V or F for the sheen, or cook-torrance (a lobe made of such terms) as
 * its lobe. */
FN bool compose_sheen_is_free(Choices c) {
    return lobe_is_composed(c.sheen_lobe) || c.sheen_d >= 0 || c.sheen_v >= 0 || c.sheen_f >= 0;
}

/* Returns a sheen of chosen terms. Terms that are not chosen stay as in `lobe` if this is a cook-torrance and
 * the choices name no lobe; otherwise they are those of charlie-neubelt. */
FN Lobe compose_sheen(Lobe lobe, const Surface *s, Choices c) {
    Lobe m = lobe;
    if (c.sheen_lobe >= 0 || !lobe_is_composed(lobe.id)) {
        m = lobe_rough(LOBE_COOK_TORRANCE, s->sheen_roughness);
        m.params[COOK_TORRANCE_D] = to_float(D_CHARLIE);
        m.params[COOK_TORRANCE_V] = to_float(V_NEUBELT);
        m.params[COOK_TORRANCE_F] = to_float(F_NONE);
    }
    return compose_terms(m, c.sheen_d, c.sheen_v, c.sheen_f, s);
}

/* Returns the inputs that set parameters of a chosen sheen by their names; compose_diffuse_named does so for a chosen
 * diffuse lobe. */
FN LobeNamed compose_sheen_named(const Surface *s) {
    LobeNamed n = lobe_unnamed();
    n.density = s->sheen_density;
    n.tilt = s->nap;
    n.azimuth = azimuth_of(s->nap_direction);
    n.tail = s->sheen_tail;
    n.rise = s->sheen_rise;
    if (s->sheen_beta > 0.0f) n.beta = s->sheen_beta;
    return n;
}
FN LobeNamed compose_diffuse_named(const Surface *s) {
    LobeNamed n = lobe_unnamed();
    n.retro = s->diffuse_retro;
    n.lift = s->diffuse_lift;
    n.wrap = s->subsurface;
    return n;
}

/* Replaces the lobes, terms, layer rule and source of E that the choices name, and sets the amount of the sheen. */
FN void compose_choices(Stack *m, const Surface *s, Choices c) {
    bool free = compose_sheen_is_free(c);
    if (c.sheen_lobe >= 0 || free) {
        Lobe lobe = m->sheen.lobe;
        if (c.sheen_lobe >= 0) {
            lobe = lobe_rough(c.sheen_lobe, m->has_fuzz ? s->fuzz_roughness : s->sheen_roughness);
            lobe = lobe_named(lobe, compose_sheen_named(s));
        }
        if (free) lobe = compose_sheen(lobe, s, c);
        m->nap = nap_of(s->nap, s->nap_direction);
        slot_make(&m->sheen, lobe, m->sheen_color, s->sheen_second, 1.0f, m->sheen.normal, m->sheen.grazing);
        m->albedo = ALBEDO_TABLE;
        m->albedo_coord = lobe.params[0];
    }
    if (c.layer >= 0) m->layer = c.layer;
    m->amount = min(s->sheen, 1.0f);
    if (layer_needs_average(c.layer) && !albedo_is_own(m->albedo)) {
        m->albedo = ALBEDO_TABLE; /* these rules need E(wi) and its average; engines' formulas have neither */
        m->albedo_coord = m->sheen.lobe.params[0];
    }
    m->combine = c.layer_by >= 0 ? c.layer_by : layer_combine(m->layer);
    if ((c.d >= 0 || c.v >= 0 || c.f >= 0) && HAS_SPECULAR(m)) {
        m->specular.lobe = compose_terms(compose_facets(m->specular.lobe), c.d, c.v, c.f, s);
        m->glass_lost = 0.0f;
    }
    if (c.diffuse >= 0 && HAS_DIFFUSE(m)) {
        Lobe lobe = lobe_named(lobe_rough(c.diffuse, s->roughness), compose_diffuse_named(s));
        Rgb color = m->diffuse.f0;
        slot_make(&m->diffuse, lobe, color, color, 1.0f, m->diffuse.normal, m->diffuse.grazing);
    }
}

/* Adds the slot of dust if dust_accumulate found some at this point. */
FN void compose_dust(Stack *m, const Surface *s) {
    if (s->dust <= DUST_LEAST) return;
    m->dust_amount = s->dust;
    slot_even(&m->dust, lobe_rough(DUST_LOBE, s->dust_roughness), s->dust_color, s->dust_color, 1.0f);
    m->dust.normal = max(m->dust.normal, 1e-30f); /* HAS_DUST: black dust too dims what is below */
}

/* Prepares the lobes of a stack, once they are chosen, and finds the rows of the albedo table for the sheen. */
FN void stack_prepare(Stack *m) {
    stack_prepare_lobes(m);
    if (HAS_SHEEN(m) && albedo_is_own(m->albedo) && SHEEN_IS_OWN(m->table))
        m->rows = table_rows(m->table, m->albedo_coord);
}

/* Makes the stack of a surface whose inputs need no conversion from another workflow. */
FN void compose_stack(Stack *m, const Surface *s, Choices c, TableRef e) {
    compose_begin(m, s, c);
    compose_choices(m, s, c);
    stack_split_diffuse(m);
    compose_dust(m, s);
    m->table = e;
    stack_prepare(m);
    if (HAS_SHEEN(m) && layer_needs_wi(m->layer)) m->e_avg = table_sheen_nap_average(e, m->nap, m->rows);
    if (m->layer == LAYER_MULTIPLICATIVE) {
        m->sheen.f0 = rgb_grey(0.0f);
        m->sheen.f90 = rgb_grey(0.0f);
    }
}

/* Replaces the diffuse and the specular lobe by one lobe, such as a point of woven cloth, with the colours of its
 * single and its multiple scattering. */
FN void compose_base(Stack *m, Lobe lobe, Rgb single, Rgb multiple) {
    m->specular.normal = 0.0f;
    m->base_fresnel = BASE_FRESNEL_NONE;
    m->retro = 0.0f; /* threads lean: half a turn would make another lobe of them */
    stack_without_glass(m);
    m->diffuse.lobe = lobe;
    m->diffuse.f0 = single;
    m->diffuse.f90 = multiple;
    m->diffuse.normal = max(0.33f * rgb_mean(single) + 0.67f * rgb_mean(multiple), 1e-3f);
    m->diffuse.grazing = m->diffuse.normal;
    stack_split_diffuse(m);
    IN_SLOT(diffuse, prepare)(&m->diffuse.lobe, &m->diffuse_prepared);
}

/* Makes the stack of a surface. e: the table of E of the sheen's lobe over its first parameter; only a stack whose
 * `albedo` is ALBEDO_TABLE or ALBEDO_KHRONOS reads it. s->dust: the amount at this point, as dust_accumulate
 * returns it. */
FN void surface_stack(Stack *m, const Surface *s, Choices c, TableRef e) {
    Choices d = convert_choices(c);
    Surface t = convert_surface(*s, c);
    compose_surface(&t, d);
    compose_stack(m, &t, d, e);
}
