/* run_loop.c - loops: short ones of a known number of rounds are unrolled */
#include "text/flat/run.h"

enum { ROUNDS_MOST = 8, ROUND_VALUES_MOST = 160, TRIES_MOST = 24, CARRIED_MOST = 1024 };

static GraphNode *condition_of(Run *run, const StatementSyntax *loop) {
    return loop->value ? run_number(run, loop->value, KIND_BOOL) : graph_bool(&run->graph, true);
}

static void lower_flag(Run *run, int slot) { run_set(run, slot, graph_bool(&run->graph, false)); }

static void step(Run *run, const StatementSyntax *loop) {
    if (loop->step && !run->wrong) run_value(run, loop->step);
}

typedef enum Round { ROUND_DONE, ROUND_LAST, ROUND_UNKNOWN } Round;

/* Runs one round if it is known to take place, and whether it is the last. */
static Round one_round(Run *run, const StatementSyntax *loop) {
    const GraphNode *condition = condition_of(run, loop);
    if (run->wrong || node_is_bool(condition, false)) return ROUND_LAST;
    if (!node_is_constant(condition)) return ROUND_UNKNOWN;
    run_scoped(run, loop->body);
    if (run->wrong) return ROUND_LAST;
    lower_flag(run, run->frame.continued);
    GraphNode *stopped = run_stopped(run);
    if (node_is_bool(stopped, true)) return ROUND_LAST;
    if (!node_is_constant(stopped)) return ROUND_UNKNOWN;
    step(run, loop);
    return ROUND_DONE;
}

/* Runs all rounds one by one. Returns false, and leaves everything as it was, if they are too many or too long. */
static bool unrolled(Run *run, StatementSyntax *loop) {
    Graph *graph = &run->graph;
    const int values = graph->count, mark = run->change_count;
    Flow **last = run->region->last;
    if (loop->rolled) return false;
    for (int k = 0; k <= ROUNDS_MOST && graph->count - values <= ROUND_VALUES_MOST; k++) {
        const Round round = one_round(run, loop);
        if (round == ROUND_LAST) return true;
        if (round == ROUND_UNKNOWN) break;
        loop->rolled = k == ROUNDS_MOST;
    }
    loop->rolled |= graph->count - values > ROUND_VALUES_MOST;
    run_undo(run, mark);
    graph_rewind(graph, values);
    *last = NULL;
    run->region->last = last;
    return false;
}

/* The slots that a round hands to the next. */
typedef struct Carried {
    int slots[CARRIED_MOST];
    GraphNode *phis[CARRIED_MOST];
    int count;
} Carried;

static int place_of(const Carried *carried, int slot) {
    for (int k = 0; k < carried->count; k++)
        if (carried->slots[k] == slot) return k;
    return -1;
}

static void drop(Carried *carried, int place) {
    carried->count--;
    carried->slots[place] = carried->slots[carried->count];
    carried->phis[place] = carried->phis[carried->count];
}

/* Adds changed slots to those that are carried. Returns true if there are new ones. */
static bool grow(Run *run, Carried *carried, int mark, int slots, GraphNode *const *heads) {
    bool grown = false;
    for (int k = mark; k < run->change_count && !run->wrong; k++) {
        const int slot = run->changes[k].slot;
        if (slot >= slots || run->slots[slot] == heads[slot] || place_of(carried, slot) >= 0) continue;
        if (carried->count == CARRIED_MOST) {
            run_wrong(run, "a loop that changes too much");
            return false;
        }
        carried->slots[carried->count++] = slot;
        grown = true;
    }
    return grown;
}

