/* surface.h - the inputs of a material at one point, as plain numbers; and the stack of lobes they mean */
#ifndef WEFT_SHADING_SURFACE_H
#define WEFT_SHADING_SURFACE_H

#include "shading/albedo.h"
#include "shading/inputs.h"
#include "shading/stack.h"

typedef float SurfaceSCALAR;
typedef Rgb SurfaceCOLOR;
typedef Dir SurfaceNORMAL, SurfaceDIRECTION;

typedef struct Surface {
#define SURFACE_FIELD(kind, name, def, low, high, hard_low, hard_high, help) Surface##kind name;
    SURFACE_INPUTS(SURFACE_FIELD)
#undef SURFACE_FIELD
} Surface;

/* Fills stack with the metallic workflow and the extensions of glTF, seen from wo (shading frame, z > 0):
 *
 *   f      = coat + (1 - coat_F) (sheen + A base)
 *   base   = (1 - max3 F_min) (1 - metallic) base_color / pi + D V F
 *   F      = f0 (1 - s) + f90 s,  s = (1 - wi . h)^5
 *   f0     = mix(min(((ior - 1) / (ior + 1))^2 specular_color, 1) specular, base_color, metallic)
 *   coat_F = clearcoat (0.04 + 0.96 (1 - cos_o)^5)
 *   A      = what the layer rule leaves for the base under the sheen
 *
 * Khronos Group, "glTF 2.0 Specification", 2021, Appendix B; KHR_materials_specular, _ior, _clearcoat,
 * _sheen, _anisotropy. sheen is any lobe of the catalogue; sheen_e holds its E (may be NULL when sheen_color
 * is black).
 *
 * Departure: F_min, which dims the diffuse lobe, is that of a dielectric at the least of wi . h, cos_o and
 * cos_i. With wi . h alone, as glTF has it, a smooth white dielectric reflects up to 1.45 times what it
 * receives at grazing; so it never passes 1 (tests/shading/test_furnace). */
void surface_stack(Stack *stack, const Surface *surface, Dir wo, LobeId sheen, int layer,
                   const AlbedoTable *sheen_e);

#endif
