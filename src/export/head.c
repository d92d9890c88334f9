/* head.c - the comment that a text begins with: model, licence, conventions, and how to call it */
#include <stdio.h>

#include "base/printable.h"
#include "export/draft.h"

#include "weave/cloth_base.h"

/* Returns the target's type for a direction. */
static const char *vector(const Draft *draft) {
    if (draft->desc->target == WEFT_EXPORT_WGSL) return "vec3f";
    return draft_is_hlsl(draft) ? "float3" : "vec3";
}

/* Returns the qualifier that declares a variable of that type. */
static const char *word(const Draft *draft, const char *type) {
    return draft->desc->target == WEFT_EXPORT_WGSL ? "let" : type;
}

static char *function(const Draft *draft, const char *end, char name[SPELL_NAME]) {
    char bare[DRAFT_ID + 16];
    snprintf(bare, sizeof bare, "%s_%s", draft->id[0], end);
    return spell_item(&draft->speller, &draft->items, ITEM_FUNCTION, bare, name);
}

static void put_conventions(const Draft *draft, Buffer *out) {
    buffer_put_text(out,
                    " *\n * Conventions: directions are unit vectors in the shading frame: +z the normal, +x the "
                    "tangent,\n"
                    " * +y the bitangent. wo points to the viewer, wi to the light, both away from the surface.\n"
                    " * Colours are linear Rec. 709. Angles are radians. E(cos_o), the albedo, is the part of the\n"
                    " * light from wo that is reflected at all.\n");
    if (draft->desc->fold_pi)
        buffer_put_text(out,
                        " * pi: FOLDED. What is returned is multiplied by pi. The unit of a light is what a white\n"
                        " * Lambertian surface that faces it sends back: light = irradiance / pi, as engines "
                        "without 1/pi\n"
                        " * in their Lambert have it. For lights in W/m^2 export with --light-pi explicit; both "
                        "give one\n"
                        " * picture.\n");
    else
        buffer_put_text(
            out, " * pi: EXPLICIT. f has its 1/pi inside (1/sr), and a light is the irradiance of a surface that\n"
                 " * faces it (W/m^2). Where a white Lambertian surface shows a light as bright as its number, "
                 "the\n"
                 " * light's unit has the 1/pi inside: multiply by pi, or export with --light-pi folded; both "
                 "give\n"
                 " * one picture.\n");
}

/* Writes the line that sees a cloth. */
static void put_seen(const Draft *draft, Buffer *out) {
    char record[SPELL_NAME], name[SPELL_NAME];
    spell_item(&draft->speller, &draft->items, ITEM_RECORD, "WeaveSeen", record);
    put_line(out, " *   %s seen = %s(s, uv.x, uv.y, dx.x, dx.y, dy.x, dy.y, 1); // once for all lights",
             word(draft, record), function(draft, "see", name));
}

/* Says where a cloth lies, and what of it the text leaves out. */
static void put_cloth(const Draft *draft, Buffer *out) {
    const WeavePlacing p = cloth_placing(draft->desc->cloth);
    put_line(
        out,
        " *\n * Cloth: a unit of u spans %g warp threads and a unit of v %g picks; scale uv to change that. v runs",
        (double)p.warps, (double)p.picks);
    put_line(out,
             " * down and +y of the frame against it, as in glTF. dx and dy are the steps of uv to the next pixel,");
    put_line(out,
             " * as dFdx(uv) and dFdy(uv). A pixel of one point goes over to the cloth from afar from 0.25 threads");
    put_line(out,
             " * on; where you average several points of a pixel, give their number in place of 1: then from 0.85.");
    put_line(out, " * seen.covers is the part that threads cover: light of gaps is black, so blend it premultiplied.");
    put_line(out, " * Left out: the back, where the front's threads are seen; hair and normal maps of the mesh.");
}

