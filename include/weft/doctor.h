/* doctor.h - validation (lint) of a cloth asset: findings for each engine, and repairs
 *
 *   weft_doctor_open("chair.gltf", &doctor, NULL, &error);
 *   for (int k = 0; k < weft_doctor_count(doctor); k++) puts(weft_doctor_finding(doctor, k)->words);
 *   weft_doctor_fix(doctor, "mended.glb", &error);
 *   weft_doctor_close(doctor);
 *
 * It examines the file as it is, before a reader clamps or repairs anything, and whatever a reader warns of is a
 * finding. Findings about light are measured
 * on the lobes that render, with the parameters of the material; docs/doctor.md explains what each finding looks
 * like, its cause, and how it is detected. The doctor does not render, and a difference between two engines does
 * not mean that one of them is wrong. */
#ifndef WEFT_DOCTOR_H
#define WEFT_DOCTOR_H

#include <stddef.h>

#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The severity of a finding. */
typedef enum WeftSeverity {
    WEFT_SEVERITY_NOTE = 0, /* may look different from what the author expects */
    WEFT_SEVERITY_WARNING,  /* looks wrong in some engine */
    WEFT_SEVERITY_ERROR     /* breaks the specification, or makes content invisible */
} WeftSeverity;

/* F(id, name, severity, fixable, help): every kind of finding, in the order of reports. fixable: 1 if
 * weft_doctor_fix can repair some of that kind; WeftFinding.fixable is set on those that it can. */
