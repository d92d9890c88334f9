/* stack.h - a material at one point: lobes with weights known from wo alone, so that sampling and pdf agree
 * exactly
 *
 *   f cos   = sum_k weight_k f_k cos_k
 *   pdf     = sum_k pick_k pdf_k,   sum_k pick_k = 1
 *
 * The diffuse lobe is dimmed by what the interface above it reflects, which depends on wi too: it changes f,
 * not the proposal. */
#ifndef WEFT_SHADING_STACK_H
#define WEFT_SHADING_STACK_H

#include "shading/registry.h"

enum { STACK_MAX = 4 };

typedef struct StackLobe {
    Lobe lobe;
    Rgb f0, f90; /* colour times weight; equal where the lobe has no Fresnel term */
    float pick;  /* probability that sampling chooses it */
    bool coat;   /* works in the coat's frame */
} StackLobe;

typedef struct Stack {
    int count;
    StackLobe lobes[STACK_MAX];
    float under_f0, under_f90;  /* of the interface above the diffuse lobe */
    Dir coat_x, coat_y, coat_z; /* coat frame, in the shading frame */
} Stack;

typedef struct StackValue {
    Rgb f_cos; /* f times the cosine of wi */
    float pdf; /* of stack_sample, 1/sr */
} StackValue;

StackValue stack_eval(const Stack *stack, Dir o, Dir i);

/* A wi for (u, v) in [0, 1)^2; below the horizon where there is no sample. */
Dir stack_sample(const Stack *stack, Dir o, float u, float v);

#endif
