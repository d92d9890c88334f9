/* job_json.c - the report of a job: its rates, and the object that --json prints */
#include <sys/resource.h>

#include "cli/render/job.h"
#include "weft/weft.h"

static double rate(double count, double seconds) { return seconds > 0.0 ? count / seconds : 0.0; }

double job_samples_per_second(const Job *job) {
    return rate(job->info.samples_per_pixel * job_pixels(job), job->info.render_seconds);
}

double job_stage_ns(const Job *job, int stage) {
    return rate(1e9 * job->stages[stage].seconds, job->info.samples_per_pixel * job_pixels(job));
}

static long long peak_memory(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (long long)usage.ru_maxrss * 1024 : 0; /* Linux counts KiB */
}

void job_json(const Job *job, Json *json) {
    const Request *request = job->request;
    const WeftRenderInfo *info = &job->info;
    int cursor = 0;
    json_text(json, "scene", request->scene_options.scene);
    json_text(json, "engine", job->engine == ENGINE_RASTER ? "raster" : "trace");
    if (job->engine == ENGINE_RASTER) json_text(json, "driver", job->driver);
    json_whole(json, "triangles", job->triangles);
    json_whole(json, "width", job->width);
    json_whole(json, "height", job->height);
    if (request->chunk_count) {
        json_open(json, "part", '{');
        json_whole(json, "index", request->chunk_index + 1);
        json_whole(json, "of", request->chunk_count);
        json_number(json, "pixels", job->part.pixels);
        json_close(json, '}');
    }
    json_number(json, "samples_per_pixel", info->samples_per_pixel);
    json_bool(json, "interrupted", job->interrupted);
    json_open(json, "seconds", '{');
    json_number(json, "load", job->load_seconds);
    json_number(json, "build", info->build_seconds);
    json_number(json, "render", info->render_seconds);
    json_close(json, '}');
    if (job->engine == ENGINE_TRACE) {
        json_text(json, "isa", weft_isa());
        json_whole(json, "rays", info->rays);
        json_number(json, "samples_per_second", job_samples_per_second(job));
        json_number(json, "rays_per_second", rate((double)info->rays, info->render_seconds));
        if (!(job->noise < 0.0)) json_number(json, "noise", job->noise);
        if (request->denoise) json_text(json, "denoised", weft_denoiser_name((int)request->denoiser));
    }
    if (job->stage_count) json_open(json, "stages", '{');
    for (int k = 0; k < job->stage_count; k++) json_number(json, job->stages[k].name, job_stage_ns(job, k));
    if (job->stage_count) json_close(json, '}');
    json_open(json, "camera", '{');
    json_floats(json, "eye", info->camera_eye, 3);
    json_floats(json, "target", info->camera_target, 3);
    json_float(json, "fov", info->camera_fov);
    json_close(json, '}');
    if (!request->chunk_count) { /* the tone of parts is that of the picture which is merged */
        json_open(json, "tone", '{');
        json_text(json, "curve", weft_tonemap_name((int)job->tone.curve));
        json_float(json, "exposure", job->tone.exposure);
        if (job->tone.white[1] > 0.0f) json_floats(json, "white", job->tone.white, 2);
        json_close(json, '}');
    }
    json_whole(json, "peak_memory_bytes", peak_memory());
    json_open(json, "outputs", '[');
    for (const char *path; (path = option_next(request->options, "-o", &cursor));) json_text(json, NULL, path);
    json_close(json, ']');
    json_open(json, "warnings", '[');
    for (int k = 0; k < job->warnings->count; k++) json_text(json, NULL, job->warnings->lines[k]);
    json_close(json, ']');
}
