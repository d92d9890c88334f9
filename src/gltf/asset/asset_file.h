/* asset_file.h - the files beside an asset: each is read only once, under whatever names the asset refers to it */
#pragma once

#include "gltf/asset/field.h"

/* Returns the record of the file that uri names, and notes that its first `wanted` bytes are needed (more if
 * other references need more). Returns NULL after a sticky failure on field. */
AssetFile *file_refer(FileTable *table, const Field *field, const char *uri, size_t wanted);

/* Returns the bytes that all references before the first call need, or as many as the file has. `data` is
 * NULL after a sticky failure. At most 4 GiB are read for a table. */
Span file_bytes(FileTable *table, Asset *asset, AssetFile *file);

void files_free(FileTable *table);
