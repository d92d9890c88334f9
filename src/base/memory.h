/* memory.h - allocation that checks its sizes, and an arena for objects that are released together */
#pragma once

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>

/* Allocates count * size zeroed bytes; returns NULL if the product overflows or memory is short. Release with free().
 * A count of 0 gives a valid pointer. */
void *alloc_array(size_t count, size_t size);

/* Grows or shrinks a block to count * size bytes; returns NULL and leaves the block unchanged if the product overflows
 * or memory is short. */
void *realloc_array(void *block, size_t count, size_t size);

/* Returns free memory between blocks in use to the system, if the C library can. */
void memory_return(void);

/* Detects a shortage of memory in decoders that do not report it apart from wrong data, OpenEXR and zlib: malloc sets
 * errno, which decoders in memory do not change otherwise. Call memory_begin, the decoder, memory_was_short. */
static inline void memory_begin(void) { errno = 0; }
static inline bool memory_was_short(void) { return errno == ENOMEM; }

/* An arena, whose allocations are released together. Zero-initialise; not thread-safe. */
typedef struct Arena {
    struct ArenaBlock *blocks;
    size_t used; /* bytes handed out, for limits */
} Arena;

/* Allocates count * size zeroed bytes aligned to 16; returns NULL as alloc_array does. */
void *arena_array(Arena *arena, size_t count, size_t size);

/* Copies text; returns NULL if memory is short. */
char *arena_text(Arena *arena, const char *text);

/* Releases all blocks; the arena is then empty and can be reused. */
void arena_free(Arena *arena);
