/* result.h - results, errors and warnings of all calls
 *
 * A call that can fail returns a WeftResult and takes a WeftError* (may be NULL) that it fills on failure.
 * Warnings go to a WeftLog. The library never prints and never exits. */
#ifndef WEFT_RESULT_H
#define WEFT_RESULT_H

#include "weft/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The numbers are the exit codes of the weft program. */
typedef enum WeftResult {
    WEFT_OK = 0,
    WEFT_FAILED = 1,       /* a check or a comparison did not hold */
    WEFT_USAGE = 2,        /* a name, number or descriptor makes no sense */
    WEFT_INPUT = 3,        /* an input could not be read or is invalid */
    WEFT_RESOURCES = 4,    /* out of memory or disk space, or a device failed */
    WEFT_INTERRUPTED = 130 /* stopped by the caller; what there is, is valid */
} WeftResult;

/* M(id, result, text): every message of the library. Tests assert on ids; people read
 * "subject: text" or "subject: text: detail". */
#define WEFT_MESSAGES(M)                                                                                               \
    M(NONE, OK, "")                                                                                                    \
    M(MEMORY, RESOURCES, "out of memory")                                                                              \
    M(FILE_OPEN, INPUT, "cannot be opened")                                                                            \
    M(FILE_READ, INPUT, "cannot be read")                                                                              \
    M(FILE_LARGE, INPUT, "is too large")                                                                               \
    M(FILE_WRITE, RESOURCES, "cannot be written")                                                                      \
    M(OUTPUT_SUFFIX, USAGE, "has no suffix that names an image format (.png .exr .hdr .npy .ktx2)")                    \
    M(IMAGE_FORMAT, INPUT, "is not an image of a known format (PNG JPEG TGA TIFF DDS KTX2 HDR EXR NPY)")               \
    M(IMAGE_SIZE, INPUT, "is truncated, or its header is wrong")                                                       \
    M(CUBEMAP, INPUT, "is not a cubemap whose six faces are named as posx or px")                                      \
    M(IMAGE_DAMAGED, INPUT, "is damaged")                                                                              \
    M(IMAGE_UNSUPPORTED, INPUT, "uses an image feature that is not supported")                                         \
    M(IMAGE_REPAIRED, WARNING, "was repaired")                                                                         \
    M(GLTF_JSON, INPUT, "is not valid JSON")                                                                           \
    M(GLTF_CONTAINER, INPUT, "is not a valid GLB container")                                                           \
    M(GLTF_VERSION, INPUT, "is not glTF 2.x")                                                                          \
    M(GLTF_SCHEMA, INPUT, "breaks the glTF 2.0 schema")                                                                \
    M(GLTF_REFERENCE, INPUT, "refers to something that does not exist")                                                \
    M(GLTF_BOUNDS, INPUT, "reads outside its buffer")                                                                  \
    M(GLTF_URI, INPUT, "has a URI that is not allowed")                                                                \
    M(GLTF_EXTENSION, INPUT, "requires an extension that is not supported")                                            \
    M(GLTF_CYCLE, INPUT, "has a node that is its own ancestor")                                                        \
    M(GLTF_PARENTS, INPUT, "has a node with two parents")                                                              \
    M(GLTF_TOO_LARGE, INPUT, "exceeds a limit")                                                                        \
    M(GLTF_DECODE, INPUT, "has compressed data that does not decode")                                                  \
    M(GLTF_WARN_EXTENSION, WARNING, "uses an extension that is ignored")                                               \
    M(GLTF_WARN_IGNORED, WARNING, "has a part that is ignored")                                                        \
    M(GLTF_WARN_REST_POSE, WARNING, "is shown in its rest pose")                                                       \
    M(GLTF_WARN_REPAIRED, WARNING, "was repaired")                                                                     \
    M(SCENE_NAME, USAGE, "is not a built-in scene")                                                                    \
    M(SCENE_EMPTY, INPUT, "has nothing to render")                                                                     \
    M(SCENE_KIND, INPUT, "is not a scene of a known kind (.gltf .glb)")                                                \
    M(CAMERA_NAME, USAGE, "is not a camera of this scene")                                                             \
    M(VARIANT_NAME, USAGE, "is not a material variant of this scene")                                                  \
    M(MATERIAL_NAME, USAGE, "is not a material of this scene")                                                         \
    M(PRESET_NAME, USAGE, "is not a preset")                                                                           \
    M(MATERIAL_FILE, INPUT, "is not a valid material file")                                                            \
    M(PARAM_NAME, USAGE, "is not a parameter")                                                                         \
    M(PARAM_VALUE, USAGE, "is not a value that the parameter takes")                                                   \
    M(PARAM_RANGE, WARNING, "is out of range")                                                                         \
    M(PARAM_FITTED, WARNING, "is outside the range that was fitted")                                                   \
    M(PLAUSIBLE, WARNING, "is not plausible")                                                                          \
    M(LOBE_NAME, USAGE, "is not a lobe")                                                                               \
    M(EXPORT_LOBE, USAGE, "is a random walk, for the path tracer only: export fibre, which stands for it")             \
    M(LTC_LOBE, USAGE, "has no linearly transformed cosines")                                                          \
    M(CACHE_IGNORED, WARNING, "is not used as a cache")                                                                \
    M(LAYER_NAME, USAGE, "is not a layer rule")                                                                        \
    M(CHECK_NAME, USAGE, "is neither a lobe nor an engine profile")                                                    \
    M(MEASURED, INPUT, "is not a measured BRDF in MERL's format")                                                      \
    M(BSDF, INPUT, "is not a measured BRDF in RGL's format")                                                           \
    M(UTIA, INPUT, "is not a measured BRDF in UTIA's format")                                                          \
    M(BRDF_TABLE, INPUT, "is not a table of theta_o, phi_o, theta_i, phi_i, r, g, b")                                  \
    M(BAKE_KIND, USAGE, "is not a kind of table")                                                                      \
    M(TABLE_FORM, USAGE, "is not a form of table (gltf, filament and so on, or cos,roughness,centres)")                \
    M(DESC, USAGE, "is invalid")                                                                                       \
    M(RENDER_DEVICE, RESOURCES, "could not be built for ray tracing")                                                  \
    M(TEXT_NAME, USAGE, "is not a file of the catalogue")                                                              \
    M(TEXT_DIALECT, INPUT, "is not shading text")                                                                      \
    M(TEXTURES_SCALED, WARNING, "has textures of many sizes, which are scaled to one")                                 \
    M(GL_CONTEXT, RESOURCES, "cannot be used")                                                                         \
    M(GL_COMPILE, INPUT, "does not compile for the GPU")                                                               \
    M(GL_MEMORY, RESOURCES, "does not fit the GPU")                                                                    \
    M(DRAFT, INPUT, "is not a weaving draft that can be read")                                                         \
    M(DRAFT_NOTATION, USAGE, "is not a weave")                                                                         \
    M(DRAFT_COMPLETED, WARNING, "was completed")                                                                       \
    M(LOBE_FILE, INPUT, "is not a lobe that can be taken")                                                             \
    M(LOBE_COMPILE, INPUT, "does not compile")                                                                         \
    M(COMPILER, RESOURCES, "needs a C compiler; install gcc or clang")                                                 \
    M(YARN_NAME, USAGE, "is not a yarn")                                                                               \
    M(IMAGE_DENOISED, WARNING, "was denoised: to look at, not to measure by")                                          \
    M(DENOISER, RESOURCES, "cannot denoise")                                                                           \
    M(ISA_NAME, USAGE, "is not a set of instructions")                                                                 \
    M(ISA, RESOURCES, "cannot be used")

