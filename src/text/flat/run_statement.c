/* run_statement.c - statements, one after the other */
#include "text/flat/run.h"

GraphNode *run_stopped(Run *run) {
    const int flags[] = {run->frame.returned, run->frame.broken, run->frame.continued};
    GraphNode *stopped = graph_bool(&run->graph, false);
    for (int k = 0; k < 3; k++)
        if (flags[k] >= 0)
            stopped = graph_binary(&run->graph, KIND_BOOL, OPERATOR('|', '|'), stopped, run->slots[flags[k]]);
    return stopped;
}

static void raise_flag(Run *run, int slot) {
    if (slot < 0)
        run_wrong(run, "a break outside a loop");
    else
        run_set(run, slot, graph_bool(&run->graph, true));
}

static void declare(Run *run, const StatementSyntax *statement) {
    const Kind kind = run_kind(run, statement->type, statement->size);
    const ShaderValue value = statement->value ? run_value(run, statement->value) : (ShaderValue){.kind = KIND_NONE};
    const int slot = run_declare(run, statement->name, kind);
    if (statement->value && !run->wrong) run_write(run, &(VariablePlace){.kind = kind, .slot = slot}, value);
}

static void leave(Run *run, const StatementSyntax *statement) {
    if (statement->value) {
        const ShaderValue value = run_value(run, statement->value);
        if (!run->wrong) run_write(run, &(VariablePlace){.kind = run->frame.kind, .slot = run->frame.result}, value);
    }
    raise_flag(run, run->frame.returned);
}

static void scoped(Run *run, const void *what) { run_scoped(run, what); }

static void branch(Run *run, const StatementSyntax *statement) {
    GraphNode *condition = run_number(run, statement->value, KIND_BOOL);
    if (run->wrong) return;
    run_branch(run, condition, scoped, statement->body, statement->other ? scoped : NULL, statement->other, false);
}

static void run_one(Run *run, const StatementSyntax *statement) {
    switch (statement->kind) {
    case STATEMENT_BLOCK: run_scoped(run, statement); break;
    case STATEMENT_DECLARE: declare(run, statement); break;
    case STATEMENT_EXPR: run_value(run, statement->value); break;
    case STATEMENT_IF: branch(run, statement); break;
    case STATEMENT_FOR: run_loop(run, (StatementSyntax *)statement); break;
    case STATEMENT_SWITCH: run_switch(run, statement); break;
    case STATEMENT_CASE: run_wrong(run, "a case outside a switch"); break;
    case STATEMENT_RETURN: leave(run, statement); break;
    case STATEMENT_BREAK: raise_flag(run, run->frame.broken); break;
    case STATEMENT_CONTINUE: raise_flag(run, run->frame.continued); break;
    case STATEMENT_DISCARD: graph_flow(&run->graph, run->region, FLOW_DISCARD, NULL); break;
    }
}

/* Runs what follows a statement that may have jumped, where it has not. */
static void rest(Run *run, const void *what) {
    const int flags[] = {run->frame.returned, run->frame.broken, run->frame.continued};
    for (int k = 0; k < 3; k++)
        if (flags[k] >= 0) run_set(run, flags[k], graph_bool(&run->graph, false));
    run_statements(run, what);
}

void run_statements(Run *run, const StatementSyntax *first) {
    for (const StatementSyntax *one = first; one && !run->wrong; one = one->next) {
        run_one(run, one);
        if (run->wrong) return;
        GraphNode *stopped = run_stopped(run);
        if (node_is_bool(stopped, false)) continue;
        if (one->next) run_branch(run, stopped, NULL, NULL, rest, one->next, false);
        return;
    }
}

void run_scoped(Run *run, const StatementSyntax *statement) {
    const int variables = run->variable_count, slots = run->slot_count;
    if (statement->kind == STATEMENT_BLOCK)
        run_statements(run, statement->body);
    else
        run_one(run, statement);
    run->variable_count = variables;
    run->slot_count = slots;
}

static bool is_jump(StatementKind kind) { return kind == STATEMENT_BREAK || kind == STATEMENT_RETURN; }

/* Returns true if what follows a statement is never reached. */
static bool ends(const StatementSyntax *statement) {
    if (is_jump(statement->kind)) return true;
    if (statement->kind != STATEMENT_BLOCK || !statement->body) return false;
    const StatementSyntax *last = statement->body;
    while (last->next) last = last->next;
    return ends(last);
}

/* Cases of a switch that share statements. */
typedef struct SwitchCase {
    const StatementSyntax *labels; /* the first of them */
    const StatementSyntax *body;
    const StatementSyntax *after; /* the label after the body, or NULL */
} SwitchCase;

static SwitchCase case_at(const StatementSyntax *label) {
    SwitchCase one = {.labels = label, .body = label};
    while (one.body && one.body->kind == STATEMENT_CASE) one.body = one.body->next;
    one.after = one.body;
    while (one.after && one.after->kind != STATEMENT_CASE) one.after = one.after->next;
    return one;
}

typedef struct Switch {
    GraphNode *value;
    const StatementSyntax *label;    /* of the next cases */
    const StatementSyntax *standard; /* the label of the default's cases, NULL: none so far */
} Switch;

/* Runs statements up to a label. */
static void run_case(Run *run, const void *what) {
    const SwitchCase one = case_at(what);
    StatementSyntax copies[64];
    int count = 0;
    for (const StatementSyntax *k = one.body; k != one.after && count < 64; k = k->next) {
        copies[count] = *k;
        copies[count].next = NULL;
        if (count) copies[count - 1].next = &copies[count];
        count++;
    }
    const bool last = !one.after;
    if (count == 64 || (count && !last && !ends(&copies[count - 1])))
        run_wrong(run, "a case that runs into the next");
    else if (count)
        run_statements(run, copies);
}

static void run_cases(Run *run, const void *what) {
    const Switch *self = what;
    if (!self->label) {
        if (self->standard) run_case(run, self->standard);
        return;
    }
    const SwitchCase one = case_at(self->label);
    Switch next = {self->value, one.after, self->standard};
    GraphNode *here = graph_bool(&run->graph, false);
    bool standard = false;
    for (const StatementSyntax *label = one.labels; label != one.body; label = label->next) {
        standard |= !label->value;
        if (!label->value) continue;
        GraphNode *is = graph_binary(&run->graph, KIND_BOOL, OPERATOR('=', '='), self->value,
                                     run_number(run, label->value, self->value->kind));
        here = graph_binary(&run->graph, KIND_BOOL, OPERATOR('|', '|'), here, is);
    }
    if (standard) {
        next.standard = self->label;
        if (one.labels->next != one.body) run_wrong(run, "a default that shares its statements");
    }
    if (!run->wrong) run_branch(run, here, run_case, self->label, run_cases, &next, false);
}

void run_switch(Run *run, const StatementSyntax *statement) {
    const int variables = run->variable_count, slots = run->slot_count, broken = run->frame.broken;
    const ShaderValue value = run_value(run, statement->value);
    if (run->wrong || (value.kind != KIND_INT && value.kind != KIND_UINT)) {
        run_wrong(run, "a switch of what is no whole number");
        return;
    }
    run->frame.broken = run_declare(run, 0, KIND_BOOL);
    if (run->wrong) return;
    run->slots[run->frame.broken] = graph_bool(&run->graph, false);
    run_cases(run, &(Switch){.value = value.leaves[0], .label = statement->body});
    run->frame.broken = broken;
    run->variable_count = variables;
    run->slot_count = slots;
}
