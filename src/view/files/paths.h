/* paths.h - kinds of files, by their names */
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef enum PathKind {
    PATH_UNKNOWN,
    PATH_SCENE,    /* .gltf .glb builtin: */
    PATH_LIGHT,    /* .hdr .exr */
    PATH_MATERIAL, /* .json .u3m .u3ma .mtlx preset: */
    PATH_LOBE,     /* .h */
    PATH_DRAFT,    /* .wif .dtx */
    PATH_PICTURE,  /* .png .jpg .jpeg .webp .tga .tif .tiff .ktx2 */
    PATH_FOLDER
} PathKind;

PathKind path_kind(const char *path);

/* Returns true if the folder holds the first face of a cube map, posx or px. */
bool path_is_cubemap(const char *folder);

/* Returns the part after the last slash. */
const char *path_name(const char *path);

/* Copies the name of the file without its suffix; characters that are not fit for a file name become '-'. */
void path_stem(const char *path, char *stem, size_t size);

/* Returns true if the file name contains the word, in any case. */
bool path_contains(const char *path, const char *word);

/* Returns a number that changes with the time or the size of a file; 0 if it does not exist. */
unsigned long long path_stamp(const char *path);
