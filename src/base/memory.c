#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

void *alloc_array(size_t count, size_t size) {
    if (size && count > SIZE_MAX / 2 / size) return NULL;
    size_t bytes = count * size;
    return calloc(1, bytes ? bytes : 1);
}

void memory_return(void) {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void *realloc_array(void *block, size_t count, size_t size) {
    if (size && count > SIZE_MAX / 2 / size) return NULL;
    size_t bytes = count * size;
    return realloc(block, bytes ? bytes : 1);
}

struct ArenaBlock {
    struct ArenaBlock *next;
    size_t size, used;
    _Alignas(16) unsigned char bytes[];
};

/* Embree reads the last vertex of a shared buffer with a 16-byte load: the slack keeps that inside the block. */
enum { ARENA_BLOCK = 1 << 16, ARENA_SLACK = 16 };

void *arena_array(Arena *arena, size_t count, size_t size) {
    if (size && count > SIZE_MAX / 2 / size) return NULL;
    size_t bytes = (count * size + 15) & ~(size_t)15;
    struct ArenaBlock *block = arena->blocks;
    if (!block || block->size - block->used < bytes) {
        size_t capacity = bytes > ARENA_BLOCK ? bytes : ARENA_BLOCK;
        struct ArenaBlock *fresh = alloc_array(1, sizeof *fresh + capacity + ARENA_SLACK);
        if (!fresh) return NULL;
        fresh->size = capacity;
        /* A large array gets a block of its own behind the current one, which stays in use. */
        if (block && bytes > ARENA_BLOCK) {
            fresh->next = block->next;
            block->next = fresh;
        } else {
            fresh->next = block;
            arena->blocks = fresh;
        }
        block = fresh;
    }
    void *memory = block->bytes + block->used;
    block->used += bytes;
    arena->used += bytes;
    return memory;
}

char *arena_text(Arena *arena, const char *text) {
    size_t size = strlen(text) + 1;
    char *copy = arena_array(arena, size, 1);
    if (copy) memcpy(copy, text, size);
    return copy;
}

void arena_free(Arena *arena) {
    for (struct ArenaBlock *block = arena->blocks, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    *arena = (Arena){0};
}
