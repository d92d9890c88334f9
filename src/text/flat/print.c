#include "text/flat/print.h"

#include <math.h>

#include "text/flat/placement.h"
#include "text/source/number_text.h"

typedef struct Printer {
    const Run *run;
    Buffer *out;
    int indent;
    bool used[SYMBOLS_MOST]; /* what the shader reads from outside, by name */
} Printer;

/* The strengths with which expressions bind: a choice least, an operator as in syntax.c, a sign, a name most. */
enum { BINDS_SELECT = 0, BINDS_SIGN = 11, BINDS_NAME = 12 };

static int binding(Operator op) {
    switch (op) {
    case '*':
    case '/':
    case '%': return 10;
    case '+':
    case '-': return 9;
    case OPERATOR('<', '<'):
    case OPERATOR('>', '>'): return 8;
    case '<':
    case '>':
    case OPERATOR('<', '='):
    case OPERATOR('>', '='): return 7;
    case OPERATOR('=', '='):
    case OPERATOR('!', '='): return 6;
    case '&': return 5;
    case '^': return 4;
    case '|': return 3;
    case OPERATOR('&', '&'): return 2;
    default: return 1;
    }
}

static void put_token(const Printer *self, Symbol name) {
    const Token token = self->run->syntax.symbols.names[name];
    buffer_put(self->out, token.at, token.size);
}

static void put_kind(const Printer *self, Kind kind) { put_token(self, self->run->kinds.shapes[kind].name); }

static void put_number(const Printer *self, const GraphNode *node) {
    switch (node->kind) {
    case KIND_FLOAT: buffer_put_text(self->out, number(node->number).text); break;
    case KIND_BOOL: buffer_put_text(self->out, node->integer ? "true" : "false"); break;
    case KIND_UINT: buffer_print(self->out, "%uu", (unsigned)node->integer); break;
    default: buffer_print(self->out, node->integer == (int)0x80000000u ? "0x%x" : "%d", (unsigned)node->integer); break;
    }
}

static bool is_negative(const GraphNode *node) {
    if (node->op != NODE_NUMBER) return false;
    return node->kind == KIND_FLOAT ? signbit(node->number) != 0 : node->kind == KIND_INT && node->integer < 0;
}

static int binds(const GraphNode *node) {
    if (node->name) return BINDS_NAME;
    if (node->op == NODE_BINARY) return binding(node->word);
    if (node->op == NODE_SELECT) return BINDS_SELECT;
    return node->op == NODE_UNARY || is_negative(node) ? BINDS_SIGN : BINDS_NAME;
}

static void put_value(const Printer *self, const GraphNode *node);

/* Puts an operand, in brackets if it binds less than `least`. */
static void put_operand(const Printer *self, const GraphNode *node, int least) {
    const bool brackets = binds(node) < least;
    if (brackets) buffer_put(self->out, "(", 1);
    put_value(self, node);
    if (brackets) buffer_put(self->out, ")", 1);
}

static void put_operator(const Printer *self, Operator op) {
    const char marks[2] = {(char)(op / 256), (char)(op % 256)};
    buffer_put(self->out, op > 255 ? marks : marks + 1, op > 255 ? 2 : 1);
}

static void put_binary(const Printer *self, const GraphNode *node) {
    const int bound = binding(node->word);
    put_operand(self, node_operand(node, 0), bound);
    buffer_put(self->out, " ", 1);
    put_operator(self, node->word);
    buffer_put(self->out, " ", 1);
    put_operand(self, node_operand(node, 1), bound + 1);
}

static void put_call(const Printer *self, const GraphNode *node) {
    put_token(self, node->word);
    buffer_put(self->out, "(", 1);
    for (int k = 0; k < node->count; k++) {
        if (k) buffer_put(self->out, ", ", 2);
        put_value(self, node_operand(node, k));
    }
    buffer_put(self->out, ")", 1);
}

static void put_part(const Printer *self, const GraphNode *node) {
    put_operand(self, node_operand(node, 0), BINDS_NAME);
    buffer_put(self->out, ".", 1);
    for (int k = 0; k < kind_size(node->kind); k++) buffer_put(self->out, &"xyzw"[node->word >> 2 * k & 3], 1);
}

/* Puts a value that nothing depends on. */
static void put_unknown(const Printer *self, Kind kind) {
    if (kind != KIND_BOOL) put_kind(self, kind);
    buffer_put_text(self->out, kind == KIND_BOOL ? "false" : kind_base(kind) == BASE_BOOL ? "(false)" : "(0)");
}

static void put_variable(const Printer *self, const GraphNode *node) { buffer_print(self->out, "v%d", node->name); }

