/* foreign.h - files that have the suffix of a measured BRDF and are something else */
#pragma once

#include <stddef.h>

/* Returns what a file is by its first bytes, and what to do with it; NULL for one that may be a measurement. */
const char *foreign_name(const void *data, size_t size);