#define WEFT_FINDINGS(F)                                                                                               \
    F(EXTENSION_REQUIRED, "extension-required", ERROR, 0, "an extension is required that weft does not know")          \
    F(EXTENSION_UNDECLARED, "extension-undeclared", ERROR, 1, "an extension is used that extensionsUsed leaves out")   \
    F(VALUE_RANGE, "value-range", ERROR, 1, "a number is outside what glTF allows")                                    \
    F(DEFAULT_DISPUTED, "default-disputed", WARNING, 1, "a number is left out whose default readers do not agree on")  \
    F(TEXTURE_TIMES_ZERO, "texture-times-zero", ERROR, 1, "a texture is multiplied by a factor that is 0 by default")  \
    F(TEXTURE_OFF, "texture-off", NOTE, 0, "a texture is multiplied by a factor that is set to 0")                     \
    F(TEXTURE_TWO_SPACES, "texture-two-spaces", WARNING, 0, "one image is read as sRGB and as plain numbers")          \
    F(TEXTURE_SAYS_LINEAR, "texture-says-linear", WARNING, 0,                                                          \
      "a colour texture is marked as linear, and read as sRGB")                                                        \
    F(TEXTURE_TRANSFORM, "texture-transform", WARNING, 0, "KHR_texture_transform shrinks a texture to a line")         \
    F(TEXCOORD_MISSING, "texcoord-missing", ERROR, 0, "a texture is used on a mesh without its coordinates")           \
    F(IMAGE_REPAIRED, "image-repaired", WARNING, 0, "an image had to be repaired to be read")                          \
    F(SHEEN_BLACK, "sheen-black", WARNING, 0, "a sheen is there whose colour is black")                                \
    F(SHEEN_TEXTURE_BLACK, "sheen-texture-black", ERROR, 0, "the texture of a sheen is black")                         \
    F(SHEEN_ROUGHNESS_CHANNEL, "sheen-roughness-channel", ERROR, 1,                                                    \
      "the roughness of a sheen is in a channel that no engine reads")                                                 \
    F(SHEEN_ROUGHNESS_PLAIN, "sheen-roughness-plain", WARNING, 1, "the texture of a sheen's roughness has no effect")  \
    F(SHEEN_GAINS, "sheen-gains", WARNING, 1, "the sheen returns more light than arrives")                             \
    F(SHEEN_DARKENS, "sheen-darkens", NOTE, 0, "the sheen removes more light from the base than it adds")              \
    F(ENGINES_DIFFER, "engines-differ", NOTE, 0, "the same sheen is much brighter in one engine than in another")      \
    F(SHEEN_ON_METAL, "sheen-on-metal", WARNING, 1, "a sheen on a metal")                                              \
    F(SHEEN_TRANSMISSION, "sheen-transmission", WARNING, 0, "a sheen on what lets light through")                      \
    F(SHEEN_BEHIND_GLASS, "sheen-behind-glass", NOTE, 0, "a sheen and glass in one asset")                             \
    F(SHEEN_COAT, "sheen-coat", NOTE, 0, "a clear coat over a sheen")                                                  \
    F(SHEEN_IOR, "sheen-ior", NOTE, 0, "a sheen and an index of refraction in one material")                           \
    F(SHEEN_EMISSION, "sheen-emission", NOTE, 0, "a cloth that glows")                                                 \
    F(BASE_DARK, "base-dark", NOTE, 0, "a base colour darker than cloth")                                              \
    F(BASE_BRIGHT, "base-bright", WARNING, 1, "a base colour brighter than fresh snow")                                \
    F(METAL_DARK, "metal-dark", NOTE, 0, "a metal darker than metals are")                                             \
    F(IMPLAUSIBLE, "implausible", WARNING, 0, "a reflectance or metalness that no material has")                       \
    F(NORMALS_MISSING, "normals-missing", WARNING, 0, "a mesh has no normals, and is shown faceted")                   \
    F(TANGENTS_MISSING, "tangents-missing", WARNING, 0, "a normal map or a stretched highlight without tangents")      \
    F(BACK_MISSING, "back-missing", NOTE, 0, "cloth with an open edge that has no back")                               \
    F(IMAGE_UNREAD, "image-unread", ERROR, 0, "an image cannot be read")                                               \
    F(EXTENSION_ARCHIVED, "extension-archived", WARNING, 0, "an extension is used that Khronos has archived")          \
    F(EXTENSION_IGNORED, "extension-ignored", NOTE, 0, "an extension is used that weft does not read")                 \
    F(TEXTURE_UNSHOWN, "texture-unshown", ERROR, 0, "a texture has no picture or coordinates that weft reads")         \
    F(TEXTURE_CHANNEL, "texture-channel", ERROR, 1, "a number is in a channel of a texture that no engine reads")      \
    F(TEXTURE_PLAIN, "texture-plain", WARNING, 1, "the alpha that a number is read from is 1 everywhere")              \
    F(PART_IGNORED, "part-ignored", WARNING, 0, "a part of the file is left out")                                      \
    F(PART_REPAIRED, "part-repaired", WARNING, 0, "a value that makes no sense is read as another")                    \
    F(REST_POSE, "rest-pose", NOTE, 0, "skins or morph targets are there, of which the rest pose is seen")             \
    F(SCENE_EMPTY, "scene-empty", WARNING, 0, "the scene has no surface")                                              \
    F(UV_UNEVEN, "uv-uneven", NOTE, 0, "the texture coordinates of a cloth have several scales")                       \
    F(U3M_MEMBER, "u3m-member", ERROR, 0, "a U3M lacks a member that its schema demands")                              \
    F(U3M_SIZE, "u3m-size", WARNING, 0, "a picture of a U3M has no size in millimetres")                               \
    F(U3M_DPI, "u3m-dpi", WARNING, 0, "the millimetres and the dpi of a picture contradict each other")                \
    F(U3M_REPEAT, "u3m-repeat", NOTE, 0, "a picture of a U3M is mirrored or turned as it repeats")                     \
    F(U3M_CONSTANT, "u3m-constant", WARNING, 0, "a constant of a U3M is not the mean of its texture")                  \
    F(U3M_CHANNELS, "u3m-channels", WARNING, 0, "a number of a U3M has a coloured picture")                            \
    F(U3M_MODE, "u3m-mode", NOTE, 0, "a colour of a U3M is mixed in another way than by multiplication")               \
    F(U3M_GLOSS, "u3m-gloss", WARNING, 0, "the picture of a roughness is called gloss")                                \
    F(U3M_SPECULAR, "u3m-specular", WARNING, 0, "specular_value is beyond 8 % or looks like a reflectance")            \
    F(U3M_TINT, "u3m-tint", NOTE, 0, "a sheen of a U3M has the tint 0, which programs take for other defaults")        \
    F(U3M_COAT_NORMAL, "u3m-coat-normal", NOTE, 0, "a clear coat of a U3M is flat over a base with normals")           \
    F(U3M_GREEN, "u3m-green", WARNING, 0, "green points down in the normals of a U3M")                                 \
    F(U3M_NORMAL_SPACE, "u3m-normal-space", WARNING, 0, "the normals of a U3M are encoded as colours")                 \
    F(IMAGE_BASIS, "image-basis", WARNING, 0, "a KTX 2 picture is none that KHR_texture_basisu allows")

