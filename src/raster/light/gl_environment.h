/* gl_environment.h - the environment of a scene in the driver's memory, filtered for shading/ambient/ambient.h
 *
 *   environment_text(&text);                          before it includes shading/ambient/ambient.h
 *   environment_program(program, cube, block);        once a program: its unit and its block's binding
 *   environment_place(env, environment);              when it is rotated or scaled; nothing is filtered again
 *   environment_bind(env, cube, block);               once a frame
 *
 * All calls are for the context that is current. */
#pragma once

#include "scene/light/env_split.h"
#include "text/assemble/text.h"

enum { ENVIRONMENT_LEVELS = 7, ENVIRONMENT_SIDE = 256 };

/* kappa of level m of the cube is ENVIRONMENT_KAPPA / 4^m, and its faces are ENVIRONMENT_SIDE / 2^m wide. */
#define ENVIRONMENT_KAPPA 3200.0f

typedef struct GlEnvironment {
    AmbientParts parts;
    unsigned cube;
    unsigned map;     /* the unfiltered image, for environment_background; 0 for one colour */
    unsigned blurred; /* the image blurred by backdrop.h; 0 until first used */
    unsigned buffer;  /* uniform block Environment */
    bool cached;      /* the cube came from the cache */
} GlEnvironment;

/* Zero-initialise. */
typedef struct EnvironmentHow {
    TextLanguage language; /* of the context */
    const char *folder;    /* TextDesc.folder; may be NULL */
    int env_lights;        /* most lights; 0: AMBIENT_LIGHTS; below 0: none, all light is in the residual */
    bool no_cache;
    bool (*progress)(void *user, float done); /* between steps, done in [0, 1]; true to stop. May be NULL */
    void *user;
} EnvironmentHow;

/* Splits an environment into lights and a rest, and filters the cube or reads it from the user's cache, where its file
 * is named by the hash of the pixels; a file that cannot be read or written is a warning (WEFT_MESSAGE_CACHE_IGNORED).
 * Rotation and factors are those of `environment`. Leaves framebuffer 0 bound and no program in use. Fails with
 * WEFT_MESSAGE_MEMORY, _GL_MEMORY, _GL_COMPILE, or WEFT_INTERRUPTED; *out is then zero. */
WeftResult environment_create(const Environment *environment, const EnvironmentHow *how, GlEnvironment *out,
                              const WeftLog *log, WeftError *error);

/* Makes the texture `blurred` of an environment that has an image, unless it is made already. Fails with
 * WEFT_MESSAGE_MEMORY or _GL_MEMORY. */
WeftResult environment_blur(GlEnvironment *self, const Environment *environment, WeftError *error);

void environment_destroy(GlEnvironment *environment);

/* Uploads the rotation and the factors of `environment`. */
void environment_place(const GlEnvironment *self, const Environment *environment);

/* Fills in the lights in world space, for a rotation of the environment in radians, and returns their number. */
int environment_lights(const GlEnvironment *environment, float rotation, EnvLight env_lights[AMBIENT_LIGHTS_MAX]);

/* Fills in the points of these lights likewise, and returns their number. */
int environment_points(const GlEnvironment *environment, float rotation, EnvPoint env_points[AMBIENT_POINTS_MAX]);

/* Declares the functions that shading/ambient/ambient.h needs from its source, which is then a Frame
 * (shading/stack/frame.h). Takes one sampler. The caller declares AmbientWeights ambient_baked(Frame, int), float
 * ambient_light_visibility(Frame, int, float) and float ambient_light_behind(Frame, int, float). */
void environment_text(Text *text);

/* Sets the texture unit of the cube and the binding of the block in a program, if it has them. */
void environment_program(unsigned program, int cube, int block);
void environment_bind(const GlEnvironment *environment, int cube, int block);
