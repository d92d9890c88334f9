/* ball.c - the picture of a Shadertoy: a lit ball for one model, or two halves for two lobes
 *
 * The picture is our own work. The mouse moves one light; a second, faint one behind the ball shows the rim. Both are
 * distant. Tone: sRGB of the radiance, clamped. Of a cloth the mouse, up and down, sets how far away it is. */
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "text/passes/types.h"
#include "text/source/number_text.h"
#include "weave/cloth_base.h"

static const char scene_begin[] =
    "/* A ball fills most of the picture's height, or of its half. Radiance towards the viewer, of\n"
    " * one distant light of irradiance `light`. */\n"
    "vec3 lit(bool right, float roughness, vec3 n, vec3 v, vec3 l, vec3 light) {\n"
    "    vec3 t = normalize(cross(vec3(0.0, 1.0, 0.0), n) + vec3(1e-6, 0.0, 0.0)), b = cross(n, t);\n"
    "    vec3 wo = vec3(dot(v, t), dot(v, b), dot(v, n)), wi = vec3(dot(l, t), dot(l, b), dot(l, n));\n"
    "    return shown(right, roughness, wo, wi) * light;\n"
    "}\n"
    "\n"
    "void mainImage(out vec4 pixel, in vec2 at) {\n"
    "    vec2 mouse = iMouse.z > 0.0 || iMouse.x + iMouse.y > 0.0\n"
    "                     ? iMouse.xy / iResolution.xy : vec2(0.5 + 0.35 * sin(iTime), 0.5);\n"
    "    float roughness = mix(0.15, 1.0, clamp(mouse.y, 0.0, 1.0)); /* up and down */\n"
    "    float azimuth = 6.2831853 * (mouse.x - 0.5);                /* left and right */\n"
    "    vec3 l = normalize(vec3(sin(azimuth), 0.55, cos(azimuth)));\n"
    "    bool right = halves && at.x > 0.5 * iResolution.x;\n"
    "    vec2 size = vec2(halves ? 0.5 : 1.0, 1.0) * iResolution.xy;\n"
    "    vec2 q = (at - vec2(right ? size.x : 0.0, 0.0) - 0.5 * size) / (0.44 * min(size.x, size.y));\n"
    "    vec3 color = vec3(0.022 + 0.02 * at.y / iResolution.y);\n"
    "    if (dot(q, q) < 1.0) {\n";

static const char scene_end[] =
    "        vec3 n = vec3(q, sqrt(1.0 - dot(q, q))), v = vec3(0.0, 0.0, 1.0);\n"
    "        color = lit(right, roughness, n, v, l, sun) +\n"
    "                lit(right, roughness, n, v, normalize(vec3(-0.5, 0.3, -0.8)), 0.4 * sun);\n"
    "    }\n"
    "    if (halves && abs(at.x - 0.5 * iResolution.x) < 1.0) color = vec3(0.25);\n"
    "    color = clamp(color, 0.0, 1.0);\n"
    "    vec3 high = 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055;\n"
    "    pixel = vec4(mix(12.92 * color, high, step(0.0031308, color)), 1.0);\n"
    "}\n";

static char *named(const Draft *draft, ItemKind kind, const char *id, const char *end, char name[SPELL_NAME]) {
    char bare[DRAFT_ID + 16];
    snprintf(bare, sizeof bare, "%s%s", id, end);
    return spell_name(&draft->speller, kind, bare, name);
}

/* Writes the statements that return f times the cosine of a lobe. */
static void put_lobe(const Draft *draft, const WeftLobe *lobe, const char *id, const char *indent, Buffer *out) {
    char record[SPELL_NAME], make[SPELL_NAME], eval[SPELL_NAME];
    bool two = weft_lobe_info(lobe->lobe)->traits & WEFT_LOBE_TWO_COLORS, rough = draft_lobe_rough(lobe);
    put_line(out, "%s%s m = %s(%s);", indent,
             spell_name(&draft->speller, ITEM_RECORD, draft_lobe_record(lobe->lobe), record),
             named(draft, ITEM_FUNCTION, id, rough ? "_rough" : "_default", make), rough ? "roughness" : "");
    put_line(out, "%sreturn %s(m, cloth, %swo, wi) * max(wi.z, 0.0);", indent,
             named(draft, ITEM_FUNCTION, id, "_eval", eval), two ? "vec3(1.0), " : "");
}

