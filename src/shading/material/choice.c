#include "shading/material/choice.h"

#include <stdio.h>

#include "shading/material/convert.h"
#include "shading/material/profile.h"
#include "weft/lobe.h"

const char *choice_id(ChoiceId choice, int k) {
    switch (choice) {
    case CHOICE_workflow: return weft_workflow_name(k);
    case CHOICE_profile: return weft_profile_name(k);
    case CHOICE_diffuse:
    case CHOICE_sheen_lobe: return weft_lobe_info(k) ? weft_lobe_info(k)->id : NULL;
    case CHOICE_sheen_d:
    case CHOICE_d: return weft_term_name(WEFT_TERM_D, k);
    case CHOICE_sheen_v:
    case CHOICE_v: return weft_term_name(WEFT_TERM_V, k);
    case CHOICE_sheen_f:
    case CHOICE_f: return weft_term_name(WEFT_TERM_F, k);
    case CHOICE_rim: return k == RIM_SHEEN ? "sheen" : k == RIM_FUZZ ? "fuzz" : NULL;
    case CHOICE_layer: return weft_layer_name(k);
    case CHOICE_layer_by: return k == LAYER_BY_MAX ? "max" : k == LAYER_BY_CHANNEL ? "channel" : NULL;
    case CHOICE_convert: return k == CONVERT_METALLIC ? "metallic" : k == CONVERT_SPECULAR ? "specular" : NULL;
    case CHOICE_COUNT: break;
    }
    return NULL;
}

/* The names of papers and engines for the terms of the two sheens, whose letter distinguishes D and V; and those of
 * programs for profiles. */
static const struct {
    const char *name, *id, *help;
} aliases[] = {
    {"ashikhmin-d", "ashikhmin", "d ashikhmin"},
    {"ashikhmin-v", "neubelt", "v neubelt"},
    {"charlie-d", "charlie", "d charlie"},
    {"charlie-v", "conty-kulla", "v conty-kulla"},
    {"blender-3", "cycles-velvet", "profile cycles-velvet"},
    {"blender-4", "cycles-principled", "profile cycles-principled"},
    {"blender3", "cycles-velvet", "profile cycles-velvet"},
    {"blender4", "cycles-principled", "profile cycles-principled"},
};
enum { ALIASES = sizeof aliases / sizeof *aliases };

const char *weft_alias_name(int k) { return k >= 0 && k < ALIASES ? aliases[k].name : NULL; }
const char *weft_alias_help(int k) { return k >= 0 && k < ALIASES ? aliases[k].help : NULL; }

const char *alias_id(const char *name) {
    for (int k = 0; k < ALIASES; k++)
        if (strcmp(aliases[k].name, name) == 0) return aliases[k].id;
    return name;
}

const char *choice_several(ChoiceId choice, const char *name, char text[SEVERAL_SIZE]) {
    size_t length = strlen(name), used = 0;
    int found = 0;
    const char *id;
    for (int k = 0; (id = choice_id(choice, k)); k++) {
        if (strncmp(id, name, length) != 0 || id[length] != '-' || !choice_fits(choice, k)) continue;
        int wrote = snprintf(text + used, SEVERAL_SIZE - used, "%s%s", found++ ? ", " : "", id);
        if ((size_t)wrote >= SEVERAL_SIZE - used) break;
        used += (size_t)wrote;
    }
    for (int k = 0; k < ALIASES; k++) {
        if (strncmp(aliases[k].name, name, length) != 0 || aliases[k].name[length] != '-') continue;
        bool there = false; /* in this list */
        for (int j = 0; (id = choice_id(choice, j)); j++) there |= strcmp(id, aliases[k].id) == 0;
        if (!there || choice != CHOICE_profile) continue;
        int wrote = snprintf(text + used, SEVERAL_SIZE - used, "%s%s (%s)", found++ ? ", " : "", aliases[k].name,
                             aliases[k].id);
        if ((size_t)wrote >= SEVERAL_SIZE - used) break;
        used += (size_t)wrote;
    }
    return length && found > 1 ? text : NULL;
}

int choice_find(ChoiceId choice, const char *name) {
    const char *id = alias_id(name);
    if (choice == CHOICE_sheen_lobe || choice == CHOICE_diffuse) return weft_lobe_find(id);
    for (int k = 0; choice_id(choice, k); k++)
        if (strcmp(choice_id(choice, k), id) == 0) return k;
    return -1;
}

int choice_fits(ChoiceId choice, int k) {
    return choice != CHOICE_diffuse || (weft_lobe_info(k)->traits & WEFT_LOBE_DIFFUSE) != 0;
}

#define LISTED(id, index, stack, help) [index] = {id, help},
static const char *const workflows[][2] = {WEFT_WORKFLOWS(LISTED)};
static const char *const profiles[][2] = {WEFT_PROFILES(LISTED)};
enum { WORKFLOWS = sizeof workflows / sizeof *workflows, PROFILES = sizeof profiles / sizeof *profiles };

const char *weft_workflow_name(int k) { return k >= 0 && k < WORKFLOWS ? workflows[k][0] : NULL; }
const char *weft_workflow_help(int k) { return k >= 0 && k < WORKFLOWS ? workflows[k][1] : NULL; }
const char *weft_profile_name(int k) { return k >= 0 && k < PROFILES ? profiles[k][0] : NULL; }
const char *weft_profile_help(int k) { return k >= 0 && k < PROFILES ? profiles[k][1] : NULL; }
