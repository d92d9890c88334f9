/* run_value.c - expressions */
#include <stdlib.h>

#include "text/flat/run.h"

ShaderValue run_wrong(Run *run, const char *what) {
    if (!run->wrong) run->wrong = what;
    run->nothing = (GraphNode){.op = NODE_UNKNOWN, .home = run->graph.whole};
    for (int k = 0; k < LEAVES_MOST; k++) run->nothings[k] = &run->nothing;
    return (ShaderValue){KIND_NONE, run->nothings, false};
}

ShaderValue run_wrong_name(Run *run, const char *what, Symbol name) {
    if (!run->wrong) run->wrong_name = name;
    return run_wrong(run, what);
}

ShaderValue run_leaves(Run *run, Kind kind) {
    const int count = run->kinds.shapes[kind].leaf_count;
    GraphNode **leaves = arena_array(&run->arena, (size_t)count + 1, sizeof(GraphNode *));
    return leaves ? (ShaderValue){kind, leaves, false} : run_wrong(run, "memory is short");
}

ShaderValue run_of_node(Run *run, GraphNode *node) {
    ShaderValue value = run_leaves(run, node->kind);
    value.leaves[0] = node;
    return value;
}

GraphNode *run_number(Run *run, const Expr *expr, Kind kind) {
    const ShaderValue value = run_value(run, expr);
    if (value.kind != kind || value.whole) run_wrong(run, "a number of another type");
    return run->wrong ? graph_unknown(&run->graph, kind) : value.leaves[0];
}

static ShaderValue literal(Run *run, Token word) {
    char text[40];
    if (word.size >= sizeof text) return run_wrong(run, "a number");
    memcpy(text, word.at, word.size);
    text[word.size] = '\0';
    const bool hex = word.size > 1 && (text[1] == 'x' || text[1] == 'X');
    char *end;
    if (!hex && strpbrk(text, ".eEf")) {
        const float x = strtof(text, &end);
        if (strcmp(end, "") != 0 && strcmp(end, "f") != 0) return run_wrong(run, "a number");
        return run_of_node(run, graph_float(&run->graph, x));
    }
    const unsigned long x = strtoul(text, &end, 0);
    const bool natural = strcmp(end, "u") == 0 || strcmp(end, "U") == 0;
    if ((*end && !natural) || x > 0xffffffffu) return run_wrong(run, "a number");
    return run_of_node(run, graph_integer(&run->graph, natural ? KIND_UINT : KIND_INT, (int)(unsigned)x));
}

static ShaderValue named(Run *run, Symbol name) {
    if (name == run->true_name || name == run->false_name)
        return run_of_node(run, graph_bool(&run->graph, name == run->true_name));
    if (run->constants[name].kind) return run->constants[name];
    const Kind kind = run->outside[name];
    if (!kind) return run_wrong_name(run, "a name", name);
    ShaderValue value = run_of_node(run, graph_outside(&run->graph, kind, name));
    value.whole = run->kinds.shapes[kind].element != KIND_NONE;
    return value;
}

static ShaderValue member(Run *run, const Expr *expr) {
    const ShaderValue value = run_value(run, expr->a);
    const Shape *shape = &run->kinds.shapes[value.kind];
    for (int k = 0; shape->members && k < shape->count; k++)
        if (shape->members[k].name == expr->name)
            return (ShaderValue){shape->members[k].kind, value.leaves + shape->members[k].first, false};
    int count;
    const int word = run_components(run, expr->name, value.kind, &count);
    if (!count || kind_size(value.kind) < 2 || value.whole) return run_wrong_name(run, "a member", expr->name);
    const Kind kind = kind_vector(kind_base(value.kind), count);
    return run_of_node(run, graph_part(&run->graph, kind, word, value.leaves[0]));
}

/* Returns the kind of an element of a vector, a matrix or an array outside, KIND_NONE if it has none. */
static Kind element_kind(const Run *run, Kind kind) {
    if (kind_size(kind) > 1) return kind_vector(kind_base(kind), 1);
    if (kind_matrix(kind)) return kind_vector(BASE_FLOAT, kind_matrix(kind));
    return run->kinds.shapes[kind].element;
}

