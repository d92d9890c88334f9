/* draco_primitive.h - KHR_draco_mesh_compression: primitives whose accessors are made by decoding
 *
 * Specification: Hector Diaz et al., "KHR_draco_mesh_compression", Khronos glTF extension registry. */
#pragma once

#include "gltf/asset/field.h"

/* Reads the extension of a primitive whose accessors were read. */
void draco_read(const Field *field, Primitive *primitive);

/* Replaces the accessors of a primitive by those of its decoded mesh, on first use. Where that fails and the accessors
 * have data of their own, they are kept, with a warning; else the failure is sticky. */
void draco_unpack(Asset *asset, int mesh, Primitive *primitive);
