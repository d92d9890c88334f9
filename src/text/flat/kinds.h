/* kinds.h - the types of a text: numbers, vectors, matrices and samplers, and its own records and arrays
 *
 * A value of a type consists of leaves: numbers, vectors and matrices are one, records and arrays have those of their
 * members and elements in their order. */
#pragma once

#include "text/flat/syntax.h"

typedef int Kind;

typedef enum BaseType { BASE_NONE, BASE_BOOL, BASE_INT, BASE_UINT, BASE_FLOAT } BaseType;

enum {
    KIND_NONE, /* of what is not understood */
    KIND_VOID,
    KIND_VECTORS = 4, /* base times 4 plus the size, 1 to 4 */
    KIND_BOOL = BASE_BOOL * 4 + 1,
    KIND_INT = BASE_INT * 4 + 1,
    KIND_UINT = BASE_UINT * 4 + 1,
    KIND_FLOAT = BASE_FLOAT * 4 + 1,
    KIND_MATRICES = 20, /* plus the size, 2 to 4 */
    KIND_SAMPLERS = 25,
    KIND_OWN = 40, /* records and arrays from here on */
    KINDS_MOST = 512
};

/* Return the kind of a vector (1 component: a number), its base (BASE_NONE of anything else), its size (0). */
static inline Kind kind_vector(BaseType base, int size) { return (int)base * 4 + size; }
static inline BaseType kind_base(Kind kind) {
    return kind > KIND_VECTORS && kind <= KIND_MATRICES ? (BaseType)((kind - 1) / 4) : BASE_NONE;
}
static inline int kind_size(Kind kind) { return kind_base(kind) ? (kind - 1) % 4 + 1 : 0; }
static inline int kind_matrix(Kind kind) {
    return kind > KIND_MATRICES + 1 && kind < KIND_SAMPLERS ? kind - KIND_MATRICES : 0;
}
static inline bool kind_is_sampler(Kind kind) { return kind >= KIND_SAMPLERS && kind < KIND_OWN; }

typedef struct ShapeMember {
    Symbol name;
    Kind kind;
    int first; /* index of the first leaf */
} ShapeMember;

typedef struct Shape {
    Symbol name;          /* of a record, else 0 */
    Kind element;         /* of an array, else KIND_NONE */
    int count;            /* of elements or members */
    ShapeMember *members; /* of a record */
    const Kind *leaves;   /* the kind of each leaf */
    int leaf_count;
} Shape;

/* An array of more leaves has none: it is read outside the shader, an element at a time. */
enum { LEAVES_MOST = 512, ELEMENTS_MOST = 1 << 16 };

typedef struct Kinds {
    Arena arena;
    Shape shapes[KINDS_MOST];
    const char *spelled[KIND_OWN]; /* the names of GLSL's own */
    int count;
    bool failed; /* too many, or memory is short */
} Kinds;

/* Begins the list with the kinds of GLSL. Call kinds_free. */
void kinds_begin(Kinds *kinds, SymbolTable *symbols);
void kinds_free(Kinds *kinds);

/* Returns the kind of that name, KIND_NONE if there is none. */
Kind kinds_named(const Kinds *kinds, Symbol name);

/* Returns the kind of an array, which is added if it is new. */
Kind kinds_array(Kinds *kinds, Kind element, int count);

/* Adds a record; its members' names and kinds are given, and copied. */
void kinds_record(Kinds *kinds, Symbol name, const ShapeMember *members, int count);

/* Returns the result of a look-up with coordinates in a sampler, KIND_NONE if it is none. */
Kind kinds_texel(Kind sampler);

/* Returns the number of sides that the size of a sampler's texture has. */
int kinds_dimensions(Kind sampler);
