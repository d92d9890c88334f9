#include "text/flat/constants.h"

#include <math.h>

#include "base/equal.h"

static const Constant none = {.kind = KIND_NONE};

static Constant of_float(float x) {
    Constant c = {.kind = isfinite(x) ? KIND_FLOAT : KIND_NONE};
    c.number = x;
    return c;
}

static Constant of_integer(Kind kind, int x) {
    Constant c = {.kind = kind};
    c.integer = x;
    return c;
}

static Constant of_bool(bool x) { return of_integer(KIND_BOOL, x); }

Constant constant_unary(Operator op, Constant a) {
    if (op == '-' && a.kind == KIND_FLOAT) return of_float(-a.number);
    if (op == '-' && a.kind == KIND_INT) return of_integer(KIND_INT, (int)(0u - (unsigned)a.integer));
    if (op == '!' && a.kind == KIND_BOOL) return of_bool(!a.integer);
    if (op == '~' && a.kind == KIND_UINT) return of_integer(KIND_UINT, ~a.integer);
    return none;
}

static Constant floats(Operator op, float a, float b) {
    switch (op) {
    case '+': return of_float(a + b);
    case '-': return of_float(a - b);
    case '*': return of_float(a * b);
    case '/': return is_equal(b, 0.0f) ? none : of_float(a / b);
    case '<': return of_bool(a < b);
    case '>': return of_bool(a > b);
    case OPERATOR('<', '='): return of_bool(a <= b);
    case OPERATOR('>', '='): return of_bool(a >= b);
    case OPERATOR('=', '='): return of_bool(is_equal(a, b));
    case OPERATOR('!', '='): return of_bool(!is_equal(a, b));
    default: return none;
    }
}

/* Compares whole numbers, which are in range of both int and uint. */
static Constant compared(Operator op, long long a, long long b) {
    switch (op) {
    case '<': return of_bool(a < b);
    case '>': return of_bool(a > b);
    case OPERATOR('<', '='): return of_bool(a <= b);
    case OPERATOR('>', '='): return of_bool(a >= b);
    case OPERATOR('=', '='): return of_bool(a == b);
    case OPERATOR('!', '='): return of_bool(a != b);
    default: return none;
    }
}

/* Computes with whole numbers, which wrap at 32 bits. */
static Constant whole(Operator op, Kind kind, int x, int y) {
    const bool is_signed = kind == KIND_INT;
    const unsigned a = (unsigned)x, b = (unsigned)y;
    const bool divides = y != 0 && !(is_signed && y == -1);
    switch (op) {
    case '+': return of_integer(kind, (int)(a + b));
    case '-': return of_integer(kind, (int)(a - b));
    case '*': return of_integer(kind, (int)(a * b));
    case '&': return of_integer(kind, (int)(a & b));
    case '|': return of_integer(kind, (int)(a | b));
    case '^': return of_integer(kind, (int)(a ^ b));
    case '/': return divides ? of_integer(kind, is_signed ? x / y : (int)(a / b)) : none;
    case '%': return divides && (!is_signed || (x >= 0 && y > 0)) ? of_integer(kind, (int)(a % b)) : none;
    case OPERATOR('<', '<'): return b < 32u ? of_integer(kind, (int)(a << b)) : none;
    case OPERATOR('>', '>'): return b < 32u && !is_signed ? of_integer(kind, (int)(a >> b)) : none;
    default: return is_signed ? compared(op, x, y) : compared(op, a, b);
    }
}

static Constant bools(Operator op, bool a, bool b) {
    switch (op) {
    case OPERATOR('&', '&'): return of_bool(a && b);
    case OPERATOR('|', '|'): return of_bool(a || b);
    case OPERATOR('^', '^'):
    case OPERATOR('!', '='): return of_bool(a != b);
    case OPERATOR('=', '='): return of_bool(a == b);
    default: return none;
    }
}

Constant constant_binary(Operator op, Constant a, Constant b) {
    if (a.kind == KIND_FLOAT && b.kind == KIND_FLOAT) return floats(op, a.number, b.number);
    if (a.kind == KIND_BOOL && b.kind == KIND_BOOL) return bools(op, a.integer, b.integer);
    if ((a.kind == KIND_INT || a.kind == KIND_UINT) && b.kind == a.kind) return whole(op, a.kind, a.integer, b.integer);
    return none;
}

/* Returns no number where the result is infinite, of which no constant is made. */
static float per_sqrtf(float x) { return x > 0.0f ? 1.0f / sqrtf(x) : NAN; }
static float fractf(float x) { return x - floorf(x); }

static Constant of_one(const char *name, float x) {
    static const struct {
        const char *name;
        float (*function)(float);
    } all[] = {{"abs", fabsf},  {"ceil", ceilf},   {"cos", cosf},     {"exp", expf},
               {"exp2", exp2f}, {"floor", floorf}, {"fract", fractf}, {"inversesqrt", per_sqrtf},
               {"log", logf},   {"log2", log2f},   {"sin", sinf},     {"sqrt", sqrtf}};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (strcmp(all[k].name, name) == 0) return of_float(all[k].function(x));
    return none;
}

static Constant of_two(const char *name, float x, float y) {
    if (strcmp(name, "min") == 0) return of_float(y < x ? y : x);
    if (strcmp(name, "max") == 0) return of_float(x < y ? y : x);
    if (strcmp(name, "pow") == 0 && x > 0.0f) return of_float(powf(x, y));
    return none;
}

static Constant of_three(const char *name, float x, float y, float z) {
    if (strcmp(name, "mix") == 0) return of_float(x * (1.0f - z) + y * z);
    if (strcmp(name, "clamp") == 0 && y <= z) return of_float(x < y ? y : z < x ? z : x);
    return none;
}

/* Returns a as that kind of number. */
static Constant converted(Kind kind, Constant a) {
    if (kind == KIND_FLOAT && a.kind == KIND_INT) return of_float((float)a.integer);
    if (kind == KIND_FLOAT && a.kind == KIND_UINT) return of_float((float)(unsigned)a.integer);
    if (kind == KIND_FLOAT && a.kind == KIND_BOOL) return of_float(a.integer ? 1.0f : 0.0f);
    if (kind == KIND_INT && a.kind == KIND_FLOAT && fabsf(a.number) < 1e9f) return of_integer(KIND_INT, (int)a.number);
    if ((kind == KIND_INT || kind == KIND_UINT) && (a.kind == KIND_INT || a.kind == KIND_UINT))
        return of_integer(kind, a.integer);
    return none;
}

Constant constant_call(Kind kind, const char *name, const Constant *operands, int count) {
    static const char *const makers[] = {"float", "int", "uint"};
    for (int k = 0; k < count; k++)
        if (!operands[k].kind) return none;
    for (size_t k = 0; k < sizeof makers / sizeof makers[0]; k++)
        if (count == 1 && strcmp(makers[k], name) == 0) return converted(kind, operands[0]);
    for (int k = 0; k < count; k++)
        if (operands[k].kind != KIND_FLOAT) return none;
    if (count == 1) return of_one(name, operands[0].number);
    if (count == 2) return of_two(name, operands[0].number, operands[1].number);
    return count == 3 ? of_three(name, operands[0].number, operands[1].number, operands[2].number) : none;
}
