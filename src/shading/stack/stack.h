/* stack.h - a material at one point: dust over a coat over a sheen over a specular and a diffuse lobe
 *
 *   f cos = T_dust (T_coat (sheen + base_scale (specular + (1 - F) diffuse)) + coat) + dust
 *         = T_dust (sheen + base_scale (T_coat (specular + (1 - F) diffuse) + coat)) + dust   if the sheen is on the coat
 *   pdf   = sum select_p_k pdf_k,  sum select_p_k = 1
 *
 * Cloth transmits light: a share of the diffuse lobe's energy goes to a Lambert lobe below the surface. It is dimmed
 * by everything that is over the diffuse lobe as if wi were its mirror image above, since the layers in front are
 * behind too: so f is as reciprocal as the layers are, and both sides together reflect what one did.
 *
 * Thin glass lets a share of the light below the specular interface through without bending it: the specular lobe with
 * wi mirrored, in a colour, times 1 - F; what that lobe loses between its facets goes through too, evenly (ggx_lost.h).
 * It is dimmed by the layers above as cloth's light is, and it and the reflection of a white pane send on all light.
 * Khronos Group, KHR_materials_transmission, 2021. The path tracer takes the glass of solids out of the stack, since
 * they bend light (trace/path/solid.h).
 *
 * A retroreflective base turns a share of its light back: specular and diffuse lobe are blended linearly with themselves
 * for the mirror direction of wo. All lobes but those of threads are the same for both directions turned about the
 * normal by half a turn, so wi is turned in place of wo: f is as reciprocal and E the same. Jamie Portsmouth, Matthias
 * Raab, Laurent Belcour, Francis Liu, JCGT 15(1), 2026.
 *
 * A Stack holds what does not depend on directions. It is made once for a material, or for each point if textures
 * change its inputs. A StackView holds what depends on wo alone. It serves sampling and every wi. Two factors depend
 * on wi too: base_scale of some layer rules, and 1 - F. They scale f but not the pdf, so that samples follow the pdf
 * exactly. */
#pragma once

#include "shading/dialect/rgb.h"
#include "shading/lobe/table.h"
#include "shading/stack/layer.h"
#include "shading/stack/slots.h"
#include "shading/terms/f_schlick.h"
#include "shading/terms/f_schlick_gaussian.h"

STRUCT(Slot) {
    Lobe lobe;
    Rgb f0, f90;           /* the lobe's two colours times its weight; f90 of a tinted lobe is the weight alone */
    float normal, grazing; /* rough albedo at normal and at grazing incidence, to weigh slots when sampling;
                            * normal is 0 if the slot is empty */
};

/* The dimming of the diffuse lobe by the specular interface: none; by F at wi . h, as glTF has it; by F at
 * the least of wi . h, cos_o and cos_i, which never gains energy; or by F at wi . h as f_schlick_gaussian has
 * it. */
#define BASE_FRESNEL_NONE     0
#define BASE_FRESNEL_HALF     1
#define BASE_FRESNEL_LEAST    2
#define BASE_FRESNEL_GAUSSIAN 3

/* The Fresnel factor of the coat. BARE: only that of its lobe. SCHLICK: F at the coat's cosine scales the
 * coat and dims the layers below. GAUSSIAN: F by f_schlick_gaussian dims the layers below. */
#define COAT_BARE     0
#define COAT_SCHLICK  1
#define COAT_GAUSSIAN 2

/* The source of E of the sheen: the lobe's own table, which ALBEDO_KHRONOS reads too, or an engine's formula
 * (profile.h). */
#define ALBEDO_TABLE        0
#define ALBEDO_KHRONOS      1
#define ALBEDO_THREE        2
#define ALBEDO_FILAMENT     3
#define ALBEDO_BABYLON      4
#define ALBEDO_MATERIALX    5
#define ALBEDO_BABYLON_FUZZ 6

/* An engine's own steps that depend on wo (profile.h). */
#define VIEW_NONE      0
#define VIEW_URP       1
#define VIEW_THREE     2
#define VIEW_FILAMENT  3
#define VIEW_BABYLON   4
#define VIEW_MATERIALX 5

#define SLOT_MEMBER(name, NAME, Name, wo)   Slot name;
#define SLOT_PREPARED(name, NAME, Name, wo) OF_SLOT(Name, Prepared) name##_prepared;
#define SLOT_VIEW(name, NAME, Name, wo)     OF_SLOT(Name, View) name##_view;
#define SLOT_FLOAT(name, NAME, Name, wo)    float name;
#define SLOT_BOOL(name, NAME, Name, wo)     bool name;

