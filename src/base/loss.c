#include "weft/loss.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/printable.h"

static bool is_same(const WeftLoss *a, const WeftLoss *b) {
    return a->material == b->material && strcmp(a->name, b->name) == 0 && strcmp(a->what, b->what) == 0 &&
           strcmp(a->why, b->why) == 0;
}

int weft_losses_add(WeftLosses *losses, int material, const char *name, const char *what, const char *why) {
    WeftLoss loss = {.material = material};
    printable(name, loss.name, sizeof loss.name);
    printable(what, loss.what, sizeof loss.what);
    printable(why, loss.why, sizeof loss.why);
    for (int k = 0; k < losses->count; k++)
        if (is_same(&losses->items[k], &loss)) return 1;
    WeftLoss *more = realloc_array(losses->items, (size_t)losses->count + 1, sizeof *more);
    if (!more) return 0;
    losses->items = more;
    losses->items[losses->count++] = loss;
    return 1;
}

/* Returns the part of a warning behind its subject, of which fail.c says no more than so many bytes, and its message. */
static const char *detail_of(const char *subject, WeftMessage message, const char *text) {
    enum { SUBJECT_MOST = 200 };
    const size_t length = strnlen(subject, SUBJECT_MOST);
    if (strncmp(text, subject, length) == 0) text += length;
    const char *said = strstr(text, weft_message_text(message));
    if (said) text = said + strlen(weft_message_text(message));
    return text + strspn(text, ": ");
}

int weft_losses_hear(WeftLosses *losses, int material, const char *name, const char *subject, WeftMessage message,
                     const char *text) {
    char what[sizeof losses->items->what];
    const char *detail = detail_of(subject, message, text), *end = strstr(detail, ": ");
    const size_t length = end ? (size_t)(end - detail) : strlen(detail);
    printable(detail, what, length < sizeof what ? length + 1 : sizeof what);
    return weft_losses_add(losses, material, name, what, end ? end + 2 : NULL);
}

void weft_losses_free(WeftLosses *losses) {
    if (!losses) return;
    free(losses->items);
    *losses = (WeftLosses){.items = NULL};
}
