/* run_builtin.c - functions and names of GLSL */
#include "text/flat/run.h"

typedef enum Result {
    AS_FIRST, /* the type of argument 0, 1 or 2 */
    AS_SECOND,
    AS_THIRD,
    A_MIX, /* the type of argument 0; argument 2 may be bools */
    A_FLOAT,
    A_BOOL,
    SOME_BOOLS, /* one for each component of argument 0 */
    SOME_FLOATS,
    SOME_INTS,
    SOME_UINTS,
    A_TEXEL, /* of the sampler that argument 0 is */
    A_SIZE   /* of that sampler */
} Result;

typedef struct GlslFunction {
    const char *name;
    int arguments; /* the least */
    Result result;
    bool pinned; /* neighbouring pixels take part */
} GlslFunction;

static const GlslFunction builtins[] = {{"abs", 1, AS_FIRST, false},
                                        {"acos", 1, AS_FIRST, false},
                                        {"all", 1, A_BOOL, false},
                                        {"any", 1, A_BOOL, false},
                                        {"asin", 1, AS_FIRST, false},
                                        {"atan", 1, AS_FIRST, false},
                                        {"ceil", 1, AS_FIRST, false},
                                        {"clamp", 3, AS_FIRST, false},
                                        {"cos", 1, AS_FIRST, false},
                                        {"cross", 2, AS_FIRST, false},
                                        {"dFdx", 1, AS_FIRST, true},
                                        {"dFdy", 1, AS_FIRST, true},
                                        {"degrees", 1, AS_FIRST, false},
                                        {"distance", 2, A_FLOAT, false},
                                        {"dot", 2, A_FLOAT, false},
                                        {"equal", 2, SOME_BOOLS, false},
                                        {"exp", 1, AS_FIRST, false},
                                        {"exp2", 1, AS_FIRST, false},
                                        {"floatBitsToInt", 1, SOME_INTS, false},
                                        {"floatBitsToUint", 1, SOME_UINTS, false},
                                        {"floor", 1, AS_FIRST, false},
                                        {"fract", 1, AS_FIRST, false},
                                        {"fwidth", 1, AS_FIRST, true},
                                        {"greaterThan", 2, SOME_BOOLS, false},
                                        {"greaterThanEqual", 2, SOME_BOOLS, false},
                                        {"intBitsToFloat", 1, SOME_FLOATS, false},
                                        {"inversesqrt", 1, AS_FIRST, false},
                                        {"isinf", 1, SOME_BOOLS, false},
                                        {"isnan", 1, SOME_BOOLS, false},
                                        {"length", 1, A_FLOAT, false},
                                        {"lessThan", 2, SOME_BOOLS, false},
                                        {"lessThanEqual", 2, SOME_BOOLS, false},
                                        {"log", 1, AS_FIRST, false},
                                        {"log2", 1, AS_FIRST, false},
                                        {"max", 2, AS_FIRST, false},
                                        {"min", 2, AS_FIRST, false},
                                        {"mix", 3, A_MIX, false},
                                        {"mod", 2, AS_FIRST, false},
                                        {"normalize", 1, AS_FIRST, false},
                                        {"not", 1, AS_FIRST, false},
                                        {"notEqual", 2, SOME_BOOLS, false},
                                        {"pow", 2, AS_FIRST, false},
                                        {"radians", 1, AS_FIRST, false},
                                        {"reflect", 2, AS_FIRST, false},
                                        {"round", 1, AS_FIRST, false},
                                        {"sign", 1, AS_FIRST, false},
                                        {"sin", 1, AS_FIRST, false},
                                        {"smoothstep", 3, AS_THIRD, false},
                                        {"sqrt", 1, AS_FIRST, false},
                                        {"step", 2, AS_SECOND, false},
                                        {"tan", 1, AS_FIRST, false},
                                        {"texelFetch", 3, A_TEXEL, false},
                                        {"texture", 2, A_TEXEL, true},
                                        {"textureGrad", 4, A_TEXEL, false},
                                        {"textureLod", 3, A_TEXEL, false},
                                        {"textureSize", 2, A_SIZE, false},
                                        {"trunc", 1, AS_FIRST, false},
                                        {"uintBitsToFloat", 1, SOME_FLOATS, false}};

