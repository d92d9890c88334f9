/* dds.h - a table as a DirectDraw surface, the container that Unreal, Unity and Direct3D read without conversion */
#pragma once

#include <stdio.h>

#include "weft/image.h"

/* Writes one surface without mipmaps: an F32 image of 1, 2 or 4 channels. Errors stay in the stream. */
void dds_write(FILE *stream, const WeftImage *image);
