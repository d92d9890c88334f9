/* map_look.h - the material that goes with the maps of a cloth, fitted so that its light is that of the threads
 *
 * Maps hold what threads are: colours, slopes, directions. A viewer shades them as a surface of facets over paint, which
 * threads are not: of one and the same numbers it makes another light. So the numbers are searched for which the mean
 * over texels is what the cloth reflects from afar. The error is the mean, over five lights and an even sky, of
 *
 *   sum |f_maps cos - f_cloth cos| / sum f_cloth cos
 *
 * over pairs of directions: those of the pixels of a ball under each light, 12, 37, 72, 95 and 128 degrees off the
 * viewer, and wi by the cosine, whose f are summed for each wo, for the sky. It is computed for texels as they are and
 * for means of 16 by 16 of them, as filtered textures have them. To it comes a term for the contrast of 4 by 4 texels
 * with each other, which nearly flat normals would lose. */
#pragma once

#include "measure/cloth/map_fit.h"
#include "weft/match.h"

/* The factors on the texels of the maps, and the numbers beside them. */
typedef struct MapLook {
    float color[3];   /* factors on the texels of base colour */
    float shade;      /* power of the light that reaches them (map_texel_color) */
    float roughness;  /* factor on those of roughness */
    float anisotropy; /* factor on the alignment of fibres */
    float normal;     /* scale of the normal map */
    float metallic, specular, sheen[3], sheen_roughness;
    MapOcclusion occlusion;
} MapLook;

/* Finds the look of maps of a cloth for viewers that shade as the profile of a fit that has begun does, and sets *found.
 * Neither means anything where the progress of the fit was stopped. */
void map_look_find(MapFit *fit, MapLook *look, WeftBaked *found);
