/* asset.h - one glTF file while it is read: the records of its parts, and how much decoding may still use
 *
 * A file is read in two passes. The first turns the JSON into the records below and checks every type,
 * range and reference, used or not; cameras, lights, samplers and images are checked only if they are shown.
 * The second bakes what the scene shows. Errors are sticky: `result` keeps the first failure, readers go on
 * with harmless values, and each stage ends with a test of asset->result. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "base/file.h"
#include "base/memory.h"
#include "gltf/asset/transform.h"
#include "scene/record/scene.h"
#include "weft/result.h"
#include "weft/scene.h"

/* Borrowed bytes. */
typedef struct Span {
    const unsigned char *data; /* NULL: no bytes, whatever size is */
    size_t size;
} Span;

/* A file beside the asset. */
typedef struct AssetFile {
    const char *path;
    dev_t device;
    ino_t node;
    size_t size, wanted; /* bytes in the file; bytes that are needed */
    FileBytes bytes;     /* NULL: not read yet; owned */
    int image;           /* of the scene, + 1; 0: none */
} AssetFile;

/* Distinct files: a file that several names refer to has one record. */
typedef struct FileTable {
    AssetFile *items;
    size_t count, bytes; /* number of items; bytes read so far */
} FileTable;

typedef struct AssetBuffer {
    Span span;
    AssetFile *file;      /* where its bytes lie, or NULL */
    unsigned char *owned; /* what to free when the read ends, or NULL */
} AssetBuffer;

/* KHR_meshopt_compression or EXT_meshopt_compression of a buffer view. */
typedef struct Compression {
    Span source;
    size_t count, stride;
    enum { MODE_ATTRIBUTES, MODE_TRIANGLES, MODE_INDICES } mode;
    enum { FILTER_NONE, FILTER_OCTAHEDRAL, FILTER_QUATERNION, FILTER_EXPONENTIAL, FILTER_COLOR } filter;
} Compression;

typedef struct BufferView {
    Span span;                /* decoded on first use where compressed: its data are until then those of the fallback */
    size_t stride;            /* 0: packed */
    Compression *compression; /* until it is decoded; NULL: none */
    int image;                /* of the scene, + 1; 0: none */
} BufferView;

typedef enum Component {
    COMPONENT_I8 = 5120,
    COMPONENT_U8 = 5121,
    COMPONENT_I16 = 5122,
    COMPONENT_U16 = 5123,
    COMPONENT_U32 = 5125,
    COMPONENT_F32 = 5126
} Component;

typedef struct Accessor {
    int view; /* -1: zeros */
    size_t offset, count;
    Component component;
    uint8_t columns, rows; /* scalars and vectors have 1 column */
    bool normalized;
    /* Sparse replacement: sparse_count elements of values at the places that indices list. */
    size_t sparse_count;
    int index_view, value_view;
    size_t index_offset, value_offset;
    Component index_component;
} Accessor;

/* A glTF texture. `image` is -1 if only an extension such as EXT_texture_avif names a source. */
typedef struct TextureSource {
    int image, sampler;
    int spare;         /* the plain picture beside that of an extension, -1: none */
    const char *offer; /* the extension that names a picture of another format; NULL: none */
    int scene_texture; /* index into the scene's textures, -1 until something shown needs it */
} TextureSource;

enum { SKIN_SETS = 2, TARGET_ATTRIBUTES = 3, DRACO_ATTRIBUTES = 10 };

/* KHR_draco_mesh_compression of a primitive. */
typedef struct DracoSource {
    int view;
    int64_t id[DRACO_ATTRIBUTES]; /* unique ids; -1: not compressed */
} DracoSource;

typedef struct Primitive {
    int mode; /* of the specification: 4 triangles, 5 strip, 6 fan; the others have no surface */
    int position, normal, tangent, texcoord[2], color, index; /* accessors, -1: absent */
    int set[2];                                               /* of texcoord: n of TEXCOORD_n */
    int joints[SKIN_SETS], weights[SKIN_SETS];
    int material;                      /* of the scene */
    int *variant_material;             /* as in Mesh */
    int (*targets)[TARGET_ATTRIBUTES]; /* position, normal, tangent of each morph target */
    size_t target_count;
    DracoSource *draco; /* until it is decoded; NULL: none */
} Primitive;

