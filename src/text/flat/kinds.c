#include "text/flat/kinds.h"

typedef struct Known {
    const char *name;
    Kind kind;
} Known;

#define VECTORS(name, base)                                                                                            \
    {name "2", (base)*4 + 2}, {name "3", (base)*4 + 3}, { name "4", (base)*4 + 4 }

/* The samplers whose texels are numbers of one base; those after SHADOWS compare depths. */
enum { SHADOWS = KIND_SAMPLERS + 8 };
static const Known known[] = {{"void", KIND_VOID},
                              {"bool", KIND_BOOL},
                              {"int", KIND_INT},
                              {"uint", KIND_UINT},
                              {"float", KIND_FLOAT},
                              VECTORS("bvec", BASE_BOOL),
                              VECTORS("ivec", BASE_INT),
                              VECTORS("uvec", BASE_UINT),
                              VECTORS("vec", BASE_FLOAT),
                              {"mat2", KIND_MATRICES + 2},
                              {"mat3", KIND_MATRICES + 3},
                              {"mat4", KIND_MATRICES + 4},
                              {"sampler2D", KIND_SAMPLERS},
                              {"sampler3D", KIND_SAMPLERS + 1},
                              {"samplerCube", KIND_SAMPLERS + 2},
                              {"sampler2DArray", KIND_SAMPLERS + 3},
                              {"sampler2DShadow", SHADOWS},
                              {"samplerCubeShadow", SHADOWS + 1},
                              {"sampler2DArrayShadow", SHADOWS + 2}};

Kind kinds_texel(Kind sampler) {
    if (!kind_is_sampler(sampler)) return KIND_NONE;
    return sampler < SHADOWS ? kind_vector(BASE_FLOAT, 4) : KIND_FLOAT;
}

int kinds_dimensions(Kind sampler) {
    switch (sampler) {
    case KIND_SAMPLERS + 1:
    case KIND_SAMPLERS + 3:
    case SHADOWS + 2: return 3;
    default: return 2;
    }
}

void kinds_begin(Kinds *kinds, SymbolTable *symbols) {
    memset(kinds, 0, sizeof *kinds);
    kinds->count = KIND_OWN;
    static const Kind same[KIND_OWN] = {
#define ONE(k)  k
#define FOUR(k) ONE(k), ONE((k) + 1), ONE((k) + 2), ONE((k) + 3)
        FOUR(0), FOUR(4), FOUR(8), FOUR(12), FOUR(16), FOUR(20), FOUR(24), FOUR(28), FOUR(32), FOUR(36)};
    for (int k = KIND_VECTORS; k < KIND_OWN; k++) kinds->shapes[k] = (Shape){.leaves = &same[k], .leaf_count = 1};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        kinds->spelled[known[k].kind] = known[k].name;
        kinds->shapes[known[k].kind].name =
            symbol_of(symbols, (Token){TOKEN_NAME, known[k].name, strlen(known[k].name)});
    }
}

void kinds_free(Kinds *kinds) { arena_free(&kinds->arena); }

Kind kinds_named(const Kinds *kinds, Symbol name) {
    for (int k = kinds->count - 1; k > 0; k--)
        if (kinds->shapes[k].name == name) return k;
    return KIND_NONE;
}

/* Adds a shape of so many leaves, which the caller fills. Returns NULL, and fails, if there are too many. */
static Kind *add(Kinds *kinds, Shape shape, int leaves) {
    Kind *all = NULL;
    if (kinds->count < KINDS_MOST && leaves <= LEAVES_MOST)
        all = arena_array(&kinds->arena, (size_t)leaves + 1, sizeof *all);
    if (!all) {
        kinds->failed = true;
        return NULL;
    }
    shape.leaves = all;
    shape.leaf_count = leaves;
    kinds->shapes[kinds->count++] = shape;
    return all;
}

Kind kinds_array(Kinds *kinds, Kind element, int count) {
    for (int k = KIND_OWN; k < kinds->count; k++)
        if (kinds->shapes[k].element == element && kinds->shapes[k].count == count) return k;
    const Shape *each = &kinds->shapes[element];
    if (!element || count < 1 || count > ELEMENTS_MOST) return KIND_NONE;
    const int total = count * each->leaf_count <= LEAVES_MOST ? count * each->leaf_count : 0;
    Kind *leaves = add(kinds, (Shape){.element = element, .count = count}, total);
    if (!leaves) return KIND_NONE;
    for (int k = 0; k < total; k++) leaves[k] = each->leaves[k % each->leaf_count];
    return kinds->count - 1;
}

void kinds_record(Kinds *kinds, Symbol name, const ShapeMember *members, int count) {
    int total = 0;
    for (int k = 0; k < count; k++) total += kinds->shapes[members[k].kind].leaf_count;
    ShapeMember *own = arena_array(&kinds->arena, (size_t)count + 1, sizeof *own);
    Kind *leaves = own ? add(kinds, (Shape){.name = name, .count = count, .members = own}, total) : NULL;
    if (!leaves) {
        kinds->failed = true;
        return;
    }
    for (int k = 0, at = 0; k < count; k++) {
        const Shape *shape = &kinds->shapes[members[k].kind];
        own[k] = members[k];
        own[k].first = at;
        for (int j = 0; j < shape->leaf_count; j++) leaves[at++] = shape->leaves[j];
    }
}
