/* programs.h - the programs that were compiled, by key
 *
 * All calls are for the context that is current. */
#pragma once

#include <stdint.h>

#include "raster/gl/context.h"
#include "raster/material/shader.h"
#include "scene/light/sheen_tables.h"

/* Texture units and uniform blocks of every program: a material's maps come first, or the floor's three. */
enum {
    UNIT_FLOOR = 0,
    UNIT_TABLES = 8,
    UNIT_ENVIRONMENT,
    UNIT_BACKGROUND,
    UNIT_SHADOW,
    UNIT_SOFT_SHADOW,
    UNIT_CLOTH_CELLS,
    UNIT_CLOTH_COLORS,
    UNIT_COUNT,
    UNIT_COARSE = UNIT_COUNT,     /* of a moving picture */
    UNIT_RAYS = UNIT_SOFT_SHADOW, /* of frames of a sum, which need neither shadow maps nor the filtered cube */
    UNIT_MASKS = UNIT_SHADOW,
    UNIT_SKY = UNIT_ENVIRONMENT
};
enum { BLOCK_PICTURE, BLOCK_MATERIAL, BLOCK_ENVIRONMENT };

typedef struct Program {
    struct Program *next;
    ShaderKey key;
    unsigned name;                  /* 0: it never compiled; shared by programs of one flat text */
    uint64_t text;                  /* hash of its flat text; 0: it was compiled from another */
    unsigned tables;                /* array texture for weft_tables, 0 where the program has none */
    TextTable own[TEXT_TABLES_MAX]; /* the first of its layers; the sheens' are behind them */
    int own_count;
    unsigned sheens_version; /* of the sheens' tables behind its own */
    int samplers;            /* array elements counted one by one */
    int least_opacity;       /* location of forward.glsl's uniform; -1 where the material does not blend */
    int hair_half;           /* location of vertex.glsl's uniform, or -1 */
    int surface_number;      /* location of a uniform of forward.glsl and resolve.glsl, or -1 */
    bool stale;              /* true if the text may have changed */
    bool wanted;             /* and it is to be compiled */
    unsigned used;           /* tick of the picture that it was last drawn with */
    WeftError error;         /* of the last attempt; its program before stays in use */
} Program;

typedef struct Programs {
    Program *first;
    TextDesc desc;             /* of all texts */
    Fits fits;                 /* for their light from the environment */
    const SheenTables *sheens; /* of the scene: behind each program's own tables */
    unsigned sheens_version;   /* counts changes of them, which programs take at their next use */
    int compiled;              /* so far */
    int wanted;                /* in the list */
    unsigned tick;             /* pictures so far */
} Programs;

/* Programs that are kept, of those that shade, and the number of last pictures whose programs are kept in any case. A
 * program may be some ten megabytes of code. */
enum { PROGRAMS_KEPT = 7, PROGRAMS_LATE = 3 };

/* Records that a picture will be drawn with a key. Returns false if memory is short. */
bool programs_want(Programs *programs, const ShaderKey *key);

/* Returns true if the key's program was built from the current text. */
bool programs_has(Programs *programs, const ShaderKey *key);

/* Deletes the programs whose keys are spare. */
void programs_forget(Programs *programs, bool (*is_spare)(const ShaderKey *key));

/* Compiles the recorded programs that are new or stale, several at once, in threads with contexts that share the
 * objects of `context`, which is current. Does nothing if there are none; else it changes which program is
 * in use. Returns false if memory is short. */
bool programs_build(Programs *programs, const GlContext *context);

/* Returns the program of a key that was recorded and built, or NULL if it has never compiled. If its last text did not
 * compile, an earlier version stays in use, and *error has the compiler's message all the same; else *error is
 * WEFT_OK. */
const Program *programs_get(Programs *programs, const ShaderKey *key, WeftError *error);

/* Compiles the program that draws the environment behind the scene. Returns 0 on failure, with the compiler's message
 * in error. Release with glDeleteProgram. */
unsigned programs_background(const Programs *programs, WeftError *error);

/* Marks all programs as stale: they are compiled again at their next use. */
void programs_refresh(Programs *programs);

/* Returns the compiler's message for the first program that failed at its last use; empty if none did. */
const char *programs_complaint(const Programs *programs);

void programs_destroy(Programs *programs);