STRUCT(Stack) {
    SLOTS(SLOT_MEMBER)
    SLOTS(SLOT_PREPARED)
    int base_fresnel; /* BASE_FRESNEL_NONE ... */
    Rgb interface_f0; /* of the specular interface over the diffuse lobe */
    float interface_f90;
    /* F of the specular slot, with s = schlick_s and the view's `extra`, is f0 (1 - s) + f90 s
     * + extra (extra_f0 (1 - s) + extra_f90 s - extra_f_quadratic s (1 - s)). */
    Rgb extra_f0, extra_f90, extra_f_quadratic;
    float gloss;                /* roughness or alpha of the specular slot, as the engine's steps in `view` need it */
    int view;                   /* VIEW_NONE ... */
    int coat_rule;              /* COAT_BARE ... */
    float coat_weight, coat_f0; /* amount; reflectance at normal incidence */
    bool has_fuzz;              /* the material has fuzz in place of a sheen */
    bool sheen_over_coat;       /* the sheen is on the coat, and dims it */
    float retro;                /* the share of the base's light that is turned back */
    float dust_amount;          /* 0: no dust */
    float transmission;         /* the share of the diffuse slot's energy that goes through */
    Rgb transmitted;            /* the colour of that light, times its share */
    float transmitted_p;        /* the share of the diffuse slot's samples */
    float glass;        /* the share of the light below the specular interface that goes through as through glass */
    float glass_taken;  /* the share that it takes of diffuse and of transmitted light: metal has none to take */
    Rgb glass_tint;     /* the colour of that light, times its share */
    float glass_p;      /* the share of the diffuse slot's samples */
    float glass_lost;   /* alpha of facets whose lost light goes through; 0: it stays lost */
    int layer, combine; /* LAYER_ADDITIVE ...; LAYER_BY_MAX or LAYER_BY_CHANNEL */
    Rgb color;          /* colour of the sheen in the layer rule */
    Rgb sheen_color;    /* colour, times weight, of a lobe that is chosen for the sheen */
    float amount;       /* k of layer rule seed: the amount of the sheen */
    int albedo;         /* source of E: ALBEDO_TABLE ... */
    TableRef table;
    Nap nap;                    /* lean of the sheen's fibres */
    float albedo_coord;         /* the sheen's shape parameter at which E is looked up */
    Taps rows;                  /* row weights for it, if the table is weft's own */
    SheenE e_avg;               /* cosine-weighted average of the white sheen's E */
    Dir coat_x, coat_y, coat_z; /* the coat's frame, in the shading frame */
};

STRUCT(Scales){SLOTS(SLOT_FLOAT)};
STRUCT(StackView) {
    Dir o, coat_o; /* wo in the shading frame, and in the coat's */
    SLOTS(SLOT_VIEW)
    Scales scale;    /* factors on f of the slots: transmittance of dust and coat, weights that depend on wo */
    Scales select_p; /* probability that sampling chooses the slot */
    float coat_transmittance, dust_transmittance; /* what coat and dust let through, 1 without them */
    Rgb interface_f0;                             /* as in the stack, unless `view` changes them */
    float interface_f90;
    float extra;    /* factor on the stack's extra_f0, extra_f90 and extra_f_quadratic */
    SheenE e_o;     /* E of the white sheen towards wo */
    Rgb base_scale; /* the layer rule's factor on the base; if it depends on wi, a stand-in for sampling */
};

/* Some of the slots. */
STRUCT(Slots){SLOTS(SLOT_BOOL)};

FN Slots slots_of(bool diffuse, bool specular, bool sheen, bool coat, bool dust) {
    Slots s;
    s.diffuse = diffuse;
    s.specular = specular;
    s.sheen = sheen;
    s.coat = coat;
    s.dust = dust;
    return s;
}

FN Slots slots_all(void) { return slots_of(true, true, true, true, true); }

STRUCT(StackValue) {
    Rgb f_cos; /* f times the cosine of wi */
    float pdf; /* of the mixture, 1/sr */
};

