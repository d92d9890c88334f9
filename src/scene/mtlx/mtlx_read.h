/* mtlx_read.h - the values and textures of a MaterialX document as a material file
 *
 *   MaterialX Specification 1.39: elements, and the standard nodes image, tiledimage, gltf_image, texcoord, place2d
 * (without rotation), multiply, add, dotproduct, combine2, extract, separate3, separate4, convert, constant, normalmap,
 * tangent, bitangent and rotate3d. A graph of others is passed over with a warning. */
#pragma once

#include <jansson.h>
#include <stddef.h>

#include "weft/result.h"

/* Reads size bytes of XML: the first surface material whose node is one of mtlx_nodes. name is the subject of errors and
 * warnings. *out is the object that material_file_read takes as text: release it with json_decref. Fails with
 * WEFT_MESSAGE_MATERIAL_FILE or _MEMORY; *out is then NULL. */
WeftResult mtlx_read(const void *data, size_t size, const char *name, json_t **out, const WeftLog *log,
                     WeftError *error);
