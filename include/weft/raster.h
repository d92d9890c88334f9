/* raster.h - drawing a scene with OpenGL: the models of the path tracer at the rate of a display
 *
 *   weft_raster_create(scene, &(WeftRasterDesc){0}, &raster, log, &error);
 *   weft_raster_draw(raster, &(WeftRasterView){.width = 1280, .height = 720}, &error);
 *   weft_raster_image(raster, &image, &error);
 *   weft_raster_free(raster);
 *
 * and in a window, whose context is current:
 *
 *   weft_raster_create(scene, &(WeftRasterDesc){.adopt = 1}, &raster, log, &error);
 *   weft_scene_set(scene, "cloth.sheen_color", "0.8", log, &error);
 *   weft_raster_update(raster, log, &error);
 *   weft_raster_draw(raster, &view, &error);
 *   weft_raster_show(raster, &(WeftRasterShow){.exposure = 1.0f}, &error);
 *
 * A WeftRaster belongs to one thread at a time and owns all that it makes in the driver. Either it has a
 * context of its own, and each call restores the context that was current before; or it adopts the caller's,
 * which must then be current at every call, weft_raster_free included. In an adopted context a call accepts any
 * state. It restores the bound framebuffers, the viewport and the scissor box, and leaves all other state as in a
 * new context: nothing bound, no test or blending on, pixels stored without gaps, alignment 4. No query,
 * transform feedback or conditional rendering may be active. Errors pending in the driver when a call begins are
 * dropped. Several rasters may share a context.
 *
 * DOES NOT: indirect light between surfaces, but for one bounce in sums of frames; refraction; layer rule "stochastic"
 * (drawn without its bounces). */
#ifndef WEFT_RASTER_H
#define WEFT_RASTER_H

#include "weft/image.h"
#include "weft/part.h"
#include "weft/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scene that was uploaded to a driver. */
typedef struct WeftRaster WeftRaster;

/* The kind of OpenGL: desktop 3.3 core, or ES 3.0. */
typedef enum WeftGl { WEFT_GL_DESKTOP = 0, WEFT_GL_ES } WeftGl;

/* Zero means default, in every member. */
typedef struct WeftRasterDesc {
    WeftGl gl; /* of the context it makes */
    int adopt; /* not 0: draw in the context that is current in this thread, of either kind (gl is then not
                  read): OpenGL 3.3 or ES 3.0 with float targets, or later, through EGL or GLX */
    /* A folder whose files replace the library's shader text, such as shading/lobes/ggx.h below it. Neither the
     * folder nor its files need to exist. Copied. */
    const char *shader_dir;
    int threads;   /* for tables, textures and shaders, up to WEFT_THREADS_MAX; 0: one a processor */
    int occlusion; /* rays a vertex, traced in the background, for its visibility of the sky and of the
                      environment's lights, up to 4096; 0: none */
    int no_cache;  /* not 0: the filtered environment, the tables that light lobes by it, and occlusion are
                      neither read from the user's cache nor written to it */
    /* May be NULL. Called while the environment is filtered, with the finished fraction in [0, 1]; a result
     * other than 0 stops. weft_raster_update may call it too. */
    WeftProgress progress;
    void *user;
} WeftRasterDesc;

/* Uploads the scene, which must outlive the raster; when it has changed, call weft_raster_update before any other
 * call. Shaders are compiled when they are first drawn with. log (may be NULL) receives warnings. Fails with
 * WEFT_MESSAGE_GL_CONTEXT, _GL_MEMORY, _MEMORY, _RENDER_DEVICE, _SCENE_EMPTY, or _DESC where a number is out
 * of range. */
WEFT_API WeftResult weft_raster_create(const WeftScene *scene, const WeftRasterDesc *desc, WeftRaster **out,
                                       const WeftLog *log, WeftError *error);

WEFT_API void weft_raster_free(WeftRaster *raster); /* may be NULL */

/* Uploads what changed in the scene since the last upload, after any call of weft/scene.h: materials, variants,
 * lights, the environment and its placement. The costs are:
 *
 * - a parameter: a few bytes, and tables to fit if it shapes a lobe;
 * - another term: a shader to compile at the next picture, unless the raster has it already;
 * - another environment image: filtering, with progress;
 * - a texture that was not used before: an upload of all textures;
 * - moving a light: its corners; adding or removing one: all meshes. No other shapes change;
 * - a rotated environment, or surfaces that became transparent or opaque: occlusion, in the background.
 *
 * Fails as weft_raster_create does, or with WEFT_INTERRUPTED; pictures then show a mixture of the old and the new
 * scene until an update succeeds. */
