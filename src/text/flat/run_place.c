/* run_place.c - variables and their parts */
#include "text/flat/run.h"

#include <stdlib.h>

void run_set(Run *run, int slot, GraphNode *node) {
    if (run->change_count == run->change_capacity) {
        const int more = run->change_capacity ? 2 * run->change_capacity : 1024;
        Change *grown = realloc_array(run->changes, (size_t)more, sizeof *grown);
        if (!grown) {
            run_wrong(run, "memory is short");
            return;
        }
        run->changes = grown;
        run->change_capacity = more;
    }
    run->changes[run->change_count++] = (Change){slot, run->slots[slot]};
    run->slots[slot] = node;
}

void run_undo(Run *run, int mark) {
    while (run->change_count > mark) {
        const Change *last = &run->changes[--run->change_count];
        run->slots[last->slot] = last->before;
    }
}

int run_declare(Run *run, Symbol name, Kind kind) {
    const Shape *shape = &run->kinds.shapes[kind];
    if (shape->element && !shape->leaf_count) run_wrong(run, "a variable of too many elements");
    if (run->variable_count == VARIABLES_MOST || run->slot_count + shape->leaf_count > SLOTS_MOST) {
        run_wrong(run, "too many variables");
        return 0;
    }
    const int first = run->slot_count;
    run->variables[run->variable_count++] = (Variable){name, kind, first};
    for (int k = 0; k < shape->leaf_count; k++)
        run->slots[run->slot_count++] = graph_unknown(&run->graph, shape->leaves[k]);
    return first;
}

Kind run_kind(Run *run, Symbol name, const Expr *size) {
    Kind kind = kinds_named(&run->kinds, name);
    if (kind && size) {
        const GraphNode *count = run_number(run, size, KIND_INT);
        kind = node_is_constant(count) ? kinds_array(&run->kinds, kind, count->integer) : KIND_NONE;
    }
    if (!kind) run_wrong_name(run, "a type", name);
    return kind;
}

static const Variable *find(const Run *run, Symbol name) {
    for (int k = run->variable_count - 1; k >= run->frame.variables; k--)
        if (run->variables[k].name == name) return &run->variables[k];
    for (int k = run->global_count - 1; k >= 0; k--)
        if (run->variables[k].name == name) return &run->variables[k];
    return NULL;
}

int run_components(const Run *run, Symbol name, Kind vector, int *count) {
    static const char sets[3][5] = {"xyzw", "rgba", "stpq"};
    const Token token = run->syntax.symbols.names[name];
    for (int set = 0; set < 3; set++) {
        int word = 0, found = 0;
        for (size_t k = 0; k < token.size && k < 4; k++) {
            const char *at = strchr(sets[set], token.at[k]);
            if (!at || at - sets[set] >= kind_size(vector)) break;
            word |= (int)(at - sets[set]) << 2 * k;
            found++;
        }
        if ((size_t)found == token.size) {
            *count = found;
            return word;
        }
    }
    *count = 0;
    return 0;
}

static bool place_member(Run *run, const Expr *expr, VariablePlace *place) {
    if (place->part) return false;
    const Shape *shape = &run->kinds.shapes[place->kind];
    for (int k = 0; shape->members && k < shape->count; k++)
        if (shape->members[k].name == expr->name) {
            place->slot += shape->members[k].first;
            place->kind = shape->members[k].kind;
            return true;
        }
    int count;
    const int word = run_components(run, expr->name, place->kind, &count);
    if (!count) return false;
    place->part = true;
    place->word = word;
    place->vector = place->kind;
    place->kind = kind_vector(kind_base(place->vector), count);
    return true;
}

