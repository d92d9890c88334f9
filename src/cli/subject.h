/* subject.h - something that reflects, as the command line names it
 *
 *   ashikhmin-neubelt                  a lobe, with its defaults
 *   ggx:alpha=0.2,color=1,0.8,0.3      with parameters
 *   three:sheen_color=1,sheen_roughness=0.4   an engine profile: a material with these inputs and choices
 *   metallic:base_color=0.2            a workflow, likewise
 *   preset:velvet, velvet.json         a material
 *   chair.glb:fabric                   a material of a scene
 *   cotton.binary                      a measured BRDF in MERL's format
 *
 * A kind before the name settles what two of them share: "lobe:silk", "preset:silk". Textures are left out:
 * of a material only the numbers count, and a warning says so. */
#ifndef WEFT_CLI_SUBJECT_H
#define WEFT_CLI_SUBJECT_H

#include <stdbool.h>

#include "weft/weft.h"

typedef enum SubjectKind {
    SUBJECT_LOBE,
    SUBJECT_PROFILE,
    SUBJECT_WORKFLOW,
    SUBJECT_MATERIAL,
    SUBJECT_MEASURED
} SubjectKind;

typedef struct Subject {
    SubjectKind kind;
    char name[128];  /* what it is called: an id, a material's own name, a file without folder and suffix */
    char path[1024]; /* SUBJECT_MEASURED: the file */
    bool bare;       /* a profile or workflow has its own defaults */
    bool given;      /* settings stood behind the name */
    char words[256]; /* as it was typed, cut where it is long: for labels */
    WeftLobe lobe;   /* SUBJECT_LOBE */
    WeftMaterial material;      /* SUBJECT_PROFILE, SUBJECT_WORKFLOW, SUBJECT_MATERIAL */
    WeftReflection *reflection; /* owned */
} Subject;

/* What follows the name, for help texts. */
#define SUBJECT_FORM "NAME[:KEY=VALUE,...]"

/* Reads what was typed. A profile or workflow without inputs has a grey cloth with a white sheen: base_color
 * 0.2, sheen_color 1, sheen_roughness 0.5, roughness 1. Returns 0, or an exit code after one line on standard
 * error. Release with subject_free in any case. */
int subject_read(const char *typed, Subject *out);

/* Without the reflection. */
int subject_parse(const char *typed, Subject *out);

/* The same, but a profile or workflow has its own defaults and no grey cloth. */
int subject_parse_bare(const char *typed, Subject *out);

/* Makes the reflection of what was parsed, or again after its numbers were changed. */
int subject_prepare(Subject *subject);

/* Says on standard error where it takes another number than it was given. */
void subject_warn(const Subject *subject);

/* Whether it has a material: a profile and a workflow have one too. */
bool subject_is_material(const Subject *subject);

void subject_free(Subject *subject);

#endif
