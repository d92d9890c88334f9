#include "cli/render/scene_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/names.h"
#include "cli/console/report.h"
#include "weft/image.h"

/* Reads "r,g,b", or one number for all three. */
static bool colors_parse(const char *text, double c[3]) {
    if (!numbers_parse(text, 1, c)) return numbers_parse(text, 3, c);
    c[1] = c[2] = c[0];
    return true;
}

static bool colors(const char *text, float color[3]) {
    double c[3];
    bool good = colors_parse(text, c);
    for (int k = 0; good && k < 3; k++) {
        good = c[k] >= 0.0 && c[k] <= 1e30;
        if (good) color[k] = (float)c[k];
    }
    return good;
}

/* Returns true if the verb has a background and a floor. */
static bool has_stage(const Options *options) { return option_row(options, "--background") != NULL; }

static bool read_background(const Options *options, SceneOptions *scene_options) {
    if (!has_stage(options)) return true;
    static const char *const names[] = {"auto", "environment", "transparent", "a linear r,g,b", "blurred", NULL};
    int choice = WEFT_BACKGROUND_COLOR;
    bool good = colors(option_text(options, "--background"), scene_options->background_color) ||
                (option_choice(options, "--background", names, &choice) && choice != WEFT_BACKGROUND_COLOR);
    scene_options->background = (WeftBackground)choice;
    return good;
}

/* Reads `count` numbers from the next part of a text, up to a semicolon, and moves *text behind it. */
static bool take_numbers(const char **text, int count, float *out) {
    char part[128];
    double v[3];
    size_t size = strcspn(*text, ";");
    if (size == 0 || size >= sizeof part) return false;
    memcpy(part, *text, size);
    part[size] = '\0';
    *text += size + ((*text)[size] == ';');
    if (!numbers_parse(part, count, v)) return false;
    for (int k = 0; k < count; k++) out[k] = (float)v[k];
    return true;
}

static bool parse_light(const char *text, WeftLight *light) {
    static const char *const prefixes[] = {"sun;", "point;", "spot;", "polygon;"}; /* as WeftLightKind */
    float cone[2] = {0.0f, 45.0f}, shape[2] = {4.0f, 0.0f};
    int kind = 0;
    while (kind <= WEFT_LIGHT_POLYGON && strncmp(text, prefixes[kind], strlen(prefixes[kind])) != 0) kind++;
    if (kind > WEFT_LIGHT_POLYGON) return false;
    *light = (WeftLight){.kind = (WeftLightKind)kind};
    text += strlen(prefixes[kind]);
    bool polygon = kind == WEFT_LIGHT_POLYGON;
    bool good = (kind == WEFT_LIGHT_DIRECTIONAL || take_numbers(&text, 3, light->position)) &&
                (kind == WEFT_LIGHT_POINT || take_numbers(&text, 3, light->direction)) &&
                (!polygon || take_numbers(&text, 2, light->size)) && take_numbers(&text, 3, light->color);
    if (good && kind == WEFT_LIGHT_SPOT && *text) good = take_numbers(&text, 2, cone);
    if (good && polygon && *text) good = take_numbers(&text, 2, shape);
    good = good && shape[0] >= 3.0f && shape[0] <= 8.0f && !(shape[0] > floorf(shape[0]));
    if (!good || *text) return false;
    light->inner = cone[0];
    light->outer = cone[1];
    light->corners = polygon ? (int)shape[0] : 0;
    light->roll = shape[1];
    return true;
}

static bool read_lights(const Options *options, SceneOptions *scene_options) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, "--light", &cursor));) {
        if (strcmp(text, "none") == 0) {
            scene_options->light_count = 0;
            scene_options->no_lights = true;
            continue;
        }
        if (scene_options->light_count == SCENE_LIGHTS_MOST) {
            report(WEFT_USAGE, "--light: more than %d", SCENE_LIGHTS_MOST);
            return false;
        }
        if (!parse_light(text, &scene_options->lights[scene_options->light_count++])) {
            report(WEFT_USAGE,
                   "--light: \"%.80s\" is not none, sun;x,y,z;r,g,b, point;x,y,z;r,g,b, "
                   "spot;x,y,z;x,y,z;r,g,b;inner,outer or polygon;x,y,z;x,y,z;w,h;r,g,b;corners,roll",
                   text);
            return false;
        }
    }
    return true;
}

/* Reads --env. A value that reads as a colour is a radiance and never the name of a file. */
static bool read_env(const Options *options, SceneOptions *scene_options) {
    const char *text = scene_options->env = option_text(options, "--env");
    double c[3];
    scene_options->env_is_color = text && colors_parse(text, c);
    if (!scene_options->env_is_color || colors(text, scene_options->env_color)) return true;
    report(WEFT_USAGE, "--env: \"%.80s\" is not a radiance, which is from 0 to 1e30", text);
    return false;
}

/* Reads the moment of an animation. */
static bool read_moment(const Options *options, SceneOptions *scene_options) {
    scene_options->moves = option_given(options, "--time");
    scene_options->moment.animation = option_text(options, "--animation");
    if (scene_options->moves) return option_number(options, "--time", &scene_options->moment.time);
    if (scene_options->moment.animation) report(WEFT_USAGE, "--animation: needs --time");
    return !scene_options->moment.animation;
}

