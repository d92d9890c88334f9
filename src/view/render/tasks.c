/* Tasks: writes files, applies materials and environments, probes pixels, draws the sheet of profiles. */
#include <stdio.h>
#include <string.h>

#include "view/files/survey.h"
#include "view/render/renderer_state.h"
#include "weft/save.h"

static WeftResult shot(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                       WeftError *error) {
    WeftImage linear = {0}, display = {0};
    WeftRasterView view = request->view;
    WeftResult result = WEFT_OK;
    view.camera = request->camera;
    if (task->width > 0) view.width = task->width, view.height = task->height;
    view.floor.on = task->floor;
    if (task->transparent) view.background = WEFT_BACKGROUND_TRANSPARENT;
    if (task->reference) {
        if (!reference_image(self->reference, &linear)) {
            snprintf(error->text, sizeof error->text, "there is no path-traced picture yet");
            return WEFT_INPUT;
        }
    } else {
        result = frame_apply_state(self, frame_edited_state(request), error);
        if (result == WEFT_OK) result = weft_raster_draw(self->raster, &view, error);
        if (result == WEFT_OK) result = weft_raster_image(self->raster, &linear, error);
    }
    const WeftImage *image = &linear;
    if (result == WEFT_OK && !weft_image_suffix_linear(task->path)) {
        bool numeric = request->view.part >= WEFT_PART_BASE_COLOR && !task->reference;
        const WeftTone tone = {request->tonemap, request->exposure, {request->white[0], request->white[1]}};
        const WeftTone numbers = {.curve = WEFT_TONEMAP_NONE};
        const float *behind = request->laid_behind && !task->transparent ? request->behind : NULL;
        result = weft_image_show(&linear, numeric ? &numbers : &tone, behind, &display, error);
        image = &display;
    }
    if (result == WEFT_OK) result = weft_image_write(task->path, image, error);
    snprintf(event->text, sizeof event->text, "wrote %.400s, %d x %d", task->path, linear.width, linear.height);
    weft_image_free(&linear);
    weft_image_free(&display);
    return result;
}

