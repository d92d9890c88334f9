/* buffer_views.h - buffers and the views into them */
#pragma once

#include "gltf/asset/asset.h"

/* Reads every buffer and fixes the asset's decoding limit, which depends on their sizes. */
void buffers_read(Asset *asset);

void views_read(Asset *asset);

/* Returns the bytes of a view, decompressed where needed. `data` is NULL after a sticky failure. */
Span view_bytes(Asset *asset, int view);

void buffers_free(Asset *asset);
