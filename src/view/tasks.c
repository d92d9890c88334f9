/* What is done once: files to write and to wear, questions about a pixel, a sheet of profiles. */
#include <stdio.h>
#include <string.h>

#include "view/painting.h"
#include "view/survey.h"
#include "weft/save.h"

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
        result = painting_wear(self, painting_edited(order), error);
        if (result == WEFT_OK) result = weft_raster_draw(self->raster, &view, error);
        if (result == WEFT_OK) result = weft_raster_image(self->raster, &linear, error);
    }
    const WeftImage *image = &linear;
    if (result == WEFT_OK && !weft_image_suffix_linear(task->path)) {
        bool number = order->view.part >= WEFT_PART_BASE_COLOR && !task->truth;
        WeftTonemap curve = number ? WEFT_TONEMAP_NONE : order->tonemap;
        float exposure = number ? 0.0f : order->exposure;
        result = order->laid_behind && !task->transparent
                     ? weft_image_tonemap_over(&linear, curve, exposure, order->behind, &display, error)
                     : weft_image_tonemap(&linear, curve, exposure, &display, error);
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
    WeftResult result = painting_wear(self, painting_edited(order), error);
    if (result != WEFT_OK) return result;
    snprintf(news->text, sizeof news->text, "wrote %.450s", task->path);
    if (ends_with(task->path, ".json"))
        return weft_scene_save_material(self->scene, task->index, task->path, error);
    return weft_scene_save(self->scene, task->path, error);
}

/* What its materials have become, for the window to know. */
static WeftResult dressed(Painter *self, WeftResult result, News *news, WeftError *error) {
    const WeftLog log = painter_log(self);
    if (result == WEFT_OK) {
        Around around = self->is.around;
        Look look;
        if (!look_read(&look, self->scene)) return WEFT_RESOURCES;
        look.around = around;
        look_take_naps(&look, &self->is);
        look_take_presets(&look, &self->is);
        look_free(&self->is);
        self->is = look;
        news->look_changed = look_copy(&news->look, &self->is);
        facts_read_maps(&news->maps, self->scene);
        painter_watch(self);
        result = weft_raster_update(self->raster, &log, error);
    }
    truth_release(self->truth, self->scene, ~0u);
    self->stale = true;
    return result;
}

/* NULL where nothing can be seen, or memory is short. */
static float *survey(Painter *self, const Order *order) {
    if (!self->pick && weft_pick_create(self->scene, &self->pick, NULL) != WEFT_OK) return NULL;
    return survey_take(self->pick, self->scene, order->camera,
                       (float)order->view.width / (float)order->view.height);
}

void tasks_survey(Painter *self, const Order *order) {
    News news = {.kind = TASK_SURVEY, .scene = self->scene_number, .shares = survey(self, order)};
    painter_tell(self, &news);
}

/* The number of a preset of that name, counted from 1; 0: it is a file's. */
static int preset_of(const char *path) {
    int k = 0;
    if (strncmp(path, "preset:", 7) != 0) return 0;
    while (weft_preset_name(k) && strcmp(weft_preset_name(k), path + 7) != 0) k++;
    return weft_preset_name(k) ? k + 1 : 0;
}

static WeftResult dress(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    const WeftLog log = painter_log(self);
    char target[64];
    snprintf(target, sizeof target, "%d", task->index);
    WeftResult result = painting_wear(self, painting_edited(order), error);
    if (result != WEFT_OK) return result;
    truth_hold(self->truth);
    switch (task->kind) {
    case TASK_WEAR:
        result = weft_scene_bind_maps(self->scene, task->index < 0 ? NULL : target, task->path, &news->index,
                                      &log, error);
        snprintf(news->text, sizeof news->text, "%d maps of %.400s", news->index, task->path);
        snprintf(news->path, sizeof news->path, "%s", task->path);
        if (result == WEFT_OK) folders_keep(&self->folders, task->path, task->index);
        break;
    default:
        if (task->input >= 0) {
            size_t used = strlen(target);
            snprintf(target + used, sizeof target - used, ".%s", weft_material_input_name(task->input));
            result = weft_scene_set_texture(self->scene, target, task->path, &log, error);
        } else {
            result = weft_scene_assign_material(self->scene, task->index < 0 ? NULL : target, task->path,
                                                &log, error);
            if (result == WEFT_OK && task->index >= 0)
                look_set_preset(&self->is, task->index, preset_of(task->path));
        }
        break;
    }
    return dressed(self, result, news, error);
}