WEFT_API WeftResult weft_raster_update(WeftRaster *raster, const WeftLog *log, WeftError *error);

/* Polygon lights of a picture, unless WeftRasterView.polygons is set. */
enum { WEFT_RASTER_POLYGONS = 8 };

/* The strategy by which a lobe is lit by the environment (docs/environment.md has their errors). */
typedef enum WeftAmbient {
    WEFT_AMBIENT_BEST = 0,   /* for each lobe the one that is nearest to the path tracer */
    WEFT_AMBIENT_IRRADIANCE, /* irradiance times albedo, the cheapest */
    WEFT_AMBIENT_MIRROR,     /* one look-up in the mirror direction, as in engines */
    WEFT_AMBIENT_FITTED,     /* environment lights for bright parts, and a few look-ups fitted to the lobe */
    WEFT_AMBIENT_NONE        /* no light from the environment */
} WeftAmbient;

/* Zero means default, in every member. */
typedef struct WeftRasterView {
    int width, height;         /* pixels, 1 .. 16384; 0: 960 x 720 */
    int samples;               /* a pixel, for edges: 1, 2, 4 or 8; 0: 4. A driver may have fewer */
    const char *camera;        /* as in WeftRenderDesc */
    WeftBackground background; /* behind the scene */
    float background_color[3]; /* linear, for WEFT_BACKGROUND_COLOR */
    WeftAmbient ambient;       /* how the environment lights */
    int polygons;       /* at most so many polygon lights, the strongest; 0: WEFT_RASTER_POLYGONS, below 0: none */
    int no_shadows;     /* not 0: lights reach every point that faces them */
    WeftPart part;      /* other than all: the background is transparent */
    int crop[4];        /* x, y, width, height from the top left: nothing else is drawn; all 0: everything */
    int plain_textures; /* not 0: textures as the path tracer reads them, without smaller copies */
    WeftFloor floor;    /* only with part all */
    int hide_lights;    /* not 0: polygon lights emit, but the camera looks through them */
    int bounces;        /* 1: in a sum of frames light bounces once between surfaces; 0: not at all */
    /* Pixels along the side of a square that share a point of shading, for a picture in motion; up to 8. Outlines keep all
     * their pixels: the light of a pixel is that of the points around it on its own surface. Points of a polygon's soft
     * shadow are shared by neighbours too. 0 or 1: each pixel has a point. A part that is no light has all its points. */
    int shading_rate;
} WeftRasterView;

/* Draws one picture into the raster's own target. A shader that does not compile is an error only where there
 * is no earlier program to draw with: see WeftRasterInfo. Fails with WEFT_MESSAGE_DESC, _CAMERA_NAME,
 * _GL_COMPILE, _TEXT_DIALECT, _GL_MEMORY, _GL_CONTEXT. */
WEFT_API WeftResult weft_raster_draw(WeftRaster *raster, const WeftRasterView *view, WeftError *error);

/* Most frames of a sum. */
enum { WEFT_RASTER_FRAMES_MOST = 1 << 20 };

/* Begins a picture that is the mean of so many frames. Each frame has random samples of the light, with shadow rays
 * that a shader traces, and is moved by a fraction of a pixel: the mean converges to the path tracer's direct light
 * (max_depth 1), for every lobe and light, with smooth edges. With bounces 1 a surface is also lit by what others send
 * back of their direct light, evenly to all sides, with the colour of a triangle on the mean: about the path tracer's
 * max_depth 2, and exactly so where what is met is matt. Of the view, `ambient`, `polygons`, `no_shadows` and
 * `samples` count only for a floor. If the last picture was drawn with the same view, it counts as a few frames at
 * first. Compiles the shaders that it needs. Fails as weft_raster_draw does, with WEFT_MESSAGE_GL_MEMORY also where the
 * scene has more than about two million triangles.
 *
 * DOES NOT: the floor, which is the same as in other pictures; measured BRDFs; gaps of a woven cloth along shadow rays,
 * where they have their mean; maps of emission in mirrors, where a triangle has its mean; unlit surfaces in mirrors,
 * which are black; opacity maps beyond the first 64 along shadow rays, which are opaque; layer rule "stochastic", drawn
 * without its bounces. */
WEFT_API WeftResult weft_raster_accumulate_begin(WeftRaster *raster, const WeftRasterView *view, int frames,
                                                 WeftError *error);

