/* stack_view.h - the view of a stack from wo: the scale of each slot, and the probability that it is sampled */
#pragma once

#include "shading/material/compose.h"

/* Returns E of the white sheen towards w. */
#define VIEW_ALBEDO(name, index, own_table, formula)                                                                   \
    if (m->albedo == index) return sheen_e_of(formula);
FN SheenE stack_albedo(const Stack *m, Dir w) {
    float cosine = w.z;
    WEFT_ALBEDO_FORMULAS(VIEW_ALBEDO)
    if (!SHEEN_IS_OWN(m->table)) return sheen_e_of(table_engine(m->table, cosine, m->albedo_coord));
    return table_sheen_nap(m->table, w, m->nap, m->rows);
}

/* Sets what the coat does in a view: its wo, its scale and its transmittance. */
FN void view_coat(const Stack *m, StackView *w) {
    w->coat_o = stack_to_coat(m, w->o);
    if (m->coat_rule == COAT_BARE) return;
    float cosine = w->coat_o.z, f = 0.0f; /* stays 0 where the coat's normal map faces away */
    float s = m->coat_rule == COAT_GAUSSIAN ? schlick_gaussian_s(cosine) : schlick_s(cosine);
    if (cosine > 1e-4f) f = m->coat_weight * mix(m->coat_f0, 1.0f, s);
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
#define SCALE_ONE(name, NAME, Name, wo)                                                                                \
    w->scale.name = 1.0f;                                                                                              \
    w->select_p.name = 1.0f;
/* For each row of WEFT_VIEWS: runs its statement if the stack's `view` names the row. */
#define VIEW_OF_ROW(name, index, what)                                                                                 \
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
    if (m->view != VIEW_NONE) {
        WEFT_VIEWS(VIEW_OF_ROW)
    }
    if (HAS_COAT(m)) view_coat(m, w);
    if (HAS_DUST(m)) view_dust(m, w);
    if (HAS_COAT(m) || HAS_DUST(m)) {
        float transmittance_above = w->coat_transmittance * w->dust_transmittance;
        w->scale.diffuse = w->scale.diffuse * transmittance_above;
        w->scale.specular = w->scale.specular * transmittance_above;
        w->scale.sheen = w->scale.sheen * (m->sheen_over_coat ? w->dust_transmittance : transmittance_above);
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
#define SELECT_P_OF(name, NAME, Name, wo)                                                                              \
    p.name = 0.0f;                                                                                                     \
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
        if (!m->sheen_over_coat) w->select_p.sheen = w->select_p.sheen * w->coat_transmittance;
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
        if (m->sheen_over_coat) p.coat = p.coat * base_scale;
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

/* Updates the view to another diffuse lobe of the stack; sets only what stack_value reads. */
FN void view_base(const Stack *m, StackView *w) {
    IN_SLOT(diffuse, view)(m->diffuse.lobe.id, &m->diffuse_prepared, &w->o, &w->diffuse_view);
}
