#include "cli/render/job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "base/steady_clock.h"
#include "cli/console/interrupt.h"
#include "cli/console/progress.h"
#include "cli/files/save.h"
#include "cli/render/crew.h"
#include "cli/render/picture_gather.h"
#include "cli/render/picture_merge.h"
#include "cli/render/picture_part.h"
#include "weft/weft.h"

/* Loads the scene, and assigns its materials and lights. */
static WeftResult scene_open(Job *job, WeftScene **scene, WeftError *error) {
    const Request *request = job->request;
    int picture = request->engine == ENGINE_BOTH ? 0 : job->number;
    const WeftLog log = {.fn = warnings_log, .user = job->warnings};
    WeftResult result = weft_scene_load_moment(request->scene_options.scene,
                                               request->scene_options.moves ? &request->scene_options.moment : NULL,
                                               NULL, NULL, scene, &log, error);
    if (result == WEFT_OK) result = scene_options_apply(&request->scene_options, picture, *scene, &log, error);
    return result;
}

double job_pixels(const Job *job) {
    return job->part.pixels > 0.0 ? job->part.pixels : (double)job->width * job->height;
}

static WeftResult nothing_gathered(WeftError *error) {
    return failure(error, WEFT_INTERRUPTED, "interrupted before the first sample; nothing was written");
}

/* Gathers the samples, and the figures of the render. */
static WeftResult gather(Job *job, WeftRender *render, const WeftRenderDesc *desc, WeftError *error) {
    Gather all = {.job = job, .render = render, .desc = *desc};
    const double start = clock_now();
    WeftResult result = gather_samples(&all, error);
    job->info = weft_render_info(render);
    job->info.rays += all.rays;
    if (crew_place()) job->info.render_seconds = clock_now() - start;
    job->stage_count = 0;
    while (job->request->desc.stages && job->stage_count < JOB_STAGES &&
           weft_render_stage(render, job->stage_count, &job->stages[job->stage_count]))
        job->stage_count++;
    return job->interrupted && !crew_follows() && !(job->info.samples_per_pixel > 0.0) ? nothing_gathered(error)
                                                                                       : result;
}

const char *job_camera(const Job *job, const char *camera) {
    if (!camera) camera = job->request->desc.camera;
    bool builtin = path_is_on_builtin(job->request->scene_options.scene);
    return !camera && builtin && weft_scene_info(job->scene).camera_count > 0 ? "0" : camera;
}

/* Returns the floor to draw; a sheet has none of its own accord, since its pictures are compared pixel by pixel. */
static WeftFloor floor_of(const Job *job) {
    const SceneOptions *scene_options = &job->request->scene_options;
    return request_count(job->request) > 1 ? scene_options->floor : scene_options_floor(scene_options, job->scene);
}

/* Takes the requested images from the render. */
static WeftResult develop(Job *job, const WeftRender *render, WeftError *error) {
    const Request *request = job->request;
    WeftResult result = request->denoise ? weft_render_denoised(render, request->denoiser, &job->linear, error)
                                         : weft_render_image(render, &job->linear, error);
    if (result == WEFT_OK && request->aovs) result = weft_render_layers(render, request->aovs, &job->layers, error);
    job->noise = weft_render_noise(render);
    return result;
}

static WeftResult trace(Job *job, const char *camera, WeftError *error) {
    WeftRenderDesc desc = job->request->desc;
    WeftRender *render = NULL;
    desc.camera = camera;
    desc.floor = floor_of(job);
    if (interrupt_seen()) return nothing_gathered(error);
    if (!desc.crop[2]) desc.crop[2] = job->width, desc.crop[3] = job->height;
    WeftResult result = weft_render_create(job->scene, &desc, &render, error);
    if (result == WEFT_OK && interrupt_seen()) result = nothing_gathered(error);
    if (result == WEFT_OK && job->request->chunk_count) {
        result = picture_part_trace(job, render, &desc, error);
    } else {
        if (result == WEFT_OK) result = gather(job, render, &desc, error);
        if (result == WEFT_OK && !crew_follows()) result = develop(job, render, error);
    }
    weft_render_free(render);
    if (result == WEFT_OK && job->info.non_finite > 0) {
        char text[96];
        snprintf(text, sizeof text, "%lld samples were not finite and were left out", job->info.non_finite);
        warnings_add(job->warnings, true, text);
    }
    return result;
}

