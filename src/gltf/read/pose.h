/* pose.h - vertices in the rest pose: node transforms, skins and the default weights of morph targets */
#pragma once

#include "gltf/asset/asset.h"

/* Reads the records of skins. The caller counts the nodes before and checks them afterwards. */
void skins_read(Asset *asset, size_t node_count);

/* The transforms of the vertices of one primitive under one node to the world. */
typedef struct Pose {
    Transform world;   /* without a skin: of the node */
    Transform *joints; /* with a skin: of each joint, from the mesh at bind time to the world; else NULL */
    uint32_t *index[SKIN_SETS];
    float *weight[SKIN_SETS];
    bool mirrored; /* the winding of front faces is reversed */
} Pose;

/* Makes the pose, with arrays in scratch. Fails (sticky) if a joint is out of range. A skinned mesh ignores
 * the transform of its own node. */
Pose pose_prepare(Asset *asset, Arena *scratch, const Node *node, const Primitive *primitive);

/* Returns the transform of one vertex: the pose's own, or with a skin a blend of the joints, made in *blend. */
const Transform *pose_at(const Pose *pose, size_t vertex, Transform *blend);

/* Adds the morph targets of attribute (0 position, 1 normal, 2 tangent) to the first three of every `stride`
 * values, with the node's weights, else the mesh's. */
void pose_morph(Asset *asset, Arena *scratch, const Node *node, const Primitive *primitive, int attribute,
                float *values, size_t stride);
