/* picture_part.h - a part of a picture: some of its rows, which one of several processes renders, and their file
 *
 * A picture is cut into bands of whole rows of the path tracer's tiles, 16 pixels high, which are dealt out in turn. A
 * tile knows nothing of other tiles, so that the parts are, byte for byte, what one process would have rendered. The
 * file is an .exr of the picture's size whose layers hold the rows as they are, and whose comment has the words,
 * KEY=VALUE, of the picture that they belong to. */
#pragma once

#include "cli/render/job.h"

/* Returns true if pixel row y of a picture of that height belongs to part `index` of `count`, counted from 0. */
bool picture_part_has_row(int height, int index, int count, int y);

/* Renders the part that the request names: desc is that of the whole picture. The other rows stay black. An
 * interruption is a failure, since a part is whole or not at all. */
WeftResult picture_part_trace(Job *job, const WeftRenderDesc *desc, WeftError *error);

/* Lists the layers of a picture that was merged as an .exr has them; returns their number. */
int picture_part_layers(const PicturePart *part, WeftImageLayer layers[WEFT_IMAGE_LAYERS]);

void picture_part_free(PicturePart *part);

/* Writes the part to every -o. */
WeftResult picture_part_write(const Job *job, WeftError *error);

/* Reads the parts of a picture in any order into a job without a scene, and the words of the first one into its
 * request. Fails with one line that names a file which is no part, is damaged, is of another picture or instruction
 * set, or is there twice, or that lists the missing ones. */
WeftResult picture_parts_read(const char *const *paths, int count, Request *request, Job *job, WeftError *error);