/* Draws frames of the picture that was begun until all are drawn, or for so many seconds: it then returns after at
 * most a part of a frame, which is continued next time. *done: the number of frames so far. The last picture is then
 * their mean. Fails with WEFT_MESSAGE_DESC if no picture was begun, or if another was drawn or the scene was updated
 * since; else as weft_raster_draw does. */
WEFT_API WeftResult weft_raster_accumulate(WeftRaster *raster, double seconds, int *done, WeftError *error);

/* Returns 1 if a picture can be drawn with the existing programs, 0 if weft_raster_draw would compile first, which on
 * a driver without a GPU may take many seconds; show something else meanwhile. Returns 1 for a view that
 * weft_raster_draw refuses. Does not query the driver, and counts the floor even where it is not visible. */
WEFT_API int weft_raster_ready(WeftRaster *raster, const WeftRasterView *view);

/* Waits for background work, which the next picture then shows. If shapes of lights have changed, call
 * weft_raster_update before. Fails with WEFT_MESSAGE_GL_MEMORY or _MEMORY. */
WEFT_API WeftResult weft_raster_wait(WeftRaster *raster, WeftError *error);

/* Reads back the last picture: F32 RGBA, linear Rec. 709 radiance, straight alpha. Release with weft_image_free. */
WEFT_API WeftResult weft_raster_image(WeftRaster *raster, WeftImage *out, WeftError *error);

/* The way an image is shown on screen. Zero means the default, in every member. */
typedef struct WeftRasterShow {
    unsigned framebuffer; /* of the context that was adopted, and complete; 0: the window's */
    int x, y;             /* the picture's lower left corner in it, pixels */
    int width, height;    /* of the picture there, scaled by its nearest pixels; 0: as it is */
    int clip[4];          /* x, y, width, height of the part that may change; width 0: no limit */
    float background[3];  /* light of the display, linear, in [0, 1], where the picture is transparent */
    WeftTonemap tonemap;  /* before the sRGB curve */
    float exposure;       /* stops */
    float white[2];       /* as WeftTone has it */
} WeftRasterShow;

/* Shows the last picture on screen, tone-mapped and dithered as by weft_image_tonemap_over. It converts to sRGB
 * itself: under OpenGL ES the framebuffer must not do so too. Fails with WEFT_MESSAGE_DESC where nothing was drawn
 * or the raster has a context of its own, _GL_COMPILE, _TEXT_DIALECT, _GL_CONTEXT. */
WEFT_API WeftResult weft_raster_show(WeftRaster *raster, const WeftRasterShow *show, WeftError *error);

/* Returns the number of files .h and .glsl in the shader_dir that were made, changed or removed since the last call,
 * or since the raster was made. If there are any, shaders are compiled anew when they are next drawn with. A shader
 * that does not compile leaves the earlier program in use, and WeftRasterInfo.complaint gives the reason until the
 * text is repaired. Queries the file system for each file: call it a few times a second. */
WEFT_API int weft_raster_refresh(WeftRaster *raster);

/* Waits until the driver has finished all its work, for timing. */
WEFT_API void weft_raster_finish(WeftRaster *raster);

/* Returns memory that loaders and the driver's compilers have freed to the system. It takes some milliseconds: call it
 * when there is nothing to draw for a while. */
WEFT_API void weft_raster_return_memory(void);

/* Frees what is not needed to show or read the last picture again, such as the samples of each pixel, twelve bytes a
 * sample; the next picture makes it anew. Then returns free memory to the system, as weft_raster_return_memory does.
 * Call it when there is nothing to draw for a while, not between the frames of a sum. raster may be NULL. */
WEFT_API void weft_raster_rest(WeftRaster *raster);

/* The state of a raster. */
typedef struct WeftRasterInfo {
    const char *driver;     /* name of the driver; lives as long as the raster */
    int programs;           /* in use */
    int compiled;           /* shaders compiled since the start */
    int samplers;           /* the most that one program has */
    int samples;            /* a pixel, of the last picture */
    double compile_seconds; /* s, for all programs */
    int making;             /* not 0: there is background work (weft_raster_wait waits for it) */
    int made;               /* not 0: background work is finished, and the next picture shows it */
    float camera_eye[3], camera_target[3], camera_fov; /* of the last picture, as in WeftRenderInfo */
    /* The compiler's message for a text that does not compile, beginning with file and line; empty if all
     * compiled. */
    char complaint[512];
} WeftRasterInfo;

/* Returns the present state of a raster. */
WEFT_API WeftRasterInfo weft_raster_info(const WeftRaster *raster);

#ifdef __cplusplus
}
#endif

#endif
