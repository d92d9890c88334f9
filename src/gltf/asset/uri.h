/* uri.h - URIs of buffers and images: data in the URI itself, or a file beside the asset
 *
 * Accepted: "data:...;base64,..." and relative references with percent-encoding whose path stays in the
 * asset's folder or below it. Refused with GLTF_URI: every other scheme, absolute paths, `..` that leads out,
 * names with a zero byte, and all files where the asset itself came from memory. */
#pragma once

#include "gltf/asset/field.h"

bool uri_is_data(const char *uri);

/* Decodes a data URI. Release the bytes with free(); NULL after a sticky failure on field. */
unsigned char *uri_decode(const Field *field, const char *uri, size_t *size);

/* Decodes percent-encoding in place. Returns false if a % is not followed by two hexadecimal digits, or is %00. */
bool uri_unescape(char *text);

/* Returns the path of a file URI, in the asset's arena; NULL after a sticky failure on field. */
char *uri_path(const Field *field, const char *uri);
