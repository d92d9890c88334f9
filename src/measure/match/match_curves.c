#include "measure/match/match_curves.h"

#include <math.h>
#include <string.h>

#include "shading/stack/input_ids.h"

/* A narrower range is a constant. */
static const double range_least = 0.02;

/* A colour that is darker has no gain. */
static const double dark = 1e-3;

static bool varies(ValueRange range) { return range.high - range.low > range_least; }

static double at_node(ValueRange range, int k, int count) {
    return count < 2 ? range.low : range.low + (range.high - range.low) * k / (count - 1.0);
}

void curves_begin(MatchCurves *curves, bool joined) {
    curves->columns = varies(curves->sheen_roughness) ? CURVE_NODES : 1;
    curves->rows = varies(curves->brightness) && (joined || curves->columns == 1) ? CURVE_ROWS : 1;
    curves->roughnesses = varies(curves->roughness) ? CURVE_NODES : 1;
}

bool curves_vary_sheen(const MatchCurves *curves) { return curves->columns > 1 || curves->rows > 1; }

/* Returns the number of nodes. Phase 0 has the brightest row, where the sheen is seen best, and the roughness of the base. */
int curves_nodes(const MatchCurves *curves, int phase) {
    if (phase == 1) return (curves->rows - 1) * curves->columns;
    return (curves_vary_sheen(curves) ? curves->columns : 0) + (curves->roughnesses > 1 ? curves->roughnesses : 0);
}

/* The place of a search among the nodes. */
typedef struct NodePlace {
    bool of_sheen;
    int row, column;
} NodePlace;

static NodePlace place_of(const MatchCurves *curves, int phase, int k) {
    const int columns = curves->columns > 1 ? curves->columns : 1;
    if (phase == 1) return (NodePlace){true, k / columns, k % columns};
    const int sheens = curves_vary_sheen(curves) ? columns : 0;
    return k < sheens ? (NodePlace){true, curves->rows - 1, k} : (NodePlace){false, 0, k - sheens};
}

static double brightest(const float *color) { return (double)fmaxf(fmaxf(color[0], color[1]), color[2]); }

/* Sets a number under both profiles: in `to` it changes in proportion. */
static void number_set(CurveNode *node, InputId input, double value) {
    float *from = node->from.inputs[input].value, *to = node->to.inputs[input].value;
    *to = *from > 0.0f ? (float)fmin((double)*to * value / (double)*from, 1.0) : (float)value;
    *from = (float)value;
}

/* Makes a node the mean of the texels around it, with its own roughness and brightness of the sheen. */
static void sheen_set(const MatchCurves *curves, NodePlace place, CurveNode *node) {
    const NodeMean *mean = &curves->mean[place.row][place.column];
    float *color = node->from.inputs[INPUT_sheen_color].value, *base = node->from.inputs[INPUT_base_color].value;
    if (mean->weight > 0.0) {
        for (int c = 0; c < 3; c++) base[c] = (float)mean->base_color[c];
        for (int c = 0; c < 3 && mean->sheen_color[c] > 0.0; c++) color[c] = (float)mean->sheen_color[c];
        number_set(node, INPUT_roughness, mean->roughness);
        number_set(node, INPUT_metallic, mean->metallic);
    }
    if (curves->columns > 1)
        node->from.inputs[INPUT_sheen_roughness].value[0] =
            (float)at_node(curves->sheen_roughness, place.column, curves->columns);
    const double most = brightest(color);
    if (curves->rows == 1 || !(most > 0.0)) return;
    const double wanted = at_node(curves->brightness, place.row, curves->rows);
    for (int c = 0; c < 3; c++) color[c] = (float)((double)color[c] * wanted / most);
}

static bool is_dark(const MatchCurves *curves, NodePlace place) {
    return curves->rows > 1 && at_node(curves->brightness, place.row, curves->rows) < dark;
}

