#define _POSIX_C_SOURCE 200809L
#include "view/viewer.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include <epoxy/gl.h>

#include "view/browser.h"
#include "view/inputs.h"
#include "view/paths.h"
#include "view/replay.h"
#include "view/report.h"
#include "view/watchman.h"

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void viewer_say(Viewer *v, bool grave, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(v->message, sizeof v->message, format, list);
    va_end(list);
    v->message_grave = grave;
}

static void add_warnings(Viewer *v, const char *lines) {
    size_t used = strlen(v->warnings);
    if (lines) snprintf(v->warnings + used, sizeof v->warnings - used, "%s", lines);
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

float viewer_aspect(const Viewer *v) {
    return v->stage.height >= 1.0f ? fmaxf(v->stage.width, 1.0f) / v->stage.height : 1.0f;
}

/* ---- opening ---- */

static void open_scene(Viewer *v, const char *path, bool again) {
    if (v->loader) loader_finish(v->loader, NULL);
    bool dressed = !v->dressed[0] || strcmp(v->dressed, path) == 0;
    if (!v->dressed[0]) snprintf(v->dressed, sizeof v->dressed, "%s", path);
    v->loader = loader_start(v->window, v->desc, path, again, dressed);
    if (!v->loader) viewer_say(v, true, "%.300s: out of memory", path);
}

/* What a picture is for, by its name: "velvet_normal.png". */
static int guess_input(const char *path) {
    static const char *const words[][2] = {{"normal", "normal"},     {"sheenrough", "sheen_roughness"},
                                           {"sheen", "sheen_color"}, {"rough", "roughness"},
                                           {"metal", "metallic"},    {"specular", "specular_color"},
                                           {"emissi", "emission"},   {"opacity", "opacity"},
                                           {"nap", "nap_direction"}, {"occlusion", "occlusion"}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (path_contains(path, words[k][0])) return input_number(words[k][1]);
    return input_number("base_color");
}

static void light_by(Viewer *v, const char *path) {
    v->look.around.kind = AROUND_FILE;
    snprintf(v->look.around.path, sizeof v->look.around.path, "%s", path);
}

void viewer_open(Viewer *v, const char *path) {
    PathKind kind = path_kind(path);
    if (!v->has_scene && kind != PATH_SCENE) {
        viewer_say(v, true, "%.300s: open a scene first", path);
        return;
    }
    switch (kind) {
    case PATH_SCENE: open_scene(v, path, false); break;
    case PATH_LIGHT: light_by(v, path); break;
    case PATH_MATERIAL: viewer_task(v, TASK_DRESS, path, v->material, -1); break;
    case PATH_PICTURE:
        snprintf(v->dropped, sizeof v->dropped, "%s", path);
        v->dropped_input = guess_input(path);
        viewer_dialog(v, "Use a picture");
        break;
    case PATH_FOLDER:
        if (path_is_cubemap(path))
            light_by(v, path);
        else
            viewer_task(v, TASK_WEAR, path, -1, -1);
        break;
    case PATH_UNKNOWN:
        viewer_say(v, true,
                   "%.300s: is no scene (.gltf .glb), light (.hdr .exr), material (.json) or picture", path);
        break;
    }
}

static void set_home(Viewer *v, const float eye[3], const float target[3]) {
    memcpy(v->home, target, sizeof v->home);
    v->reach = 0.0f;
    for (int k = 0; k < 3; k++) v->reach = hypotf(v->reach, eye[k] - target[k]);
    v->reach = fmaxf(0.5f * v->reach, 1e-3f);
}

/* Where it is seen from; how large things are, until the painter knows what is in the middle. */
static void start_seeing(Viewer *v, const Loaded *loaded) {
    bool first = strcmp(v->dressed, loaded->path) == 0;
    const char *camera = first ? v->desc->camera : NULL;
    bool builtin = strncmp(loaded->path, "builtin:", 8) == 0;
    if (!camera) camera = builtin && loaded->facts.info.camera_count ? "0" : "auto";
    if (!orbit_at(&v->orbit, loaded->scene, camera, viewer_aspect(v))) {
        viewer_say(v, true, "%.100s: %s", camera, weft_message_text(WEFT_MESSAGE_CAMERA_NAME));
        orbit_at(&v->orbit, loaded->scene, "auto", viewer_aspect(v));
    }
    v->at_home = false;
    set_home(v, v->orbit.eye, v->orbit.target);
}

/* What was edited stays edited where the scene is read again; maps are those of the file. */
static void keep_edits(const Viewer *v, Look *look) {
    for (int k = 0; k < look->material_count; k++) {
        if (look_same_material(&v->look, &v->first, k)) continue;
        WeftMaterial m = *look_material(&v->look, k);
        for (int i = 0; i < WEFT_INPUTS_MAX; i++)
            if (m.inputs[i].texture) m.inputs[i].texture = look_material(look, k)->inputs[i].texture;
        look_set_material(look, k, &m);
    }
    look->light_count = v->look.light_count;
    memcpy(look->lights, v->look.lights, sizeof look->lights);
    look->around = v->look.around;
    look_take_naps(look, &v->look);
}

static void forget_scene(Viewer *v) {
    look_free(&v->look);
    look_free(&v->first);
    look_free(&v->before);
    look_free(&v->sent);
    look_free(&v->other);
    history_free(&v->history);
    history_free(&v->other_history);
    facts_free(&v->facts);
}

/* Those of the panels, of a scene that is another one. */
static void choose_first(Viewer *v, const Look *look) {
    v->material = v->light = 0;
    v->variant = -1;
    v->has_probe = v->has_copied = false;
    v->save_path[0] = v->shot_path[0] = '\0';
    for (int k = look->material_count - 1; k >= 0; k--) /* the first that has a sheen */
        if (weft_material_reads(look_material(look, k), input_number("sheen_roughness"))) v->material = k;
}

enum { WATCH_SCENE, WATCH_LIGHT };

/* The scene's own file and the light's; those of textures are the painter's to watch. */
static void watch_files(Viewer *v) {
    watchman_forget(v->watchman);
    if (strncmp(v->facts.path, "builtin:", 8) != 0) watchman_watch(v->watchman, v->facts.path, WATCH_SCENE);
    if (v->look.around.kind == AROUND_FILE) watchman_watch(v->watchman, v->look.around.path, WATCH_LIGHT);
    snprintf(v->watched, sizeof v->watched, "%s", v->look.around.path);
}

static bool poll_files(Viewer *v, double seconds) {
    if (v->has_scene && strcmp(v->watched, v->look.around.path) != 0) watch_files(v);
    if (v->loader || v->has_pending) return false;
    int changed = watchman_look(v->watchman, seconds);
    if (changed == WATCH_SCENE) open_scene(v, v->facts.path, true);
    if (changed == WATCH_LIGHT) v->look.around.again = v->other.around.again = v->look.around.again + 1;
    return changed >= 0;
}

/* The scene that was read goes to the painter; it is shown once that can draw it. */
static void hand_over(Viewer *v, Loaded *loaded) {
    if (v->has_pending) loaded_free(&v->pending);
    if (!loaded->again || !v->has_scene) start_seeing(v, loaded);
    painter_give(v->painter, loaded->scene, &loaded->look, ++v->scenes);
    loaded->scene = NULL;
    v->pending = *loaded;
    v->has_pending = true;
    *loaded = (Loaded){0};
}

static void show_scene(Viewer *v, Loaded *loaded) {
    Look look, before;
    bool again = loaded->again && v->has_scene && loaded->look.material_count == v->look.material_count &&
                 strcmp(loaded->path, v->facts.path) == 0;
    if (!look_copy(&look, &loaded->look)) return;
    if (again) keep_edits(v, &look);
    if (!look_copy(&before, &look)) {
        look_free(&look);
        return;
    }
    forget_scene(v);
    v->look = look;
    v->before = before;
    v->first = loaded->look;
    v->facts = loaded->facts;
    loaded->look = (Look){0};
    loaded->facts = (Facts){0};
    v->split = SPLIT_NONE;
    v->side = 0;
    if (!again) choose_first(v, &v->look);
    v->has_scene = v->ask = true;
    v->profiles_made = false;
    snprintf(v->warnings, sizeof v->warnings, "%s", loaded->said ? loaded->said : "");
    settings_opened(&v->settings, v->facts.path);
    watch_files(v);
}

/* The painter has taken the scene, or could not: then the old one stays. */
static void take_scene(Viewer *v, const News *news) {
    if (!v->has_pending || news->scene != v->scenes) return;
    Loaded loaded = v->pending;
    v->has_pending = false;
    if (!news->failed) {
        bool first = !v->has_scene;
        char title[300];
        show_scene(v, &loaded);
        v->scene = news->scene;
        viewer_say(v, false, "%.200s: %lld triangles, %d materials", v->facts.path,
                   v->facts.info.triangle_count, v->facts.info.material_count);
        snprintf(title, sizeof title, "weft - %.200s", path_name(v->facts.path));
        window_title(v->window, title);
        if (first && v->desc->materials) viewer_task(v, TASK_WEAR, v->desc->materials, -1, -1);
    }
    loaded_free(&loaded);
}

static void poll_loader(Viewer *v) {
    Loaded loaded;
    if (!v->loader || !loader_done(v->loader)) return;
    loader_finish(v->loader, &loaded);
    v->loader = NULL;
    if (loaded.scene)
        hand_over(v, &loaded);
    else
        viewer_say(v, true, "%s", loaded.failure);
    loaded_free(&loaded);
}

/* ---- orders and what comes back ---- */

static bool same_order(const Order *a, const Order *b) {
    WeftRasterView x = a->view, y = b->view;
    x.camera = y.camera = NULL;
    bool same = a->split == b->split && a->scene == b->scene && a->tonemap == b->tonemap &&
                a->truth == b->truth && a->compare == b->compare && strcmp(a->camera, b->camera) == 0 &&
                memcmp((const char *)&x, (const char *)&y, sizeof x) == 0;
    return same && !(a->at < b->at) && !(a->at > b->at) && !(a->exposure < b->exposure) &&
           !(a->exposure > b->exposure);
}

/* Both looks and how they are seen; the looks are borrowed. */
static Order make_order(const Viewer *v) {
    Order order = {.scene = v->scene,
                   .edited = v->side,
                   .split = v->split,
                   .at = v->split_at,
                   .tonemap = v->tonemap,
                   .exposure = v->exposure};
    order.look = v->side == 0 || v->split == SPLIT_NONE ? v->look : v->other;
    order.other = v->side == 0 || v->split == SPLIT_NONE ? v->other : v->look;
    order.view.width = (int)fmaxf(v->stage.width, 16.0f);
    order.view.height = (int)fmaxf(v->stage.height, 16.0f);
    order.view.background = v->background;
    memcpy(order.view.background_color, v->background_color, sizeof order.view.background_color);
    order.view.part = v->part;
    order.view.ambient = v->ambient;
    order.truth = v->mode != MODE_LIVE;
    order.compare = v->mode == MODE_DIFFERENCE;
    if (v->mode != MODE_LIVE) {
        order.split = SPLIT_NONE;
        order.edited = 0;
        order.look = v->look;
        order.view.part = WEFT_PART_ALL;
    }
    orbit_text(&v->orbit, order.camera);
    return order;
}

static void order_truth(Viewer *v, const Order *order) {
    TruthOrder t;
    memset(&t, 0, sizeof t); /* compared byte by byte */
    t.wanted = v->mode != MODE_LIVE && v->has_scene;
    t.desc.width = order->view.width, t.desc.height = order->view.height;
    t.desc.background = order->view.background;
    memcpy(t.desc.background_color, order->view.background_color, sizeof t.desc.background_color);
    snprintf(t.camera, sizeof t.camera, "%s", order->camera);
    t.tonemap = order->tonemap, t.exposure = order->exposure;
    t.background[0] = t.background[1] = 0.16f, t.background[2] = 0.17f;
    t.difference = v->mode == MODE_DIFFERENCE;
    t.samples = TRACE_SAMPLES;
    truth_order(v->truth, &t);
}

/* Whether the picture that is shown is right but for its finish. */
static bool can_be_finer(const Viewer *v) {
    return v->has_scene && v->painted.number == v->ordered && v->painted.texture &&
           v->painted.effort < EFFORT_SMOOTH;
}

/* Sends what is wanted where it is something else than before. */
static void send_order(Viewer *v) {
    if (!v->has_scene || v->stage.width < 1.0f) return;
    Order order = make_order(v);
    bool changed = v->ask || !same_order(&order, &v->order) || !look_same(&v->look, &v->sent);
    if (changed) v->changed = now();
    bool finer = can_be_finer(v) && now() - v->changed > 0.12;
    if (!changed && !finer) return;
    order.effort = finer ? (Effort)(v->painted.effort + 1) : EFFORT_COARSE;
    v->ordered = painter_order(v->painter, &order);
    order_truth(v, &order);
    look_free(&v->sent);
    if (!look_copy(&v->sent, &v->look)) v->sent = (Look){0};
    order.look = order.other = (Look){0};
    v->order = order;
    v->ask = false;
    if (changed) v->has_probe = false;
}

/* Where a camera of the scene stands is known once it has been drawn through. */
static void take_camera(Viewer *v) {
    const Painted *p = &v->painted;
    if (!v->orbit.name[0] || p->number != v->ordered || !p->texture) return;
    memcpy(v->orbit.eye, p->eye, sizeof p->eye);
    memcpy(v->orbit.target, p->target, sizeof p->target);
    if (p->fov > 0.0f) v->orbit.fov = p->fov;
    if (v->at_home || !p->focused) return;
    v->at_home = true;
    set_home(v, p->eye, p->target);
}

/* A newer picture is waited for a little: of what was just asked for, or of the frame before, while the
 * painter is at this one's. So window and painter work side by side, and no picture is more than two frames
 * behind. */
static void await_picture(Viewer *v) {
    double until = now() + 0.04;
    unsigned before = v->painted.number;
    painter_look(v->painter, &v->painted);
    bool waits = v->has_scene && !v->late && v->mode == MODE_LIVE;
    while (waits && v->painted.number == before && before != v->ordered && now() < until) {
        window_wait(v->window, 0.004);
        painter_look(v->painter, &v->painted);
    }
    v->late = v->painted.number == before && before != v->ordered;
}

static void take_truth(Viewer *v) {
    TruthPicture picture;
    if (!truth_take(v->truth, &picture)) return;
    if (picture.image.pixels) {
        viewer_upload(&v->truth_texture, &picture.image);
        v->truth_width = picture.image.width, v->truth_height = picture.image.height;
        weft_image_free(&picture.image);
    }
    v->traced = picture;
    if (picture.failure[0]) viewer_say(v, true, "%s", picture.failure);
}

/* The look is another one, of which history knows. */
static void settle_look(Viewer *v) {
    look_free(&v->before);
    look_copy(&v->before, &v->look);
    v->ask = true;
}

static void take_dressed(Viewer *v, News *news) {
    Around around = v->look.around;
    history_close(&v->history);
    history_keep(&v->history, &v->look);
    history_close(&v->history);
    look_free(&v->look);
    v->look = news->look;
    v->look.around = around;
    news->look_changed = false;
    settle_look(v);
}

static void take_news(Viewer *v) {
    News news;
    while (painter_news(v->painter, &news)) {
        if (news.text[0]) viewer_say(v, news.failed, "%s", news.text);
        if (news.kind == TASK_SCENE) take_scene(v, &news);
        if (news.scene != v->scene) { /* of one that is gone */
            news_free(&news);
            continue;
        }
        if (news.look_changed) take_dressed(v, &news);
        if (news.kind == TASK_PROBE && !news.failed) {
            v->probe = news.probe;
            v->has_probe = news.probe.hit;
        }
        if (news.kind == TASK_PICK && !news.failed && news.stamp) stage_picked(v, &news.probe, news.stamp);
        if (news.kind == TASK_PROFILES && news.image.pixels) {
            viewer_upload(&v->profiles_texture, &news.image);
            v->profiles_width = news.image.width, v->profiles_height = news.image.height;
            weft_image_free(&v->profiles);
            v->profiles = news.image;
            news.image = (WeftImage){0};
            v->profiles_made = true;
        }
        news_free(&news);
    }
    char *said = painter_said(v->painter);
    add_warnings(v, said);
    free(said);
    if (strcmp(v->shader_complaint, v->painted.complaint) != 0) {
        memcpy(v->shader_complaint, v->painted.complaint, sizeof v->shader_complaint);
        if (v->shader_complaint[0])
            viewer_say(v, true, "shader: %s", v->shader_complaint);
        else
            viewer_say(v, false, "shaders compile again");
    }
    if (strcmp(v->failure, v->painted.failure) != 0) {
        memcpy(v->failure, v->painted.failure, sizeof v->failure);
        viewer_say(v, v->failure[0] != '\0', "%s", v->failure);
    }
}

/* ---- what can be asked for ---- */

void viewer_task(Viewer *v, TaskKind kind, const char *path, int index, int input) {
    Task task = {.kind = kind, .scene = v->scene, .index = index, .input = input};
    if (path && strlen(path) >= sizeof task.path) {
        viewer_say(v, true, "%.100s...: is too long a path", path);
        return;
    }
    if (path) snprintf(task.path, sizeof task.path, "%s", path);
    painter_task(v->painter, &task);
}

void viewer_undo(Viewer *v) {
    bool done = history_undo(&v->history, &v->look);
    if (done) settle_look(v);
    viewer_say(v, false, done ? "undone" : "there is nothing to undo");
}

void viewer_redo(Viewer *v) {
    bool done = history_redo(&v->history, &v->look);
    if (done) settle_look(v);
    viewer_say(v, false, done ? "done again" : "there is nothing to do again");
}

void viewer_mode(Viewer *v, Mode mode) { v->mode = v->mode == mode ? MODE_LIVE : mode; }

/* What is not edited is kept while the comparison is off. */
void viewer_split(Viewer *v, Split split) {
    if (!v->has_scene) return;
    if (split != SPLIT_NONE && !v->other.materials && !look_copy(&v->other, &v->look)) return;
    v->split = split;
    v->ask = true;
}

void viewer_swap(Viewer *v) {
    Look before;
    if (v->split == SPLIT_NONE || !look_copy(&before, &v->other)) return;
    Look kept = v->look;
    v->look = v->other;
    v->other = kept;
    v->side = !v->side;
    look_free(&v->before);
    v->before = before;
    History history = v->history;
    v->history = v->other_history;
    v->other_history = history;
    v->ask = true;
}

void viewer_frame_selection(Viewer *v) {
    if (v->has_scene) orbit_frame(&v->orbit, v->facts.info.low, v->facts.info.high, viewer_aspect(v));
}

void viewer_reset_camera(Viewer *v) {
    snprintf(v->orbit.name, sizeof v->orbit.name, "%s", v->facts.info.camera_count ? "0" : "auto");
}

static void offer_path(Viewer *v, char *path, const char *suffix) {
    if (path[0]) return;
    char stem[200];
    path_stem(v->facts.path, stem, sizeof stem);
    snprintf(path, LOOK_PATH, "%s%s", stem, suffix);
}

void viewer_shot(Viewer *v, const char *path) {
    if (!path) {
        offer_path(v, v->shot_path, "-weft.png");
        v->shot_width = (int)v->stage.width, v->shot_height = (int)v->stage.height;
        v->shot_truth = v->mode == MODE_TRUTH;
        viewer_dialog(v, "Save a picture");
        return;
    }
    Task task = {.kind = TASK_SHOT,
                 .scene = v->scene,
                 .width = v->shot_width,
                 .height = v->shot_height,
                 .transparent = v->shot_transparent,
                 .truth = v->shot_truth};
    snprintf(task.path, sizeof task.path, "%s", path);
    if (!weft_image_suffix_known(path))
        viewer_say(v, true, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    else
        painter_task(v->painter, &task);
}

void viewer_save(Viewer *v, const char *path) {
    if (!v->has_scene) return;
    if (!path) {
        offer_path(v, v->save_path, "-weft.glb");
        viewer_dialog(v, "Save the scene");
        return;
    }
    viewer_task(v, TASK_SAVE, path, v->material, -1);
}

void viewer_copy_command(Viewer *v) {
    bool lost = false;
    char *line = command_line(v, &lost);
    if (!line) return;
    const UiClipboard *clip = window_clipboard(v->window);
    clip->set(clip->user, line);
    viewer_say(v, lost,
               lost ? "copied, but for brushed nap and maps: save the scene and render that"
                    : "copied: %.400s",
               line);
    free(line);
}

void viewer_profiles(Viewer *v) {
    v->profiles_open = true;
    v->profiles_made = false;
    viewer_task(v, TASK_PROFILES, NULL, v->material, -1);
}

void viewer_dialog(Viewer *v, const char *name) {
    browser_refresh(v->browser);
    snprintf(v->open_dialog, sizeof v->open_dialog, "%s", name);
}

void viewer_set_material(Viewer *v, int index, const WeftMaterial *material) {
    if (!look_set_material(&v->look, index, material)) viewer_say(v, true, "out of memory");
}

bool viewer_at_rest(Viewer *v) {
    return !v->loader && !v->has_pending && painter_idle(v->painter) &&
           (!v->has_scene || v->painted.number == v->ordered) && !v->painted.busy &&
           (v->mode != MODE_LIVE || v->painted.effort == EFFORT_SMOOTH) && !v->ask &&
           (v->mode == MODE_LIVE || truth_resting(v->truth));
}

/* ---- one frame ---- */

static void note_history(Viewer *v) {
    bool held = v->input.button[0] || v->input.button[1] || v->input.button[2];
    if (v->has_scene && !look_same(&v->look, &v->before)) {
        if (v->look.material_count == v->before.material_count) history_keep(&v->history, &v->before);
        Look copy;
        if (look_copy(&copy, &v->look)) {
            look_free(&v->before);
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
    static const char *const names[] = {"Material", "Light", "View", "Inspect", NULL};
    static const char *const tips[] = {"What surfaces are made of: models and numbers.",
                                       "Lights, and what shines from far away.",
                                       "Camera, exposure, comparison, tools.",
                                       "What a material does with light, and what a pixel is made of."};
    int width, height;
    window_size(v->window, &width, &height);
    float x = v->stage.width + 1.0f, y = v->stage.y, row = ui_line_height();
    UiBox head = {x, y, (float)width - x, row + 8.0f * ui_scale()};
    UiBox body = {x, y + head.height, head.width, fmaxf(v->stage.height - head.height, 1.0f)};
    if (ui_panel("Side", head, false)) ui_tabs("Panel", names, tips, &v->panel);
    ui_panel_end();
    ui_scope(names[v->panel]);
    if (ui_panel(names[v->panel], body, true) && v->has_scene) {
        if (v->panel == 0) material_panel(v);
        if (v->panel == 1) light_panel(v);
        if (v->panel == 2) view_panel(v);
        if (v->panel == 3) inspect_panel(v);
    }
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
    send_order(v);
    await_picture(v);
    take_camera(v);
    take_news(v);
    take_truth(v);
    draw_frame(v);
    send_order(v);
    note_history(v);
    v->worst_seconds = fmax(v->worst_seconds, now() - started);
    v->frame_seconds += 0.1 * (now() - started - v->frame_seconds);
    v->picture_seconds = (double)v->painted.whole_seconds;
}

static bool start(Viewer *v, char why[512]) {
    WindowDesc desc = {.title = "weft", .unseen = v->desc->unseen};
    desc.width = v->desc->width ? v->desc->width : v->settings.width;
    desc.height = v->desc->height ? v->desc->height : v->settings.height;
    v->window = window_open(&desc, why);
    if (!v->window) return false;
    snprintf(why, 512, "out of memory");
    if (!ui_create(window_scale(v->window), window_clipboard(v->window))) return false;
    v->truth = truth_start(v->window);
    if (v->truth) v->painter = painter_start(v->window, v->truth, v->desc->shader_dir, v->desc->occlusion);
    v->watchman = watchman_start();
    v->browser = browser_create(v->settings.folder);
    if (!v->painter || !v->watchman || !v->browser) return false;
    if (v->desc->script && !(v->replay = replay_open(v->desc->script, why))) return false;
    lay_out(v);
    open_scene(v, v->desc->scene ? v->desc->scene : "builtin:cloth", false);
    return true;
}

static void stop(Viewer *v) {
    if (v->loader) loader_finish(v->loader, NULL);
    painter_stop(v->painter);
    truth_stop(v->truth);
    replay_close(v->replay);
    watchman_stop(v->watchman);
    if (v->browser) snprintf(v->settings.folder, sizeof v->settings.folder, "%s", browser_folder(v->browser));
    browser_free(v->browser);
    if (v->window) {
        window_size(v->window, &v->settings.width, &v->settings.height);
        if (v->has_scene && !v->desc->forget) settings_write(&v->settings);
        glDeleteTextures(1, &v->truth_texture);
        glDeleteTextures(1, &v->profiles_texture);
        ui_destroy();
    }
    window_close(v->window);
    inspection_free(v->inspection);
    weft_image_free(&v->profiles);
    forget_scene(v);
    if (v->has_pending) loaded_free(&v->pending);
}

/* How long nothing needs to be drawn: files are looked at now and then. */
static double patience(const Viewer *v, int due) {
    bool flies = false;
    static const int keys[] = {'W', 'A', 'S', 'D', 'Q', 'E'};
    for (int k = 0; k < 6; k++) flies |= v->input.key[keys[k]];
    if (window_hidden(v->window)) return 0.25;
    if (due > 0 || flies) return 0.0;
    if (v->replay) return 0.005;
    return can_be_finer(v) ? 0.05 : 0.25;
}

static int run(Viewer *v, char why[512]) {
    int due = 3; /* frames until all widgets have settled */
    why[0] = '\0';
    while (!window_closing(v->window) && !v->ending) {
        unsigned shown = v->painted.number;
        window_wait(v->window, patience(v, due));
        double started = now();
        if (v->replay && !replay_step(v->replay, v, why)) return 1;
        bool any = window_take(v->window, &v->input);
        for (char *path; (path = window_dropped(v->window)); free(path)) viewer_open(v, path), any = true;
        poll_loader(v);
        any |= poll_files(v, started);
        any |= painter_fresh(v->painter) || truth_fresh(v->truth) || v->loader || v->painted.number != shown;
        any |= can_be_finer(v) && v->mode == MODE_LIVE;
        if (v->replay && replay_acts(v->replay) && due < 1) due = 1;
        if (any || inspection_busy(v->panel == 3 ? v->inspection : NULL)) due = 3;
        if (window_hidden(v->window) || due <= 0) {
            v->clock = started;
            continue;
        }
        due--;
        run_frame(v, started);
        if (v->desc->report) report_state(v, due == 0);
        if (v->desc->frames && v->frame >= v->desc->frames) break;
    }
    return 0;
}

int view_run(const ViewDesc *desc, char why[512]) {
    Viewer *v = calloc(1, sizeof *v);
    if (!v) {
        snprintf(why, 512, "out of memory");
        return 4;
    }
    v->desc = desc;
    v->settings = settings_default();
    if (!desc->forget) settings_read(&v->settings);
    v->tonemap = desc->tonemap;
    v->exposure = desc->exposure;
    v->background = desc->background;
    memcpy(v->background_color, desc->background_color, sizeof v->background_color);
    v->split_at = 0.5f;
    v->held_light = -1;
    v->brush = (Brush){.radius = 0.05f, .strength = 0.7f};
    int code = start(v, why) ? run(v, why) : 4;
    stop(v);
    free(v);
    return code;
}
