#define _POSIX_C_SOURCE 200809L
#include "view/viewer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <epoxy/gl.h>

#include "base/steady_clock.h"
#include "view/browser.h"
#include "view/examine.h"
#include "view/file_watch.h"
#include "view/frame_requests.h"
#include "view/opening.h"
#include "view/replay.h"
#include "view/state_report.h"

void viewer_say(Viewer *v, bool grave, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(v->message, sizeof v->message, format, list);
    va_end(list);
    v->message_grave = grave;
}

void viewer_upload(unsigned *texture, const WeftImage *image) {
    GLenum format = image->channels == 4 ? GL_RGBA : GL_RGB;
    bool made = *texture != 0;
    if (!made) glGenTextures(1, texture);
    glBindTexture(GL_TEXTURE_2D, *texture);
    if (!made) {
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image->width, image->height, 0, format, GL_UNSIGNED_BYTE,
                 image->pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
}

Shows viewer_shows(const Viewer *v) {
    bool asked = v->mode != MODE_LIVE, instead = v->traced.number > v->rendered.number;
    if (v->reference_texture && (asked || instead)) return SHOWS_TRACED;
    return v->rendered.texture && v->rendered.scene == v->scene ? SHOWS_DRAWN : SHOWS_NOTHING;
}

const char *shows_name(Shows shows) {
    static const char *const names[] = {"nothing", "drawn", "traced"};
    return names[shows];
}

void viewer_show_maps(Viewer *v) {
    if (v->facts.thumbs.pixels) viewer_upload(&v->thumbs, &v->facts.thumbs);
}

float viewer_aspect(const Viewer *v) {
    return v->stage.height >= 1.0f ? fmaxf(v->stage.width, 1.0f) / v->stage.height : 1.0f;
}

static void note_history(Viewer *v) {
    bool held = v->input.button[0] || v->input.button[1] || v->input.button[2];
    if (v->has_scene && !scene_state_same(&v->state, &v->before)) {
        if (v->state.material_count == v->before.material_count) history_keep(&v->history, &v->before);
        SceneState copy;
        if (scene_state_copy(&copy, &v->state)) {
            scene_state_free(&v->before);
            v->before = copy;
        }
    }
    if (!held && !ui_types()) history_close(&v->history); /* a drag is one step, and so is what is typed */
}

static void lay_out(Viewer *v) {
    int width, height;
    window_size(v->window, &width, &height);
    float scale = ui_scale(), bar = 22.0f * scale,
          side = fminf(v->settings.panel * scale, 0.6f * (float)width);
    float top = 2.0f * ui_line_height() - 4.0f * scale;
    v->stage =
        (UiBox){0.0f, top, floorf((float)width - side), floorf(fmaxf((float)height - top - bar, 1.0f))};
}

static void draw_side(Viewer *v) {
    static const char *const names[] = {"Material", "Light", "View", "Inspect", "Doctor", NULL};
    static const char *const tips[] = {"What surfaces are made of: models and numbers.",
                                       "Lights, and the environment.", "Camera, exposure, comparison, tools.",
                                       "What a material does with light, and what a pixel is made of.",
                                       "What will go wrong with the file that is open, and in which engine."};
    static void (*const panels[])(Viewer * v) = {material_panel, light_panel, view_panel, inspect_panel,
                                                 doctor_panel};
    int width, height;
    window_size(v->window, &width, &height);
    float x = v->stage.width + 1.0f, y = v->stage.y, row = ui_line_height();
    UiBox head = {x, y, (float)width - x, row + 8.0f * ui_scale()};
    UiBox body = {x, y + head.height, head.width, fmaxf(v->stage.height - head.height, 1.0f)};
    if (ui_panel("Side", head, false)) ui_tabs("Panel", names, tips, &v->panel);
    ui_panel_end();
    ui_scope(names[v->panel]);
    if (ui_panel(names[v->panel], body, true) && v->has_scene) panels[v->panel](v);
    ui_panel_end();
    ui_scope_end();
}

static void draw_frame(Viewer *v) {
    window_bind(v->window);
    ui_begin(&v->input);
    stage_draw(v);
    menu_draw(v);
    draw_side(v);
    status_draw(v);
    dialogs_draw(v);
    ui_end();
    window_cursor(v->window, ui_cursor());
    window_present(v->window);
}

static void run_frame(Viewer *v, double started) {
    v->input.seconds = v->replay ? 1.0f / 60.0f : (float)fmin(started - v->clock, 0.1);
    v->clock = started;
    v->frame++;
    lay_out(v);
    keys_input(v);
    stage_input(v);
    requests_send(v);
    requests_wait_frame(v);
    requests_read_camera(v);
    requests_take_events(v);
    requests_take_reference(v);
    draw_frame(v);
    requests_send(v);
    note_history(v);
    v->worst_seconds = fmax(v->worst_seconds, clock_now() - started);
    v->frame_seconds += 0.1 * (clock_now() - started - v->frame_seconds);
    v->picture_seconds = (double)v->rendered.whole_seconds;
}

static bool start(Viewer *v, char why[512]) {
    WindowDesc desc = {.title = "weft", .unseen = v->desc->unseen, .scale = v->desc->scale};
    desc.width = v->desc->width ? v->desc->width : v->settings.width;
    desc.height = v->desc->height ? v->desc->height : v->settings.height;
    v->window = window_open(&desc, why);
    if (!v->window) return false;
    snprintf(why, 512, "out of memory");
    if (!ui_create(window_scale(v->window), window_clipboard(v->window))) return false;
    v->reference = reference_start(v->window);
    if (v->reference)
        v->renderer = renderer_start(v->window, v->reference, v->desc->shader_dir, v->desc->occlusion);
    v->file_watch = file_watch_start();
    v->browser = browser_create(v->settings.folder);
    if (!v->renderer || !v->file_watch || !v->browser) return false;
    lay_out(v);
    opening_begin(v);
    return true;
}

static void stop(Viewer *v) {
    examination_free(v->examination);
    if (v->loader) loader_finish(v->loader, NULL);
    if (v->leaving) loader_finish(v->leaving, NULL);
    renderer_stop(v->renderer);
    reference_stop(v->reference);
    replay_close(v->replay);
    file_watch_stop(v->file_watch);
    if (v->browser) snprintf(v->settings.folder, sizeof v->settings.folder, "%s", browser_folder(v->browser));
    browser_free(v->browser);
    if (v->window) {
        window_size(v->window, &v->settings.width, &v->settings.height);
        if (v->has_scene && !v->desc->forget) settings_write(&v->settings);
        glDeleteTextures(1, &v->reference_texture);
        glDeleteTextures(1, &v->profiles_texture);
        glDeleteTextures(1, &v->thumbs);
        ui_destroy();
    }
    window_close(v->window);
    inspection_free(v->inspection);
    weft_image_free(&v->profiles);
    opening_forget(v);
    if (v->has_pending) loaded_free(&v->pending);
}

/* Returns how long the window may wait, s, before it looks at files again. */
static double patience(const Viewer *v, int due) {
    bool flies = false;
    static const int keys[] = {'W', 'A', 'S', 'D', 'Q', 'E'};
    for (int k = 0; k < 6; k++) flies |= v->input.key[keys[k]];
    if (window_hidden(v->window)) return 0.25;
    if (due > 0 || flies || v->desc->frames) return 0.0;
    if (v->replay) return 0.005;
    return requests_can_refine(v) ? 0.05 : 0.25;
}

static int run(Viewer *v, char why[512]) {
    int due = 3; /* frames until all widgets have settled */
    why[0] = '\0';
    while (!window_closing(v->window) && !v->ending) {
        unsigned shown = v->rendered.number;
        window_wait(v->window, patience(v, due));
        double started = clock_now();
        if (v->replay && !replay_step(v->replay, v, why)) return WEFT_INPUT;
        bool any = window_take(v->window, &v->input);
        for (char *path; (path = window_dropped(v->window)); free(path)) viewer_open(v, path), any = true;
        opening_poll(v);
        any |= opening_watch(v, started);
        any |= renderer_has_output(v->renderer) || reference_has_frame(v->reference) || v->loader ||
               v->rendered.number != shown;
        any |= requests_can_refine(v) && v->mode == MODE_LIVE;
        if (!v->has_scene && v->opened != WEFT_OK) {
            snprintf(why, 512, "%s", v->message);
            return (int)v->opened;
        }
        if (v->replay && replay_acts(v->replay) && due < 1) due = 1;
        if (any || doctor_busy(v) || inspection_busy(v->panel == PANEL_INSPECT ? v->inspection : NULL))
            due = 3;
        bool settled = due <= 0;
        if (window_hidden(v->window) || (settled && !v->desc->frames)) { /* frames that are counted go on */
            v->clock = started;
            continue;
        }
        if (!settled) due--;
        run_frame(v, started);
        if (v->desc->report) report_state(v, due == 0 && !settled);
        if (v->desc->frames && v->frame >= v->desc->frames) break;
    }
    return 0;
}

int view_run(const ViewDesc *desc, char why[512]) {
    Viewer *v = calloc(1, sizeof *v);
    if (!v) {
        snprintf(why, 512, "out of memory");
        return WEFT_RESOURCES;
    }
    v->desc = desc;
    v->settings = settings_default();
    if (!desc->forget) settings_read(&v->settings);
    v->tonemap = desc->tonemap;
    v->exposure = desc->exposure;
    v->background = desc->background;
    memcpy(v->background_color, desc->background_color, sizeof v->background_color);
    v->floor = desc->floor;
    v->hide_lights = desc->hide_lights;
    v->split_at = 0.5f;
    v->dragged_light = -1;
    v->brush = (Brush){.radius = 0.05f, .strength = 0.7f};
    int code = WEFT_INPUT;
    if (!desc->script || (v->replay = replay_open(desc->script, why)))
        code = start(v, why) ? run(v, why) : WEFT_RESOURCES;
    stop(v);
    free(v);
    return code;
}
