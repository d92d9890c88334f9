#include "text/flat/graph.h"

#include <stdlib.h>

#include "base/equal.h"
#include "text/flat/constants.h"

enum { ROW_MOST = 6 };

bool graph_begin(Graph *graph, const Kinds *kinds) {
    memset(graph, 0, sizeof *graph);
    graph->kinds = kinds;
    graph->whole = graph_region(graph, NULL, false);
    return !graph->failed;
}

void graph_free(Graph *graph) {
    free(graph->nodes);
    arena_free(&graph->arena);
}

void graph_rewind(Graph *graph, int count) {
    while (graph->count > count) {
        GraphNode *last = graph->nodes[--graph->count];
        GraphNode **bucket = &graph->buckets[last->hash % GRAPH_BUCKETS];
        if (last->pinned) last->home->pinned--;
        if (*bucket == last) *bucket = last->next; /* a phi is in none */
    }
}

Region *graph_region(Graph *graph, Region *parent, bool loop) {
    Region *made = arena_array(&graph->arena, 1, sizeof *made);
    if (!made) {
        graph->failed = true;
        made = &graph->spare_region;
    }
    *made = (Region){.parent = parent, .loop = loop, .depth = parent ? parent->depth + 1 : 0};
    made->last = &made->first;
    return made;
}

Flow *graph_flow(Graph *graph, Region *region, FlowKind kind, GraphNode *condition) {
    Flow *made = arena_array(&graph->arena, 1, sizeof *made);
    if (!made) {
        graph->failed = true;
        made = &graph->spare_flow;
    }
    *made = (Flow){.kind = kind, .region = region, .condition = condition, .after = graph->count};
    *region->last = made;
    region->last = &made->next;
    return made;
}

bool region_within(const Region *inner, const Region *outer) {
    while (inner && inner->depth > outer->depth) inner = inner->parent;
    return inner == outer;
}

static unsigned hash_of(const GraphNode *node) {
    unsigned hash = 2166136261u;
    const unsigned words[] = {(unsigned)node->op, (unsigned)node->kind, (unsigned)node->word, (unsigned)node->integer};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) hash = (hash ^ words[k]) * 16777619u;
    for (int k = 0; k < node->count; k++) hash = (hash ^ (unsigned)node_operand(node, k)->serial) * 16777619u;
    return hash ^ hash >> 15;
}

static bool same(const GraphNode *a, const GraphNode *b) {
    if (a->hash != b->hash || a->op != b->op || a->kind != b->kind || a->word != b->word || a->integer != b->integer ||
        a->count != b->count)
        return false;
    for (int k = 0; k < a->count; k++)
        if (node_operand(a, k) != node_operand(b, k)) return false;
    return true;
}

static void set_home(const Graph *graph, GraphNode *node) {
    if (!node->home) node->home = graph->whole;
    for (int k = 0; k < node->count; k++) {
        Region *home = node_operand(node, k)->home;
        if (home->depth > node->home->depth) node->home = home;
    }
}

/* Stores a node. Returns a spare one, and fails, if there are too many. */
static GraphNode *store(Graph *graph, const GraphNode *node) {
    if (graph->count == graph->capacity) {
        const int more = graph->capacity ? 2 * graph->capacity : 4096;
        GraphNode **grown = more <= GRAPH_MOST ? realloc_array(graph->nodes, (size_t)more, sizeof(GraphNode *)) : NULL;
        if (grown) {
            graph->nodes = grown;
            graph->capacity = more;
        }
    }
    GraphNode *made = graph->count < graph->capacity ? arena_array(&graph->arena, 1, sizeof *made) : NULL;
    if (!made) {
        graph->failed = true;
        graph->spare = *node;
        graph->spare.home = graph->whole;
        return &graph->spare;
    }
    *made = *node;
    set_home(graph, made);
    made->serial = graph->count;
    graph->nodes[graph->count++] = made;
    return made;
}

/* Returns the node that equals this one, or stores it. A pinned node serves its own region and those in it. */
static GraphNode *find_or_store(Graph *graph, GraphNode *node) {
    node->hash = hash_of(node);
    GraphNode **bucket = &graph->buckets[node->hash % GRAPH_BUCKETS];
    for (GraphNode *one = *bucket; one; one = one->next)
        if (same(one, node) && (!node->home || region_within(node->home, one->home))) return one;
    GraphNode *made = store(graph, node);
    if (graph->failed) return made;
    made->pinned = node->home != NULL;
    if (made->pinned) made->home->pinned++;
    made->next = *bucket;
    *bucket = made;
    return made;
}

