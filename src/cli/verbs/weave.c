/* weave.c - `weft weave`: weaving drafts, read, described and written */
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/draft_operand.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

static const double UV_METRES = 0.5; /* of a unit of texture coordinates of builtin:cloth */

typedef struct Weaving {
    const Options *options;
    const char *what, *output; /* output: NULL: none */
    WeftDraft *draft;
    WeftDraftInfo info;
    WeftCloth *cloth;      /* NULL: not needed */
    bool given;            /* a material was given, not a draft alone */
    WeftMaterial material; /* what lies on the cloth */
    bool baked;
    WeftBaked fit; /* of the maps, if they were made */
} Weaving;

static int output_check(Weaving *weaving) {
    const char *path = weaving->output = option_text(weaving->options, "-o");
    const char *folder = option_text(weaving->options, "--bake");
    const bool cloth = option_given(weaving->options, "--close");
    static const char *const of_bakes[] = {"--profile", "--textures"};
    for (size_t k = 0; k < sizeof of_bakes / sizeof *of_bakes && !folder; k++)
        if (option_given(weaving->options, of_bakes[k]))
            return report(WEFT_USAGE, "%s: is for the textures of --bake DIR", of_bakes[k]);
    if (folder && strlen(folder) > 4000) return report(WEFT_USAGE, "--bake: the name is too long");
    if (!path && cloth) return report(WEFT_USAGE, "--close: the picture needs a name: -o OUT.png");
    if (!path) return 0;
    if (cloth && !path_ends(path, ".png")) return report(WEFT_USAGE, "%s: a cloth is drawn as .png", path);
    if (!weft_draft_suffix_known(path))
        return report(WEFT_USAGE, "%s: drafts are written as .wif, .png, .svg, .pdf or .txt", path);
    return output_probe_other(weaving->options, path);
}

/* Returns the threads of a system per centimetre. The repeat is longest across its own threads. */
static double sett(const WeftDraftInfo *info, WeftThreads threads) {
    return (double)info->count[threads] / (100.0 * (double)info->size[threads]);
}

/* Returns true if the operand names a material: a preset, or a material file. */
static bool is_material(const char *what) { return strncmp(what, "preset:", 7) == 0 || path_ends(what, ".json"); }

/* Copies the draft of a material, which a scene holds. */
static WeftResult draft_of_material(Weaving *weaving, const WeftLog *log, WeftError *error) {
    WeftScene *scene = NULL;
    WeftMaterial material;
    WeftResult result = weft_scene_load("builtin:cloth", &scene, log, error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, weaving->what, NULL, error);
    if (result == WEFT_OK) result = weft_scene_material(scene, 0, &material, error);
    if (result == WEFT_OK)
        result = weft_draft_copy(weft_scene_cloth(scene, material.cloth, NULL), &weaving->draft, error);
    weft_scene_free(scene);
    return result;
}

/* Reads a material: its cloth and its draft. */
static int material_take(Weaving *weaving) {
    static const char *const own[] = {"--sett", "--back", "--yarn", "--seed"};
    const WeftLog log = {.fn = report_warning};
    WeftError error;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++)
        if (option_given(weaving->options, own[k]))
            return report(WEFT_USAGE, "%s: %.300s is a material, which has its own; change it there", own[k],
                          weaving->what);
    if (weft_material_read_woven(weaving->what, &weaving->material, &weaving->cloth, &log, &error) != WEFT_OK)
        return report_error(&error);
    if (!weaving->cloth)
        return report(WEFT_INPUT, "%.300s: is not woven; a material with the key \"weave\" is needed", weaving->what);
    if (draft_of_material(weaving, &log, &error) != WEFT_OK) return report_error(&error);
    weaving->info = weft_draft_info(weaving->draft);
    return 0;
}

static int draft_make(Weaving *weaving) {
    const WeftLog log = {.fn = report_warning};
    WeftError error;
    weaving->given = is_material(weaving->what);
    if (weaving->given) return material_take(weaving);
    weft_material_default(&weaving->material);
    weaving->material.alpha_mode = WEFT_ALPHA_BLEND; /* gaps of a cloth alone are holes */
    const int read = draft_read(weaving->what, &log, &weaving->draft);
    if (read != 0) return read;
    if (option_given(weaving->options, "--back")) {
        WeftDraft *back;
        if (weft_draft_back(weaving->draft, &back, &error) != WEFT_OK) return report_error(&error);
        weft_draft_free(weaving->draft);
        weaving->draft = back;
    }
    const int result = draft_sett(option_text(weaving->options, "--sett"), weaving->draft);
    weaving->info = weft_draft_info(weaving->draft);
    if (result == 0 && !weaving->info.shafts)
        return report(WEFT_RESOURCES, "%.300s: %s", weaving->what, weft_message_text(WEFT_MESSAGE_MEMORY));
    return result;
}

