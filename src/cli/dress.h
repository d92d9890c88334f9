/* dress.h - what the materials of a scene are to be: the options that say so, in their order
 *
 * An option that takes several ids, comma between, makes several pictures: one option may. */
#ifndef WEFT_CLI_DRESS_H
#define WEFT_CLI_DRESS_H

#include "options.h"
#include "weft/scene.h"

enum { DRESS_LABEL = 96, DRESS_VARIANTS_MOST = 32 };

typedef struct Dress {
    const Options *options;
    const char *varied; /* the option with several ids, NULL: none */
    int count;          /* pictures, at least 1 */
} Dress;

/* The rows of the option table. */
#define DRESS_OPTIONS                                                                                        \
    OPTION_HEADING("Materials, later ones win"),                                                             \
        OPTION_TEXT("--variant", "NAME", NULL, "switch to a material variant of the file"),                  \
        OPTION_LIST("--preset", "[MAT=]NAME", "dress the cloth of the scene, or material MAT, in a preset"), \
        OPTION_LIST("--material", "[MAT=]FILE",                                                              \
                    "the same in a material file: a small JSON, see docs/materials.md"),                     \
        OPTION_LIST("--materials", "[MAT=]DIR",                                                              \
                    "put on it the maps of a folder by their names, as albedo.png or chair_Roughness.tga"),  \
        OPTION_TEXT("--workflow", "NAME,...", NULL, "what the inputs of all materials mean"),                \
        OPTION_TEXT("--profile", "NAME,...", NULL,                                                           \
                    "draw all materials as an engine does; none is weft's own way"),                         \
        OPTION_TEXT("--diffuse", "LOBE,...", NULL, "the diffuse term of every base"),                        \
        OPTION_TEXT("--sheen", "LOBE,...", NULL, "the lobe of every sheen"),                                 \
        OPTION_TEXT(                                                                                         \
            "--layer", "RULE,...", NULL,                                                                     \
            "how every sheen sits on its base; RULE,by=channel or RULE,by=max says by which colour"),        \
        OPTION_LIST("--texture", "MAT.INPUT=FILE",                                                           \
                    "put a picture on an input of material MAT; MAT.INPUT.g=FILE takes its green channel"),  \
        OPTION_LIST(                                                                                         \
            "--set", "MAT.INPUT=VALUE",                                                                      \
            "set an input of material MAT (name, index or *) to a number or r,g,b, or a choice to an "       \
            "id"),                                                                                           \
        OPTION_TEXT("--convert", "WORKFLOW", NULL,                                                           \
                    "turn all materials from metallic to specular, or the other way, and say what is lost")

/* Checks every id of these options. False after one line on standard error. */
bool dress_read(const Options *options, Dress *dress);

/* The id that makes picture number k another one than the rest, "" where there is but one. */
void dress_label(const Dress *dress, int k, char label[DRESS_LABEL]);

/* The choice that is varied: "profile"; NULL where there is but one picture. */
const char *dress_varied(const Dress *dress);

/* Does to a fresh scene what the options say of picture number k. log also hears what a conversion loses. */
WeftResult dress_apply(const Dress *dress, int k, WeftScene *scene, const WeftLog *log, WeftError *error);

#endif
