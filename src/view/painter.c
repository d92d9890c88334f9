#define _POSIX_C_SOURCE 200809L
#include "view/painter.h"

#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <epoxy/gl.h>

#include "view/studies.h"
#include "view/watchman.h"
#include "weft/pick.h"
#include "weft/save.h"

enum { RING = 3, TASKS = 32, NEWS = 64, SAID = 4096, COARSE_MOST = 8 };

static const double smooth_most = 4.0;     /* s, that smooth edges may take */
static const double frame_seconds = 0.036; /* that a picture may, while the hand moves */

struct Painter {
    Window *window;
    Truth *truth;
    char *shader_dir;
    int occlusion;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t change;
    /* under the lock */
    Order order;
    unsigned number;
    bool ordered, quit, working;
    WeftScene *gift;                    /* that is to be taken over */
    unsigned gift_number, scene_number; /* of it, and of the one at hand */
    Look gift_look;
    Task tasks[TASKS];
    int task_count;
    News news[NEWS];
    int news_count;
    Painted painted;
    int newest, shown; /* of the ring; -1 none */
    bool fresh;
    char said[SAID];
    /* of the thread alone */
    WeftScene *scene;
    WeftRaster *raster;
    WeftPick *pick;
    Look is; /* what the scene is dressed as */
    LookWorn worn;
    Order done;
    unsigned done_number;
    bool stale; /* a picture of the same order would be another one */
    bool started;
    Watchman *watchman; /* of the files of textures */
    int coarse;         /* pixels a side that become one while the hand moves */
    double coarse_seconds, whole_seconds, smooth_seconds; /* that pictures take */
    bool smooth_known, surprised;
    Study study; /* that is under way */
    unsigned textures[RING], targets[RING];
    int widths[RING], heights[RING];
};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void on_said(void *user, WeftMessage message, const char *text) {
    Painter *self = user;
    pthread_mutex_lock(&self->lock);
    size_t used = strlen(self->said);
    if (!strstr(self->said, text)) snprintf(self->said + used, SAID - used, "%s\n", text);
    pthread_mutex_unlock(&self->lock);
}

static WeftLog log_of(Painter *self) { return (WeftLog){on_said, self}; }