enum { ARGUMENTS_MOST = 6 };

static Symbol symbol(Run *run, const char *name) {
    return symbol_of(&run->syntax.symbols, (Token){TOKEN_NAME, name, strlen(name)});
}

void run_builtins(Run *run) {
    static const struct {
        const char *name;
        Kind kind;
    } inputs[] = {
        {"gl_FragCoord", BASE_FLOAT * 4 + 4}, {"gl_FrontFacing", KIND_BOOL}, {"gl_PointCoord", BASE_FLOAT * 4 + 2}};
    for (size_t k = 0; k < sizeof builtins / sizeof builtins[0]; k++)
        run->builtins[symbol(run, builtins[k].name)] = &builtins[k];
    for (size_t k = 0; k < sizeof inputs / sizeof inputs[0]; k++)
        run->outside[symbol(run, inputs[k].name)] = inputs[k].kind;
    run->true_name = symbol(run, "true");
    run->false_name = symbol(run, "false");
    run->main_name = symbol(run, "main");
}

/* Returns the kind of a call's result, KIND_NONE if its arguments are no numbers of one base. */
static Kind result_kind(const GlslFunction *self, GraphNode *const *arguments, int count) {
    if (count < 1 || count < self->arguments) return KIND_NONE;
    const Kind first = arguments[0]->kind;
    const Kind second = count > 1 ? arguments[1]->kind : KIND_NONE, third = count > 2 ? arguments[2]->kind : KIND_NONE;
    const int size = kind_size(first);
    if (self->result == A_TEXEL) return kinds_texel(first);
    if (self->result == A_SIZE)
        return kind_is_sampler(first) ? kind_vector(BASE_INT, kinds_dimensions(first)) : KIND_NONE;
    const bool chooses = self->result == A_MIX && kind_base(third) == BASE_BOOL;
    if (chooses && kind_size(third) != size) return KIND_NONE;
    for (int k = 0; k < (chooses ? 2 : count); k++)
        if (!kind_base(first) || kind_base(arguments[k]->kind) != kind_base(first)) return KIND_NONE;
    switch (self->result) {
    case AS_FIRST:
    case A_MIX: return first;
    case AS_SECOND: return second;
    case AS_THIRD: return third;
    case A_FLOAT: return KIND_FLOAT;
    case A_BOOL: return KIND_BOOL;
    case SOME_BOOLS: return kind_vector(BASE_BOOL, size);
    case SOME_FLOATS: return kind_vector(BASE_FLOAT, size);
    case SOME_INTS: return kind_vector(BASE_INT, size);
    case SOME_UINTS: return kind_vector(BASE_UINT, size);
    default: return KIND_NONE;
    }
}

ShaderValue run_builtin(Run *run, const Expr *call) {
    const GlslFunction *self = run->builtins[call->name];
    GraphNode *arguments[ARGUMENTS_MOST];
    int count = 0;
    if (!self) return run_wrong_name(run, "a function", call->name);
    for (const Expr *one = call->a; one; one = one->next) {
        const ShaderValue value = run_value(run, one);
        if (run->wrong || value.whole || count == ARGUMENTS_MOST) return run_wrong(run, "an argument");
        if (value.kind >= KIND_OWN || value.kind <= KIND_VOID) return run_wrong(run, "a record as an argument");
        arguments[count++] = value.leaves[0];
    }
    const Kind kind = result_kind(self, arguments, count);
    if (!kind) return run_wrong_name(run, "arguments of a function of GLSL", call->name);
    return run_of_node(run, graph_call(&run->graph, kind, call->name, self->name, arguments, count,
                                       self->pinned ? run->region : NULL));
}
