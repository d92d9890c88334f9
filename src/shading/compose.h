/* compose.h - from inputs and choices to a stack, and what a stack reflects
 *
 * A profile, or else a workflow, makes the stack; then come the choices that were made, in place of what it
 * says. */
#ifndef WEFT_SHADING_COMPOSE_H
#define WEFT_SHADING_COMPOSE_H

#include "shading/azimuth.h"
#include "shading/convert.h"
#include "shading/dust.h"
#include "shading/dust_lobe.h"
#include "shading/lobes/cook_torrance.h"
#include "shading/lobes/ggx.h"
#include "shading/lobes/silk.h"
#include "shading/profile.h"
#include "shading/slots.h"

/* The index of refraction; where none is given, that of the reflectance. */
FN float compose_ior(const Surface *s) {
    float root = sqrt(dielectric_f0(s));
    return s->ior > 0.0f ? max(s->ior, 1.0f) : (1.0f + root) / max(1.0f - root, 0.1f);
}

/* A lobe of facets as the composition that it is. */
FN Lobe compose_facets(Lobe lobe) {
    if (lobe.id != LOBE_GGX && lobe.id != LOBE_SILK) return lobe;
    float ax = 0.0f, ay = 0.0f;
    if (lobe.id == LOBE_GGX) {
        Ggx g;
        g.alpha = lobe.params[GGX_ALPHA];
        g.anisotropy = lobe.params[GGX_ANISOTROPY];
        ax = ggx_ax(g);
        ay = g.alpha;
    } else {
        Silk k;
        k.alpha = lobe.params[SILK_ALPHA];
        k.anisotropy = lobe.params[SILK_ANISOTROPY];
        ax = silk_ax(k);
        ay = silk_ay(k);
    }
    Lobe m = lobe_rough(LOBE_COOK_TORRANCE, sqrt(ay));
    if (ax < ay || ax > ay) {
        m.params[COOK_TORRANCE_D] = to_float(D_GGX_ANISO);
        m.params[COOK_TORRANCE_V] = to_float(V_SMITH_GGX_ANISO);
    }
    m.params[COOK_TORRANCE_STRETCH] = clamp(ax / m.params[COOK_TORRANCE_ALPHA], 0.01f, 100.0f);
    return m;
}

/* A composition with terms of one's own choice; what is not chosen stays. */
FN Lobe compose_terms(Lobe lobe, int d, int v, int f, const Surface *s) {
    Lobe m = lobe;
    if (d >= 0) m.params[COOK_TORRANCE_D] = to_float(d);
    if (v >= 0) m.params[COOK_TORRANCE_V] = to_float(v);
    if (f >= 0) m.params[COOK_TORRANCE_F] = to_float(f);
    m.params[COOK_TORRANCE_IOR] = compose_ior(s);
    m.params[COOK_TORRANCE_K] = s->extinction;
    return m;
}

/* A distribution that knows no direction is laid on a base that is not brushed: it is as wide as the
 * roughness says, which for workflow disney is sqrt(alpha_x alpha_y), and anisotropy is not read. */
FN void compose_surface(Surface *s, Choices c) {
    if (c.d >= 0 && c.d != D_GGX_ANISO) s->anisotropy = 0.0f;
}

/* Whether terms of the sheen are chosen, or the lobe that is made of terms. */
FN bool compose_sheen_is_free(Choices c) {
    return c.sheen_lobe == LOBE_COOK_TORRANCE || c.sheen_d >= 0 || c.sheen_v >= 0 || c.sheen_f >= 0;
}

/* A sheen of free terms. What is not chosen is that of the workflow's or profile's sheen where that is such a
 * composition and stays, and else of charlie-neubelt. */
FN Lobe compose_sheen(Lobe lobe, const Surface *s, Choices c) {
    Lobe m = lobe;
    if (c.sheen_lobe >= 0 || lobe.id != LOBE_COOK_TORRANCE) {
        m = lobe_rough(LOBE_COOK_TORRANCE, s->sheen_roughness);
        m.params[COOK_TORRANCE_D] = to_float(D_CHARLIE);
        m.params[COOK_TORRANCE_V] = to_float(V_NEUBELT);
        m.params[COOK_TORRANCE_F] = to_float(F_NONE);
    }
    return compose_terms(m, c.sheen_d, c.sheen_v, c.sheen_f, s);
}

