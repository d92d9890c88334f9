/* each_asset.h - a verb over several assets: one after another, each with files of its own */
#pragma once

#include <limits.h>

#include "cli/console/options.h"

enum { EACH_MOST = INT_MAX };

/* An option that names what is written for an asset. Its value may be a folder, in which each asset has a file of its
 * name, or have "{}" in it, which stands for that name; with one asset it may be any file. */
typedef struct EachOutput {
    const char *option;
    const char *suffix; /* of a file in a folder; NULL: the asset's own, .glb for one that has no file */
} EachOutput;

/* Runs the verb for each operand as for that alone, whatever became of those before; an interruption ends it. outputs
 * ends with a NULL. Returns the gravest exit code. Without operands the verb runs once. */
int each_run(const Options *options, const EachOutput *outputs, int (*run)(const Options *options));
