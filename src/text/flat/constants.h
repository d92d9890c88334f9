/* constants.h - operators and functions of GLSL on constant numbers, in single precision as on a GPU */
#pragma once

#include "text/flat/kinds.h"

/* A number; KIND_NONE: not constant, or not a number. */
typedef struct Constant {
    Kind kind;
    union {
        float number;
        int integer; /* bits of uint, and 0 or 1 of bool */
    };
} Constant;

/* Return the result, of kind KIND_NONE if an operand is not constant or the result is none that a text can have. */
Constant constant_unary(Operator op, Constant a);
Constant constant_binary(Operator op, Constant a, Constant b);
Constant constant_call(Kind kind, const char *name, const Constant *operands, int count);
