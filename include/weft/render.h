/* render.h - path tracing a scene: the reference picture
 *
 * Unidirectional, next-event estimation and multiple importance sampling for environment, punctual and
 * emissive-triangle lights. The same descriptor gives the same bytes on any number of threads.
 *
 * DOES: rendering without bias, except for the shading-terminator offset and the rotation of normal-mapped normals
 * towards the viewer; denoising on request, for pictures to look at. DOES NOT: refraction, volumes, clamping. */
#ifndef WEFT_RENDER_H
#define WEFT_RENDER_H

#include <stdint.h>

#include "weft/image.h"
#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The background of the scene. */
typedef enum WeftBackground {
    WEFT_BACKGROUND_AUTO = 0,    /* a uniform backdrop under the studio light, else the environment */
    WEFT_BACKGROUND_ENVIRONMENT, /* the environment that lights the scene */
    WEFT_BACKGROUND_TRANSPARENT, /* alpha 0 where there is no surface */
    WEFT_BACKGROUND_COLOR,       /* background_color, linear */
    WEFT_BACKGROUND_BLURRED      /* the environment out of focus, by about 10 degrees */
} WeftBackground;

/* A floor under the scene that only catches shadows and reflections: a horizontal disc through the lowest point of the
 * bounding box. It darkens the background by the fraction of the light, in luminance, that the scene blocks, and may
 * mirror the scene. It fades towards its rim, is invisible from below, and neither lights nor hides anything. */
typedef struct WeftFloor {
    int on;           /* not 0: there is a floor */
    float reflection; /* mirror reflectance for the scene, at any angle, in [0, 1] */
    float roughness;  /* of the mirror, as a material has it, in [0, 1] */
} WeftFloor;

/* Returns the floor that suits a scene which came with neither light nor floor, as most assets do: a matte one, under
 * the studio. It is not on (all 0) for a built-in scene, for one with a punctual, polygon or emissive light or another
 * environment than the studio, and for one that stands on a floor of its own: upward faces, within a hundredth of the
 * scene's extent of its lowest point, whose area is at least half of that of the bounding box seen from above. */
WEFT_API WeftFloor weft_scene_stage(const WeftScene *scene);

/* The strategy that finds lights; anything but MIS is for tests and teaching. */
typedef enum WeftSampling { WEFT_SAMPLING_MIS = 0, WEFT_SAMPLING_LIGHT, WEFT_SAMPLING_LOBE } WeftSampling;

/* The two ways to divide the samples of a pixel into halves, whose difference shows the error. */
enum {
    /* each half is stratified on its own: the estimate of the error is right on average, and the picture has a little
     * more noise */
    WEFT_HALVES_INDEPENDENT = 1,
    /* the samples of a picture without halves, 16 by 16 in turn: its noise is that of such a picture, and the estimate
     * of the error is too large */
    WEFT_HALVES_SHARED = 2
};

/* Zero means default, in every member. */
typedef struct WeftRenderDesc {
    int width, height; /* pixels, 1 .. 65536; 0: 960 x 720 */
    int crop[4];       /* x, y, width, height in pixels from the top left; all 0: everything */
    int max_depth;     /* scattering events on a path, 1 is direct light only; 0: 9 */
    uint32_t seed;     /* of the noise */
    int threads;       /* up to WEFT_THREADS_MAX; 0: one a processor */
    /* NULL or "auto" frames the scene; a camera's name or index; or "eye;target;fov" as "x,y,z;x,y,z;degrees"
     */
    const char *camera;
    WeftBackground background;
    float background_color[3];
    WeftSampling sampling;
    int pixel_centre; /* not 0: every camera ray goes through the middle of its pixel, no filter */
    int no_roulette;  /* not 0: paths end only at max_depth or where nothing is hit */
    /* not 0: lights and the environment reach every point that faces them, by any sampling; to compare with other
     * renderers */
    int no_shadows;
    WeftFloor floor;
    int hide_lights; /* not 0: polygon lights emit, but the camera looks through them */
    int halves; /* WEFT_HALVES_...; weft_render_denoised needs either, noise and WEFT_AOV_VARIANCE independent ones */
    int first_hits; /* not 0: albedo, normal and depth are recorded, which weft_render_denoised needs too */
    int places;     /* not 0: position and texture coordinates of the same surfaces are recorded too */
    int mattes;     /* not 0: which objects and materials a pixel shows is recorded */
    /* not 0: the light that each slot of the visible surface reflects is recorded; needs first_hits, and an environment
     * whose `ambient` and `reflection` are equal */
    int slots;
    float noise; /* weft_render_run stops when the estimated relMSE is at most this; 0: it does not */
    int stages;  /* not 0: stages are timed for weft_render_stage */
    /* not 0: light and rays meet the flat triangles and not the smooth surface that their normals describe, so that
     * coarse meshes are dark where light grazes them; to show the effect of the shading-terminator offset */
    int no_lift;
} WeftRenderDesc;

