#define _POSIX_C_SOURCE 200809L
#include "view/state/viewer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <epoxy/gl.h>

#include "base/steady_clock.h"
#include "view/panels/examine.h"
#include "view/panels/panels.h"
#include "view/replay.h"
#include "view/state/states.h"
#include "view/state_report.h"
#include "view/ui/browser.h"

void viewer_report(Viewer *v, bool grave, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(v->states->frame.message, sizeof v->states->frame.message, format, list);
    va_end(list);
    v->states->frame.message_grave = grave;
}

void viewer_quit(Viewer *v) { v->states->frame.ending = true; }
void viewer_set_settings(Viewer *v, const Settings *settings) { v->states->frame.settings = *settings; }
void viewer_add_recent(Viewer *v, const char *path) { settings_opened(&v->states->frame.settings, path); }

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
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image->width, image->height, 0, format, GL_UNSIGNED_BYTE, image->pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
}

bool viewer_is_idle(const Viewer *v) {
    return !v->opening->loader && !v->opening->has_pending && !v->photographs->load && renderer_is_idle(v->renderer) &&
           (!v->shown->any || v->requests->rendered.number == v->requests->requested) && !v->requests->rendered.busy &&
           !doctor_busy(v) && (v->options->mode != MODE_LIVE || v->requests->rendered.effort == EFFORT_SMOOTH) &&
           !v->requests->due && (v->options->mode == MODE_LIVE || reference_is_idle(v->reference));
}

float viewer_aspect(const Viewer *v) {
    return v->states->frame.stage.height >= 1.0f
               ? fmaxf(v->states->frame.stage.width, 1.0f) / v->states->frame.stage.height
               : 1.0f;
}

static void lay_out(Viewer *v) {
    int width, height;
    window_size(v->window, &width, &height);
    float scale = ui_scale(), bar = 22.0f * scale,
          side = fminf(v->states->frame.settings.panel * scale, 0.6f * (float)width);
    float top = 2.0f * ui_line_height() - 4.0f * scale;
    UiBox stage = {0.0f, top, floorf((float)width - side), floorf(fmaxf((float)height - top - bar, 1.0f))},
          beside = {stage.width, top, 0.0f, stage.height};
    if (v->photographs->view.place == PHOTOGRAPH_BESIDE) {
        beside.x = floorf(0.5f * stage.width);
        beside.width = stage.width - beside.x;
        stage.width = beside.x;
    }
    v->states->frame.stage = stage;
    v->states->frame.beside = beside;
}

static void draw_side(Viewer *v) {
    static const char *const names[] = {"Material", "Light", "View", "Inspect", "Doctor", NULL};
    static const char *const tips[] = {"What surfaces are made of: models and numbers.", "Lights, and the environment.",
                                       "Camera, exposure, comparison, tools.",
                                       "What a material does with light, and what a pixel is made of.",
                                       "What will go wrong with the file that is open, and in which engine."};
    static void (*const panels[])(Viewer * v) = {material_panel, light_panel, view_panel, inspect_panel, doctor_panel};
    int width, height;
    window_size(v->window, &width, &height);
    float x = v->states->frame.beside.x + v->states->frame.beside.width + 1.0f, y = v->states->frame.stage.y,
          row = ui_line_height();
    UiBox head = {x, y, (float)width - x, row + 8.0f * ui_scale()};
    UiBox body = {x, y + head.height, head.width, fmaxf(v->states->frame.stage.height - head.height, 1.0f)};
    int panel = v->options->panel;
    if (ui_panel("Side", head, false) && ui_tabs("Panel", names, tips, &panel)) options_set_panel(v, panel);
    ui_panel_end();
    ui_scope(names[v->options->panel]);
    if (ui_panel(names[v->options->panel], body, true) && v->shown->any) panels[v->options->panel](v);
    ui_panel_end();
    ui_scope_end();
}

static void draw_frame(Viewer *v) {
    window_bind(v->window);
    ui_begin(&v->states->frame.input);
    stage_draw(v);
    menu_draw(v);
    draw_side(v);
    presets_draw(v);
    status_draw(v);
    dialogs_draw(v);
    ui_end();
    window_cursor(v->window, ui_cursor());
    window_present(v->window);
}

static void run_frame(Viewer *v, double started) {
    v->states->frame.input.seconds = v->replay ? 1.0f / 60.0f : (float)fmin(started - v->states->frame.clock, 0.1);
    v->states->frame.clock = started;
    v->states->frame.number++;
    lay_out(v);
    keys_input(v);
    stage_input(v);
    requests_send(v);
    requests_wait_frame(v);
    requests_read_camera(v);
    unsigned scene = v->shown->number;
    requests_take_events(v);
    if (v->shown->number != scene) doctor_forget(v);
    requests_take_reference(v);
    draw_frame(v);
    requests_send(v);
    const bool *button = v->states->frame.input.button;
    edit_note_changes(v, button[0] || button[1] || button[2] || ui_types());
    v->states->frame.worst_seconds = fmax(v->states->frame.worst_seconds, clock_now() - started);
    v->states->frame.frame_seconds += 0.1 * (clock_now() - started - v->states->frame.frame_seconds);
    v->states->frame.picture_seconds = (double)v->requests->rendered.whole_seconds;
}

static bool start(Viewer *v, char why[512]) {
    WindowDesc desc = {.title = "weft", .unseen = v->desc->unseen, .scale = v->desc->scale};
    desc.width = v->desc->width ? v->desc->width : v->states->frame.settings.width;
    desc.height = v->desc->height ? v->desc->height : v->states->frame.settings.height;
    v->window = window_open(&desc, why);
    if (!v->window) return false;
    snprintf(why, 512, "out of memory");
    if (!ui_create(window_scale(v->window), window_clipboard(v->window))) return false;
    v->reference = reference_start(v->window);
    if (v->reference) v->renderer = renderer_start(v->window, v->reference, v->desc->shader_dir, v->desc->occlusion);
    if (!v->renderer || !dialogs_begin(v)) return false;
    lay_out(v);
    return opening_begin(v);
}

