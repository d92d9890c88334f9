#include "gltf/asset/asset.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/fail.h"

void asset_fail(Asset *asset, WeftMessage message, const char *detail, ...) {
    if (asset->result != WEFT_OK) return;
    char line[400];
    if (detail) {
        va_list arguments;
        va_start(arguments, detail);
        vsnprintf(line, sizeof line, detail, arguments);
        va_end(arguments);
        asset->result = fail(asset->error, message, asset->name, "%s", line);
    } else {
        asset->result = fail(asset->error, message, asset->name, NULL);
    }
}

bool asset_progress(Asset *asset, double low, double high, size_t done, size_t of) {
    double share = of ? (double)done / (double)of : 1.0;
    if (!asset->progress || !asset->progress(asset->user, low + (high - low) * share)) return true;
    if (asset->result == WEFT_OK && asset->error)
        *asset->error = (WeftError){.result = WEFT_INTERRUPTED, .text = "interrupted"};
    if (asset->result == WEFT_OK) asset->result = WEFT_INTERRUPTED;
    return false;
}

bool asset_charge(Asset *asset, size_t count, size_t size) {
    if (size && count > (asset->limit - asset->spent) / size) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "%zu bytes of input decode to more than %zu bytes",
                   asset->input_bytes, asset->limit);
        return false;
    }
    asset->spent += count * size;
    return true;
}

void *asset_array(Asset *asset, Arena *arena, size_t count, size_t size) {
    if (!asset_charge(asset, count, size)) return NULL;
    void *memory = arena_array(arena, count, size);
    if (!memory) asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
    return memory;
}

const char *asset_text(Asset *asset, const char *text) {
    const char *copy = arena_text(&asset->scene->arena, text);
    if (!copy) asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
    return copy ? copy : "";
}
