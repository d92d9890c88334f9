/* bake.h - parts that baking and auditing share */
#ifndef WEFT_CLI_BAKE_H
#define WEFT_CLI_BAKE_H

#include "cli/console/options.h"
#include "cli/console/progress.h"
#include "weft/weft.h"

/* The options that both take. */
typedef struct BakeCommon {
    WeftTableForm form;
    bool formed; /* a form was given */
    double tolerance, scale;
    int threads;
    bool quiet;
} BakeCommon;

/* False after one line on standard error. */
bool bake_common(const Options *options, BakeCommon *common);

/* The lobe `id` with every -p; it must be white and its first parameter left alone. Returns 0, or an exit
 * code after one line. */
int bake_lobe(const Options *options, const char *id, WeftLobe *lobe);

/* A WeftProgress whose user is a Progress; it stops at an interruption. */
int bake_progress(void *progress, double fraction);

/* Warnings go to standard error, unless --quiet is given. common must outlive the log. */
WeftLog bake_log(const BakeCommon *common);

/* weft bake fibre-model */
int fibre_model_run(const Options *options);

/* weft bake bsdf MODEL */
int bake_bsdf_run(const Options *options);

/* weft bake lobe DATA */
int bake_lobe_run(const Options *options);

/* weft bake audit FILE */
int audit_run(const Options *options);

#endif
