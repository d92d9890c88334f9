/* enclosure.h - which files an asset may name: those in its folder or below it, with links followed, and those of the
 * folder of weft_root_use */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Returns true if the relative path leaves the folder that it starts in, at any step. */
bool leaves_folder(const char *path);

/* Returns true if the asset may open the file; one that is not there counts by its name. The path begins with the
 * `folder` characters of the asset's folder. If not, out is the folder that would have to be opened, cut short where
 * it does not fit. */
bool is_enclosed(const char *path, size_t folder, char *out, size_t size);