/* Writes the statements that see a cloth, whose threads lie on the ball as seen from the front: the mouse goes from 8 of
 * them between its middle and its rim to 400. */
static void put_seen(const Draft *draft, Buffer *out) {
    char record[SPELL_NAME], see[SPELL_NAME];
    put_line(out, "    float per = 8.0 * pow(50.0, (roughness - 0.15) / 0.85) / %s;",
             number(cloth_placing(draft->desc->cloth).warps).text);
    put_line(out, "    %s seen = %s(s, spot.x * per, -spot.y * per, spot.z * per, 0.0, 0.0, spot.z * per, 1);",
             spell_name(&draft->speller, ITEM_RECORD, "WeaveSeen", record),
             named(draft, ITEM_FUNCTION, draft->id[0], "_see", see));
}

void draft_ball(const Draft *draft, Buffer *out) {
    const WeftExportDesc *desc = draft->desc;
    char record[SPELL_NAME], make[SPELL_NAME], shade[SPELL_NAME];
    bool halves = desc->right && desc->right->lobe != desc->lobe->lobe;
    put_line(out, "\n/* Here the picture begins. */\n");
    put_line(out, "const vec3 cloth = vec3(0.82, 0.3, 0.24); /* colour of the cloth */");
    put_line(out, "const vec3 sun = vec3(%s);", desc->fold_pi ? "1.0" : "3.14159265");
    put_line(out, "const bool halves = %s;", halves ? "true" : "false");
    if (desc->cloth) put_line(out, "vec3 spot; /* the place on the ball, and the width of a pixel there */");
    put_line(out, "\n/* Shades with the model of the left or of the right half. */");
    put_line(out, "vec3 shown(bool right, float roughness, vec3 wo, vec3 wi) {");
    if (halves) {
        put_line(out, "    if (right) {");
        put_lobe(draft, desc->right, draft->id[1], "        ", out);
        put_line(out, "    }");
    }
    if (desc->lobe) {
        put_lobe(draft, desc->lobe, draft->id[0], "    ", out);
    } else {
        put_line(out, "    %s s = %s();", spell_name(&draft->speller, ITEM_RECORD, "Surface", record),
                 named(draft, ITEM_FUNCTION, draft->id[0], "_surface", make));
        if (desc->profile) draft_ball_inputs(draft, out);
        if (desc->cloth) put_seen(draft, out);
        put_line(out, "    return %s(s, %swo, wi);", named(draft, ITEM_FUNCTION, draft->id[0], "_shade", shade),
                 desc->cloth ? "seen, " : "");
    }
    put_line(out, "}\n");
    buffer_put_text(out, scene_begin);
    if (desc->cloth) put_line(out, "        spot = vec3(q, 1.0 / (0.44 * min(size.x, size.y)));");
    buffer_put_text(out, scene_end);
}

/* Writes inputs of a cloth of two colours, whose roughness the mouse sets; an engine's defaults have no sheen. */
void draft_ball_inputs(const Draft *draft, Buffer *out) {
    static const char *const lines[][2] = {
        {"base_color", "    s.base_color = 0.5 * cloth;"},
        {"roughness", "    s.roughness = max(roughness, 0.4);"},
        {"sheen_color", "    s.sheen_color = cloth;"},
        {"sheen_roughness", "    s.sheen_roughness = roughness;"},
        {"sheen", "    s.sheen = 1.0;"},
    };
    const Token surface = {TOKEN_NAME, "Surface", 7};
    for (size_t k = 0; k < sizeof lines / sizeof lines[0]; k++) {
        const Token input = {TOKEN_NAME, lines[k][0], strlen(lines[k][0])};
        if (types_member(&draft->items, surface, input).kind == TOKEN_NAME) put_line(out, "%s", lines[k][1]);
    }
}
