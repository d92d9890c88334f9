/* subject.h - something that reflects, as the command line names it
 *
 *   ashikhmin-neubelt                  a lobe, with its defaults
 *   ggx:alpha=0.2,color=1,0.8,0.3      with parameters
 *   three:sheen_color=1,sheen_roughness=0.4   an engine profile: a material with these inputs and choices
 *   preset:velvet, velvet.json         a material
 *   chair.glb:fabric                   a material of a scene
 *   cotton.binary                      a measured BRDF in MERL's format
 *
 * A kind before the name settles what two of them share: "lobe:silk", "preset:silk". */
#ifndef WEFT_CLI_SUBJECT_H
#define WEFT_CLI_SUBJECT_H

#include "weft/weft.h"

typedef enum SubjectKind { SUBJECT_LOBE, SUBJECT_PROFILE, SUBJECT_MATERIAL, SUBJECT_MEASURED } SubjectKind;

typedef struct Subject {
    SubjectKind kind;
    char name[128];             /* the lobe, profile, preset or file, without what was set */
    char words[256];            /* as it was typed, cut where it is long: for labels */
    WeftLobe lobe;              /* SUBJECT_LOBE */
    WeftMaterial material;      /* SUBJECT_PROFILE, SUBJECT_MATERIAL */
    WeftReflection *reflection; /* owned */
} Subject;

/* What follows the name, for help texts. */
#define SUBJECT_FORM "NAME[:KEY=VALUE,...]"

/* Reads what was typed. A profile without inputs has a grey cloth with a white sheen: base_color 0.2,
 * sheen_color 1, sheen_roughness 0.5, roughness 1. Returns 0, or an exit code after one line on standard
 * error. Release with subject_free in any case. */
int subject_read(const char *typed, Subject *out);

/* Without the reflection. */
int subject_parse(const char *typed, Subject *out);

/* Makes the reflection of what was parsed, or again after its numbers were changed. */
int subject_prepare(Subject *subject);

void subject_free(Subject *subject);

#endif
