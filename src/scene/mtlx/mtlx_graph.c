#include "scene/mtlx/mtlx_graph.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "base/pi.h"

/* The walk through a graph, which ends after so many nodes: two inputs a node would double the steps of each. */
enum { STEPS = 1000 };

typedef struct GraphWalk {
    int depth, steps;
    const XmlElement *strange;
} GraphWalk;

bool mtlx_numbers(const char *text, float *values, int count) {
    for (int k = 0; text && k < count; k++) {
        char *end;
        const double value = strtod(text, &end);
        if (end == text || !isfinite(value) || fabs(value) > 1e30) return false;
        values[k] = (float)value;
        while (isspace((unsigned char)*end)) end++;
        if (*end != (k + 1 < count ? ',' : '\0')) return false;
        text = end + 1;
    }
    return text != NULL;
}

bool mtlx_is_connected(const XmlElement *input) {
    return xml_attribute(input, "nodename") || xml_attribute(input, "nodegraph") ||
           xml_attribute(input, "interfacename");
}

/* Returns the node that an input or output names, or the input of the graph around it that stands for it; NULL: none.
 * *output is the output of the node that is meant, or NULL. */
static const XmlElement *target(const XmlElement *input, const char **output) {
    const XmlElement *node = input->parent, *scope = node ? node->parent : NULL;
    const char *nodename = xml_attribute(input, "nodename"), *graph = xml_attribute(input, "nodegraph");
    const char *interface = xml_attribute(input, "interfacename");
    *output = xml_attribute(input, "output");
    if (strcmp(input->name, "output") == 0) scope = node; /* an output lies in the graph itself */
    if (!scope) return NULL;
    if (nodename) return xml_child(scope, nodename);
    if (interface) return xml_child(scope, interface);
    const XmlElement *found = graph ? xml_child(scope, graph) : NULL;
    if (!found) return NULL;
    const XmlElement *end = *output ? xml_child(found, *output) : found->first;
    while (!*output && end && strcmp(end->name, "output") != 0) end = end->next;
    *output = NULL;
    return end;
}

static bool strange(GraphWalk *walk, const XmlElement *node) {
    if (!walk->strange) walk->strange = node;
    return false;
}

static bool follow(GraphWalk *walk, const XmlElement *input, MtlxSource *out);

/* Reads the numbers of an input of a node; where the node lacks it, it has those of `values`. */
static bool given_numbers(const XmlElement *node, const char *name, float *values, int count) {
    const XmlElement *input = xml_child(node, name);
    return !input || (!mtlx_is_connected(input) && mtlx_numbers(xml_attribute(input, "value"), values, count));
}

/* Texture coordinates, or one of them: rows of (u, v, 1). */
typedef struct UvRows {
    float row[2][3];
    int texcoord;
} UvRows;

static bool follow_place(GraphWalk *walk, const XmlElement *input, UvRows *out);

static bool place_of_two(GraphWalk *walk, const XmlElement *node, UvRows *out) {
    UvRows second;
    const XmlElement *a = xml_child(node, "in1"), *b = xml_child(node, "in2");
    if (!a || !b || !follow_place(walk, a, out) || !follow_place(walk, b, &second)) return strange(walk, node);
    memcpy(out->row[1], second.row[0], sizeof second.row[0]);
    return out->texcoord == second.texcoord || strange(walk, node);
}

/* Reads a node of coordinates and of two numbers: what `multiply`, `add`, `subtract` and `dotproduct` make of them. */
static bool place_with(GraphWalk *walk, const XmlElement *node, UvRows *out) {
    float v[2] = {0.0f, 0.0f};
    const XmlElement *first = xml_child(node, "in1"), *second = xml_child(node, "in2");
    const bool swapped = first && !mtlx_is_connected(first);
    if (!first || !second || !follow_place(walk, swapped ? second : first, out)) return strange(walk, node);
    const char *text = xml_attribute(swapped ? first : second, "value"), *kind = node->name;
    if (!mtlx_numbers(text, v, 2)) {
        if (!mtlx_numbers(text, v, 1)) return strange(walk, node);
        v[1] = v[0];
    }
    const bool subtracts = strcmp(kind, "subtract") == 0;
    if (subtracts && swapped) return strange(walk, node);
    if (strcmp(kind, "dotproduct") == 0) {
        for (int k = 0; k < 3; k++) out->row[0][k] = v[0] * out->row[0][k] + v[1] * out->row[1][k];
        return true;
    }
    for (int k = 0; k < 2; k++) {
        if (strcmp(kind, "multiply") == 0)
            for (int c = 0; c < 3; c++) out->row[k][c] *= v[k];
        else
            out->row[k][2] += subtracts ? 0.0f - v[k] : v[k];
    }
    return true;
}

