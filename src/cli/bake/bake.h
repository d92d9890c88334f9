/* bake.h - parts that baking and auditing share */
#pragma once

#include "cli/console/options.h"
#include "cli/console/progress.h"
#include "weft/weft.h"

/* Options of bake and audit. */
typedef struct BakeCommon {
    WeftTableForm form;
    bool formed; /* a form was given */
    double tolerance, scale;
    int threads;
    bool quiet;
} BakeCommon;

/* Reads the options that both take. Returns false after one line on standard error. */
bool bake_common(const Options *options, BakeCommon *common);

/* Reads the lobe `id` with every -p. Its colours must be white, and its first parameter must not be given. Returns 0,
 * or an exit code after one line. */
int bake_lobe(const Options *options, const char *id, WeftLobe *lobe);

/* Shows progress on a Progress, as a WeftProgress; stops at an interruption. */
int bake_progress(void *progress, double fraction);

/* Makes a log that writes warnings to standard error, unless --quiet is given. common must outlive it. */
WeftLog bake_log(const BakeCommon *common);

/* Runs `weft bake fibre-model`. Returns an exit code, as the next three do. */
int fibre_model_run(const Options *options);

/* Runs `weft bake bsdf MODEL`. */
int bake_bsdf_run(const Options *options);

/* Runs `weft bake lobe DATA`. */
int bake_lobe_run(const Options *options);

/* Runs `weft bake albedo LOBE --form FORM`. */
int bake_form_run(const Options *options);

/* Runs `weft bake audit FILE`. */
int audit_run(const Options *options);