static bool place_element(Run *run, const Expr *expr, VariablePlace *place) {
    const Shape *shape = &run->kinds.shapes[place->kind];
    if (place->part || !shape->element) return false;
    GraphNode *at = run_number(run, expr->b, KIND_INT);
    const int stride = run->kinds.shapes[shape->element].leaf_count;
    if (node_is_constant(at)) {
        if (at->integer < 0 || at->integer >= shape->count) return false;
        place->slot += stride * at->integer;
    } else {
        if (place->at) return false;
        place->at = at;
        place->count = shape->count;
        place->stride = stride;
    }
    place->kind = shape->element;
    return true;
}

bool run_place(Run *run, const Expr *expr, VariablePlace *out) {
    if (expr->kind == EXPR_NAME) {
        const Variable *variable = find(run, expr->name);
        if (variable) *out = (VariablePlace){.kind = variable->kind, .slot = variable->slot};
        return variable != NULL;
    }
    if (expr->kind != EXPR_MEMBER && expr->kind != EXPR_INDEX) return false;
    if (!run_place(run, expr->a, out)) return false;
    return expr->kind == EXPR_MEMBER ? place_member(run, expr, out) : place_element(run, expr, out);
}

static GraphNode *is_at(Run *run, const VariablePlace *place, int k) {
    return graph_binary(&run->graph, KIND_BOOL, OPERATOR('=', '='), place->at, graph_integer(&run->graph, KIND_INT, k));
}

/* Returns the leaf of a place that lies in that slot of the first element. */
static GraphNode *read_leaf(Run *run, const VariablePlace *place, int slot) {
    if (!place->at) return run->slots[slot];
    GraphNode *value = run->slots[slot + (place->count - 1) * place->stride];
    for (int k = place->count - 2; k >= 0; k--)
        value = graph_select(&run->graph, is_at(run, place, k), run->slots[slot + k * place->stride], value);
    return value;
}

ShaderValue run_read(Run *run, const VariablePlace *place) {
    if (place->part)
        return run_of_node(run, graph_part(&run->graph, place->kind, place->word, read_leaf(run, place, place->slot)));
    ShaderValue value = run_leaves(run, place->kind);
    for (int k = 0; k < run->kinds.shapes[place->kind].leaf_count; k++)
        value.leaves[k] = read_leaf(run, place, place->slot + k);
    return value;
}

static void write_leaf(Run *run, const VariablePlace *place, int slot, GraphNode *node) {
    if (!place->at) {
        run_set(run, slot, node);
        return;
    }
    for (int k = 0; k < place->count; k++) {
        const int at = slot + k * place->stride;
        GraphNode *before = run->slots[at];
        if (before->op == NODE_UNKNOWN)
            run_set(run, at, node);
        else
            run_set(run, at, graph_select(&run->graph, is_at(run, place, k), node, before));
    }
}

/* Returns a vector with some components replaced by those of `with`. */
static GraphNode *replaced(Run *run, const VariablePlace *place, GraphNode *before, GraphNode *with) {
    const BaseType base = kind_base(place->vector);
    const int size = kind_size(place->vector), count = kind_size(place->kind);
    GraphNode *all[4];
    for (int k = 0; k < size; k++) all[k] = graph_part(&run->graph, kind_vector(base, 1), k, before);
    for (int k = 0; k < count; k++)
        all[place->word >> 2 * k & 3] = graph_part(&run->graph, kind_vector(base, 1), k, with);
    const Symbol name = run->kinds.shapes[place->vector].name;
    return graph_call(&run->graph, place->vector, name, "", all, size, NULL);
}

void run_write(Run *run, const VariablePlace *place, ShaderValue value) {
    if (value.kind != place->kind || value.whole) {
        run_wrong(run, "an assignment of another type");
        return;
    }
    if (place->part) {
        GraphNode *before = read_leaf(run, place, place->slot);
        write_leaf(run, place, place->slot, replaced(run, place, before, value.leaves[0]));
        return;
    }
    for (int k = 0; k < run->kinds.shapes[place->kind].leaf_count; k++)
        write_leaf(run, place, place->slot + k, value.leaves[k]);
}
