/* u3m_words.c - the draft and the yarns that the words of a U3M choose */
#include <string.h>

#include "scene/material/u3m_weave.h"

/* Drafts by the schema's words for constructions. The setts are usual ones, threads a centimetre. */
static const struct {
    const char *construction, *draft;
} drafts[] = {{"Plain weave", "plain; sett 26 24"},
              {"Poplin", "plain; sett 50 28"},
              {"TafFeta", "plain; sett 44 34"},
              {"Canvas", "plain; sett 14 12"},
              {"Oxford", "basket 2 1; sett 36 20"},
              {"Twill", "twill 2/2 z; sett 30 24"},
              {"Twill - right hand (Z)", "twill 2/2 z; sett 30 24"},
              {"Twill - left hand (S)", "twill 2/2 s; sett 30 24"},
              {"Satin", "satin 5/2; sett 56 34"}};

/* Yarns by the schema's words for fibres; cotton for all others. */
static const struct {
    const char *fibre, *yarn;
} fibres[] = {{"Linen", "linen"},
              {"Hemp", "linen"},
              {"Jute", "linen"},
              {"Ramie", "linen"},
              {"Wool", "wool"},
              {"Virgin Wool", "wool"},
              {"Cashmere", "wool"},
              {"Alpaca", "wool"},
              {"Angora", "wool"},
              {"Mohair", "wool"},
              {"Camelhair", "wool"},
              {"Silk", "silk"},
              {"Wild Silk", "dupion"},
              {"Polyester", "polyester"},
              {"Recycled Polyester", "polyester"},
              {"Nylon", "polyester"},
              {"Polyamid", "polyester"},
              {"Recycled Polyamide", "polyester"},
              {"Acetate", "polyester"},
              {"Triacetate", "polyester"},
              {"Cupro", "polyester"}};

static const char *draft_of(const json_t *physics) {
    const char *type = json_string_value(json_object_get(json_object_get(physics, "construction"), "type"));
    for (size_t k = 0; type && k < sizeof drafts / sizeof *drafts; k++)
        if (strcmp(drafts[k].construction, type) == 0) return drafts[k].draft;
    return NULL;
}

static const char *yarn_of(const json_t *physics) {
    const json_t *parts = json_object_get(json_object_get(physics, "composition"), "parts");
    const char *most = NULL;
    double greatest = 0.0;
    for (size_t k = 0; k < json_array_size(parts); k++) {
        const json_t *part = json_array_get(parts, k);
        const double ratio = json_number_value(json_object_get(part, "ratio"));
        if (!(ratio > greatest)) continue;
        greatest = ratio;
        most = json_string_value(json_object_get(part, "type"));
    }
    for (size_t k = 0; most && k < sizeof fibres / sizeof *fibres; k++)
        if (strcmp(fibres[k].fibre, most) == 0) return fibres[k].yarn;
    return "cotton";
}

json_t *u3m_words_weave(const json_t *physics, const float color[3], const char **draft, const char **yarn) {
    const double r = (double)color[0], g = (double)color[1], b = (double)color[2];
    *draft = draft_of(physics);
    *yarn = yarn_of(physics);
    if (!*draft) return NULL;
    return json_pack("{s:s, s:{s:s, s:[f,f,f]}, s:{s:s, s:[f,f,f]}}", "draft", *draft, "warp", "yarn", *yarn, "color",
                     r, g, b, "weft", "yarn", *yarn, "color", r, g, b);
}
