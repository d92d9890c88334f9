/* deliver_summary.c - the summary of a delivery, as JSON for a build server and as text */
#include <stdio.h>
#include <string.h>

#include "cli/console/json_writer.h"
#include "cli/console/report.h"
#include "cli/deliver/delivery.h"

static const char *const view_keys[VIEW_COUNT] = {"near", "far"};

/* Writes the lines of a text as an array. */
static void lines_write(Json *json, const char *key, const char *text) {
    char line[512];
    json_open(json, key, '[');
    for (const char *at = text, *end; at && (end = strchr(at, '\n')); at = end + 1) {
        snprintf(line, sizeof line, "%.*s", (int)(end - at), at);
        json_text(json, NULL, line);
    }
    json_close(json, ']');
}

static bool is_alike(const WeftLoss *a, const WeftLoss *b) {
    return strcmp(a->what, b->what) == 0 && strcmp(a->why, b->why) == 0;
}

/* Returns how many materials have lost the same as item k of a list does; 0: an earlier item stands for it. */
static int loss_count(const WeftLosses *losses, int k) {
    int count = 0;
    for (int i = 0; i < losses->count; i++) {
        if (!is_alike(&losses->items[i], &losses->items[k])) continue;
        if (i < k) return 0;
        count++;
    }
    return count;
}

/* Writes what was lost, each thing once with all its materials. */
static void losses_write(Json *json, const WeftLosses *losses) {
    for (int k = 0; k < losses->count; k++) {
        if (loss_count(losses, k) == 0) continue;
        json_open(json, NULL, '{');
        json_text(json, "what", losses->items[k].what);
        json_text(json, "why", losses->items[k].why);
        json_open(json, "materials", '[');
        for (int i = k; i < losses->count; i++)
            if (losses->items[i].material >= 0 && is_alike(&losses->items[i], &losses->items[k]))
                json_text(json, NULL, losses->items[i].name);
        json_close(json, ']');
        json_close(json, '}');
    }
}

static void view_write(Json *json, const char *key, const ViewErrors *errors) {
    json_open(json, key, '{');
    json_number(json, "mean_color", errors->color);
    json_number(json, "profile_l1", errors->profile);
    json_number(json, "flip", errors->flip);
    json_number(json, "contrast", errors->contrast);
    json_close(json, '}');
}

/* Writes how far the textures of a woven material are off its threads. */
static void baked_write(Json *json, const WeftBaked *baked) {
    json_open(json, "baked", '{');
    json_number(json, "copied", baked->copied);
    json_number(json, "fitted", baked->fitted);
    json_number(json, "even_sky", baked->sky);
    json_number(json, "contrast", baked->contrast);
    json_number(json, "levels", baked->levels);
    json_close(json, '}');
}

static void materials_write(Json *json, const TargetFile *file) {
    json_open(json, "materials", '[');
    for (int k = 0; k < file->delivery.material_count; k++) {
        const WeftDelivered *material = &file->delivery.materials[k];
        const WeftBaked *baked = file->source ? &file->source->materials[k] : NULL;
        json_open(json, NULL, '{');
        json_text(json, "material", material->name);
        json_number(json, "copied", material->found.copied);
        json_number(json, "matched", material->found.matched);
        json_number(json, "even_sky", material->even_sky);
        if (baked && baked->copied > 0.0) baked_write(json, baked);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void target_file_write(Json *json, const Delivery *delivery, const TargetFile *file) {
    const WeftTarget target = file_target(file);
    char name[DELIVER_PATH];
    json_open(json, NULL, '{');
    json_text(json, "target", target.name);
    json_text(json, "viewer", target.help);
    json_text(json, "profile", target.profile);
    json_open(json, "files", '{');
    snprintf(name, sizeof name, "%s-%s%s", delivery->name, target.name, file_suffix(file));
    json_text(json, file->target == TARGET_U3M ? "u3m" : "gltf", name);
    snprintf(name, sizeof name, "%s-%s.png", delivery->name, target.name);
    json_text(json, "sheet", name);
    json_close(json, '}');
    json_whole(json, "bytes", file->bytes);
    json_open(json, "errors", '{');
    for (int v = 0; v < VIEW_COUNT; v++) view_write(json, view_keys[v], &file->errors.views[v]);
    json_number(json, "even_sky", file->errors.sky);
    json_close(json, '}');
    lines_write(json, "extensions", file->delivery.extensions);
    json_open(json, "lost", '[');
    losses_write(json, &delivery->losses);
    losses_write(json, &file->delivery.losses);
    json_close(json, ']');
    materials_write(json, file);
    json_close(json, '}');
}

void summary_write(const Delivery *delivery, FILE *stream) {
    Json json = {.stream = stream};
    json_open(&json, NULL, '{');
    json_text(&json, "source", delivery->what);
    json_text(&json, "name", delivery->name);
    json_text(&json, "reference", delivery->reference);
    json_text(&json, "metric", weft_brdf_metric_name(delivery->metric));
    json_open(&json, "pictures", '{');
    json_whole(&json, "width", delivery->width);
    json_whole(&json, "height", delivery->height);
    json_whole(&json, "samples_per_pixel", delivery->spp);
    for (int v = 0; v < VIEW_COUNT; v++) json_text(&json, view_keys[v], delivery->cameras[v]);
    json_close(&json, '}');
    json_open(&json, "targets", '[');
    for (int k = 0; k < delivery->count; k++) target_file_write(&json, delivery, &delivery->files[k]);
    json_close(&json, ']');
    json_close(&json, '}');
}

/* Prints what was lost, a line each; after the first one, indented by so many columns. Returns the count of lines. */
static int losses_print(const WeftLosses *losses, int materials, int indent) {
    int lines = 0;
    for (int k = 0; k < losses->count; k++) {
        const WeftLoss *loss = &losses->items[k];
        const int count = loss_count(losses, k);
        if (count == 0) continue;
        printf("%*s%s%s%s", lines++ ? indent : 0, "", loss->what, loss->why[0] ? ": " : "", loss->why);
        if (materials > 1) printf(" (%d of %d materials)", count, materials);
        printf("\n");
    }
    return lines;
}

void summary_print(const Delivery *delivery) {
    enum { LOST = 69 }; /* the column of what is lost */
    printf("%-10s %22s %22s %9s  lost\n", "", "near: colour, columns", "far: colour, columns", "even sky");
    for (int k = 0; k < delivery->count; k++) {
        const TargetFile *file = &delivery->files[k];
        const ViewErrors *views = file->errors.views;
        const WeftTarget target = file_target(file);
        printf("%-10s", target.name);
        for (int v = 0; v < VIEW_COUNT; v++)
            printf(" %11.1f %% %6.1f %%", 100.0 * views[v].color, 100.0 * views[v].profile);
        printf(" %+7.1f %%  ", 100.0 * file->errors.sky);
        if (losses_print(&file->delivery.losses, delivery->materials, LOST) == 0) printf("nothing\n");
    }
    if (!delivery->losses.count) return;
    printf("in all: ");
    losses_print(&delivery->losses, delivery->materials, 8);
}
