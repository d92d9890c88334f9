/* kind_text.h - the text of stacks as loops, for the structure that a file from cmake/kinds.cmake defines */
#pragma once

#define HAS_LAYERED_SHEEN(m) HAS_SHEEN(m) /* a black one leaves all of the base */
#define HAS_TRANSMITTED(m)   (KIND_TRANSMITS)
#define HAS_RETRO(m)         false
#define HAS_GLASS(m)         false
#include "shading/dialect/loop.h"
#include "shading/kinds/kind.h"
#include "shading/kinds/kind_loops.h"
#include "shading/material/material_stack.h"
#include "shading/stack/frame.h"

static Choices kind_choices(void) {
    Choices c = choices_unmade();
    c.profile = KIND_PROFILE;
    return c;
}

/* A coat of a kind that has one is always made, since a loop has no branches, and hidden where there is none. */
#define TAKE_STACK(m, v)                                                                                               \
    Surface s = surface_without_coming(surface_of_row(&(v)->surface, k));                                              \
    bool coated = s.clearcoat > 0.0f;                                                                                  \
    s.clearcoat = coat_lobe < 0 ? 0.0f : max(s.clearcoat, 1e-20f);                                                     \
    if (dust_lobe < 0) s.dust = 0.0f;                                                                                  \
    if (!KIND_TRANSMITS) s.diffuse_transmission = 0.0f;                                                                \
    Stack m;                                                                                                           \
    compose_stack(&m, &s, kind_choices(), e);                                                                          \
    if (KIND_WOVEN)                                                                                                    \
        compose_base(&m, yarn_of_row(&(v)->yarn, k), ROW_RGB((v)->yarn.single, k), ROW_RGB((v)->yarn.multiple, k));    \
    m.coat.normal = coated ? m.coat.normal : 0.0f

#define PUT_SELECT_P(name, NAME, Name, wo) v->select_p[place++][k] = w.select_p.name;
#define GET_SELECT_P(name, NAME, Name, wo) w.select_p.name = v->select_p[place++][k];

/* Fills the views. A table of one row is looked up in another way, so its number of rows must be fixed before the
 * loop. */
FN void see_each(KindVertices *restrict v, TableRef e, int n) {
    EACH(k, (size_t)n) {
        TAKE_STACK(m, v);
        StackView w = {0};
        stack_view(&m, ROW_DIR(v->o, k), &w);
        v->e_o[k] = w.e_o.e;
        v->base_scale[0][k] = w.base_scale.r;
        v->base_scale[1][k] = w.base_scale.g;
        v->base_scale[2][k] = w.base_scale.b;
        int place = 0;
        SLOTS(PUT_SELECT_P)
    }
}

LOOP(see_n, (KindVertices *restrict v, TableRef e, int n), (v, e, n)) {
    if (e.rows < 2) {
        e.rows = 1;
        see_each(v, e, n);
    } else
        see_each(v, e, n);
}