/* Scales coordinates by 1 / scale about the pivot and moves them by -offset. */
static bool place_2d(GraphWalk *walk, const XmlElement *node, UvRows *out) {
    float pivot[2] = {0.0f, 0.0f}, scale[2] = {1.0f, 1.0f}, offset[2] = {0.0f, 0.0f}, angle = 0.0f;
    const XmlElement *st = xml_child(node, "texcoord");
    const bool known = given_numbers(node, "pivot", pivot, 2) && given_numbers(node, "scale", scale, 2) &&
                       given_numbers(node, "offset", offset, 2) && given_numbers(node, "rotate", &angle, 1);
    if (!known || angle < 0.0f || angle > 0.0f || xml_child(node, "operationorder")) return strange(walk, node);
    if (st && !follow_place(walk, st, out)) return false;
    for (int k = 0; k < 2; k++) {
        if (!(fabsf(scale[k]) > 1e-6f)) return strange(walk, node);
        out->row[k][2] -= pivot[k];
        for (int c = 0; c < 3; c++) out->row[k][c] /= scale[k];
        out->row[k][2] += pivot[k] - offset[k];
    }
    return true;
}

static bool follow_place(GraphWalk *walk, const XmlElement *input, UvRows *out) {
    static const UvRows identity = {{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}, 0};
    const char *output;
    const XmlElement *node = target(input, &output);
    *out = identity;
    if (!node || ++walk->depth > MTLX_CHAIN || ++walk->steps > STEPS) return strange(walk, node);
    bool good = true;
    const char *kind = node->name;
    if (strcmp(kind, "texcoord") == 0) {
        float index = 0.0f;
        good = given_numbers(node, "index", &index, 1) && (is_equal(index, 0.0f) || is_equal(index, 1.0f));
        out->texcoord = index > 0.5f;
        if (!good) strange(walk, node);
    } else if (strcmp(kind, "combine2") == 0) {
        good = place_of_two(walk, node, out);
    } else if (strcmp(kind, "place2d") == 0) {
        good = place_2d(walk, node, out);
    } else if (strcmp(kind, "multiply") == 0 || strcmp(kind, "add") == 0 || strcmp(kind, "subtract") == 0 ||
               strcmp(kind, "dotproduct") == 0) {
        good = place_with(walk, node, out);
    } else {
        good = strange(walk, node);
    }
    walk->depth--;
    return good;
}

/* Reads image, tiledimage and gltf_image. */
static bool read_image(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    static const char *const placed[] = {
        "pivot", "scale", "rotate", "offset", "realworldimagesize", "realworldtilesize"};
    UvRows place = {{{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}, 0};
    float tiling[2] = {1.0f, 1.0f}, offset[2] = {0.0f, 0.0f};
    const XmlElement *st = xml_child(node, "texcoord"), *u = xml_child(node, "uaddressmode"),
                     *v = xml_child(node, "vaddressmode"), *filter = xml_child(node, "filtertype");
    out->file = xml_child(node, "file");
    out->factor[0] = out->factor[1] = out->factor[2] = 1.0f;
    if (!out->file || !xml_attribute(out->file, "value")) return strange(walk, node);
    for (size_t k = 0; k < sizeof placed / sizeof *placed; k++)
        if (xml_child(node, placed[k])) return strange(walk, node);
    if (st && !follow_place(walk, st, &place)) return false;
    if (!given_numbers(node, "uvtiling", tiling, 2) || !given_numbers(node, "uvoffset", offset, 2))
        return strange(walk, node);
    if (!given_numbers(node, "factor", out->factor, 3)) {
        if (!given_numbers(node, "factor", out->factor, 1)) return strange(walk, node);
        out->factor[1] = out->factor[2] = out->factor[0];
    }
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++) out->place[3 * k + c] = place.row[k][c] * tiling[k] - (c == 2 ? offset[k] : 0.0f);
    out->texcoord = place.texcoord;
    out->wrap[0] = u ? xml_attribute(u, "value") : NULL;
    out->wrap[1] = v ? xml_attribute(v, "value") : NULL;
    out->filter = filter ? xml_attribute(filter, "value") : NULL;
    return true;
}

