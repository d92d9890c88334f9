/* u3m.h - materials of the textile industry: .u3m, JSON beside its pictures, and .u3ma, both in an archive
 *
 * Vizoo and Browzwear, "Unified 3D Material", schema 1.1, 2020. docs/u3m.md says which members are shown and how. */
#pragma once

#include "scene/material/material_file.h"
#include "scene/u3m/u3m_archive.h"
#include "scene/u3m/u3m_source.h"

/* The files that a U3M names. */
typedef struct U3mFiles {
    const char *folder;  /* of the .u3m, "" or with a slash at its end; NULL: textures are refused */
    U3mArchive *archive; /* with that folder; NULL: the folder is one of the disk */
} U3mFiles;

/* Reads size bytes of JSON as a material of workflow disney. name is the subject of errors and warnings. A texture that
 * cannot be read gives way to its constant, with a warning. Fails with WEFT_MESSAGE_MATERIAL_FILE and _MEMORY. Release
 * with material_file_free in any case. */
WeftResult u3m_read(const void *data, size_t size, const char *name, const U3mFiles *files, MaterialFile *out,
                    const WeftLog *log, WeftError *error);

/* Reads the file at path. */
WeftResult u3m_load(const char *path, MaterialFile *out, const WeftLog *log, WeftError *error);
