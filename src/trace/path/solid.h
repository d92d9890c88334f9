/* solid.h - solid glass at the vertices of paths: light that a rough surface bends, and what is left of it inside
 *
 *   f_t cos_i = tint (1 - F) D G1(wo) G1(wi) (wo . h) n^2 |wi . h| / (cos_o (wo . h + n wi . h)^2)
 *   h = -(wo + n wi) normalised,  n: index of refraction beyond the surface over that on the side of wo
 *   T = c^(x / d) after x metres inside
 *
 *   Bruce Walter, Stephen R. Marschner, Hongsong Li, Kenneth E. Torrance, "Microfacet Models for Refraction through Rough
 * Surfaces", EGSR 2007, Equations 16, 17 and 21; D, G1 of GGX. F is Schlick's between the two colours of the interface, at
 * the cosine on the side of air; from within all is reflected beyond the critical angle. The light that is reflected
 * outside is the stack's own, and the layers of the stack dim what goes through on either side.
 *   What single scattering between facets loses is given back in the directions of the rest: f_t from outside is scaled to
 * 1 less the reflection, f from inside to 1 (Emmanuel Turquin, "Practical Multiple Scattering Compensation for Microfacet
 * Models", Industrial Light & Magic, 2019), by a table over roughness and cos_o; facets that are stretched, by that of
 * their smaller alpha.
 *   Departures: f_t is that of energy, without the factor n^2 on radiance inside; it cancels unless a light or the camera
 * is inside. So scaled, f is not reciprocal where facets are rough. A path knows one solid at a time: what is inside of two
 * is inside of the one entered last. */
#pragma once

#include "scene/record/material.h"
#include "shading/material/material_stack.h"

/* Factors on f that give back what facets lose, from outside and from inside: over roughness and the root of cos_o, both
 * from 0 to 1. */
enum { SOLID_ROWS = 11, SOLID_COLUMNS = 25 };
typedef struct SolidTable {
    float scale[2][SOLID_ROWS][SOLID_COLUMNS];
} SolidTable;

/* Glass as it was taken from a stack. */
typedef struct SolidGlass {
    float share; /* of the light below the interface */
    Rgb tint;    /* colour of what goes through, times the share */
    float ior;
    float ax, ay;     /* of the facets */
    Rgb f0, f90;      /* colours of the highlight */
    Rgb interface_f0; /* as in the stack */
    float interface_f90;
    const SolidTable *table; /* borrowed */
} SolidGlass;

/* A stack whose glass was taken, and the glass, seen from wo. */
typedef struct SolidView {
    const SolidGlass *glass;
    const Stack *stack;
    const StackView *view;
    bool inside; /* wo is inside of the solid */
    float n;     /* as above */
    GgxPrepared facets;
    GgxView facets_view;
    float scale; /* of the table */
    float p;     /* the share of the samples that the glass draws */
} SolidView;

/* Takes the glass out of a stack, which then only reflects. surface: that of the stack. */
SolidGlass solid_take(Stack *stack, const Surface *surface, const SolidTable *table);

/* Takes the glass out of a stack as solid_take does, without a record of it. */
void solid_drop(Stack *stack);

/* Fills the table of a glass, whose own is not read: for all roughnesses if that is textured, else about its own. */
void solid_table_fill(const SolidGlass *glass, bool textured, SolidTable *table);

/* Takes the highlight out of a stack that is seen from inside: that of the glass is another one there. */
void solid_hide_highlight(Stack *stack);

/* Prepares the glass and the rest as seen from wo. view: of the stack, whose highlight is hidden (solid_hide_highlight) if
 * `inside`. Borrows its pointers. */
SolidView solid_see(const SolidGlass *glass, const Stack *stack, const StackView *view, bool inside);

/* Returns f cos and pdf of the glass alone, the pdf as part of that of all. */
StackValue solid_glass(const SolidView *view, Dir i);

/* Computes wi for (u, v) in [0, 1)^2 and a third number, of the glass or the stack. If there is no sample, wi is at the
 * horizon. */
void solid_sample(const SolidView *view, float u, float v, float third, Dir *i);

/* Returns the absorption coefficient of a material's inside, 1/m. */
Rgb solid_absorption(const Surface *surface);

/* Returns what is left of light after x metres of that absorption. */
static inline Rgb solid_left(Rgb absorption, float x) {
    return (Rgb){expf(-absorption.r * x), expf(-absorption.g * x), expf(-absorption.b * x)};
}