static void put_call(const Draft *draft, Buffer *out) {
    char a[SPELL_NAME], b[SPELL_NAME], record[SPELL_NAME];
    const WeftExportDesc *desc = draft->desc;
    bool c = desc->target == WEFT_EXPORT_C;
    const char *type = vector(draft);
    if (desc->target == WEFT_EXPORT_SHADERTOY) return;
    put_line(out, " *\n * Example: %s", draft->id[0]);
    if (c) {
        put_line(out, " *   %s wo = {0.6f, 0.0f, 0.8f}, wi = {-0.48f, 0.64f, 0.6f};",
                 spell_name(&draft->speller, ITEM_RECORD, "Dir", a));
    } else {
        put_line(out, " *   %s wo = %s(dot(v, t), dot(v, b), dot(v, n)); // t, b, n: the frame", word(draft, type),
                 type);
        put_line(out, " *   %s wi = %s(dot(l, t), dot(l, b), dot(l, n));", word(draft, type), type);
    }
    if (!desc->lobe) {
        spell_item(&draft->speller, &draft->items, ITEM_RECORD, "Surface", record);
        put_line(out, " *   %s s = %s();", desc->target == WEFT_EXPORT_WGSL ? "var" : record,
                 function(draft, "surface", a));
        if (desc->cloth) put_seen(draft, out);
        put_line(out, " *   %s f_cos = %s(s, %swo, wi); // times the light",
                 c ? spell_name(&draft->speller, ITEM_RECORD, "Rgb", record) : word(draft, type),
                 function(draft, "shade", b), desc->cloth ? "seen, " : "");
        return;
    }
    bool two = weft_lobe_info(desc->lobe->lobe)->traits & WEFT_LOBE_TWO_COLORS;
    bool rough = draft_lobe_rough(desc->lobe);
    spell_name(&draft->speller, ITEM_RECORD, draft_lobe_record(desc->lobe->lobe), record);
    put_line(out, " *   %s m = %s(%s);", word(draft, record), function(draft, rough ? "rough" : "default", a),
             rough ? (c ? "0.5f" : "0.5") : "");
    if (c) {
        spell_name(&draft->speller, ITEM_RECORD, "Rgb", record);
        put_line(out, " *   %s color = {0.5f, 0.1f, 0.1f}%s, f = %s(m, color, %swo, wi);", record,
                 two ? ", second = {1.0f, 1.0f, 1.0f}" : "", function(draft, "eval", b), two ? "second, " : "");
    } else {
        put_line(out, " *   %s sent = %s(m, color, %swo, wi) * max(wi.z, 0.0) * light;", word(draft, type),
                 function(draft, "eval", b), two ? "second, " : "");
    }
    put_line(out, " *   %s drawn = %s(m, wo, u, v); // u, v in [0, 1); z <= 0: no sample",
             c ? spell_name(&draft->speller, ITEM_RECORD, "Dir", record) : word(draft, type),
             function(draft, "sample", a));
    put_line(out, " *   %s pdf = %s(m, wo, drawn);", word(draft, "float"), function(draft, "pdf", a));
    if (desc->albedo || desc->ambient)
        put_line(out, " *   %s e = %s(m, wo.z);", word(draft, "float"), function(draft, "albedo", a));
    if (!desc->ambient) return;
    put_line(out, " * An environment map: look k, 0 to 6, is its mean about %s(m, wo, k),",
             function(draft, "ambient_axis", a));
    put_line(out, " * weighted by exp(kappa (mu - 1)) with kappa = %s(m, wo, k), or by",
             function(draft, "ambient_kappa", a));
    put_line(out, " * max(mu, 0) where kappa is 0; mu: the cosine to the axis.");
    put_line(out, " *   %s lit = %s(m, color, wo, look0, ... look6);",
             c ? spell_name(&draft->speller, ITEM_RECORD, "Rgb", record) : word(draft, type),
             function(draft, "ambient", b));
}

static void put_unreal(const Draft *draft, const char *name, Buffer *out) {
    put_line(out, " *\n * Unreal: save this as Shaders/%s.ush of a plugin or project and map that folder with",
             draft->id[0]);
    put_line(out, " * AddShaderSourceDirectoryMapping. In a Custom node put /Project/%s.ush in Include File Paths and",
             draft->id[0]);
    put_line(out, " * call %s in Code; for a shading model of your own include it in", name);
    put_line(out, " * ShadingModels.ush and call it in its BxDF with V and L turned into the frame of "
                  "GBuffer.WorldNormal:");
    put_line(out, " * Unreal's lights are explicit. Its x is GBuffer.WorldTangent.");
}

static void put_unity(const Draft *draft, const char *name, Buffer *out) {
    put_line(out, " *\n * Unity: save this as %s.hlsl below Assets. Shader Graph: a Custom Function node of type File",
             draft->id[0]);
    put_line(out, " * whose function, void Name_float(..., out float3 Out), calls %s; behind an", name);
    put_line(out, " * #include of this file. HDRP, URP: include it behind Lighting.hlsl and add it to the "
                  "loop over lights.");
    put_line(out, " * HDRP's lights are explicit; URP's and the built-in pipeline's are folded.");
}

/* Says how a Custom Function node takes the text, which has its functions. */
static void put_node(const Draft *draft, Buffer *out) {
    char name[SPELL_NAME];
    put_line(out, " *\n * Unity: save this as %s.hlsl below Assets. Shader Graph: a Custom Function node of type File,",
             draft->id[0]);
    put_line(out, " * this file as its source, name %s, inputs and outputs as of %s_float at the end.",
             spell_name(&draft->speller, ITEM_FUNCTION, draft->id[0], name), name);
    put_line(out, " * HDRP's lights are explicit; URP's and the built-in pipeline's are folded.");
}

