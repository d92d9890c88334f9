/* asset.h - one glTF file while it is read: what its parts have become so far, and what may still be spent
 *
 * Reading is in two passes. The first turns the JSON into the records below, checking every type, range and
 * reference, used or not (but for cameras, lights, samplers and images, which are checked when shown). The
 * second bakes what the scene shows. Errors are sticky: the first failure is kept in `result`, readers go on
 * with harmless values, and each stage ends by asking asset->result. */
#ifndef WEFT_GLTF_ASSET_H
#define WEFT_GLTF_ASSET_H

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

/* Bytes that belong to somebody else. */
typedef struct Span {
    const unsigned char *data; /* NULL: there are none, whatever size says */
    size_t size;
} Span;

/* A file beside the asset. */
typedef struct AssetFile {
    const char *path;
    dev_t device;
    ino_t node;
    size_t size, wanted; /* bytes: there; of them, to be read */
    FileBytes bytes;     /* owned */
    int image;           /* of the scene, + 1; 0: none */
} AssetFile;

/* Distinct files: one that is referred to by several names is here once. */
typedef struct FileTable {
    AssetFile *items;
    size_t count, bytes; /* how many; how much of them was read */
} FileTable;

typedef struct AssetBuffer {
    Span span;
    AssetFile *file;      /* where its bytes lie, or NULL */
    unsigned char *owned; /* what to free when the read ends, or NULL */
} AssetBuffer;

/* EXT_meshopt_compression of a buffer view. */
typedef struct Compression {
    Span source;
    size_t count, stride;
    enum { MODE_ATTRIBUTES, MODE_TRIANGLES, MODE_INDICES } mode;
    enum { FILTER_NONE, FILTER_OCTAHEDRAL, FILTER_QUATERNION, FILTER_EXPONENTIAL } filter;
} Compression;

typedef struct BufferView {
    Span span;                /* decoded on first use where compressed */
    size_t stride;            /* 0: packed */
    Compression *compression; /* NULL: none */
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

/* KHR_texture_basisu and the like leave image at -1 where they are the only source. */
typedef struct TextureSource {
    int image, sampler;
    int scene_texture; /* index into the scene's textures, -1 until something shown needs it */
} TextureSource;

enum { SKIN_SETS = 2, TARGET_ATTRIBUTES = 3 };

typedef struct Primitive {
    int mode; /* of the specification: 4 triangles, 5 strip, 6 fan; the others are not surfaces */
    int position, normal, tangent, texcoord[2], color, index; /* accessors, -1: absent */
    int joints[SKIN_SETS], weights[SKIN_SETS];
    int material;                      /* of the scene */
    int *variant_material;             /* as in Mesh */
    int (*targets)[TARGET_ATTRIBUTES]; /* position, normal, tangent of each morph target */
    size_t target_count;
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

typedef struct Node {
    const char *name;
    int parent, mesh, skin, camera, light; /* -1: none */
    bool shown;                            /* reached from the scene that is shown */
    float *weights;                        /* instead of the mesh's; NULL: none */
    size_t weight_count;
    Transform local, world;
} Node;

typedef struct Asset {
    const char *name; /* subject of messages */
    bool in_memory;   /* then files beside it are refused */
    bool examined;    /* by who shows nothing: no extension is refused, nobody's textures are read too, and an
                         image that cannot be read is a warning */
    const WeftLog *log;
    WeftError *error;
    WeftResult result;     /* of the first failure */
    WeftProgress progress; /* NULL: nobody watches */
    void *user;            /* of progress */
    WeftScene *scene;
    Arena arena; /* dies with the read */

    FileBytes file; /* the asset's own bytes, owned; empty where they are the caller's */
    json_t *root;
    Span text;   /* what root was read from */
    Span bin;    /* BIN chunk of a GLB */
    Span behind; /* the chunks of a GLB that nobody knows, with their headers */
    bool packed; /* true for a GLB */

    FileTable buffer_files, image_files;

    /* Bytes that decoding may produce in all. A small hostile file must not become a large scene. */
    size_t input_bytes, limit, spent;
    size_t triangles;

    AssetBuffer *buffers;
    BufferView *views;
    Accessor *accessors;
    TextureSource *textures;
    MeshSource *meshes;
    Skin *skins;
    Node *nodes;
    int *node_order; /* parents before children */
    size_t buffer_count, view_count, accessor_count, image_count, sampler_count, texture_count,
        material_count, mesh_count, skin_count, camera_count, light_count, node_count;
    bool *material_shown; /* material_count + 1, the last for surfaces without a material */
} Asset;

/* The sticky failure: keeps the first. detail is a printf format or NULL. */
__attribute__((format(printf, 3, 4))) void asset_fail(Asset *asset, WeftMessage message, const char *detail,
                                                      ...);

/* Tells whoever watches what share of the read is done, of the part that runs from low to high; false, with a
 * sticky WEFT_INTERRUPTED, where it is to stop. For the thread that made the call alone. */
bool asset_progress(Asset *asset, double low, double high, size_t done, size_t of);

/* Charges count * size bytes to the limit for good; false after a sticky GLTF_TOO_LARGE. */
bool asset_charge(Asset *asset, size_t count, size_t size);

/* count * size zeroed bytes from an arena (the asset's or the scene's), charged to the limit for good; NULL
 * after a sticky GLTF_TOO_LARGE or MEMORY. */
void *asset_array(Asset *asset, Arena *arena, size_t count, size_t size);

/* A copy in the scene's arena; "" after a sticky failure. */
const char *asset_text(Asset *asset, const char *text);

#endif
