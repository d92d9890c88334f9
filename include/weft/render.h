/* render.h - path tracing a scene: the reference picture
 *
 * Unidirectional, next-event estimation and multiple importance sampling for environment, punctual and
 * emissive-triangle lights. The same descriptor gives the same bytes on any number of threads.
 *
 * DOES:     unbiased but for the shading-terminator offset and the bend of normal-mapped normals towards the
 * viewer; denoising on request, of a picture to look at. DOES NOT: refraction, volumes, clamping. */
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
    WEFT_BACKGROUND_AUTO = 0,    /* a plain backdrop under the studio light, else the environment */
    WEFT_BACKGROUND_ENVIRONMENT, /* what lights the scene is seen behind it */
    WEFT_BACKGROUND_TRANSPARENT, /* alpha 0 where nothing is */
    WEFT_BACKGROUND_COLOR,       /* background_color, linear */
    WEFT_BACKGROUND_BLURRED      /* the environment out of focus, by about 10 degrees */
} WeftBackground;

/* A floor under the scene, a level disc through the lowest point of its box, that is seen by what it catches
 * alone: whatever is behind it is darkened by the part of the light, in luminance, that the scene keeps from
 * it, and may be mirrored over by the scene. It fades towards its rim, is not there from below, and neither
 * lights nor hides anything. */
typedef struct WeftFloor {
    int on;           /* not 0: it is there */
    float reflection; /* share of the scene that it mirrors, at any angle; in [0, 1] */
    float roughness;  /* of the mirror, as a material has it, in [0, 1] */
} WeftFloor;

/* Which strategy finds lights; anything but MIS is for tests and teaching. */
typedef enum WeftSampling { WEFT_SAMPLING_MIS = 0, WEFT_SAMPLING_LIGHT, WEFT_SAMPLING_LOBE } WeftSampling;

/* Zero means default, in every member. */
typedef struct WeftRenderDesc {
    int width, height; /* pixels, 1 .. 65536; 0: 960 x 720 */
    int crop[4];       /* x, y, width, height in pixels from the top left; all 0: everything */
    int max_depth;     /* scattering events on a path, 1 is direct light only; 0: 9 */
    uint32_t seed;     /* another one, other noise */
    int threads;       /* 1 .. WEFT_THREADS_MAX, more are not used; 0: one a processor */
    /* NULL or "auto" frames the scene; a camera's name or index; or "eye;target;fov" as "x,y,z;x,y,z;degrees"
     */
    const char *camera;
    WeftBackground background;
    float background_color[3];
    WeftSampling sampling;
    int pixel_centre; /* not 0: every camera ray goes through the middle of its pixel, no filter */
    int no_roulette;  /* not 0: paths end only at max_depth or where nothing is hit */
    /* not 0: lights and the environment reach every point that faces them, however they are sampled; to compare with
     * other renderers */
    int no_shadows;
    WeftFloor floor;
    int hide_lights; /* not 0: polygon lights shine, but the camera looks through them */
    /* not 0: samples are two halves, independent of each other, whose difference shows the error; needed by
     * noise, WEFT_AOV_VARIANCE and weft_render_denoised. Half as many samples each are a little less even. */
    int halves;
    int first_hits; /* not 0: albedo, normal and depth are kept, which weft_render_denoised needs too */
    float noise;    /* weft_render_run stops when the estimated relMSE is at most this; 0: it does not */
    int stages;     /* not 0: the time of weft_render_stage is taken */
    /* not 0: light and rays meet the triangles and not the smooth surface that their normals describe, so that coarse
     * meshes are dark where light grazes them; to show what that is for */
    int no_lift;
} WeftRenderDesc;

/* A picture in the making. */
typedef struct WeftRender WeftRender;

/* Builds the acceleration structure, the light and albedo tables. scene must outlive the render and not
 * change meanwhile. Fails with WEFT_MESSAGE_DESC, _CAMERA_NAME, _SCENE_EMPTY, _MEMORY or _RENDER_DEVICE. */
WEFT_API WeftResult weft_render_create(const WeftScene *scene, const WeftRenderDesc *desc, WeftRender **out,
                                       WeftError *error);

/* The parts of the scene that changed since a render was made or last restarted: a sum of these. The
 * environment is a light; a polygon light is a shape too. */
enum { WEFT_CHANGED_MATERIALS = 1, WEFT_CHANGED_LIGHTS = 2, WEFT_CHANGED_SHAPES = 4 };

/* Begins again from no samples, with another descriptor; what did not change is kept: after a change of the
 * descriptor alone nothing is built. Fails as weft_render_create does; the render can then only be restarted
 * with all of them changed, or freed. */
WEFT_API WeftResult weft_render_restart(WeftRender *render, const WeftRenderDesc *desc, unsigned changed,
                                        WeftError *error);

