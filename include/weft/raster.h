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
 * context of its own, and what was current before a call is current after it; or it adopts the caller's,
 * which must then be current at every call, the last one among them. In that one each call takes state as it
 * finds it, and leaves the framebuffers bound, the viewport and the scissor box as they were and all else as
 * a new context has it: nothing bound, no test or blending on, pixels stored without gaps, alignment 4.
 * No query, transform feedback or conditional rendering may be under way. Errors that the driver holds when a
 * call begins are dropped. Several rasters may share a context.
 *
 * DOES NOT: light that bounced, refraction, layer rule "stochastic" (drawn without its bounces). */
#ifndef WEFT_RASTER_H
#define WEFT_RASTER_H

#include "weft/image.h"
#include "weft/part.h"
#include "weft/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scene in a driver's hands. */
typedef struct WeftRaster WeftRaster;

/* Which OpenGL: desktop 3.3 core, or ES 3.0. */
typedef enum WeftGl { WEFT_GL_DESKTOP = 0, WEFT_GL_ES } WeftGl;

/* Zero means default, in every member. */
typedef struct WeftRasterDesc {
    WeftGl gl; /* of the context it makes */
    int adopt; /* not 0: draw in the context that is current in this thread, of whichever kind it is (gl is
                  then not asked): OpenGL 3.3 or ES 3.0 with float targets, or later, through EGL or GLX */
    /* A folder whose files win over the library's shader text: shading/lobes/ggx.h below it is taken where it
     * is there. It need not be there. Copied. */
    const char *shader_dir;
    int threads;   /* for tables, textures and shaders, up to WEFT_THREADS_MAX; 0: one a processor */
    int occlusion; /* rays a vertex, to find in the background what it sees of the sky and of the
                      environment's lights, up to 4096; 0: none */
    int no_cache;  /* not 0: the filtered environment, the tables by which lobes meet it and occlusion are
                      neither read from the user's cache nor written */
    /* May be NULL. Called while the environment is filtered, with the finished share in [0, 1]; a result
     * other than 0 stops. weft_raster_update may call it too. */
    WeftProgress progress;
    void *user;
} WeftRasterDesc;

/* Uploads the scene, which must outlive the raster; where it changes, call weft_raster_update before anything
 * else. Shaders are compiled when they are first drawn with. log (may be NULL) receives warnings. Fails with
 * WEFT_MESSAGE_GL_CONTEXT, _GL_MEMORY, _MEMORY, _RENDER_DEVICE, _SCENE_EMPTY, or _DESC where a number is out
 * of range. */
WEFT_API WeftResult weft_raster_create(const WeftScene *scene, const WeftRasterDesc *desc, WeftRaster **out,
                                       const WeftLog *log, WeftError *error);

/* raster may be NULL. */
WEFT_API void weft_raster_free(WeftRaster *raster);

/* Takes the scene as it is now, after any call of weft/scene.h: materials, variants, lights, the environment
 * and its placement. What is the same is left alone: a parameter is a few bytes to upload, and tables to
 * fit where it shapes a lobe; a term compiles a shader, at the next picture, unless there was one for it
 * before; another image in the environment is
 * filtered, with progress; a texture that was not looked up before uploads all textures. The only shapes that
 * change are those of lights: to move one uploads its corners, to add or remove one uploads all meshes. What
 * is seen of the sky is found anew, in the background, where the environment was turned or light passes
 * elsewhere; lights do not count for that. Fails as weft_raster_create does, or with WEFT_INTERRUPTED;
 * pictures are then partly of the scene as it was, until an update does not fail. */
WEFT_API WeftResult weft_raster_update(WeftRaster *raster, const WeftLog *log, WeftError *error);

/* Polygon lights of a picture, unless the view says otherwise. */
enum { WEFT_RASTER_POLYGONS = 8 };

/* The strategy by which a lobe is lit by the environment (docs/environment.md has their errors). */
typedef enum WeftAmbient {
    WEFT_AMBIENT_BEST = 0,   /* for each lobe the one that is nearest to the path tracer */
    WEFT_AMBIENT_IRRADIANCE, /* irradiance times albedo, the cheapest */
    WEFT_AMBIENT_MIRROR,     /* one look-up where a mirror would look, as engines do */
    WEFT_AMBIENT_FITTED,     /* lights for what is bright, and a few look-ups fitted to the lobe */
    WEFT_AMBIENT_NONE        /* no light from the environment */
} WeftAmbient;

