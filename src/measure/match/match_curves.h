/* match_curves.h - the match of a material at every value that its textures have
 *
 * The match of a material's mean says what becomes of its numbers. If the roughness or the colour of the sheen come
 * from textures, it is repeated at nodes, for the mean of the texels around each: roughness and specular stay those
 * of the first match, the roughness of the sheen becomes another one, and the colours of sheen and base are
 * multiplied by gains. If the roughness of the base comes from a texture, it alone is searched at nodes of its own,
 * for the mean of all else. Between nodes of a roughness, a curve is a monotone cubic: Fritsch, Butland, "A Method
 * for Constructing Local Monotone Piecewise Cubic Interpolants", SIAM J. Sci. Stat. Comput. 5(2), 1984; between
 * brightnesses of the sheen it is linear. */
#pragma once

#include "measure/match/match.h"

/* The least and the greatest value of a number over a material's texels. */
typedef struct ValueRange {
    double low, high;
} ValueRange;

enum { CURVE_NODES = 7, CURVE_ROWS = 3, CURVE_PHASES = 2 };

/* A texel with a sheen as it is for the other engine. */
typedef struct SheenTexel {
    double roughness;                   /* of the sheen */
    double sheen_gain[3], base_gain[3]; /* factors on the colours */
} SheenTexel;

/* The mean of the texels around a node. */
typedef struct NodeMean {
    double weight; /* 0: there are none, and the node has the numbers of the material's mean */
    double base_color[3], sheen_color[3], roughness, metallic;
} NodeMean;

/* A node beside a texel. */
typedef struct CurvePlace {
    int row, column;
    double weight;
} CurvePlace;

typedef struct MatchCurves {
    /* Set by the caller; brightness is the brightest channel of the sheen's colour. A number whose range is narrow is
     * constant: it has one node, its mean. */
    ValueRange sheen_roughness, brightness, roughness;
    /* Set by curves_begin. */
    int columns, rows, roughnesses;         /* nodes of sheen_roughness, brightness and roughness */
    NodeMean mean[CURVE_ROWS][CURVE_NODES]; /* set by the caller where the sheen varies */
    /* Set by curves_take, at the nodes. */
    SheenTexel node[CURVE_ROWS][CURVE_NODES];
    double to_roughness[CURVE_NODES];
} MatchCurves;

/* A search at a node. */
typedef struct CurveNode {
    WeftMaterial from, to; /* under both profiles, without textures; to: the start, then the match */
    int locked[WEFT_INPUTS_MAX];
} CurveNode;

/* Chooses the numbers of nodes. joined: the textures of the sheen's roughness and colour, if there are both, lie at the
 * same place; if not, the brightness counts as constant. */
void curves_begin(MatchCurves *curves, bool joined);

/* Finds the nodes around a texel, with weights that add up to 1. */
void curves_around(const MatchCurves *curves, double roughness, double brightness, CurvePlace out[4]);

/* Returns true if a number of the sheen varies. */
bool curves_vary_sheen(const MatchCurves *curves);

/* Returns the number of searches of a phase. Those of phase 1 begin where those of phase 0 ended. */
int curves_nodes(const MatchCurves *curves, int phase);

/* Prepares search k of a phase. from, to: the mean under both profiles, and its match. */
void curves_node(const MatchCurves *curves, int phase, int k, const WeftMaterial *from, const WeftMaterial *to,
                 CurveNode *node);

/* Keeps the result of search k of a phase. */
void curves_take(MatchCurves *curves, int phase, int k, const CurveNode *node);

/* Makes the curves of the roughnesses increase, after phase 0. */
void curves_straighten(MatchCurves *curves);

/* Returns what becomes of a texel with that roughness and brightness of the sheen; of a roughness of the base. Call the
 * former if curves_vary_sheen, the latter if `roughnesses` is above 1. */
SheenTexel curves_sheen(const MatchCurves *curves, double roughness, double brightness);
double curves_roughness(const MatchCurves *curves, double roughness);

/* Returns true if a factor on the texture does what the curve of the sheen's roughness or of roughness does, within
 * half a step of 8 bits, and sets *factor to it. */
bool curves_sheen_is_factor(const MatchCurves *curves, double *factor);
bool curves_roughness_is_factor(const MatchCurves *curves, double *factor);

/* Returns true if gains of the sheen's colour, or of the base's, differ from node to node by more than 0.5 %. */
bool curves_gain_varies(const MatchCurves *curves, bool base);
