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

/* The warnings of a writer, which tell what is lost. */
typedef struct LossHearing {
    const char *path, *name; /* of the file that is written, with which warnings begin; of the material */
    WeftLosses *losses;
    bool short_of; /* memory */
} LossHearing;

static void loss_note(void *user, WeftMessage message, const char *text) {
    LossHearing *hearing = user;
    hearing->short_of |= !weft_losses_hear(hearing->losses, 0, hearing->name, hearing->path, message, text);
}

/* Writes the material of a scene, and collects what the file lacks of it. */
static int material_write(WeftScene *scene, const char *path, WeftLosses *losses) {
    LossHearing hearing = {.path = path, .name = weft_scene_material_name(scene, 0), .losses = losses};
    const WeftLog log = {.fn = loss_note, .user = &hearing};
    WeftError error;
    const int result = told(weft_scene_save_u3m(scene, 0, path, NULL, &log, &error), &error);
    if (result == 0 && hearing.short_of)
        return report(WEFT_RESOURCES, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_MEMORY));
    return result;
}

int u3m_write(Delivery *delivery, TargetFile *file, const char *path) {
    WeftScene *scene = NULL;
    if (delivery->materials != 1)
        return report(WEFT_USAGE, "--to u3m: a U3M holds one material, and %.300s has %d; deliver each by itself",
                      delivery->what, delivery->materials);
    int result = source_bake(delivery, file, &(WeftBaking){.profile = file_target(file).fit}, &scene);
    if (result == 0) result = material_write(scene, path, &file->delivery.losses);
    weft_scene_free(scene);
    return result;
}

int u3m_load(Delivery *delivery, const char *path, WeftScene **out) {
    WeftError error;
    const int result = source_load(delivery, out);
    if (result != 0) return result;
    return told(weft_scene_assign_material(*out, NULL, path, NULL, &error), &error);
}
