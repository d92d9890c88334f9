#include "weft/export.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "export/draft.h"

static const char *const targets[WEFT_EXPORT_TARGETS + 1] = {"glsl", "essl",  "hlsl",  "c",      "shadertoy",
                                                             "wgsl", "godot", "unity", "unreal", NULL};
static const char *const helps[WEFT_EXPORT_TARGETS] = {
    "functions for GLSL 3.30 core and later",
    "functions for GLSL ES 3.00: OpenGL ES 3, WebGL 2",
    "functions for HLSL, shader model 5 and later: Unreal, Unity",
    "one header for C99 and C++ that stands alone",
    "a complete shader to paste: a ball, the mouse moves roughness and light",
    "functions for WGSL: WebGPU in browsers, and wgpu and Dawn outside",
    "a .gdshaderinc for Godot 4, to be included by a shader",
    "a .hlsl for Unity's Custom Function node: void NAME_float and NAME_half",
    "a .ush for Unreal's Custom node or a shading model",
};
static const char *const luts[WEFT_EXPORT_LUTS + 1] = {"c", "png16", "exr", "dds", "npy", NULL};

const char *weft_export_target_name(int target) {
    return target >= 0 && target < WEFT_EXPORT_TARGETS ? targets[target] : NULL;
}

const char *weft_export_target_help(int target) {
    return target >= 0 && target < WEFT_EXPORT_TARGETS ? helps[target] : NULL;
}

const char *weft_export_lut_name(int lut) { return lut >= 0 && lut < WEFT_EXPORT_LUTS ? luts[lut] : NULL; }

static bool is_prefix(const char *prefix) {
    size_t size = strlen(prefix);
    bool good = size <= 24 && !(size && is_digit(prefix[0]));
    for (size_t k = 0; k < size; k++) good &= is_name(prefix[k]);
    return good && strncmp(prefix, "gl_", 3) != 0 && !strstr(prefix, "__"); /* GLSL reserves these */
}

static WeftResult check_lobe(const WeftLobe *lobe, WeftError *error) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    if (!info) return fail(error, WEFT_MESSAGE_LOBE_NAME, "lobe", NULL);
    if (info->traits & WEFT_LOBE_REFERENCE) return fail(error, WEFT_MESSAGE_EXPORT_LOBE, info->id, NULL);
    return WEFT_OK;
}

static WeftResult check(const WeftExportDesc *desc, WeftError *error) {
    const char *model = "export";
    if (!desc || (desc->lobe != NULL) + (desc->profile != NULL || desc->material != NULL) != 1)
        return fail(error, WEFT_MESSAGE_DESC, model, "one of lobe, profile and material is needed");
    if ((unsigned)desc->target >= WEFT_EXPORT_TARGETS || (unsigned)desc->lut >= WEFT_EXPORT_LUTS)
        return fail(error, WEFT_MESSAGE_DESC, model, "unknown target or lut");
    if (desc->prefix && !is_prefix(desc->prefix))
        return fail(error, WEFT_MESSAGE_DESC, model, "a prefix that begins no name");
    if (desc->right && (!desc->lobe || desc->target != WEFT_EXPORT_SHADERTOY))
        return fail(error, WEFT_MESSAGE_DESC, model, "a second lobe is for shadertoy, beside a first");
    if (desc->ambient && (!desc->lobe || desc->target == WEFT_EXPORT_SHADERTOY))
        return fail(error, WEFT_MESSAGE_DESC, model, "the light of a map is for a lobe, and not for shadertoy");
    if (desc->cloth && !desc->material)
        return fail(error, WEFT_MESSAGE_DESC, model, "a cloth is that of a material, which is needed too");
    WeftResult result = desc->lobe ? check_lobe(desc->lobe, error) : WEFT_OK;
    return result == WEFT_OK && desc->right ? check_lobe(desc->right, error) : result;
}

/* Returns the lobe with its parameters clamped to their hard ranges, and choices rounded. */
static WeftLobe clamped(const WeftLobe *lobe) {
    WeftLobe out = *lobe;
    Lobe inner;
    if (lobe_of(lobe, &inner)) memcpy(out.params, inner.params, sizeof out.params);
    return out;
}

static WeftResult make_draft(Draft *draft, WeftError *error) {
    const WeftExportDesc *desc = draft->desc;
    WeftResult result = WEFT_OK;
    if (desc->lobe) {
        WeftLobe lobe = clamped(desc->lobe);
        draft_lobe(draft, &lobe, 0);
        if (desc->right && desc->right->lobe != desc->lobe->lobe) {
            lobe = clamped(desc->right);
            draft_lobe(draft, &lobe, 1);
        }
    } else {
        result = draft_material(draft, error);
    }
    return result == WEFT_OK ? draft_cut(draft, error) : result;
}

/* Writes what keeps a text from being included twice: the guard of C, with the headers that it needs, and of Unity's
 * HLSL; Unreal's texts have #pragma once. */