/* Weaves the cloth. A draft of many crossings is woven only if the options need the cloth. */
static int cloth_make(Weaving *weaving) {
    const Options *options = weaving->options;
    const bool asked = option_given(options, "--close") || option_given(options, "--bake");
    WeftYarn yarns[2];
    WeftError error;
    int seed = 0;
    if (weaving->cloth) return 0;
    if (!option_integer(options, "--seed", &seed)) return WEFT_USAGE;
    const int result = yarns_read(option_text(options, "--yarn"), yarns);
    if (result != 0) return result;
    if (!asked && (long)weaving->info.count[0] * weaving->info.count[1] > 1 << 18) return 0;
    if (weft_cloth_create(weaving->draft, yarns, (unsigned)seed, &weaving->cloth, &error) != WEFT_OK)
        return report_error(&error);
    return 0;
}

static int cloth_write(const Weaving *weaving) {
    WeftImage image;
    WeftError error;
    double threads = 0.0;
    int pixels = 0;
    if (!option_number(weaving->options, "--close", &threads) || !option_integer(weaving->options, "--size", &pixels))
        return WEFT_USAGE;
    if (weft_cloth_draw(weaving->cloth, pixels, (float)threads, &image, &error) != WEFT_OK) return report_error(&error);
    const WeftResult result = weft_image_write(weaving->output, &image, &error);
    weft_image_free(&image);
    return result == WEFT_OK ? 0 : report_error(&error);
}

/* Writes the draft or the cloth, where a file for it is named. */
static int weaving_write(const Weaving *weaving) {
    WeftError error;
    if (!weaving->output) return 0;
    if (option_given(weaving->options, "--close")) return cloth_write(weaving);
    return weft_draft_write(weaving->draft, weaving->output, &error) == WEFT_OK ? 0 : report_error(&error);
}

/* Writes the material of a scene with the maps as cloth.u3m, with construction and composition, which a material does not
 * name. */
static WeftResult u3m_write(const Weaving *weaving, const WeftScene *scene, const char *path, WeftError *error) {
    const char *text = option_text(weaving->options, "--yarn"), *comma = strchr(text, ',');
    char name[64];
    snprintf(name, sizeof name, "%.*s", comma ? (int)(comma - text) : (int)strlen(text), text);
    const WeftTextile textile = {
        .draft = weaving->draft, .yarns = {name, comma ? comma + 1 : name}, .metres = UV_METRES};
    return weft_scene_save_u3m(scene, 0, path, weaving->given ? NULL : &textile, NULL, error);
}

/* Returns what a unit of texture coordinates spans: of the draped cloth where the material does not say. */
static double baked_metres(const WeftCloth *cloth) {
    const WeftClothInfo info = weft_cloth_info(cloth);
    return info.automatic || !(info.metres > 0.0f) ? UV_METRES : (double)info.metres;
}

/* Writes the maps, their material, and a draped cloth of it as cloth.glb. */
static int maps_write(Weaving *weaving) {
    const char *folder = option_text(weaving->options, "--bake");
    char material[4096], glb[4096], u3m[4096];
    WeftScene *scene = NULL;
    WeftError error;
    WeftBaking baking = {.profile = option_text(weaving->options, "--profile")};
    if (!folder) return 0;
    static const char *const textures[] = {"png", "ktx2", NULL};
    if (!option_integer(weaving->options, "--size", &baking.pixels) ||
        !option_choice(weaving->options, "--textures", textures, &baking.levels))
        return WEFT_USAGE;
    baking.metres = weaving->given ? baked_metres(weaving->cloth) : UV_METRES;
    if (weft_cloth_info(weaving->cloth).rotation > 0.0f || weft_cloth_info(weaving->cloth).rotation < 0.0f)
        report(0, "warning: %.300s: its weave is rotated; textures lie along the texture coordinates", weaving->what);
    snprintf(material, sizeof material, "%s/material.json", folder);
    snprintf(glb, sizeof glb, "%s/cloth.glb", folder);
    snprintf(u3m, sizeof u3m, "%s/cloth.u3m", folder);
    const WeftLog log = {.fn = report_warning};
    interrupt_watch();
    Progress progress = progress_start_count(false, "of the search", 0.0);
    baking.progress = progress_heed;
    baking.user = &progress;
    WeftResult result = weft_material_bake(&weaving->material, weaving->cloth, &baking, folder, &weaving->fit, &error);
    progress_finish(&progress);
    if (result == WEFT_INTERRUPTED)
        return report(WEFT_INTERRUPTED, "%.300s: interrupted; no maps were written", folder);
    if (result == WEFT_OK) result = weft_scene_load("builtin:cloth", &scene, &log, &error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, NULL, material, &log, &error);
    if (result == WEFT_OK) result = weft_scene_save(scene, glb, &error);
    if (result == WEFT_OK) result = u3m_write(weaving, scene, u3m, &error);
    weft_scene_free(scene);
    weaving->baked = result == WEFT_OK;
    return result == WEFT_OK ? 0 : report_error(&error);
}