/* HAS_DIFFUSE and so on test whether a slot holds a lobe, HAS_LAYERED_SHEEN whether the layer rule has a
 * sheen that is not black, HAS_TRANSMITTED whether the base lets light through, HAS_GLASS whether as glass does, HAS_RETRO
 * whether it turns light back. A shader, whose slots are fixed, defines them as constants: an empty slot costs nothing. */
#ifndef HAS_DIFFUSE
#define HAS_DIFFUSE(m)       ((m)->diffuse.normal > 0.0f)
#define HAS_SPECULAR(m)      ((m)->specular.normal > 0.0f)
#define HAS_SHEEN(m)         ((m)->sheen.normal > 0.0f)
#define HAS_COAT(m)          ((m)->coat.normal > 0.0f)
#define HAS_DUST(m)          ((m)->dust.normal > 0.0f)
#define HAS_LAYERED_SHEEN(m) ((m)->color.r + (m)->color.g + (m)->color.b > 0.0f)
#define HAS_TRANSMITTED(m)   ((m)->transmission > 0.0f || (m)->glass > 0.0f)
#endif
#ifndef HAS_GLASS
#define HAS_GLASS(m) ((m)->glass > 0.0f)
#endif
#ifndef HAS_RETRO
#define HAS_RETRO(m) ((m)->retro > 0.0f)
#endif

/* Tests whether the layer rule puts the sheen too below F of the specular interface. Such a rule needs no E. */
#define IS_BELOW_F(m) (m->layer == LAYER_SEED || m->layer == LAYER_SIDE_BY_SIDE)

/* Tests whether the view has `extra`, a correction of the specular slot. */
#define HAS_EXTRA_F(m) (m->view != VIEW_NONE && m->view != VIEW_URP)

/* A shader that shows one part of the light defines these as false for the other slots. Those slots still dim
 * that part. */
#ifndef SHOWS_DIFFUSE
#define SHOWS_DIFFUSE  true
#define SHOWS_SPECULAR true
#define SHOWS_SHEEN    true
#define SHOWS_COAT     true
#define SHOWS_DUST     true
#endif

#define CLEAR_SLOT(name, NAME, Name, wo)                                                                               \
    m->name.lobe = lobe_default(LOBE_LAMBERT);                                                                         \
    m->name.f0 = rgb_grey(0.0f);                                                                                       \
    m->name.f90 = rgb_grey(0.0f);                                                                                      \
    m->name.normal = 0.0f;                                                                                             \
    m->name.grazing = 0.0f;

/* Fills a slot. second: the second colour, if the lobe has two. normal, grazing: rough albedo there (Slot). */
FN void slot_make(Slot *s, Lobe lobe, Rgb color, Rgb second, float weight, float normal, float grazing) {
    s->lobe = lobe;
    s->f0 = rgb_scale(color, weight);
    s->f90 = rgb_scale(rgb(lobe_second(&s->lobe, color.r, second.r), lobe_second(&s->lobe, color.g, second.g),
                           lobe_second(&s->lobe, color.b, second.b)),
                       weight);
    s->normal = rgb_max3(s->f0) + rgb_max3(s->f90) > 0.0f ? max(normal, 1e-30f) : 0.0f;
    s->grazing = grazing;
}

/* Works as slot_make, for a lobe of about the same albedo in all directions. */
FN void slot_even(Slot *s, Lobe lobe, Rgb color, Rgb second, float weight) {
    slot_make(s, lobe, color, second, weight, weight * rgb_mean(color), weight * rgb_mean(color));
}

/* Takes the glass out, whose light then stays with the lobes below the interface. */
FN void stack_without_glass(Stack *m) {
    m->glass = 0.0f;
    m->glass_taken = 0.0f;
    m->glass_tint = rgb_grey(0.0f);
    m->glass_p = 0.0f;
}

