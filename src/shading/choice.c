#include "shading/choice.h"

#include "shading/profile.h"
#include "weft/lobe.h"

const char *choice_id(ChoiceId choice, int k) {
    switch (choice) {
    case CHOICE_workflow: return weft_workflow_id(k);
    case CHOICE_profile: return weft_profile_id(k);
    case CHOICE_diffuse:
    case CHOICE_sheen_lobe: return k >= 0 && k < LOBE_COUNT ? weft_lobe_info(k)->id : NULL;
    case CHOICE_d: return weft_term_id(WEFT_TERM_D, k);
    case CHOICE_v: return weft_term_id(WEFT_TERM_V, k);
    case CHOICE_f: return weft_term_id(WEFT_TERM_F, k);
    case CHOICE_layer: return weft_layer_id(k);
    case CHOICE_layer_by: return k == LAYER_BY_MAX ? "max" : k == LAYER_BY_CHANNEL ? "channel" : NULL;
    case CHOICE_COUNT: break;
    }
    return NULL;
}

int choice_find(ChoiceId choice, const char *id) {
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

const char *weft_workflow_id(int k) { return k >= 0 && k < WORKFLOWS ? workflows[k][0] : NULL; }
const char *weft_workflow_help(int k) { return k >= 0 && k < WORKFLOWS ? workflows[k][1] : NULL; }
const char *weft_profile_id(int k) { return k >= 0 && k < PROFILES ? profiles[k][0] : NULL; }
const char *weft_profile_help(int k) { return k >= 0 && k < PROFILES ? profiles[k][1] : NULL; }
