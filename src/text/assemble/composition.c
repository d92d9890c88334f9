#include <stdio.h>
#include <stdlib.h>

#include "text/assemble/composition.h"

#include "base/equal.h"
#include "shading/catalogue/engine_tables.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"
#include "weft/lobe.h"

/* A workflow or profile: its file, and what makes its stack. */
typedef struct Composition {
    const char *folder, *id, *stack;
} Composition;

#define WORKFLOW_ROW(id, index, stack, help) {"workflows", id, #stack},
#define PROFILE_ROW(id, index, stack, help)  {"profiles", id, #stack},
static const Composition workflows[] = {WEFT_WORKFLOWS(WORKFLOW_ROW)};
static const Composition profiles[] = {WEFT_PROFILES(PROFILE_ROW)};

typedef struct Formula {
    int index;
    const char *row;
} Formula;

#define ALBEDO_ROW(name, index, own_table, formula) {index, "F(" #name ", " #index ", " #own_table ", " #formula ")"},
#define FORMULA_ROW(name, index, formula)           {index, "F(" #name ", " #index ", " #formula ")"},
static const Formula albedos[] = {WEFT_ALBEDO_FORMULAS(ALBEDO_ROW){-1, ""}};
static const Formula views[] = {WEFT_VIEWS(FORMULA_ROW){-1, ""}};

/* Returns the text of the formula with that index, or the empty one at the end. */
static const char *formula_of(const Formula *f, int index) {
    while (f->index >= 0 && f->index != index) f++;
    return f->row;
}

Surface composition_surface(float x, const bool zero[INPUT_COUNT]) {
    Material material = material_default();
    for (int k = 0; k < INPUT_COUNT; k++) {
        const InputRole role = input_roles[k];
        for (int c = 0; c < input_value_count((InputId)k); c++) {
            float *value = &material.inputs[k].value[c];
            *value = zero[k]              ? 0.0f
                     : role == ROLE_HALF  ? 0.5f
                     : role == ROLE_WHOLE ? 1.0f
                     : role == ROLE_MIX   ? x
                                          : *value;
        }
    }
    return material_plain(&material);
}

/* Returns the workflow or profile that makes the stack, which is the target of a conversion (convert.h). */
static const Composition *composition_of(const Choices *choices) {
    const Choices c = convert_choices(*choices);
    return c.profile > 0 ? &profiles[c.profile] : &workflows[c.workflow < 0 ? 0 : c.workflow];
}

const char *composition_stack(const Choices *choices) { return composition_of(choices)->stack; }

/* Adds the lobe of a slot to a list. Returns false if the slot is empty or the list has the lobe. */
static bool add_lobe(TextSlot *to, const Slot *from) {
    int id = from->lobe.id;
    if (weft_lobe_info(id)->traits & TRAIT_REFERENCE || !(from->normal > 0.0f)) return false;
    for (int k = 0; k < to->count; k++)
        if (to->lobes[k] == id) return false;
    to->lobes[to->count++] = id;
    return true;
}

/* Adds the highlight as the workflow or profile makes it. compose_choices reads its alphas if terms are chosen. */
static void add_begun(CompositionSlots *self, const Surface *s, const Choices *choices) {
    const Choices c = convert_choices(*choices);
    Surface t = convert_surface(*s, *choices);
    Stack m;
    if (c.d < 0 && c.v < 0 && c.f < 0) return;
    compose_surface(&t, c);
    compose_begin(&m, &t, c);
    add_lobe(&self->begun, &m.specular);
}

CompositionSlots composition_slots(const Choices *choices, const bool zero[INPUT_COUNT], bool whole_sheen) {
    CompositionSlots found = {.used = true};
    for (int x = 0; x < 2 * (whole_sheen ? 3 : 6); x++) {
        Stack m;
        Surface s = composition_surface(0.5f * (float)(x / 2 % 3), zero);
        if (x % 2 && is_equal(s.diffuse_roughness, 0.0f)) continue; /* as the turn before */
        if (x % 2 == 0) s.diffuse_roughness = 0.0f;                 /* the diffuse lobe is another one then */
        if (x / 2 > 2) s.sheen = 0.5f; /* a profile may blend from highlight to sheen by it */
        stack_make(&m, &s, choices, (TableRef){.kind = TABLE_NONE});
        for (int k = 0; k < SLOT_COUNT; k++) {
            const Slot *slot = stack_slot(&m, k);
            const bool first = add_lobe(&found.slots[k], slot) && found.slots[k].count == 1;
            if (first) found.lobes[k] = slot->lobe;
        }
        add_begun(&found, &s, choices);
        const Stack *made = &m;
        found.used &= !IS_BELOW_F(made);
        found.transmits |= HAS_TRANSMITTED(made);
        found.glass |= HAS_GLASS(made);
        found.retro |= HAS_RETRO(made);
    }
    return found;
}

