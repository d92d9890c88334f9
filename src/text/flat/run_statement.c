/* run_statement.c - statements, one after the other */
#include "text/flat/run.h"

Node *run_stopped(Run *run) {
    const int flags[] = {run->frame.returned, run->frame.broken, run->frame.continued};
    Node *stopped = graph_bool(&run->graph, false);
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

static void declare(Run *run, const Statement *statement) {
    const Kind kind = run_kind(run, statement->type, statement->size);
    const Value value = statement->value ? run_value(run, statement->value) : (Value){.kind = KIND_NONE};
    const int slot = run_declare(run, statement->name, kind);
    if (statement->value && !run->wrong) run_write(run, &(Place){.kind = kind, .slot = slot}, value);
}

static void leave(Run *run, const Statement *statement) {
    if (statement->value) {
        const Value value = run_value(run, statement->value);
        if (!run->wrong) run_write(run, &(Place){.kind = run->frame.kind, .slot = run->frame.result}, value);
    }
    raise_flag(run, run->frame.returned);
}

static void scoped(Run *run, const void *what) { run_scoped(run, what); }

static void branch(Run *run, const Statement *statement) {
    Node *condition = run_number(run, statement->value, KIND_BOOL);
    if (run->wrong) return;
    run_branch(run, condition, scoped, statement->body, statement->other ? scoped : NULL, statement->other, false);
}

static void run_one(Run *run, const Statement *statement) {
    switch (statement->kind) {
    case STATEMENT_BLOCK: run_scoped(run, statement); break;
    case STATEMENT_DECLARE: declare(run, statement); break;
    case STATEMENT_EXPR: run_value(run, statement->value); break;
    case STATEMENT_IF: branch(run, statement); break;
    case STATEMENT_FOR: run_loop(run, (Statement *)statement); break;
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

void run_statements(Run *run, const Statement *first) {
    for (const Statement *one = first; one && !run->wrong; one = one->next) {
        run_one(run, one);
        if (run->wrong) return;
        Node *stopped = run_stopped(run);
        if (node_is_bool(stopped, false)) continue;
        if (one->next) run_branch(run, stopped, NULL, NULL, rest, one->next, false);
        return;
    }
}

void run_scoped(Run *run, const Statement *statement) {
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
static bool ends(const Statement *statement) {
    if (is_jump(statement->kind)) return true;
    if (statement->kind != STATEMENT_BLOCK || !statement->body) return false;
    const Statement *last = statement->body;
    while (last->next) last = last->next;
    return ends(last);
}

/* Cases of a switch that share statements. */
typedef struct Case {
    const Statement *labels; /* the first of them */
    const Statement *body;
    const Statement *after; /* the label after the body, or NULL */
} Case;

static Case case_at(const Statement *label) {
    Case one = {.labels = label, .body = label};
    while (one.body && one.body->kind == STATEMENT_CASE) one.body = one.body->next;
    one.after = one.body;
    while (one.after && one.after->kind != STATEMENT_CASE) one.after = one.after->next;
    return one;
}

typedef struct Switch {
    Node *value;
    const Statement *label;    /* of the next cases */
    const Statement *standard; /* the label of the default's cases, NULL: none so far */
} Switch;

/* Runs statements up to a label. */
static void run_case(Run *run, const void *what) {
    const Case one = case_at(what);
    Statement copies[64];
    int count = 0;
    for (const Statement *k = one.body; k != one.after && count < 64; k = k->next) {
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
    const Case one = case_at(self->label);
    Switch next = {self->value, one.after, self->standard};
    Node *here = graph_bool(&run->graph, false);
    bool standard = false;
    for (const Statement *label = one.labels; label != one.body; label = label->next) {
        standard |= !label->value;
        if (!label->value) continue;
        Node *is = graph_binary(&run->graph, KIND_BOOL, OPERATOR('=', '='), self->value,
                                run_number(run, label->value, self->value->kind));
        here = graph_binary(&run->graph, KIND_BOOL, OPERATOR('|', '|'), here, is);
    }
    if (standard) {
        next.standard = self->label;
        if (one.labels->next != one.body) run_wrong(run, "a default that shares its statements");
    }
    if (!run->wrong) run_branch(run, here, run_case, self->label, run_cases, &next, false);
}

void run_switch(Run *run, const Statement *statement) {
    const int variables = run->variable_count, slots = run->slot_count, broken = run->frame.broken;
    const Value value = run_value(run, statement->value);
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