/* Writes the camera of picture `index` of `count` on a circle, as WeftRenderDesc.camera: that of eye and target, m, and fov,
 * degrees, vertical, turned about the vertical through the target, counter-clockwise seen from above. */
enum { WEFT_CAMERA_TEXT = 256 };
WEFT_API void weft_camera_rotated(const float eye[3], const float target[3], float fov, int index, int count,
                                  char text[WEFT_CAMERA_TEXT]);

/* A picture in progress. */
typedef struct WeftRender WeftRender;

/* Builds the acceleration structure, and the light and albedo tables. scene must outlive the render; it may change
 * only between runs, before a weft_render_restart that names the change. Fails with WEFT_MESSAGE_DESC, _CAMERA_NAME,
 * _SCENE_EMPTY, _MEMORY or _RENDER_DEVICE. */
WEFT_API WeftResult weft_render_create(const WeftScene *scene, const WeftRenderDesc *desc, WeftRender **out,
                                       WeftError *error);

/* The parts of the scene that changed since a render was made or last restarted, or-ed together. The environment is
 * a light; a polygon light is a shape too. */
enum { WEFT_CHANGED_MATERIALS = 1, WEFT_CHANGED_LIGHTS = 2, WEFT_CHANGED_SHAPES = 4 };

/* Discards all samples and takes another descriptor. Only what depends on `changed` is built again; a change of the
 * descriptor alone builds nothing. Fails as weft_render_create does; the render can then only be freed, or restarted
 * with all parts changed. */
WEFT_API WeftResult weft_render_restart(WeftRender *render, const WeftRenderDesc *desc, unsigned changed,
                                        WeftError *error);

WEFT_API void weft_render_free(WeftRender *render); /* may be NULL */

/* Adds up to spp samples to every pixel. Stops early when seconds (0: no limit) have passed, with WEFT_OK, or when
 * progress (may be NULL) stops it, with WEFT_INTERRUPTED. The samples are kept, and another call adds to them.
 *
 * While this runs, no other call on the render is allowed, from any thread: weft_render_info, weft_render_image and
 * their like read what it writes. */
WEFT_API WeftResult weft_render_run(WeftRender *render, int spp, double seconds, WeftProgress progress, void *user);

/* Returns how many samples every pixel has, at least. A run of the rest goes on where an interrupted one stopped. */
WEFT_API int weft_render_samples(const WeftRender *render);

/* Several processes can render one picture, and a process can go on where another stopped: the picture is made of tiles,
 * which know nothing of each other, and the sums of a tile can be copied. The result has the same bytes as one run if
 * the samples that a tile had when it was copied are a multiple of WEFT_RENDER_BLOCK, twice that of a render with
 * halves, or all that it gets, and the instruction set (weft/isa.h) is the same. */
enum {
    WEFT_RENDER_TILE = 16,  /* pixels a side; tiles are counted row by row in the crop, from the top left */
    WEFT_RENDER_BLOCK = 16, /* samples of a pixel that are traced together */
    /* Before the sums of a tile: the number of samples of a pixel in each half, and of samples that were not finite. */
    WEFT_RENDER_TILE_HEAD = 3
};

