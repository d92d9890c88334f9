/* material_file.h - a material as a small JSON file: docs/materials.md has its keys */
#pragma once

#include "scene/record/scene.h"

/* The contents of a material file. input.texture is an index into textures, plus 1. */
typedef struct MaterialFile {
    Material material;       /* defaults for keys that the file lacks; name is "" */
    bool named[INPUT_COUNT]; /* given by the file */
    bool keep[INPUT_COUNT];  /* to be left as the asset has it */
    bool alpha_named, sided_named;
    Texture textures[INPUT_COUNT];
    WeftImage images[INPUT_COUNT];      /* owned */
    TextureLevels *levels[INPUT_COUNT]; /* owned; of images; NULL: none */
    char *paths[INPUT_COUNT];           /* owned; of images; NULL: an image that is none of a file */
    int texture_count, image_count;
    float span[INPUT_COUNT][2];     /* metres that the picture of an input spans; 0: as its transform says */
    float constant[INPUT_COUNT][3]; /* the value of an input with a texture where textures are not read */
    bool has_constants;             /* the file gives these; otherwise the factor of the texture stands for it */
    WeftCloth *cloth;               /* owned; NULL: none */
    Measured *measured;             /* owned; NULL: none */
    struct U3mText *u3m;            /* the U3M that this is of (scene/u3m/u3m_source.h); owned; NULL: it is of none */
    struct MaterialFile *back;      /* what is seen from behind, with no cloth and no back; owned; NULL: the same */
} MaterialFile;

/* Reads size bytes of JSON. name is the subject of errors and warnings; folder ("" or with a slash at its end) that of
 * textures, NULL: textures are refused. Release with material_file_free in any case. */
WeftResult material_file_read(const void *data, size_t size, const char *name, const char *folder, MaterialFile *out,
                              const WeftLog *log, WeftError *error);

/* Reads the file at path, whose textures are relative to it, or "preset:NAME", without warnings. */
WeftResult material_file_load(const char *path, MaterialFile *out, const WeftLog *log, WeftError *error);

void material_file_free(MaterialFile *file);
