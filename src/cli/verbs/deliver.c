/* deliver.c - `weft deliver`: files for viewers that need no plug-in, each with a sheet that shows how near it is */
#include "cli/deliver/delivery.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/lobes.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"

/* Finds the target of that name: 0, or an exit code after one line. */
static int target_named(const char *name, int *out) {
    Nearest nearest = {.typed = name};
    WeftTarget target;
    char list[160] = "", hint[96];
    size_t used = 0;
    for (int k = 0; weft_target_info(k, &target); k++) {
        if (strcmp(target.name, name) == 0) {
            *out = k;
            return 0;
        }
        nearest_offer(&nearest, target.name);
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", target.name);
    }
    *out = TARGET_U3M;
    if (strcmp(name, "u3m") == 0) return 0;
    nearest_offer(&nearest, "u3m");
    nearest_hint(&nearest, hint, sizeof hint);
    return report(WEFT_USAGE, "--to %.60s: is not a target; there are %s, u3m%s", name[0] ? name : "\"\"", list, hint);
}

/* Reads the targets, "three,babylon", with blanks about a name or none; each once. */
static int targets_read(Delivery *delivery) {
    char name[64];
    const char *at = option_text(delivery->options, "--to");
    if (!at) return report(WEFT_USAGE, "--to is required: names of targets, such as three,babylon,filament");
    for (const char *end; at; at = *end ? end + 1 : NULL) {
        at += strspn(at, " \t");
        end = at + strcspn(at, ",");
        size_t length = (size_t)(end - at);
        while (length && isblank((unsigned char)at[length - 1])) length--;
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        int target;
        if (target_named(name, &target) != 0) return WEFT_USAGE;
        for (int k = 0; k < delivery->count; k++)
            if (delivery->files[k].target == target) return report(WEFT_USAGE, "--to %s: is named twice", name);
        delivery->files[delivery->count++].target = target;
    }
    return 0;
}

/* Names the files after what is delivered: a file's name without its folder and suffix, or words joined by dashes. */
static void name_make(Delivery *delivery) {
    const char *what = delivery->what, *slash = strrchr(what, '/');
    const bool file = access(what, F_OK) == 0;
    if (strncmp(what, "preset:", 7) == 0 || path_builtin(what)) what = strchr(what, ':') + 1;
    if (file && slash) what = slash + 1;
    const char *point = file ? strrchr(what, '.') : NULL;
    size_t length = point && point > what ? (size_t)(point - what) : strlen(what), used = 0;
    for (size_t k = 0; k < length && used < sizeof delivery->name - 1; k++) {
        const unsigned char c = (unsigned char)what[k];
        if (isalnum(c) || c == '_' || c >= 0x80)
            delivery->name[used++] = (char)c;
        else if (used && delivery->name[used - 1] != '-')
            delivery->name[used++] = '-';
    }
    while (used && (delivery->name[used - 1] & 0xc0) == 0x80 && used == sizeof delivery->name - 1) used--;
    while (used && delivery->name[used - 1] == '-') used--;
    delivery->name[used] = '\0';
    if (!used) snprintf(delivery->name, sizeof delivery->name, "cloth");
}

static int name_read(Delivery *delivery) {
    const char *name = option_text(delivery->options, "--name");
    if (!name) {
        name_make(delivery);
        return 0;
    }
    if (!*name || *name == '.' || strchr(name, '/') || strlen(name) >= sizeof delivery->name)
        return report(WEFT_USAGE, "--name %.80s: is not a name of files: no folder, at most %d characters", name,
                      DELIVER_NAME - 1);
    snprintf(delivery->name, sizeof delivery->name, "%s", name);
    return 0;
}

static int options_take(Delivery *delivery) {
    static const char *const metrics[] = {"cosine", "log", "picture", NULL};
    static const char *const of_drafts[] = {"--sett", "--yarn", "--seed"};
    const Options *options = delivery->options;
    static const char *const textures[] = {"auto", "png", "ktx2", NULL}; /* as TextureFormat */
    int metric = 0;
    if (!option_choice(options, "--metric", metrics, &metric) ||
        !option_choice(options, "--textures", textures, &delivery->textures))
        return WEFT_USAGE;
    delivery->metric = (WeftBrdfMetric)metric;
    delivery->folder = option_text(options, "-o");
    if (!delivery->folder) return report(WEFT_USAGE, "-o DIR is required: the folder for the files");
    const SourceKind kind = source_kind(delivery->what);
    if (option_given(options, "--from") && kind != SOURCE_ASSET)
        return report(WEFT_USAGE, "--from: goes with an asset, a .gltf or .glb");
    for (size_t k = 0; k < sizeof of_drafts / sizeof *of_drafts && kind != SOURCE_DRAFT; k++)
        if (option_given(options, of_drafts[k])) return report(WEFT_USAGE, "%s: goes with a draft", of_drafts[k]);
    if (!option_integer(options, "--size", &delivery->pixels) ||
        !option_integer(options, "--width", &delivery->width) || !option_integer(options, "--spp", &delivery->spp))
        return WEFT_USAGE;
    delivery->height = delivery->width * 3 / 4;
    return name_read(delivery);
}

