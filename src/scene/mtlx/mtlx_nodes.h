/* mtlx_nodes.h - MaterialX's surface nodes whose inputs are a material's: names, types and defaults
 *
 *   AcademySoftwareFoundation/MaterialX 1.39, libraries/bxdf/open_pbr_surface.mtlx (version 1.1 of the node),
 * gltf_pbr.mtlx (2.0.1), standard_surface.mtlx (1.0.1). */
#pragma once

#include "scene/record/scene.h"
#include "weft/save.h"

/* GREY is a color3 of one number. NORMAL and TANGENT are vectors that a graph makes. */
typedef enum MtlxType {
    MTLX_FLOAT,
    MTLX_COLOR,
    MTLX_GREY,
    MTLX_NORMAL,
    MTLX_TANGENT,
    MTLX_INTEGER,
    MTLX_BOOLEAN
} MtlxType;

/* The number of the material that an input of a node is. */
typedef enum MtlxRule {
    MTLX_SAME,       /* the number of the weft input */
    MTLX_SQUARE,     /* the square of the number: an alpha for a roughness */
    MTLX_WEIGHT,     /* a factor on the weft input, which another row has too; written as 1 */
    MTLX_MAP,        /* the texture of the weft input without the number, which is a strength */
    MTLX_ALPHA_MODE, /* 0 opaque, 1 mask, 2 blend */
    MTLX_ALPHA_CUTOFF,
    MTLX_TWO_SIDED,
    MTLX_FINITE /* as MTLX_SAME; not written where it is 0, which stands for infinity */
} MtlxRule;

typedef struct MtlxRow {
    const char *name;
    MtlxType type;
    MtlxRule rule;
    int input;     /* InputId; -1: none */
    float initial; /* the default of the node, of all channels */
} MtlxRow;

/* The formula by which a node makes two widths of a highlight of a roughness and an anisotropy. */
typedef enum MtlxStretch { MTLX_STRETCH_NONE, MTLX_STRETCH_OPENPBR, MTLX_STRETCH_ASPECT } MtlxStretch;

typedef struct MtlxNodeInfo {
    const char *id;
    const MtlxRow *rows;        /* until a name of NULL */
    const char *const *unshown; /* inputs that switch on what weft does not show, 0 by default; until NULL */
    const char *choices;        /* "name=value name=value": choices that are as the node has it */
    const char *shader;         /* "profile" or "workflow", and its id, of a material that is read */
    const char *shader_id;
    MtlxStretch stretch;
} MtlxNodeInfo;

extern const MtlxNodeInfo mtlx_nodes[WEFT_MTLX_NODES];

/* Returns the name of a row's type in a file: "float", "color3", "vector3", "integer" or "boolean". */
const char *mtlx_type_name(MtlxType type);

/* Returns the row of an input of the node, or NULL. */
const MtlxRow *mtlx_row(const MtlxNodeInfo *node, const char *name);

/* Returns the first row, not of a weight, that is made of a weft input, or NULL. */
const MtlxRow *mtlx_row_of(const MtlxNodeInfo *node, int input);

/* Turns a placement of texture coordinates whose v runs down, as glTF's does, into one whose v runs up, as MaterialX's
 * does, and back. */
void mtlx_flip(const float from[6], float to[6]);

/* Turns the numbers of a material into those that the node asks for in the same inputs: of any workflow into those of a
 * metallic one with an ior; sheen and fuzz into what the node has, as a weight and a colour; widths of highlights; glass.
 * A node without a thickness has one colour for glass: that of the walls, which is base_color, or with a depth that of what is
 * inside. Both are in INPUT_attenuation_color, and double_sided then says that the walls are thin. */
void mtlx_to_node(WeftMtlxNode node, Material *material);

/* Returns true if light goes through a material as through glass, which is drawn; if that is a solid that absorbs light. */
bool mtlx_is_glass(const Material *material);
bool mtlx_absorbs(const Material *material);

/* Turns widths of highlights that were read from a node into a roughness and an anisotropy. */
void mtlx_from_node(WeftMtlxNode node, Material *material);
