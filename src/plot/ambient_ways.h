/* ambient_ways.h - the light of a map that a lobe reflects: the reference, and the ways in which engines find it
 *
 *   way              look-up of the map                                                              times
 *   weft             the default strategy of shading/ambient/ambient_lobe.h
 *   khronos          in the mirror direction, filtered by D charlie for a view along the normal       E
 *   filament         in the mirror direction, filtered by D GGX for a view along the normal           E
 *   three            irradiance / pi of the normal                                                    E
 *   babylon          as filament                                                                      E
 *   materialx        as three                                                                         E
 *   babylon-openpbr  mean of six along the surface on the viewer's side, filtered by D GGX at roughness^2, at most the
 *                    irradiance / pi, and mixed with that by roughness^2                               min(2 R, 1)
 *
 * Sources: KhronosGroup/glTF-Sample-Renderer, ibl.glsl, and glTF-IBL-Sampler, filter.frag; google/filament,
 * light_indirect.fs, evaluateSheenIBL; mrdoob/three.js 0.187, lights_physical_pars_fragment; BabylonJS/Babylon.js 9.35,
 * pbrBlockSheen and openpbrEnvironmentLighting; MaterialX 1.39, mx_sheen_bsdf. E is the engine's own formula for lobe
 * charlie-neubelt, which is the sheen of all but khronos, else that of the lobe; R is that of lobe ltc-fibre-half at the
 * root of the roughness, which is the lobe's first parameter.
 *
 * Departures: a filter is the exact sum, where engines read levels of a cube map; the term of babylon-openpbr that
 * depends on b of its table, at most 9 % of its roughness, is left out. */
#pragma once

#include "base/vec3.h"
#include "plot/making.h"

typedef enum AmbientWay {
    WAY_WEFT = 0,
    WAY_KHRONOS,
    WAY_FILAMENT,
    WAY_THREE,
    WAY_BABYLON,
    WAY_MATERIALX,
    WAY_BABYLON_OPENPBR,
    AMBIENT_WAYS
} AmbientWay;

/* Returns the name of a way. */
const char *ambient_way_name(int way);

/* A map, prepared for sums and for weft's own way. */
typedef struct AmbientMap AmbientMap;

/* Prepares a lat-long image (NULL: the studio), which is copied; release with ambient_map_free. Fails with
 * WEFT_MESSAGE_DESC if it is no image of floats or has a value that is not finite, or WEFT_MESSAGE_MEMORY; *out is NULL then. */
WeftResult ambient_map_make(const WeftImage *image, AmbientMap **out, WeftError *error);
void ambient_map_free(AmbientMap *map);

/* A lobe under a map. */
typedef struct AmbientModel AmbientModel;

/* Prepares a lobe, which a model must be; NULL if memory is short. */
AmbientModel *ambient_model_make(const AmbientMap *map, const WeftPlotModel *model);
void ambient_model_free(AmbientModel *model);

/* Computes the light from a point of a unit sphere that is seen from afar along -z of the map: the reference, and by each
 * way. n: the normal, n.z > 0. */
void ambient_model_light(const AmbientModel *model, Vec3 n, float reference[3], float ways[AMBIENT_WAYS][3]);