static void endless_warn(const Weaving *weaving) {
    static const char *const names[] = {"warp threads", "picks"};
    for (int t = 0; t < 2; t++)
        if (weaving->info.endless[t])
            report(0, "warning: %.300s: %d of %d %s never change sides: the cloth would not hold together",
                   weaving->what, weaving->info.endless[t], weaving->info.count[t], names[t]);
}

static void text_write(const Weaving *weaving) {
    enum { COLUMN = 14 };
    const WeftDraftInfo *info = &weaving->info;
    char text[160];
    print_name(info->title[0] ? info->title : weaving->what);
    printf("\n");
    snprintf(text, sizeof text, "%d warp threads x %d picks", info->count[WEFT_WARP], info->count[WEFT_WEFT]);
    layout_entry(stdout, COLUMN, "repeat", text);
    snprintf(text, sizeof text, "shafts: %d, treadles: %d, at the least", info->shafts, info->treadles);
    layout_entry(stdout, COLUMN, "loom", text);
    snprintf(text, sizeof text, "on top at %.4g %% of the crossings", 100.0 * (double)info->warp_share);
    layout_entry(stdout, COLUMN, "warp", text);
    snprintf(text, sizeof text, "warp over %d picks, weft over %d threads", info->longest_float[WEFT_WARP],
             info->longest_float[WEFT_WEFT]);
    layout_entry(stdout, COLUMN, "longest float", text);
    snprintf(text, sizeof text, "%.4g x %.4g per cm; the repeat is %.4g x %.4g mm", sett(info, WEFT_WARP),
             sett(info, WEFT_WEFT), 1000.0 * (double)info->size[WEFT_WARP], 1000.0 * (double)info->size[WEFT_WEFT]);
    layout_entry(stdout, COLUMN, "threads", text);
    if (!weaving->cloth) return;
    const WeftClothInfo cloth = weft_cloth_info(weaving->cloth);
    snprintf(text, sizeof text, "warp %.1f %%, weft %.1f %%, gaps %.1f %%", 100.0 * (double)cloth.share[WEFT_WARP],
             100.0 * (double)cloth.share[WEFT_WEFT],
             100.0 * (1.0 - (double)cloth.share[WEFT_WARP] - (double)cloth.share[WEFT_WEFT]));
    layout_entry(stdout, COLUMN, "seen", text);
    if (!weaving->baked) return;
    snprintf(text, sizeof text,
             "%.1f %% off the cloth's own light; %.1f %% with the threads' own numbers; sky %+.1f %%, contrast %.2f",
             100.0 * weaving->fit.fitted, 100.0 * weaving->fit.copied, 100.0 * weaving->fit.sky, weaving->fit.contrast);
    layout_entry(stdout, COLUMN, "textures", text);
    if (!(weaving->fit.levels > 0.0)) return;
    snprintf(text, sizeof text, "%.1f %% off it in the mean", 100.0 * weaving->fit.levels);
    layout_entry(stdout, COLUMN, "mip levels", text);
}

static void json_write(const Weaving *weaving) {
    const WeftDraftInfo *info = &weaving->info;
    static const char *const names[] = {"warp", "weft"};
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "draft", weaving->what);
    json_text(&json, "title", info->title);
    json_whole(&json, "shafts", info->shafts);
    json_whole(&json, "treadles", info->treadles);
    json_float(&json, "warp_share", info->warp_share);
    if (weaving->cloth) {
        json_float(&json, "warp_seen", weft_cloth_info(weaving->cloth).share[WEFT_WARP]);
        json_float(&json, "weft_seen", weft_cloth_info(weaving->cloth).share[WEFT_WEFT]);
    }
    if (weaving->baked) {
        json_open(&json, "textures", '{');
        json_float(&json, "fitted", (float)weaving->fit.fitted);
        json_float(&json, "copied", (float)weaving->fit.copied);
        json_float(&json, "sky", (float)weaving->fit.sky);
        json_float(&json, "contrast", (float)weaving->fit.contrast);
        if (weaving->fit.levels > 0.0) json_float(&json, "levels", (float)weaving->fit.levels);
        json_close(&json, '}');
    }
    for (int t = 0; t < 2; t++) {
        json_open(&json, names[t], '{');
        json_whole(&json, "threads", info->count[t]);
        json_float(&json, "size", info->size[t]);
        json_whole(&json, "longest_float", info->longest_float[t]);
        json_whole(&json, "endless", info->endless[t]);
        json_close(&json, '}');
    }
    json_close(&json, '}');
}