/* The result of warnings, which are logged and never returned. */
#define WEFT_WARNING WEFT_OK

/* The ids of messages: WEFT_MESSAGE_NONE and the rest of WEFT_MESSAGES. */
typedef enum WeftMessage {
#define WEFT_MESSAGE_ENUM(id, result, text) WEFT_MESSAGE_##id,
    WEFT_MESSAGES(WEFT_MESSAGE_ENUM)
#undef WEFT_MESSAGE_ENUM
        WEFT_MESSAGE_COUNT
} WeftMessage;

/* One failure: its message, and one line of text without a newline at its end. */
typedef struct WeftError {
    WeftResult result;   /* result of the call */
    WeftMessage message; /* the reason */
    char text[512];      /* "subject: text: detail", UTF-8 */
} WeftError;

/* Receives warnings. fn may be NULL: warnings are then dropped. text lives only during the call. fn may be
 * called from a thread the library made, but never from two at once for one log. */
typedef struct WeftLog {
    void (*fn)(void *user, WeftMessage message, const char *text); /* receives each warning */
    void *user;                                                    /* handed to fn as it is */
} WeftLog;

/* Returns the text of a message without subject or detail; never NULL. */
WEFT_API const char *weft_message_text(WeftMessage message);

#ifdef __cplusplus
}
#endif

#endif