FN void compose_choices(Stack *m, const Surface *s, Choices c) {
    bool free = compose_sheen_is_free(c);
    if (c.sheen_lobe >= 0 || free) {
        Lobe lobe = m->sheen.lobe;
        if (c.sheen_lobe >= 0) {
            lobe = lobe_rough(c.sheen_lobe, s->sheen_roughness);
            lobe = lobe_fibres(lobe, s->sheen_density, s->nap, azimuth_of(s->nap_direction));
            if (s->sheen_beta > 0.0f && (lobe.id == LOBE_EXPONENTIAL || lobe.id == LOBE_EXPONENTIAL_LIT))
                lobe.params[0] = max(s->sheen_beta, 0.01f);
        }
        if (free) lobe = compose_sheen(lobe, s, c);
        m->nap = nap_of(s->nap, s->nap_direction);
        slot_make(&m->sheen, lobe, m->sheen_color, s->sheen_second, m->left, m->sheen.pick);
        m->albedo = ALBEDO_TABLE;
        m->at = lobe.params[0];
    }
    if (c.layer >= 0) m->layer = c.layer;
    m->amount = min(s->sheen, 1.0f);
    if ((c.layer == LAYER_RECIPROCAL || c.layer == LAYER_STOCHASTIC) && m->albedo > ALBEDO_KHRONOS) {
        m->albedo = ALBEDO_TABLE; /* these ask for more than engines' own formulas know */
        m->at = m->sheen.lobe.params[0];
    }
    if (c.layer_by >= 0) m->by = c.layer_by;
    if ((c.d >= 0 || c.v >= 0 || c.f >= 0) && HAS_SPECULAR(m)) {
        m->specular.lobe = compose_terms(compose_facets(m->specular.lobe), c.d, c.v, c.f, s);
    }
    if (c.diffuse >= 0 && HAS_DIFFUSE(m)) {
        Lobe lobe = lobe_rough(c.diffuse, c.diffuse == LOBE_WRAP ? s->subsurface : s->roughness);
        Rgb color = rgb_scale(m->diffuse.f0, 1.0f / max(m->left, 1e-6f));
        slot_make(&m->diffuse, lobe, color, color, m->left, m->diffuse.pick);
    }
}

/* E of the white sheen towards a direction. */
#define COMPOSE_ALBEDO(name, index, formula)                                                                 \
    if (m->albedo == index) return sheen_e_of(formula);
FN SheenE stack_albedo(const Stack *m, Dir w) {
    float cosine = w.z;
    WEFT_ALBEDO_FORMULAS(COMPOSE_ALBEDO)
    return table_sheen_nap(m->table, w, m->nap, m->at);
}

/* Dust over all of it, where dust_settle found some. What lies below keeps 1 - E, E of white dust: what dark
 * dust does not send back it keeps. So a white base under white dust returns what it receives. */
FN void compose_dust(Stack *m, const Surface *s, Dir o) {
    if (s->dust <= DUST_LEAST) return;
    Lobe lobe = lobe_rough(LOBE_LTC_FIBRE, s->dust_roughness);
    float e_1 = dust_albedo(&lobe, o.z), weight = dust_weight(s->dust, e_1, o.z), e = weight * e_1;
    slot_dim(&m->diffuse, 1.0f - e);
    slot_dim(&m->specular, 1.0f - e);
    slot_dim(&m->sheen, 1.0f - e);
    slot_dim(&m->coat, 1.0f - e);
    m->left = m->left * (1.0f - e);
    slot_make(&m->dust, lobe, s->dust_color, s->dust_color, weight, e * rgb_mean(s->dust_color));
}

/* What depends on wo and all of the stack: E, and the chance of each lobe to be sampled. */
FN void compose_finish(Stack *m, TableRef e, Dir o) {
    m->table = e;
    if (HAS_SHEEN(m)) {
        m->e_o = stack_albedo(m, o);
        m->e_avg = table_sheen_nap_average(e, m->nap, m->at);
        float keep = rgb_mean(stack_keep(m, m->e_o));
        m->sheen.pick = m->layer == LAYER_MULTIPLICATIVE ? 0.0f : max(m->sheen.pick * m->e_o.e, 1e-3f);
        if (m->layer == LAYER_MULTIPLICATIVE) {
            m->sheen.f0 = rgb_grey(0.0f);
            m->sheen.f90 = m->sheen.f0;
        }
        m->diffuse.pick = m->diffuse.pick * keep;
        if (!IS_BELOW_F(m)) m->specular.pick = m->specular.pick * keep;
    }
    float sum = m->diffuse.pick + m->specular.pick + m->sheen.pick + m->coat.pick + m->dust.pick;
    /* a floor keeps every lobe reachable, so that no weight is unbounded */
    float most = sum > 0.0f ? 0.9375f / sum : 0.0f, least = 0.015625f, rest = 1.0f;
    m->diffuse.pick = m->diffuse.pick > 0.0f ? most * m->diffuse.pick + least : 0.0f;
    m->specular.pick = m->specular.pick > 0.0f ? most * m->specular.pick + least : 0.0f;
    m->sheen.pick = m->sheen.pick > 0.0f ? most * m->sheen.pick + least : 0.0f;
    m->coat.pick = m->coat.pick > 0.0f ? most * m->coat.pick + least : 0.0f;
    m->dust.pick = m->dust.pick > 0.0f ? most * m->dust.pick + least : 0.0f;
    sum = m->diffuse.pick + m->specular.pick + m->sheen.pick + m->coat.pick + m->dust.pick;
    rest = sum > 0.0f ? 1.0f / sum : 0.0f;
    m->diffuse.pick = m->diffuse.pick * rest;
    m->specular.pick = m->specular.pick * rest;
    m->sheen.pick = m->sheen.pick * rest;
    m->coat.pick = m->coat.pick * rest;
    m->dust.pick = m->dust.pick * rest;
}

