/* picture_merge.h - the parts of a picture (picture_part.h) become the picture */
#pragma once

#include "cli/render/job.h"

/* Reads the parts of a picture in any order into a job without a scene, and how it is shown into its request. Parts with
 * fewer samples than others of the same picture are left aside. Fails with one line that names a file which is no part,
 * is damaged, is of another picture or instruction set, or is there twice, or that lists the missing ones. */
WeftResult picture_parts_read(const char *const *paths, int count, Request *request, Job *job, WeftError *error);

/* Lists the layers of a picture that was merged as an .exr has them; returns their number. */
int picture_merged_layers(const PicturePart *part, WeftImageLayer layers[WEFT_IMAGE_LAYERS]);
