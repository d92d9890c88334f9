/* material.c - a profile, a workflow or a material as two functions: its inputs, and f times the cosine */
#include <stdio.h>
#include <stdlib.h>

#include "export/draft.h"

#include "base/fail.h"
#include "export/sheen.h"
#include "scene/material/material_numbers.h"
#include "shading/material/choice.h"
#include "text/assemble/composition.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"
#include "weave/weft_cloth.h"

typedef struct Rule {
    const char *id, *base, *needs_wi, *needs_average, *by;
} Rule;

#define RULE(id, index, base, needs_wi, needs_average, conserves, by, help) {id, #base, #needs_wi, #needs_average, #by},
static const Rule rules[] = {WEFT_LAYERS(RULE)};

typedef struct ExportModel {
    Material material;
    Surface surface;
    Choices choices;
    bool zero[INPUT_COUNT]; /* inputs that are 0 for all surfaces */
    Stack stack;            /* of the choices */
    bool one_layer;         /* the layer rule is equal for all surfaces */
    bool chosen;            /* a choice is made beside the profile */
    CompositionSlots slots;
    AlbedoTable *table; /* of E of the sheen; NULL: the text reads none */
    bool woven, bare;   /* the base is a cloth; nothing is above it */
} ExportModel;

/* Makes the material of a profile or workflow by id. */
static WeftResult find_profile(const char *id, Material *out, WeftError *error) {
    int profile = choice_find(CHOICE_profile, id), workflow = choice_find(CHOICE_workflow, id);
    *out = material_default();
    if (profile > 0)
        material_choose(out, CHOICE_profile, profile);
    else if (workflow >= 0)
        material_choose(out, CHOICE_workflow, workflow);
    else
        return fail(error, WEFT_MESSAGE_CHECK_NAME, id, NULL);
    return WEFT_OK;
}

static bool is_walk(int lobe) { return lobe >= 0 && weft_lobe_info(lobe)->traits & WEFT_LOBE_REFERENCE; }

/* Finds the inputs that are 0 for all surfaces: those at 0 without a texture. For a profile any input may be set. */
static void find_zeros(const Draft *draft, ExportModel *model) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        const Input *input = &model->material.inputs[k];
        bool number = input_infos[k].kind == WEFT_INPUT_SCALAR || input_infos[k].kind == WEFT_INPUT_COLOR;
        bool some = input->texture != 0 || draft->desc->profile != NULL;
        for (int c = 0; c < input_value_count((InputId)k); c++) some |= input->value[c] > 0.0f;
        model->zero[k] = number && !some;
    }
    if (draft->desc->profile) model->zero[INPUT_dust] = true; /* no engine has dust */
}

/* Finds the facts that are true for all surfaces, to fold the conditions of the text. */
static void find_facts(Draft *draft, ExportModel *model) {
    const Choices *c = &model->choices;
    Stack m[3];
    for (int x = 0; x < 3; x++) {
        Surface s = composition_surface(0.5f * (float)x, model->zero);
        stack_make(&m[x], &s, c, (TableRef){.kind = TABLE_NONE});
    }
    bool layer = true, by = true, under = true, albedo = true, view = true, coat = true;
    for (int x = 1; x < 3; x++) {
        layer &= m[x].layer == m[0].layer;
        by &= m[x].combine == m[0].combine;
        under &= m[x].base_fresnel == m[0].base_fresnel;
        view &= m[x].view == m[0].view;
        coat &= m[x].coat_rule == m[0].coat_rule;
        albedo &= m[x].albedo == m[0].albedo;
    }
    model->stack = m[1];
    model->one_layer = layer;
    if (layer) draft_fact(draft, "m.layer", m[0].layer);
    if (by) draft_fact(draft, "m.combine", m[0].combine);
    if (draft->desc->cloth)
        draft_fact(draft, "m.base_fresnel", BASE_FRESNEL_NONE);
    else if (under)
        draft_fact(draft, "m.base_fresnel", m[0].base_fresnel);
    if (view) draft_fact(draft, "m.view", m[0].view);
    if (coat) draft_fact(draft, "m.coat_rule", m[0].coat_rule);
    if (albedo && !layer_needs_average(c->layer)) /* such a rule may change it on the way */
        draft_fact(draft, "m.albedo", m[0].albedo);
#define CHOICE_FACT(name, help) draft_fact(draft, "c." #name, c->name);
    SURFACE_CHOICES(CHOICE_FACT)
#define SHOWN_FACT(name, NAME, Name, wo) draft_fact(draft, "only." #name, 1);
    if (!draft->desc->cloth) { /* a cloth's base and the layers above it are evaluated one by one */
        SLOTS(SHOWN_FACT)
    }
    Choices beside = *c;
    beside.workflow = beside.profile = CHOICE_AUTO;
    if (!convert_wanted(*c)) beside.convert = CHOICE_AUTO;
#define CHOICE_MADE(name, help) model->chosen |= beside.name != CHOICE_AUTO;
    SURFACE_CHOICES(CHOICE_MADE)
}

