#include "text/flat/run.h"

#include <stdlib.h>

enum { MEMBERS_MOST = 512 };

/* Adds a name of what the shader reads: a number, vector, matrix or sampler, or an array of them. */
static void add_outside(Run *run, Symbol name, Symbol type, const Expr *size) {
    const Kind kind = run_kind(run, type, size), element = run->kinds.shapes[kind].element;
    if ((element ? element : kind) >= KIND_OWN) run_wrong_name(run, "a record from outside", name);
    run->outside[name] = kind;
}

/* Adds a record, or the members of a block, which are names of their own. */
static void add_fields(Run *run, const Declaration *declaration, bool record) {
    ShapeMember members[MEMBERS_MOST];
    int count = 0;
    for (const FieldSyntax *field = declaration->fields; field && !run->wrong; field = field->next) {
        if (!record) {
            add_outside(run, field->name, field->type, field->size);
            continue;
        }
        const Kind kind = run_kind(run, field->type, field->size);
        if (count == MEMBERS_MOST) {
            run_wrong(run, "a record of too many members");
            return;
        }
        members[count++] = (ShapeMember){field->name, kind, 0};
    }
    if (record && !run->wrong) kinds_record(&run->kinds, declaration->name, members, count);
}

static void add_variable(Run *run, const Declaration *declaration) {
    const Kind kind = run_kind(run, declaration->type, declaration->size);
    const ShaderValue value =
        declaration->value ? run_value(run, declaration->value) : (ShaderValue){.kind = KIND_NONE};
    if (run->wrong) return;
    if (declaration->constant && value.kind == kind) {
        run->constants[declaration->name] = value;
        return;
    }
    const int slot = run_declare(run, declaration->name, kind);
    if (declaration->value && !run->wrong) run_write(run, &(VariablePlace){.kind = kind, .slot = slot}, value);
    run->global_count = run->frame.variables = run->variable_count;
}

static void add(Run *run, Declaration *declaration) {
    switch (declaration->kind) {
    case DECLARATION_RECORD: add_fields(run, declaration, true); break;
    case DECLARATION_BLOCK: add_fields(run, declaration, false); break;
    case DECLARATION_FUNCTION: run->functions[declaration->name] = declaration; break;
    case DECLARATION_OUTSIDE: add_outside(run, declaration->name, declaration->type, declaration->size); break;
    case DECLARATION_VARIABLE:
    case DECLARATION_OUTPUT: add_variable(run, declaration); break;
    }
}

/* Appends what main left in the outputs. */
static void put_outputs(Run *run) {
    for (const Declaration *one = run->syntax.first; one && !run->wrong; one = one->next) {
        if (one->kind != DECLARATION_OUTPUT) continue;
        for (int k = 0; k < run->global_count; k++)
            if (run->variables[k].name == one->name)
                graph_flow(&run->graph, run->region, FLOW_OUTPUT, run->slots[run->variables[k].slot])->name = one->name;
    }
}

bool run_text(const char *text, Run *run) {
    memset(run, 0, sizeof *run);
    syntax_read(text, &run->syntax);
    kinds_begin(&run->kinds, &run->syntax.symbols);
    run_builtins(run);
    run->frame = (CallFrame){.result = -1, .returned = -1, .broken = -1, .continued = -1};
    run->wrong = run->syntax.wrong;
    if (!graph_begin(&run->graph, &run->kinds) && !run->wrong) run->wrong = "memory is short";
    run->region = run->graph.whole;
    for (Declaration *one = run->syntax.first; one && !run->wrong; one = one->next) add(run, one);
    const Expr call = {.kind = EXPR_CALL, .name = run->main_name};
    if (!run->wrong) run_value(run, &call);
    put_outputs(run);
    if (!run->wrong && (run->graph.failed || run->kinds.failed)) run->wrong = "too large";
    return !run->wrong;
}

void run_free(Run *run) {
    free(run->changes);
    arena_free(&run->arena);
    graph_free(&run->graph);
    kinds_free(&run->kinds);
    syntax_free(&run->syntax);
}
