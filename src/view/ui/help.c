#include "view/ui/help.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "weft/lobe.h"
#include "weft/material.h"

/* The files of a choice: folder and the prefix of their names. */
static const struct {
    const char *choice, *prefix;
} places[] = {{"workflow", "workflows/"}, {"profile", "profiles/"}, {"diffuse", "lobes/"},    {"d", "terms/d_"},
              {"v", "terms/v_"},          {"f", "terms/f_"},        {"sheen_lobe", "lobes/"}, {"layer", "layers/"}};

/* Returns what follows a line's end in a comment: past the blanks and the star. */
static const char *next_line(const char *p) {
    while (*p == ' ') p++;
    if (*p == '*' && p[1] != '/') p += p[1] == ' ' ? 2 : 1;
    return p;
}

/* Copies the first comment without its stars, up to LINES lines. Lines of one paragraph become one, since the tip wraps it;
 * lines that are indented, such as formulas, stay. */
static void first_comment(const char *text, char *out, size_t size) {
    enum { LINES = 16 };
    size_t used = 0;
    int lines = 0;
    const char *p = text + 2;
    out[0] = '\0';
    while (*p && strncmp(p, "*/", 2) != 0 && used + 2 < size && lines < LINES) {
        if (*p == '\n') {
            p = next_line(p + 1);
            const bool blank = used && out[used - 1] == '\n';
            out[used++] = blank || *p == '\n' || *p == ' ' ? '\n' : ' ';
            lines++;
        } else {
            out[used++] = *p++;
        }
    }
    while (used && (out[used - 1] == '\n' || out[used - 1] == ' ')) used--;
    out[used] = '\0';
}

const char *help_choice(int choice, int value) {
    static char text[2048];
    const char *name = weft_material_choice_name(choice), *id = weft_material_choice_value(choice, value);
    text[0] = '\0';
    if (value < 0) {
        snprintf(text, sizeof text, "auto: the choice of the workflow or the profile.\n%s",
                 weft_material_choice_help(choice));
        return text;
    }
    for (size_t k = 0; k < sizeof places / sizeof *places && name && id; k++) {
        char path[96];
        if (strcmp(places[k].choice, name) != 0) continue;
        int used = snprintf(path, sizeof path, "%s%s.h", places[k].prefix, id);
        for (int c = 0; c < used; c++)
            if (path[c] == '-') path[c] = '_';
        const char *file = weft_catalogue_text(path);
        if (file && strncmp(file, "/* ", 3) == 0) first_comment(file, text, sizeof text);
        break;
    }
    if (name && !text[0]) snprintf(text, sizeof text, "%s", weft_material_choice_help(choice));
    return text;
}

const char *help_input(int input) {
    static char text[512];
    WeftInputInfo info;
    text[0] = '\0';
    if (!weft_material_input_info(input, &info)) return text;
    bool angle = info.kind == WEFT_INPUT_ANGLE || info.kind == WEFT_INPUT_DIRECTION;
    int used = snprintf(text, sizeof text, "%s: %s\n%g .. %g%s is plausible; it starts at %g.\n", info.name, info.help,
                        (double)info.low, (double)info.high, angle ? " degrees" : "", (double)info.initial);
    snprintf(text + used, sizeof text - (size_t)used, "%s",
             info.kind == WEFT_INPUT_COLOR
                 ? "Click the swatch to pick, drag a number, double-click it to type; right double-click resets."
                 : "Drag; Ctrl-click types a number, also beyond the range; double-click resets.");
    return text;
}
