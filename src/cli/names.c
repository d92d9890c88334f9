#include "names.h"

#include <stdio.h>
#include <string.h>

#include "report.h"
#include "weft/lobe.h"

enum { NAME_MAX_LENGTH = 40 };

static int least(int a, int b) { return a < b ? a : b; }

/* Edits that turn a into b: insert, delete, replace, or swap two neighbours (optimal string alignment;
 * Frederick J. Damerau, "A Technique for Computer Detection and Correction of Spelling Errors", 1964). */
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
    int bearable = least(1 + (int)typed / 4, ((int)length - 1) / 2); /* most of the name must be there */
    /* the start of a name is a way to write it: --time for --time-limit */
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

static const char *lobe_id(int lobe) { return lobe < weft_lobe_count() ? weft_lobe_info(lobe)->id : NULL; }

/* The index of id in a list that ends with NULL. */
static int listed(const char *id, const char *(*name)(int index), WeftMessage message) {
    char hint[96];
    Nearest nearest = {.typed = id};
    for (int k = 0; name(k); k++) {
        if (strcmp(name(k), id) == 0) return k;
        nearest_offer(&nearest, name(k));
    }
    report(WEFT_USAGE, "%.200s: %s%s", id, weft_message_text(message),
           nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; `weft models` lists them");
    return -1;
}

int lobe_named(const char *id) { return listed(id, lobe_id, WEFT_MESSAGE_LOBE_NAME); }
int layer_named(const char *id) { return listed(id, weft_layer_id, WEFT_MESSAGE_LAYER_NAME); }
