/* export.c - `weft export`: a lobe, a profile or a material as text for an engine, with its tables */
#include "weft/export.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/files/export_files.h"
#include "cli/operands/command.h"
#include "cli/operands/lobes.h"
#include "cli/operands/model.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"

typedef struct Export {
    const Options *options;
    WeftExportDesc descs[WEFT_EXPORT_MODELS_MAX];
    Model models[WEFT_EXPORT_MODELS_MAX], right;
    int count;
    WeftExport made;
    WeftExportLut beside; /* the form of the tables outside the text */
    bool quiet;
} Export;

/* Reads the model to export. A profile or workflow keeps its own defaults except for settings behind its name, since
 * the shader takes any values. */
static int read_model(const char *typed, Model *model, WeftExportDesc *desc) {
    int result = model_parse_bare(typed, model);
    if (result != 0) return result;
    bool choice = model->kind == MODEL_PROFILE || model->kind == MODEL_WORKFLOW;
    if (model->kind == MODEL_MEASURED)
        return report(WEFT_USAGE, "%.200s: is a measurement: `weft fit` makes a material of it", typed);
    if (model->kind == MODEL_LOBE) {
        desc->lobe = &model->lobe;
    } else if (choice && strcmp(model->name, "none") != 0) {
        desc->profile = model->name;
        if (model->given) desc->material = &model->material;
    } else {
        desc->material = &model->material;
        desc->name = model->name;
        desc->cloth = model->cloth;
    }
    if (desc->albedo && !desc->lobe)
        return report(WEFT_USAGE, "--albedo: is for a lobe; a material has the tables that it needs");
    if (desc->ambient && !desc->lobe) return report(WEFT_USAGE, "--ambient: is for a lobe");
    return 0;
}

/* Reads the lobe of the right half of a Shadertoy. */
static int read_right(Export *self, const char *typed) {
    int result = self->descs->lobe ? model_parse(typed, &self->right) : WEFT_USAGE;
    if (!self->descs->lobe || (result == 0 && self->right.kind != MODEL_LOBE))
        return report(WEFT_USAGE, "%.200s: a Shadertoy shows two lobes side by side, and only lobes", typed);
    self->descs->right = &self->right.lobe;
    return result;
}

static int read_models(Export *self, const WeftExportDesc *common) {
    const Options *options = self->options;
    bool toy = common->target == WEFT_EXPORT_SHADERTOY;
    if (toy && options->operand_count > 2)
        return report(WEFT_USAGE, "%.200s: is one operand too many: a Shadertoy shows two lobes at most",
                      options->operands[2]);
    for (int k = 0; k < options->operand_count; k++) {
        if (toy && k == 1) return read_right(self, options->operands[k]);
        self->descs[k] = *common;
        int result = read_model(options->operands[k], &self->models[k], &self->descs[k]);
        if (result != 0) return result;
        self->count++;
    }
    return 0;
}

static int export_read(const Options *options, Export *self) {
    static const char *const pis[] = {"explicit", "folded", NULL};
    const char *targets[WEFT_EXPORT_TARGETS + 1] = {NULL}, *luts[WEFT_EXPORT_LUTS + 1] = {NULL};
    int target, lut = WEFT_EXPORT_LUT_C, pi;
    self->options = options;
    self->quiet = option_given(options, "--quiet");
    for (int k = 0; k < WEFT_EXPORT_TARGETS; k++) targets[k] = weft_export_target_name(k);
    for (int k = 0; k < WEFT_EXPORT_LUTS; k++) luts[k] = weft_export_lut_name(k);
    if (!option_text(options, "--target"))
        return report(WEFT_USAGE,
                      "export: needs --target glsl, essl, hlsl, wgsl, c, shadertoy, godot, unity or unreal");
    if (!option_text(options, "-o")) return report(WEFT_USAGE, "export: needs -o FILE");
    if (!option_choice(options, "--target", targets, &target) || !option_choice(options, "--light-pi", pis, &pi))
        return WEFT_USAGE;
    if (option_given(options, "--lut") && !option_choice(options, "--lut", luts, &lut)) return WEFT_USAGE;
    self->beside = option_given(options, "--lut") ? (WeftExportLut)lut : WEFT_EXPORT_LUT_EXR;
    return read_models(self, &(WeftExportDesc){.target = (WeftExportTarget)target,
                                               .lut = (WeftExportLut)lut,
                                               .albedo = option_given(options, "--albedo"),
                                               .ambient = option_given(options, "--ambient"),
                                               .fold_pi = pi,
                                               .prefix = option_text(options, "--prefix")});
}

