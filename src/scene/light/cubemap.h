/* cubemap.h - a cube map of the light around a scene, six files or one of KTX 2, read as one lat-long image
 *
 * Faces are called posx negx posy negy posz negz, or px nx py ny pz nz, in any case, each with any suffix of
 * image/. They lie as OpenGL has them ("OpenGL 3.3 Core Profile", 3.8.9, table 3.20): posx is seen from
 * inside with -y down and -z to the right, and row 0 of a file is on top. The six faces of a KTX 2 file lie in the same
 * order and in the same way ("KTX File Format Specification", version 2.0.4, section 4). */
#pragma once

#include <stdbool.h>

#include "weft/image.h"

/* Returns true if the path is a folder, is named like a face of a cube map, or is a KTX 2 file of six faces. */
bool cubemap_named(const char *path);

enum { CUBEMAP_WIDTH = 8192 };

/* Reads the cube map of a KTX 2 file, of a folder, or of a face's folder, as F32 RGB of 4 n by 2 n for faces of n by n, at most
 * CUBEMAP_WIDTH wide. Integers are decoded from sRGB unless a KTX 2 file has linear ones. Fails as weft_image_read does, or with WEFT_MESSAGE_CUBEMAP if a
 * face is missing, there twice, not square, or of another size than the rest. */
WeftResult cubemap_read(const char *path, WeftImage *out, const WeftLog *log, WeftError *error);