/* The stack of a surface seen from wo (shading frame, z > 0). e is the table of E of the sheen's lobe over
 * its first parameter, where the stack without it has an `albedo` of ALBEDO_TABLE or ALBEDO_KHRONOS. s.dust
 * is what lies at this point: dust_settle says. */
FN void surface_stack(Stack *m, const Surface *s, Choices c, TableRef e, Dir o) {
    Choices d = convert_choices(c);
    Surface t = convert_surface(*s, c);
    compose_surface(&t, d);
    compose_begin(m, &t, d, o);
    compose_choices(m, &t, d);
    compose_dust(m, &t, o);
    compose_finish(m, e, o);
}

/* The same as stack_value for some of the slots: what the others do to these stays. */
FN StackValue stack_value_of(const Stack *m, Slots only, Angles a, Angles coat) {
    SheenE e_i = sheen_e_of(0.0f);
    if (m->layer >= LAYER_ALBEDO_MIN && HAS_SHEEN(m)) e_i = stack_albedo(m, a.i);
    bool worn = IS_WORN(m);
    Rgb keep = rgb_grey(1.0f);
    if (worn) keep = stack_keep(m, e_i);
    Rgb under = stack_under(m, a), over = rgb_grey(1.0f), specular_keep = keep;
    if (IS_BELOW_F(m) && worn) {
        under = stack_let_through(m, a);
        over = under;
        specular_keep = rgb_grey(1.0f);
    }
    StackValue sum;
    sum.f_cos = rgb_grey(0.0f);
    sum.pdf = 0.0f;
    if (only.diffuse && HAS_DIFFUSE(m)) {
        LobeValue v;
        diffuse_at(&m->diffuse.lobe, &a, &v);
        sum.f_cos = rgb_mul(rgb_mul(keep, under), slot_f(&m->diffuse, v));
        sum.pdf = slot_pdf(&m->diffuse, v);
    }
    if (only.specular && HAS_SPECULAR(m)) {
        LobeValue v;
        specular_at(&m->specular.lobe, &a, &v);
        sum.f_cos = rgb_add(sum.f_cos, rgb_mul(specular_keep, slot_f(&m->specular, v)));
        sum.pdf = sum.pdf + slot_pdf(&m->specular, v);
    }
    if (only.sheen && HAS_SHEEN(m)) {
        LobeValue v;
        sheen_at(&m->sheen.lobe, &a, &v);
        sum.f_cos = rgb_add(sum.f_cos, rgb_mul(over, slot_f(&m->sheen, v)));
        sum.pdf = sum.pdf + slot_pdf(&m->sheen, v);
    }
    if (only.dust && HAS_DUST(m)) {
        LobeValue v = dust_value(&m->dust.lobe, a);
        sum.f_cos = rgb_add(sum.f_cos, slot_f(&m->dust, v));
        sum.pdf = sum.pdf + slot_pdf(&m->dust, v);
    }
    sum.f_cos = rgb_scale(sum.f_cos, a.i.z);
    if (only.coat && HAS_COAT(m) && coat.o.z > 0.0f && coat.i.z > 0.0f) {
        LobeValue v;
        coat_at(&m->coat.lobe, &coat, &v);
        sum.f_cos = rgb_add(sum.f_cos, rgb_scale(slot_f(&m->coat, v), coat.i.z));
        sum.pdf = sum.pdf + slot_pdf(&m->coat, v);
    }
    return sum;
}

/* f cos and pdf for wi, both above the horizon. coat: the same pair in the coat's frame. */
FN StackValue stack_value(const Stack *m, Angles a, Angles coat) {
    Slots only = slots_of(SHOWS_DIFFUSE, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);
    return stack_value_of(m, only, a, coat);
}

#endif