/* A look names the file of a light once it has been read, not before. */
static WeftResult light(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    Look look;
    if (!look_copy(&look, painting_edited(order))) return WEFT_RESOURCES;
    look.around.kind = AROUND_FILE;
    snprintf(look.around.path, sizeof look.around.path, "%s", task->path);
    look.around.again = ++self->readings;
    WeftResult result = painting_wear(self, &look, error);
    const char *refusal = painting_refuses(self, &look);
    if (result == WEFT_OK && refusal) {
        snprintf(error->text, sizeof error->text, "%s", refusal);
        result = WEFT_INPUT;
    }
    snprintf(news->text, sizeof news->text, "lit by %.450s", task->path);
    news->look_changed = result == WEFT_OK && look_copy(&news->look, &look);
    look_free(&look);
    self->stale = true;
    return result;
}

WeftResult tasks_reload(Painter *self, int texture, WeftError *error) {
    const WeftLog log = painter_log(self);
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
    const Look *look = painting_edited(order);
    if (task->nap && at.material < look->material_count && !look_nap(look, at.material))
        nap_own(self->scene, look_material(look, at.material), &news->image);
    return WEFT_OK;
}

/* The pixel once for each part, as far as a person asks for. */
static WeftResult probe(Painter *self, const Task *task, const Order *order, News *news, WeftError *error) {
    static const WeftPart parts[] = {WEFT_PART_ALL,      WEFT_PART_DIFFUSE,    WEFT_PART_SPECULAR,
                                     WEFT_PART_SHEEN,    WEFT_PART_BASE_COLOR, WEFT_PART_NORMAL,
                                     WEFT_PART_ROUGHNESS};
    WeftResult result = pick(self, task, order, news, error);
    if (result == WEFT_OK) result = painting_wear(self, painting_edited(order), error);
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

void tasks_do(Painter *self, const Task *task, const Order *order) {
    WeftError error = {0};
    News news = {.kind = task->kind, .scene = task->scene, .stamp = task->stamp, .index = task->index};
    WeftResult result = WEFT_OK;
    switch (task->kind) {
    case TASK_SHOT: result = shot(self, task, order, &news, &error); break;
    case TASK_SAVE: result = save(self, task, order, &news, &error); break;
    case TASK_PICK: result = pick(self, task, order, &news, &error); break;
    case TASK_PROBE: result = probe(self, task, order, &news, &error); break;
    case TASK_LIGHT: result = light(self, task, order, &news, &error); break;
    case TASK_SCENE:
    case TASK_SURVEY: return;
    case TASK_PROFILES:
        study_start(&self->study, painting_edited(order), task->index, &order->view, order->camera,
                    order->tonemap, order->exposure, task->stamp);
        return;
    case TASK_DRESS:
    case TASK_WEAR: result = dress(self, task, order, &news, &error); break;
    }
    news.failed = result != WEFT_OK;
    if (news.failed)
        snprintf(news.text, sizeof news.text, "%s", error.text[0] ? error.text : "out of memory");
    painter_tell(self, &news);
}

/* One more picture of a sheet. */
void tasks_study(Painter *self) {
    News news = {.kind = TASK_PROFILES, .scene = self->scene_number, .stamp = self->study.stamp};
    Look look;
    WeftError error = {0};
    WeftImage linear;
    bool good = study_look(&self->study, &look);
    WeftRasterView view = study_view(&self->study);
    if (good) good = painting_wear(self, &look, &error) == WEFT_OK;
    if (good) good = weft_raster_draw(self->raster, &view, &error) == WEFT_OK;
    if (good) good = weft_raster_image(self->raster, &linear, &error) == WEFT_OK;
    if (good) study_add(&self->study, &linear);
    look_free(&look);
    if (!good) {
        news.failed = true;
        snprintf(news.text, sizeof news.text, "%s", error.text[0] ? error.text : "out of memory");
        study_stop(&self->study);
        painter_tell(self, &news);
    } else if (study_done(&self->study)) {
        news.failed = !study_sheet(&self->study, &news.image);
        study_stop(&self->study);
        painter_tell(self, &news);
    }
    self->stale = true; /* the scene is dressed otherwise */
}
