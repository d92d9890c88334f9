/* job.h - one picture: its scene, which is loaded, assigned materials and lights, and drawn by an engine; its report */
#pragma once

#include "cli/console/json_writer.h"
#include "cli/console/report.h"
#include "cli/render/request.h"

enum { JOB_STAGES = 32 };

typedef struct Job {
    const Request *request;
    Warnings *warnings;
    int number;                         /* of the picture within the request */
    Engine engine;                      /* TRACE or RASTER */
    WeftScene *scene;                   /* owned, see job_free */
    WeftRaster *raster;                 /* owned; NULL of the path tracer */
    WeftImage linear;                   /* owned, see job_free */
    WeftImage display;                  /* owned */
    WeftTone tone;                      /* of it */
    bool metered;                       /* tone has what --exposure auto and --white-balance auto found */
    WeftRenderLayers layers;            /* owned: the AOVs that were asked for */
    double noise;                       /* relMSE, estimated; below 0: unknown */
    WeftRenderStage stages[JOB_STAGES]; /* of --stages */
    int stage_count;
    WeftRenderInfo info; /* samples, seconds and camera, of either engine */
    char driver[128];    /* of OpenGL */
    long long triangles;
    double load_seconds;
    int width, height; /* of the picture after cropping */
    bool interrupted;
} Job;

/* Loads the scene and applies materials and lights. */
WeftResult job_open(Job *job, WeftError *error);

/* Writes the picture; number as for request_outputs_write. */
WeftResult job_write(const Job *job, const char *number, WeftError *error);

/* Makes the picture through a camera, NULL: the request's. Needs job_open. An interruption is noted; only one
 * before the first sample is a failure. */
WeftResult job_draw(Job *job, const char *camera, WeftError *error);

/* Runs job_open and job_draw. */
WeftResult job_run(Job *job, WeftError *error);

/* Releases the scene, and keeps the picture and its report. */
void job_close(Job *job);
void job_free(Job *job);

double job_samples_per_second(const Job *job);

/* Returns the time of a stage for each sample, ns. */
double job_stage_ns(const Job *job, int stage);

/* Writes the members of the picture's JSON object. */
void job_json(const Job *job, Json *json);
