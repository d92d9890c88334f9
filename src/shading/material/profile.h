/* profile.h - the lists of workflows and of engine profiles, and the one that a surface's choices name
 *
 * Adding a profile: one file in profiles/, its #include and one line in WEFT_PROFILES. */
#pragma once

#include "shading/lobes/ltc_fibre_half.h"
#include "shading/profiles/babylon.h"
#include "shading/profiles/babylon_openpbr.h"
#include "shading/profiles/core.h"
#include "shading/profiles/cycles_principled.h"
#include "shading/profiles/cycles_velvet.h"
#include "shading/profiles/disney_2012.h"
#include "shading/profiles/filament_cloth.h"
#include "shading/profiles/filament_sheen.h"
#include "shading/profiles/hdrp_cotton.h"
#include "shading/profiles/hdrp_silk.h"
#include "shading/profiles/khr_fuzz.h"
#include "shading/profiles/khr_fuzz_exact.h"
#include "shading/profiles/khronos.h"
#include "shading/profiles/materialx.h"
#include "shading/profiles/openpbr.h"
#include "shading/profiles/order_1886.h"
#include "shading/profiles/three.h"
#include "shading/profiles/unreal4.h"
#include "shading/profiles/urp.h"
#include "shading/workflows/cloth.h"
#include "shading/workflows/disney.h"
#include "shading/workflows/free.h"
#include "shading/workflows/metallic.h"
#include "shading/workflows/specular.h"

/* W(id, index, what fills a cleared stack, help) */
#define WEFT_WORKFLOWS(W)                                                                                              \
    W("metallic", 0, metallic_stack(m, s), "base colour, metalness, roughness: glTF's")                                \
    W("specular", 1, specular_stack(m, s), "diffuse colour, specular colour, roughness")                               \
    W("disney", 2, disney_stack(m, s), "the principled BRDF of 2012 with its ten parameters and base colour")          \
    W("cloth", 3, cloth_stack(m, s), "a sheen over a diffuse colour, no highlight")                                    \
    W("free", 4, free_stack(m, s), "diffuse + D V F + sheen, nothing takes from anything")

/* P(id, index, what fills a cleared stack, help); none: the workflow. */
#define WEFT_PROFILES(P)                                                                                               \
    P("none", 0, metallic_stack(m, s), "weft's own: the workflow")                                                     \
    P("unreal4", 1, unreal4_stack(m, s), "Unreal Engine 4.27, shading model Cloth")                                    \
    P("hdrp-cotton", 2, hdrp_cotton_stack(m, s), "Unity HDRP, Fabric: cotton and wool")                                \
    P("hdrp-silk", 3, hdrp_silk_stack(m, s), "Unity HDRP, Fabric: silk")                                               \
    P("urp", 4, urp_stack(m, s), "Unity URP with a fabric that users added")                                           \
    P("filament-cloth", 5, filament_cloth_stack(m, s), "Filament's cloth model")                                       \
    P("filament-sheen", 6, filament_sheen_stack(m, s), "Filament's lit model with a sheen")                            \
    P("khronos", 7, khronos_stack(m, s), "glTF's reference renderer")                                                  \
    P("three", 8, three_stack(m, s), "three.js 0.187, MeshPhysicalMaterial")                                           \
    P("babylon", 9, babylon_stack(m, s), "Babylon.js 9.34, PBRMaterial with albedoScaling")                            \
    P("materialx", 10, materialx_stack(m, s), "MaterialX, gltf_pbr in GLSL")                                           \
    P("cycles-velvet", 11, cycles_velvet_stack(m, s), "Blender Cycles before 4.0, Velvet over Lambert")                \
    P("disney-2012", 12, disney_2012_stack(m, s), "the BRDF Explorer's disney.brdf")                                   \
    P("order-1886", 13, order_1886_stack(m, s), "The Order: 1886, a reconstruction")                                   \
    P("openpbr", 14, openpbr_stack(m, s), "OpenPBR Surface: its fuzz, as ltc-fibre, over its base")                    \
    P("cycles-principled", 15, cycles_principled_stack(m, s), "Blender Cycles 4.0 and later, Principled: microfibres") \
    P("khr-fuzz", 16, khr_fuzz_stack(m, s), "glTF's coming fuzz as written, by the published table")                   \
    P("khr-fuzz-exact", 17, khr_fuzz_exact_stack(m, s), "the same by a table without bias")                            \
    P("core", 18, core_stack(m, s), "engines without extensions: metalness and roughness alone")                       \
    P("babylon-openpbr", 19, babylon_openpbr_stack(m, s), "Babylon.js 9.35, OpenPBRMaterial: its fuzz")

/* The formulas of engines for E: A(name, source, true if it reads the table of the lobe itself, formula). */
#define WEFT_ALBEDO_FORMULAS(A)                                                                                        \
    A(khronos, ALBEDO_KHRONOS, true, khronos_albedo(m, cosine))                                                        \
    A(three, ALBEDO_THREE, false, three_albedo(cosine, m->albedo_coord))                                               \
    A(filament, ALBEDO_FILAMENT, false, table_albedo(engine_table(ENGINE_FILAMENT_SHEEN), cosine, m->albedo_coord))    \
    A(babylon, ALBEDO_BABYLON, false, table_albedo(engine_table(ENGINE_BABYLON_SHEEN), cosine, m->albedo_coord))       \
    A(materialx, ALBEDO_MATERIALX, false, materialx_albedo(cosine, m->albedo_coord))                                   \
    A(babylon_fuzz, ALBEDO_BABYLON_FUZZ, false, ltc_fibre_half_r(cosine, m->albedo_coord))

/* The steps of engines that depend on wo: V(name, view, statement that changes a view in which nothing is
 * dimmed yet). */
#define WEFT_VIEWS(V)                                                                                                  \
    V(urp, VIEW_URP, urp_view(m, w))                                                                                   \
    V(three, VIEW_THREE, filament_view(engine_table(ENGINE_THREE_GGX), m, w))                                          \
    V(filament, VIEW_FILAMENT, filament_view(engine_table(ENGINE_FILAMENT_GGX), m, w))                                 \
    V(babylon, VIEW_BABYLON, filament_view(engine_table(ENGINE_BABYLON_GGX), m, w))                                    \
    V(materialx, VIEW_MATERIALX, materialx_view(m, w))

#define PROFILE_CASE(id, index, fill, help)                                                                            \
    if (c.profile == index) {                                                                                          \
        fill;                                                                                                          \
        return;                                                                                                        \
    }
#define WORKFLOW_CASE(id, index, fill, help)                                                                           \
    if (workflow == index) {                                                                                           \
        fill;                                                                                                          \
        return;                                                                                                        \
    }
FN void compose_begin(Stack *m, const Surface *s, Choices c) {
    workflow_begin(m, c);
    if (c.profile > 0) {
        WEFT_PROFILES(PROFILE_CASE)
    }
    int workflow = c.workflow > 0 ? c.workflow : 0; /* of the list's first where none is chosen */
    WEFT_WORKFLOWS(WORKFLOW_CASE)
}
