#include "weft/export.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "export/draft.h"

static const char *const targets[WEFT_EXPORT_TARGETS + 1] = {"glsl", "essl", "hlsl", "c", "shadertoy", NULL};
static const char *const helps[WEFT_EXPORT_TARGETS] = {
    "functions for GLSL 3.30 core and later",
    "functions for GLSL ES 3.00: OpenGL ES 3, WebGL 2",
    "functions for HLSL, shader model 5 and later: Unreal, Unity",
    "one header for C99 and C++ that stands alone",
    "a complete shader to paste: a ball, the mouse moves roughness and light",
};
static const char *const luts[WEFT_EXPORT_LUTS + 1] = {"c", "png16", "exr", "dds", "npy", NULL};

const char *weft_export_target(int target) {
    return target >= 0 && target < WEFT_EXPORT_TARGETS ? targets[target] : NULL;
}

const char *weft_export_target_help(int target) {
    return target >= 0 && target < WEFT_EXPORT_TARGETS ? helps[target] : NULL;
}

const char *weft_export_lut(int lut) { return lut >= 0 && lut < WEFT_EXPORT_LUTS ? luts[lut] : NULL; }

static bool is_prefix(const char *prefix) {
    size_t size = strlen(prefix);
    bool good = size <= 24 && !(size && is_digit(prefix[0]));
    for (size_t k = 0; k < size; k++) good &= is_name(prefix[k]);
    return good && strncmp(prefix, "gl_", 3) != 0 && !strstr(prefix, "__"); /* GLSL keeps those for itself */
}

static WeftResult check_lobe(const WeftLobe *lobe, WeftError *error) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    if (!info) return fail(error, WEFT_MESSAGE_LOBE_NAME, "lobe", NULL);
    if (info->traits & WEFT_LOBE_REFERENCE) return fail(error, WEFT_MESSAGE_EXPORT_LOBE, info->id, NULL);
    return WEFT_OK;
}

static WeftResult check(const WeftExportDesc *desc, WeftError *error) {
    const char *subject = "export";
    if (!desc || (desc->lobe != NULL) + (desc->profile != NULL || desc->material != NULL) != 1)
        return fail(error, WEFT_MESSAGE_DESC, subject, "one of lobe, profile and material is needed");
    if ((unsigned)desc->target >= WEFT_EXPORT_TARGETS || (unsigned)desc->lut >= WEFT_EXPORT_LUTS)
        return fail(error, WEFT_MESSAGE_DESC, subject, "a target or lut that there is not");
    if (desc->prefix && !is_prefix(desc->prefix))
        return fail(error, WEFT_MESSAGE_DESC, subject, "a prefix that begins no name");
    if (desc->right && (!desc->lobe || desc->target != WEFT_EXPORT_SHADERTOY))
        return fail(error, WEFT_MESSAGE_DESC, subject, "a second lobe is for shadertoy, beside a first");
    WeftResult result = desc->lobe ? check_lobe(desc->lobe, error) : WEFT_OK;
    return result == WEFT_OK && desc->right ? check_lobe(desc->right, error) : result;
}

/* With its parameters in their hard range, and choices whole. */
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

/* In C the header guards itself, and includes what it calls. */
static void put_guard(const Draft *draft, bool open, Buffer *out) {
    char name[SPELL_NAME], plain[DRAFT_ID + 8];
    if (draft->desc->target != WEFT_EXPORT_C) return;
    snprintf(plain, sizeof plain, "%s_H", draft->id[0]);
    spell_name(&draft->speller, ITEM_CONSTANT, plain, name);
    for (char *c = name; *c; c++) *c = (char)(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
    if (open)
        put_line(out, "#ifndef %s\n#define %s\n\n#include <math.h>\n#include <stdbool.h>\n", name, name);
    else
        put_line(out, "\n#endif");
}

static void put_all(Draft *draft, const WeftExport *uploads, Buffer *out) {
    draft_head(draft, uploads, out);
    put_guard(draft, true, out);
    draft_tables(draft, out);
    for (int k = 0; k < draft->items.count; k++) /* its place is taken */
        if (token_is(draft->items.all[k].name, "table_fetch")) draft->items.all[k].kept = false;
    spell_items(&draft->speller, &draft->items, out);
    if (draft->desc->target == WEFT_EXPORT_SHADERTOY) draft_ball(draft, out);
    put_guard(draft, false, out);
}

WeftResult weft_export(const WeftExportDesc *desc, WeftExport *out, WeftError *error) {
    Draft draft;
    Buffer text = {0};
    *out = (WeftExport){0};
    WeftResult result = check(desc, error);
    if (result != WEFT_OK) return result;
    draft_begin(&draft, desc);
    result = make_draft(&draft, error);
    if (result == WEFT_OK) result = draft_uploads(&draft, out, error);
    if (result == WEFT_OK) {
        put_all(&draft, out, &text);
        if (text.failed) result = fail(error, WEFT_MESSAGE_MEMORY, "text", NULL);
    }
    draft_free(&draft);
    if (result == WEFT_OK) {
        out->text = text.bytes; /* which free() releases, as all of a buffer */
        out->size = text.size;
        text.bytes = NULL;
    } else {
        weft_export_free(out);
    }
    buffer_free(&text);
    return result;
}

void weft_export_free(WeftExport *text) {
    if (!text) return;
    free(text->text);
    for (int k = 0; k < text->table_count; k++) weft_image_free(&text->tables[k].texels);
    *text = (WeftExport){0};
}