/* Makes node->to start with the gains and the roughness that the brightest row has. */
static void sheen_start(const MatchCurves *curves, NodePlace place, CurveNode *node) {
    const SheenTexel *top = &curves->node[curves->rows - 1][place.column];
    float *color = node->to.inputs[INPUT_sheen_color].value, *base = node->to.inputs[INPUT_base_color].value;
    node->to.inputs[INPUT_sheen_roughness].value[0] = (float)top->roughness;
    node->locked[INPUT_sheen_roughness] = 1;
    node->locked[INPUT_sheen_color] = is_dark(curves, place);
    for (int c = 0; c < 3; c++) {
        color[c] = (float)fmin((double)node->from.inputs[INPUT_sheen_color].value[c] * top->sheen_gain[c], 1.0);
        if (is_dark(curves, place)) base[c] = node->from.inputs[INPUT_base_color].value[c];
    }
}

void curves_node(const MatchCurves *curves, int phase, int k, const WeftMaterial *from, const WeftMaterial *to,
                 CurveNode *node) {
    const NodePlace place = place_of(curves, phase, k);
    *node = (CurveNode){.from = *from, .to = *to};
    for (int n = 0; n < WEFT_INPUTS_MAX; n++) node->locked[n] = 1;
    if (!place.of_sheen) {
        const double r = at_node(curves->roughness, place.column, curves->roughnesses);
        node->from.inputs[INPUT_roughness].value[0] = (float)r;
        node->to.inputs[INPUT_roughness].value[0] = (float)r;
        node->locked[INPUT_roughness] = 0;
        return;
    }
    static const InputId open[] = {INPUT_sheen_roughness, INPUT_sheen_color, INPUT_base_color};
    for (size_t n = 0; n < sizeof open / sizeof *open; n++) node->locked[open[n]] = 0;
    sheen_set(curves, place, node);
    if (phase == 1) {
        sheen_start(curves, place, node);
        return;
    }
    for (size_t n = 0; n < sizeof open / sizeof *open; n++)
        memcpy(node->to.inputs[open[n]].value, node->from.inputs[open[n]].value, sizeof node->to.inputs->value);
}

static void gains_of(const CurveNode *node, InputId input, double gain[3]) {
    const float *was = node->from.inputs[input].value, *now = node->to.inputs[input].value;
    for (int c = 0; c < 3; c++) gain[c] = (double)was[c] > dark ? (double)now[c] / (double)was[c] : 1.0;
}

void curves_take(MatchCurves *curves, int phase, int k, const CurveNode *node) {
    const NodePlace place = place_of(curves, phase, k);
    if (!place.of_sheen) {
        curves->to_roughness[place.column] = (double)node->to.inputs[INPUT_roughness].value[0];
        return;
    }
    SheenTexel *texel = &curves->node[place.row][place.column];
    texel->roughness = (double)node->to.inputs[INPUT_sheen_roughness].value[0];
    gains_of(node, INPUT_sheen_color, texel->sheen_gain);
    gains_of(node, INPUT_base_color, texel->base_gain);
    if (is_dark(curves, place))
        memcpy(texel->sheen_gain, curves->node[curves->rows - 1][place.column].sheen_gain, sizeof texel->sheen_gain);
}

void curves_straighten(MatchCurves *curves) {
    SheenTexel *top = curves->node[curves->rows - 1];
    for (int k = 1; k < curves->columns; k++) top[k].roughness = fmax(top[k].roughness, top[k - 1].roughness);
    for (int k = 1; k < curves->roughnesses; k++)
        curves->to_roughness[k] = fmax(curves->to_roughness[k], curves->to_roughness[k - 1]);
}

/* A place between two nodes: the first of them, and the weights of four numbers, the values at both and the slopes. */
typedef struct CurveSpan {
    int first;
    double t;
} CurveSpan;

static CurveSpan between(ValueRange range, int count, double x) {
    if (count == 1) return (CurveSpan){0, 0.0};
    const double at = fmin(fmax((x - range.low) / (range.high - range.low), 0.0), 1.0) * (count - 1);
    const int first = (int)fmin(floor(at), count - 2.0);
    return (CurveSpan){first, at - first};
}

void curves_around(const MatchCurves *curves, double roughness, double brightness, CurvePlace out[4]) {
    const CurveSpan column = between(curves->sheen_roughness, curves->columns, roughness);
    const CurveSpan row = between(curves->brightness, curves->rows, brightness);
    for (int k = 0; k < 4; k++) {
        const int right = k & 1, down = k >> 1;
        out[k] = (CurvePlace){.row = row.first + (curves->rows > 1 ? down : 0),
                              .column = column.first + (curves->columns > 1 ? right : 0),
                              .weight = (down ? row.t : 1.0 - row.t) * (right ? column.t : 1.0 - column.t)};
    }
}

