/* run_branch.c - two ways through a text, and what they leave behind */
#include <stdlib.h>

#include "text/flat/run.h"

/* Two branches with few new values are computed both: a choice costs less than an if. A look-up counts as many. */
enum { VALUES_FEW = 24, VALUES_LOOKUP = 25 };

/* Returns what nodes from `before` on cost, in values. */
static int cost_since(const Graph *graph, int before) {
    int cost = 0;
    for (int k = before; k < graph->count; k++) {
        const GraphNode *node = graph->nodes[k];
        const bool looks = node->op == NODE_CALL && kind_is_sampler(node_operand(node, 0)->kind);
        cost += looks ? VALUES_LOOKUP : 1;
    }
    return cost;
}

/* Notes that a bool has a value, and what follows for its parts. */
static void learn(Run *run, const GraphNode *node, bool value) {
    const bool all = node->op == NODE_BINARY && node->word == OPERATOR('&', '&') && value;
    const bool none = node->op == NODE_BINARY && node->word == OPERATOR('|', '|') && !value;
    if (node->op == NODE_UNARY) {
        learn(run, node_operand(node, 0), !value);
        return;
    }
    if (all || none)
        for (int k = 0; k < 2; k++) learn(run, node_operand(node, k), value);
    if (run->fact_count < FACTS_MOST) run->facts[run->fact_count++] = (Fact){node, value};
}

/* Returns 1 or 0 for a bool whose value is known here, else -1. */
static int known(const Run *run, const GraphNode *node) {
    if (node_is_constant(node)) return node->integer != 0;
    if (node->op == NODE_UNARY) {
        const int inner = known(run, node_operand(node, 0));
        return inner < 0 ? -1 : !inner;
    }
    for (int k = run->fact_count - 1; k >= 0; k--)
        if (run->facts[k].node == node) return run->facts[k].value;
    if (node->op != NODE_BINARY) return -1;
    const bool both = node->word == OPERATOR('&', '&'), either = node->word == OPERATOR('|', '|');
    if (!both && !either) return -1;
    const int a = known(run, node_operand(node, 0)), b = known(run, node_operand(node, 1));
    if (a == (int)either || b == (int)either) return either;
    return a == (int)both && b == (int)both ? both : -1;
}

/* The slots that a branch changed. */
typedef struct Left {
    Change *all; /* the value after the branch in place of the one before */
    int count;
} Left;

typedef struct BranchJoin {
    Run *run;
    GraphNode *condition;
    Region *then, *other;
    int slots; /* those there before */
    Left left[2];
    bool select;
    Flow *flow;
} BranchJoin;

/* Runs a branch, and takes its changes back. */
static Left tried(Run *run, const BranchJoin *join, bool side, Branch *branch, const void *what) {
    const int mark = run->change_count, variables = run->variable_count, slot_count = run->slot_count;
    const int facts = run->fact_count, slots = join->slots;
    Region *outer = run->region;
    Left left = {NULL, 0};
    run->region = side ? join->then : join->other;
    learn(run, join->condition, side);
    if (branch) branch(run, what);
    run->region = outer;
    run->fact_count = facts;
    run->variable_count = variables;
    run->slot_count = slot_count;
    run->stamp++;
    left.all = arena_array(&run->arena, (size_t)(run->change_count - mark) + 1, sizeof *left.all);
    if (!left.all) run_wrong(run, "memory is short");
    for (int k = mark; k < run->change_count && left.all; k++) {
        const int slot = run->changes[k].slot;
        if (slot >= slots || run->stamps[slot] == run->stamp) continue;
        run->stamps[slot] = run->stamp;
        left.all[left.count++] = (Change){slot, run->slots[slot]};
    }
    run_undo(run, mark);
    return left;
}

static bool is_empty(const Region *region) { return !region->first && !region->pinned; }

static Flow *flow_of(BranchJoin *join) {
    if (join->flow) return join->flow;
    Run *run = join->run;
    join->flow = graph_flow(&run->graph, run->region, FLOW_IF, join->condition);
    join->flow->body = join->then;
    join->flow->other = join->other;
    join->then->owner = join->other->owner = join->flow;
    join->flow->phis =
        arena_array(&run->graph.arena, (size_t)(join->left[0].count + join->left[1].count) + 1, sizeof(GraphNode *));
    if (!join->flow->phis) run_wrong(run, "memory is short");
    return join->flow;
}

/* Returns the value after both branches: a where the condition held, else b. */
static GraphNode *joined(BranchJoin *join, GraphNode *a, GraphNode *b) {
    Run *run = join->run;
    const bool a_out = region_within(run->region, a->home), b_out = region_within(run->region, b->home);
    if (a->kind && b->kind && a->kind != b->kind) run_wrong(run, "a choice between types");
    if (a == b || (a_out && b->op == NODE_UNKNOWN)) return a;
    if (b_out && a->op == NODE_UNKNOWN) return b;
    const bool simple = a->kind == KIND_BOOL &&
                        (node_is_constant(a) || node_is_constant(b) || a == join->condition || b == join->condition);
    if (a_out && b_out && (join->select || simple)) return graph_select(&run->graph, join->condition, a, b);
    Flow *flow = flow_of(join);
    GraphNode *phi = graph_phi(&run->graph, NODE_PHI, a->kind ? a->kind : b->kind, run->region, a, b);
    phi->flow = flow;
    if (!run->wrong) flow->phis[flow->phi_count++] = phi;
    return phi;
}

/* Sets the slots that the first branch left, or those that the second left alone. */
static void join_left(BranchJoin *join, int side) {
    Run *run = join->run;
    const Left *mine = &join->left[side], *others = &join->left[!side];
    for (int k = 0; k < mine->count && !run->wrong; k++) {
        const int slot = mine->all[k].slot;
        GraphNode *other = run->slots[slot];
        bool both = false;
        for (int j = 0; j < others->count && !both; j++) {
            both = others->all[j].slot == slot;
            if (both) other = others->all[j].before;
        }
        if (side && both) continue;
        GraphNode *own = mine->all[k].before;
        run_set(run, slot, side ? joined(join, other, own) : joined(join, own, other));
    }
}

void run_branch(Run *run, GraphNode *condition, Branch *then, const void *a, Branch *other, const void *b,
                bool select) {
    const int value = known(run, condition);
    if (value >= 0) {
        Branch *taken = value ? then : other;
        if (taken) taken(run, value ? a : b);
        return;
    }
    const int before = run->graph.count, slots = run->slot_count;
    BranchJoin join = {.run = run, .condition = condition, .slots = slots};
    join.then = graph_region(&run->graph, run->region, false);
    join.other = graph_region(&run->graph, run->region, false);
    join.left[0] = tried(run, &join, true, then, a);
    join.left[1] = tried(run, &join, false, other, b);
    if (run->wrong) return;
    join.select =
        is_empty(join.then) && is_empty(join.other) && (select || cost_since(&run->graph, before) <= VALUES_FEW);
    if (join.then->first || join.other->first) flow_of(&join);
    join_left(&join, 0);
    join_left(&join, 1);
}
