/* kind_slot.h - the functions of a slot whose lobe is fixed, in place of those of slots.h */
#pragma once

#define SHEEN_KIND(m)  TABLE_ROOTS
#define SHEEN_TILTS(m) 0
#define FN_NOINLINE    FN /* no loop of vectors has a call */
#include "shading/catalogue/registry.h"

#define OF_SLOT(Name, Record)   Name##Record
#define IN_SLOT(name, function) name##_##function

/* The functions of dispatch.gen.h for one lobe. */
#define KIND_HOLDS(slot, Slot, name, Name, NAME)                                                                       \
    typedef Name##Prepared Slot##Prepared;                                                                             \
    typedef Name##View Slot##View;                                                                                     \
    enum { slot##_lobe = LOBE_##NAME };                                                                                \
    FN void slot##_prepare(const Lobe *m, Slot##Prepared *p) { name##_prepare(name##_of(m), p); }                      \
    FN void slot##_view(int id, const Slot##Prepared *p, const Dir *o, Slot##View *w) { name##_view(p, *o, w); }       \
    FN void slot##_reflect(int id, const Slot##Prepared *p, const Slot##View *w, const Angles *a, const Rgb *f0,       \
                           const Rgb *f90, LobeReflected *s) {                                                         \
        LobeValue v = name##_value(p, w, *a);                                                                          \
        bool one = (NAME##_TRAITS & (TRAIT_TWO_COLORS | TRAIT_TINTED)) == 0;                                           \
        *s = one ? lobe_reflected_single(v, *f0) : lobe_reflected(v, *f0, *f90);                                       \
    }                                                                                                                  \
    FN void slot##_sample_at(int id, const Slot##Prepared *p, const Slot##View *w, const Dir *o, float u, float v,     \
                             Dir *i) {                                                                                 \
        *i = name##_sample(p, w, *o, u, v);                                                                            \
    }

/* The functions of an empty slot, which are never called. */
#define KIND_EMPTY(slot, Slot)                                                                                         \
    typedef struct Slot##Prepared {                                                                                    \
        float none;                                                                                                    \
    } Slot##Prepared;                                                                                                  \
    typedef Slot##Prepared Slot##View;                                                                                 \
    enum { slot##_lobe = -1 };                                                                                         \
    FN void slot##_prepare(const Lobe *m, Slot##Prepared *p) {}                                                        \
    FN void slot##_view(int id, const Slot##Prepared *p, const Dir *o, Slot##View *w) {}                               \
    FN void slot##_reflect(int id, const Slot##Prepared *p, const Slot##View *w, const Angles *a, const Rgb *f0,       \
                           const Rgb *f90, LobeReflected *s) {                                                         \
        *s = (LobeReflected){0};                                                                                       \
    }                                                                                                                  \
    FN void slot##_sample_at(int id, const Slot##Prepared *p, const Slot##View *w, const Dir *o, float u, float v,     \
                             Dir *i) {}
