/* stack.h - a material at one point: dust over a coat over a sheen over a specular and a diffuse lobe
 *
 *   f cos = dust + dust_keep (coat + sheen_keep sheen + base_keep (specular + under diffuse))
 *   pdf   = sum pick_k pdf_k,  sum pick_k = 1
 *
 * What a slot weighs and how likely sampling picks it is known from wo alone. What depends on wi too - what
 * the layer rule leaves for the base, what the specular interface leaves for the diffuse lobe - changes f and
 * not the proposal, so that sampling and pdf agree exactly. */
#ifndef WEFT_SHADING_STACK_H
#define WEFT_SHADING_STACK_H

#include "shading/layer.h"
#include "shading/registry.h"
#include "shading/rgb.h"
#include "shading/table.h"
#include "shading/terms/f_schlick.h"
#include "shading/terms/f_schlick_gaussian.h"

STRUCT(Slot) {
    Lobe lobe;
    Rgb f0, f90; /* the lobe's colours times its weight; of a tinted one the second is the weight alone */
    Rgb sag;     /* of F = f0 (1 - s) + f90 s - sag s (1 - s): 0 but where F enters squared */
    float pick;  /* probability that sampling chooses it; 0: there is no lobe */
};

/* How the specular interface dims the diffuse lobe: not; by F at wi . h, as glTF has it; by F at the least of
 * wi . h, cos_o and cos_i, which never gains energy; or by F at wi . h as f_schlick_gaussian has it. */
#define UNDER_NONE     0
#define UNDER_HALF     1
#define UNDER_LEAST    2
#define UNDER_GAUSSIAN 3

/* Where the E of the sheen comes from: a table of the lobe's own, which ALBEDO_KHRONOS reads too, or what an
 * engine takes for it (profile.h). */
#define ALBEDO_TABLE     0
#define ALBEDO_KHRONOS   1
#define ALBEDO_THREE     2
#define ALBEDO_FILAMENT  3
#define ALBEDO_BABYLON   4
#define ALBEDO_MATERIALX 5

STRUCT(Stack) {
    Slot diffuse, specular, sheen, coat, dust;
    int under;
    Rgb under_f0;
    float under_f90;
    float left; /* of what comes from below dust and coat, 1 without them */
    int layer, by;
    Rgb color;       /* of the sheen, as the layer rule sees it */
    Rgb sheen_color; /* times its weight, for a lobe that is chosen in its place */
    float amount;    /* k of layer rule seed */
    int albedo;      /* source of E */
    TableRef table;
    Nap nap;                    /* of the sheen */
    float at;                   /* the parameter with which E is asked for */
    SheenE e_o, e_avg;          /* E of the white sheen towards wo, and on cosine average */
    Dir coat_x, coat_y, coat_z; /* the coat's frame, in the shading frame */
};

/* Some of the five. */
STRUCT(Slots) { bool diffuse, specular, sheen, coat, dust; };

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

/* Whether a slot holds a lobe, and whether a layer rule has a sheen to see. A shader, which knows what its
 * slots may hold, says so in place of these: what holds nothing then adds nothing. */
#ifndef HAS_DIFFUSE
#define HAS_DIFFUSE(m)  ((m)->diffuse.pick > 0.0f)
#define HAS_SPECULAR(m) ((m)->specular.pick > 0.0f)
#define HAS_SHEEN(m)    ((m)->sheen.pick > 0.0f)
#define HAS_COAT(m)     ((m)->coat.pick > 0.0f)
#define HAS_DUST(m)     ((m)->dust.pick > 0.0f)
#define IS_WORN(m)      ((m)->color.r + (m)->color.g + (m)->color.b > 0.0f)
#endif

/* Whether the rule lays the interface of the base over the sheen too: it asks for no E. */
#define IS_BELOW_F(m) (m->layer == LAYER_SEED || m->layer == LAYER_SIDE_BY_SIDE)

/* Whether what a slot reflects is looked at. A shader that shows a part of the light says so; what the others
 * do to that part stays. */
#ifndef SHOWS_DIFFUSE
#define SHOWS_DIFFUSE  true
#define SHOWS_SPECULAR true
#define SHOWS_SHEEN    true
#define SHOWS_COAT     true
#define SHOWS_DUST     true
#endif

FN void slot_clear(Slot *s) {
    s->lobe = lobe_default(LOBE_LAMBERT);
    s->f0 = rgb_grey(0.0f);
    s->f90 = s->f0;
    s->sag = s->f0;
    s->pick = 0.0f;
}

/* A lobe of a colour and, where it has two, of a second one; `share` is about what it reflects towards wo. */
FN void slot_make(Slot *s, Lobe lobe, Rgb color, Rgb second, float weight, float share) {
    s->lobe = lobe;
    s->f0 = rgb_scale(color, weight);
    s->f90 = rgb_scale(rgb(lobe_second(&s->lobe, color.r, second.r), lobe_second(&s->lobe, color.g, second.g),
                           lobe_second(&s->lobe, color.b, second.b)),
                       weight);
    s->sag = rgb_grey(0.0f);
    s->pick = rgb_max3(s->f0) + rgb_max3(s->f90) > 0.0f ? max(share, 1e-3f) : 0.0f;
}

