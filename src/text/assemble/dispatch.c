#include <stdio.h>
#include <stdlib.h>

#include "text/assemble/dispatch.h"

#include "shading/lobe/lobe_tables.h"
#include "shading/material/dust.h"
#include "shading/stack/slots.h"
#include "text/assemble/outside_text.h"
#include "text/assemble/tables.h"
#include "weft/lobe.h"

static bool has(int id, unsigned trait) { return weft_lobe_info(id)->traits & trait; }

void text_lobe(Text *text, int id) {
    char file[128];
    if (has(id, TRAIT_TABLE)) {
        lobe_tables_make_for(id);
        text_lobe_tables(text);
    }
    snprintf(file, sizeof file, "shading/lobes/%s.h", lobe_names(id)->prefix);
    text_include(text, file);
}

bool text_weight_is_cosine(int id) {
    const OutsideLobe *lobe = outside_lobe(id);
    char file[128];
    snprintf(file, sizeof file, "lobes/%s.h", lobe_names(id)->prefix);
    const char *text = lobe ? lobe->text : weft_catalogue_text(file);
    return strstr(text, "fresnel_weight_of_cosine(") || strstr(text, "term_f(");
}

/* Returns the lobe whose LOBE_ constant a line names, in code or a comment, or -1. */
static int owner_of(const char *c, const char *end) {
    for (; c + 5 < end; c++) {
        if (is_name(*c) && memcmp(c, "LOBE_", 5) == 0) {
            const char *name = c + 5;
            Token token = token_next(&name, end);
            for (int id = 0; id < LOBE_COUNT; id++)
                if (token_is(token, lobe_names(id)->macros)) return id;
        }
        while (c < end && is_name(*c)) c++;
    }
    return -1;
}

/* Defines the macro of a line "#define NAME number". */
static void define_line(Text *text, const char *c, const char *end) {
    char name[96], value[16];
    if (!token_is(token_solid(&c, end), "#") || !token_is(token_solid(&c, end), "define")) return;
    Token from = token_solid(&c, end), to = token_solid(&c, end);
    snprintf(name, sizeof name, "%.*s", (int)from.size, from.at);
    snprintf(value, sizeof value, "%.*s", (int)to.size, to.at);
    text_define(text, name, value);
}

/* Writes the lines of a generated file that belong to no lobe or to one of `there`; the ids of others become macros.
 * Only lines from the first that contains `first` (NULL: from the top) to before `last` (NULL: to the end). An empty
 * comment replaces a removed line, so that the others keep their line numbers. */
static void put_lines(Text *text, const char *file, const char *first, const char *last, const bool there[LOBE_MOST]) {
    Buffer chosen = {0};
    text_outside_lines(text, there);
    const char *c = weft_catalogue_text(file + strlen("shading/")), *end = c + strlen(c);
    const char *from = first ? strstr(c, first) : c, *to = last ? strstr(c, last) : end;
    for (const char *stop; c < to; c = stop) {
        stop = memchr(c, '\n', (size_t)(end - c));
        stop = stop ? stop + 1 : end;
        int id = owner_of(c, stop);
        bool stays = c >= from && (id < 0 || there[id]);
        const char *mark = c;
        while (stays && mark < stop && (id < 0 || memcmp(mark, "/* LOBE_", 8) != 0)) mark++;
        if (c >= from && !stays) define_line(text, c, stop);
        buffer_put(&chosen, c, (size_t)(mark - c));
        if (mark < stop) buffer_put_text(&chosen, "//\n");
    }
    text_source(text, file, &chosen);
    buffer_free(&chosen);
}

void text_slots(Text *text, const TextSlot slots[SLOT_COUNT], bool sampled) {
#define SLOT_NAMES(name, NAME, Name, wo)                                                                               \
    {#Name "Prepared", #Name "View", #name "_prepare", #name "_view", #name "_reflect", #name "_sample_at"},
    static const char *const names[] = {"LobePrepared", "LobeView",     "lobe_prepare",
                                        "lobe_view",    "lobe_reflect", "lobe_sample_at"};
    enum { NAMES = sizeof names / sizeof *names };
    static const char *const own[SLOT_COUNT][NAMES] = {SLOTS(SLOT_NAMES)};
    for (int k = 0; k < SLOT_COUNT; k++) {
        bool there[LOBE_MOST] = {false};
        for (int j = 0; j < slots[k].count; j++) there[slots[k].lobes[j]] = true;
        for (int n = 0; n < NAMES; n++) text_define(text, names[n], own[k][n]);
        put_lines(text, "shading/lobes.gen.h", "UNION(LobePrepared)", NULL, there);
        put_lines(text, "shading/dispatch.gen.h", "LOBE_FN void lobe_prepare(", "/* The view is that", there);
        put_lines(text, "shading/dispatch.gen.h", "LOBE_FN void lobe_reflect(", "/* A wi for", there);
        if (sampled)
            put_lines(text, "shading/dispatch.gen.h", "LOBE_FN void lobe_sample_at(", "/* For one pair", there);
        for (int n = 0; n < NAMES; n++) text_undefine(text, names[n]);
    }
    text_define(text, "OF_SLOT(Name, Record)", "Name##Record");
    text_define(text, "IN_SLOT(name, function)", "name##_##function");
}

/* Provides shading/material/dust_lobe.h for a text without the lobe of dust. */
static void put_no_dust(Text *text) {
    if (!text_provide(text, "shading/material/dust_lobe.h")) return;
    text_line(text, "\nfloat dust_weight(float dust, float e_1, float cos_o) { return 0.0; }\n"
                    "float dust_albedo(Lobe m, float cos_o) { return 0.0; }");
}

void text_dispatch(Text *text, const int *lobes, int lobe_count) {
    bool there[LOBE_MOST] = {false}, tinted = false, cosine = false;
    for (int k = 0; k < lobe_count; k++) {
        there[lobes[k]] = true;
        tinted |= has(lobes[k], TRAIT_TINTED);
        cosine |= text_weight_is_cosine(lobes[k]);
        lobe_tables_make_for(lobes[k]); /* before text_lobe_tables, which writes all that are made */
    }
    for (int k = 0; k < lobe_count; k++)
        if (has(lobes[k], TRAIT_TABLE)) text_lobe_tables(text);
    if (!cosine) text_define(text, "FRESNEL_WEIGHT_IS_COSINE(s)", "false");
    if (!tinted) text_define(text, "IS_TINTED(t)", "false");
    text_include(text, "shading/lobe/lobe.h");
    text_outside(text, there);
    put_lines(text, "shading/lobe_ids.gen.h", NULL, NULL, there);
    put_lines(text, "shading/lobes.gen.h", NULL, NULL, there);
    text_provide(text, "shading/lobes.gen.h");
    put_lines(text, "shading/dispatch.gen.h", NULL, NULL, there);
    text_provide(text, "shading/catalogue/registry.h");
    text_line(text, "\nfloat lobe_f(Lobe m, Angles a) { return lobe_value(m, a).f; }\n"
                    "float lobe_fresnel_weight(Lobe m, Angles a) { return lobe_value(m, a).s; }\n"
                    "float lobe_pdf(Lobe m, Angles a) { return lobe_value(m, a).pdf; }");
    if (!there[DUST_LOBE]) put_no_dust(text);
}
