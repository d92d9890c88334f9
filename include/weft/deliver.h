/* deliver.h - a glTF file for one viewer: matched to what it shades, and without the extensions that it ignores */
#ifndef WEFT_DELIVER_H
#define WEFT_DELIVER_H

#include "weft/match.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A program that shows glTF files without a plug-in. */
typedef struct WeftTarget {
    const char *name, *help; /* such as "three", and a line on it; live as long as the program */
    const char *profile;     /* of weft_profile_name, which shades as the program does */
    int levels;              /* not 0: it reads KHR_texture_basisu by what it comes with */
    const char *fit; /* the one that baked cloth is fitted by: it has stretched highlights where the program does */
} WeftTarget;

/* Fills in the target at index, and returns 1; returns 0 past the end. */
WEFT_API int weft_target_info(int index, WeftTarget *out);

/* A material of a delivered file, measured without its normal map and with the means of its other textures. */
typedef struct WeftDelivered {
    char name[64];   /* of the material, truncated */
    WeftMatch found; /* distance of the original's numbers, and of those delivered, from the original */
    /* light that the material returns under an even sky of all directions, over what the original returns, less 1:
     * the mean of the channels */
    double even_sky;
} WeftDelivered;

/* The outcome for a target. */
typedef struct WeftDelivery {
    WeftDelivered *materials; /* material_count of them */
    int material_count;       /* of the file */
    char *extensions;         /* those that the written file uses, UTF-8, a line each; owned */
    WeftLosses losses;        /* things of the original that the target does not show, by its materials */
} WeftDelivery;

/* Converts the glTF file at `path` for a target, by its index, and writes it to `out`, a .glb or .gltf. `from` is the
 * profile that the file was made for, -1: as weft draws it, with what extras.weft holds. Extensions of materials that
 * the target does not read are taken out, and so is extras.weft; then the factors that remain (those of
 * weft_match_asset) are searched for what comes closest to the original. An index of refraction that has to go
 * becomes a specular colour. All else stays as it is. progress (may be NULL) can stop the work: WEFT_INTERRUPTED; `out`
 * may then exist, and is of no use. *delivery (delivery may be NULL) is released with weft_delivery_free. Fails with
 * WEFT_MESSAGE_DESC (no such target or profile), WEFT_MESSAGE_GLTF_EXTENSION (KHR_materials_pbrSpecularGlossiness, for
 * a target that does not read it), and as weft_match_asset does. */
WEFT_API WeftResult weft_deliver(const char *path, const char *out, int from, int target, WeftBrdfMetric metric,
                                 WeftProgress progress, void *user, WeftDelivery *delivery, const WeftLog *log,
                                 WeftError *error);

/* Gives materials of the glTF file at `path` whose normal map is fine mip levels of their own, and writes it to `out`, which
 * may be the same. Means of normals are flat, so that from afar highlights would be narrower than they are: in the levels
 * after the first the roughness widens with the slopes s that a level has no texels for,
 *
 *   alpha'^2 = mean of alpha^2 + 2 scale^2 (E s^2 - (E s)^2) / 2,  alpha = roughness^2
 *
 * (Marc Olano, Dan Baker, "LEAN Mapping", I3D 2010, for one width). Only where the deviation of slopes exceeds
 * WEFT_FINE_SLOPES, sides are multiples of 4, and a map of roughness has the place of the normal map and is no finer, or
 * there is none. Materials share maps that are equal at all levels; images that nothing names any more stay. Both
 * maps then are KTX 2 files by KHR_texture_basisu, with PNGs beside, and delivery (may be NULL), which weft_deliver filled for
 * the file, lists that among its extensions. *count (may be NULL): materials that were changed; if none, `out` is written as
 * it was. Fails as reading and writing a file do. */
#define WEFT_FINE_SLOPES 0.15
WEFT_API WeftResult weft_deliver_levels(const char *path, const char *out, WeftDelivery *delivery, int *count,
                                        WeftError *error);

/* Releases what a delivery owns. delivery may be NULL. */
WEFT_API void weft_delivery_free(WeftDelivery *delivery);

#ifdef __cplusplus
}
#endif

#endif
