/* picture_part.h - a part of a picture: some of its rows, which one of several processes renders, and their file
 *
 * A picture is cut into bands of whole rows of the path tracer's tiles, which are dealt out in turn. A tile knows nothing
 * of other tiles, so that the parts are, byte for byte, what one process would have rendered. The file is an .exr of the
 * picture's size whose layers hold the rows as they are, their AOVs and their sums (sums_file.h), to which more samples
 * can be added, and whose comment has the words, KEY=VALUE, of the picture that they belong to (picture_words.h). */
#pragma once

#include "cli/render/job.h"

/* The channels of the rows. */
extern const char *const picture_channels[4];

/* Returns true if pixel row y of a picture of that height belongs to part `index` of `count`, counted from 0. */
bool picture_part_has_row(int height, int index, int count, int y);

/* Renders the part that the request names: desc is that of the render, with a crop. The other rows stay black. An
 * interruption is a failure, since a part is whole or not at all. */
WeftResult picture_part_trace(Job *job, WeftRender *render, const WeftRenderDesc *desc, WeftError *error);

void picture_part_free(PicturePart *part);

/* Writes the part to every -o. */
WeftResult picture_part_write(const Job *job, WeftError *error);