/* Returns true if both inputs name the same node. */
static bool is_same_node(const XmlElement *a, const XmlElement *b) {
    const char *first = xml_attribute(a, "nodename"), *second = xml_attribute(b, "nodename");
    const char *of_first = xml_attribute(a, "output"), *of_second = xml_attribute(b, "output");
    const bool same_output = of_first && of_second ? strcmp(of_first, of_second) == 0 : of_first == of_second;
    return first && second && strcmp(first, second) == 0 && same_output;
}

/* Reads a value of a node without a graph: one number or three. */
static bool read_constant(const XmlElement *input, MtlxSource *out) {
    const char *text = xml_attribute(input, "value");
    out->count = mtlx_numbers(text, out->factor, 3) ? 3 : mtlx_numbers(text, out->factor, 1) ? 1 : 0;
    if (out->count == 1) out->factor[1] = out->factor[2] = out->factor[0];
    return out->count > 0;
}

static bool follow_or_read(GraphWalk *walk, const XmlElement *input, MtlxSource *out) {
    return mtlx_is_connected(input) ? follow(walk, input, out) : read_constant(input, out);
}

static bool read_multiply(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    const XmlElement *a = xml_child(node, "in1"), *b = xml_child(node, "in2");
    MtlxSource other = {.channel = -1};
    if (!a || !b || !follow_or_read(walk, a, out)) return strange(walk, node);
    if (is_same_node(a, b)) {
        if (out->square || out->tangent) return strange(walk, node);
        out->square = out->file != NULL;
        for (int c = 0; c < 3 && !out->file; c++) out->factor[c] *= out->factor[c];
        return true;
    }
    if (!follow_or_read(walk, b, &other)) return strange(walk, node);
    if (((out->file || out->tangent) && other.file) || out->square || other.square || other.tangent)
        return strange(walk, node);
    MtlxSource texture = out->file || out->tangent ? *out : other;
    const float *by = out->file || out->tangent ? other.factor : out->factor;
    for (int c = 0; c < 3; c++) texture.factor[c] *= by[c];
    texture.along *= by[0];
    texture.across *= by[0];
    *out = texture;
    return true;
}

/* Reads a sum of a tangent and a bitangent. */
static bool read_add(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    const XmlElement *a = xml_child(node, "in1"), *b = xml_child(node, "in2");
    MtlxSource other = {.channel = -1};
    if (!a || !b || !follow_or_read(walk, a, out) || !follow_or_read(walk, b, &other)) return strange(walk, node);
    if (!out->tangent || !other.tangent) return strange(walk, node);
    out->along += other.along;
    out->across += other.across;
    return true;
}

/* Reads a vector turned about the normal. MaterialX's implementations turn it clockwise, seen from the tip of the axis
 * (mx_rotate_vector3). */
static bool read_rotation(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    const XmlElement *in = xml_child(node, "in");
    float degrees = 0.0f;
    if (!in || !follow_or_read(walk, in, out) || !out->tangent || !given_numbers(node, "amount", &degrees, 1))
        return strange(walk, node);
    const float angle = (0.0f - degrees) * (PI_FLOAT / 180.0f), x = out->along, y = out->across;
    out->along = cosf(angle) * x - sinf(angle) * y;
    out->across = sinf(angle) * x + cosf(angle) * y;
    return true;
}

