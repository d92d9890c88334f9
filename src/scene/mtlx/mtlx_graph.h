/* mtlx_graph.h - the texture, channel, factor and placement that a graph of MaterialX makes of an input */
#pragma once

#include <stdbool.h>

#include "scene/mtlx/xml.h"

/* The deepest chain of nodes that is followed; a circle is longer. */
enum { MTLX_CHAIN = 24 };

/* A texture, or a turned tangent, as a graph makes it. Strings are the document's. */
typedef struct MtlxSource {
    const XmlElement *file; /* the input that names the picture; NULL: it is a constant, in factor */
    float factor[3];
    int count;    /* numbers in it */
    int channel;  /* 0 to 3, or -1: all */
    bool square;  /* the texture times its factor is squared */
    float scale;  /* of a normal map */
    bool tangent; /* a tangent, turned by angle towards the bitangent, radians */
    float along, across;
    const char *wrap[2], *filter; /* as the document has them, or NULL */
    int texcoord;
    float place[6]; /* v up, as MaterialX has it */
} MtlxSource;

/* Follows an input with a nodename, nodegraph or interfacename. Returns false if a node is not understood: *strange is
 * then that node, or NULL where there is none of that name. */
bool mtlx_follow(const XmlElement *input, MtlxSource *out, const XmlElement **strange);

/* Returns true if an input's value comes from elsewhere. */
bool mtlx_is_connected(const XmlElement *input);

/* Reads count finite numbers between commas. Returns false if the text is anything else. */
bool mtlx_numbers(const char *text, float *values, int count);
