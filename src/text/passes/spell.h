/* spell.h - a plain text (TEXT_PLAIN) in the words of a language, under names of its own
 *
 *   Dir, Rgb        vec3, float3 or vec3f; records in C
 *   charlie_d       weft_charlie_d, and so every function, record (WeftAngles) and constant (WEFT_PI) */
#ifndef WEFT_TEXT_SPELL_H
#define WEFT_TEXT_SPELL_H

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

/* Appends the items that are kept, late or not, in their order, each behind its comment. */
void spell_items(const Speller *speller, const Items *items, bool late, Buffer *out);

/* Appends the functions of C that stand for what shading languages have, where kept items of any of the texts
 * call them; to stand before all. */
void spell_helpers(const Speller *speller, const Items *const *texts, int count, Buffer *out);

/* The name that an item of that kind gets. Returns name. */
char *spell_name(const Speller *speller, ItemKind kind, const char *plain, char name[SPELL_NAME]);

/* Works as spell_name, for the item of that name among these if there is one. */
char *spell_item(const Speller *speller, const Items *items, ItemKind kind, const char *plain,
                 char name[SPELL_NAME]);

#endif
