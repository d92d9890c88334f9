/* instances.h - EXT_mesh_gpu_instancing: the mesh of a node at many places
 *
 * Specification: Ed Mackey et al., "EXT_mesh_gpu_instancing", Khronos glTF extension registry. */
#pragma once

#include "gltf/asset/field.h"

/* Reads the extension of a node. */
void instances_read(const Field *field, Node *node);

/* Returns how often the mesh of a node is there. */
size_t instances_count(const Node *node);

/* The places of the instances of a node, decoded. */
typedef struct Instances {
    const float *values[INSTANCE_ATTRIBUTES]; /* translation, rotation, scale of each; NULL: none */
} Instances;

/* Decodes the places, into scratch. */
Instances instances_decode(Asset *asset, Arena *scratch, const Node *node);

/* Returns the transform of instance k to the world. */
Transform instances_world(const Instances *instances, const Node *node, size_t k);
