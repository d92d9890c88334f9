#include "text/flat/placement.h"

enum { LENGTH_MOST = 40 };

static bool is_phi(const GraphNode *node) {
    return node->op == NODE_PHI || node->op == NODE_LOOP_PHI || node->op == NODE_EXIT;
}

static bool is_leaf(const GraphNode *node) {
    return node->op == NODE_NUMBER || node->op == NODE_OUTSIDE || node->op == NODE_UNKNOWN;
}

/* Marks something as needed. Returns true if it was not marked before. */
static bool need(GraphNode *node) {
    const bool found = node && !node->live;
    if (found) node->live = true;
    return found;
}

/* Marks a flow and those around it. */
static bool need_flow(Flow *flow) {
    bool found = false;
    for (; flow && !flow->live; flow = flow->region->owner) {
        flow->live = found = true;
        need(flow->condition);
        if (flow->kind != FLOW_LOOP) continue;
        for (Flow *stay = flow->body->first; stay; stay = stay->next)
            if (stay->kind == FLOW_STAY) {
                stay->live = true;
                need(stay->condition);
            }
    }
    return found;
}

/* Marks what has an effect by itself. */
static void need_effects(Region *region) {
    for (Flow *flow = region->first; flow; flow = flow->next) {
        if (flow->kind == FLOW_DISCARD || flow->kind == FLOW_OUTPUT) need_flow(flow);
        if (flow->body) need_effects(flow->body);
        if (flow->other) need_effects(flow->other);
    }
}

static bool need_operands(GraphNode *node) {
    bool found = need_flow(node->flow);
    found |= need_flow(node->home->owner);
    for (int k = 0; k < node->count; k++) found |= need(node_operand(node, k));
    if (node->op == NODE_LOOP_PHI) found |= need(node->operands[1]);
    return found;
}

/* Marks all nodes and flows that the outputs depend on. A loop's phi depends on later nodes, hence the rounds. */
static void mark(Graph *graph) {
    need_effects(graph->whole);
    for (bool again = true; again;) {
        again = false;
        for (int k = graph->count - 1; k >= 0; k--)
            if (graph->nodes[k]->live) again |= need_operands(graph->nodes[k]);
    }
}

static Region *common(Region *a, Region *b) {
    while (a != b)
        if (a->depth > b->depth)
            a = a->parent;
        else
            b = b->parent;
    return a;
}

static void use(GraphNode *node, Region *region) {
    node->uses++;
    node->user = region;
    node->place = node->place ? common(node->place, region) : region;
}

bool placement_before(const GraphNode *phi) {
    const GraphNode *other = node_operand(phi, 1);
    return (is_leaf(other) || is_phi(other)) && region_within(phi->flow->region, other->home);
}

/* Adds the uses by a flow and its phis. */
static void use_flow(Flow *flow) {
    if (flow->condition) use(flow->condition, flow->region);
    for (int k = 0; k < flow->phi_count; k++) {
        GraphNode *phi = flow->phis[k];
        if (!phi->live) continue;
        if (flow->kind == FLOW_LOOP) {
            use(phi->operands[0], flow->region);
            use(phi->operands[1], flow->body);
        } else {
            use(phi->operands[0], flow->body);
            use(phi->operands[1], placement_before(phi) ? flow->region : flow->other);
        }
    }
}

static void use_flows(Region *region) {
    for (Flow *flow = region->first; flow; flow = flow->next) {
        if (!flow->live) continue;
        use_flow(flow);
        if (flow->body) use_flows(flow->body);
        if (flow->other) use_flows(flow->other);
    }
}

/* Sets the place of a node all of whose uses are known, and adds its uses of others. */
static void place(GraphNode *node) {
    if (node->pinned) {
        node->place = node->home;
    } else {
        Region *best = node->place;
        for (Region *region = best; region != node->home; region = region->parent)
            if (region->loop) best = region->parent;
        node->place = best;
    }
    for (int k = 0; k < node->count; k++) use(node_operand(node, k), node->place);
}

/* Returns true for what is as short as a name. */
static bool is_short(const GraphNode *node) {
    if (is_leaf(node) || is_phi(node) || node->name) return true;
    const GraphNode *first = node_operand(node, 0);
    if (node->op == NODE_PART || node->op == NODE_UNARY) return is_short(first);
    return node->op == NODE_INDEX && is_short(first) && is_leaf(node_operand(node, 1));
}

/* Decides whether a node gets a variable. */
static void name(GraphNode *node, int *names) {
    node->length = 1;
    for (int k = 0; k < node->count; k++)
        if (!node_operand(node, k)->name) node->length += node_operand(node, k)->length;
    if (is_short(node)) return;
    const bool shared = node->uses > 1 || node->user != node->place;
    if (!shared && node->length <= LENGTH_MOST) return;
    Region *region = node->place;
    node->name = ++*names;
    if (!region->end) region->end = &region->nodes;
    *region->end = node;
    region->end = &node->after;
}

void placement_of(Graph *graph) {
    int names = 0;
    mark(graph);
    use_flows(graph->whole);
    for (int k = graph->count - 1; k >= 0; k--) {
        GraphNode *node = graph->nodes[k];
        if (node->live && !is_phi(node) && !is_leaf(node)) place(node);
    }
    for (int k = 0; k < graph->count; k++) {
        GraphNode *node = graph->nodes[k];
        if (!node->live) continue;
        if (node->op == NODE_PHI || node->op == NODE_LOOP_PHI)
            node->name = ++names;
        else if (!is_phi(node) && !is_leaf(node))
            name(node, &names);
        else
            node->length = 1;
    }
}
