/* pose.h - vertices in the rest pose: node transforms, skins and the default weights of morph targets */
#ifndef WEFT_GLTF_POSE_H
#define WEFT_GLTF_POSE_H

#include "gltf/asset/asset.h"

/* The records of skins. Nodes must be counted, and are checked, by the caller afterwards. */
void skins_read(Asset *asset, size_t node_count);

/* Transforms the vertices of one primitive under one node to the world. */
typedef struct Pose {
    Transform world;   /* without a skin: the node's */
    Transform *joints; /* with one: from the mesh at bind time to the world, for each joint; else NULL */
    uint32_t *index[SKIN_SETS];
    float *weight[SKIN_SETS];
    bool mirrored; /* front faces turn around */
} Pose;

/* Decodes into scratch. Fails (sticky) where a joint is out of range. A skinned mesh ignores its node's own
 * transform. */
Pose pose_prepare(Asset *asset, Arena *scratch, const Node *node, const Primitive *primitive);

/* The map of one vertex: the pose's own, or with a skin a blend made in *blend. */
const Transform *pose_at(const Pose *pose, size_t vertex, Transform *blend);

/* Adds the morph targets of attribute (0 position, 1 normal, 2 tangent) to the first three of every `stride`
 * values, with the node's weights, else the mesh's. */
void pose_morph(Asset *asset, Arena *scratch, const Node *node, const Primitive *primitive, int attribute,
                float *values, size_t stride);

#endif