static int weave_run(const Options *options) {
    Weaving weaving = {.options = options, .what = options->operands[0]};
    int result = output_check(&weaving);
    if (result == 0) result = draft_make(&weaving);
    if (result == 0) endless_warn(&weaving);
    if (result == 0) result = cloth_make(&weaving);
    if (result == 0) result = weaving_write(&weaving);
    if (result == 0) result = maps_write(&weaving);
    if (result == 0 && option_given(options, "--json"))
        json_write(&weaving);
    else if (result == 0)
        text_write(&weaving);
    weft_cloth_free(weaving.cloth);
    weft_draft_free(weaving.draft);
    return result;
}

static const Option weave_options[] = {
    OPTION_HEADING("Cloth"),
    OPTION_TEXT("--sett", "E[,P]", NULL, "warp threads per cm, and picks where they differ"),
    OPTION_SWITCH("--back", "the cloth turned over: left and right change places, and so do warp and weft on top"),
    OPTION_TEXT("--yarn", "WARP[,WEFT]", "cotton",
                "yarn of warp and weft: cotton, linen, wool, silk, dupion, polyester"),
    OPTION_WHOLE("--seed", "N", "0", 0, 288, "another cloth of the same draft and yarns"),
    OPTION_HEADING("Result"),
    OPTION_TEXT("-o", "OUT", NULL,
                "write the draft: .wif for weaving programs and looms; .png, .svg or .pdf as weavers print it; "
                ".txt with # where the warp is on top"),
    OPTION_NUMBER("--close", "THREADS", NULL, 0.5, 20000,
                  "draw the cloth itself, so many warp threads wide, as -o OUT.png"),
    OPTION_TEXT(
        "--bake", "DIR", NULL,
        "write textures of both faces that tile, a material file with them, fitted so that a viewer shades it as the "
        "cloth, a draped cloth of it, cloth.glb, and cloth.u3m"),
    OPTION_TEXT("--profile", "NAME", "khronos", "the viewer's shading that --bake is fitted for: an engine profile"),
    OPTION_TEXT("--textures", "FORMAT", "png",
                "of --bake: png, or ktx2 with mip levels of their own, each fitted by itself, for viewers that read "
                "KHR_texture_basisu"),
    OPTION_WHOLE("--size", "PIXELS", "800", 16, 8192,
                 "width of that picture; textures have as many texels as a square of that side"),
    OPTION_SWITCH("--json", "the figures as JSON on standard output"),
    OPTION_END,
};

const Verb verb_weave = {
    .name = "weave",
    .operands = "DRAFT [options]",
    .help = "reads a weaving draft (WIF, picture, words); draws, bakes it",
    .operands_least = 1,
    .operands_most = 1,
    .options = weave_options,
    .notes = "DRAFT is a file (.wif, .dtx of Fiberworks, .wpo of WeavePoint), a picture (a\n"
             "pixel a crossing, the darker of two colours where the warp is on top), a\n"
             "material with a weave (.json, or preset:NAME: yarns, seed, metres and sheen are\n"
             "its own), or words:\n\n"
             "  plain | houndstooth | basket N [M] | twill A/B[/A/B...] [z|s] | satin N/C |\n"
             "  sateen N/C | herringbone A/B N | picks #.. .#. ..#\n\n"
             "and after it, each behind a semicolon,\n\n"
             "  warp STRIPES, weft STRIPES or both STRIPES: such as 24k 4r 8#2050a0; the word\n"
             "      mirror at their end repeats them backwards, as in a tartan\n"
             "  sett E [P]: threads per cm of warp and weft\n\n"
             "docs/weave.md has the letters of colours, and what is completed in a WIF.\n\n"
             "Examples\n"
             "  weft weave \"twill 2/2 z\"\n"
             "  weft weave cloth.wif -o drawdown.pdf\n"
             "  weft weave \"twill 2/2; both 24b 4k 24g 4r mirror\" -o tartan.png\n"
             "  weft weave flower.png --sett 60,40 -o flower.wif\n"
             "  weft weave preset:woven-denim --bake denim --size 1024 --profile three\n",
    .run = weave_run,
};
