/* asset_file.h - the files beside an asset: each is read once, however often and by whatever names it is referred
 * to
 */
#ifndef WEFT_GLTF_ASSET_FILE_H
#define WEFT_GLTF_ASSET_FILE_H

#include "gltf/asset/field.h"

/* The file that uri names, whose first `wanted` bytes are of interest (more where other references want
 * more). NULL after a sticky failure on field. */
AssetFile *file_refer(FileTable *table, const Field *field, const char *uri, size_t wanted);

/* The bytes that were wanted of it by all references before the first call, or as many as there are; data is
 * NULL after a sticky failure. At most 4 GiB are read for a table. */
Span file_bytes(FileTable *table, Asset *asset, AssetFile *file);

void files_free(FileTable *table);

#endif
