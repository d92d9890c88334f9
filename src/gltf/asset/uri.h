/* uri.h - URIs of buffers and images: data in the URI itself, or a file beside the asset
 *
 * Accepted: "data:...;base64,...", "data:...,..." with percent-encoding, and relative references with percent-encoding
 * whose file lies in the asset's folder or below it, or in that of weft_root_use. Refused with GLTF_URI: every other scheme,
 * absolute paths, `..` and links that lead out, names with a zero byte, and all files where the asset itself came from
 * memory. Backslashes are taken as slashes, with a warning. */
#pragma once

#include "gltf/asset/field.h"

bool uri_is_data(const char *uri);

/* Decodes a data URI. Release the bytes with free(); NULL after a sticky failure on field. */
unsigned char *uri_decode(const Field *field, const char *uri, size_t *size);

/* Decodes percent-encoding in place. Returns false if a % is not followed by two hexadecimal digits, or is %00. */
bool uri_unescape(char *text);

/* Returns the path of a file URI, in the asset's arena; NULL after a sticky failure on field. */
char *uri_path(const Field *field, const char *uri);

/* Works so for a file that is about to be written: it lies below the asset's folder, whatever weft_root_use says. */
char *uri_path_to_write(const Field *field, const char *uri);