typedef struct MeshSource {
    const char *name;
    Primitive *primitives;
    size_t primitive_count;
    float *weights; /* of the morph targets; NULL: all 0 */
    size_t weight_count;
    bool morphs; /* some primitive has targets */
} MeshSource;

typedef struct Skin {
    int *joints;
    size_t joint_count;
    int inverse_bind; /* accessor, -1: identities */
} Skin;

enum { INSTANCE_ATTRIBUTES = 3 };

typedef struct Node {
    const char *name;
    int parent, mesh, skin, camera, light; /* -1: none */
    bool shown;                            /* reached from the scene that is shown */
    bool hidden;                           /* by KHR_node_visibility, itself or an ancestor */
    int instance[INSTANCE_ATTRIBUTES];     /* accessors of translations, rotations, scales; -1: none */
    size_t instance_count;                 /* 0: the mesh is there once, at the node */
    float *weights;                        /* replace those of the mesh; NULL: none */
    size_t weight_count;
    Transform local, world;
} Node;

typedef struct Asset {
    const char *name;         /* subject of messages */
    bool in_memory;           /* files beside it are refused */
    bool examined;            /* for the doctor: no extension is refused, the textures of unused materials are read
                         too, and an image that cannot be read is a warning */
    const WeftMoment *moment; /* of an animation, which is shown; NULL: at rest */
    const WeftLog *log;
    const struct Field *place; /* while a warning is given: the value that it is about; NULL: the asset */
    WeftError *error;
    WeftResult result;     /* of the first failure */
    WeftProgress progress; /* may be NULL */
    void *user;            /* of progress */
    WeftScene *scene;
    Arena arena; /* freed when the read ends */

    FileBytes file; /* the asset's own bytes, owned; empty where they are the caller's */
    json_t *root;
    Span text;   /* the text of root */
    Span bin;    /* BIN chunk of a GLB */
    Span behind; /* the other chunks of a GLB, with their headers */
    bool packed; /* true for a GLB */

    FileTable buffer_files, image_files;

    /* Decoding may produce at most `limit` bytes in all, so that a small hostile file does not become a large scene. */
    size_t input_bytes, limit, spent;
    size_t triangles;

    AssetBuffer *buffers;
    BufferView *views;
    Accessor *accessors;
    Texture *samplers; /* without images */
    TextureSource *textures;
    MeshSource *meshes;
    Skin *skins;
    Node *nodes;
    int *node_order; /* parents before children */
    size_t view_room, accessor_room;
    size_t buffer_count, view_count, accessor_count, image_count, sampler_count, texture_count, material_count,
        mesh_count, skin_count, camera_count, light_count, node_count;
    bool *material_shown; /* material_count + 1, the last for surfaces without a material */
    /* material_count + 1: n of the TEXCOORD_n that textures of a material call sets 0 and 1, -1: none does */
    int (*material_sets)[2];
    int *sets;        /* of the material that is read */
    Material **backs; /* of materials from behind, material_count + 1; NULL: it has none of its own */
} Asset;

/* Records a sticky failure, of which the first is kept. detail is a printf format or NULL. */
__attribute__((format(printf, 3, 4))) void asset_fail(Asset *asset, WeftMessage message, const char *detail, ...);

/* Reports the progress of the part of the read that runs from low to high. Returns false, with a sticky
 * WEFT_INTERRUPTED, if the read has to stop. Only the thread that called the reader may call it. */
bool asset_progress(Asset *asset, double low, double high, size_t done, size_t of);

/* Charges count * size bytes to the limit for good. Returns false after a sticky GLTF_TOO_LARGE. */
bool asset_charge(Asset *asset, size_t count, size_t size);

/* Allocates count * size zeroed bytes from an arena (the asset's or the scene's) and charges them to the
 * limit for good. Returns NULL after a sticky GLTF_TOO_LARGE or MEMORY. */
void *asset_array(Asset *asset, Arena *arena, size_t count, size_t size);

/* Copies a text to the scene's arena. Returns "" after a sticky failure. */
const char *asset_text(Asset *asset, const char *text);