static void put_godot(const Draft *draft, const char *name, Buffer *out) {
    put_line(out,
             " *\n * Godot 4: save this as %s.gdshaderinc beside a shader of type spatial and include it there. In its",
             draft->id[0]);
    put_line(out, " * light() turn VIEW and LIGHT into the frame of NORMAL and a tangent that a varying brings, call");
    put_line(out, " * %s and add the result times LIGHT_COLOR times ATTENUATION to SPECULAR_LIGHT, which", name);
    put_line(out,
             " * ALBEDO does not multiply. LIGHT_COLOR has a factor of pi: export with --light-pi explicit. Set the");
    put_line(out, " * tables as parameters of the material.");
}

/* Says how engines take the text. */
static void put_engines(const Draft *draft, Buffer *out) {
    char name[SPELL_NAME];
    const WeftExportTarget target = draft->desc->target;
    function(draft, draft->desc->lobe ? "eval" : "shade", name);
    if (target == WEFT_EXPORT_HLSL || target == WEFT_EXPORT_UNREAL) put_unreal(draft, name, out);
    if (target == WEFT_EXPORT_HLSL) put_unity(draft, name, out);
    if (target == WEFT_EXPORT_UNITY) put_node(draft, out);
    if (target == WEFT_EXPORT_GODOT) put_godot(draft, name, out);
}

static void put_tables(const WeftExport *uploads, bool bound, Buffer *out) {
    if (!uploads->table_count) return;
    put_line(out, " *\n * Tables: one channel of 32 bit floats or 16 bit unorms, nothing filtered, no sRGB, "
                  "no mipmaps; row 0");
    put_line(out, " * is the first of the file. The text fetches texels and interpolates them itself.");
    for (int k = 0; k < uploads->table_count; k++)
        put_line(out, " *   %s, %d x %d", uploads->tables[k].name, uploads->tables[k].texels.width,
                 uploads->tables[k].texels.height);
    if (!bound) return;
    put_line(out, " * Each is a texture of sample type unfilterable-float, bound where its @group and @binding say:");
    put_line(out, " * change those as your layout has it.");
}

/* Names the model, without characters that could end the comment. */
static void put_model(const WeftExportDesc *desc, Buffer *out) {
    const char *what = desc->lobe      ? weft_lobe_info(desc->lobe->lobe)->id
                       : desc->profile ? desc->profile
                                       : (desc->name ? desc->name : "material");
    char safe[DRAFT_ID + 16];
    snprintf(safe, sizeof safe, "%.70s", what);
    for (char *k = safe; *k; k++)
        if (*k == '*' || (unsigned char)*k < ' ') *k = '_';
    make_printable(safe);
    buffer_put_text(out, safe);
    if (!desc->right) return;
    buffer_put_text(out, " | ");
    buffer_put_text(out, weft_lobe_info(desc->right->lobe)->id);
}

void drafts_head(const Draft *drafts, int count, const WeftExport *uploads, Buffer *out) {
    static const char *const languages[WEFT_EXPORT_TARGETS] = {
        "GLSL 3.30 core and later; goes behind your #version",
        "GLSL ES 3.00; goes behind #version 300 es and precision highp float;",
        "HLSL, shader model 5 and later",
        "C99 and C++",
        "Shadertoy: paste all of it into a new shader",
        "WGSL, the language of WebGPU",
        "Godot 4: a .gdshaderinc",
        "Unity: HLSL for a Custom Function node",
        "Unreal: a .ush",
    };
    buffer_put_text(out, "/* ");
    for (int k = 0; k < count; k++) {
        if (k) buffer_put_text(out, ", ");
        put_model(drafts[k].desc, out);
    }
    put_line(out, " - for %s", languages[drafts->desc->target]);
    put_line(out, " *");
    put_line(out, " * Made by weft %s from its catalogue of cloth-shading models.", weft_version());
    put_line(out, " * SPDX-License-Identifier: MIT");
    put_line(out, " * Copyright (c) 2026 The weft maintainers");
    put_conventions(drafts, out);
    for (int k = 0; k < count; k++) put_call(&drafts[k], out);
    for (int k = 0; k < count; k++)
        if (drafts[k].desc->cloth) put_cloth(&drafts[k], out);
    put_engines(drafts, out);
    put_tables(uploads, drafts->desc->target == WEFT_EXPORT_WGSL, out);
    put_line(out, " */");
}