static void stop(Viewer *v, bool interrupted) {
    Settings *settings = &v->states->frame.settings;
    doctor_forget(v);
    sessions_end(v, interrupted);
    renderer_stop(v->renderer);
    stills_end(v); /* afterwards, since the renderer may be saving its scene */
    bakings_end(v);
    reference_stop(v->reference);
    replay_close(v->replay);
    dialogs_end(v);
    if (v->window) {
        window_size(v->window, &settings->width, &settings->height);
        if (v->shown->any && !v->desc->forget) settings_write(settings);
    }
    requests_end(v);
    presets_free(v->presets);
    opening_end(v);
    photographs_end(v);
    if (v->window) ui_destroy();
    window_close(v->window);
    inspection_free(v->inspection);
    free(v->weave);
}

/* Returns how long the window may wait, s, before it looks at files again. */
static double patience(const Viewer *v, int due) {
    bool flies = false;
    static const int keys[] = {'W', 'A', 'S', 'D', 'Q', 'E'};
    for (int k = 0; k < 6; k++) flies |= v->states->frame.input.key[keys[k]];
    if (window_hidden(v->window)) return 0.25;
    if (due > 0 || flies || v->desc->frames) return 0.0;
    if (v->replay) return 0.005;
    return requests_can_refine(v) ? 0.05 : 0.25;
}

static int run(Viewer *v, char why[512]) {
    int due = 3; /* frames until all widgets have settled */
    why[0] = '\0';
    while (!v->states->frame.ending) {
        unsigned shown = v->requests->rendered.number;
        window_wait(v->window, patience(v, due));
        double started = clock_now();
        if (v->replay && !replay_step(v->replay, v, why)) return WEFT_INPUT;
        if (v->desc->interrupted && v->desc->interrupted()) {
            snprintf(why, 512, "interrupted: %s",
                     v->sessions->file.path[0] ? "the session is kept" : "the window ends");
            return WEFT_INTERRUPTED;
        }
        bool any = window_take(v->window, &v->states->frame.input);
        if (window_take_close(v->window)) leaving_quit(v), any = true;
        for (char *path; (path = window_dropped(v->window)); free(path)) opening_ask(v, path), any = true;
        opening_poll(v);
        sessions_poll(v, started);
        any |= opening_watch(v, started);
        any |= stills_poll(v);
        any |= bakings_poll(v);
        any |= photographs_poll(v);
        any |= presets_poll(v);
        any |= renderer_has_output(v->renderer) || reference_has_frame(v->reference) || v->opening->loader ||
               v->requests->rendered.number != shown;
        any |= (requests_can_refine(v) && v->options->mode == MODE_LIVE) || v->requests->glide;
        if (!v->shown->any && v->opening->opened != WEFT_OK) {
            snprintf(why, 512, "%s", v->states->frame.message);
            return (int)v->opening->opened;
        }
        if (v->replay && replay_acts(v->replay) && due < 1) due = 1;
        if (any || doctor_busy(v) || inspection_busy(v->options->panel == PANEL_INSPECT ? v->inspection : NULL))
            due = 3;
        bool settled = due <= 0;
        if (window_hidden(v->window) ||
            (settled && !v->desc->frames)) { /* with a count of frames the window does not rest */
            v->states->frame.clock = started;
            continue;
        }
        if (!settled) due--;
        run_frame(v, started);
        if (v->desc->report && due == 0 && !settled) {
            report_state(v);
            v->states->frame.worst_seconds = 0.0;
        }
        bool enough = v->desc->frames && v->states->frame.number >= v->desc->frames;
        if (enough && v->shown->any) break; /* before, what is asked for may yet fail */
    }
    return 0;
}

Viewer *viewer_create(const ViewDesc *desc) {
    typedef struct Both {
        Viewer viewer;
        struct States states;
    } Both;
    Both *both = calloc(1, sizeof *both);
    if (!both) return NULL;
    struct States *states = &both->states;
    both->viewer = (Viewer){.desc = desc,
                            .frame = &states->frame,
                            .opening = &states->opening,
                            .shown = &states->shown,
                            .edit = &states->edit,
                            .options = &states->options,
                            .camera = &states->camera,
                            .requests = &states->requests,
                            .dialogs = &states->dialogs,
                            .drag = &states->drag,
                            .stills = &states->stills,
                            .bakings = &states->bakings,
                            .leaving = &states->leaving,
                            .sessions = &states->sessions,
                            .photographs = &states->photographs,
                            .states = states};
    states->frame.settings = settings_default();
    options_begin(&both->viewer);
    stage_begin(&both->viewer);
    photographs_begin(&both->viewer);
    return &both->viewer;
}

/* Gives all threads one heap. With one each, what a compiler has freed in its own is of no use to the next, and the few
 * blocks that it keeps hold whole pages: 30 MiB of the built-in sewing machine by a software driver. */
static void share_heap(void) {
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, 1);
#endif
}

int view_run(const ViewDesc *desc, char why[512]) {
    share_heap();
    Viewer *v = viewer_create(desc);
    if (!v) {
        snprintf(why, 512, "out of memory");
        return WEFT_RESOURCES;
    }
    if (!desc->forget) settings_read(&v->states->frame.settings);
    int code = WEFT_INPUT;
    if (!desc->script || (v->replay = replay_open(desc->script, why)))
        code = start(v, why) ? run(v, why) : WEFT_RESOURCES;
    stop(v, code == WEFT_INTERRUPTED);
    free(v);
    return code;
}