/* Appends the lobes of the slots, with LOBE_LAMBERT and LOBE_GGX, which every stack names even if it then uses others. */
void text_composition_lobes(Text *text, const CompositionSlots *found, int table_kind, int table_tilts) {
#define SLOT_HAS(name, NAME, Name, wo) "HAS_" #NAME "(m)",
    static const char *const has[] = {SLOTS(SLOT_HAS)};
    int ids[2 + (SLOT_COUNT + 1) * LOBE_MOST] = {LOBE_LAMBERT, LOBE_GGX}, count = 2;
    for (int k = 0; k <= SLOT_COUNT; k++) {
        const TextSlot *slot = k < SLOT_COUNT ? &found->slots[k] : &found->begun;
        for (int j = 0; j < slot->count; j++) ids[count++] = slot->lobes[j];
    }
    char kind[16], tilts[16];
    snprintf(kind, sizeof kind, "%d", table_kind);
    snprintf(tilts, sizeof tilts, "%d", table_tilts);
    text_define(text, "SHEEN_KIND(m)", kind);
    text_define(text, "SHEEN_TILTS(m)", tilts);
    for (int k = 0; k < SLOT_COUNT; k++) text_define(text, has[k], found->slots[k].count ? "true" : "false");
    text_define(text, "HAS_LAYERED_SHEEN(m)", found->used ? "true" : "(m.color.r + m.color.g + m.color.b > 0.0)");
    text_define(text, "HAS_TRANSMITTED(m)", found->transmits ? "true" : "false");
    text_define(text, "HAS_GLASS(m)", found->glass ? "true" : "false");
    text_define(text, "HAS_RETRO(m)", found->retro ? "true" : "false");
    text_dispatch(text, ids, count);
    text_slots(text, found->slots, found->sampled);
}

/* Appends those of the engines' tables that the composition names, since each takes a while to make. */
static void put_engines(Text *text, const char *const formulas[2]) {
#define ENGINE_TABLE_NAME(NAME, name, side, points, sheen, shifted) "ENGINE_" #NAME,
    static const char *const names[ENGINE_COUNT] = {ENGINE_TABLES(ENGINE_TABLE_NAME)};
    int which[ENGINE_COUNT], count = 0;
    for (int k = 0; k < ENGINE_COUNT; k++)
        if (strstr(formulas[0], names[k]) || strstr(formulas[1], names[k])) which[count++] = k;
    text_engine_tables(text, which, count);
}

/* Appends the one composition of this shader, in place of shading/material/profile.h. */
void text_composition(Text *text, const Choices *choices) {
    const Composition *c = composition_of(choices);
    char file[128];
    int size = snprintf(file, sizeof file, "shading/%s/%s.h", c->folder, c->id);
    for (int k = 0; k < size; k++)
        if (file[k] == '-') file[k] = '_';
    const bool none[INPUT_COUNT] = {false};
    Surface s = composition_surface(0.5f, none);
    Stack m;
    compose_begin(&m, &s, convert_choices(*choices));
    const char *albedo = formula_of(albedos, m.albedo), *view = formula_of(views, m.view);
    const char *const formulas[] = {albedo, view};
    put_engines(text, formulas);
    text_provide(text, "shading/material/profile.h");
    text_include(text, "shading/stack/workflow.h");
    text_include(text, file);
    text_line(text,
              "\nvoid compose_begin(inout Stack m, Surface s, Choices c) {\n    workflow_begin(m, c);\n    %s;\n}",
              c->stack);
    text_define(text, "WEFT_ALBEDO_FORMULAS(F)", albedo);
    text_define(text, "WEFT_VIEWS(F)", view);
    text_include(text, "shading/material/stack_value.h");
}

void text_composition_choices(Text *text, const Choices *choices) {
    text_line(text, "\nChoices material_choices() {\n    Choices c;");
#define PUT_CHOICE(name, help) text_line(text, "    c.%s = %d;", #name, choices->name);
    SURFACE_CHOICES(PUT_CHOICE)
    text_line(text, "    return c;\n}");
}