/* Runs a round whose carried slots have phis in a region of its own. */
static Region *try_round(Run *run, const StatementSyntax *loop, Carried *carried) {
    Region *region = graph_region(&run->graph, run->region, true), *outer = run->region;
    for (int k = 0; k < carried->count; k++) {
        GraphNode *first = run->slots[carried->slots[k]];
        carried->phis[k] = graph_phi(&run->graph, NODE_LOOP_PHI, first->kind, region, first, NULL);
        run_set(run, carried->slots[k], carried->phis[k]);
    }
    run->region = region;
    GraphNode *going = graph_unary(&run->graph, KIND_BOOL, '!', run_stopped(run));
    GraphNode *condition = condition_of(run, loop);
    if (!run->wrong) {
        condition = graph_binary(&run->graph, KIND_BOOL, OPERATOR('&', '&'), going, condition);
        graph_flow(&run->graph, region, FLOW_STAY, condition);
        run_scoped(run, loop->body);
        lower_flag(run, run->frame.continued);
        step(run, loop);
    }
    run->region = outer;
    return region;
}

/* Appends the loop, and sets what it leaves behind. */
static void accept(Run *run, Region *region, const Carried *carried, GraphNode *const *nexts) {
    Flow *flow = graph_flow(&run->graph, run->region, FLOW_LOOP, NULL);
    flow->body = region;
    region->owner = flow;
    flow->phis = arena_array(&run->graph.arena, (size_t)carried->count + 1, sizeof(GraphNode *));
    if (!flow->phis) {
        run_wrong(run, "memory is short");
        return;
    }
    for (int k = 0; k < carried->count; k++) {
        GraphNode *phi = carried->phis[k];
        phi->operands[1] = nexts[k];
        phi->flow = flow;
        flow->phis[flow->phi_count++] = phi;
        GraphNode *after = graph_phi(&run->graph, NODE_EXIT, phi->kind, run->region, phi, NULL);
        after->home = run->region;
        after->flow = flow;
        run_set(run, carried->slots[k], after);
    }
}

/* Finds the slots that rounds hand on, by trying until a round changes no others. */
static void rolled(Run *run, const StatementSyntax *loop) {
    const int slots = run->slot_count, values = run->graph.count, mark = run->change_count;
    Carried *carried = arena_array(&run->arena, 1, sizeof *carried);
    GraphNode **heads = arena_array(&run->arena, (size_t)slots + 1, sizeof(GraphNode *));
    GraphNode *nexts[CARRIED_MOST];
    if (!carried || !heads) {
        run_wrong(run, "memory is short");
        return;
    }
    memcpy(heads, run->slots, (size_t)slots * sizeof(GraphNode *));
    for (int k = 0; k < TRIES_MOST && !run->wrong; k++) {
        Region *region = try_round(run, loop, carried);
        bool again = grow(run, carried, mark, slots, heads);
        if (run->wrong) return; /* the slots may be of no value */
        for (int j = 0; j < carried->count; j++) nexts[j] = run->slots[carried->slots[j]];
        for (int j = carried->count - 1; j >= 0 && !again; j--)
            if (carried->phis[j] == run->slots[carried->slots[j]]) {
                drop(carried, j);
                again = true;
            }
        run_undo(run, mark);
        if (!again && !run->wrong) {
            accept(run, region, carried, nexts);
            return;
        }
        graph_rewind(&run->graph, values);
    }
    run_wrong(run, "a loop");
}

void run_loop(Run *run, StatementSyntax *loop) {
    const int variables = run->variable_count, slots = run->slot_count;
    const CallFrame frame = run->frame;
    for (const StatementSyntax *one = loop->start; one && !run->wrong; one = one->next)
        run_statements(
            run, &(StatementSyntax){
                     .kind = one->kind, .type = one->type, .name = one->name, .size = one->size, .value = one->value});
    run->frame.broken = run_declare(run, 0, KIND_BOOL);
    run->frame.continued = run_declare(run, 0, KIND_BOOL);
    if (run->wrong) return;
    lower_flag(run, run->frame.broken);
    lower_flag(run, run->frame.continued);
    if (!unrolled(run, loop)) rolled(run, loop);
    run->frame.broken = frame.broken;
    run->frame.continued = frame.continued;
    run->variable_count = variables;
    run->slot_count = slots;
}