/* The kinds of findings: WEFT_FINDING_EXTENSION_REQUIRED and the rest of WEFT_FINDINGS. */
typedef enum WeftFindingKind {
#define WEFT_FINDING_ENUM(id, name, severity, fixable, help) WEFT_FINDING_##id,
    WEFT_FINDINGS(WEFT_FINDING_ENUM)
#undef WEFT_FINDING_ENUM
        WEFT_FINDING_COUNT
} WeftFindingKind;

/* Returns the members of the catalogue above by kind; NULL, or 0, out of range. */
WEFT_API const char *weft_finding_name(int kind);
WEFT_API const char *weft_finding_help(int kind);
WEFT_API WeftSeverity weft_finding_severity(int kind);
WEFT_API int weft_finding_fixable(int kind);

/* Returns "note", "warning" or "error"; NULL out of range. */
WEFT_API const char *weft_severity_name(WeftSeverity severity);

/* The part of an asset that a finding is about. */
typedef enum WeftFindingOf { WEFT_OF_ASSET = 0, WEFT_OF_MATERIAL, WEFT_OF_MESH, WEFT_OF_IMAGE } WeftFindingOf;

/* One thing that is wrong. Owned by the doctor. */
typedef struct WeftFinding {
    WeftFindingKind kind;  /* one of the catalogue */
    WeftSeverity severity; /* of that kind */
    WeftFindingOf of;      /* the part that it is about */
    int index;             /* in the list of that name in the file; 0 of the asset */
    char subject[96];      /* name of the object, or its place, such as "materials[3]", if it has none */
    unsigned engines;      /* bit k: profile k (weft_profile_name) is affected; 0: any reader of the file */
    char words[400];       /* what is wrong, with figures: a sentence without a full stop */
    char fix[280];         /* what to do */
    int fixable;           /* weft_doctor_fix does it */
    double figure;         /* the measured value; NAN where nothing was measured */
    char place[160];       /* a JSON pointer (RFC 6901) into the file */
} WeftFinding;

/* An asset that was examined. */
typedef struct WeftDoctor WeftDoctor;

/* Examines the .gltf or .glb at path, or the material .u3m or .u3ma, which must outlive the doctor. Fails as weft_scene_load does, except that
 * an unsupported required extension and an image that is missing or cannot be read are findings. log (may be
 * NULL) receives the reader's warnings. On success *out is owned by the caller: release it with
 * weft_doctor_close. */
WEFT_API WeftResult weft_doctor_open(const char *path, WeftDoctor **out, const WeftLog *log, WeftError *error);

/* Works as weft_doctor_open, but calls progress (may be NULL) with the finished fraction of materials and meshes.
 * progress can stop the examination: WEFT_INTERRUPTED. weft_doctor_fix examines its own output and calls
 * progress too, so user must outlive the doctor. */
WEFT_API WeftResult weft_doctor_open_watched(const char *path, WeftProgress progress, void *user, WeftDoctor **out,
                                             const WeftLog *log, WeftError *error);

/* Works as weft_doctor_open, from size bytes, which must outlive the doctor. */
WEFT_API WeftResult weft_doctor_open_memory(const void *data, size_t size, const char *name, WeftDoctor **out,
                                            const WeftLog *log, WeftError *error);

WEFT_API void weft_doctor_close(WeftDoctor *doctor); /* may be NULL */

/* Returns the number of findings, and a finding by index: first those of the asset, then by material, by mesh and
 * by image. NULL out of range. */
WEFT_API int weft_doctor_count(const WeftDoctor *doctor);
WEFT_API const WeftFinding *weft_doctor_finding(const WeftDoctor *doctor, int index);

/* Counts of the parts that were examined. */
typedef struct WeftDoctorInfo {
    int material_count, mesh_count, image_count; /* in the file */
    int sheen_count;                             /* materials with KHR_materials_sheen */
} WeftDoctorInfo;

/* Returns the counts of the parts that were examined. */
WEFT_API WeftDoctorInfo weft_doctor_info(const WeftDoctor *doctor);

/* Writes the asset as .glb or .gltf with all that is fixable fixed, and nothing else changed: all other JSON text
 * and all other bytes stay as they are. Files that the asset refers to are packed into a .glb, or copied along
 * with a .gltf in another folder. Fails with WEFT_MESSAGE_SCENE_KIND (another suffix), _FILE_OPEN, _FILE_WRITE
 * or _MEMORY. A U3M is not repaired: WEFT_MESSAGE_SCENE_KIND. */
WEFT_API WeftResult weft_doctor_fix(const WeftDoctor *doctor, const char *path, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