static WeftResult crop(const Job *job, WeftImage *image, WeftError *error) {
    const int *c = job->request->desc.crop;
    WeftImage part;
    if (!c[2]) return WEFT_OK;
    WeftResult result = weft_image_create(c[2], c[3], 4, WEFT_PIXEL_F32, &part, error);
    if (result != WEFT_OK) return result;
    for (int y = 0; y < c[3]; y++)
        memcpy((float *)part.pixels + 4 * (size_t)y * (size_t)c[2],
               (const float *)image->pixels + 4 * ((size_t)(c[1] + y) * (size_t)image->width + (size_t)c[0]),
               4 * (size_t)c[2] * sizeof(float));
    weft_image_free(image);
    *image = part;
    return WEFT_OK;
}

/* Draws a small picture, so that the driver compiles the shaders while occlusion is still being computed. If that
 * fails, the full picture fails too and reports the reason. */
static void compile_early(WeftRaster *raster, WeftRasterView view) {
    enum { SMALLER = 32 };
    if (!weft_raster_info(raster).making) return;
    view.width = view.width > SMALLER ? view.width / SMALLER : 1;
    view.height = view.height > SMALLER ? view.height / SMALLER : 1;
    memset(view.crop, 0, sizeof view.crop);
    weft_raster_draw(raster, &view, NULL);
}

/* Draws frames of a sum until all are drawn or an interruption ends it. */
static WeftResult accumulate(Job *job, const WeftRasterView *view, int *done, WeftError *error) {
    const double piece = 0.25;
    const int frames = job->request->accumulate;
    const Request *request = job->request;
    Progress progress = progress_start(request->quiet, "", frames, frames, job_pixels(job), 0.0);
    WeftResult result = weft_raster_accumulate_begin(job->raster, view, frames, error);
    while (result == WEFT_OK && *done < frames && !job->interrupted) {
        result = weft_raster_accumulate(job->raster, piece, done, error);
        job->interrupted = progress_heed(&progress, (double)*done / frames) != 0;
    }
    progress_finish(&progress);
    return result == WEFT_OK && !*done ? nothing_gathered(error) : result;
}

static WeftResult raster(Job *job, const char *camera, WeftError *error) {
    const WeftRenderDesc *desc = &job->request->desc;
    const WeftLog log = {.fn = warnings_log, .user = job->warnings};
    WeftRasterView view = {.width = desc->width,
                           .height = desc->height,
                           .samples = job->request->msaa,
                           .ambient = job->request->ambient,
                           .polygons = job->request->polygons ? job->request->polygons : -1,
                           .camera = camera,
                           .part = job->request->part,
                           .floor = floor_of(job),
                           .hide_lights = desc->hide_lights,
                           .bounces = job->request->bounces,
                           .background = desc->background};
    memcpy(view.crop, desc->crop, sizeof view.crop);
    WeftResult result = WEFT_OK;
    if (!job->raster) result = weft_raster_create(job->scene, &job->request->raster, &job->raster, &log, error);
    double started = clock_now();
    int frames = 0;
    if (job->request->accumulate) {
        if (result == WEFT_OK) result = accumulate(job, &view, &frames, error);
    } else {
        if (result == WEFT_OK) compile_early(job->raster, view);
        if (result == WEFT_OK) result = weft_raster_wait(job->raster, error);
        if (result == WEFT_OK) result = weft_raster_draw(job->raster, &view, error);
    }
    if (result == WEFT_OK) result = weft_raster_image(job->raster, &job->linear, error);
    if (result != WEFT_OK) return result;
    const WeftRasterInfo drawn = weft_raster_info(job->raster);
    job->info = (WeftRenderInfo){.samples_per_pixel = frames ? frames : drawn.samples,
                                 .render_seconds = clock_now() - started,
                                 .camera_fov = drawn.camera_fov};
    memcpy(job->info.camera_eye, drawn.camera_eye, sizeof job->info.camera_eye);
    memcpy(job->info.camera_target, drawn.camera_target, sizeof job->info.camera_target);
    snprintf(job->driver, sizeof job->driver, "%s", drawn.driver);
    if (*drawn.complaint) warnings_add(job->warnings, true, drawn.complaint);
    return crop(job, &job->linear, error);
}

