/* raster_state.h - everything a WeftRaster keeps between pictures: the uploaded scene, its shaders and render
 * targets */
#pragma once

#include "raster/frame/coarse.h"
#include "raster/frame/sums.h"
#include "raster/geometry/meshes.h"
#include "raster/gl/context.h"
#include "raster/gl/display.h"
#include "raster/gl/queue.h"
#include "raster/gl/target.h"
#include "raster/light/gl_environment.h"
#include "raster/light/gl_sky.h"
#include "raster/light/ground.h"
#include "raster/light/lookout.h"
#include "raster/light/ray_scene.h"
#include "raster/light/shadow.h"
#include "raster/material/materials.h"
#include "raster/material/programs.h"
#include "raster/material/shader_watch.h"
#include "weft/raster.h"

struct WeftRaster {
    const WeftScene *scene;
    WeftRasterDesc desc; /* shader_dir is our own copy */
    GlContext *context;
    GlMeshes meshes;
    GlTextures textures;
    bool no_mipmaps; /* textures are looked up without their mipmaps */
    GlMaterials materials;
    Programs programs;
    GlEnvironment environment;
    bool environment_lit;         /* the scene's environment is not black, and `environment` has it */
    unsigned environment_version; /* of the uploaded environment, as in Environment */
    unsigned shape_version;       /* of the uploaded meshes, as in WeftScene */
    unsigned background_program;  /* 0 until it is needed */
    Lookout lookout;
    LightPolygons polygons;
    Shadows shadows;
    Floor floor; /* of the last picture; floor.there only where it is seen */
    Ground ground;
    float sky_on_floor; /* luminance of the environment's light on the floor */
    bool floor_shaded;  /* the scene shades the floor */
    Target target;
    RayScene rays;
    GlSky sky;
    Sums sums;
    Coarse coarse;
    bool drawn;                /* the picture is that of drawn_view through drawn_from, and the scene is the same */
    WeftRasterView drawn_view; /* of the last picture, complete */
    View drawn_from;
    bool summing; /* what is drawn is a frame of the sum */
    Display display;
    unsigned picture_buffer; /* uniform buffer of the block Picture */
    Queue queue;
    Camera camera; /* of the last picture */
    double compile_seconds;
    int drawn_programs;     /* value of programs.compiled at the last picture */
    uint64_t drawn_samples; /* bit k: these programs have drawn with k samples a pixel */
    FolderWatch watch;      /* of the shader_dir */
};