GraphNode *graph_float(Graph *graph, float x) {
    return find_or_store(graph, &(GraphNode){.op = NODE_NUMBER, .kind = KIND_FLOAT, .number = x});
}

GraphNode *graph_integer(Graph *graph, Kind kind, int x) {
    return find_or_store(graph, &(GraphNode){.op = NODE_NUMBER, .kind = kind, .integer = x});
}

GraphNode *graph_outside(Graph *graph, Kind kind, Symbol name) {
    return find_or_store(graph, &(GraphNode){.op = NODE_OUTSIDE, .kind = kind, .word = name});
}

GraphNode *graph_unknown(Graph *graph, Kind kind) {
    return find_or_store(graph, &(GraphNode){.op = NODE_UNKNOWN, .kind = kind});
}

static GraphNode *of_constant(Graph *graph, Constant c) {
    return c.kind == KIND_FLOAT ? graph_float(graph, c.number) : graph_integer(graph, c.kind, c.integer);
}

static Constant constant_of(const GraphNode *node) {
    Constant c = {.kind = node->op == NODE_NUMBER ? node->kind : KIND_NONE};
    c.integer = node->integer;
    if (node->kind == KIND_FLOAT) c.number = node->number;
    return c;
}

GraphNode *graph_unary(Graph *graph, Kind kind, Operator op, GraphNode *a) {
    const Constant folded = constant_unary(op, constant_of(a));
    if (folded.kind) return of_constant(graph, folded);
    if (a->op == NODE_UNARY && a->word == op) return node_operand(a, 0);
    return find_or_store(graph, &(GraphNode){.op = NODE_UNARY, .kind = kind, .word = op, .operands = {a}, .count = 1});
}

/* Returns true for a vector made of its components. */
static bool makes_vector(const Graph *graph, const GraphNode *node) {
    return node->op == NODE_CALL && kind_size(node->kind) > 1 && node->word == graph->kinds->shapes[node->kind].name;
}

/* Returns true if a node is the number x, or a vector or matrix made of it alone. */
static bool is_all(const Graph *graph, const GraphNode *node, float x) {
    if (node->op == NODE_NUMBER) {
        const bool whole = node->kind == KIND_INT || node->kind == KIND_UINT;
        return node->kind == KIND_FLOAT ? is_equal(node->number, x) : whole && is_equal((float)node->integer, x);
    }
    if (!makes_vector(graph, node)) return false;
    for (int k = 0; k < node->count; k++)
        if (!is_all(graph, node_operand(node, k), x)) return false;
    return true;
}

/* Returns true if `one` is among the operands of a row of one operator: a || b || c. */
static bool is_among(const GraphNode *one, const GraphNode *row, Operator op, int depth) {
    if (one == row) return true;
    if (!depth || row->op != NODE_BINARY || row->word != op) return false;
    return is_among(one, node_operand(row, 0), op, depth - 1) || is_among(one, node_operand(row, 1), op, depth - 1);
}

/* Returns 0 in each component. */
static GraphNode *zero_of(Graph *graph, Kind kind) {
    GraphNode *zero = kind_base(kind) == BASE_FLOAT || kind_matrix(kind)
                          ? graph_float(graph, 0.0f)
                          : graph_integer(graph, kind_vector(kind_base(kind), 1), 0);
    const Symbol name = graph->kinds->shapes[kind].name;
    return kind == zero->kind ? zero : graph_call(graph, kind, name, "", &zero, 1, NULL);
}