static void put_guard(const Draft *draft, bool open, Buffer *out) {
    char name[SPELL_NAME], bare[DRAFT_ID + 8];
    const WeftExportTarget target = draft->desc->target;
    if (target == WEFT_EXPORT_UNREAL && open) put_line(out, "#pragma once\n");
    if (target != WEFT_EXPORT_C && target != WEFT_EXPORT_UNITY) return;
    snprintf(bare, sizeof bare, "%s_H", draft->id[0]);
    spell_name(&draft->speller, ITEM_CONSTANT, bare, name);
    for (char *c = name; *c; c++) *c = (char)(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
    if (open)
        put_line(out, "#ifndef %s\n#define %s\n%s", name, name,
                 target == WEFT_EXPORT_C ? "\n#include <math.h>\n#include <stdbool.h>\n" : "");
    else
        put_line(out, "\n#endif");
}

/* Declares the precision of hashes, of which fragment shaders of GLSL ES keep 16 bits otherwise. */
static void put_precision(const Draft *drafts, int count, Buffer *out) {
    const Token hash = {TOKEN_NAME, "uint", 4};
    bool found = false;
    for (int d = 0; d < count; d++)
        for (int k = 0; k < drafts[d].items.count; k++) {
            const Item *item = &drafts[d].items.all[k];
            found |= item->kept && token_found(item->code, item->end, hash);
        }
    if (found && drafts->desc->target == WEFT_EXPORT_ESSL) put_line(out, "precision highp int;\n");
}

static void put_all(Draft *drafts, int count, const WeftExport *uploads, Buffer *out) {
    const Items *texts[WEFT_EXPORT_MODELS_MAX];
    const Token fetch = {TOKEN_NAME, "table_fetch", 11}; /* the function that draft_tables replaces */
    for (int d = 0; d < count; d++) {
        texts[d] = &drafts[d].items;
        for (int k = 0; k < drafts[d].items.count; k++)
            if (token_same(drafts[d].items.all[k].name, fetch)) drafts[d].items.all[k].kept = false;
    }
    drafts_merge(drafts, count);
    drafts_head(drafts, count, uploads, out);
    put_guard(drafts, true, out);
    put_precision(drafts, count, out);
    draft_tables(drafts, out);
    spell_helpers(&drafts->speller, texts, count, out);
    drafts_spell(drafts, count, out);
    if (drafts->desc->target == WEFT_EXPORT_SHADERTOY) draft_ball(drafts, out);
    for (int d = 0; d < count && drafts->desc->target == WEFT_EXPORT_UNITY; d++) draft_unity(&drafts[d], out);
    put_guard(drafts, false, out);
}

static bool same_words(const char *a, const char *b) { return strcmp(a ? a : "", b ? b : "") == 0; }

/* Checks that the models of one text agree in target, tables, pi and prefix, which its head states. */
static WeftResult check_all(const WeftExportDesc *descs, int count, WeftError *error) {
    const char *model = "export";
    if (!descs || count < 1 || count > WEFT_EXPORT_MODELS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, model, "takes 1 to %d models", WEFT_EXPORT_MODELS_MAX);
    for (int k = 0; k < count; k++) {
        WeftResult result = check(&descs[k], error);
        if (result != WEFT_OK) return result;
        if (descs[k].target != descs->target || descs[k].lut != descs->lut || !descs[k].fold_pi != !descs->fold_pi ||
            !same_words(descs[k].prefix, descs->prefix))
            return fail(error, WEFT_MESSAGE_DESC, model, "one text has one target, lut, prefix and pi");
    }
    if (count > 1 && descs->target == WEFT_EXPORT_SHADERTOY)
        return fail(error, WEFT_MESSAGE_DESC, model, "a shadertoy shows one model, or two lobes");
    return WEFT_OK;
}

static WeftResult make_drafts(Draft *drafts, int count, WeftError *error) {
    for (int k = 0; k < count; k++) {
        WeftResult result = make_draft(&drafts[k], error);
        if (result != WEFT_OK) return result;
        for (int j = 0; j < k; j++)
            if (strcmp(drafts[j].id[0], drafts[k].id[0]) == 0)
                return fail(error, WEFT_MESSAGE_DESC, drafts[k].id[0], "two models go by that name");
        if (k + 1 < count) draft_begin(&drafts[k + 1], drafts[k + 1].desc, drafts[k].tables);
    }
    return WEFT_OK;
}

WeftResult weft_export_all(const WeftExportDesc *descs, int count, WeftExport *out, WeftError *error) {
    Buffer text = {0};
    DraftTables tables = {.count = 0};
    *out = (WeftExport){0};
    WeftResult result = check_all(descs, count, error);
    if (result != WEFT_OK) return result;
    Draft *drafts = alloc_array((size_t)count, sizeof *drafts);
    if (!drafts) return fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    memset(drafts, 0, (size_t)count * sizeof *drafts);
    for (int k = 0; k < count; k++) drafts[k].desc = &descs[k];
    draft_begin(drafts, descs, &tables);
    result = make_drafts(drafts, count, error);
    if (result == WEFT_OK) result = draft_tables_fit(drafts, error);
    if (result == WEFT_OK) result = draft_uploads(drafts, out, error);
    if (result == WEFT_OK) {
        put_all(drafts, count, out, &text);
        if (text.failed) result = fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    }
    for (int k = 0; k < count; k++) draft_free(&drafts[k]);
    free(drafts);
    if (result == WEFT_OK) {
        out->text = text.bytes; /* free() releases the whole buffer */
        out->size = text.size;
        text.bytes = NULL;
    } else {
        weft_export_free(out);
    }
    buffer_free(&text);
    return result;
}

WeftResult weft_export(const WeftExportDesc *desc, WeftExport *out, WeftError *error) {
    return weft_export_all(desc, 1, out, error);
}

void weft_export_free(WeftExport *text) {
    if (!text) return;
    free(text->text);
    for (int k = 0; k < text->table_count; k++) weft_image_free(&text->tables[k].texels);
    *text = (WeftExport){0};
}