/* Takes one channel of a texture or of a constant. */
static bool take_channel(GraphWalk *walk, const XmlElement *node, int channel, MtlxSource *out) {
    if (channel < 0 || channel > 3 || out->channel >= 0 || out->square || out->tangent) return strange(walk, node);
    if (channel == 3 && !out->file) return strange(walk, node);
    const float factor = out->factor[channel < 3 ? channel : 0];
    out->channel = channel;
    out->factor[0] = out->factor[1] = out->factor[2] = factor;
    out->count = 1;
    return true;
}

static bool read_channel(GraphWalk *walk, const XmlElement *node, const char *output, MtlxSource *out) {
    static const char *const names[] = {"outr", "outg", "outb", "outa"}, *const axes[] = {"outx", "outy", "outz",
                                                                                          "outw"};
    const XmlElement *in = xml_child(node, "in");
    float index = 0.0f;
    if (!in || !follow_or_read(walk, in, out)) return strange(walk, node);
    int channel = -1;
    if (strcmp(node->name, "extract") == 0) {
        if (given_numbers(node, "index", &index, 1) && index >= 0.0f && index <= 3.0f) channel = (int)index;
    } else {
        for (int k = 0; output && k < 4; k++)
            if (strcmp(output, names[k]) == 0 || strcmp(output, axes[k]) == 0) channel = k;
    }
    return take_channel(walk, node, channel, out);
}

static bool read_normal_map(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    const XmlElement *in = xml_child(node, "in");
    float scale = 1.0f;
    if (!in || !follow_or_read(walk, in, out) || !out->file || !given_numbers(node, "scale", &scale, 1))
        return strange(walk, node);
    out->scale = scale;
    return true;
}

static bool read_same(GraphWalk *walk, const XmlElement *node, MtlxSource *out) {
    const XmlElement *in = xml_child(node, strcmp(node->name, "constant") == 0 ? "value" : "in");
    return in && follow_or_read(walk, in, out) ? true : strange(walk, node);
}

static bool read_axis(MtlxSource *out, bool across) {
    out->tangent = true;
    out->along = across ? 0.0f : 1.0f;
    out->across = across ? 1.0f : 0.0f;
    return true;
}

static bool read_node(GraphWalk *walk, const XmlElement *node, const char *output, MtlxSource *out) {
    const char *kind = node->name;
    if (strcmp(kind, "image") == 0 || strcmp(kind, "tiledimage") == 0 || strcmp(kind, "gltf_image") == 0)
        return read_image(walk, node, out);
    if (strcmp(kind, "multiply") == 0) return read_multiply(walk, node, out);
    if (strcmp(kind, "add") == 0) return read_add(walk, node, out);
    if (strcmp(kind, "rotate3d") == 0) return read_rotation(walk, node, out);
    if (strcmp(kind, "normalmap") == 0) return read_normal_map(walk, node, out);
    if (strcmp(kind, "tangent") == 0 || strcmp(kind, "bitangent") == 0) return read_axis(out, kind[0] == 'b');
    if (strcmp(kind, "convert") == 0 || strcmp(kind, "dot") == 0 || strcmp(kind, "constant") == 0)
        return read_same(walk, node, out);
    if (strcmp(kind, "extract") == 0 || strcmp(kind, "separate3") == 0 || strcmp(kind, "separate4") == 0)
        return read_channel(walk, node, output, out);
    return strange(walk, node);
}

static bool follow(GraphWalk *walk, const XmlElement *input, MtlxSource *out) {
    const char *output;
    const XmlElement *node = target(input, &output);
    if (!node || ++walk->depth > MTLX_CHAIN || ++walk->steps > STEPS) return strange(walk, node);
    const bool passes = strcmp(node->name, "output") == 0 || strcmp(node->name, "input") == 0;
    const bool good = passes ? follow_or_read(walk, node, out) : read_node(walk, node, output, out);
    walk->depth--;
    return good ? true : strange(walk, node);
}

bool mtlx_follow(const XmlElement *input, MtlxSource *out, const XmlElement **strange_node) {
    GraphWalk walk = {.depth = 0};
    *out = (MtlxSource){.channel = -1, .scale = 1.0f};
    const bool good = follow(&walk, input, out);
    *strange_node = walk.strange;
    return good;
}
