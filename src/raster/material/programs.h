/* programs.h - the programs that were compiled, by key
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_PROGRAMS_H
#define WEFT_RASTER_PROGRAMS_H

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
    UNIT_COUNT
};
enum { BLOCK_PICTURE, BLOCK_MATERIAL, BLOCK_ENVIRONMENT };

typedef struct Program {
    struct Program *next;
    ShaderKey key;
    unsigned name;                  /* 0: it never compiled */
    unsigned tables;                /* array texture for weft_tables, 0 where the program has none */
    TextTable own[TEXT_TABLES_MAX]; /* the first of its layers; the sheens' are behind them */
    int own_count;
    unsigned turn;   /* of the sheens that it holds */
    int samplers;    /* array elements counted one by one */
    bool stale;      /* true if the text may have changed */
    bool wanted;     /* and it is to be compiled */
    unsigned used;   /* tick of the picture that it was last drawn with */
    WeftError error; /* of the last attempt; its program before stays in use */
} Program;

typedef struct Programs {
    Program *first;
    TextDesc desc;             /* of all texts */
    Fits fits;                 /* for their light from the environment */
    const SheenTables *sheens; /* of the scene: behind each program's own tables */
    unsigned turn;             /* another number for others, which programs take at their next use */
    int compiled;              /* so far */
    int wanted;                /* in the list */
    unsigned tick;             /* pictures so far */
} Programs;

/* So many programs are kept, those of the last few pictures in any case: each may be some ten megabytes of
 * code. */
enum { PROGRAMS_KEPT = 7, PROGRAMS_LATE = 3 };

/* Notes that a key will be drawn with; false where memory is short. */
bool programs_want(Programs *programs, const ShaderKey *key);

/* Returns true if the key's program was built from the current text. */
bool programs_has(Programs *programs, const ShaderKey *key);

/* Compiles those noted that are new or stale, several at once, in threads with contexts that share the
 * objects of `context`, which is current. Does nothing where there are none; else it changes which program is
 * in use. False where memory is short. */
bool programs_build(Programs *programs, const GlContext *context);

/* The program for a key that was noted and built. NULL where it has never compiled, with what the compiler
 * says in error; an earlier version stays in use, and error reports the failure all the same: *error is
 * WEFT_OK only where all is well. */
const Program *programs_get(Programs *programs, const ShaderKey *key, WeftError *error);

/* The program that draws the environment behind everything; 0 on failure, with what the compiler says in
 * error. Release with glDeleteProgram. */
unsigned programs_background(const Programs *programs, WeftError *error);

/* From now on all are compiled again at their next use. */
void programs_refresh(Programs *programs);

/* Returns the compiler's message for the first program that failed at its last use; empty if none did. */
const char *programs_complaint(const Programs *programs);

void programs_destroy(Programs *programs);

#endif
