/* run_branch.c - two ways through a text, and what they leave behind */
#include <stdlib.h>

#include "text/flat/run.h"

/* Two branches with few new values are computed both: a choice costs less than an if. */
enum { VALUES_FEW = 24 };

/* What a branch left in slots. */
typedef struct Left {
    Change *all; /* the value after the branch in place of the one before */
    int count;
} Left;

typedef struct Join {
    Run *run;
    Node *condition;
    Region *then, *other;
    int slots; /* those there before */
    Left left[2];
    bool select;
    Flow *flow;
} Join;

/* Runs a branch, and takes its changes back. */
static Left tried(Run *run, Region *region, Branch *branch, const void *what, int slots) {
    const int mark = run->change_count, variables = run->variable_count, slot_count = run->slot_count;
    Region *outer = run->region;
    Left left = {NULL, 0};
    run->region = region;
    if (branch) branch(run, what);
    run->region = outer;
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

static Flow *flow_of(Join *join) {
    if (join->flow) return join->flow;
    Run *run = join->run;
    join->flow = graph_flow(&run->graph, run->region, FLOW_IF, join->condition);
    join->flow->body = join->then;
    join->flow->other = join->other;
    join->then->owner = join->other->owner = join->flow;
    join->flow->phis = arena_array(&run->graph.arena, (size_t)(join->left[0].count + join->left[1].count) + 1,
                                   sizeof *join->flow->phis);
    if (!join->flow->phis) run_wrong(run, "memory is short");
    return join->flow;
}

/* Returns the value after both branches: a where the condition held, else b. */
static Node *joined(Join *join, Node *a, Node *b) {
    Run *run = join->run;
    const bool a_out = region_within(run->region, a->home), b_out = region_within(run->region, b->home);
    if (a->kind && b->kind && a->kind != b->kind) run_wrong(run, "a choice between types");
    if (a == b || (a_out && b->op == NODE_UNKNOWN)) return a;
    if (b_out && a->op == NODE_UNKNOWN) return b;
    const bool known = a->kind == KIND_BOOL && (node_is_constant(a) || node_is_constant(b));
    if (a_out && b_out && (join->select || known)) return graph_select(&run->graph, join->condition, a, b);
    Flow *flow = flow_of(join);
    Node *phi = graph_phi(&run->graph, NODE_PHI, a->kind ? a->kind : b->kind, run->region, a, b);
    phi->flow = flow;
    if (!run->wrong) flow->phis[flow->phi_count++] = phi;
    return phi;
}

/* Sets the slots that the first branch left, or those that the second left alone. */
static void join_left(Join *join, int side) {
    Run *run = join->run;
    const Left *mine = &join->left[side], *others = &join->left[!side];
    for (int k = 0; k < mine->count && !run->wrong; k++) {
        const int slot = mine->all[k].slot;
        Node *other = run->slots[slot];
        bool both = false;
        for (int j = 0; j < others->count && !both; j++) {
            both = others->all[j].slot == slot;
            if (both) other = others->all[j].before;
        }
        if (side && both) continue;
        Node *own = mine->all[k].before;
        run_set(run, slot, side ? joined(join, other, own) : joined(join, own, other));
    }
}

void run_branch(Run *run, Node *condition, Branch *then, const void *a, Branch *other, const void *b, bool select) {
    if (node_is_constant(condition)) {
        if (condition->integer ? then : other) (condition->integer ? then : other)(run, condition->integer ? a : b);
        return;
    }
    const int before = run->graph.count, slots = run->slot_count;
    Join join = {.run = run, .condition = condition, .slots = slots};
    join.then = graph_region(&run->graph, run->region, false);
    join.other = graph_region(&run->graph, run->region, false);
    join.left[0] = tried(run, join.then, then, a, slots);
    join.left[1] = tried(run, join.other, other, b, slots);
    if (run->wrong) return;
    join.select = is_empty(join.then) && is_empty(join.other) && (select || run->graph.count - before <= VALUES_FEW);
    if (join.then->first || join.other->first) flow_of(&join);
    join_left(&join, 0);
    join_left(&join, 1);
}