/* Behind what lets that share through. */
FN void slot_dim(Slot *s, float share) {
    s->f0 = rgb_scale(s->f0, share);
    s->f90 = rgb_scale(s->f90, share);
    s->sag = rgb_scale(s->sag, share);
    s->pick = s->pick * share;
}

FN void stack_clear(Stack *m) {
    slot_clear(&m->diffuse);
    m->specular = m->diffuse;
    m->sheen = m->diffuse;
    m->coat = m->diffuse;
    m->dust = m->diffuse;
    m->under = UNDER_NONE;
    m->under_f0 = rgb_grey(0.0f);
    m->under_f90 = 0.0f;
    m->left = 1.0f;
    m->layer = LAYER_ADDITIVE;
    m->by = LAYER_BY_MAX;
    m->color = rgb_grey(0.0f);
    m->sheen_color = m->color;
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
    m->at = 0.0f;
    m->e_o = sheen_e_of(0.0f);
    m->e_avg = m->e_o;
    m->coat_x = dir(1.0f, 0.0f, 0.0f);
    m->coat_y = dir(0.0f, 1.0f, 0.0f);
    m->coat_z = dir(0.0f, 0.0f, 1.0f);
}

/* The frame about the coat's own normal; which way x points does not matter to an isotropic coat. Tom Duff et
 * al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. */
FN void stack_coat_frame(Stack *m, Dir n) {
    float a = -1.0f / (1.0f + n.z), b = n.x * n.y * a;
    m->coat_x = dir(1.0f + n.x * n.x * a, b, -n.x);
    m->coat_y = dir(b, 1.0f + n.y * n.y * a, -n.y);
    m->coat_z = n;
}
FN Dir stack_to_coat(const Stack *m, Dir w) {
    return dir(dir_dot(w, m->coat_x), dir_dot(w, m->coat_y), dir_dot(w, m->coat_z));
}

FN float slot_pdf(const Slot *s, LobeValue v) { return s->pick * v.pdf; }

FN Rgb slot_f(const Slot *s, LobeValue v) {
    Rgb f = rgb(lobe_color(v, s->f0.r, s->f90.r), lobe_color(v, s->f0.g, s->f90.g),
                lobe_color(v, s->f0.b, s->f90.b)),
        sag = rgb_scale(s->sag, -share_plain(v.s) * (1.0f - share_plain(v.s)));
    return rgb_scale(rgb_add(f, sag), v.f);
}

/* F of the specular interface, each channel. */
FN Rgb stack_fresnel(const Stack *m, float d) {
    float s = m->under == UNDER_GAUSSIAN ? schlick_gaussian_s(d) : schlick_s(d);
    return rgb_mix(m->under_f0, rgb_grey(m->under_f90), s);
}

FN Rgb stack_under(const Stack *m, Angles a) {
    Rgb f = rgb_grey(0.0f);
    if (m->under == UNDER_HALF || m->under == UNDER_GAUSSIAN) f = stack_fresnel(m, a.d);
    if (m->under == UNDER_LEAST) f = rgb_grey(rgb_max3(stack_fresnel(m, min(a.d, min(a.o.z, a.i.z)))));
    return rgb(max(1.0f - f.r, 0.0f), max(1.0f - f.g, 0.0f), max(1.0f - f.b, 0.0f));
}

/* For the rules whose interface lies over diffuse and sheen, what it lets through: 1 - F of whatever the
 * specular slot is, metal too, by schlick between its two colours. seed: at wi . h, each channel.
 * side-by-side: of the strongest channel at the least of the three cosines. s: schlick_s there. */
FN Rgb stack_let_by(const Stack *m, float s) {
    Rgb f = rgb_scale(rgb_mix(m->specular.f0, m->specular.f90, s), 1.0f / max(m->left, 1e-6f));
    if (m->layer == LAYER_SIDE_BY_SIDE) f = rgb_grey(rgb_max3(f));
    if (!HAS_SPECULAR(m)) f = rgb_grey(0.0f);
    return rgb(max(1.0f - f.r, 0.0f), max(1.0f - f.g, 0.0f), max(1.0f - f.b, 0.0f));
}
FN Rgb stack_let_through(const Stack *m, Angles a) {
    float cosine = m->layer == LAYER_SEED ? a.d : min(a.d, min(a.o.z, a.i.z));
    return stack_let_by(m, schlick_s(cosine));
}

/* What the sheen leaves of the base, by one channel of its colour. */
FN float stack_keep_by(const Stack *m, float c, SheenE e_i) {
    return layer_base(m->layer, c, sheen_e_in(m->e_o, c), sheen_e_in(e_i, c), sheen_e_in(m->e_avg, c));
}
FN Rgb stack_keep(const Stack *m, SheenE e_i) {
    if (m->layer == LAYER_SEED) return rgb_grey(layer_base(m->layer, m->amount, 0.0f, 0.0f, 0.0f));
    if (m->by == LAYER_BY_CHANNEL)
        return rgb(stack_keep_by(m, m->color.r, e_i), stack_keep_by(m, m->color.g, e_i),
                   stack_keep_by(m, m->color.b, e_i));
    return rgb_grey(stack_keep_by(m, rgb_max3(m->color), e_i));
}

#endif