WeftResult job_open(Job *job, WeftError *error) {
    const WeftRenderDesc *desc = &job->request->desc;
    double started = clock_now();
    job->width = desc->crop[2] ? desc->crop[2] : desc->width;
    job->height = desc->crop[3] ? desc->crop[3] : desc->height;
    WeftResult result = scene_open(job, &job->scene, error);
    job->load_seconds = clock_now() - started;
    if (result == WEFT_OK) job->triangles = weft_scene_info(job->scene).triangle_count;
    if (result == WEFT_OK && job->number == 0 && !crew_follows())
        result = save_all(job->request->options, job->scene, error);
    return result;
}

/* Puts a colour behind a linear picture. */
static void lay_behind(WeftImage *linear, const float color[3]) {
    float *p = linear->pixels;
    for (size_t k = 0; k < (size_t)linear->width * (size_t)linear->height; k++, p += 4) {
        for (int c = 0; c < 3; c++) p[c] = p[c] * p[3] + color[c] * (1.0f - p[3]);
        p[3] = 1.0f;
    }
}

/* Decides how the picture is shown; those of a turntable are shown as the first of them. */
static void meter(Job *job) {
    const SceneOptions *scene_options = &job->request->scene_options;
    if (job->metered) return;
    job->tone = scene_options->tone;
    if (scene_options->meter_exposure) job->tone.exposure = weft_image_meter(&job->linear);
    if (scene_options->find_white) weft_image_find_white(&job->linear, job->tone.white);
    job->metered = true;
}

/* Makes the picture as displayed; a colour is laid behind what is displayed, where neither curve nor exposure
 * changes it, and behind what is linear. */
WeftResult job_finish(Job *job, WeftError *error) {
    const SceneOptions *scene_options = &job->request->scene_options;
    bool color = scene_options->background == WEFT_BACKGROUND_COLOR && job->request->part == WEFT_PART_ALL;
    meter(job);
    WeftResult result =
        weft_image_show(&job->linear, &job->tone, color ? scene_options->background_color : NULL, &job->display, error);
    if (color) lay_behind(&job->linear, scene_options->background_color);
    return result;
}

static void free_images(Job *job) {
    weft_image_free(&job->linear);
    weft_image_free(&job->display);
    weft_render_layers_free(&job->layers);
    picture_part_free(&job->part);
}

WeftResult job_draw(Job *job, const char *camera, WeftError *error) {
    free_images(job);
    job->noise = -1.0;
    camera = job_camera(job, camera);
    WeftResult result = job->engine == ENGINE_RASTER ? raster(job, camera, error) : trace(job, camera, error);
    return result == WEFT_OK && !job->request->chunk_count && !crew_follows() ? job_finish(job, error) : result;
}

WeftResult job_run(Job *job, WeftError *error) {
    WeftResult result = job_open(job, error);
    return result == WEFT_OK ? job_draw(job, NULL, error) : result;
}

void job_close(Job *job) {
    weft_raster_free(job->raster);
    weft_scene_free(job->scene);
    job->raster = NULL;
    job->scene = NULL;
}

void job_free(Job *job) {
    job_close(job);
    free_images(job);
}

WeftResult job_write(const Job *job, const char *number, WeftError *error) {
    const Request *request = job->request;
    WeftImageLayer merged[WEFT_IMAGE_LAYERS];
    if (request->chunk_count) return picture_part_write(job, error);
    const int count = picture_merged_layers(&job->part, merged);
    const Outputs outputs = {&job->linear,
                             &job->display,
                             {.denoised = request->denoise ? weft_denoiser_name((int)request->denoiser) : NULL,
                              .isa = *job->part.isa                ? job->part.isa
                                     : job->engine == ENGINE_TRACE ? weft_isa()
                                                                   : NULL,
                              .layers = count ? merged : job->layers.layers,
                              .layer_count = count ? count : job->layers.layer_count,
                              .texts = job->layers.texts,
                              .text_count = job->layers.text_count}};
    return request_outputs_write(request, number, &outputs, error);
}