static void tell(Painter *self, News *news) {
    pthread_mutex_lock(&self->lock);
    if (self->news_count < NEWS)
        self->news[self->news_count++] = *news;
    else
        news_free(news);
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

/* ---- pictures ---- */

/* One of the ring that is neither shown nor newest, of this size. */
static int take_target(Painter *self, int width, int height) {
    int k = 0;
    pthread_mutex_lock(&self->lock);
    while (k == self->newest || k == self->shown) k++;
    pthread_mutex_unlock(&self->lock);
    if (!self->textures[k]) {
        glGenTextures(1, &self->textures[k]);
        glGenFramebuffers(1, &self->targets[k]);
    }
    if (self->widths[k] != width || self->heights[k] != height) {
        glBindTexture(GL_TEXTURE_2D, self->textures[k]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glBindFramebuffer(GL_FRAMEBUFFER, self->targets[k]);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->textures[k], 0);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        self->widths[k] = width, self->heights[k] = height;
    }
    return k;
}

/* What the scene is dressed as, asked of itself, where it could not be brought to a look. */
static bool read_again(Painter *self, const Look *wanted, Look *is) {
    if (!look_read(is, self->scene)) return false;
    is->around = self->is.around;
    look_take_naps(is, wanted);
    return true;
}

/* Brings the scene to a look. A light from a file that cannot be had leaves the one before. */
static WeftResult wear(Painter *self, const Look *look, WeftError *error) {
    const WeftLog log = log_of(self);
    unsigned changed = 0;
    Look is;
    if (look->material_count != self->is.material_count) return WEFT_INPUT; /* of another scene */
    if (look_same(look, &self->is)) return WEFT_OK;
    truth_hold(self->truth);
    WeftResult result = look_apply(look, &self->is, &self->worn, self->scene, &changed, &log, error);
    bool known = result == WEFT_OK ? look_copy(&is, look) : read_again(self, look, &is);
    if (changed & WEFT_CHANGED_SHAPES) {
        weft_pick_free(self->pick);
        self->pick = NULL;
    }
    truth_release(self->truth, self->scene, changed);
    if (!known) return WEFT_RESOURCES;
    look_free(&self->is);
    self->is = is;
    WeftResult updated = weft_raster_update(self->raster, &log, result == WEFT_OK ? error : NULL);
    return result == WEFT_OK ? updated : result;
}

/* One look in a part of a picture; as much of it as `strip` has of its height. */
static WeftResult draw_one(Painter *self, const Order *order, const Look *look, const int part[4], int target,
                           WeftError *error) {
    WeftRasterView view = order->view;
    view.camera = order->camera;
    bool sides = order->split == SPLIT_SIDES, number = order->view.part >= WEFT_PART_BASE_COLOR;
    int height = order->view.height;
    WeftResult result = wear(self, look, error);
    if (sides) view.width = order->view.width / 2;
    const int crop[4] = {sides ? 0 : part[0], part[1], sides && part[2] > view.width ? view.width : part[2],
                         part[3]};
    memcpy(view.crop, crop, sizeof view.crop);
    if (result == WEFT_OK) result = weft_raster_draw(self->raster, &view, error);
    const WeftRasterShow show = {.framebuffer = self->targets[target],
                                 .x = sides ? part[0] : 0,
                                 .clip = {part[0], height - part[1] - part[3], part[2], part[3]},
                                 .background = {0.16f, 0.16f, 0.17f},
                                 .tonemap = number ? WEFT_TONEMAP_NONE : order->tonemap,
                                 .exposure = number ? 0.0f : order->exposure};
    return result == WEFT_OK ? weft_raster_show(self->raster, &show, error) : result;
}

static bool is_outdated(Painter *self, unsigned number) {
    pthread_mutex_lock(&self->lock);
    bool outdated = self->quit || self->gift || self->number != number;
    pthread_mutex_unlock(&self->lock);
    return outdated;
}

/* Draws part of a picture, so many rows at a time as a twentieth of a second has, about: another order need
 * not wait long, nor does a window whose driver draws one thing after the other. More rows cost less than in
 * proportion, so that their number is found by doubling and halving. *whole tells whether no order came
 * between.
 */
static WeftResult draw_part(Painter *self, const Order *order, const Look *look, const int part[4],
                            unsigned number, int target, double expected, bool *whole, WeftError *error) {
    const double piece = 0.05;
    int height = part[3], y = 0;
    int rows = expected < 3.0 * piece ? height : (int)(height * piece / expected);
    WeftResult result = WEFT_OK;
    while (y < height && result == WEFT_OK && *whole) {
        double start = now();
        int left = height - y;
        if (rows < 8) rows = 8;
        if (order->compare || rows > left || left - rows < rows / 4) rows = left;
        const int strip[4] = {part[0], part[1] + y, part[2], rows};
        result = draw_one(self, order, look, strip, target, error);
        glFinish();
        y += rows;
        double took = now() - start;
        if (took < 1.5 * piece) rows *= 2;
        if (took > 2.0 * piece) rows /= 2;
        if (y < height) *whole = !is_outdated(self, number);
    }
    return result;
}

/* One look after the other: to go from one to the other may take long. */
static WeftResult draw_picture(Painter *self, const Order *order, unsigned number, int target,
                               double expected, bool *whole, WeftError *error) {
    int width = order->view.width, height = order->view.height, middle = width / 2;
    *whole = true;
    const int all[4] = {0, 0, width, height};
    if (order->split == SPLIT_NONE)
        return draw_part(self, order, &order->look, all, number, target, expected, whole, error);
    if (order->split == SPLIT_LINE) middle = (int)(order->at * (float)width);
    middle = middle < 1 ? 1 : middle > width - 1 ? width - 1 : middle;
    const int left[4] = {0, 0, middle, height}, right[4] = {middle, 0, width - middle, height};
    bool last = order->edited == 1; /* the one that is edited comes last: tasks find the scene so */
    WeftResult result = draw_part(self, order, last ? &order->look : &order->other, last ? left : right,
                                  number, target, 0.5 * expected, whole, error);
    if (result != WEFT_OK || !*whole) return result;
    return draw_part(self, order, last ? &order->other : &order->look, last ? right : left, number, target,
                     0.5 * expected, whole, error);
}

/* What can be drawn in the time there is: smooth edges in a few seconds, or at once where they take no longer
 * than a frame may; all pixels where that has proved quick enough; or at least what is asked for. */
static Effort effort_of(const Painter *self, const Order *order) {
    if (order->compare || self->smooth_seconds < frame_seconds) return EFFORT_SMOOTH;
    if (order->effort == EFFORT_SMOOTH && self->smooth_seconds < smooth_most) return EFFORT_SMOOTH;
    return order->effort > EFFORT_COARSE || self->coarse == 1 ? EFFORT_WHOLE : EFFORT_COARSE;
}

static Order with_effort(const Painter *self, const Order *order, Effort effort) {
    Order drawn = *order; /* its looks are borrowed */
    int by = effort == EFFORT_COARSE ? self->coarse : 1;
    if (effort < EFFORT_SMOOTH) drawn.view.samples = 1;
    drawn.view.width = order->view.width / by > 16 ? order->view.width / by : 16;
    drawn.view.height = order->view.height / by > 16 ? order->view.height / by : 16;
    return drawn;
}

static double *seconds_of(Painter *self, Effort effort) {
    return effort == EFFORT_SMOOTH  ? &self->smooth_seconds
           : effort == EFFORT_WHOLE ? &self->whole_seconds
                                    : &self->coarse_seconds;
}

/* Learns from the time that a picture took: how coarse those have to be that are drawn while the hand moves,
 * and what the others take. One that takes far longer than those before counts only if the next one does,
 * too: drivers compile as they draw. */
static void learn(Painter *self, const Order *order, Effort effort, double seconds) {
    double *known = seconds_of(self, effort);
    self->surprised = !self->surprised && seconds > 3.0 * *known;
    if (self->surprised) return;
    *known = seconds;
    if (effort == EFFORT_WHOLE && !self->smooth_known) self->smooth_seconds = 4.0 * seconds;
    self->smooth_known |= effort == EFFORT_SMOOTH;
    if (order->effort != EFFORT_COARSE || effort == EFFORT_SMOOTH) return;
    double finer = self->coarse > 1 ? (double)self->coarse / (self->coarse - 1) : 1.0;
    if (seconds > frame_seconds && self->coarse < COARSE_MOST)
        self->coarse++;
    else if (self->coarse > 1 && seconds * finer * finer < frame_seconds)
        self->coarse--;
}

/* A camera of the scene turns about what is in the middle of its picture. */
static void focus(Painter *self, const Order *order) {
    WeftPicked at;
    Painted seen = self->painted; /* this thread alone writes it */
    Painted *p = &seen;
    float d[3], n = 0.0f;
    if (strchr(order->camera, ';')) return;
    if (!self->pick && weft_pick_create(self->scene, &self->pick, NULL) != WEFT_OK) return;
    int width = order->view.width, height = order->view.height;
    bool hit = weft_pick_at(self->pick, order->camera, width, height, 0.5f * (float)width,
                            0.5f * (float)height, &at) != 0;
    for (int k = 0; k < 3; k++) {
        d[k] = p->target[k] - p->eye[k];
        n += d[k] * d[k];
    }
    pthread_mutex_lock(&self->lock);
    for (int k = 0; k < 3 && hit && n > 0.0f; k++)
        self->painted.target[k] = p->eye[k] + at.distance / sqrtf(n) * d[k];
    self->painted.focused = true;
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

static void publish(Painter *self, const Order *order, Effort effort, unsigned number, int target,
                    double seconds, const WeftError *error) {
    WeftRasterInfo info = weft_raster_info(self->raster);
    pthread_mutex_lock(&self->lock);
    Painted *p = &self->painted;
    if (target >= 0) {
        p->texture = self->textures[target];
        p->width = order->view.width, p->height = order->view.height;
        p->effort = effort;
        p->seconds = (float)seconds;
        p->whole_seconds = (float)self->whole_seconds;
        self->newest = target;
    }
    p->number = number;
    memcpy(p->eye, info.camera_eye, sizeof p->eye);
    memcpy(p->target, info.camera_target, sizeof p->target);
    p->fov = info.camera_fov;
    p->focused = strchr(order->camera, ';') != NULL;
    p->programs = info.programs, p->compiled = info.compiled;
    p->busy = info.making != 0;
    snprintf(p->complaint, sizeof p->complaint, "%s", info.complaint);
    snprintf(p->failure, sizeof p->failure, "%s", error->text);
    snprintf(p->driver, sizeof p->driver, "%s", info.driver);
    self->fresh = true;
    pthread_mutex_unlock(&self->lock);
    window_wake(self->window);
}

static void hand_linear(Painter *self) {
    WeftImage linear;
    if (weft_raster_image(self->raster, &linear, NULL) == WEFT_OK) truth_compare(self->truth, &linear);
}

static void draw(Painter *self, const Order *order, unsigned number) {
    WeftError error = {0};
    int target = -1, compiled = weft_raster_info(self->raster).compiled;
    bool whole = true;
    Effort effort = effort_of(self, order);
    Order drawn = with_effort(self, order, effort);
    double expected = *seconds_of(self, effort);
    WeftResult result = wear(self, &order->look, &error);
    double start = now();
    if (!order->truth || order->compare) {
        target = take_target(self, drawn.view.width, drawn.view.height);
        WeftResult done =
            draw_picture(self, &drawn, number, target, expected, &whole, result == WEFT_OK ? &error : NULL);
        if (result == WEFT_OK) result = done;
        if (done == WEFT_OK && order->compare) hand_linear(self);
        if (done != WEFT_OK) target = -1;
        bool fair = done == WEFT_OK && whole && weft_raster_info(self->raster).compiled == compiled;
        if (weft_raster_info(self->raster).compiled != compiled)
            malloc_trim(0); /* compilers leave much behind */
        if (fair) learn(self, order, effort, now() - start);
    }
    if (!whole) return; /* another order came between */
    if (result == WEFT_OK) error.text[0] = '\0';
    bool best = effort == EFFORT_WHOLE && self->smooth_seconds >= smooth_most;
    publish(self, order, best || order->truth ? EFFORT_SMOOTH : effort, number, target, now() - start,
            &error);
    focus(self, order);
}

/* ---- scenes ---- */

static void watch_textures(Painter *self) {
    watchman_forget(self->watchman);
    for (int k = 1; weft_scene_texture(self->scene, k).pixels; k++) {
        const char *path = weft_scene_texture_path(self->scene, k);
        if (path) watchman_watch(self->watchman, path, k);
    }
}

static void drop_scene(Painter *self) {
    weft_pick_free(self->pick);
    weft_raster_free(self->raster);
    weft_scene_free(self->scene);
    look_free(&self->is);
    self->pick = NULL;
    self->raster = NULL;
    self->scene = NULL;
}

/* The scene before stays where this one cannot be drawn. */
static void take_scene(Painter *self, WeftScene *scene, Look *look, unsigned number) {
    const WeftRasterDesc desc = {.adopt = 1, .shader_dir = self->shader_dir, .occlusion = self->occlusion};
    const WeftLog log = log_of(self);
    WeftError error = {0};
    WeftRaster *raster = NULL;
    WeftResult result = weft_raster_create(scene, &desc, &raster, &log, &error);
    News news = {.kind = TASK_SCENE, .scene = number, .failed = result != WEFT_OK};
    if (result == WEFT_OK) {
        study_stop(&self->study);
        truth_hold(self->truth);
        truth_release(self->truth, scene, ~0u);
        drop_scene(self);
        self->scene = scene;
        self->raster = raster;
        pthread_mutex_lock(&self->lock);
        self->scene_number = number;
        pthread_mutex_unlock(&self->lock);
        self->is = *look;
        self->worn = (LookWorn){0};
        self->started = false;
        self->smooth_seconds = 8.0;
        self->smooth_known = false;
        self->coarse = 4; /* these until they are known */
        self->coarse_seconds = 1.0;
        self->whole_seconds = 2.0;
        self->smooth_seconds = 8.0;
        self->smooth_known = false;
        watch_textures(self);
    } else {
        weft_scene_free(scene);
        look_free(look);
        snprintf(news.text, sizeof news.text, "%s", error.text);
    }
    tell(self, &news);
}

/* ---- tasks ---- */

/* The look that the panels show. */
static const Look *edited(const Order *order) {
    return order->edited && order->split != SPLIT_NONE ? &order->other : &order->look;
}

static WeftResult shot(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    WeftImage linear = {0}, display = {0};
    WeftRasterView view = order->view;
    WeftResult result = WEFT_OK;
    view.camera = order->camera;
    if (task->width > 0) view.width = task->width, view.height = task->height;
    if (task->transparent) view.background = WEFT_BACKGROUND_TRANSPARENT;
    if (task->truth) {
        if (!truth_image(self->truth, &linear)) {
            snprintf(error->text, sizeof error->text, "there is no path-traced picture yet");
            return WEFT_INPUT;
        }
    } else {
        result = wear(self, edited(order), error);
        if (result == WEFT_OK) result = weft_raster_draw(self->raster, &view, error);
        if (result == WEFT_OK) result = weft_raster_image(self->raster, &linear, error);
    }
    const WeftImage *image = &linear;
    if (result == WEFT_OK && !weft_image_suffix_linear(task->path)) {
        bool number = order->view.part >= WEFT_PART_BASE_COLOR && !task->truth;
        result = weft_image_tonemap(&linear, number ? WEFT_TONEMAP_NONE : order->tonemap,
                                    number ? 0.0f : order->exposure, &display, error);
        image = &display;
    }
    if (result == WEFT_OK) result = weft_image_write(task->path, image, error);
    snprintf(news->text, sizeof news->text, "wrote %.400s, %d x %d", task->path, linear.width, linear.height);
    weft_image_free(&linear);
    weft_image_free(&display);
    return result;
}

static bool ends_with(const char *text, const char *end) {
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

static WeftResult save(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    WeftResult result = wear(self, edited(order), error);
    if (result != WEFT_OK) return result;
    snprintf(news->text, sizeof news->text, "wrote %.450s", task->path);
    if (ends_with(task->path, ".json"))
        return weft_scene_save_material(self->scene, task->index, task->path, error);
    return weft_scene_save(self->scene, task->path, error);
}

/* What its materials have become, for the window to know. */
static WeftResult dressed(Painter *self, WeftResult result, News *news, WeftError *error) {
    const WeftLog log = log_of(self);
    if (result == WEFT_OK) {
        Around around = self->is.around;
        Look look;
        if (!look_read(&look, self->scene)) return WEFT_RESOURCES;
        look.around = around;
        look_take_naps(&look, &self->is);
        look_free(&self->is);
        self->is = look;
        news->look_changed = look_copy(&news->look, &self->is);
        watch_textures(self);
        result = weft_raster_update(self->raster, &log, error);
    }
    truth_release(self->truth, self->scene, ~0u); /* a variant may change shapes */
    self->stale = true;
    return result;
}

static WeftResult dress(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    const WeftLog log = log_of(self);
    char target[64];
    snprintf(target, sizeof target, "%d", task->index);
    WeftResult result = wear(self, edited(order), error);
    if (result != WEFT_OK) return result;
    truth_hold(self->truth);
    switch (task->kind) {
    case TASK_VARIANT:
        result =
            weft_scene_set_variant(self->scene, weft_scene_variant_name(self->scene, task->index), error);
        break;
    case TASK_WEAR:
        result = weft_scene_wear_folder(self->scene, task->index < 0 ? NULL : target, task->path,
                                        &news->index, &log, error);
        snprintf(news->text, sizeof news->text, "%d maps of %.400s", news->index, task->path);
        break;
    default:
        if (task->input >= 0) {
            size_t used = strlen(target);
            snprintf(target + used, sizeof target - used, ".%s", weft_material_input_name(task->input));
            result = weft_scene_set_texture(self->scene, target, task->path, &log, error);
        } else {
            result = weft_scene_dress(self->scene, task->index < 0 ? NULL : target, task->path, &log, error);
        }
        break;
    }
    return dressed(self, result, news, error);
}

/* A file whose picture does not come whole leaves the one before, until it changes again. */
static WeftResult reload(Painter *self, int texture, WeftError *error) {
    const WeftLog log = log_of(self);
    truth_hold(self->truth);
    WeftResult result = weft_scene_read_texture(self->scene, texture, &log, error);
    truth_release(self->truth, self->scene,
                  result == WEFT_OK ? WEFT_CHANGED_MATERIALS | WEFT_CHANGED_LIGHTS : 0);
    return result == WEFT_OK ? weft_raster_update(self->raster, &log, error) : result;
}

static WeftResult pick(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    WeftPicked at;
    WeftResult result = self->pick ? WEFT_OK : weft_pick_create(self->scene, &self->pick, error);
    if (result != WEFT_OK) return result;
    Probe *probe = &news->probe;
    int width = order->view.width, half = width / 2;
    bool sides = order->split == SPLIT_SIDES;
    float x = sides && task->x >= (float)half ? task->x - (float)half : task->x;
    probe->hit = weft_pick_at(self->pick, order->camera, sides ? half : width, order->view.height, x, task->y,
                              &at) != 0;
    if (!probe->hit) return WEFT_OK;
    probe->material = at.material;
    probe->distance = at.distance;
    probe->texel = at.texel;
    memcpy(probe->position, at.position, sizeof probe->position);
    memcpy(probe->normal, at.normal, sizeof probe->normal);
    memcpy(probe->tangent, at.tangent, sizeof probe->tangent);
    memcpy(probe->bitangent, at.bitangent, sizeof probe->bitangent);
    memcpy(probe->texcoord, at.texcoord[0], sizeof probe->texcoord);
    return WEFT_OK;
}

/* The pixel once for each part, as far as a person asks for. */
static WeftResult probe(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    static const WeftPart parts[] = {WEFT_PART_ALL,      WEFT_PART_DIFFUSE,    WEFT_PART_SPECULAR,
                                     WEFT_PART_SHEEN,    WEFT_PART_BASE_COLOR, WEFT_PART_NORMAL,
                                     WEFT_PART_ROUGHNESS};
    WeftResult result = pick(self, task, order, news, error);
    if (result == WEFT_OK) result = wear(self, edited(order), error);
    int x = (int)task->x, y = (int)task->y;
    if (x < 0 || y < 0 || x >= order->view.width || y >= order->view.height) return result;
    for (size_t k = 0; k < sizeof parts / sizeof *parts && result == WEFT_OK; k++) {
        WeftImage image;
        WeftRasterView view = order->view;
        view.camera = order->camera;
        view.part = parts[k];
        view.crop[0] = x, view.crop[1] = y, view.crop[2] = view.crop[3] = 1;
        result = weft_raster_draw(self->raster, &view, error);
        if (result == WEFT_OK) result = weft_raster_image(self->raster, &image, error);
        if (result != WEFT_OK) break;
        const float *p = (const float *)image.pixels + 4 * ((size_t)y * (size_t)image.width + (size_t)x);
        memcpy(news->probe.value[parts[k]], p, sizeof news->probe.value[0]);
        weft_image_free(&image);
    }
    return result;
}

static void do_task(Painter *self, const Task *task, const Order *order) {
    WeftError error = {0};
    News news = {.kind = task->kind, .scene = task->scene, .stamp = task->stamp, .index = task->index};
    WeftResult result = WEFT_OK;
    switch (task->kind) {
    case TASK_SHOT: result = shot(self, task, order, &news, &error); break;
    case TASK_SAVE: result = save(self, task, order, &news, &error); break;
    case TASK_PICK: result = pick(self, task, order, &news, &error); break;
    case TASK_PROBE: result = probe(self, task, order, &news, &error); break;
    case TASK_SCENE: return;
    case TASK_PROFILES:
        study_start(&self->study, edited(order), task->index, &order->view, order->camera, order->tonemap,
                    order->exposure, task->stamp);
        return;
    case TASK_DRESS:
    case TASK_WEAR:
    case TASK_VARIANT: result = dress(self, task, order, &news, &error); break;
    }
    news.failed = result != WEFT_OK;
    if (news.failed)
        snprintf(news.text, sizeof news.text, "%s", error.text[0] ? error.text : "out of memory");
    tell(self, &news);
}

/* One more picture of a sheet. */
static void go_on_studying(Painter *self) {
    News news = {.kind = TASK_PROFILES, .scene = self->scene_number, .stamp = self->study.stamp};
    Look look;
    WeftError error = {0};
    WeftImage linear;
    bool good = study_look(&self->study, &look);
    WeftRasterView view = study_view(&self->study);
    if (good) good = wear(self, &look, &error) == WEFT_OK;
    if (good) good = weft_raster_draw(self->raster, &view, &error) == WEFT_OK;
    if (good) good = weft_raster_image(self->raster, &linear, &error) == WEFT_OK;
    if (good) study_add(&self->study, &linear);
    look_free(&look);
    if (!good) {
        news.failed = true;
        snprintf(news.text, sizeof news.text, "%s", error.text[0] ? error.text : "out of memory");
        study_stop(&self->study);
        tell(self, &news);
    } else if (study_done(&self->study)) {
        news.failed = !study_sheet(&self->study, &news.image);
        study_stop(&self->study);
        tell(self, &news);
    }
    self->stale = true; /* the scene is dressed otherwise */
}

/* ---- the thread ---- */

static bool reload_changed(Painter *self) {
    int texture = watchman_look(self->watchman, now());
    if (texture < 0) return false;
    WeftError error = {0};
    News news = {.kind = TASK_DRESS};
    news.failed = reload(self, texture, &error) != WEFT_OK;
    if (news.failed)
        snprintf(news.text, sizeof news.text, "%s", error.text);
    else
        snprintf(news.text, sizeof news.text, "read again: %.400s",
                 weft_scene_texture_path(self->scene, texture));
    tell(self, &news);
    return true;
}

/* Whether what was made in the background, or a file on disk, makes for another picture. */
static bool has_changed(Painter *self) {
    if (!self->raster) return false;
    if (reload_changed(self)) return true;
    if (self->shader_dir && weft_raster_refresh(self->raster) > 0) return true;
    return weft_raster_info(self->raster).made != 0;
}

static void wait_a_little(Painter *self) {
    struct timespec until;
    bool making = self->raster && weft_raster_info(self->raster).making != 0;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += making ? 40000000L : 250000000L;
    if (until.tv_nsec >= 1000000000L) until.tv_sec++, until.tv_nsec -= 1000000000L;
    self->working = making;
    pthread_cond_timedwait(&self->change, &self->lock, &until);
    self->working = true;
}

static bool copy_order(Order *copy, const Order *order) {
    *copy = *order;
    bool good = look_copy(&copy->look, &order->look);
    copy->other = (Look){0};
    if (good && order->split != SPLIT_NONE && !look_copy(&copy->other, &order->other)) {
        look_free(&copy->look);
        good = false;
    }
    return good;
}

static void free_order(Order *order) {
    look_free(&order->look);
    look_free(&order->other);
}

/* What comes first: a scene, a task, a picture, a sheet. False where there is nothing to do. The lock is held
 * before and after. */
static bool step(Painter *self) {
    bool ordered = self->ordered && self->raster && self->order.scene == self->scene_number;
    if (self->gift) {
        WeftScene *scene = self->gift;
        Look look = self->gift_look;
        unsigned number = self->gift_number;
        self->gift = NULL;
        pthread_mutex_unlock(&self->lock);
        take_scene(self, scene, &look, number);
    } else if (ordered && (self->number != self->done_number || self->stale || !self->started)) {
        unsigned number = self->number;
        if (number != self->done_number) {
            free_order(&self->done);
            if (!copy_order(&self->done, &self->order)) return false;
        }
        self->done_number = number;
        self->stale = false;
        self->started = true;
        pthread_mutex_unlock(&self->lock);
        draw(self, &self->done, number);
    } else if (ordered && self->task_count) {
        Task task = self->tasks[0];
        memmove(self->tasks, self->tasks + 1, (size_t)--self->task_count * sizeof task);
        bool stale = task.scene != self->scene_number;
        pthread_mutex_unlock(&self->lock);
        if (!stale) do_task(self, &task, &self->done);
    } else if (ordered && self->study.under_way) {
        pthread_mutex_unlock(&self->lock);
        go_on_studying(self);
    } else {
        return false;
    }
    pthread_mutex_lock(&self->lock);
    return true;
}

static void *work(void *user) {
    Painter *self = user;
    bool good = window_worker_begin(self->window);
    pthread_mutex_lock(&self->lock);
    if (!good)
        snprintf(self->painted.failure, sizeof self->painted.failure,
                 "a second OpenGL context cannot be had");
    while (!self->quit && good) {
        if (step(self)) continue;
        wait_a_little(self);
        pthread_mutex_unlock(&self->lock);
        bool changed = has_changed(self);
        pthread_mutex_lock(&self->lock);
        self->stale |= changed;
    }
    pthread_mutex_unlock(&self->lock);
    truth_hold(self->truth);
    truth_release(self->truth, NULL, ~0u);
    study_stop(&self->study);
    drop_scene(self);
    glDeleteTextures(RING, self->textures);
    glDeleteFramebuffers(RING, self->targets);
    window_worker_end(self->window);
    return NULL;
}

Painter *painter_start(Window *window, Truth *truth, const char *shader_dir, int occlusion) {
    Painter *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->window = window;
    self->truth = truth;
    self->occlusion = occlusion;
    self->shader_dir = shader_dir ? strdup(shader_dir) : NULL;
    self->newest = self->shown = -1;
    pthread_mutex_init(&self->lock, NULL);
    pthread_condattr_t steady;
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(&self->change, &steady);
    pthread_condattr_destroy(&steady);
    self->watchman = watchman_start();
    if (self->watchman && pthread_create(&self->thread, NULL, work, self) == 0) return self;
    watchman_stop(self->watchman);
    free(self->shader_dir);
    free(self);
    return NULL;
}

void painter_stop(Painter *self) {
    if (!self) return;
    pthread_mutex_lock(&self->lock);
    self->quit = true;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    pthread_join(self->thread, NULL);
    free_order(&self->order);
    free_order(&self->done);
    weft_scene_free(self->gift);
    if (self->gift) look_free(&self->gift_look);
    for (int k = 0; k < self->news_count; k++) news_free(&self->news[k]);
    pthread_mutex_destroy(&self->lock);
    pthread_cond_destroy(&self->change);
    watchman_stop(self->watchman);
    free(self->shader_dir);
    free(self);
}

void painter_give(Painter *self, WeftScene *scene, const Look *look, unsigned number) {
    pthread_mutex_lock(&self->lock);
    if (self->gift) {
        weft_scene_free(self->gift);
        look_free(&self->gift_look);
    }
    self->gift = scene;
    if (!look_copy(&self->gift_look, look)) self->gift_look = (Look){0};
    self->gift_number = number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

unsigned painter_order(Painter *self, const Order *order) {
    Order copy;
    if (!copy_order(&copy, order)) return self->number;
    pthread_mutex_lock(&self->lock);
    free_order(&self->order);
    self->order = copy;
    self->ordered = true;
    unsigned number = ++self->number;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
    return number;
}

void painter_task(Painter *self, const Task *task) {
    pthread_mutex_lock(&self->lock);
    bool picking =
        task->kind == TASK_PICK && self->task_count && self->tasks[self->task_count - 1].kind == TASK_PICK;
    if (picking) self->task_count--; /* only the latest counts */
    if (self->task_count < TASKS) self->tasks[self->task_count++] = *task;
    pthread_cond_broadcast(&self->change);
    pthread_mutex_unlock(&self->lock);
}

bool painter_look(Painter *self, Painted *painted) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh;
    self->fresh = false;
    if (fresh) self->shown = self->newest;
    *painted = self->painted;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool painter_fresh(Painter *self) {
    pthread_mutex_lock(&self->lock);
    bool fresh = self->fresh || self->news_count;
    pthread_mutex_unlock(&self->lock);
    return fresh;
}

bool painter_news(Painter *self, News *news) {
    pthread_mutex_lock(&self->lock);
    bool some = self->news_count > 0;
    if (some) {
        *news = self->news[0];
        memmove(self->news, self->news + 1, (size_t)--self->news_count * sizeof *news);
    }
    pthread_mutex_unlock(&self->lock);
    return some;
}

void news_free(News *news) {
    weft_image_free(&news->image);
    if (news->look_changed) look_free(&news->look);
}

bool painter_idle(Painter *self) {
    pthread_mutex_lock(&self->lock);
    bool idle =
        !self->working && !self->gift && !self->task_count && !self->news_count && !self->study.under_way &&
        (!self->ordered || self->order.scene != self->scene_number || self->number == self->done_number) &&
        !self->stale;
    pthread_mutex_unlock(&self->lock);
    return idle;
}

char *painter_said(Painter *self) {
    pthread_mutex_lock(&self->lock);
    char *said = self->said[0] ? strdup(self->said) : NULL;
    self->said[0] = '\0';
    pthread_mutex_unlock(&self->lock);
    return said;
}