/* Reads a delivered file again, to be shaded as its target does. */
static int target_file_load(Delivery *delivery, const TargetFile *file, const char *path, WeftScene **scene) {
    WeftError error;
    if (file->target == TARGET_U3M) return u3m_load(delivery, path, scene);
    WeftResult result = weft_scene_load(path, scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_set(*scene, "*.profile", file_target(file).profile, NULL, &error);
    return told(result, &error);
}

/* Writes a glTF file from the source that is made for it, and gives fine normal maps mip levels of their own. */
static int gltf_write(Delivery *delivery, TargetFile *file, const char *path) {
    char source[DELIVER_PATH];
    int from;
    WeftError error;
    const double low = delivery->low, middle = 0.5 * (low + delivery->high), high = delivery->high;
    delivery_part(delivery, low, middle);
    const int result = source_write(delivery, file, source, &from);
    if (result != 0) return result;
    delivery_part(delivery, middle, high);
    const int made = told(weft_deliver(source, path, from, file->target, delivery->metric, delivery_heed, delivery,
                                       &file->delivery, NULL, &error),
                          &error);
    if (made != 0 || !target_levels(delivery, file)) return made;
    return told(weft_deliver_levels(path, path, &file->delivery, NULL, &error), &error);
}

/* Renders a delivered file as its target shades it, and compares it with the reference. */
static int target_file_judge(Delivery *delivery, TargetFile *file, const Shots *reference, const char *path) {
    const WeftTarget target = file_target(file);
    WeftScene *scene = NULL;
    Shots shots = {.sky = {0}};
    char sheet[DELIVER_PATH];
    folder_path(delivery, target.name, ".png", sheet);
    int result = target_file_load(delivery, file, path, &scene);
    if (result == 0) result = shots_take(delivery, scene, &shots);
    if (result == 0) result = shots_compare(&shots, reference, &file->errors);
    if (result == 0) result = delivery_sheet(delivery, file, &shots, reference, sheet);
    shots_free(&shots);
    weft_scene_free(scene);
    return result;
}

static int target_file_make(Delivery *delivery, TargetFile *file, const Shots *reference, double low, double high) {
    static const double MADE = 0.6; /* where the making ends */
    struct stat status;
    char path[DELIVER_PATH];
    folder_path(delivery, file_target(file).name, file_suffix(file), path);
    delivery_part(delivery, low, low + MADE * (high - low));
    const int made = file->target == TARGET_U3M ? u3m_write(delivery, file, path) : gltf_write(delivery, file, path);
    if (made != 0) return made;
    if (stat(path, &status) == 0) file->bytes = (long long)status.st_size;
    delivery_part(delivery, low + MADE * (high - low), high);
    return target_file_judge(delivery, file, reference, path);
}

static int summary_file(const Delivery *delivery) {
    Output output;
    char path[DELIVER_PATH];
    folder_path(delivery, NULL, ".json", path);
    const int result = output_begin(&output, path);
    if (result != 0) return result;
    summary_write(delivery, output.stream);
    return output_end(&output);
}

/* Draws the reference, then makes each target's files; all in the temporary folder. */
static int all_make(Delivery *delivery) {
    static const double REFERENCE = 0.2; /* where this part of the work ends */
    WeftScene *scene = NULL;
    Shots reference = {.sky = {0}};
    delivery_part(delivery, 0.0, 0.05);
    int result = source_load(delivery, &scene);
    if (result == 0) result = shots_aim(delivery, scene);
    delivery_part(delivery, 0.05, REFERENCE);
    if (result == 0) result = shots_take(delivery, scene, &reference);
    weft_scene_free(scene);
    for (int k = 0; k < delivery->count && result == 0; k++) {
        const double each = (1.0 - REFERENCE) / delivery->count, low = REFERENCE + each * k;
        result = target_file_make(delivery, &delivery->files[k], &reference, low, low + each);
    }
    if (result == 0) result = summary_file(delivery);
    if (result == 0 && interrupt_seen()) result = WEFT_INTERRUPTED;
    shots_free(&reference);
    return result;
}

static int deliver_run(const Options *options) {
    Delivery delivery = {.options = options, .what = options->operands[0]};
    int result = targets_read(&delivery);
    if (result == 0) result = options_take(&delivery);
    if (result != 0) return result;
    interrupt_watch();
    result = folder_begin(&delivery);
    delivery.progress = progress_start_count(false, "of the delivery", 0.0);
    if (result == 0) result = all_make(&delivery);
    progress_finish(&delivery.progress);
    if (result == 0) result = folder_commit(&delivery);
    folder_end(&delivery);
    if (result == WEFT_INTERRUPTED) report(result, "%.300s: interrupted; nothing was written", delivery.what);
    if (result == 0 && option_given(options, "--json"))
        summary_write(&delivery, stdout);
    else if (result == 0)
        summary_print(&delivery);
    for (int k = 0; k < delivery.count; k++) weft_delivery_free(&delivery.files[k].delivery);
    for (int k = 0; k < delivery.source_count; k++) free(delivery.sources[k].materials);
    weft_losses_free(&delivery.losses);
    return result;
}

static void targets_list(void) {
    WeftTarget target;
    printf("\nTargets\n");
    for (int k = 0; weft_target_info(k, &target); k++) layout_entry(stdout, 12, target.name, target.help);
    target = file_target(&(TargetFile){.target = TARGET_U3M});
    layout_entry(stdout, 12, target.name, target.help);
}

static const Option deliver_options[] = {
    OPTION_HEADING("Delivery"),
    OPTION_TEXT("--to", "TARGET,...", NULL, "the viewers it is for, see below"),
    OPTION_TEXT("-o", "DIR", NULL, "the folder for the files; it is made if it does not exist"),
    OPTION_TEXT("--name", "NAME", NULL, "what the files are called, before -TARGET; else after X"),
    OPTION_TEXT("--from", "PROFILE", "khronos", "of an asset: the engine that it was made for"),
    OPTION_TEXT("--metric", "NAME", "cosine", "what a match makes least: cosine, log or picture, see weft match"),
    OPTION_ROOT,
    OPTION_HEADING("Cloth of a draft"),
    OPTION_TEXT("--sett", "E[,P]", NULL, "warp threads per cm, and picks where they differ"),
    OPTION_TEXT("--yarn", "WARP[,WEFT]", "cotton",
                "yarn of warp and weft: cotton, linen, wool, silk, dupion, polyester"),
    OPTION_WHOLE("--seed", "N", "0", 0, 288, "another cloth of the same draft and yarns"),
    OPTION_WHOLE("--size", "PIXELS", "1024", 16, 8192,
                 "textures of woven cloth have as many texels as a square of that side"),
    OPTION_TEXT(
        "--textures", "FORMAT", "auto",
        "of woven cloth, and of fine normal maps of an asset with their roughness: png, which leaves those of an "
        "asset as they are; ktx2 with mip levels of their own, and png beside it; auto: ktx2 for khronos, three and "
        "filament"),
    OPTION_HEADING("Sheets"),
    OPTION_WHOLE("--width", "PIXELS", "320", 32, 2048, "of one picture on a sheet"),
    OPTION_WHOLE("--spp", "N", "32", 1, 4096, "samples per pixel"),
    OPTION_SWITCH("--json", "the summary on standard output as well"),
    OPTION_END,
};

const Verb verb_deliver = {
    .name = "deliver",
    .operands = "X [options]",
    .help = "hands cloth over as glTF for viewers, with proof",
    .operands_least = 1,
    .operands_most = 1,
    .options = deliver_options,
    .lists = targets_list,
    .notes = "X is an asset (.gltf, .glb), a material (.json, preset:NAME, .u3m, .mtlx),\n"
             "a weaving draft or its words as in weft weave, or a built-in scene.\n"
             "A measurement has to be fitted first: weft fit FILE -o fitted.json.\n\n"
             "For each target DIR/NAME-TARGET.glb is written, and DIR/NAME-TARGET.png: the\n"
             "reference, the file as its target shades it, and how they differ, near and far.\n"
             "DIR/NAME.json has all numbers. Extensions that the target does not read are\n"
             "taken out, and the factors that remain are matched again. Woven cloth is baked\n"
             "and fitted for each target by itself. Files take their places at the end, when\n"
             "all are made. For u3m the file is DIR/NAME-u3m.u3ma.\n\n"
             "There is no target for Unreal Engine 5: weft has no profile of its Substrate, by\n"
             "which a file could be matched and judged.\n\n"
             "docs/deliver.md goes from a draft to a page on the web.\n\n"
             "Examples\n"
             "  weft deliver \"twill 3/1; warp 1#28385c; weft 1w\" --to three,filament -o out\n"
             "  weft deliver preset:woven-charmeuse --to three,core -o out --name satin\n"
             "  weft deliver chair.glb --from blender4 --to three,filament -o out --json\n",
    .run = deliver_run,
};