/* Returns what a operator b is if one of them says it alone, or NULL. As drivers do, 0 x is 0 for every x. */
static GraphNode *simpler(Graph *graph, Kind kind, Operator op, GraphNode *a, GraphNode *b) {
    const bool as_a = a->kind == kind, as_b = b->kind == kind;
    switch (op) {
    case '+':
        if (as_b && is_all(graph, a, 0.0f)) return b;
        return as_a && is_all(graph, b, 0.0f) ? a : NULL;
    case '-': return as_a && is_all(graph, b, 0.0f) ? a : NULL;
    case '*':
        if (as_b && is_all(graph, a, 1.0f)) return b;
        if (as_a && is_all(graph, b, 1.0f)) return a;
        return is_all(graph, a, 0.0f) || is_all(graph, b, 0.0f) ? zero_of(graph, kind) : NULL;
    case '/':
        if (as_a && is_all(graph, a, 0.0f)) return a;
        return as_a && is_all(graph, b, 1.0f) ? a : NULL;
    case OPERATOR('&', '&'):
        if (node_is_bool(a, true) || node_is_bool(b, false) || is_among(a, b, op, ROW_MOST)) return b;
        return node_is_bool(b, true) || node_is_bool(a, false) || is_among(b, a, op, ROW_MOST) ? a : NULL;
    case OPERATOR('|', '|'):
        if (node_is_bool(a, false) || node_is_bool(b, true) || is_among(a, b, op, ROW_MOST)) return b;
        return node_is_bool(b, false) || node_is_bool(a, true) || is_among(b, a, op, ROW_MOST) ? a : NULL;
    case OPERATOR('=', '='):
    case OPERATOR('!', '='):
        if (kind_base(a->kind) != BASE_FLOAT && a == b) return graph_bool(graph, op == OPERATOR('=', '='));
        return NULL;
    default: return NULL;
    }
}

GraphNode *graph_binary(Graph *graph, Kind kind, Operator op, GraphNode *a, GraphNode *b) {
    const Constant folded = constant_binary(op, constant_of(a), constant_of(b));
    if (folded.kind) return of_constant(graph, folded);
    GraphNode *known = simpler(graph, kind, op, a, b);
    if (known) return known;
    const bool swaps = op == '+' || (op == '*' && !kind_matrix(a->kind) && !kind_matrix(b->kind));
    const bool swapped = swaps && !node_is_constant(b) && (node_is_constant(a) || a->serial > b->serial);
    GraphNode *first = swapped ? b : a, *second = swapped ? a : b;
    return find_or_store(
        graph, &(GraphNode){.op = NODE_BINARY, .kind = kind, .word = op, .operands = {first, second}, .count = 2});
}

static GraphNode *negation(Graph *graph, GraphNode *a) { return graph_unary(graph, KIND_BOOL, '!', a); }

/* Returns the choice between bools of which one is constant or the condition, or NULL. */
static GraphNode *select_bool(Graph *graph, GraphNode *c, GraphNode *a, GraphNode *b) {
    const Operator both = OPERATOR('&', '&'), either = OPERATOR('|', '|');
    if (a == c || node_is_bool(a, true)) return graph_binary(graph, KIND_BOOL, either, c, b);
    if (b == c || node_is_bool(b, false)) return graph_binary(graph, KIND_BOOL, both, c, a);
    if (node_is_bool(a, false)) return graph_binary(graph, KIND_BOOL, both, negation(graph, c), b);
    if (node_is_bool(b, true)) return graph_binary(graph, KIND_BOOL, either, negation(graph, c), a);
    return NULL;
}

GraphNode *graph_select(Graph *graph, GraphNode *condition, GraphNode *a, GraphNode *b) {
    if (node_is_constant(condition)) return condition->integer ? a : b;
    if (a == b || b->op == NODE_UNKNOWN) return a;
    if (a->op == NODE_UNKNOWN) return b;
    if (condition->op == NODE_UNARY && condition->word == '!')
        return graph_select(graph, node_operand(condition, 0), b, a);
    GraphNode *known = a->kind == KIND_BOOL ? select_bool(graph, condition, a, b) : NULL;
    if (known) return known;
    return find_or_store(graph,
                         &(GraphNode){.op = NODE_SELECT, .kind = a->kind, .operands = {condition, a, b}, .count = 3});
}

/* Returns component k of a vector that a call makes of parts, or NULL. */
static GraphNode *component(Graph *graph, const GraphNode *vector, int k) {
    const BaseType base = kind_base(vector->kind);
    GraphNode *only = node_operand(vector, 0);
    if (vector->count == 1 && kind_size(only->kind) == 1) return kind_base(only->kind) == base ? only : NULL;
    for (int j = 0; j < vector->count; j++) {
        GraphNode *part = node_operand(vector, j);
        const int size = kind_size(part->kind);
        if (k >= size) {
            k -= size;
            continue;
        }
        return kind_base(part->kind) == base ? graph_part(graph, kind_vector(base, 1), k, part) : NULL;
    }
    return NULL;
}

