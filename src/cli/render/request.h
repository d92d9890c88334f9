/* request.h - the command line of `weft render`, checked */
#pragma once

#include "cli/render/scene_options.h"
#include "weft/raster.h"

enum { CHUNKS_MOST = 4096 }; /* parts of a picture */

enum { REQUEST_SPP_MOST = 1 << 24 }; /* in effect "until the time is up" */

extern const Option request_options[];

typedef enum Engine { ENGINE_TRACE, ENGINE_RASTER, ENGINE_BOTH } Engine;

/* The request of the command line, checked. */
typedef struct Request {
    const Options *options;
    SceneOptions scene_options;
    WeftRenderDesc desc;
    int spp; /* 0: until the time is up */
    double time_limit;
    unsigned aovs; /* 1 << WEFT_AOV_ALBEDO and so on */
    bool denoise;
    WeftDenoiser denoiser;
    bool quiet;
    Engine engine;
    WeftRasterDesc raster;
    int msaa, polygons;
    int accumulate; /* frames of a sum; 0: one picture */
    int bounces;    /* of light in them */
    WeftAmbient ambient;
    WeftPart part;
    int turntable;                /* pictures around the scene; 0: one */
    int chunk_index, chunk_count; /* part of the picture, counted from 0, and parts; count 0: the whole picture */
    int frame_index, frame_count; /* of a turntable: every frame_count-th picture from frame_index on; count 0: all */
    const char *checkpoint;       /* file; NULL: none */
    double checkpoint_every;      /* s */
} Request;

/* Returns the number of images side by side. */
int request_count(const Request *request);

/* Reads and checks all that can be judged without the scene. False after one line on standard error. */
bool request_read(const Options *options, Request *request);

/* Makes the request that of part `index` of `count`, from 0 on. False after one line on standard error where the picture
 * cannot be cut so. */
bool request_cut(Request *request, int index, int count);

/* Tests before a long render that every -o names a supported format and a place that can be written, by creating
 * a file there. Returns 0, or an exit code after one line. */
int request_outputs_check(const Request *request);

/* The picture for every -o, linear or as displayed, and its metadata. */
typedef struct Outputs {
    const WeftImage *linear, *display;
    WeftImageWriting how;
} Outputs;

/* Writes every -o; one that fails does not keep the others from being written. number (may be NULL) comes
 * before every suffix. */
WeftResult request_outputs_write(const Request *request, const char *number, const Outputs *outputs, WeftError *error);

enum { REQUEST_FILES = 512 };

/* Writes the names of the -o files, separated by commas, to a buffer of the caller's. */
const char *request_outputs_text(const Request *request, char files[REQUEST_FILES]);