/* Puts the expression of a node, even if it has a variable. */
static void put_expression(const Printer *self, const GraphNode *node) {
    switch (node->op) {
    case NODE_NUMBER: put_number(self, node); break;
    case NODE_OUTSIDE: put_token(self, node->word); break;
    case NODE_UNARY:
        put_operator(self, node->word);
        put_operand(self, node_operand(node, 0), BINDS_NAME);
        break;
    case NODE_BINARY: put_binary(self, node); break;
    case NODE_CALL: put_call(self, node); break;
    case NODE_PART: put_part(self, node); break;
    case NODE_INDEX:
        put_operand(self, node_operand(node, 0), BINDS_NAME);
        buffer_put(self->out, "[", 1);
        put_value(self, node_operand(node, 1));
        buffer_put(self->out, "]", 1);
        break;
    case NODE_SELECT:
        put_operand(self, node_operand(node, 0), BINDS_SELECT + 1);
        buffer_put(self->out, " ? ", 3);
        put_operand(self, node_operand(node, 1), BINDS_SELECT + 1);
        buffer_put(self->out, " : ", 3);
        put_value(self, node_operand(node, 2));
        break;
    case NODE_PHI:
    case NODE_LOOP_PHI: put_variable(self, node); break;
    case NODE_EXIT: put_variable(self, node_operand(node, 0)); break;
    case NODE_UNKNOWN: put_unknown(self, node->kind); break;
    }
}

static void put_value(const Printer *self, const GraphNode *node) {
    if (node->name)
        put_variable(self, node);
    else
        put_expression(self, node);
}

static void put_indent(const Printer *self) {
    static const char blanks[] = "                                ";
    buffer_put(self->out, blanks, (size_t)(self->indent < 32 ? self->indent : 32));
}

static void put_line(const Printer *self, const char *line) {
    put_indent(self);
    buffer_put_text(self->out, line);
    buffer_put(self->out, "\n", 1);
}

/* Puts "float v7 = ...;", or without a value. */
static void put_declaration(const Printer *self, const GraphNode *node, const GraphNode *value) {
    put_indent(self);
    put_kind(self, node->kind);
    buffer_put(self->out, " ", 1);
    put_variable(self, node);
    if (value && value->op != NODE_UNKNOWN) {
        buffer_put(self->out, " = ", 3);
        if (value == node)
            put_expression(self, value);
        else
            put_value(self, value);
    }
    buffer_put(self->out, ";\n", 2);
}

static void put_assignment(const Printer *self, const GraphNode *to, const GraphNode *value) {
    if (value->op == NODE_UNKNOWN) return;
    put_indent(self);
    put_variable(self, to);
    buffer_put(self->out, " = ", 3);
    put_value(self, value);
    buffer_put(self->out, ";\n", 2);
}

/* Puts the variables of a region that were made before a serial number, and returns the next. */
static const GraphNode *put_nodes(const Printer *self, const GraphNode *node, int before) {
    for (; node && node->serial < before; node = node->after) put_declaration(self, node, node);
    return node;
}

static void put_region(Printer *self, const Region *region);

/* Puts a branch and what it leaves in phis: operand `side`. */
static void put_branch(Printer *self, const Flow *flow, int side) {
    self->indent++;
    put_region(self, side ? flow->other : flow->body);
    for (int k = 0; k < flow->phi_count; k++) {
        const GraphNode *phi = flow->phis[k];
        if (phi->live && !(side && placement_before(phi))) put_assignment(self, phi, node_operand(phi, side));
    }
    self->indent--;
}

/* Returns true if a branch has no text. */
static bool is_empty(const Flow *flow, int side) {
    const Region *region = side ? flow->other : flow->body;
    if (region->nodes) return false;
    for (const Flow *one = region->first; one; one = one->next)
        if (one->live) return false;
    for (int k = 0; k < flow->phi_count; k++) {
        const GraphNode *phi = flow->phis[k], *value = node_operand(phi, side);
        if (phi->live && value->op != NODE_UNKNOWN && !(side && placement_before(phi))) return false;
    }
    return true;
}

static void put_if(Printer *self, const Flow *flow) {
    for (int k = 0; k < flow->phi_count; k++) {
        const GraphNode *phi = flow->phis[k];
        if (phi->live) put_declaration(self, phi, placement_before(phi) ? node_operand(phi, 1) : NULL);
    }
    const bool other = !is_empty(flow, 1), inverse = is_empty(flow, 0);
    put_indent(self);
    buffer_put_text(self->out, inverse ? "if (!" : "if (");
    put_operand(self, flow->condition, inverse ? BINDS_NAME : BINDS_SELECT);
    buffer_put_text(self->out, ") {\n");
    if (!inverse) put_branch(self, flow, 0);
    if (other && !inverse) put_line(self, "} else {");
    if (other) put_branch(self, flow, 1);
    put_line(self, "}");
}

/* Returns true if the text of a value reads a phi of the loop other than this one. */
static bool reads_others(const GraphNode *value, const Flow *loop, const GraphNode *own) {
    if (value->op == NODE_LOOP_PHI) return value->flow == loop && value != own;
    if (value->name || value->op == NODE_PHI || value->op == NODE_EXIT) return false;
    for (int k = 0; k < value->count; k++)
        if (reads_others(node_operand(value, k), loop, own)) return true;
    return false;
}

