/* compose.h - makes the stack of a surface and its choices, computes the view of a stack from wo, and evaluates it
 *
 * A profile, or else a workflow, makes the stack. The choices of a material then replace the parts of it that
 * they name. */
#ifndef WEFT_SHADING_COMPOSE_H
#define WEFT_SHADING_COMPOSE_H

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
    m.params[COOK_TORRANCE_STRETCH] = clamp(p.ax / m.params[COOK_TORRANCE_ALPHA], 0.01f, 100.0f);
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

/* Return the inputs that set parameters, by their names, of a chosen sheen and of a chosen diffuse lobe. */
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
            lobe = lobe_rough(c.sheen_lobe, s->sheen_roughness);
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
    if (layer_asks_average(c.layer) && !albedo_is_own(m->albedo)) {
        m->albedo = ALBEDO_TABLE; /* these rules need E(wi) and its average; engines' formulas have neither */
        m->albedo_coord = m->sheen.lobe.params[0];
    }
    if (c.layer_by >= 0) m->combine = c.layer_by;
    if ((c.d >= 0 || c.v >= 0 || c.f >= 0) && HAS_SPECULAR(m)) {
        m->specular.lobe = compose_terms(compose_facets(m->specular.lobe), c.d, c.v, c.f, s);
    }
    if (c.diffuse >= 0 && HAS_DIFFUSE(m)) {
        Lobe lobe = lobe_named(lobe_rough(c.diffuse, s->roughness), compose_diffuse_named(s));
        Rgb color = m->diffuse.f0;
        slot_make(&m->diffuse, lobe, color, color, 1.0f, m->diffuse.normal, m->diffuse.grazing);
    }
}

/* Returns E of the white sheen towards w. */
#define COMPOSE_ALBEDO(name, index, own_table, formula)                                                      \
    if (m->albedo == index) return sheen_e_of(formula);
FN SheenE stack_albedo(const Stack *m, Dir w) {
    float cosine = w.z;
    WEFT_ALBEDO_FORMULAS(COMPOSE_ALBEDO)
    if (!SHEEN_IS_OWN(m->table)) return sheen_e_of(table_engine(m->table, cosine, m->albedo_coord));
    return table_sheen_nap(m->table, w, m->nap, m->rows);
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
    if (HAS_SHEEN(m) && layer_asks_wi(m->layer)) m->e_avg = table_sheen_nap_average(e, m->nap, m->rows);
    if (m->layer == LAYER_MULTIPLICATIVE) {
        m->sheen.f0 = rgb_grey(0.0f);
        m->sheen.f90 = rgb_grey(0.0f);
    }
}

