/* save.h - option --save: a scene as glTF, or one material as JSON, MaterialX or U3M */
#pragma once

#include "cli/console/options.h"
#include "weft/scene.h"

/* Tests that every --save names a supported kind of file and a place that can be written. Returns 0, or an exit
 * code after one line. */
int save_check(const Options *options);

/* Returns the index of the first cloth material, as --material chooses it: the first with a sheen or, if none has one,
 * the first that does not emit light. */
int save_cloth_of(const WeftScene *scene);

/* Writes every --save. */
WeftResult save_all(const Options *options, const WeftScene *scene, WeftError *error);
