/* reflection.h - a BRDF behind one handle: a lobe, a material, or a measurement
 *
 * Directions, f and E are those of lobe.h. A reflection is prepared once and then asked many times; it does
 * not change, so any number of threads may ask. */
#ifndef WEFT_REFLECTION_H
#define WEFT_REFLECTION_H

#include "weft/image.h"
#include "weft/lobe.h"
#include "weft/material.h"
#include "weft/part.h"
#include "weft/weave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A model that reflects, with its tables. */
typedef struct WeftReflection WeftReflection;

/* Makes the reflection of a material, with its numbers and choices and without its textures. Dust has its
 * greatest amount. With layer rule "stochastic", light that bounced between sheen and base is in
 * WEFT_PART_ALL alone. Fails with WEFT_MESSAGE_PARAM_VALUE (not finite, or a choice that there is not) or
 * _MEMORY. Numbers are clamped as weft_scene_set does. */
WEFT_API WeftResult weft_reflection_create(const WeftMaterial *material, WeftReflection **out,
                                           WeftError *error);

/* Likewise of a woven one, as it is seen from afar: in place of its base the sum of two lobes woven, of the warp and of
 * the weft, in the mean colours of the cloth (NULL: as above). The cloth may be freed. */
WEFT_API WeftResult weft_reflection_create_woven(const WeftMaterial *material, const WeftCloth *cloth,
                                                 WeftReflection **out, WeftError *error);

/* Makes the reflection of a lobe. Fails with WEFT_MESSAGE_LOBE_NAME or _MEMORY. */
WEFT_API WeftResult weft_reflection_of_lobe(const WeftLobe *lobe, WeftReflection **out, WeftError *error);

/* Reads a measurement, whose name ends with its format's:
 *
 *   .binary  MERL: Wojciech Matusik, Hanspeter Pfister, Matt Brand and Leonard McMillan, "A Data-Driven
 *            Reflectance Model", 2003. Isotropic, linear between the middles of its bins, 0 where nothing was
 *            measured; reciprocal where phi_d has 180 bins, or all around with 360
 *   .bsdf    RGL: Jonathan Dupuy and Wenzel Jakob, "An Adaptive Parameterization for Efficient Material
 *            Acquisition and Rendering", 2018. Isotropic or not, of colours or of spectra, which are summed to
 *            colours
 *   .bin     UTIA: Jiri Filip and Radomir Vavra, "Template-Based Sampling of Anisotropic BRDFs", 2014. Linear
 *            in its four angles; beyond 75 degrees that of 75
 *
 * Any other is taken for MERL. Fails with WEFT_MESSAGE_MEASURED, _BSDF, _UTIA, _MEMORY and with what reading a
 * file can fail with. */
WEFT_API WeftResult weft_reflection_read(const char *path, WeftReflection **out, WeftError *error);

/* Returns 1 if weft_reflection_read knows the format of a file of that name, else 0. */
WEFT_API int weft_reflection_readable(const char *name);

/* The sizes of the tables of weft_reflection_write. With none given they grow until f comes back within 1e-3
 * of its mean (weft_reflection_distance), or the next ones would pass 256 MiB or the sizes below. */
typedef struct WeftBsdfDesc {
    int thetas; /* polar angles of wo, 2 .. 256; 0 beside another: 32 */
    int phis;   /* azimuths of wo, 3 .. 256, where f depends on that, over the part of the circle that is not
                   alike; 0 beside another: 17 */
    int side;   /* points along each side of the tables of one wo, 8 .. 512; 0 beside another: 64, and 32 with
                   azimuths */
    const char *comment; /* description in the file; NULL or "": a blank */
    int threads;         /* 0: one a processor; no influence on the file */
} WeftBsdfDesc;

/* Tabulates f as RGL's format has it (".bsdf"), so that whatever reads that renders it. The sampling of the
 * file is proportional to f cos_i but for the tables' steps. Fails with WEFT_MESSAGE_DESC (a number out of its
 * range, more than 2^26 points in all, or an estimate by random walks), _MEMORY, and with what writing a file
 * can fail with. */
WEFT_API WeftResult weft_reflection_write(const WeftReflection *reflection, const char *path,
                                          const WeftBsdfDesc *desc, WeftError *error);

/* Returns the mean difference of f over the mean of the first one's f, over 4096 pairs of directions up to 80
 * degrees off the normal, in three channels: evenly over the angle of wo and over the solid angle of wi. */
WEFT_API double weft_reflection_distance(const WeftReflection *reflection, const WeftReflection *other);

WEFT_API void weft_reflection_free(WeftReflection *reflection); /* may be NULL */

/* f of count directions wi towards the light, 1/sr, without the cosine; of the parts that WeftPart numbers:
 * WEFT_PART_ALL .. WEFT_PART_DUST, 0 of others. Lobes and measurements have WEFT_PART_ALL alone. wo and wi
 * are unit; 0 where one is below the horizon. */
WEFT_API void weft_reflection_eval(const WeftReflection *reflection, int part, const float wo[3], int count,
                                   const float (*wi)[3], float (*f)[3]);

/* E towards wo, whose cosine with the normal is in (0, 1]: the share of light from there that comes back, in
 * the plane of the tangent. Of a lobe as weft_lobe_albedo has it; else a sum of some thousand directions,
 * exact to about 1 %. */
WEFT_API void weft_reflection_albedo(const WeftReflection *reflection, int part, float cos_o,
                                     float albedo[3]);

/* A picture of a sphere of it, F32 RGBA, linear, transparent around, of size x size pixels (8 .. 4096): seen
 * from far away, its tangent level, under three directional lights that cast no shadow: of irradiance 2 from
 * 45 degrees off the viewer, up and to the right; 2 from 120 degrees off, left and up, behind the sphere; 0.6
 * from the viewer. No pixel is estimated: the same call has the same bytes. Fails with WEFT_MESSAGE_DESC or
 * _MEMORY. */
WEFT_API WeftResult weft_reflection_sphere(const WeftReflection *reflection, int size, WeftImage *out,
                                           WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
