/* model.h - a reflection model, as the command line names it
 *
 *   ashikhmin-neubelt                  a lobe, with its defaults
 *   ggx:alpha=0.2,color=1,0.8,0.3      with parameters
 *   three:sheen_color=1,sheen_roughness=0.4   an engine profile: a material with these inputs and choices
 *   metallic:base_color=0.2            a workflow, likewise
 *   preset:velvet, velvet.json         a material
 *   cloth.wif, "twill 2/2 z; both 4k 4w"      a draft, woven of cotton
 *   chair.glb:fabric                   a material of a scene
 *   cotton.binary, felt.bsdf, m1.bin   a measured BRDF in MERL's, RGL's or UTIA's format
 *
 * A kind before the name resolves a name that two kinds share: "lobe:silk", "preset:silk". Textures are left out with
 * a warning: only the numbers of a material count. A weave counts if model_read made its reflection, and for
 * model_parse_bare. */
#pragma once

#include <stdbool.h>

#include "weft/weft.h"

typedef enum ModelKind { MODEL_LOBE, MODEL_PROFILE, MODEL_WORKFLOW, MODEL_MATERIAL, MODEL_MEASURED } ModelKind;

typedef struct Model {
    ModelKind kind;
    char name[128];             /* an id, a material's own name, or a file's name without folder and suffix */
    char path[1024];            /* MODEL_MEASURED: the file */
    bool bare;                  /* a profile or workflow has its own defaults */
    bool given;                 /* settings followed the name */
    char words[256];            /* as typed, cut off where it is long; for labels */
    WeftLobe lobe;              /* MODEL_LOBE */
    WeftMaterial material;      /* MODEL_PROFILE, MODEL_WORKFLOW, MODEL_MATERIAL */
    bool weaves;                /* a weave is kept */
    WeftCloth *cloth;           /* MODEL_MATERIAL: its cloth, owned; NULL: not woven, or left out */
    WeftReflection *reflection; /* owned */
} Model;

/* The form of a model on the command line, for help texts. */
#define MODEL_FORM "NAME[:KEY=VALUE,...]"

/* Reads what was typed. A profile or workflow without inputs has a grey cloth with a white sheen: base_color
 * 0.2, sheen_color 1, sheen_roughness 0.5, roughness 1. Returns 0, or an exit code after one line on standard
 * error. Release with model_free in any case. */
int model_read(const char *typed, Model *out);

/* Works as model_read, but makes no reflection and leaves out a weave. */
int model_parse(const char *typed, Model *out);

/* Works as model_parse, but keeps a weave, and a profile or workflow has its own defaults and no grey cloth. */
int model_parse_bare(const char *typed, Model *out);

/* Makes the reflection of the parsed model; call it again after a change of its numbers. */
int model_prepare(Model *model);

/* Warns on standard error if the reflection replaces a number by the nearest valid one. */
void model_warn(const Model *model);

/* Returns true if the model has a material, as profiles and workflows do. */
bool model_is_material(const Model *model);

void model_free(Model *model);
