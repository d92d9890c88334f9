/* assign_options.h - the options that assign materials, in their order
 *
 * An option with several values makes several pictures; two such options make a row for each value of the
 * first and a column for each of the second. */
#pragma once

#include "cli/operands/lobes.h"
#include "weft/scene.h"

enum { ASSIGN_LABEL = 96, ASSIGN_VARIANTS_MOST = 64, ASSIGN_VARIED_MOST = 2 };

/* An option with several values. */
typedef struct Varied {
    const char *option;      /* "--profile" or "--set" */
    char name[ASSIGN_LABEL]; /* of what varies: "profile", "*.subsurface" */
    const char *values;      /* the list as it was typed */
    char separator;          /* between the values: ',' or ';' */
    int count;
} Varied;

typedef struct Assignments {
    const Options *options;
    Varied varied[ASSIGN_VARIED_MOST]; /* the last one changes from picture to picture */
    int varied_count;
    int count; /* pictures, at least 1 */
} Assignments;

/* The rows of the option table. */
#define ASSIGN_OPTIONS                                                                                                 \
    OPTION_HEADING("Materials, later ones win"), OPTION_LOBES,                                                         \
        OPTION_TEXT("--variant", "NAME", NULL, "switch to a material variant of the file"),                            \
        OPTION_LIST("--preset", "[MAT=]NAME", "assign a preset to the cloth of the scene, or to material MAT"),        \
        OPTION_LIST("--material", "[MAT=]FILE", "the same in a material file: a small JSON, see docs/materials.md"),   \
        OPTION_LIST("--materials", "[MAT=]DIR",                                                                        \
                    "put on it the maps of a folder by their names, as albedo.png or chair_Roughness.tga"),            \
        OPTION_LIST("--weave", "[MAT=]DRAFT",                                                                          \
                    "weave it of a draft: a .wif, a picture, or words such as \"twill 2/2; warp 1#26375c\"; of what "  \
                    "yarns and size, --set MAT.weave.KEY says, see docs/weave.md"),                                    \
        OPTION_TEXT("--workflow", "NAME,...", NULL, "what the inputs of all materials mean"),                          \
        OPTION_TEXT("--profile", "NAME,...", NULL, "draw all materials as an engine does; none is weft's own way"),    \
        OPTION_TEXT("--diffuse", "LOBE,...", NULL, "the diffuse term of every base"),                                  \
        OPTION_TEXT("--sheen", "LOBE,...", NULL, "the lobe of every sheen"),                                           \
        OPTION_TEXT("--layer", "RULE,...", NULL,                                                                       \
                    "how every sheen sits on its base; RULE,by=channel or RULE,by=max says by which colour"),          \
        OPTION_LIST("--texture", "MAT.INPUT=FILE",                                                                     \
                    "put a picture on an input of material MAT; MAT.INPUT.g=FILE takes its green channel"),            \
        OPTION_LIST("--set", "MAT.INPUT=VALUE",                                                                        \
                    "set an input of material MAT (name, index or *) to a number or r,g,b, or a choice to an id; "     \
                    "several make a sheet: numbers and ids with , between, colours with ;"),                           \
        OPTION_TEXT("--convert", "WORKFLOW", NULL,                                                                     \
                    "turn all materials from metallic to specular, or the other way, and say what is lost")

/* Checks every id of these options. False after one line on standard error. */
bool assign_read(const Options *options, Assignments *assignment);

/* Copies the value that picture number k has of varied number v. */
void assign_value(const Assignments *assignment, int v, int k, char value[ASSIGN_LABEL]);

/* Labels picture number k by what sets it apart from the rest, "" where there is but one. */
void assign_label(const Assignments *assignment, int k, char label[ASSIGN_LABEL]);

/* Applies the options of picture number k to a fresh scene. log also receives what a conversion loses. */
WeftResult assign_apply(const Assignments *assignment, int k, WeftScene *scene, const WeftLog *log, WeftError *error);