/* Puts the end of a round: values that read other phis are computed before any of these changes. */
static void put_next(const Printer *self, const Flow *flow) {
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < flow->phi_count; k++) {
            const GraphNode *phi = flow->phis[k], *next = phi->operands[1];
            if (!phi->live || next->op == NODE_UNKNOWN) continue;
            const bool ahead = reads_others(next, flow, phi);
            if (!pass && ahead) {
                put_indent(self);
                put_kind(self, phi->kind);
                buffer_print(self->out, " n%d = ", phi->name);
                put_value(self, next);
                buffer_put(self->out, ";\n", 2);
            } else if (pass && ahead) {
                put_indent(self);
                buffer_print(self->out, "v%d = n%d;\n", phi->name, phi->name);
            } else if (pass) {
                put_assignment(self, phi, next);
            }
        }
}

static void put_loop(Printer *self, const Flow *flow) {
    for (int k = 0; k < flow->phi_count; k++)
        if (flow->phis[k]->live) put_declaration(self, flow->phis[k], node_operand(flow->phis[k], 0));
    put_line(self, "for (;;) {");
    self->indent++;
    put_region(self, flow->body);
    put_next(self, flow);
    self->indent--;
    put_line(self, "}");
}

static void put_stay(const Printer *self, const Flow *flow) {
    if (node_is_bool(flow->condition, true)) return;
    put_indent(self);
    buffer_put_text(self->out, "if (!");
    put_operand(self, flow->condition, BINDS_NAME);
    buffer_put_text(self->out, ") break;\n");
}

static void put_output(const Printer *self, const Flow *flow) {
    if (flow->condition->op == NODE_UNKNOWN) return;
    put_indent(self);
    put_token(self, flow->name);
    buffer_put(self->out, " = ", 3);
    put_value(self, flow->condition);
    buffer_put(self->out, ";\n", 2);
}

static void put_region(Printer *self, const Region *region) {
    const GraphNode *node = region->nodes;
    for (const Flow *one = region->first; one; one = one->next) {
        if (!one->live) continue;
        node = put_nodes(self, node, one->after);
        switch (one->kind) {
        case FLOW_IF: put_if(self, one); break;
        case FLOW_LOOP: put_loop(self, one); break;
        case FLOW_STAY: put_stay(self, one); break;
        case FLOW_DISCARD: put_line(self, "discard;"); break;
        case FLOW_OUTPUT: put_output(self, one); break;
        }
    }
    put_nodes(self, node, GRAPH_MOST);
}

static void put_size(const Printer *self, Kind kind) {
    const Shape *shape = &self->run->kinds.shapes[kind];
    if (shape->element) buffer_print(self->out, "[%d]", shape->count);
}

/* Puts "uniform vec4 name[3];" with its words as they are. */
static void put_outside(const Printer *self, const char *at, const char *end, Symbol name) {
    while (end > at && is_blank(end[-1])) end--;
    buffer_put(self->out, at, (size_t)(end - at));
    buffer_put(self->out, " ", 1);
    put_token(self, name);
    put_size(self, self->run->outside[name]);
    buffer_put(self->out, ";\n", 2);
}

static void put_block(const Printer *self, const Declaration *block) {
    bool used = false;
    for (const FieldSyntax *field = block->fields; field; field = field->next) used |= self->used[field->name];
    if (!used) return;
    const char *end = block->end;
    while (end > block->at && is_blank(end[-1])) end--;
    buffer_put(self->out, block->at, (size_t)(end - block->at));
    buffer_put(self->out, " {\n", 3);
    for (const FieldSyntax *field = block->fields; field; field = field->next)
        put_outside(self, field->at, field->end, field->name);
    buffer_put(self->out, "};\n", 3);
}

void print_shader(const Run *run, Buffer *out) {
    Printer self = {.run = run, .out = out};
    for (int k = 0; k < run->graph.count; k++) {
        const GraphNode *node = run->graph.nodes[k];
        if (node->live && node->op == NODE_OUTSIDE) self.used[node->word] = true;
    }
    buffer_put(out, run->syntax.head, (size_t)(run->syntax.head_end - run->syntax.head));
    for (const Declaration *one = run->syntax.first; one; one = one->next) {
        if (one->kind == DECLARATION_BLOCK) put_block(&self, one);
        const bool plain = one->kind == DECLARATION_OUTSIDE || one->kind == DECLARATION_OUTPUT;
        if (plain && (self.used[one->name] || one->kind == DECLARATION_OUTPUT))
            put_outside(&self, one->at, one->end, one->name);
    }
    buffer_put_text(out, "void main() {\n");
    self.indent = 1;
    put_region(&self, run->graph.whole);
    buffer_put_text(out, "}\n");
}
