/* gather.h - the samples of a picture or a part of it: with those of earlier runs, with progress and checkpoints
 *
 * A checkpoint is an .exr of the sums so far (sums_file.h) whose comment says of what picture they are, and that shows
 * the picture so far. It replaces the one before complete or not at all. A render that goes on from it has the bytes of
 * one that was never stopped. */
#pragma once

#include "cli/console/progress.h"
#include "cli/render/job.h"

/* The gathering of samples. */
typedef struct Gather {
    Job *job;
    WeftRender *render;
    WeftRenderDesc desc;         /* of the render, with a crop */
    const unsigned char *wanted; /* the tiles of a part, borrowed; NULL: all, in passes over the whole picture */
    Progress progress;
    double base;    /* progress before the present run */
    double next;    /* time of the next checkpoint, of clock_now(); INFINITY: none */
    bool due;       /* the present run was stopped for a checkpoint */
    long long rays; /* of other processes */
} Gather;

/* Adds samples until there are as many as requested, or an interruption, which is noted in the job. What an interrupted
 * one has is in the checkpoint, if there is one. */
WeftResult gather_samples(Gather *gather, WeftError *error);

/* Writes the checkpoint, and sets the time of the next. */
WeftResult gather_checkpoint(Gather *gather, WeftError *error);

/* Removes the checkpoint of a request, after its picture was written. */
void gather_forget(const Request *request);