/* Zero means default, in every member. */
typedef struct WeftRasterView {
    int width, height;         /* pixels, 1 .. 16384; 0: 960 x 720 */
    int samples;               /* a pixel, for edges: 1, 2, 4 or 8; 0: 4. A driver may have fewer */
    const char *camera;        /* as in WeftRenderDesc */
    WeftBackground background; /* what is behind */
    float background_color[3]; /* linear, for WEFT_BACKGROUND_COLOR */
    WeftAmbient ambient;       /* how the environment lights */
    int polygons; /* at most so many polygon lights, the strongest; 0: WEFT_RASTER_POLYGONS, below 0: none */
    int no_shadows;     /* not 0: lights reach every point that faces them */
    WeftPart part;      /* other than all: nothing, transparent, is behind */
    int crop[4];        /* x, y, width, height from the top left: nothing else is drawn; all 0: everything */
    int plain_textures; /* not 0: textures as the path tracer reads them, without smaller copies */
    WeftFloor floor;    /* not under a part */
    int hide_lights;    /* not 0: polygon lights shine, but the camera looks through them */
} WeftRasterView;

/* Draws one picture into the raster's own target. A shader that does not compile is an error only where there
 * is no earlier program to draw with: see WeftRasterInfo. Fails with WEFT_MESSAGE_DESC, _CAMERA_NAME,
 * _GL_COMPILE, _TEXT_DIALECT, _GL_MEMORY, _GL_CONTEXT. */
WEFT_API WeftResult weft_raster_draw(WeftRaster *raster, const WeftRasterView *view, WeftError *error);

/* Returns 1 if a picture can be drawn with the programs that there are, 0 if weft_raster_draw would compile
 * first, which on a driver without a GPU may take many seconds. What can be shown meanwhile had better be. A
 * view that would be refused counts as ready. Asks no driver; the floor counts though it may not be seen. */
WEFT_API int weft_raster_ready(WeftRaster *raster, const WeftRasterView *view);

/* Waits for what is made in the background: the next picture has it. Where shapes of lights have changed it waits only
 * after weft_raster_update. Fails with WEFT_MESSAGE_GL_MEMORY or _MEMORY. */
WEFT_API WeftResult weft_raster_wait(WeftRaster *raster, WeftError *error);

/* The picture drawn last: F32 RGBA, linear Rec. 709 radiance, straight alpha. Release with weft_image_free.
 */
WEFT_API WeftResult weft_raster_image(WeftRaster *raster, WeftImage *out, WeftError *error);

/* The way an image is shown on screen. Zero means the default, in every member. */
typedef struct WeftRasterShow {
    unsigned framebuffer; /* of the context that was adopted, and complete; 0: the window's */
    int x, y;             /* the picture's lower left corner in it, pixels */
    int width, height;    /* the picture is scaled to, by its nearest pixels; 0: as it is */
    int clip[4];          /* x, y, width, height of what may change; width 0: no limit */
    float background[3];  /* light of the display, linear, in [0, 1], where the picture is transparent */
    WeftTonemap tonemap;  /* before the sRGB curve */
    float exposure;       /* stops */
} WeftRasterShow;

/* Draws the picture drawn last as weft_image_tonemap_over makes it, dither and all. It
 * converts to sRGB itself: under OpenGL ES the framebuffer must not do so too. Fails with WEFT_MESSAGE_DESC
 * where nothing was drawn or the raster has a context of its own, _GL_COMPILE, _TEXT_DIALECT, _GL_CONTEXT. */
WEFT_API WeftResult weft_raster_show(WeftRaster *raster, const WeftRasterShow *show, WeftError *error);

/* Looks whether text in the shader_dir (files .h and .glsl) was made, changed or removed since the last look,
 * or since the raster was made, and returns how many files were. From then on shaders are compiled anew when
 * they are next drawn with; one that does not compile leaves the program before it in use, and
 * WeftRasterInfo.complaint says why until it is mended. Cheap, but it asks the file system about each file:
 * a few times a second will do. */
WEFT_API int weft_raster_refresh(WeftRaster *raster);

/* Waits until the driver has done all it was asked to: for timing. */
WEFT_API void weft_raster_finish(WeftRaster *raster);

/* The state of a raster. */
typedef struct WeftRasterInfo {
    const char *driver;     /* name of the driver; lives as long as the raster */
    int programs;           /* in use */
    int compiled;           /* shaders compiled since the start */
    int samplers;           /* the most that one program has */
    int samples;            /* a pixel, of the last picture */
    double compile_seconds; /* s, for all programs */
    int making; /* not 0: something is being made in the background (weft_raster_wait waits for it) */
    int made;   /* not 0: and the next picture has it */
    float camera_eye[3], camera_target[3], camera_fov; /* of the last picture, as in WeftRenderInfo */
    /* The compiler's message for a text that does not compile, from its file and line on; empty if all
     * compiled. */
    char complaint[512];
} WeftRasterInfo;

/* About a raster, as it is now. */
WEFT_API WeftRasterInfo weft_raster_info(const WeftRaster *raster);

#ifdef __cplusplus
}
#endif

#endif
