/* job.h - one picture: its scene, which is loaded, assigned materials and lights, and drawn by an engine; its report */
#pragma once

#include "cli/console/json_writer.h"
#include "cli/console/report.h"
#include "cli/render/request.h"

enum { JOB_STAGES = 32, PART_LAYERS = WEFT_IMAGE_LAYERS - 1, PART_NAME = 32, PART_WORDS = 2048 };

/* The record that a part of a picture keeps beside its rows, and that of a picture that was merged. */
typedef struct PicturePart {
    char words[PART_WORDS]; /* of the picture that it belongs to, picture_words.h */
    double pixels;          /* of a part; 0: the whole picture */
    struct TileSums *sums;  /* of a part, owned; NULL: none */
    char isa[16];           /* the instruction set of a picture that was merged; empty: that in use */
    int spp, left;          /* of a picture that was merged: its samples a pixel, and parts with fewer that were left */
    int layer_count;
    WeftImage layers[PART_LAYERS]; /* AOVs of a picture that was merged, owned */
    char names[PART_LAYERS][4][PART_NAME];
} PicturePart;

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
    PicturePart part; /* of a picture in parts */
} Job;

/* Loads the scene and applies materials and lights. */
WeftResult job_open(Job *job, WeftError *error);

/* Makes the picture as displayed from the linear one, of the options of the request. */
WeftResult job_finish(Job *job, WeftError *error);

/* Writes the picture; number as for request_outputs_write. */
WeftResult job_write(const Job *job, const char *number, WeftError *error);

/* Returns the camera to use where `camera` (NULL: the request's) is asked for: a built-in scene has one that shows it
 * best. */
const char *job_camera(const Job *job, const char *camera);

/* Makes the picture through a camera, NULL: the request's. Needs job_open. An interruption is noted; only one
 * before the first sample is a failure. */
WeftResult job_draw(Job *job, const char *camera, WeftError *error);

/* Runs job_open and job_draw. */
WeftResult job_run(Job *job, WeftError *error);

/* Releases the scene, and keeps the picture and its report. */
void job_close(Job *job);
void job_free(Job *job);

/* Returns the number of pixels of the picture, or of the part of it that this job renders. */
double job_pixels(const Job *job);

double job_samples_per_second(const Job *job);

/* Returns the time of a stage for each sample, ns. */
double job_stage_ns(const Job *job, int stage);

/* Writes the members of the picture's JSON object. */
void job_json(const Job *job, Json *json);
