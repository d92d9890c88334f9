/* render.c - `weft render`: a scene becomes pictures */
#include "cli/console/interrupt.h"
#include "cli/console/report.h"
#include "cli/operands/each_asset.h"
#include "cli/render/compare.h"
#include "cli/render/crew.h"
#include "cli/render/picture_gather.h"
#include "cli/render/turntable.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

/* Prints what was metered, as options that show the same. */
static void print_metered(const Job *job) {
    const SceneOptions *scene_options = &job->request->scene_options;
    if (scene_options->meter_exposure) report(0, "metered: --exposure %.9g", (double)job->tone.exposure);
    if (scene_options->find_white && !(job->tone.white[1] > 0.0f))
        report(0, "no light to balance");
    else if (scene_options->find_white)
        report(0, "white is x %.4f, y %.4f", (double)job->tone.white[0], (double)job->tone.white[1]);
}

static void summary(const Job *job) {
    char files[REQUEST_FILES];
    request_outputs_text(job->request, files);
    print_metered(job);
    if (job->engine == ENGINE_RASTER) {
        report(0, "drawn in %.2f s by %s; wrote %s", job->info.render_seconds, job->driver, files);
        return;
    }
    char noise[48] = "";
    if (!(job->noise < 0.0)) snprintf(noise, sizeof noise, ", relMSE about %.3g", job->noise);
    report(0, "%s%.4g samples/pixel in %.2f s, %.2f M samples/s%s%s; wrote %s",
           job->interrupted ? "interrupted at " : "", job->info.samples_per_pixel, job->info.render_seconds,
           1e-6 * job_samples_per_second(job), noise, job->request->denoise ? " before denoising" : "", files);
}

static void print_stages(const Job *job) {
    double sum = 0.0, embree = 0.0;
    for (int k = 0; k < job->stage_count; k++) {
        double ns = job_stage_ns(job, k);
        sum += ns;
        if (job->stages[k].embree) embree += ns;
    }
    if (!(sum > 0.0)) return;
    puts("stage                          ns a sample   share");
    for (int k = 0; k < job->stage_count; k++)
        printf("%-30s %11.1f %6.1f %%%s\n", job->stages[k].name, job_stage_ns(job, k),
               100.0 * job_stage_ns(job, k) / sum, job->stages[k].embree ? "  Embree" : "");
    printf("%-30s %11.1f %6.1f %%  Embree\n", "all", sum, 100.0 * embree / sum);
}

/* Writes only the files of --save, without a picture. */
static int save_run(const Request *request, Warnings *warnings) {
    Job job = {.request = request, .warnings = warnings, .engine = request->engine};
    WeftError error = {0};
    WeftResult result = job_open(&job, &error);
    if (result != WEFT_OK) report_error(&error);
    job_free(&job);
    return (int)result;
}

static int single_run(const Request *request, Warnings *warnings) {
    Job job = {.request = request, .warnings = warnings, .engine = request->engine};
    WeftError error = {0};
    WeftResult result = request->turntable ? turntable_run(&job, &error) : job_run(&job, &error);
    if (result == WEFT_OK && crew_follows()) return job_free(&job), (int)result;
    if (result == WEFT_OK && !request->turntable) result = job_write(&job, NULL, &error);
    if (result == WEFT_OK && !job.interrupted) gather_forget(request);
    if (result != WEFT_OK) {
        report_error(&error);
    } else {
        if (!request->quiet) summary(&job);
        if (!option_given(request->options, "--json")) print_stages(&job);
        if (option_given(request->options, "--json")) {
            Json json = {.stream = stdout};
            json_open(&json, NULL, '{');
            job_json(&job, &json);
            json_close(&json, '}');
        }
        if (job.interrupted) result = WEFT_INTERRUPTED;
    }
    job_free(&job);
    return (int)result;
}

static int scene_run(const Options *options) {
    Request request;
    if (!request_read(options, &request)) return WEFT_USAGE;
    int result = crew_follows() ? 0 : request_outputs_check(&request);
    if (result != 0) return result;
    interrupt_watch();
    Warnings warnings = {.quiet = request.quiet};
    result = !option_given(options, "-o")  ? save_run(&request, &warnings)
             : request_count(&request) > 1 ? compare_run(&request, &warnings)
                                           : single_run(&request, &warnings);
    warnings_free(&warnings);
    return result;
}

static int render_run(const Options *options) {
    static const EachOutput outputs[] = {{"-o", ".png"}, {"--save", NULL}, {"--checkpoint", ".exr"}, {NULL, NULL}};
    return each_run(options, outputs, scene_run);
}

const Verb verb_render = {
    .name = "render",
    .operands = "SCENE... -o OUT [options]",
    .help = "renders images: path traced ground truth, or real-time OpenGL",
    .operands_least = 1,
    .operands_most = EACH_MOST,
    .options = request_options,
    .notes = "SCENE is a .gltf or .glb file (glTF 2.0; docs/gltf.md has the limits),\n"
             "builtin:NAME, or a material .u3m or .mtlx on builtin:cloth. `weft models` lists\n"
             "all ids.\n"
             "--workflow, --profile, --diffuse, --sheen, --layer and --set may have several\n"
             "values: then OUT is a sheet with a picture for each and, below, how it differs\n"
             "from the first. Numbers and ids have a comma between them, colours a semicolon,\n"
             "as in --set '*.sheen_color=1;1,0,0'. Two such options make rows and columns.\n"
             "Ctrl-C writes what there is and exits with 130. A picture appears under its\n"
             "name complete or not at all. Several scenes are rendered one after another, each\n"
             "with files of its own: OUT is then a folder, or {} in it stands for the scene's\n"
             "name (docs/batches.md).\n\n"
             "Examples\n"
             "  weft render builtin:cloth -o cloth.png\n"
             "  weft render SheenChair.glb -o chair.png -o chair.exr --spp 256\n"
             "  weft render SheenChair.glb -o chair.png --variant \"Peacock Velvet\"\n"
             "  weft render velvet.glb -o velvet.png --time-limit 30 --env studio.hdr\n"
             "  weft render velvet.glb -o velvet.png --camera \"0,1,3;0,0.5,0;30\"\n"
             "  weft render builtin:cloth -o denim.png --preset denim\n"
             "  weft render builtin:cloth -o mine.png --material Cloth=mine.json \\\n"
             "       --set '*.sheen_roughness=0.3'\n"
             "  weft render chair.glb --save velvet-chair.glb --preset velvet\n"
             "  weft render builtin:cloth --preset silk --save silk.mtlx --mtlx gltf_pbr\n"
             "  weft render builtin:cloth -o sheet.png \\\n"
             "       --sheen ashikhmin-neubelt,charlie-neubelt\n"
             "  weft render builtin:spheres -o row.png --workflow disney \\\n"
             "       --set '*.subsurface=0,0.25,0.5,0.75,1'\n"
             "  weft render velvet.glb -o sheet.png --layer additive,albedo-max,reciprocal\n"
             "  weft render velvet.glb -o both.png --engine both --light \"sun;-1,-2,-1;3,3,3\"\n"
             "  weft render velvet.glb -o turn.png --engine raster --turntable 36\n"
             "  weft render assets/*.glb -o 'pictures/{}.png' --preset velvet\n",
    .run = render_run,
};
