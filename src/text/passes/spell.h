/* spell.h - a text of TEXT_PLAIN in the words of a language, under names of its own
 *
 *   Dir, Rgb        vec3, float3 or vec3f; records in C
 *   charlie_d       weft_charlie_d, and so every function, record (WeftAngles) and constant (WEFT_PI) */
#pragma once

#include "text/passes/items.h"
#include "text/source/buffer.h"

typedef enum SpellLanguage {
    SPELL_GLSL, /* 3.30 core and ES 3.00 */
    SPELL_HLSL, /* shader model 5 */
    SPELL_C,    /* C99 and C++: functions are static inline */
    SPELL_WGSL
} SpellLanguage;

enum { SPELL_PREFIX = 112, SPELL_NAME = 256 };

typedef struct Speller {
    SpellLanguage language;
    char prefix[SPELL_PREFIX]; /* "weft_", may be empty */
    char own[SPELL_PREFIX];    /* "weft_khronos_", of items that are the text's own */
} Speller;

/* Appends the kept items, either those that are late or the others, in their order, each after its comment. */
void spell_items(const Speller *speller, const Items *items, bool late, Buffer *out);

/* Appends C functions for built-in functions of shading languages that kept items of any of the texts call. They belong
 * before all items. */
void spell_helpers(const Speller *speller, const Items *const *texts, int count, Buffer *out);

/* Writes the name of an item of that kind in the text's language. Returns name. */
char *spell_name(const Speller *speller, ItemKind kind, const char *dialect, char name[SPELL_NAME]);

/* Works as spell_name, for the item of that name among these if there is one. */
char *spell_item(const Speller *speller, const Items *items, ItemKind kind, const char *dialect, char name[SPELL_NAME]);
