/* reflection.h - a BRDF behind one handle: a lobe, a material, or a measurement
 *
 * Directions, f and E are those of lobe.h. A reflection is prepared once and then evaluated many times; it is
 * immutable, so any number of threads may evaluate it. */
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

/* A prepared BRDF with its tables. */
typedef struct WeftReflection WeftReflection;

/* Makes the reflection of a material, from its numbers and choices without its textures. Dust has its greatest
 * amount. With layer rule "stochastic", light that bounced between sheen and base is only in WEFT_PART_ALL. Numbers
 * are clamped as by weft_scene_set. Fails with WEFT_MESSAGE_PARAM_VALUE (not finite, or no such choice) or _MEMORY. */
WEFT_API WeftResult weft_reflection_create(const WeftMaterial *material, WeftReflection **out, WeftError *error);

/* Makes the reflection of a woven material as seen from afar: its base is replaced by the sum of two lobes woven, of
 * warp and weft, in the mean colours of the cloth. cloth may be NULL: then as above; it may be freed. */
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
 *            Acquisition and Rendering", 2018. Isotropic or not, in colours or in spectra, which are integrated to
 *            colours
 *   .bin     UTIA: Jiri Filip and Radomir Vavra, "Template-Based Sampling of Anisotropic BRDFs", 2014. Linear
 *            in its four angles; beyond 75 degrees the value at 75
 *
 * Any other suffix means MERL. Fails with WEFT_MESSAGE_MEASURED, _BSDF, _UTIA, _MEMORY and as reading a file does. */
WEFT_API WeftResult weft_reflection_read(const char *path, WeftReflection **out, WeftError *error);

/* Returns 1 if the suffix of the name is one of these three, else 0. */
WEFT_API int weft_reflection_readable(const char *name);

/* The sizes of the tables of weft_reflection_write. If all are 0 they grow until the file reproduces f within 1e-3 of
 * its mean (weft_reflection_distance), or the next ones would exceed 256 MiB or the limits below. */
typedef struct WeftBsdfDesc {
    int thetas; /* polar angles of wo, 2 .. 256; 0 beside a given size: 32 */
    int phis;   /* azimuths of wo, 3 .. 256, if f depends on it, over the part of the circle without symmetry;
                   0 beside a given size: 17 */
    int side;   /* points along each side of the tables of one wo, 8 .. 512; 0 beside a given size: 64, or 32 with
                   azimuths */
    const char *comment; /* description in the file; NULL or "": a blank */
    int threads;         /* 0: one a processor; no influence on the file */
} WeftBsdfDesc;

/* Tabulates f in RGL's format (".bsdf") for other renderers. The sampling of the file is proportional to f cos_i up to
 * the resolution of the tables. Fails with WEFT_MESSAGE_DESC (a number out of its range, more than 2^26 points in all,
 * or an estimate by random walks), _MEMORY, and as writing a file does. */
WEFT_API WeftResult weft_reflection_write(const WeftReflection *reflection, const char *path, const WeftBsdfDesc *desc,
                                          WeftError *error);

/* Returns the mean absolute difference of f, relative to the mean f of `reflection`, over three channels and 4096 pairs
 * of directions up to 80 degrees off the normal, uniform in the angle of wo and in the solid angle of wi. */
WEFT_API double weft_reflection_distance(const WeftReflection *reflection, const WeftReflection *other);

WEFT_API void weft_reflection_free(WeftReflection *reflection); /* may be NULL */

/* Evaluates f for count directions wi towards the light, 1/sr, without the cosine. part is a WeftPart, WEFT_PART_ALL to
 * WEFT_PART_DUST; f of others is 0. Lobes and measurements have only WEFT_PART_ALL. wo and wi are unit; f is 0 where
 * one is below the horizon. */
WEFT_API void weft_reflection_eval(const WeftReflection *reflection, int part, const float wo[3], int count,
                                   const float (*wi)[3], float (*f)[3]);

/* Computes E for wo in the plane of the tangent with cosine cos_o in (0, 1]. For a lobe it is that of
 * weft_lobe_albedo, else a sum over some thousand directions, exact to about 1 %. */
WEFT_API void weft_reflection_albedo(const WeftReflection *reflection, int part, float cos_o, float albedo[3]);

/* Draws a sphere with that reflection, F32 RGBA, linear, transparent around it, size x size pixels (8 .. 4096). It is
 * seen from far away, with a horizontal tangent, under three directional lights without shadows: irradiance 2 from 45
 * degrees off the viewer, up and to the right; 2 from 120 degrees off, left and up, behind the sphere; 0.6 from the
 * viewer. The same call gives the same bytes. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_reflection_sphere(const WeftReflection *reflection, int size, WeftImage *out,
                                           WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
