/* profile.h - the lists of workflows and of engine profiles, and the one that a surface's choices name
 *
 * Adding a profile: one file in profiles/, its #include and one line in WEFT_PROFILES. */
#ifndef WEFT_SHADING_PROFILE_H
#define WEFT_SHADING_PROFILE_H

#include "shading/workflows/cloth.h"
#include "shading/workflows/disney.h"
#include "shading/workflows/free.h"
#include "shading/workflows/metallic.h"
#include "shading/workflows/specular.h"

/* W(id, index, stack, help) */
#define WEFT_WORKFLOWS(W)                                                                                    \
    W("metallic", 0, metallic_stack(s, o), "base colour, metalness, roughness: glTF's")                      \
    W("specular", 1, specular_stack(s, o), "diffuse colour, specular colour, roughness")                     \
    W("disney", 2, disney_stack(s, o),                                                                       \
      "the principled BRDF of 2012 with its ten parameters and base colour")                                 \
    W("cloth", 3, cloth_stack(s, o), "a sheen over a diffuse colour, no highlight")                          \
    W("free", 4, free_stack(s, o), "diffuse + D V F + sheen, nothing takes from anything")

/* P(id, index, stack, help); none: the workflow. */
#define WEFT_PROFILES(P) P("none", 0, metallic_stack(s, o), "weft's own: the workflow")

/* Closed forms that engines use for E: A(name, source, formula). */
#define WEFT_ALBEDO_FORMULAS(A)

#define PROFILE_CASE(id, index, stack, help)                                                                 \
    if (c.profile == index) return stack;
#define WORKFLOW_CASE(id, index, stack, help)                                                                \
    if (c.workflow == index) return stack;
FN Stack compose_begin(Surface s, Choices c, Dir o) {
    if (c.profile > 0) {
        WEFT_PROFILES(PROFILE_CASE)
    }
    WEFT_WORKFLOWS(WORKFLOW_CASE)
    return metallic_stack(s, o);
}

#endif