/* Returns the slope at node k of evenly spaced nodes, per step: the harmonic mean of those beside it. */
static double slope(const double *y, int count, int k) {
    if (k == 0 || k == count - 1) return k == 0 ? y[1] - y[0] : y[k] - y[k - 1];
    const double before = y[k] - y[k - 1], after = y[k + 1] - y[k];
    return before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
}

static double cubic(const double *y, int count, CurveSpan at) {
    if (count == 1) return y[0];
    const double t = at.t, *a = y + at.first;
    const double from = slope(y, count, at.first), to = slope(y, count, at.first + 1);
    return a[0] + (a[1] - a[0]) * t * t * (3.0 - 2.0 * t) + t * (1.0 - t) * ((1.0 - t) * from - t * to);
}

enum { NUMBERS = 7 };

/* Returns number n of a SheenTexel: the roughness, then the gains. */
static double number_of(const SheenTexel *texel, int n) {
    return n == 0 ? texel->roughness : n < 4 ? texel->sheen_gain[n - 1] : texel->base_gain[n - 4];
}

SheenTexel curves_sheen(const MatchCurves *curves, double roughness, double brightness) {
    const CurveSpan column = between(curves->sheen_roughness, curves->columns, roughness);
    const CurveSpan row = between(curves->brightness, curves->rows, brightness);
    double out[NUMBERS];
    for (int n = 0; n < NUMBERS; n++) {
        double end[2] = {0.0};
        for (int r = 0; r < 2; r++) {
            double y[CURVE_NODES] = {0.0};
            const int at = row.first + r < curves->rows ? row.first + r : row.first;
            for (int k = 0; k < curves->columns; k++) y[k] = number_of(&curves->node[at][k], n);
            end[r] = cubic(y, curves->columns, column);
        }
        out[n] = end[0] + (end[1] - end[0]) * row.t;
    }
    return (SheenTexel){out[0], {out[1], out[2], out[3]}, {out[4], out[5], out[6]}};
}

double curves_roughness(const MatchCurves *curves, double roughness) {
    return cubic(curves->to_roughness, curves->roughnesses, between(curves->roughness, curves->roughnesses, roughness));
}

/* Fits now = factor was by least squares, and returns true if it holds at all nodes. */
static bool is_factor(ValueRange range, int count, const double *now, double *factor) {
    const double half_step = 0.5 / 255.0;
    double products = 0.0, squares = 0.0;
    for (int k = 0; k < count; k++) {
        const double was = at_node(range, k, count);
        products += was * now[k];
        squares += was * was;
    }
    *factor = products / squares;
    for (int k = 0; k < count; k++)
        if (fabs(*factor * at_node(range, k, count) - now[k]) > half_step) return false;
    return true;
}

bool curves_sheen_is_factor(const MatchCurves *curves, double *factor) {
    double now[CURVE_NODES] = {0.0};
    for (int k = 0; k < curves->columns; k++) now[k] = curves->node[curves->rows - 1][k].roughness;
    return is_factor(curves->sheen_roughness, curves->columns, now, factor);
}

bool curves_roughness_is_factor(const MatchCurves *curves, double *factor) {
    return is_factor(curves->roughness, curves->roughnesses, curves->to_roughness, factor);
}

bool curves_gain_varies(const MatchCurves *curves, bool base) {
    const double most = 0.005;
    if (!curves_vary_sheen(curves)) return false;
    for (int c = 0; c < 3; c++) {
        double low = (double)INFINITY, high = -(double)INFINITY;
        for (int r = 0; r < curves->rows; r++)
            for (int k = 0; k < curves->columns; k++) {
                const SheenTexel *texel = &curves->node[r][k];
                const double gain = base ? texel->base_gain[c] : texel->sheen_gain[c];
                low = fmin(low, gain);
                high = fmax(high, gain);
            }
        if (high - low > most * high) return true;
    }
    return false;
}
