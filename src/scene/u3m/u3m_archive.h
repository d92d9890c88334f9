/* u3m_archive.h - a .u3ma: a zip with one .u3m and the files that it names
 *
 * Vizoo, "U3MA", 2020, has a part of zip: no encryption, no zip64, stored or deflated. Its names are checked before
 * anything is read, and nothing is ever written to a disk. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "base/file.h"
#include "weft/result.h"

typedef struct U3mArchive U3mArchive;

/* Opens the zip of size bytes at data, which must outlive it; name is the subject of errors. Fails with
 * WEFT_MESSAGE_MATERIAL_FILE, for more than 4096 files, a name that leaves the archive, or a file that is encrypted,
 * above 1 GiB or larger than deflate can make of what is stored. Release with u3m_archive_close. */
WeftResult u3m_archive_open(const void *data, size_t size, const char *name, U3mArchive **out, WeftError *error);

/* Returns the path of the archive's .u3m; owned by the archive. */
const char *u3m_archive_material(const U3mArchive *archive);

/* Reads a file by its path. Fails with WEFT_MESSAGE_MATERIAL_FILE where there is none, or it is damaged, and _MEMORY.
 * Release with free(data). */
WeftResult u3m_archive_read(U3mArchive *archive, const char *path, FileBytes *out, WeftError *error);

/* Returns the path of file k of the archive, folders included, which end with a slash; NULL past the last. Owned by the
 * archive. */
const char *u3m_archive_file(const U3mArchive *archive, int k);

void u3m_archive_close(U3mArchive *archive); /* may be NULL */

/* Returns true for a path that stays in the folder of the file, as the specification demands: relative, with slashes,
 * without . and .. and characters that some system takes for more than a name. */
bool u3m_path_inside(const char *path);