/* Returns an element of an array that is taken apart. */
static ShaderValue element_of(Run *run, ShaderValue array, Kind kind, GraphNode *at) {
    const int stride = run->kinds.shapes[kind].leaf_count, count = run->kinds.shapes[array.kind].count;
    if (node_is_constant(at)) {
        if (at->integer < 0 || at->integer >= count) return run_wrong(run, "an index beyond its array");
        return (ShaderValue){kind, array.leaves + stride * at->integer, false};
    }
    ShaderValue value = run_leaves(run, kind);
    for (int j = 0; j < stride && !run->wrong; j++) {
        value.leaves[j] = array.leaves[(count - 1) * stride + j];
        for (int k = count - 2; k >= 0; k--) {
            GraphNode *is =
                graph_binary(&run->graph, KIND_BOOL, OPERATOR('=', '='), at, graph_integer(&run->graph, KIND_INT, k));
            value.leaves[j] = graph_select(&run->graph, is, array.leaves[k * stride + j], value.leaves[j]);
        }
    }
    return value;
}

static ShaderValue element(Run *run, const Expr *expr) {
    const ShaderValue value = run_value(run, expr->a);
    const Kind kind = element_kind(run, value.kind);
    GraphNode *at = run_number(run, expr->b, KIND_INT);
    if (!kind || run->wrong) return run_wrong(run, "an index");
    const Shape *shape = &run->kinds.shapes[value.kind];
    if (shape->element && !value.whole) {
        return element_of(run, value, kind, at);
    }
    return run_of_node(run, graph_index(&run->graph, kind, value.leaves[0], at));
}

static ShaderValue unary(Run *run, const Expr *expr) {
    const ShaderValue a = run_value(run, expr->a);
    const BaseType base = kind_base(a.kind);
    const bool negates = expr->op == '-' && (base == BASE_FLOAT || base == BASE_INT);
    const bool flips = expr->op == '~' && (base == BASE_INT || base == BASE_UINT);
    if (!negates && !flips && !(expr->op == '!' && a.kind == KIND_BOOL)) return run_wrong(run, "a sign");
    return run_of_node(run, graph_unary(&run->graph, a.kind, expr->op, a.leaves[0]));
}

static bool compares(Operator op) {
    return op == '<' || op == '>' || op == OPERATOR('<', '=') || op == OPERATOR('>', '=');
}
static bool equates(Operator op) { return op == OPERATOR('=', '=') || op == OPERATOR('!', '='); }

/* Returns the kind of a product that a matrix takes part in, else KIND_NONE. */
static Kind product_kind(Operator op, Kind a, Kind b) {
    const int n = kind_matrix(a) ? kind_matrix(a) : kind_matrix(b);
    const Kind vector = kind_vector(BASE_FLOAT, n);
    if (!n || op != '*') return KIND_NONE;
    if (a == b || b == KIND_FLOAT) return a;
    if (a == KIND_FLOAT) return b;
    return a == vector || b == vector ? vector : KIND_NONE;
}

/* Returns the kind of a op b, KIND_NONE if GLSL has no such operation. */
static Kind binary_kind(Operator op, Kind a, Kind b) {
    const BaseType base = kind_base(a);
    const int m = kind_size(a), n = kind_size(b);
    const bool whole = base == BASE_INT || base == BASE_UINT;
    if (kind_matrix(a) || kind_matrix(b)) return product_kind(op, a, b);
    if (!base || base != kind_base(b)) return KIND_NONE;
    if (compares(op)) return m == 1 && n == 1 && base != BASE_BOOL ? KIND_BOOL : KIND_NONE;
    if (equates(op)) return a == b ? KIND_BOOL : KIND_NONE;
    if (base == BASE_BOOL) return KIND_NONE;
    if (!strchr("+-*/", op) && !whole) return KIND_NONE;
    if (m != n && m != 1 && n != 1) return KIND_NONE;
    return m > n ? a : b;
}

static ShaderValue binary_of(Run *run, Operator op, ShaderValue a, ShaderValue b) {
    const Kind kind = a.whole || b.whole ? KIND_NONE : binary_kind(op, a.kind, b.kind);
    if (!kind) return run_wrong(run, "an operator between these types");
    return run_of_node(run, graph_binary(&run->graph, kind, op, a.leaves[0], b.leaves[0]));
}