FN void stack_clear(Stack *m) {
    SLOTS(CLEAR_SLOT)
    m->base_fresnel = BASE_FRESNEL_NONE;
    m->interface_f0 = rgb_grey(0.0f);
    m->interface_f90 = 0.0f;
    m->extra_f0 = rgb_grey(0.0f);
    m->extra_f90 = rgb_grey(0.0f);
    m->extra_f_quadratic = rgb_grey(0.0f);
    m->gloss = 0.0f;
    m->view = VIEW_NONE;
    m->coat_rule = COAT_BARE;
    m->coat_weight = 0.0f;
    m->coat_f0 = 0.04f;
    m->has_fuzz = false;
    m->sheen_over_coat = false;
    m->retro = 0.0f;
    m->dust_amount = 0.0f;
    m->transmission = 0.0f;
    m->transmitted = rgb_grey(0.0f);
    m->transmitted_p = 0.0f;
    stack_without_glass(m);
    m->glass_lost = 0.0f;
    m->layer = LAYER_ADDITIVE;
    m->combine = LAYER_BY_MAX;
    m->color = rgb_grey(0.0f);
    m->sheen_color = rgb_grey(0.0f);
    m->amount = 0.0f;
    m->albedo = ALBEDO_TABLE;
    m->table.texels = TABLE_OF_NOTHING;
    m->table.kind = TABLE_NONE;
    m->table.rows = 0;
    m->table.columns = 0;
    m->table.low = 0.0f;
    m->table.high = 0.0f;
    m->table.tilts = 0;
    m->table.tilt = 0.0f;
    m->nap = nap_of(0.0f, dir(1.0f, 0.0f, 0.0f));
    m->albedo_coord = 0.0f;
    m->rows = table_taps(0.0f, 4);
    m->e_avg = sheen_e_of(0.0f);
    m->coat_x = dir(1.0f, 0.0f, 0.0f);
    m->coat_y = dir(0.0f, 1.0f, 0.0f);
    m->coat_z = dir(0.0f, 0.0f, 1.0f);
}
/* Sets the frame about the coat's own normal. Any x serves an isotropic coat. Tom Duff et al., "Building an Orthonormal
 * Basis, Revisited", JCGT 6(1), 2017. */
FN void stack_coat_frame(Stack *m, Dir n) {
    float a = -1.0f / (1.0f + n.z), b = n.x * n.y * a;
    m->coat_x = dir(1.0f + n.x * n.x * a, b, -n.x);
    m->coat_y = dir(b, 1.0f + n.y * n.y * a, -n.y);
    m->coat_z = n;
}
FN Dir stack_to_coat(const Stack *m, Dir w) {
    return dir(dir_dot(w, m->coat_x), dir_dot(w, m->coat_y), dir_dot(w, m->coat_z));
}

/* Returns what the specular interface lets through of glass at normal incidence. */
FN float stack_glass_facing(const Stack *m) {
    float facing = 0.0f;
    if (HAS_GLASS(m)) facing = max(rgb_mean(m->glass_tint) * (1.0f - rgb_max3(m->interface_f0)), 0.0f);
    return facing;
}

/* Takes the transmitted shares from the diffuse slot, after its lobe is chosen. Samples are divided by what is
 * reflected and what is transmitted; so a black lobe that transmits keeps its slot. */
FN void stack_split_diffuse(Stack *m) {
    if (!HAS_TRANSMITTED(m)) return;
    float kept = (1.0f - m->transmission) * (1.0f - m->glass_taken), through = rgb_mean(m->transmitted);
    float facing = max(through * (1.0f - rgb_max3(m->interface_f0)), 0.0f), clear = stack_glass_facing(m);
    float least = m->diffuse.normal + through + clear > 0.0f ? 1e-30f : 0.0f;
    m->diffuse.f0 = rgb_scale(m->diffuse.f0, kept);
    m->diffuse.f90 = rgb_scale(m->diffuse.f90, kept);
    m->diffuse.normal = max(kept * m->diffuse.normal + facing + clear, least);
    through = through + rgb_mean(m->glass_tint);
    m->diffuse.grazing = kept * m->diffuse.grazing + max(through * (1.0f - m->interface_f90), 0.0f);
    m->transmitted_p = min(facing / max(m->diffuse.normal, 1e-30f), 1.0f);
    m->glass_p = min(clear / max(m->diffuse.normal, 1e-30f), 1.0f - m->transmitted_p);
}

