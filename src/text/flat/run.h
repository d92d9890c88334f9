/* run.h - a shader run once with values that are not known yet: calls are followed, records are their leaves
 *
 * What the statements do to numbers becomes a graph; what depends on a number that is not known becomes flows. */
#pragma once

#include "text/flat/graph.h"

/* The value of an expression. whole: an array outside the shader, which is not taken apart; leaves[0] is its node. */
typedef struct ShaderValue {
    Kind kind;
    GraphNode **leaves;
    bool whole;
} ShaderValue;

/* A variable's leaves lie in slots from `slot` on. */
typedef struct Variable {
    Symbol name;
    Kind kind;
    int slot;
} Variable;

/* A part of a variable: leaves from `slot` on. at: the index, not known, into an array of `count` elements of `stride`
 * leaves; NULL: none. part: components of one vector of kind `vector`, bits as in NODE_PART. */
typedef struct VariablePlace {
    Kind kind;
    int slot;
    GraphNode *at;
    int count, stride;
    bool part;
    int word;
    Kind vector;
} VariablePlace;

/* A function being run. Slots of bools: whether it has returned, and whether the innermost loop or switch is left or
 * the round of the innermost loop is over; -1: none. */
typedef struct CallFrame {
    int variables; /* index of the first variable */
    Kind kind;     /* of the result */
    int result, returned, broken, continued;
} CallFrame;

typedef struct Change {
    int slot;
    GraphNode *before;
} Change;

/* A bool that has a known value in the branch being run. */
typedef struct Fact {
    const GraphNode *node;
    bool value;
} Fact;

enum { FACTS_MOST = 256 };
enum { VARIABLES_MOST = 4096, SLOTS_MOST = 1 << 15, CALLS_MOST = 64 };

typedef struct Run {
    Syntax syntax;
    Kinds kinds;
    Graph graph;
    Arena arena;
    Declaration *functions[SYMBOLS_MOST]; /* by name */
    Kind outside[SYMBOLS_MOST];           /* of uniforms, inputs and what GLSL supplies, by name */
    ShaderValue constants[SYMBOLS_MOST];  /* of the text, by name */
    const struct GlslFunction *builtins[SYMBOLS_MOST];
    Symbol true_name, false_name, main_name;
    Variable variables[VARIABLES_MOST];
    int variable_count, global_count;
    GraphNode *slots[SLOTS_MOST];
    int stamps[SLOTS_MOST], stamp; /* marks slots that were met already */
    int slot_count;
    Change *changes; /* of slots, to be undone */
    int change_count, change_capacity;
    Fact facts[FACTS_MOST]; /* more are not noted */
    int fact_count;
    Region *region;
    CallFrame frame;
    int depth;                                 /* of calls */
    const char *wrong;                         /* what was not understood, NULL: all was */
    Symbol wrong_name;                         /* the name in question, 0: none */
    GraphNode nothing, *nothings[LEAVES_MOST]; /* the leaves of what is not understood */
} Run;

/* Runs the text's main. Returns false, with run->wrong, if something is not understood. Call run_free. */
bool run_text(const char *text, Run *run);
void run_free(Run *run);

/* The rest is for the files run_*.c. */

/* Notes the first thing that is not understood, and returns a value that stands for it. */
ShaderValue run_wrong(Run *run, const char *what);
ShaderValue run_wrong_name(Run *run, const char *what, Symbol name);

ShaderValue run_value(Run *run, const Expr *expr);
GraphNode *run_number(Run *run, const Expr *expr, Kind kind); /* the value of an expression of one leaf */
ShaderValue run_call(Run *run, const Expr *call);
ShaderValue run_builtin(Run *run, const Expr *call);
/* Returns the record of the members that a call with its name lists, or the vector, matrix or number of the parts. */
ShaderValue run_made(Run *run, const Expr *call, Kind kind);
ShaderValue run_of_node(Run *run, GraphNode *node);
ShaderValue run_leaves(Run *run, Kind kind); /* a value whose leaves the caller sets */
void run_builtins(Run *run);                 /* enters what GLSL supplies */

/* Returns false if the expression is no part of a variable. */
bool run_place(Run *run, const Expr *expr, VariablePlace *out);
ShaderValue run_read(Run *run, const VariablePlace *place);
void run_write(Run *run, const VariablePlace *place, ShaderValue value);

/* Components named as "xz" or "rgb" of a vector; 0 if they are none. *count is their number. */
int run_components(const Run *run, Symbol name, Kind vector, int *count);

/* Adds a variable without a value, and returns its first slot. */
int run_declare(Run *run, Symbol name, Kind kind);
Kind run_kind(Run *run, Symbol name, const Expr *size); /* a type as declared */
void run_set(Run *run, int slot, GraphNode *node);

/* Runs one of two things by a condition and joins what they leave in slots. select: computes both, unless they are
 * flows. */
typedef void Branch(Run *run, const void *what);
void run_branch(Run *run, GraphNode *condition, Branch *then, const void *a, Branch *other, const void *b, bool select);

void run_statements(Run *run, const StatementSyntax *first);
void run_loop(Run *run, StatementSyntax *loop);
void run_switch(Run *run, const StatementSyntax *statement);

/* Runs a statement as a block: its variables end with it. */
void run_scoped(Run *run, const StatementSyntax *statement);

/* Returns whether the statements that follow are skipped. */
GraphNode *run_stopped(Run *run);

/* Undoes changes from `mark` on. */
void run_undo(Run *run, int mark);