/* An expression of which one branch is wanted, and the slot for its value. */
typedef struct Arm {
    const Expr *expr;
    GraphNode *node; /* the value, if there is no expression */
    int slot;
} Arm;

static void run_arm(Run *run, const void *what) {
    const Arm *arm = what;
    GraphNode *node = arm->node;
    if (arm->expr) {
        const ShaderValue value = run_value(run, arm->expr);
        if (value.kind >= KIND_OWN || value.whole) {
            run_wrong(run, "?: between records");
            return;
        }
        node = value.leaves[0];
    }
    const GraphNode *before = run->slots[arm->slot];
    if (before->kind && before->kind != node->kind) {
        run_wrong(run, "?: between types");
        return;
    }
    run_set(run, arm->slot, node);
}

/* Returns condition ? a : b, of which an expression is computed only where it is needed. */
static ShaderValue choice(Run *run, GraphNode *condition, Arm a, Arm b) {
    const int slot = run->slot_count;
    if (slot == SLOTS_MOST) return run_wrong(run, "too many variables");
    run->slots[run->slot_count++] = graph_unknown(&run->graph, KIND_NONE);
    a.slot = b.slot = slot;
    run_branch(run, condition, run_arm, &a, run_arm, &b, true);
    run->slot_count = slot;
    return run->wrong ? run_wrong(run, "") : run_of_node(run, run->slots[slot]);
}

static ShaderValue selected(Run *run, const Expr *expr) {
    GraphNode *condition = run_number(run, expr->a, KIND_BOOL);
    if (run->wrong) return run_wrong(run, "");
    return choice(run, condition, (Arm){.expr = expr->b}, (Arm){.expr = expr->c});
}

static ShaderValue both(Run *run, const Expr *expr, bool all) {
    GraphNode *a = run_number(run, expr->a, KIND_BOOL);
    if (run->wrong) return run_wrong(run, "");
    const Arm right = {.expr = expr->b}, left = {.node = graph_bool(&run->graph, !all)};
    const ShaderValue value = choice(run, a, all ? right : left, all ? left : right);
    return value.kind == KIND_BOOL ? value : run_wrong(run, "&& of what is no bool");
}

static ShaderValue binary(Run *run, const Expr *expr) {
    if (expr->op == OPERATOR('&', '&')) return both(run, expr, true);
    if (expr->op == OPERATOR('|', '|')) return both(run, expr, false);
    const ShaderValue a = run_value(run, expr->a), b = run_value(run, expr->b);
    return binary_of(run, expr->op, a, b);
}

static ShaderValue assign(Run *run, const Expr *expr) {
    ShaderValue value = run_value(run, expr->b), before = value;
    VariablePlace place;
    if (run->wrong || !run_place(run, expr->a, &place)) return run_wrong(run, "an assignment to no variable");
    if (expr->op) {
        before = run_read(run, &place);
        if (before.kind == KIND_UINT && value.kind == KIND_INT && value.leaves[0]->op == NODE_NUMBER)
            value = run_of_node(run, graph_integer(&run->graph, KIND_UINT, value.leaves[0]->integer)); /* k++ */
        value = binary_of(run, expr->op, before, value);
    }
    if (!run->wrong) run_write(run, &place, value);
    return expr->before ? before : value;
}

ShaderValue run_value(Run *run, const Expr *expr) {
    VariablePlace place;
    if (run->wrong || run->graph.failed) return run_wrong(run, "too large");
    if (run_place(run, expr, &place)) return run_read(run, &place);
    switch (expr->kind) {
    case EXPR_NUMBER: return literal(run, expr->word);
    case EXPR_NAME: return named(run, expr->name);
    case EXPR_CALL: return run_call(run, expr);
    case EXPR_MEMBER: return member(run, expr);
    case EXPR_INDEX: return element(run, expr);
    case EXPR_UNARY: return unary(run, expr);
    case EXPR_BINARY: return binary(run, expr);
    case EXPR_SELECT: return selected(run, expr);
    case EXPR_ASSIGN: return assign(run, expr);
    }
    return run_wrong(run, "an expression");
}
