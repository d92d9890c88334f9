/* graph.h - values of a shader as a graph: equal values are one node, and constants are folded
 *
 * A node is a number, a vector or a matrix. Nodes have no effects, so a node is computed wherever it is needed; what
 * depends on the path taken is a phi of an if or of a loop. The regions of a shader, its main function, the branches
 * of ifs and the bodies of loops, form a tree. */
#pragma once

#include "text/flat/kinds.h"

struct Flow;

/* Statements in a row: the whole shader, a branch, or the body of a loop. */
typedef struct Region {
    struct Region *parent;
    struct Flow *owner; /* NULL: the whole shader */
    bool loop;
    int depth;
    int pinned; /* nodes that belong to it and no other */
    struct Flow *first, **last;
    struct GraphNode *nodes, **end; /* set by placement_of: those with names, in the order of their making */
} Region;

typedef enum NodeOp {
    NODE_NUMBER,  /* a constant number */
    NODE_OUTSIDE, /* a uniform, an input, or a whole array of them: word is its name */
    NODE_UNARY,   /* word is the operator */
    NODE_BINARY,
    NODE_CALL,     /* word is the name of a function or type of GLSL */
    NODE_PART,     /* components: word has two bits for each, the first in the lowest */
    NODE_INDEX,    /* operand 0 at operand 1 */
    NODE_SELECT,   /* operand 0 ? operand 1 : operand 2 */
    NODE_PHI,      /* after an if: operand 0 where its condition held, else operand 1 */
    NODE_LOOP_PHI, /* in a loop: operand 0 at first, then operand 1 of the round before */
    NODE_EXIT,     /* operand 0, a loop's phi, after the loop */
    NODE_UNKNOWN   /* of a variable that has no value yet */
} NodeOp;

typedef struct GraphNode {
    NodeOp op;
    Kind kind;
    int word;
    union {
        float number;
        int integer; /* bits of uint, and 0 or 1 of bool */
    };
    struct GraphNode *operands[4], **more; /* more: all of them, if there are over 4 */
    int count;
    Region *home;           /* the innermost region without which the value does not exist */
    bool pinned;            /* belongs to `home` and no other region */
    struct Flow *flow;      /* of a phi */
    struct GraphNode *next; /* with the same hash */
    unsigned hash;
    int serial;
    /* Set by placement_of (text/flat/placement.h). */
    bool live;
    int uses, length;        /* length: operations in the text of its value */
    int name;                /* of the variable that has its value; 0: none */
    Region *place;           /* where it is computed */
    Region *user;            /* of a use; the only one if there is one */
    struct GraphNode *after; /* the next of the nodes with names that are computed in the same region */
} GraphNode;

typedef enum FlowKind {
    FLOW_IF,
    FLOW_LOOP,
    FLOW_STAY, /* leaves the loop unless the condition holds */
    FLOW_DISCARD,
    FLOW_OUTPUT /* condition is the value */
} FlowKind;

typedef struct Flow {
    FlowKind kind;
    Region *region; /* around this flow */
    GraphNode *condition;
    Region *body, *other;
    int after; /* the serial of the first node made after it */
    GraphNode **phis;
    int phi_count;
    Symbol name; /* of an output */
    bool live;
    struct Flow *next;
} Flow;

enum { GRAPH_BUCKETS = 1 << 14, GRAPH_MOST = 1 << 18 };

typedef struct Graph {
    Arena arena;
    const Kinds *kinds;
    GraphNode *buckets[GRAPH_BUCKETS];
    GraphNode **nodes; /* in the order of their making: operands first */
    int count, capacity;
    Region *whole;
    bool failed;     /* too many nodes, or memory is short */
    GraphNode spare; /* for what is made then, and never read */
    Region spare_region;
    Flow spare_flow;
} Graph;

bool graph_begin(Graph *graph, const Kinds *kinds);
void graph_free(Graph *graph);

/* Forgets the nodes made after the first `count`. */
void graph_rewind(Graph *graph, int count);

Region *graph_region(Graph *graph, Region *parent, bool loop);

/* Appends a flow to a region. */
Flow *graph_flow(Graph *graph, Region *region, FlowKind kind, GraphNode *condition);

GraphNode *graph_float(Graph *graph, float x);
GraphNode *graph_integer(Graph *graph, Kind kind, int x); /* int, uint or bool */
static inline GraphNode *graph_bool(Graph *graph, bool x) { return graph_integer(graph, KIND_BOOL, x); }
GraphNode *graph_outside(Graph *graph, Kind kind, Symbol name);
GraphNode *graph_unknown(Graph *graph, Kind kind);
GraphNode *graph_unary(Graph *graph, Kind kind, Operator op, GraphNode *a);
GraphNode *graph_binary(Graph *graph, Kind kind, Operator op, GraphNode *a, GraphNode *b);
GraphNode *graph_select(Graph *graph, GraphNode *condition, GraphNode *a, GraphNode *b);
GraphNode *graph_part(Graph *graph, Kind kind, int word, GraphNode *of);
GraphNode *graph_index(Graph *graph, Kind kind, GraphNode *of, GraphNode *at);
GraphNode *graph_phi(Graph *graph, NodeOp op, Kind kind, Region *home, GraphNode *a,
                     GraphNode *b); /* never one with another */

/* Returns a call of GLSL's own. pinned: the region to which it belongs, since neighbouring pixels take part; else
 * NULL. */
GraphNode *graph_call(Graph *graph, Kind kind, Symbol name, const char *spelled, GraphNode *const *operands, int count,
                      Region *pinned);

static inline GraphNode *node_operand(const GraphNode *node, int k) {
    return node->more ? node->more[k] : node->operands[k];
}

/* Return true for a constant, for that bool, and for a number or a vector all of whose components are x. */
static inline bool node_is_constant(const GraphNode *node) { return node->op == NODE_NUMBER; }
static inline bool node_is_bool(const GraphNode *node, bool x) {
    return node->op == NODE_NUMBER && node->kind == KIND_BOOL && node->integer == (int)x;
}

/* Returns true if `inner` is `outer` or in it. */
bool region_within(const Region *inner, const Region *outer);
