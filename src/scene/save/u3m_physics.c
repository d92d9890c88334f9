#include "scene/save/u3m_physics.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { CELLS_MOST = 1 << 20 }; /* of a draft whose weave is looked for */

/* The schema's words for the fibres of named yarns. */
static const struct {
    const char *yarn, *fibre;
} fibres[] = {{"cotton", "Cotton"}, {"linen", "Linen"},      {"wool", "Wool"},
              {"silk", "Silk"},     {"dupion", "Wild Silk"}, {"polyester", "Polyester"}};

static const char *fibre_of(const char *yarn) {
    for (size_t k = 0; yarn && k < sizeof fibres / sizeof *fibres; k++)
        if (strcmp(fibres[k].yarn, yarn) == 0) return fibres[k].fibre;
    return "unknown";
}

/* Returns true if each pick is the one before, moved by so many warp threads to the right. */
static bool moves_by(const WeftDraft *draft, const int count[2], int threads) {
    for (int pick = 0; pick < count[WEFT_WEFT]; pick++)
        for (int warp = 0; warp < count[WEFT_WARP]; warp++)
            if (weft_draft_warp_up(draft, warp, pick) != weft_draft_warp_up(draft, warp + threads, pick + 1))
                return false;
    return true;
}

/* Returns the number of warp threads of the repeat that are on top of a pick. */
static int on_top(const WeftDraft *draft, int threads, int pick) {
    int count = 0;
    for (int warp = 0; warp < threads; warp++) count += weft_draft_warp_up(draft, warp, pick);
    return count;
}

/* Returns true for a plain weave in which groups of so many warp threads go together. */
static bool alternates(const WeftDraft *draft, const int count[2], int together) {
    const int first = weft_draft_warp_up(draft, 0, 0);
    if (count[WEFT_WARP] % (2 * together) || count[WEFT_WEFT] % 2) return false;
    for (int pick = 0; pick < count[WEFT_WEFT]; pick++)
        for (int warp = 0; warp < count[WEFT_WARP]; warp++)
            if (weft_draft_warp_up(draft, warp, pick) != (first ^ ((warp / together + pick) & 1))) return false;
    return true;
}

/* Returns true if the repeat, of at least five threads, has one crossing of its own in each pick, none beside another. */
static bool is_satin(const WeftDraft *draft, const int count[2]) {
    const int n = count[WEFT_WARP], top = on_top(draft, n, 0);
    if (n < 5 || n != count[WEFT_WEFT] || (top != 1 && top != n - 1)) return false;
    for (int step = 2; step < n - 1; step++)
        if (moves_by(draft, count, step)) return true;
    return false;
}

/* Returns the schema's word for a weave, or NULL. Seen from the front a Z twill rises to the right. */
static const char *construction_of(const WeftDraft *draft, const int count[2]) {
    if ((long)count[0] * count[1] > CELLS_MOST) return NULL;
    if (alternates(draft, count, 1)) return "Plain weave";
    if (alternates(draft, count, 2)) return "Oxford";
    if (is_satin(draft, count)) return "Satin";
    const bool right = moves_by(draft, count, 1), left = moves_by(draft, count, -1);
    if (right && !left) return "Twill - right hand (Z)";
    if (left && !right) return "Twill - left hand (S)";
    return NULL;
}

static json_t *construction_json(const WeftDraft *draft, const WeftDraftInfo *info) {
    const char *word = construction_of(draft, info->count);
    char name[160];
    if (word) return json_pack("{s:s, s:n}", "type", word, "name");
    snprintf(name, sizeof name, "a repeat of %d x %d threads", info->count[WEFT_WARP], info->count[WEFT_WEFT]);
    return json_pack("{s:s, s:s}", "type", "other", "name", info->title[0] ? info->title : name);
}

static json_t *part_json(const char *fibre, double ratio) {
    return json_pack("{s:f, s:s, s:n}", "ratio", ratio, "type", fibre, "name");
}

/* Returns the fibres by the length of thread on a square metre: threads of one system are as many as its sett. */
static json_t *composition_json(const WeftDraftInfo *info, const char *const yarns[2]) {
    const char *const names[2] = {fibre_of(yarns[WEFT_WARP]), fibre_of(yarns[WEFT_WEFT])};
    const double warp = (double)info->count[WEFT_WARP] / (double)info->size[WEFT_WARP],
                 weft = (double)info->count[WEFT_WEFT] / (double)info->size[WEFT_WEFT],
                 ratio = rint(1e3 * warp / (warp + weft)) / 1e3;
    if (strcmp(names[0], names[1]) == 0) return json_pack("{s:[o]}", "parts", part_json(names[0], 1.0));
    return json_pack("{s:[o, o]}", "parts", part_json(names[0], ratio), part_json(names[1], 1.0 - ratio));
}

json_t *u3m_physics(const WeftDraft *draft, const char *const yarns[2]) {
    const WeftDraftInfo info = weft_draft_info(draft);
    return json_pack("{s:n, s:n, s:{s:s}, s:o, s:{s:s, s:n}, s:o}", "thickness", "weight", "devices", "fab", "null",
                     "composition", composition_json(&info, yarns), "material_type", "type", "Woven", "name",
                     "construction", construction_json(draft, &info));
}