/* render may be NULL. */
WEFT_API void weft_render_free(WeftRender *render);

/* While this runs, from whichever thread, only the progress callback's arguments may be used:
 * weft_render_info and weft_render_image read what the render writes, so they wait until it has returned.
 *
 * Adds up to spp samples to every pixel; stops early when seconds (0: no limit) have passed or progress (may
 * be NULL) says so: then WEFT_INTERRUPTED, or WEFT_OK for the time limit. What was gathered is kept and can
 * be added to by another call. */
WEFT_API WeftResult weft_render_run(WeftRender *render, int spp, double seconds, WeftProgress progress,
                                    void *user);

/* The progress of an image and its costs. */
typedef struct WeftRenderInfo {
    double samples_per_pixel; /* mean over the picture */
    long long rays;           /* traced so far, shadow rays among them */
    long long non_finite;     /* samples that were not finite and count as black; 0 but for a defect */
    double build_seconds;     /* of weft_render_create */
    double render_seconds;    /* spent in weft_render_run */
    float camera_eye[3], camera_target[3], camera_fov; /* what `camera` resolved to; vertical, degrees */
} WeftRenderInfo;

/* About a render, as it is now. */
WEFT_API WeftRenderInfo weft_render_info(const WeftRender *render);

/* A stage of following paths, and what it took. */
typedef struct WeftRenderStage {
    const char *name; /* such as "camera rays" */
    double seconds;   /* of all threads since the last restart; 0 where `stages` was not asked for */
    int embree;       /* not 0: spent in Embree, with the copying of rays */
} WeftRenderStage;

/* Fills out with a stage by its number from 0 on; returns 0 if there is none. */
WEFT_API int weft_render_stage(const WeftRender *render, int stage, WeftRenderStage *out);

/* The picture so far: F32 RGBA, linear Rec. 709 radiance, straight alpha, of the crop's size. Pixels without
 * a sample are transparent black. Release with weft_image_free. */
WEFT_API WeftResult weft_render_image(const WeftRender *render, WeftImage *out, WeftError *error);

/* The relMSE of the picture so far, as weft_diff would find it beside a perfect one, estimated from the halves: the
 * mean over pixels and channels of their variance over the square of the picture plus 1e-2. Below 0: not known,
 * without halves, or where a pixel has no sample in one of them. */
WEFT_API double weft_render_noise(const WeftRender *render);

/* The other pictures of a render (arbitrary output variables): means over the samples of a pixel. */
typedef enum WeftAov {
    WEFT_AOV_ALBEDO = 0, /* RGB: base color of the surface that is seen; 0 of the background and the floor */
    WEFT_AOV_NORMAL,     /* XYZ of the world, towards the viewer, normal map included; 0 likewise */
    WEFT_AOV_DEPTH,      /* along the camera's axis, of the samples that meet a surface; else 1e10 */
    WEFT_AOV_VARIANCE,   /* RGB: square of the error, as the halves show it: right on average, not smooth */
    WEFT_AOV_SAMPLES,    /* how many */
    WEFT_AOV_COUNT
} WeftAov;

/* "albedo", "normal", "depth", "variance" or "samples"; NULL beyond. */
WEFT_API const char *weft_aov_name(int aov);

/* One of them so far: F32 of 3 channels or 1. Fails with WEFT_MESSAGE_DESC where the descriptor did not ask for
 * what it needs, or with _MEMORY. */
WEFT_API WeftResult weft_render_aov(const WeftRender *render, WeftAov aov, WeftImage *out, WeftError *error);

/* The ways to take noise out of a picture. */
typedef enum WeftDenoiser {
    WEFT_DENOISER_REGRESSION = 0, /* a linear model of albedo, normal and depth about each pixel */
    WEFT_DENOISER_OIDN,           /* Intel's Open Image Denoise, where libOpenImageDenoise is installed */
    WEFT_DENOISER_COUNT
} WeftDenoiser;

/* "regression" or "oidn"; NULL beyond. */
WEFT_API const char *weft_denoiser_name(int denoiser);

/* Fails with WEFT_MESSAGE_DENOISER where this machine lacks what the denoiser needs, or with _DESC: so that a render is
 * not begun in vain. */
WEFT_API WeftResult weft_denoiser_check(WeftDenoiser denoiser, WeftError *error);

/* The picture so far without most of its noise, as weft_render_image has it otherwise. It is to look at, never
 * to measure: what it takes away is not known. The same samples give the same bytes on any number of threads,
 * by REGRESSION. Needs halves and first_hits. Fails with WEFT_MESSAGE_DESC, _MEMORY or _DENOISER. */
WEFT_API WeftResult weft_render_denoised(const WeftRender *render, WeftDenoiser denoiser, WeftImage *out,
                                         WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