static bool ends_with(const char *text, const char *end) {
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

static WeftResult save(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                       WeftError *error) {
    WeftResult result = frame_apply_state(self, frame_edited_state(request), error);
    if (result != WEFT_OK) return result;
    snprintf(event->text, sizeof event->text, "wrote %.450s", task->path);
    if (ends_with(task->path, ".json")) return weft_scene_save_material(self->scene, task->index, task->path, error);
    return weft_scene_save(self->scene, task->path, error);
}

/* Saves the scene for a picture in the background. */
static WeftResult copy(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                       WeftError *error) {
    snprintf(event->path, sizeof event->path, "%s", task->path);
    WeftResult result = frame_apply_state(self, frame_edited_state(request), error);
    return result == WEFT_OK ? weft_scene_save(self->scene, task->path, error) : result;
}

/* Sends the new state of the materials to the window. */
static WeftResult finish_assign(Renderer *self, WeftResult result, RenderEvent *event, WeftError *error) {
    const WeftLog log = renderer_log(self);
    SceneState state;
    if (result == WEFT_OK && !scene_state_read(&state, self->scene)) result = WEFT_RESOURCES;
    if (result == WEFT_OK) {
        EnvironmentState environment = self->is.environment;
        state.environment = environment;
        scene_state_take_naps(&state, &self->is);
        scene_state_take_presets(&state, &self->is);
        scene_state_free(&self->is);
        self->is = state;
        event->state_changed = scene_state_copy(&event->state, &self->is);
        facts_read_maps(&event->maps, self->scene);
        renderer_watch_files(self);
        result = weft_raster_update(self->raster, &log, error);
    }
    reference_resume(self->reference, self->scene, ~0u);
    self->stale = true;
    return result;
}

/* Returns the coverage of the picture by each material; NULL if there is nothing to pick, or memory is short. */
static float *survey(Renderer *self, const FrameRequest *request) {
    if (!self->pick && weft_pick_create(self->scene, &self->pick, NULL) != WEFT_OK) return NULL;
    return survey_take(self->pick, self->scene, request->camera,
                       (float)request->view.width / (float)request->view.height);
}

void tasks_survey(Renderer *self, const FrameRequest *request) {
    RenderEvent event = {.kind = TASK_SURVEY, .scene = self->scene_number, .coverage = survey(self, request)};
    renderer_post(self, &event);
}

/* Returns the number, from 1, of the preset in "preset:NAME"; 0 if the path is a file's. */
static int preset_of(const char *path) {
    int k = 0;
    if (strncmp(path, "preset:", 7) != 0) return 0;
    while (weft_preset_name(k) && strcmp(weft_preset_name(k), path + 7) != 0) k++;
    return weft_preset_name(k) ? k + 1 : 0;
}

/* Weaves a material of the task's yarns. */
static WeftResult weave_anew(Renderer *self, const Task *task, WeftError *error) {
    WeftMaterial material;
    WeftDraft *draft;
    WeftResult result = weft_scene_material(self->scene, task->index, &material, error);
    const WeftDraft *was = result == WEFT_OK ? weft_scene_cloth(self->scene, material.cloth, NULL) : NULL;
    if (result == WEFT_OK && !was) {
        snprintf(error->text, sizeof error->text, "the material is not woven");
        return WEFT_USAGE;
    }
    if (result == WEFT_OK) result = weft_draft_copy(was, &draft, error);
    if (result != WEFT_OK) return result;
    if (task->pick >= 0)
        weft_draft_set_up(draft, task->warp, task->pick, !weft_draft_warp_up(draft, task->warp, task->pick));
    result = weft_scene_set_weave(self->scene, task->index, draft, task->yarns, error);
    weft_draft_free(draft);
    return result;
}

static WeftResult assign_material(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                                  WeftError *error) {
    const WeftLog log = renderer_log(self);
    char target[64];
    snprintf(target, sizeof target, "%d", task->index);
    WeftResult result = frame_apply_state(self, frame_edited_state(request), error);
    if (result != WEFT_OK) return result;
    reference_pause(self->reference);
    switch (task->kind) {
    case TASK_BIND_MAPS:
        result =
            weft_scene_bind_maps(self->scene, task->index < 0 ? NULL : target, task->path, &event->index, &log, error);
        snprintf(event->text, sizeof event->text, "%d maps of %.400s", event->index, task->path);
        snprintf(event->path, sizeof event->path, "%s", task->path);
        if (result == WEFT_OK) folders_keep(&self->folders, task->path, task->index);
        break;
    case TASK_WEAVE: result = weave_anew(self, task, error); break;
    case TASK_WEAVE_KEY: result = weft_scene_weave(self->scene, target, task->key, task->path, &log, error); break;
    default:
        if (task->input >= 0) {
            size_t used = strlen(target);
            snprintf(target + used, sizeof target - used, ".%s", weft_material_input_name(task->input));
            result = weft_scene_set_texture(self->scene, target, task->path, &log, error);
        } else {
            result = weft_scene_assign_material(self->scene, task->index < 0 ? NULL : target, task->path, &log, error);
            if (result == WEFT_OK && task->index >= 0)
                scene_state_set_preset(&self->is, task->index, preset_of(task->path));
        }
        break;
    }
    return finish_assign(self, result, event, error);
}

/* Lights the scene by a file. The window receives a state that names the file only if the file could be read. */
static WeftResult light(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                        WeftError *error) {
    SceneState state;
    if (!scene_state_copy(&state, frame_edited_state(request))) return WEFT_RESOURCES;
    state.environment.kind = ENVIRONMENT_FILE;
    snprintf(state.environment.path, sizeof state.environment.path, "%s", task->path);
    state.environment.version = ++self->readings;
    WeftResult result = frame_apply_state(self, &state, error);
    const char *refusal = frame_refusal(self, &state);
    if (result == WEFT_OK && refusal) {
        snprintf(error->text, sizeof error->text, "%s", refusal);
        result = WEFT_INPUT;
    }
    snprintf(event->text, sizeof event->text, "lit by %.450s", task->path);
    event->state_changed = result == WEFT_OK && scene_state_copy(&event->state, &state);
    scene_state_free(&state);
    self->stale = true;
    return result;
}

WeftResult tasks_reload(Renderer *self, int texture, WeftError *error) {
    const WeftLog log = renderer_log(self);
    reference_pause(self->reference);
    WeftResult result = weft_scene_read_texture(self->scene, texture, &log, error);
    reference_resume(self->reference, self->scene,
                     result == WEFT_OK ? WEFT_CHANGED_MATERIALS | WEFT_CHANGED_LIGHTS : 0);
    return result == WEFT_OK ? weft_raster_update(self->raster, &log, error) : result;
}

static WeftResult pick(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                       WeftError *error) {
    WeftPicked at;
    WeftResult result = self->pick ? WEFT_OK : weft_pick_create(self->scene, &self->pick, error);
    if (result != WEFT_OK) return result;
    Probe *probe = &event->probe;
    int width = request->view.width, half = width / 2;
    bool sides = request->split == SPLIT_SIDES;
    float x = sides && task->x >= (float)half ? task->x - (float)half : task->x;
    probe->hit =
        weft_pick_at(self->pick, request->camera, sides ? half : width, request->view.height, x, task->y, &at) != 0;
    if (!probe->hit) return WEFT_OK;
    probe->material = at.material;
    probe->distance = at.distance;
    probe->uv_per_metre = at.uv_per_metre;
    memcpy(probe->position, at.position, sizeof probe->position);
    memcpy(probe->normal, at.normal, sizeof probe->normal);
    memcpy(probe->tangent, at.tangent, sizeof probe->tangent);
    memcpy(probe->bitangent, at.bitangent, sizeof probe->bitangent);
    memcpy(probe->texcoord, at.texcoord[0], sizeof probe->texcoord);
    const SceneState *state = frame_edited_state(request);
    if (task->nap && at.material < state->material_count && !scene_state_nap(state, at.material))
        nap_own(self->scene, scene_state_material(state, at.material), &event->image);
    return WEFT_OK;
}

/* Draws the pixel once for each part of its light that the window shows. */
static WeftResult probe(Renderer *self, const Task *task, const FrameRequest *request, RenderEvent *event,
                        WeftError *error) {
    static const WeftPart parts[] = {WEFT_PART_ALL,        WEFT_PART_DIFFUSE, WEFT_PART_SPECULAR, WEFT_PART_SHEEN,
                                     WEFT_PART_BASE_COLOR, WEFT_PART_NORMAL,  WEFT_PART_ROUGHNESS};
    WeftResult result = pick(self, task, request, event, error);
    if (result == WEFT_OK) result = frame_apply_state(self, frame_edited_state(request), error);
    int x = (int)task->x, y = (int)task->y;
    if (x < 0 || y < 0 || x >= request->view.width || y >= request->view.height) return result;
    for (size_t k = 0; k < sizeof parts / sizeof *parts && result == WEFT_OK; k++) {
        WeftImage image;
        WeftRasterView view = request->view;
        view.camera = request->camera;
        view.part = parts[k];
        view.crop[0] = x, view.crop[1] = y, view.crop[2] = view.crop[3] = 1;
        result = weft_raster_draw(self->raster, &view, error);
        if (result == WEFT_OK) result = weft_raster_image(self->raster, &image, error);
        if (result != WEFT_OK) break;
        const float *p = (const float *)image.pixels + 4 * ((size_t)y * (size_t)image.width + (size_t)x);
        memcpy(event->probe.value[parts[k]], p, sizeof event->probe.value[0]);
        weft_image_free(&image);
    }
    return result;
}

void tasks_do(Renderer *self, const Task *task, const FrameRequest *request) {
    WeftError error = {0};
    RenderEvent event = {.kind = task->kind, .scene = task->scene, .stamp = task->stamp, .index = task->index};
    WeftResult result = WEFT_OK;
    switch (task->kind) {
    case TASK_SHOT: result = shot(self, task, request, &event, &error); break;
    case TASK_SAVE: result = save(self, task, request, &event, &error); break;
    case TASK_COPY: result = copy(self, task, request, &event, &error); break;
    case TASK_PICK: result = pick(self, task, request, &event, &error); break;
    case TASK_PROBE: result = probe(self, task, request, &event, &error); break;
    case TASK_LIGHT: result = light(self, task, request, &event, &error); break;
    case TASK_SCENE:
    case TASK_SURVEY: return;
    case TASK_PROFILES:
        study_start(&self->study, frame_edited_state(request), task->index, &request->view, request->camera,
                    &(WeftTone){request->tonemap, request->exposure, {request->white[0], request->white[1]}},
                    task->stamp);
        return;
    case TASK_ASSIGN:
    case TASK_WEAVE:
    case TASK_WEAVE_KEY:
    case TASK_BIND_MAPS: result = assign_material(self, task, request, &event, &error); break;
    }
    event.failed = result != WEFT_OK;
    if (event.failed) snprintf(event.text, sizeof event.text, "%s", error.text[0] ? error.text : "out of memory");
    renderer_post(self, &event);
}

/* Draws one more picture of the sheet of profiles (studies.h); sends the sheet after the last. */
void tasks_study(Renderer *self) {
    RenderEvent event = {.kind = TASK_PROFILES, .scene = self->scene_number, .stamp = self->study.stamp};
    SceneState state;
    WeftError error = {0};
    WeftImage linear;
    bool good = study_state(&self->study, &state);
    WeftRasterView view = study_view(&self->study);
    if (good) good = frame_apply_state(self, &state, &error) == WEFT_OK;
    if (good) good = weft_raster_draw(self->raster, &view, &error) == WEFT_OK;
    if (good) good = weft_raster_image(self->raster, &linear, &error) == WEFT_OK;
    if (good) study_add(&self->study, &linear);
    scene_state_free(&state);
    if (!good) {
        event.failed = true;
        snprintf(event.text, sizeof event.text, "%s", error.text[0] ? error.text : "out of memory");
        study_stop(&self->study);
        renderer_post(self, &event);
    } else if (study_done(&self->study)) {
        event.failed = !study_sheet(&self->study, &event.image);
        study_stop(&self->study);
        renderer_post(self, &event);
    }
    self->stale = true; /* the scene has the state of a study, not of the request */
}