/* Returns true if the components are the first ones in their order. */
static bool in_order(int word, int size) {
    for (int k = 0; k < size; k++)
        if ((word >> 2 * k & 3) != k) return false;
    return true;
}

/* Returns components of a vector made of parts, or NULL. */
static GraphNode *made_part(Graph *graph, Kind kind, int word, GraphNode *of) {
    const int size = kind_size(kind);
    if (size == 1) return component(graph, of, word & 3);
    GraphNode *first = node_operand(of, 0), *all[4];
    if (first->kind == kind && in_order(word, size)) return first;
    for (int k = 0; k < size; k++)
        if (!(all[k] = component(graph, of, word >> 2 * k & 3))) return NULL;
    return graph_call(graph, kind, graph->kinds->shapes[kind].name, "", all, size, NULL);
}

GraphNode *graph_part(Graph *graph, Kind kind, int word, GraphNode *of) {
    const int size = kind_size(kind);
    if (of->kind == kind && in_order(word, size)) return of;
    if (of->op == NODE_UNKNOWN) return graph_unknown(graph, kind);
    if (of->op == NODE_PART) {
        int inner = 0;
        for (int k = 0; k < size; k++) inner |= (of->word >> 2 * (word >> 2 * k & 3) & 3) << 2 * k;
        return graph_part(graph, kind, inner, node_operand(of, 0));
    }
    if (makes_vector(graph, of)) {
        GraphNode *made = made_part(graph, kind, word, of);
        if (made) return made;
    }
    return find_or_store(graph,
                         &(GraphNode){.op = NODE_PART, .kind = kind, .word = word, .operands = {of}, .count = 1});
}

GraphNode *graph_index(Graph *graph, Kind kind, GraphNode *of, GraphNode *at) {
    if (node_is_constant(at) && kind_size(of->kind) > 1) return graph_part(graph, kind, at->integer & 3, of);
    return find_or_store(graph, &(GraphNode){.op = NODE_INDEX, .kind = kind, .operands = {of, at}, .count = 2});
}

/* Returns a call whose value follows from its operands, or NULL. */
static GraphNode *folded_call(Graph *graph, Kind kind, Symbol name, const char *spelled, GraphNode *const *operands,
                              int count) {
    Constant all[3] = {{.kind = KIND_NONE}};
    for (int k = 0; k < count && k < 3; k++) all[k] = constant_of(operands[k]);
    const Constant folded = count <= 3 ? constant_call(kind, spelled, all, count) : (Constant){.kind = KIND_NONE};
    if (folded.kind) return of_constant(graph, folded);
    if (count == 1 && operands[0]->kind == kind && kind_base(kind) && graph->kinds->shapes[kind].name == name)
        return operands[0];
    if (strcmp(spelled, "mix") == 0 && operands[2]->kind == KIND_FLOAT) {
        if (is_all(graph, operands[2], 0.0f)) return operands[0];
        if (is_all(graph, operands[2], 1.0f)) return operands[1];
    }
    if (strcmp(spelled, "pow") == 0 && is_all(graph, operands[1], 1.0f)) return operands[0];
    return NULL;
}

GraphNode *graph_call(Graph *graph, Kind kind, Symbol name, const char *spelled, GraphNode *const *operands, int count,
                      Region *pinned) {
    GraphNode *folded = pinned ? NULL : folded_call(graph, kind, name, spelled, operands, count);
    if (folded) return folded;
    GraphNode node = {.op = NODE_CALL, .kind = kind, .word = name, .count = count, .home = pinned};
    if (count > 4) {
        node.more = arena_array(&graph->arena, (size_t)count, sizeof(GraphNode *));
        if (!node.more) {
            graph->failed = true;
            return graph_unknown(graph, kind);
        }
        memcpy(node.more, operands, (size_t)count * sizeof(GraphNode *));
    } else if (count) {
        memcpy(node.operands, operands, (size_t)count * sizeof(GraphNode *));
    }
    return find_or_store(graph, &node);
}

GraphNode *graph_phi(Graph *graph, NodeOp op, Kind kind, Region *home, GraphNode *a, GraphNode *b) {
    GraphNode *made =
        store(graph, &(GraphNode){.op = op, .kind = kind, .operands = {a, b}, .count = op == NODE_PHI ? 2 : 1});
    if (!graph->failed) made->home = home;
    return made;
}
