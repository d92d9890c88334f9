/* save.c - weft_scene_save: writes a scene as a .glb, or as a .gltf with files beside it
 *
 * Specification: Khronos Group, "glTF 2.0 Specification", 2021, and its extension registry. */
#include "weft/save.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/path.h"
#include "gltf/asset/container.h"
#include "gltf/save/saving.h"
#include "scene/material/hair.h"
#include "weft/version.h"

static void root_save(Saving *saving) {
    json_t *info = json_object();
    saving_put(saving, info, "version", json_string("2.0"));
    saving_put(saving, info, "generator", json_string("weft " WEFT_VERSION));
    saving_put(saving, saving->root, "asset", info);
    textures_save(saving);
    if (saving->result == WEFT_OK) materials_save(saving);
    if (saving->result == WEFT_OK) nodes_save(saving);
}

static void buffer_save(Saving *saving) {
    json_t *buffer = json_object();
    if (!saving->size) { /* glTF forbids an empty buffer */
        json_decref(buffer);
        return;
    }
    saving_put(saving, buffer, "byteLength", json_integer((json_int_t)saving->size));
    if (!saving->packed) {
        const char *path = saving_beside(saving, ".bin"), *uri = path ? saving_uri(saving, path) : NULL;
        if (uri) saving_put(saving, buffer, "uri", json_string(uri));
        if (uri) saving_write(saving, path, saving->bytes, saving->size, NULL, 0);
    }
    saving_append(saving, saving_list(saving, "buffers"), buffer);
}

static void container_write(Saving *saving, const char *text) {
    size_t size = 0;
    unsigned char *head = container_head((Span){(const unsigned char *)text, strlen(text)}, saving->size, 0, &size);
    if (!head)
        saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    else if (size + saving->size > UINT32_MAX)
        saving_fail(saving, WEFT_MESSAGE_FILE_WRITE, saving->path, "it would have more than 4 GB");
    saving_write(saving, saving->path, head, size, saving->bytes, saving->size);
    free(head);
}

/* Writes the file that names all others, after them. */
static void file_write(Saving *saving) {
    size_t layout = saving->packed ? JSON_COMPACT : JSON_INDENT(1);
    char *text = json_dumps(saving->root, layout | JSON_REAL_PRECISION(17));
    if (!text)
        saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    else if (saving->packed)
        container_write(saving, text);
    else
        saving_write(saving, saving->path, text, strlen(text), "\n", 1);
    free(text);
}

WeftResult weft_scene_save(const WeftScene *scene, const char *path, WeftError *error) {
    bool packed = path_ends(path, ".glb");
    if (!packed && !path_ends(path, ".gltf"))
        return fail(error, WEFT_MESSAGE_SCENE_KIND, path, "write a .glb or a .gltf");
    WeftScene bald; /* hair grows anew when the scene is loaded */
    Saving saving = {.scene = &bald, .path = path, .packed = packed, .error = error, .root = json_object()};
    if (!hairs_left_out(scene, &saving.arena, &bald) || !saving.root)
        saving_fail(&saving, WEFT_MESSAGE_MEMORY, path, NULL);
    if (saving.result == WEFT_OK) root_save(&saving);
    if (saving.result == WEFT_OK) buffer_save(&saving);
    if (saving.result == WEFT_OK) file_write(&saving);
    json_decref(saving.root);
    free(saving.bytes);
    arena_free(&saving.arena);
    return saving.result;
}