/* Returns the number of tiles. */
WEFT_API int weft_render_tile_count(const WeftRender *render);

/* Adds samples to tiles until each has spp in all, one tile after another. wanted (may be NULL: all) has a byte for each
 * tile, 0 if it is to be left alone. When progress (may be NULL) stops it, with WEFT_INTERRUPTED, another call goes on.
 * `fraction` is that of the tiles. While this runs, no other call on the render is allowed. */
WEFT_API WeftResult weft_render_tiles_run(WeftRender *render, const unsigned char *wanted, int spp,
                                          WeftProgress progress, void *user);

/* Returns how many sums each pixel of a tile has, which the descriptor decides; at most WEFT_RENDER_NUMBERS. */
enum { WEFT_RENDER_NUMBERS = 104 };
WEFT_API int weft_render_tile_numbers(const WeftRender *render);

/* Copies the sums of a tile: WEFT_RENDER_TILE_HEAD numbers, then for each of the WEFT_RENDER_TILE * WEFT_RENDER_TILE
 * pixels, row by row, weft_render_tile_numbers; pixels beyond the picture have 0. */
WEFT_API void weft_render_tile(const WeftRender *render, int tile, float *numbers);

/* Replaces the sums of a tile by those of a render of the same scene and descriptor. Fails with WEFT_MESSAGE_DESC, and
 * leaves the tile as it was, if a number is not finite, or is no number of samples where there has to be one. */
WEFT_API WeftResult weft_render_tile_set(WeftRender *render, int tile, const float *numbers, WeftError *error);

/* The progress of an image and its costs. */
typedef struct WeftRenderInfo {
    double samples_per_pixel; /* mean over the picture */
    long long rays;           /* traced so far, including shadow rays */
    long long non_finite;     /* samples that were not finite and count as black; above 0 only by a defect */
    double build_seconds;     /* of weft_render_create */
    double render_seconds;    /* spent in weft_render_run */
    float camera_eye[3], camera_target[3], camera_fov; /* what `camera` resolved to; vertical, degrees */
} WeftRenderInfo;

/* Returns the present progress and costs of a render. */
WEFT_API WeftRenderInfo weft_render_info(const WeftRender *render);

/* A stage of path tracing, and its time. */
typedef struct WeftRenderStage {
    const char *name; /* such as "camera rays" */
    double seconds;   /* of all threads since the last restart; 0 without WeftRenderDesc.stages */
    int embree;       /* not 0: spent in Embree, with the copying of rays */
} WeftRenderStage;

/* Fills in a stage by its number from 0 on; returns 0 if there is none. */
WEFT_API int weft_render_stage(const WeftRender *render, int stage, WeftRenderStage *out);

/* Makes the picture so far: F32 RGBA, linear Rec. 709 radiance, straight alpha, of the crop's size. Pixels without
 * a sample are transparent black. Release with weft_image_free. */
WEFT_API WeftResult weft_render_image(const WeftRender *render, WeftImage *out, WeftError *error);

/* Estimates from the halves the relMSE that weft_diff would report between the picture so far and a converged one: the
 * mean, over pixels and channels, of the variance over the squared picture plus 1e-2. Returns a value below 0 without
 * halves, or if a pixel has no sample in one of them. */
WEFT_API double weft_render_noise(const WeftRender *render);