FN void eval_each(KindVertices *restrict v, TableRef e, int direction, int n) {
    float(*i)[ROW_CAPACITY] = v->i[direction];
    float(*f)[ROW_CAPACITY] = v->f[direction], *pdf = v->pdf[direction];
    EACH(k, (size_t)n) {
        TAKE_STACK(m, v);
        StackView w = {0};
        Dir wi = ROW_DIR(i, k);
        bool below = KIND_TRANSMITS && wi.z < 0.0f;
        wi.z = below ? -wi.z : wi.z;
        bool above = wi.z > 0.0f;
        float seen = above ? 1.0f : 0.0f; /* a choice would put look-ups in a branch */
        wi = dir(above ? wi.x : 0.0f, above ? wi.y : 0.0f, above ? wi.z : 1.0f);
        view_begin(&m, ROW_DIR(v->o, k), &w);
        w.e_o = sheen_e_of(v->e_o[k]);
        w.base_scale = rgb(v->base_scale[0][k], v->base_scale[1][k], v->base_scale[2][k]);
        int place = 0;
        SLOTS(GET_SELECT_P)
        Angles a = angles_between(w.o, wi), in_coat = a;
        if (coat_lobe >= 0) in_coat = angles_between(w.coat_o, stack_to_coat(&m, wi));
        StackValue value = stack_value(&m, &w, &a, &in_coat);
        if (KIND_TRANSMITS) {
            StackValue through = stack_transmitted(&m, &w, &a);
            value.f_cos.r = below ? through.f_cos.r : value.f_cos.r;
            value.f_cos.g = below ? through.f_cos.g : value.f_cos.g;
            value.f_cos.b = below ? through.f_cos.b : value.f_cos.b;
            value.pdf = below ? through.pdf : value.pdf;
        }
        f[0][k] = value.f_cos.r * seen;
        f[1][k] = value.f_cos.g * seen;
        f[2][k] = value.f_cos.b * seen;
        pdf[k] = value.pdf * seen;
    }
}

LOOP(eval_n, (KindVertices *restrict v, TableRef e, int direction, int n), (v, e, direction, n)) {
    if (e.rows < 2) {
        e.rows = 1;
        eval_each(v, e, direction, n);
    } else
        eval_each(v, e, direction, n);
}

#define TRY_SLOT(name, NAME, Name, wo)                                                                                 \
    if (name##_lobe >= 0) {                                                                                            \
        bool begun = w.select_p.name > 0.0f && (slot < 0 || u >= at);                                                  \
        slot = begun ? place : slot;                                                                                   \
        begin = begun ? at : begin;                                                                                    \
        width = begun ? w.select_p.name : width;                                                                       \
        at += w.select_p.name;                                                                                         \
    }                                                                                                                  \
    place++;
#define DRAW_SLOT(name, NAME, Name, wo)                                                                                \
    if (name##_lobe >= 0) {                                                                                            \
        Dir x;                                                                                                         \
        name##_sample_at(0, &m.name##_prepared, &w.name##_view, &w.wo, u, v->v[k], &x);                                \
        if (PLACE_##NAME == PLACE_COAT) x = dir_choose(x.z > 0.0f, stack_from_coat(&m, x), x);                         \
        i = dir_choose((slot == place) & (w.wo.z > 0.0f), x, i);                                                       \
    }                                                                                                                  \
    place++;

LOOP(sample_n, (KindVertices *restrict v, TableRef e, int n), (v, e, n)) {
    float(*drawn)[ROW_CAPACITY] = v->i[KIND_DRAWN];
    EACH(k, (size_t)n) {
        TAKE_STACK(m, v);
        StackView w = {0};
        view_begin(&m, ROW_DIR(v->o, k), &w);
        int place = 0, slot = -1;
        SLOTS(GET_SELECT_P)
        float u = v->u[k], begin = 0.0f, at = 0.0f, width = 1.0f;
        place = 0;
        SLOTS(TRY_SLOT)
        u = min(max((u - begin) / max(width, 1e-12f), 0.0f), 0x1.fffffep-1f);
        bool through = KIND_TRANSMITS && slot == PLACE_DIFFUSE;
        float rest = u;
        through = through && stack_takes_transmitted(&m, &rest);
        u = KIND_TRANSMITS && slot == PLACE_DIFFUSE ? rest : u;
        Dir i = dir(0.0f, 0.0f, -1.0f);
        place = 0;
        SLOTS(DRAW_SLOT)
        if (KIND_TRANSMITS) {
            Dir behind = warp_cosine(u, v->v[k]);
            i.z = max(i.z, 0.0f);
            i = dir_choose(through, dir(behind.x, behind.y, -behind.z), i);
        }
        drawn[0][k] = i.x;
        drawn[1][k] = i.y;
        drawn[2][k] = i.z;
    }
}

const KindLoops KIND = {see_n, eval_n, sample_n};