/* Finds the slots. Under the layers above a cloth a white Lambert lobe stands for it, which the cloth then replaces. */
static void find_slots(const Draft *draft, ExportModel *model) {
    CompositionSlots *found = &model->slots;
    *found = composition_slots(&model->choices, model->zero, false);
    model->woven = draft->desc->cloth != NULL;
    if (!model->woven) return;
    found->slots[PLACE_DIFFUSE] = (TextSlot){.lobes = {LOBE_LAMBERT}, .count = 1};
    found->slots[PLACE_SPECULAR].count = 0;
    found->glass = found->retro = false;
    found->transmits &= !model->zero[INPUT_diffuse_transmission];
    model->bare = !found->slots[PLACE_SHEEN].count && !found->slots[PLACE_COAT].count && !found->transmits &&
                  model->zero[INPUT_dust];
}

static WeftResult find_model(Draft *draft, ExportModel *model, WeftError *error) {
    const WeftExportDesc *desc = draft->desc;
    WeftResult result = WEFT_OK;
    if (desc->profile) result = find_profile(desc->profile, &model->material, error);
    if (desc->material && result == WEFT_OK) result = numbers_sound(desc->material, error);
    if (desc->material && result == WEFT_OK) model->material = material_sound(desc->material);
    if (result != WEFT_OK) return result;
    model->surface = material_plain(&model->material);
    model->choices = material_choices(&model->material);
    const int chosen[] = {model->choices.sheen_lobe, model->choices.diffuse};
    for (int k = 0; k < 2; k++)
        if (is_walk(chosen[k])) return fail(error, WEFT_MESSAGE_EXPORT_LOBE, weft_lobe_info(chosen[k])->id, NULL);
    find_zeros(draft, model);
    find_facts(draft, model);
    find_slots(draft, model);
    draft_identifier(desc->profile ? desc->profile : desc->name ? desc->name : "material", draft->id[0]);
    return WEFT_OK;
}

/* Returns true if the layer rule reads E and E comes from a table of the sheen's own lobe. */
static bool needs_e(const ExportModel *model) {
    const Stack *m = &model->stack;
    return model->slots.slots[PLACE_SHEEN].count &&
           (!model->one_layer || (m->layer != LAYER_ADDITIVE && !IS_BELOW_F(m)));
}

static bool needs_table(const ExportModel *model) { return needs_e(model) && albedo_is_own(model->stack.albedo); }

/* Writes the one layer rule in place of shading/stack/layer.h. */
static void put_layer(Text *text, int layer) {
    char file[96];
    text_provide(text, "shading/stack/layer.h");
    snprintf(file, sizeof file, "shading/layers/%s.h", rules[layer].id);
    for (char *c = file; *c; c++)
        if (*c == '-') *c = '_';
    text_include(text, file);
    for (int k = 0; k < LAYER_COUNT; k++) {
        char name[64];
        snprintf(name, sizeof name, "%s", rules[k].id);
        for (char *c = name; *c; c++) *c = (char)(*c == '-' ? '_' : *c - 'a' + 'A');
        text_line(text, "const int LAYER_%s = %d;", name, k);
    }
    text_line(text,
              "const int LAYER_BY_MAX = %d;\nconst int LAYER_BY_CHANNEL = %d;\n\n"
              "/* The part of the base that is left for wo and wi: c is the sheen's colour, e_o e_i e_avg "
              "its albedo. */\n"
              "float layer_base(int layer, float c, float e_o, float e_i, float e_avg) {\n    return %s;\n}",
              LAYER_BY_MAX, LAYER_BY_CHANNEL, rules[layer].base);
    text_define(text, "layer_needs_wi(layer)", rules[layer].needs_wi);
    text_define(text, "layer_needs_average(layer)", rules[layer].needs_average);
    text_define(text, "layer_combine(layer)", rules[layer].by);
}

