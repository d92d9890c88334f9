/* run_call.c - calls of the text's own functions, and of types */
#include "text/flat/run.h"

enum { ARGUMENTS_MOST = 32 };

/* The parts of a vector, matrix or number. */
typedef struct MadeParts {
    GraphNode *all[16];
    int count;
    int size; /* numbers in them */
} MadeParts;

/* Adds a part; one that is itself made of numbers as those. */
static void add_part(Run *run, MadeParts *parts, GraphNode *node, bool split) {
    const int size = kind_size(node->kind);
    if (!size || parts->size + size > 16) {
        run_wrong(run, "a value of other parts");
        return;
    }
    parts->size += size;
    split = split && size > 1 && node->op == NODE_CALL && node->word == run->kinds.shapes[node->kind].name;
    for (int k = 0; k < (split ? size : 1); k++)
        parts->all[parts->count++] =
            split ? graph_part(&run->graph, kind_vector(kind_base(node->kind), 1), k, node) : node;
}

static ShaderValue made_of(Run *run, Kind kind, const MadeParts *parts) {
    const int matrix = kind_matrix(kind), needed = matrix ? matrix * matrix : kind_size(kind);
    const bool spread = parts->count == 1 && parts->size == 1;
    if (!needed || (parts->size != needed && !spread)) return run_wrong(run, "a value of other parts");
    ShaderValue made = run_leaves(run, kind);
    made.leaves[0] = graph_call(&run->graph, kind, run->kinds.shapes[kind].name,
                                needed == 1 ? run->kinds.spelled[kind] : "", parts->all, parts->count, NULL);
    return made;
}

ShaderValue run_made(Run *run, const Expr *call, Kind kind) {
    const Shape *shape = &run->kinds.shapes[kind];
    const bool record = shape->members != NULL, split = kind_size(kind) > 1 && call->a && call->a->next;
    const ShaderValue made = run_leaves(run, kind);
    MadeParts parts = {.count = 0};
    int count = 0;
    for (const Expr *one = call->a; one; one = one->next, count++) {
        const ShaderValue value = run_value(run, one);
        if (run->wrong || value.whole) return run_wrong(run, "a value made of an array");
        if (record && (count >= shape->count || shape->members[count].kind != value.kind))
            return run_wrong(run, "a record of other members");
        if (record)
            memcpy(made.leaves + shape->members[count].first, value.leaves,
                   (size_t)run->kinds.shapes[value.kind].leaf_count * sizeof(GraphNode *));
        else
            add_part(run, &parts, value.leaves[0], split && kind_base(value.leaves[0]->kind) == kind_base(kind));
        if (run->wrong) return run_wrong(run, "");
    }
    if (!record) return made_of(run, kind, &parts);
    return count == shape->count ? made : run_wrong(run, "a record of fewer members");
}

/* Copies arguments into new variables, which are the function's parameters. */
static bool pass(Run *run, const Declaration *function, const Expr *call, VariablePlace *places, ShaderValue *values) {
    int k = 0;
    const Expr *one = call->a;
    for (const FieldSyntax *field = function->fields; field; field = field->next, one = one->next, k++) {
        if (!one || k == ARGUMENTS_MOST) return false;
        if (field->written && !run_place(run, one, &places[k])) return false;
        if (!field->fresh) values[k] = field->written ? run_read(run, &places[k]) : run_value(run, one);
        if (run->wrong) return false;
    }
    return !one;
}

static void enter(Run *run, const Declaration *function, const ShaderValue *values, Kind kind) {
    int k = 0;
    run->frame = (CallFrame){.variables = run->variable_count, .kind = kind, .broken = -1, .continued = -1};
    for (const FieldSyntax *field = function->fields; field && !run->wrong; field = field->next, k++) {
        const Kind own = run_kind(run, field->type, field->size);
        const int slot = run_declare(run, field->name, own);
        if (!field->fresh && !run->wrong) run_write(run, &(VariablePlace){.kind = own, .slot = slot}, values[k]);
    }
    run->frame.result = run_declare(run, 0, kind);
    run->frame.returned = run_declare(run, 0, KIND_BOOL);
    if (!run->wrong) run->slots[run->frame.returned] = graph_bool(&run->graph, false);
}

static ShaderValue called(Run *run, const Declaration *function, const Expr *call) {
    VariablePlace places[ARGUMENTS_MOST];
    ShaderValue values[ARGUMENTS_MOST];
    const CallFrame outer = run->frame;
    const int variables = run->variable_count, slots = run->slot_count;
    const Kind kind = run_kind(run, function->type, NULL);
    if (run->wrong || run->depth == CALLS_MOST || !pass(run, function, call, places, values))
        return run_wrong_name(run, "a call with other arguments", call->name);
    run->depth++;
    enter(run, function, values, kind);
    run_statements(run, function->body->body);
    run->depth--;
    const ShaderValue result = run_read(run, &(VariablePlace){.kind = kind, .slot = run->frame.result});
    int k = 0, at = variables;
    for (const FieldSyntax *field = function->fields; field && !run->wrong; field = field->next, k++, at++)
        if (field->written)
            values[k] =
                run_read(run, &(VariablePlace){.kind = run->variables[at].kind, .slot = run->variables[at].slot});
    run->frame = outer;
    run->variable_count = variables;
    run->slot_count = slots;
    k = 0;
    for (const FieldSyntax *field = function->fields; field && !run->wrong; field = field->next, k++)
        if (field->written) run_write(run, &places[k], values[k]);
    return result;
}

ShaderValue run_call(Run *run, const Expr *call) {
    const Declaration *function = run->functions[call->name];
    if (function) return called(run, function, call);
    const Kind kind = kinds_named(&run->kinds, call->name);
    return kind ? run_made(run, call, kind) : run_builtin(run, call);
}
