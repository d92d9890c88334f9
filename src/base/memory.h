/* memory.h - allocation that checks its sizes, and an arena for things that die together */
#ifndef WEFT_BASE_MEMORY_H
#define WEFT_BASE_MEMORY_H

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>

/* count * size zeroed bytes, or NULL when the product overflows or memory is short. Release with free().
 * A count of 0 gives a valid pointer. */
void *alloc_array(size_t count, size_t size);

/* Grows or shrinks to count * size bytes; NULL (the old block untouched) on overflow or shortage. */
void *realloc_array(void *block, size_t count, size_t size);

/* Gives the system back what is free in between blocks that are not, where the C library can. */
void memory_return(void);

/* Libraries that decode fail without saying whether data were wrong or memory was short: OpenEXR, zlib.
 * malloc does, in errno, which decoders in memory leave alone else. So: memory_begin, call, memory_was_short.
 */
static inline void memory_begin(void) { errno = 0; }
static inline bool memory_was_short(void) { return errno == ENOMEM; }

/* Everything allocated from an arena is released together. Zero-initialise; not thread-safe. */
typedef struct Arena {
    struct ArenaBlock *blocks;
    size_t used; /* bytes handed out, for limits */
} Arena;

/* count * size zeroed bytes aligned to 16, or NULL as alloc_array does. */
void *arena_array(Arena *arena, size_t count, size_t size);

/* A copy of text; NULL when memory is short. */
char *arena_text(Arena *arena, const char *text);

/* Releases all blocks; the arena is then empty and can be used again. */
void arena_free(Arena *arena);

#endif