/* Puts a lobe with two colours in the place of the diffuse and the specular one: what a woven cloth is at a place. */
FN void compose_base(Stack *m, Lobe lobe, Rgb once, Rgb again) {
    m->specular.normal = 0.0f;
    m->base_fresnel = BASE_FRESNEL_NONE;
    m->diffuse.lobe = lobe;
    m->diffuse.f0 = once;
    m->diffuse.f90 = again;
    m->diffuse.normal = max(0.33f * rgb_mean(once) + 0.67f * rgb_mean(again), 1e-3f);
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

/* Sets what the coat does in a view: its wo, its scale and its transmittance. */
FN void view_coat(const Stack *m, StackView *w) {
    w->coat_o = stack_to_coat(m, w->o);
    if (m->coat_rule == COAT_BARE) return;
    float cosine = w->coat_o.z, f = 0.0f; /* stays 0 where the coat's normal map faces away */
    float s = m->coat_rule == COAT_GAUSSIAN ? schlick_gaussian_s(cosine) : schlick_s(cosine);
    if (cosine > 1e-4f) f = m->coat_weight * mix(0.04f, 1.0f, s);
    w->coat_transmittance = 1.0f - f;
    w->select_p.coat = f;
    w->scale.coat = m->coat_rule == COAT_SCHLICK ? f : cosine > 1e-4f ? 1.0f : 0.0f;
}

/* Layers below are multiplied by 1 - E, where E is the albedo this amount of dust would have if white. Darker
 * dust reflects less than E and absorbs the difference. A white base under white dust returns the light it receives. */
FN void view_dust(const Stack *m, StackView *w) {
    if (m->dust_amount <= DUST_LEAST) return;
    float e_1 = dust_albedo(&m->dust.lobe, w->o.z);
    w->scale.dust = dust_weight(m->dust_amount, e_1, w->o.z);
    w->select_p.dust = w->scale.dust * e_1;
    w->dust_transmittance = 1.0f - w->select_p.dust;
}

/* For each slot: nothing dims it, and its albedo alone decides how often it is sampled. */
#define SCALE_ONE(name, NAME, Name, wo)                                                                      \
    w->scale.name = 1.0f;                                                                                    \
    w->select_p.name = 1.0f;
/* For each row of WEFT_VIEWS: runs its statement if the stack's `view` names the row. */
#define COMPOSE_VIEW(name, index, what)                                                                      \
    if (m->view == index) what;
/* Sets all of a view but E of the sheen, the base scale and the selection probabilities. */
FN void view_begin(const Stack *m, Dir o, StackView *w) {
    w->o = o;
    w->coat_o = o;
    w->coat_transmittance = 1.0f;
    w->dust_transmittance = 1.0f;
    w->interface_f0 = m->interface_f0;
    w->interface_f90 = m->interface_f90;
    w->extra = 0.0f;
    w->e_o = sheen_e_of(0.0f);
    w->base_scale = rgb_grey(1.0f);
    SLOTS(SCALE_ONE)
    if (m->view != VIEW_PLAIN) {
        WEFT_VIEWS(COMPOSE_VIEW)
    }
    if (HAS_COAT(m)) view_coat(m, w);
    if (HAS_DUST(m)) view_dust(m, w);
    if (HAS_COAT(m) || HAS_DUST(m)) {
        float transmittance_above = w->coat_transmittance * w->dust_transmittance;
        w->scale.diffuse = w->scale.diffuse * transmittance_above;
        w->scale.specular = w->scale.specular * transmittance_above;
        w->scale.sheen = w->scale.sheen * transmittance_above;
        w->scale.coat = w->scale.coat * w->dust_transmittance;
    }
    stack_view_lobes(m, w);
}

/* Sets the base scale of a layer rule that does not depend on wi. */
FN void view_base_scale(const Stack *m, StackView *w) {
    if (HAS_LAYERED_SHEEN(m)) w->base_scale = stack_base_scale(m, w, w->e_o);
}

/* Returns a slot's sampling weight: its albedo times weight, before dust and the layer rule dim it. The floor of
 * 1e-3 keeps every slot in use reachable, so that f cos / pdf is bounded. */
FN float select_p_of(const Slot *s, float schlick, float weight, float scale) {
    return s->normal > 0.0f && scale > 0.0f ? max(mix(s->normal, s->grazing, schlick) * weight, 1e-3f) : 0.0f;
}
#define SELECT_P_OF(name, NAME, Name, wo)                                                                    \
    p.name = 0.0f;                                                                                           \
    if (HAS_##NAME(m)) p.name = select_p_of(&m->name, s, w->select_p.name, w->scale.name);
#define SELECT_P_SUM(name, NAME, Name, wo)   +p.name
#define SELECT_P_USED(name, NAME, Name, wo)  +(p.name > 0.0f ? 1.0f : 0.0f)
#define SELECT_P_SCALE(name, NAME, Name, wo) w->select_p.name = p.name > 0.0f ? most * p.name + least : 0.0f;

/* Sets the selection probabilities. On entry select_p has the factors that depend on wo. Each of n used slots gets
 * (15/16 p / sum + 1/64) / (15/16 + n/64), which is at least 1/65. */
FN void view_select_p(const Stack *m, StackView *w) {
    float s = schlick_s(w->o.z), base_scale = 1.0f;
    Scales p;
    if (HAS_COAT(m)) {
        w->select_p.diffuse = w->select_p.diffuse * w->coat_transmittance;
        w->select_p.specular = w->select_p.specular * w->coat_transmittance;
        w->select_p.sheen = w->select_p.sheen * w->coat_transmittance;
    }
    SLOTS(SELECT_P_OF)
    if (HAS_DUST(m)) {
        p.diffuse = w->dust_transmittance * p.diffuse;
        p.specular = w->dust_transmittance * p.specular;
        p.sheen = w->dust_transmittance * p.sheen;
        p.coat = w->dust_transmittance * p.coat;
    }
    if (HAS_SHEEN(m)) {
        base_scale = rgb_mean(w->base_scale);
        bool sampled = m->layer != LAYER_MULTIPLICATIVE && p.sheen > 0.0f;
        p.sheen = sampled ? max(p.sheen * w->e_o.e, 1e-3f) : 0.0f;
        p.diffuse = p.diffuse * base_scale;
        if (!IS_BELOW_F(m)) p.specular = p.specular * base_scale;
    }
    float sum = 0.0f SLOTS(SELECT_P_SUM), used = 0.0f SLOTS(SELECT_P_USED);
    float least = 1.0f / (60.0f + used), most = 60.0f * least / max(sum, 1e-30f);
    SLOTS(SELECT_P_SCALE)
}

/* Computes the view of a stack for wo (shading frame, z > 0). */
FN void stack_view(const Stack *m, Dir o, StackView *w) {
    view_begin(m, o, w);
    if (HAS_SHEEN(m)) w->e_o = stack_albedo(m, o);
    view_base_scale(m, w);
    view_select_p(m, w);
}

/* Makes a view that of a stack with another diffuse lobe, as far as stack_value asks. */
FN void view_base(const Stack *m, StackView *w) {
    IN_SLOT(diffuse, view)(m->diffuse.lobe.id, &m->diffuse_prepared, &w->o, &w->diffuse_view);
}

/* Sets v to f and the pdf of a slot's lobe. pair: wo and wi in the slot's frame. */
#define SLOT_VALUE(slot, pair)                                                                               \
    IN_SLOT(slot, reflect)                                                                                   \
    (m->slot.lobe.id, &m->slot##_prepared, &w->slot##_view, pair, &m->slot.f0, &m->slot.f90, &v);

/* f of the diffuse lobe under the interface. through: what that lets through by a rule that puts it over the sheen
 * too, which is the case if below_f. */
FN Rgb stack_under_interface(const Stack *m, const StackView *w, const Angles *a, bool below_f, Rgb through,
                             Rgb f) {
    if (below_f) return rgb_mul(rgb_mul(f, through), w->base_scale);
    if (m->base_fresnel != BASE_FRESNEL_NONE) return rgb_mul(f, stack_base_transmittance(m, w, a));
    return f;
}

/* f of the base under the sheen, of the other rules. */
FN Rgb stack_under_sheen(const Stack *m, const StackView *w, const Angles *a, Rgb f) {
    Rgb base_scale = w->base_scale;
    if (layer_asks_wi(m->layer)) {
        SheenE e_i = sheen_e_of(0.0f);
        if (HAS_SHEEN(m)) e_i = stack_albedo(m, a->i);
        base_scale = stack_base_scale(m, w, e_i);
    }
    return rgb_mul(f, base_scale);
}

/* Works as stack_value, for the slots `only`. The other slots still dim them. */
FN StackValue stack_value_of(const Stack *m, const StackView *w, Slots only, const Angles *a,
                             const Angles *coat) {
    bool layered = HAS_LAYERED_SHEEN(m), below_f = IS_BELOW_F(m) && layered;
    Rgb f = rgb_grey(0.0f), through = f; /* transmittance of the interface over diffuse and sheen */
    float pdf = 0.0f;
    LobeReflected v;
    if (below_f) through = stack_interface_transmittance(m, w, a);
    if (only.diffuse && HAS_DIFFUSE(m)) {
        SLOT_VALUE(diffuse, a)
        f = rgb_scale(v.f, w->scale.diffuse);
        pdf = w->select_p.diffuse * v.pdf;
        if (HAS_TRANSMITTED(m)) pdf = pdf * (1.0f - m->transmitted_p);
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
    if (layered && !below_f) f = stack_under_sheen(m, w, a, f);
    if (only.sheen && HAS_SHEEN(m)) {
        SLOT_VALUE(sheen, a)
        v.f = rgb_scale(v.f, w->scale.sheen);
        if (below_f) v.f = rgb_mul(v.f, through);
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
        f = rgb_add(f, rgb_scale(v.f, w->scale.coat * coat->i.z));
        pdf = pdf + w->select_p.coat * v.pdf;
    }
    StackValue sum;
    sum.f_cos = f;
    sum.pdf = pdf;
    return sum;
}

/* Returns f cos_i and the pdf of light from below the surface. a: of its mirror image above. Of layer rule stochastic it
 * is the first pass. */
FN StackValue stack_transmitted(const Stack *m, const StackView *w, const Angles *a) {
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

/* Returns f cos_i and the pdf of wi. Both directions are above the horizon. coat: the pair in the coat's frame. */
FN StackValue stack_value(const Stack *m, const StackView *w, const Angles *a, const Angles *coat) {
    Slots only = slots_of(SHOWS_DIFFUSE, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);
    return stack_value_of(m, w, only, a, coat);
}

#endif