/* Prepares the lobes, after their parameters are set. */
#define PREPARE_SLOT(name, NAME, Name, wo)                                                                             \
    if (HAS_##NAME(m)) IN_SLOT(name, prepare)(&m->name.lobe, &m->name##_prepared);
FN void stack_prepare_lobes(Stack *m){SLOTS(PREPARE_SLOT)}

/* Computes the view of each lobe whose horizon wo is above. It may be below that of a coat with its own normal. */
#define VIEW_SLOT(name, NAME, Name, wo)                                                                                \
    if (HAS_##NAME(m) && w->wo.z > 0.0f) {                                                                             \
        IN_SLOT(name, view)(m->name.lobe.id, &m->name##_prepared, &w->wo, &w->name##_view);                            \
    }
FN void stack_view_lobes(const Stack *m, StackView *w){SLOTS(VIEW_SLOT)}

/* The colours of a slot seen from wo, without its scale: F = f0 (1 - s) + f90 s - f_quadratic s (1 - s). */
STRUCT(SlotColors) {
    Rgb f0, f90, f_quadratic;
};
FN SlotColors slot_colors(const Slot *s) {
    SlotColors c;
    c.f0 = s->f0;
    c.f90 = s->f90;
    c.f_quadratic = rgb_grey(0.0f);
    return c;
}
FN SlotColors stack_specular_colors(const Stack *m, const StackView *w) {
    SlotColors c = slot_colors(&m->specular);
    if (HAS_EXTRA_F(m)) {
        c.f0 = rgb_add(c.f0, rgb_scale(m->extra_f0, w->extra));
        c.f90 = rgb_add(c.f90, rgb_scale(m->extra_f90, w->extra));
        c.f_quadratic = rgb_scale(m->extra_f_quadratic, w->extra);
    }
    return c;
}

/* Returns F of the specular interface in each channel, at the cosine d. */
FN Rgb stack_fresnel(const Stack *m, const StackView *w, float d) {
    float s = m->base_fresnel == BASE_FRESNEL_GAUSSIAN ? schlick_gaussian_s(d) : schlick_s(d);
    return rgb_mix(w->interface_f0, rgb_grey(w->interface_f90), s);
}

/* 1 - F, not below 0. */
FN Rgb stack_one_minus(Rgb f) { return rgb(max(1.0f - f.r, 0.0f), max(1.0f - f.g, 0.0f), max(1.0f - f.b, 0.0f)); }

/* Returns what the specular interface lets through to the diffuse lobe. base_fresnel is not NONE. */
FN Rgb stack_base_transmittance(const Stack *m, const StackView *w, const Angles *a) {
    if (m->base_fresnel != BASE_FRESNEL_LEAST) return stack_one_minus(stack_fresnel(m, w, a->d));
    float s = schlick_s(min(a->d, min(a->o.z, a->i.z)));
    return rgb_grey(max(1.0f - mix(rgb_max3(w->interface_f0), w->interface_f90, s), 0.0f));
}

/* Returns what the specular interface lets through to diffuse and sheen if IS_BELOW_F: 1 - F, by Schlick between the
 * two colours of the specular slot, even of a metal. Rule seed takes F at wi . h in each channel; side-by-side takes
 * F of the strongest channel at the least of wi . h, cos_o and cos_i. s: schlick_s of that cosine. */
FN Rgb stack_interface_at(const Stack *m, const StackView *w, float s) {
    SlotColors c = stack_specular_colors(m, w);
    Rgb f = rgb_mix(c.f0, c.f90, s);
    if (m->layer == LAYER_SIDE_BY_SIDE) f = rgb_grey(rgb_max3(f));
    if (!HAS_SPECULAR(m)) f = rgb_grey(0.0f);
    return stack_one_minus(f);
}
FN Rgb stack_interface_transmittance(const Stack *m, const StackView *w, const Angles *a) {
    float cosine = m->layer == LAYER_SEED ? a->d : min(a->d, min(a->o.z, a->i.z));
    return stack_interface_at(m, w, schlick_s(cosine));
}

/* Returns the layer rule's factor on the base, for one channel c of the sheen's colour. */
FN float stack_base_scale_of(const Stack *m, const StackView *w, float c, SheenE e_i) {
    return layer_base(m->layer, c, sheen_e_in(w->e_o, c), sheen_e_in(e_i, c), sheen_e_in(m->e_avg, c));
}
FN Rgb stack_base_scale(const Stack *m, const StackView *w, SheenE e_i) {
    if (m->layer == LAYER_SEED) return rgb_grey(layer_base(m->layer, m->amount, 0.0f, 0.0f, 0.0f));
    if (m->combine == LAYER_BY_CHANNEL)
        return rgb(stack_base_scale_of(m, w, m->color.r, e_i), stack_base_scale_of(m, w, m->color.g, e_i),
                   stack_base_scale_of(m, w, m->color.b, e_i));
    return rgb_grey(stack_base_scale_of(m, w, rgb_max3(m->color), e_i));
}