static int files_write(const Export *self) {
    Json json = {.stream = stdout};
    bool wanted = option_given(self->options, "--json");
    char *command = command_text(self->options);
    const ExportFiles files = {.made = &self->made,
                               .lut = self->beside,
                               .path = option_text(self->options, "-o"),
                               .command = command,
                               .quiet = self->quiet};
    int result = command ? 0 : report(WEFT_RESOURCES, "out of memory");
    if (result == 0 && !wanted) {
        result = export_tables_write(&files, NULL);
    } else if (result == 0) {
        json_open(&json, NULL, '{');
        json_text(&json, "target", weft_export_target_name((int)self->descs->target));
        json_text(&json, "output", files.path);
        json_whole(&json, "bytes", (long long)self->made.size);
        json_open(&json, "tables", '[');
        result = export_tables_write(&files, &json);
        json_close(&json, ']');
        json_close(&json, '}');
    }
    if (result == 0) result = export_text_write(&files);
    free(command);
    return result;
}

/* Says what the texts of woven materials leave out. */
static void tell_cloths(const Export *self) {
    for (int k = 0; k < self->count && !self->quiet; k++)
        if (self->descs[k].cloth)
            report(0, "%s: the back of the cloth, hair and normal maps are left out", self->models[k].name);
}

static int export_run(const Options *options) {
    Export *self = calloc(1, sizeof *self);
    WeftError error;
    if (!self) return report(WEFT_RESOURCES, "out of memory");
    int result = export_read(options, self);
    if (result == 0) result = output_probe_other(options, option_text(options, "-o"));
    if (result == 0 && weft_export_all(self->descs, self->count, &self->made, &error) != WEFT_OK)
        result = report_error(&error);
    if (result == 0) result = files_write(self);
    if (result == 0) tell_cloths(self);
    weft_export_free(&self->made);
    for (int k = 0; k < WEFT_EXPORT_MODELS_MAX; k++) model_free(&self->models[k]);
    model_free(&self->right);
    free(self);
    return result;
}

static void lists(void) {
    printf("\nTargets\n");
    for (int k = 0; weft_export_target_name(k); k++)
        layout_entry(stdout, 14, weft_export_target_name(k), weft_export_target_help(k));
}

static const Option export_options[] = {
    OPTION_HEADING("Output"),
    OPTION_TEXT("-o", "FILE", NULL, "write the text to FILE; tables go beside it, under their names in the text"),
    OPTION_TEXT("--target", "TARGET", NULL, "the language, below"),
    OPTION_TEXT("--lut", "KIND", NULL,
                "tables as c arrays (inside the text where it can hold them), png16, exr, dds or npy [inside the text "
                "where it can hold them, else exr]"),
    OPTION_LOBES,
    OPTION_ROOT,
    OPTION_HEADING("Text"),
    OPTION_TEXT("--light-pi", "HOW", "explicit",
                "explicit: f has its 1/pi and lights are irradiances; folded: f times pi, for lights whose "
                "unit has the 1/pi inside"),
    OPTION_SWITCH("--albedo", "of a lobe its directional albedo E too, from a table"),
    OPTION_SWITCH("--ambient", "of a lobe how an environment map lights it too, by look-ups and a table"),
    OPTION_TEXT("--prefix", "NAME", NULL,
                "what every name begins with; another one where two texts meet [weft_; in C weftx_]"),
    OPTION_HEADING("Reports"),
    OPTION_SWITCH("--quiet", "no summary"),
    OPTION_SWITCH("--json", "the files written as JSON on standard output"),
    OPTION_END,
};

const Verb verb_export = {
    .name = "export",
    .operands = "MODEL... --target TARGET -o FILE [options]",
    .help = "writes a model as a shader of an engine, a C header or a Shadertoy",
    .operands_least = 1,
    .operands_most = WEFT_EXPORT_MODELS_MAX,
    .options = export_options,
    .lists = lists,
    .notes = "MODEL is a lobe, an engine profile, a workflow, a preset (preset:NAME where a\n"
             "lobe has that name too), a material file .json, FILE.gltf[:MATERIAL], or a\n"
             "draft (.wif, .dtx, .wpo) or words such as \"twill 2/2 z\", woven of cotton;\n"
             "all with settings behind it, " MODEL_FORM ".\n"
             "Several share what is the same in them; a second lobe stands on the right half\n"
             "of a Shadertoy. docs/export.md explains the functions, pi, and how engines take\n"
             "them.\n\n"
             "Examples\n"
             "  weft export charlie-neubelt:alpha=0.3 --target hlsl -o charlie.ush\n"
             "  weft export ltc-fibre --target glsl --lut dds -o fuzz.glsl\n"
             "  weft export ltc-fibre --target unity -o fuzz.hlsl\n"
             "  weft export charlie-conty-kulla --target godot -o charlie.gdshaderinc\n"
             "  weft export velvet --target c -o velvet.h\n"
             "  weft export preset:woven-denim --target glsl -o denim.glsl\n"
             "  weft export ggx charlie-neubelt khronos --target glsl -o cloth.glsl\n"
             "  weft export chair.gltf:fabric --target essl --light-pi folded -o chair.glsl\n"
             "  weft export ashikhmin-neubelt charlie-neubelt --target shadertoy -o toy.glsl\n",
    .run = export_run,
};