/* The other pictures of a render (arbitrary output variables): means over the samples of a pixel. */
typedef enum WeftAov {
    WEFT_AOV_ALBEDO = 0, /* RGB: base color of the visible surface; 0 for the background and the floor */
    WEFT_AOV_NORMAL,     /* XYZ in the world, towards the viewer, with the normal map; 0 likewise */
    WEFT_AOV_DEPTH,      /* m along the camera's axis, over samples that hit a surface; 1e10 without any */
    WEFT_AOV_VARIANCE,   /* RGB: squared error, estimated from the halves: unbiased, but noisy */
    WEFT_AOV_SAMPLES,    /* number of samples */
    WEFT_AOV_POSITION,   /* XYZ in the world, metres, over samples that hit a surface; 0 without any */
    WEFT_AOV_UV,         /* first texture coordinates, likewise */
    WEFT_AOV_OBJECT,     /* names of objects as a Cryptomatte: id and coverage of rank 0, then of rank 1 */
    WEFT_AOV_MATERIAL,   /* names of materials likewise */
    WEFT_AOV_DIFFUSE,    /* RGB: light that the diffuse slot of the visible surface reflects or lets through */
    WEFT_AOV_SPECULAR,   /* the specular slot's likewise, a measurement included */
    WEFT_AOV_SHEEN,      /* the sheen's likewise */
    WEFT_AOV_COAT,       /* the coat's likewise */
    WEFT_AOV_DUST,       /* the light of dust likewise */
    WEFT_AOV_OTHER,      /* the rest: emission and background. The six add up to radiance times coverage */
    WEFT_AOV_COUNT
} WeftAov;

/* Returns "albedo", "normal", "depth", "variance", "samples", "position", "uv", "object", "material", "diffuse",
 * "specular", "sheen", "coat", "dust" or "other"; NULL beyond. */
WEFT_API const char *weft_aov_name(int aov);

/* Switches on in a descriptor what AOVs need to be recorded: a set of 1 << WEFT_AOV_ALBEDO and so on. */
WEFT_API void weft_render_record(WeftRenderDesc *desc, unsigned aovs);

/* Makes one of them from the samples so far: F32 of 1 to 4 channels. Fails with WEFT_MESSAGE_DESC if the descriptor
 * lacks what it needs, or with _MEMORY. */
WEFT_API WeftResult weft_render_aov(const WeftRender *render, WeftAov aov, WeftImage *out, WeftError *error);

/* AOVs as channels and attributes of an .exr, for WeftImageWriting. Objects and materials are Cryptomattes of six ranks
 * (version 1.2.0 of their specification) with a manifest, named CryptoObject and CryptoMaterial. */
typedef struct WeftRenderLayers {
    WeftImageLayer *layers; /* layer_count of them, owned */
    int layer_count;        /* up to WEFT_IMAGE_LAYERS */
    WeftImageText *texts;   /* text_count of them, owned: manifests of Cryptomattes */
    int text_count;         /* four for each Cryptomatte */
} WeftRenderLayers;

/* Makes the layers of a set of AOVs, 1 << WEFT_AOV_ALBEDO and so on. Release with weft_render_layers_free. Fails as
 * weft_render_aov does. */
WEFT_API WeftResult weft_render_layers(const WeftRender *render, unsigned aovs, WeftRenderLayers *out,
                                       WeftError *error);
WEFT_API void weft_render_layers_free(WeftRenderLayers *layers);

/* The denoisers. */
typedef enum WeftDenoiser {
    WEFT_DENOISER_REGRESSION = 0, /* a linear model of albedo, normal and depth about each pixel */
    WEFT_DENOISER_OIDN,           /* Intel's Open Image Denoise, where libOpenImageDenoise is installed */
    WEFT_DENOISER_COUNT
} WeftDenoiser;

/* Returns "regression" or "oidn"; NULL beyond. */
WEFT_API const char *weft_denoiser_name(int denoiser);

/* Checks, before a render begins, that a denoiser can run. Fails with WEFT_MESSAGE_DENOISER where this machine lacks
 * what it needs, or with _DESC. */
WEFT_API WeftResult weft_denoiser_check(WeftDenoiser denoiser, WeftError *error);

/* Makes the picture of weft_render_image without most of its noise. It is to look at, never to measure, since it has an
 * unknown bias. By REGRESSION the same samples give the same bytes on any number of threads. Needs halves and
 * first_hits. Fails with WEFT_MESSAGE_DESC, _MEMORY or _DENOISER. */
WEFT_API WeftResult weft_render_denoised(const WeftRender *render, WeftDenoiser denoiser, WeftImage *out,
                                         WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
