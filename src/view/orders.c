/* What the window wants to see, and what comes back from painter and path tracer. */
#define _POSIX_C_SOURCE 200809L
#include "view/orders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/clock.h"
#include "view/opening.h"

static void add_warnings(Viewer *v, const char *lines) {
    size_t used = strlen(v->warnings);
    if (lines) snprintf(v->warnings + used, sizeof v->warnings - used, "%s", lines);
}

static bool same_order(const Order *a, const Order *b) {
    WeftRasterView x = a->view, y = b->view;
    x.camera = y.camera = NULL;
    bool same = a->split == b->split && a->scene == b->scene && a->tonemap == b->tonemap &&
                a->truth == b->truth && a->compare == b->compare && strcmp(a->camera, b->camera) == 0 &&
                memcmp((const char *)&x, (const char *)&y, sizeof x) == 0 &&
                memcmp((const char *)a->behind, (const char *)b->behind, sizeof a->behind) == 0;
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
    static const float dark[3] = {0.0219f, 0.0219f, 0.0246f};
    bool color = v->background == WEFT_BACKGROUND_COLOR;
    order.view.background = color ? WEFT_BACKGROUND_TRANSPARENT : v->background;
    order.view.floor = v->floor;
    order.view.hide_lights = v->hide_lights;
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
    order.laid_behind = color && order.view.part == WEFT_PART_ALL;
    memcpy(order.behind, order.laid_behind ? v->background_color : dark, sizeof order.behind);
    orbit_text(&v->orbit, order.camera);
    return order;
}

static void order_truth(Viewer *v, const Order *order) {
    TruthOrder t;
    memset(&t, 0, sizeof t); /* compared byte by byte */
    t.wanted = v->mode != MODE_LIVE && v->has_scene;
    t.desc.width = order->view.width, t.desc.height = order->view.height;
    t.desc.background = order->view.background;
    t.desc.floor = order->view.floor;
    t.desc.hide_lights = order->view.hide_lights;
    snprintf(t.camera, sizeof t.camera, "%s", order->camera);
    t.tonemap = order->tonemap, t.exposure = order->exposure;
    memcpy(t.behind, order->behind, sizeof t.behind);
    t.difference = v->mode == MODE_DIFFERENCE;
    t.samples = TRACE_SAMPLES;
    truth_order(v->truth, &t);
    bool moved = strcmp(v->order.camera, order->camera) != 0 || v->order.view.width != order->view.width ||
                 v->order.view.height != order->view.height || v->order.truth != order->truth ||
                 !look_same(&v->look, &v->sent);
    if (moved) v->traced.samples = 0.0; /* until there are some of this view */
}

/* Whether the picture that is shown is right but for its finish. */
bool orders_finer(const Viewer *v) {
    return v->has_scene && v->painted.number == v->ordered && v->painted.texture &&
           v->painted.effort < EFFORT_SMOOTH;
}

/* Sends what is wanted where it is something else than before. */
void orders_send(Viewer *v) {
    if (!v->has_scene || v->stage.width < 1.0f) return;
    Order order = make_order(v);
    bool changed = v->ask || !same_order(&order, &v->order) || !look_same(&v->look, &v->sent);
    if (changed) v->changed = now();
    bool finer = orders_finer(v) && now() - v->changed > 0.12;
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
void orders_camera(Viewer *v) {
    const Painted *p = &v->painted;
    if (!v->orbit.name[0] || p->number != v->ordered || !p->texture) return;
    memcpy(v->orbit.eye, p->eye, sizeof p->eye);
    memcpy(v->orbit.target, p->target, sizeof p->target);
    if (p->fov > 0.0f) v->orbit.fov = p->fov;
    if (v->at_home || !p->focused) return;
    v->at_home = true;
    opening_home(v, p->eye, p->target);
}

/* A newer picture is waited for a little: of what was just asked for, or of the frame before, while the
 * painter is at this one's. So window and painter work side by side, and no picture is more than two frames
 * behind. */
void orders_await(Viewer *v) {
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

void orders_truth(Viewer *v) {
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

/* A step of its own. */
static void keep_step(Viewer *v) {
    history_close(&v->history);
    history_keep(&v->history, &v->look);
    history_close(&v->history);
}

static bool lit_by(const Look *look, const char *path) {
    return look->around.kind == AROUND_FILE && strcmp(look->around.path, path) == 0;
}

/* The same file, read again, is no step: what it was before is gone. */
static void take_light(Viewer *v, const Around *around) {
    if (!lit_by(&v->look, around->path)) keep_step(v);
    if (lit_by(&v->other, around->path)) around_take_source(&v->other.around, around);
    around_take_source(&v->look.around, around);
    viewer_settle(v);
}

/* News keep what was there, to be released with them. */
static void take_maps(Viewer *v, News *news) {
    const Facts was = v->facts;
    v->facts.maps = news->maps.maps, v->facts.map_count = news->maps.map_count;
    v->facts.thumbs = news->maps.thumbs;
    news->maps.maps = was.maps, news->maps.thumbs = was.thumbs;
    viewer_show_maps(v);
}

static void take_dressed(Viewer *v, News *news) {
    Around around = v->look.around;
    if (!look_same(&v->look, &news->look)) keep_step(v);
    look_free(&v->look);
    v->look = news->look;
    v->look.around = around;
    news->look_changed = false;
    viewer_settle(v);
}

void orders_news(Viewer *v) {
    News news;
    while (painter_news(v->painter, &news)) {
        if (news.text[0]) viewer_say(v, news.failed, "%s", news.text);
        if (news.kind == TASK_SCENE) opening_take(v, &news);
        if (news.scene != v->scene) { /* of one that is gone */
            news_free(&news);
            continue;
        }
        if (news.maps.maps) take_maps(v, &news);
        if (news.look_changed && news.kind == TASK_LIGHT)
            take_light(v, &news.look.around);
        else if (news.look_changed)
            take_dressed(v, &news);
        if (news.kind == TASK_WEAR && !news.failed) folders_keep(&v->folders, news.path, -1);
        if (news.shares) opening_varied(v, &news.shares);
        if (news.kind == TASK_PROBE && !news.failed) {
            v->probe = news.probe;
            v->has_probe = news.probe.hit;
        }
        if (news.kind == TASK_PICK && !news.failed && news.stamp) stage_picked(v, &news);
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
