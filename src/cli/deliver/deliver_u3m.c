/* deliver_u3m.c - a U3M among what is delivered: the textile industry's file of one material */
#include <stdio.h>
#include <string.h>

#include "cli/console/report.h"
#include "cli/deliver/delivery.h"

WeftTarget file_target(const TargetFile *file) {
    /* programs for clothes shade its parameters as the paper of Disney does; khronos is nearest of what reads metallic */
    WeftTarget target = {.name = "u3m",
                         .help = "programs for clothes: U3M with its pictures in one archive",
                         .profile = "none",
                         .fit = "khronos"};
    if (file->target != TARGET_U3M) weft_target_info(file->target, &target);
    return target;
}

const char *file_suffix(const TargetFile *file) { return file->target == TARGET_U3M ? ".u3ma" : ".glb"; }

/* Collects the warnings of a writer as things that are lost, a line each. */
typedef struct Losses {
    char text[2000];
    size_t used;
} Losses;

static void loss_note(void *user, WeftMessage message, const char *text) {
    Losses *losses = user;
    const char *said = strstr(text, weft_message_text(message)); /* after the name of a file that is none yet */
    if (said) text = said + strlen(weft_message_text(message));
    text += strspn(text, ": ");
    if (losses->used + strlen(text) + 2 >= sizeof losses->text) return;
    losses->used += (size_t)snprintf(losses->text + losses->used, sizeof losses->text - losses->used, "%s\n", text);
}

int u3m_write(Delivery *delivery, TargetFile *file, const char *path) {
    Losses losses = {.used = 0};
    const WeftLog log = {.fn = loss_note, .user = &losses};
    WeftScene *scene = NULL;
    WeftError error;
    int result = source_bake(delivery, file_target(file).fit, false, &scene);
    const int count = result == 0 ? weft_scene_info(scene).material_count : 1;
    if (count != 1)
        result = report(WEFT_USAGE, "--to u3m: a U3M holds one material, and %.300s has %d; deliver each by itself",
                        delivery->what, count);
    if (result == 0 && weft_scene_save_u3m(scene, 0, path, NULL, &log, &error) != WEFT_OK)
        result = report_error(&error);
    weft_scene_free(scene);
    file->delivery.lost = result == 0 ? strdup(losses.text) : NULL;
    return result;
}

int u3m_load(Delivery *delivery, const char *path, WeftScene **out) {
    WeftError error;
    const int result = source_load(delivery, out);
    if (result != 0) return result;
    return weft_scene_assign_material(*out, NULL, path, NULL, &error) == WEFT_OK ? 0 : report_error(&error);
}
