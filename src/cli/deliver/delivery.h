/* delivery.h - the parts of `weft deliver`: what is delivered, the folder, pictures of it, how far they are off */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "cli/console/options.h"
#include "cli/console/progress.h"
#include "weft/weft.h"

enum { DELIVER_TARGETS = 16, DELIVER_NAME = 80, DELIVER_PATH = 4096 };

/* The places that pictures are taken from. */
typedef enum ViewKind { VIEW_NEAR, VIEW_FAR, VIEW_COUNT } ViewKind;

/* The kinds of things that can be delivered. */
typedef enum SourceKind { SOURCE_ASSET, SOURCE_SCENE, SOURCE_MATERIAL, SOURCE_MEASURED, SOURCE_DRAFT } SourceKind;

/* Pictures of one scene, F32 RGBA; `sky` is small, from afar, in even light. */
typedef struct Shots {
    WeftImage views[VIEW_COUNT], sky;
} Shots;

/* The differences of the pictures of a delivered file from the reference's. */
typedef struct ViewErrors {
    double color;    /* |mean of colour - the reference's| over the reference's */
    double profile;  /* the same of each column's mean: the sum of |differences| over the sum of the reference's */
    double flip;     /* weft/diff.h */
    double contrast; /* standard deviation of the luminance over its mean, over that of the reference */
} ViewErrors;

typedef struct Errors {
    ViewErrors views[VIEW_COUNT];
    double sky; /* light returned under an even sky over the reference's, less 1 */
} Errors;

/* The formats of textures of cloth: what each viewer reads best, or all PNG or KTX 2. */
typedef enum TextureFormat { TEXTURES_AUTO, TEXTURES_PNG, TEXTURES_KTX2 } TextureFormat;

/* Stands for a U3M among targets, which are glTF otherwise. */
enum { TARGET_U3M = -1 };

/* The original with its cloth baked, for one target or several. */
typedef struct BakedSource {
    char name[64];        /* of what it was baked for */
    WeftBaked *materials; /* of each material of X, 0 where it is not woven; owned */
} BakedSource;

/* A file that was made for a target. */
typedef struct TargetFile {
    int target;                /* as weft_target_info counts, or TARGET_U3M */
    const BakedSource *source; /* of which it was made; NULL: of X itself, or of X without cloth */
    WeftDelivery delivery;
    Errors errors;
    long long bytes;
} TargetFile;

typedef struct Delivery {
    const Options *options;
    const char *what, *folder;
    char name[DELIVER_NAME];      /* of the files, before -TARGET */
    char temporary[DELIVER_PATH]; /* the folder in which all is made; "": none */
    bool made;                    /* the folder was made for this */
    bool loaded;                  /* what is delivered was read before, and its warnings are known */
    int from;                     /* the profile of the original, or -1 */
    const char *reference;        /* what the pictures are compared with, in words */
    WeftBrdfMetric metric;
    int pixels, width, height, spp;
    int textures; /* of cloth: of TextureFormat */
    char cameras[VIEW_COUNT][WEFT_CAMERA_TEXT];
    int materials;     /* of X */
    bool woven;        /* X has cloth, which is baked for each target by itself */
    bool all_woven;    /* nothing else: all is made for the target, and nothing is converted from another engine */
    WeftLosses losses; /* what the original has and its textures lack */
    TargetFile files[DELIVER_TARGETS];
    int count;
    BakedSource sources[DELIVER_TARGETS];
    int source_count;
    Progress progress;
    double low, high; /* the part of the work that runs */
} Delivery;

/* Sets the part of the work that runs next, and passes on its progress, as a WeftProgress whose user is a Delivery. */
void delivery_part(Delivery *delivery, double low, double high);
int delivery_heed(void *delivery, double fraction);

/* Returns what an operand is; what is nothing else is a draft, or its words. */
SourceKind source_kind(const char *what);

/* The functions below return 0, or an exit code after one line on standard error; WEFT_INTERRUPTED has no line yet. */

/* Returns the exit code of a call of the library, and reports a failure. */
int told(WeftResult result, const WeftError *error);

/* Reads what is delivered as a scene, which is what the pictures are compared with. May be called again. */
int source_load(Delivery *delivery, WeftScene **out);

/* Reads what is delivered for a file, with its cloth baked, whose errors the file then names. how: the profile, and whether
 * textures have mip levels of their own and the cloth has one face. What the textures lack is added to `losses`. */
int source_bake(Delivery *delivery, TargetFile *file, const WeftBaking *how, WeftScene **out);

/* Makes the glTF file that the file of a target is made from, and sets its path, and the profile that its numbers are
 * meant for. */
int source_write(Delivery *delivery, TargetFile *file, char path[DELIVER_PATH], int *from);

/* Returns true if textures for a target have mip levels of their own. */
bool target_levels(const Delivery *delivery, const TargetFile *file);

/* Returns what a file is for; the suffix of its name. */
WeftTarget file_target(const TargetFile *file);
const char *file_suffix(const TargetFile *file);

/* Writes the U3M of what is delivered, which has one material; and reads what is delivered with the material of that
 * file. */
int u3m_write(Delivery *delivery, TargetFile *file, const char *path);
int u3m_load(Delivery *delivery, const char *path, WeftScene **out);

/* Chooses the cameras of the pictures. */
int shots_aim(Delivery *delivery, const WeftScene *scene);

/* Takes the pictures; the environment of the scene becomes even light. Release with shots_free in any case. */
int shots_take(Delivery *delivery, WeftScene *scene, Shots *out);
void shots_free(Shots *shots);
int shots_compare(const Shots *shots, const Shots *reference, Errors *out);

/* Writes the sheet of a target: near and far, each with the reference and the difference. */
int delivery_sheet(const Delivery *delivery, const TargetFile *file, const Shots *shots, const Shots *reference,
                   const char *path);

/* Makes the folder for the files, and one in it in which they are made. */
int folder_begin(Delivery *delivery);

/* Writes the path of a file that is made: DIR/.weft-XXXXXX/NAME-TARGET.SUFFIX; target may be NULL: NAME.SUFFIX. */
void folder_path(const Delivery *delivery, const char *target, const char *suffix, char path[DELIVER_PATH]);

/* Gives the files their places, the summary last. */
int folder_commit(Delivery *delivery);

/* Removes what is left of the folder in which files are made, and DIR too if it was made and stayed empty. */
void folder_end(Delivery *delivery);

/* Writes the summary as JSON to a stream. */
void summary_write(const Delivery *delivery, FILE *stream);

/* Prints the summary for people. */
void summary_print(const Delivery *delivery);
