#include "cli/console/names.h"

#include <stdio.h>
#include <string.h>

#include "cli/console/report.h"
#include "weft/weft.h"

enum { NAME_MAX_LENGTH = 40 };

static int least(int a, int b) { return a < b ? a : b; }

/* Returns the number of edits that transform a into b: insert, delete, replace, or swap two neighbours (optimal string
 * alignment; Frederick J. Damerau, "A Technique for Computer Detection and Correction of Spelling Errors", 1964). */
static int edits(const char *a, const char *b) {
    int rows = (int)strlen(a), columns = (int)strlen(b);
    int table[NAME_MAX_LENGTH + 1][NAME_MAX_LENGTH + 1];
    for (int i = 0; i <= rows; i++) {
        for (int j = 0; j <= columns; j++) {
            if (i == 0 || j == 0) {
                table[i][j] = i + j;
                continue;
            }
            int replaced = table[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            int best = least(replaced, least(table[i - 1][j], table[i][j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                best = least(best, table[i - 2][j - 2] + 1);
            table[i][j] = best;
        }
    }
    return table[rows][columns];
}

void nearest_offer(Nearest *nearest, const char *name) {
    size_t typed = strlen(nearest->typed), length = strlen(name);
    if (typed == 0 || typed > NAME_MAX_LENGTH || length > NAME_MAX_LENGTH) return;
    int distance = edits(nearest->typed, name);
    int bearable = least(1 + (int)typed / 4, ((int)length - 1) / 2); /* most of the name must match */
    /* the start of a name counts as the name: --time for --time-limit */
    if (typed > 2 && strncmp(nearest->typed, name, typed) == 0) distance = least(distance, 1);
    if (distance > bearable || (nearest->name && distance >= nearest->distance)) return;
    nearest->name = name;
    nearest->distance = distance;
}

const char *nearest_hint(const Nearest *nearest, char *buffer, int size) {
    if (!nearest->name) return "";
    snprintf(buffer, (size_t)size, "; did you mean %s?", nearest->name);
    return buffer;
}

static const char *d_name(int k) { return weft_term_name(WEFT_TERM_D, k); }
static const char *d_help(int k) { return weft_term_help(WEFT_TERM_D, k); }
static const char *v_name(int k) { return weft_term_name(WEFT_TERM_V, k); }
static const char *v_help(int k) { return weft_term_help(WEFT_TERM_V, k); }
static const char *f_name(int k) { return weft_term_name(WEFT_TERM_F, k); }
static const char *f_help(int k) { return weft_term_help(WEFT_TERM_F, k); }

static const char *lobe_name(int k) { return weft_lobe_info(k) ? weft_lobe_info(k)->id : NULL; }

/* Returns the k-th of the lobes that are diffuse terms, or of those that are not; -1 after the last. */
static int lobe_among(int k, bool diffuse) {
    for (int lobe = 0; lobe < weft_lobe_count(); lobe++)
        if (((weft_lobe_info(lobe)->traits & WEFT_LOBE_DIFFUSE) != 0) == diffuse && k-- == 0) return lobe;
    return -1;
}
static const char *diffuse_name(int k) { return lobe_name(lobe_among(k, true)); }
static const char *other_name(int k) { return lobe_name(lobe_among(k, false)); }

static const char *chart_name(int k) { return weft_chart(k) ? weft_chart(k)->name : NULL; }
static const char *chart_help(int k) { return weft_chart(k) ? weft_chart(k)->help : NULL; }

/* Returns an empty help text, since the list of lobes prints a table instead. */
static const char *no_help(int k) { return k < 0 ? NULL : ""; }

/* Returns the number of inputs, after which those of hair are counted. */
static int input_count(void) {
    int count = 0;
    while (weft_material_input_name(count)) count++;
    return count;
}
static const char *set_name(int k) {
    const char *name = weft_material_input_name(k);
    return name || k < 0 ? name : weft_material_hair_name(k - input_count());
}
static const char *set_help(int k) {
    const char *help = weft_material_input_help(k);
    return help || k < 0 ? help : weft_material_hair_help(k - input_count());
}

static const KindGroups preset_groups = {weft_preset_group_name, weft_preset_group_help, weft_preset_group};

const Kind kinds[] = {
    {"D term", "a", "d", "D terms: distributions", d_name, d_help, true, "terms/d_", NULL},
    {"V term", "a", "v", "V terms: visibility, 1 / (4 cos cos) inside", v_name, v_help, true, "terms/v_", NULL},
    {"F term", "an", "f", "F terms: Fresnel", f_name, f_help, true, "terms/f_", NULL},
    {"alias", "an", "aliases", "Aliases: names of terms in sources, of profiles by programs", weft_alias_name,
     weft_alias_help, true, NULL, NULL},
    {"diffuse term", "a", "diffuse", "Diffuse lobes: for bases, and for anything a lobe is for", diffuse_name, no_help,
     true, "lobes/", NULL},
    {"lobe", "a", "lobes", "Lobes", lobe_name, no_help, false, "lobes/", NULL},
    {"other lobe", "a", "others", "Lobes", other_name, no_help, true, "lobes/", NULL},
    {"layer rule", "a", "layers", "Layer rules: how a sheen sits on its base; each by=max or by=channel",
     weft_layer_name, weft_layer_help, true, "layers/", NULL},
    {"workflow", "a", "workflows", "Workflows: what the inputs mean", weft_workflow_name, weft_workflow_help, true,
     "workflows/", NULL},
    {"profile", "a", "profiles", "Profiles: exact compositions of engines", weft_profile_name, weft_profile_help, true,
     "profiles/", NULL},
    {"input", "an", "inputs", "Material inputs: render --set MATERIAL.INPUT=VALUE", set_name, set_help, true, NULL,
     NULL},
    {"choice", "a", "choices", "Material choices: render --set MATERIAL.CHOICE=ID", weft_material_choice_name,
     weft_material_choice_help, true, NULL, NULL},
    {"preset", "a", "presets", "Presets: render --preset NAME", weft_preset_name, weft_preset_help, true, NULL,
     &preset_groups},
    {"weave", "a", "weaves", "Weaves: render --weave \"WEAVE; CLAUSE\", of one's own threads (docs/weave.md)",
     weft_weave_name, weft_weave_help, true, NULL, NULL},
    {"yarn", "a", "yarns", "Yarns: render --set MATERIAL.weave.warp=YARN, or weft", weft_yarn_name, weft_yarn_help,
     true, NULL, NULL},
    {"chart material", "a", "chart", "Chart: reference materials, measured, with base colour and reflectance",
     chart_name, chart_help, true, NULL, NULL},
    {"built-in scene", "a", "scenes", "Built-in scenes: render builtin:NAME", weft_builtin_name, weft_builtin_help,
     true, NULL, NULL},
    {0},
};

const Kind *kind_of(const char *id) {
    const Kind *kind = kinds;
    while (strcmp(kind->id, id) != 0) kind++;
    return kind;
}

const Kind *kind_prefixed(const char *text, int length) {
    for (const Kind *kind = kinds; kind->id; kind++)
        if (length > 0 && strncmp(kind->key, text, (size_t)length) == 0) return kind;
    return NULL;
}

/* Returns the id in a kind that an alias stands for, if its help says so: "profile khronos"; else NULL. */
static const char *alias_of(const Kind *kind, int alias) {
    size_t length = strlen(kind->id);
    const char *help = weft_alias_help(alias);
    return strncmp(help, kind->id, length) == 0 && help[length] == ' ' ? help + length + 1 : NULL;
}

int kind_find(const Kind *kind, const char *id) {
    for (int k = 0; kind->name(k); k++)
        if (strcmp(kind->name(k), id) == 0) return k;
    for (int a = 0; weft_alias_name(a); a++)
        if (strcmp(weft_alias_name(a), id) == 0 && alias_of(kind, a)) return kind_find(kind, alias_of(kind, a));
    return -1;
}

/* Writes "; several have this name: a, b" where more than one id begins with id and a dash; returns NULL otherwise. */
static const char *several_hint(const Kind *kind, const char *id, char *buffer, size_t size) {
    size_t length = strlen(id), used = (size_t)snprintf(buffer, size, "; several have this name: ");
    int found = 0;
    for (int k = 0; kind->name(k) && used < size; k++) {
        const char *name = kind->name(k);
        if (strncmp(name, id, length) != 0 || name[length] != '-') continue;
        used += (size_t)snprintf(buffer + used, size - used, "%s%s", found++ ? ", " : "", name);
    }
    for (int a = 0; weft_alias_name(a) && used < size; a++) {
        const char *name = weft_alias_name(a);
        if (!alias_of(kind, a) || strncmp(name, id, length) != 0 || name[length] != '-') continue;
        used += (size_t)snprintf(buffer + used, size - used, "%s%s (%s)", found++ ? ", " : "", name, alias_of(kind, a));
    }
    return length && found > 1 ? buffer : NULL;
}

int kind_named(const Kind *kind, const char *id) {
    int k = kind_find(kind, id);
    if (k >= 0) return k;
    char buffer[320];
    const char *hint = several_hint(kind, id, buffer, sizeof buffer);
    Nearest nearest = {.typed = id};
    for (k = 0; kind->name(k); k++) nearest_offer(&nearest, kind->name(k));
    if (!hint) hint = nearest.name ? nearest_hint(&nearest, buffer, sizeof buffer) : "; `weft models` lists them";
    report(WEFT_USAGE, "%.200s: is not %s %s%s", id, kind->article, kind->id, hint);
    return -1;
}