static void put_value(Text *text, const Surface *s, int k) {
    const char *name = input_infos[k].name, *help = input_infos[k].help;
#define VALUE_SCALAR(input) text_line(text, "    s.%s = %s; /* %s */", name, number(s->input).text, help)
#define VALUE_ANGLE(input)                                                                                             \
    text_line(text, "    s.%s = %s; /* %s; here in radians */", name, number(s->input).text, help)
#define VALUE_COLOR(input)                                                                                             \
    text_line(text, "    s.%s = rgb(%s, %s, %s); /* %s */", name, number(s->input.r).text, number(s->input.g).text,    \
              number(s->input.b).text, help)
#define VALUE_DIR(input, words)                                                                                        \
    text_line(text, "    s.%s = dir(%s, %s, %s); /* %s */", name, number(s->input.x).text, number(s->input.y).text,    \
              number(s->input.z).text, words)
#define VALUE_NORMAL(input)    VALUE_DIR(input, "unit vector in the shading frame")
#define VALUE_DIRECTION(input) VALUE_DIR(input, "unit vector in the tangent plane")
#define VALUE(kind, input, label, initial, low, high, hard_low, hard_high, role, words)                                \
    if (k == INPUT_##input) VALUE_##kind(input);
    SURFACE_INPUTS(VALUE)
}

static void put_surface(Draft *draft, const ExportModel *model) {
    text_line(&draft->text,
              "\n/* %s: the inputs that it reads, to be changed as textures say. */\nSurface %s_surface() "
              "{\n    Surface s;",
              draft->desc->profile ? "An engine's material at its defaults" : "The material's numbers", draft->id[0]);
    for (int k = 0; k < INPUT_COUNT; k++) put_value(&draft->text, &model->surface, k);
    text_line(&draft->text, "    return s;\n}");
    draft_root(draft, "%s_surface", draft->id[0]);
}

/* Writes the statements that make the stack m and its view w from wo. */
static void put_stack(Draft *draft, const ExportModel *model) {
    Text *text = &draft->text;
    if (convert_wanted(model->choices)) text_line(text, "    s = convert_surface(s, material_choices());");
    if (model->chosen) text_line(text, "    compose_surface(s, material_choices());");
    text_line(text, "    Stack m;\n    stack_clear(m);\n    %s;", composition_stack(&model->choices));
    if (model->chosen) text_line(text, "    compose_choices(m, s, material_choices());");
    if (model->woven)
        text_line(text, "    compose_base(m, lobe_default(LOBE_LAMBERT), rgb_grey(1.0), rgb_grey(1.0));");
    else if (model->slots.transmits)
        text_line(text, "    stack_split_diffuse(m);");
    if (!model->zero[INPUT_dust]) text_line(text, "    compose_dust(m, s);");
    if (model->table) text_line(text, "    m.table = sheen_table();");
    if (model->table && layer_needs_average(model->stack.layer))
        text_line(text, "    m.e_avg = table_sheen_nap_average(m.table, m.nap, table_rows(m.table, m.albedo_coord));");
    if (model->stack.layer == LAYER_MULTIPLICATIVE)
        text_line(text, "    m.sheen.f0 = rgb_grey(0.0);\n    m.sheen.f90 = m.sheen.f0;");
    /* The view of a lobe that no slot has stays uninitialised, of which C compilers warn. */
    bool c = draft->desc->target == WEFT_EXPORT_C;
    text_line(text, "    stack_prepare(m);\n%s    StackView w%s;\n    view_begin(m, wo, w);",
              c ? "    static StackView nothing;\n" : "", c ? " = nothing" : "");
    if (needs_e(model)) text_line(text, "    w.e_o = stack_albedo(m, wo);");
    if (model->slots.slots[PLACE_SHEEN].count) text_line(text, "    view_base_scale(m, w);");
    if (model->slots.transmits) {
        const bool holed = model->woven && model->material.alpha_mode != WEFT_ALPHA_OPAQUE;
        text_line(text,
                  "    if (wi.z < 0.0) {\n"
                  "        Angles mirrored = angles_between(wo, dir(wi.x, wi.y, -wi.z));\n"
                  "        return rgb_scale(stack_transmitted(m, w, mirrored).f_cos, %s%s);\n    }",
                  draft->desc->fold_pi ? "PI" : "1.0", holed ? " * seen.covers" : "");
    }
}

/* Writes the end of the function for a cloth. The layers above are linear in f of the base: pi times their f of a white
 * Lambert lobe, times f of the cloth, is that of the cloth below them. */
static void put_woven_value(Draft *draft, const ExportModel *model) {
    Text *text = &draft->text;
    const char *id = draft->id[0];
    text_line(text, "    Rgb cloth = weave_value(seen, %s_warp(), %s_weft(), a);", id, id);
    if (model->bare) {
        text_line(text, draft->desc->fold_pi ? "    return rgb_scale(cloth, PI * wi.z);\n}"
                                             : "    return rgb_scale(cloth, wi.z);\n}");
        return;
    }
    text_line(text, "    Rgb above = stack_value_of(m, w, slots_of(false, false, true, true, true), a, %s).f_cos;",
              model->slots.slots[PLACE_COAT].count ? "b" : "a");
    text_line(text, "    Rgb below = stack_value_of(m, w, slots_of(true, false, false, false, false), a, a).f_cos;");
    if (model->material.alpha_mode != WEFT_ALPHA_OPAQUE) text_line(text, "    above = rgb_scale(above, seen.covers);");
    text_line(text, draft->desc->fold_pi
                        ? "    return rgb_scale(rgb_add(above, rgb_scale(rgb_mul(below, cloth), PI)), PI);\n}"
                        : "    return rgb_add(above, rgb_scale(rgb_mul(below, cloth), PI));\n}");
}

static void put_shade(Draft *draft, const ExportModel *model) {
    Text *text = &draft->text;
    bool coat = model->slots.slots[PLACE_COAT].count > 0, through = model->slots.transmits;
    text_line(text,
              "\n/* f%s times the cosine of wi, each channel; %s. */\n"
              "Rgb %s_shade(Surface s, %sDir wo, Dir wi) {\n"
              "    if (wo.z <= 0.0%s) return rgb_grey(0.0);",
              draft->desc->fold_pi ? " times pi" : "",
              through ? "below the horizon, of the light that comes through" : "black below the horizon", draft->id[0],
              model->woven ? "WeaveSeen seen, " : "", through ? "" : " || wi.z <= 0.0");
    if (model->woven && draft->desc->cloth->rotation != 0.0)
        text_line(text, "    wo = weave_direction(%s_placing(), wo);\n    wi = weave_direction(%s_placing(), wi);",
                  draft->id[0], draft->id[0]);
    if (!model->bare) put_stack(draft, model);
    text_line(text, "    Angles a = angles_between(wo, wi);");
    if (coat) text_line(text, "    Angles b = angles_between(w.coat_o, stack_to_coat(m, wi));");
    if (model->woven)
        put_woven_value(draft, model);
    else
        text_line(text,
                  draft->desc->fold_pi ? "    return rgb_scale(stack_value(m, w, a, %s).f_cos, PI);\n}"
                                       : "    return stack_value(m, w, a, %s).f_cos;\n}",
                  coat ? "b" : "a");
    draft_root(draft, "%s_shade", draft->id[0]);
}

static void put_text(Draft *draft, ExportModel *model) {
    Text *text = &draft->text;
    TableRef e = {.kind = TABLE_NONE};
    if (model->table) e = albedo_table_ref(model->table);
    text_include(text, "shading/dialect/angles.h");
    text_composition_lobes(text, &model->slots, e.kind, e.tilts);
    if (!model->slots.slots[PLACE_SHEEN].count) text_define(text, "HAS_LAYERED_SHEEN(m)", "false");
    if (model->one_layer) put_layer(text, model->stack.layer);
    text_composition(text, &model->choices);
    if (model->chosen) text_composition_choices(text, &model->choices);
    if (model->table) text_albedo_table(text, "sheen_table", "sheen", model->table);
    put_surface(draft, model);
    if (model->woven) draft_cloth(draft);
    put_shade(draft, model);
}

WeftResult draft_material(Draft *draft, WeftError *error) {
    ExportModel model = {0};
    WeftResult result = find_model(draft, &model, error);
    if (result != WEFT_OK) return result;
    if (needs_table(&model)) {
        model.table = draft_albedo(draft);
        if (!model.table) return fail(error, WEFT_MESSAGE_MEMORY, "table", NULL);
        sheen_table_fill(&model.surface, &model.choices, model.table);
    }
    put_text(draft, &model);
    return WEFT_OK;
}
