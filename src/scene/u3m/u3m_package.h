/* u3m_package.h - the files of a U3M that is written: a .u3m with its pictures beside it, or a .u3ma with all of them
 *
 * A .u3ma is the part of zip that Vizoo, "U3MA", 2020, allows: names in UTF-8 and marked so, stored or deflated, with no
 * attributes, extra fields or comments. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "weft/result.h"

typedef struct U3mPackage U3mPackage;

/* Begins the files of the .u3m or .u3ma at path, which must outlive the package. Fails with WEFT_MESSAGE_MEMORY. Release
 * with u3m_package_free. */
WeftResult u3m_package_begin(const char *path, U3mPackage **out, WeftError *error);

/* Adds a file, whose bytes are copied, under a path that u3m_path_inside takes, unless there is one of that path. own: it
 * is made by this program, so that one on the disk gives way; otherwise one with other bytes is not replaced. Fails with
 * WEFT_MESSAGE_FILE_WRITE for a path that is not allowed or more than 1 GiB in all, and _MEMORY. */
WeftResult u3m_package_add(U3mPackage *package, const char *path, const void *data, size_t size, bool own,
                           WeftError *error);

/* Returns true if the package has a file of that path. */
bool u3m_package_has(const U3mPackage *package, const char *path);

/* Writes everything, the .u3m of these bytes last: each file complete or not at all. Fails with WEFT_MESSAGE_FILE_WRITE
 * and _MEMORY. */
WeftResult u3m_package_write(U3mPackage *package, const void *text, size_t size, WeftError *error);

void u3m_package_free(U3mPackage *package); /* may be NULL */