/* Returns true unless the name begins with "builtin:" and no such scene is built in. */
static bool check_scene(const char *scene) {
    const char *name = path_builtin(scene);
    if (!name) return true;
    Nearest nearest = {.typed = name};
    char list[256] = "", hint[96];
    for (int k = 0; weft_builtin_name(k); k++) {
        if (strcmp(weft_builtin_name(k), name) == 0) return true;
        nearest_offer(&nearest, weft_builtin_name(k));
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k ? ", " : "", weft_builtin_name(k));
    }
    report(WEFT_USAGE, "%.200s: %s: available: %s%s", scene, weft_message_text(WEFT_MESSAGE_SCENE_NAME), list,
           nearest_hint(&nearest, hint, sizeof hint));
    return false;
}

static bool needs_floor(const Options *options, const char *name) {
    if (!option_given(options, name) || option_given(options, "--floor")) return true;
    report(WEFT_USAGE, "%s: needs --floor", name);
    return false;
}

/* Reads --floor and what else decides over a floor, after --background. */
static bool read_floor(const Options *options, SceneOptions *scene_options) {
    static const char *const stages[] = {"auto", "none", NULL};
    double reflection = 0.0, roughness = 0.0;
    int stage = 0;
    if (!has_stage(options)) return true;
    bool good = option_choice(options, "--stage", stages, &stage) && needs_floor(options, "--floor-reflection") &&
                needs_floor(options, "--floor-roughness") &&
                option_number(options, "--floor-reflection", &reflection) &&
                option_number(options, "--floor-roughness", &roughness);
    scene_options->floor = (WeftFloor){option_given(options, "--floor"), (float)reflection, (float)roughness};
    scene_options->stage = stage == 0 && !scene_options->floor.on && scene_options->background == WEFT_BACKGROUND_AUTO;
    scene_options->hide_lights = option_given(options, "--hide-lights");
    return good;
}

WeftFloor scene_options_floor(const SceneOptions *scene_options, const WeftScene *scene) {
    return scene_options->stage ? weft_scene_stage(scene) : scene_options->floor;
}

static bool read_exposure(const Options *options, SceneOptions *scene_options) {
    const char *text = option_text(options, "--exposure");
    double stops = 0.0;
    scene_options->meter_exposure = strcmp(text, "auto") == 0;
    if (scene_options->meter_exposure) return true;
    const bool good = numbers_parse(text, 1, &stops) && stops >= -32.0 && stops <= 32.0;
    if (!good) report(WEFT_USAGE, "--exposure: \"%.80s\" is not auto or stops from -32 to 32", text);
    scene_options->tone.exposure = (float)stops;
    return good;
}

static bool read_white(const Options *options, SceneOptions *scene_options) {
    const char *text = option_text(options, "--white-balance");
    double v[2] = {0.0, 0.0};
    scene_options->find_white = text && strcmp(text, "auto") == 0;
    if (!text || scene_options->find_white) return true;
    if ((!numbers_parse(text, 1, v) && !numbers_parse(text, 2, v)) || !(v[0] >= 1700.0 && v[0] <= 25000.0) ||
        !(fabs(v[1]) <= 50.0)) {
        report(WEFT_USAGE, "--white-balance: \"%.80s\" is not auto or KELVIN[,TINT], 1700 to 25000 and -50 to 50",
               text);
        return false;
    }
    scene_options->kelvin = (float)v[0], scene_options->tint = (float)v[1];
    weft_white(scene_options->kelvin, scene_options->tint, scene_options->tone.white);
    return true;
}

/* Reads how the picture is shown. */
static bool read_tone(const Options *options, SceneOptions *scene_options) {
    const char *curves[WEFT_TONEMAP_COUNT + 1];
    int curve = 0;
    for (int k = 0; k <= WEFT_TONEMAP_COUNT; k++) curves[k] = weft_tonemap_name(k);
    const bool good = option_choice(options, "--tonemap", curves, &curve);
    scene_options->tone.curve = (WeftTonemap)curve;
    return good && read_exposure(options, scene_options) && read_white(options, scene_options);
}

bool scene_options_read(const Options *options, const char *scene, SceneOptions *scene_options) {
    *scene_options = (SceneOptions){.options = options, .scene = scene, .camera = option_text(options, "--camera")};
    return check_scene(scene) && read_moment(options, scene_options) && read_background(options, scene_options) &&
           read_env(options, scene_options) && read_tone(options, scene_options) &&
           option_number(options, "--env-rotation", &scene_options->env_rotation) &&
           option_number(options, "--env-strength", &scene_options->env_strength) &&
           option_number(options, "--env-ambient", &scene_options->env_ambient) &&
           option_number(options, "--env-reflection", &scene_options->env_reflection) &&
           read_floor(options, scene_options) && assign_read(options, &scene_options->assignment) &&
           read_lights(options, scene_options);
}

WeftResult scene_options_apply(const SceneOptions *scene_options, int k, WeftScene *scene, const WeftLog *log,
                               WeftError *error) {
    WeftResult result = assign_apply(&scene_options->assignment, k, scene, log, error);
    if (result == WEFT_OK && scene_options->env_is_color)
        result = weft_scene_set_environment_color(scene, scene_options->env_color, error);
    else if (result == WEFT_OK && scene_options->env)
        result = weft_scene_set_environment_file(scene, scene_options->env, log, error);
    if (result == WEFT_OK)
        result = weft_scene_set_environment_placement(scene, (float)scene_options->env_rotation,
                                                      (float)scene_options->env_strength, error);
    if (result == WEFT_OK)
        result = weft_scene_set_environment_parts(scene, (float)scene_options->env_ambient,
                                                  (float)scene_options->env_reflection, error);
    while (result == WEFT_OK && scene_options->no_lights && weft_scene_info(scene).light_count > 0)
        result = weft_scene_remove_light(scene, 0, error);
    for (int j = 0; j < scene_options->light_count && result == WEFT_OK; j++)
        result = weft_scene_add_light(scene, &scene_options->lights[j], error);
    return result;
}
