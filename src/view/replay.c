#define _POSIX_C_SOURCE 200809L
#include "view/replay.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/steady_clock.h"
#include "view/panels/panels.h"
#include "view/panels/render_command.h"
#include "view/state/dialogs.h"
#include "view/state/frame_requests.h"
#include "view/state/opening.h"
#include "view/state/sessions.h"
#include "view/state/view_camera.h"

enum { MOTIONS = 512, TRIES = 240, SIZE_MOST = 1 << 20 };

/* The part of an action that is done in one frame. */
typedef struct Motion {
    enum { DO_EVENT, DO_POINT, DO_NOTHING, DO_KEEP, DO_WRITE } kind;
    Event event;
    char path[1024];  /* of the action's file */
    char control[96]; /* DO_POINT: moves the mouse into this control's box, when it no longer moves */
    float x, y;
    UiBox last; /* of the control, a frame ago */
} Motion;

struct Replay {
    char *path, *text, *next;
    int line;
    Motion motions[MOTIONS];
    int count, first;
    int tries;    /* attempts to find the control */
    double since; /* start of the current wait, s; 0: none */
    bool stay;
};

Replay *replay_open(const char *path, char why[512]) {
    Replay *self = calloc(1, sizeof *self);
    FILE *file = fopen(path, "rb");
    if (self) {
        self->path = strdup(path);
        self->text = calloc(1, SIZE_MOST + 1);
    }
    size_t size = file && self && self->text ? fread(self->text, 1, SIZE_MOST, file) : 0;
    bool whole = file && !ferror(file) && feof(file) && self && self->text && self->path;
    if (file) fclose(file);
    if (whole && strlen(self->text) == size) {
        self->next = self->text;
        return self;
    }
    snprintf(why, 512, "%.300s: %s", path, file ? "is not a script, or is too long" : "cannot be opened");
    replay_close(self);
    return NULL;
}

void replay_close(Replay *self) {
    if (!self) return;
    free(self->path);
    free(self->text);
    free(self);
}

static void add(Replay *self, const Motion *motion) {
    if (self->count < MOTIONS) self->motions[self->count++] = *motion;
}

static void add_event(Replay *self, Event event) { add(self, &(Motion){.kind = DO_EVENT, .event = event}); }

static void add_drop(Replay *self, const char *path) {
    Motion motion = {.kind = DO_EVENT, .event = {.kind = EVENT_DROP}};
    snprintf(motion.path, sizeof motion.path, "%s", path);
    add(self, &motion);
}

static void add_pause(Replay *self, int frames) {
    for (int k = 0; k < frames; k++) add(self, &(Motion){.kind = DO_NOTHING});
}

static void add_point(Replay *self, const char *control, float x, float y) {
    Motion motion = {.kind = DO_POINT, .x = x, .y = y};
    snprintf(motion.control, sizeof motion.control, "%.95s", control);
    add(self, &motion);
}

static void add_button(Replay *self, int button, bool down) {
    add_event(self, (Event){.kind = EVENT_BUTTON, .code = button, .down = down});
}

/* Adds the steps that write the next frame of the window to a file. */
static void add_window(Replay *self, const char *path) {
    Motion motion = {.kind = DO_WRITE};
    snprintf(motion.path, sizeof motion.path, "%s", path);
    add(self, &(Motion){.kind = DO_KEEP});
    add_pause(self, 1);
    add(self, &motion);
}

static void add_click(Replay *self, const char *control, float x) {
    add_point(self, control, x, 0.5f);
    add_pause(self, 1);
    add_button(self, 0, true);
    add_button(self, 0, false);
    add_pause(self, 2);
}

typedef struct KeyName {
    const char *name;
    int key;
} KeyName;

static int key_of(const char *name) {
    static const KeyName keys[] = {{"tab", GLFW_KEY_TAB},
                                   {"escape", GLFW_KEY_ESCAPE},
                                   {"enter", GLFW_KEY_ENTER},
                                   {"home", GLFW_KEY_HOME},
                                   {"space", GLFW_KEY_SPACE},
                                   {"shift", GLFW_KEY_LEFT_SHIFT},
                                   {"control", GLFW_KEY_LEFT_CONTROL},
                                   {"up", GLFW_KEY_UP},
                                   {"down", GLFW_KEY_DOWN},
                                   {"left", GLFW_KEY_LEFT},
                                   {"right", GLFW_KEY_RIGHT},
                                   {"f1", GLFW_KEY_F1},
                                   {"f6", GLFW_KEY_F6},
                                   {"f10", GLFW_KEY_F10},
                                   {"f8", GLFW_KEY_F8},
                                   {"f12", GLFW_KEY_F12},
                                   {"backspace", GLFW_KEY_BACKSPACE}};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (strcmp(keys[k].name, name) == 0) return keys[k].key;
    if (name[0] && !name[1] && name[0] >= 'a' && name[0] <= 'z') return name[0] - 'a' + 'A';
    return name[0] && !name[1] && name[0] >= '0' && name[0] <= '9' ? name[0] : -1;
}

/* Adds a key with modifiers, such as "control+shift+z". */
static bool add_key(Replay *self, const char *text, bool down, bool up) {
    bool control = strstr(text, "control+") != NULL, shift = strstr(text, "shift+") != NULL;
    const char *plus = strrchr(text, '+'), *name = plus ? plus + 1 : text;
    int key = key_of(name);
    Event event = {
        .kind = EVENT_KEY, .code = key, .letter = (char)(name[1] ? 0 : name[0]), .control = control, .shift = shift};
    event.down = true;
    if (key >= 0 && down) add_event(self, event);
    event.down = false;
    event.control = event.shift = false;
    if (key >= 0 && up) add_event(self, event);
    add_pause(self, 1);
    return key >= 0;
}

static void add_text(Replay *self, const char *text) {
    for (; *text; text++) add_event(self, (Event){.kind = EVENT_TYPED, .code = (unsigned char)*text});
    add_pause(self, 1);
}

/* Adds the steps that type a value into a slider. */
static void add_value(Replay *self, const char *control, const char *value) {
    add_point(self, control, 0.5f, 0.5f);
    add_event(self, (Event){.kind = EVENT_KEY, .code = GLFW_KEY_LEFT_CONTROL, .down = true, .control = true});
    add_pause(self, 1);
    add_button(self, 0, true);
    add_button(self, 0, false);
    add_event(self, (Event){.kind = EVENT_KEY, .code = GLFW_KEY_LEFT_CONTROL, .down = false});
    add_pause(self, 2);
    add_text(self, value);
    add_key(self, "enter", true, true);
    add_pause(self, 2);
}

/* Moves the mouse with a button down, in small steps. */
static void add_drag(Replay *self, const Viewer *v, int button, const float way[4]) {
    enum { STEPS = 12 };
    for (int k = 0; k <= STEPS; k++) {
        float t = (float)k / STEPS;
        float x = v->frame->stage.x + v->frame->stage.width * (way[0] + t * (way[2] - way[0]));
        float y = v->frame->stage.y + v->frame->stage.height * (way[1] + t * (way[3] - way[1]));
        add_event(self, (Event){.kind = EVENT_MOVE, .x = x, .y = y});
        if (k == 0) add_pause(self, 1);
        if (k == 0) add_button(self, button, true);
    }
    add_button(self, button, false);
    add_pause(self, 1);
}

static char *take_word(char **text) {
    char *p = *text + strspn(*text, " \t"), *word = p;
    if (*p == '"') {
        word = ++p;
        p += strcspn(p, "\"");
    } else {
        p += strcspn(p, " \t");
    }
    if (*p) *p++ = '\0';
    *text = p + strspn(p, " \t");
    return word;
}

static bool is(const char *a, const char *b) { return strcmp(a, b) == 0; }

/* Returns the number of a button, 0 without a name, or -1. */
static int button_of(const char *name) {
    static const char *const names[] = {"left", "right", "middle"};
    for (int k = 0; k < 3; k++)
        if (is(name, names[k])) return k;
    return name[0] ? -1 : 0;
}

/* Reads exactly `count` finite numbers, with blanks between. */
static bool numbers_of(const char *text, int count, float *numbers) {
    for (int k = 0; k < count; k++) {
        char *end;
        numbers[k] = strtof(text, &end);
        if (end == text || !isfinite(numbers[k]) || (*end && *end != ' ' && *end != '\t')) return false;
        text = end + strspn(end, " \t");
    }
    return !*text;
}

/* Returns true if something can be waited for. */
static bool is_wait(const char *what) {
    float number;
    const char *value = strchr(what, ' ');
    static const char *const plain[] = {"rest", "shows drawn", "shows traced", "thumbnails", "session"};
    for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
        if (is(what, plain[k])) return true;
    if (strncmp(what, "message ", 8) == 0) return what[8] != 0;
    if (value &&
        (strncmp(what, "samples ", 8) == 0 || strncmp(what, "seconds ", 8) == 0 || strncmp(what, "summed ", 7) == 0))
        return numbers_of(value + 1, 1, &number) && number >= 0.0f;
    return numbers_of(what, 1, &number) && number >= 0.0f && !(number > floorf(number));
}

/* Returns true while a wait goes on. */
static bool still_waiting(Replay *self, Viewer *v, const char *what) {
    double start = self->since > 0.0 ? self->since : (self->since = clock_now());
    bool done = is(what, "rest")         ? viewer_is_idle(v) && v->shown->any && ++self->tries > 4
                : is(what, "thumbnails") ? v->presets && ++self->tries > 4 && !presets_busy(v)
                : is(what, "session")    ? v->shown->any && (!v->sessions->file.path[0] || sessions_are_kept(v))
                : strncmp(what, "samples ", 8) == 0 ? v->requests->traced.samples >= atof(what + 8)
                : strncmp(what, "summed ", 7) == 0  ? v->requests->rendered.summed >= atoi(what + 7)
                : strncmp(what, "shows ", 6) == 0   ? is(what + 6, shows_name(requests_shown(v)))
                : strncmp(what, "message ", 8) == 0 ? strstr(v->frame->message, what + 8) != NULL
                : strncmp(what, "seconds ", 8) == 0 ? clock_now() - start > atof(what + 8)
                                                    : ++self->tries > atoi(what);
    if (done) self->since = 0.0, self->tries = 0;
    return !done;
}

static bool write_command(const Viewer *v, const char *path) {
    char *line = command_said(v);
    FILE *file = fopen(path, "w");
    bool good = line && file && fputs(line, file) >= 0;
    if (file) good = fclose(file) == 0 && good;
    free(line);
    return good;
}

/* Adds events of mouse and keyboard. Returns false if the word is none of these. */
static bool do_input(Replay *self, Viewer *v, const char *word, char *rest, bool *good) {
    float way[4] = {0};
    if (is(word, "click"))
        add_click(self, take_word(&rest), 0.5f);
    else if (is(word, "key"))
        *good = add_key(self, rest, true, true);
    else if (is(word, "keydown"))
        *good = add_key(self, rest, true, false);
    else if (is(word, "keyup"))
        *good = add_key(self, rest, false, true);
    else if (is(word, "type"))
        add_text(self, rest);
    else if (is(word, "wheel")) {
        *good = numbers_of(rest, 1, way);
        add_event(self, (Event){.kind = EVENT_WHEEL, .y = way[0]});
    } else if (is(word, "drop"))
        add_drop(self, rest);
    else if (is(word, "drag")) {
        int button = button_of(take_word(&rest));
        *good = button >= 0 && numbers_of(rest, 4, way);
        if (*good) add_drag(self, v, button, way);
    } else if (is(word, "move")) {
        *good = numbers_of(rest, 2, way);
        add_event(self, (Event){.kind = EVENT_MOVE,
                                .x = v->frame->stage.x + way[0] * v->frame->stage.width,
                                .y = v->frame->stage.y + way[1] * v->frame->stage.height});
    } else if (is(word, "press") || is(word, "release")) {
        *good = button_of(rest) >= 0;
        add_button(self, button_of(rest), is(word, "press"));
    } else if (is(word, "resize")) {
        *good = numbers_of(rest, 2, way);
        add_event(self, (Event){.kind = EVENT_RESIZE, .x = way[0], .y = way[1]});
        add_pause(self, 2);
    } else {
        return false;
    }
    return true;
}

static bool do_action(Replay *self, Viewer *v, const char *word, char *rest, bool *good) {
    if (is(word, "choose")) {
        char *control = take_word(&rest), item[160];
        snprintf(item, sizeof item, "%s/%s", control, take_word(&rest));
        add_click(self, control, 0.5f);
        add_click(self, item, 0.5f);
    } else if (is(word, "slide")) {
        char *control = take_word(&rest);
        float share;
        *good = numbers_of(rest, 1, &share);
        add_click(self, control, share);
    } else if (is(word, "set")) {
        char *control = take_word(&rest);
        add_value(self, control, rest);
    } else if (is(word, "open"))
        opening_open(v, rest);
    else if (is(word, "save"))
        dialogs_save(v, rest);
    else if (is(word, "picture"))
        dialogs_shot_stage(v, rest);
    else if (is(word, "window"))
        add_window(self, rest);
    else if (is(word, "command"))
        *good = write_command(v, rest);
    else if (is(word, "camera"))
        camera_stand_at(v, rest);
    else if (is(word, "stay") && !*rest)
        self->stay = true;
    else if (is(word, "close") && !*rest)
        window_request_close(v->window);
    else if (is(word, "quit") && !*rest)
        viewer_quit(v);
    else
        return false;
    return true;
}

/* Returns true if no side moved by as much as a thousandth of a pixel. */
static bool same_box(UiBox a, UiBox b) {
    return fabsf(a.x - b.x) < 1e-3f && fabsf(a.y - b.y) < 1e-3f && fabsf(a.width - b.width) < 1e-3f &&
           fabsf(a.height - b.height) < 1e-3f;
}

/* Does one frame of the current motion. Returns false if a control does not exist. */
static bool do_motion(Replay *self, Viewer *v, char why[512]) {
    Motion *m = &self->motions[self->first];
    if (m->kind == DO_POINT) {
        const UiControl *c = ui_control_find(m->control);
        if (!c) {
            ui_reveal(m->control);
            if (++self->tries < TRIES) return true;
            snprintf(why, 512, "%.200s:%d: there is no \"%.90s\" to point at", self->path, self->line, m->control);
            return false;
        }
        if (!same_box(c->box, m->last) && ++self->tries < TRIES) {
            m->last = c->box;
            return true;
        }
        window_push(
            v->window,
            &(Event){.kind = EVENT_MOVE, .x = c->box.x + m->x * c->box.width, .y = c->box.y + m->y * c->box.height});
    } else if (m->kind == DO_KEEP) {
        window_keep(v->window);
    } else if (m->kind == DO_WRITE) {
        WeftError error = {.text = "nothing was drawn"};
        const WeftImage *kept = window_kept(v->window);
        if (!kept || weft_image_write(m->path, kept, &error) != WEFT_OK) {
            snprintf(why, 512, "%.200s:%d: %.250s", self->path, self->line, error.text);
            return false;
        }
    } else if (m->kind == DO_EVENT) {
        if (m->event.kind == EVENT_DROP) m->event.path = m->path;
        window_push(v->window, &m->event);
    }
    self->tries = 0;
    if (++self->first == self->count) self->first = self->count = 0;
    return true;
}

bool replay_acts(const Replay *self) { return self->count > 0; }

bool replay_step(Replay *self, Viewer *v, char why[512]) {
    if (self->count) return do_motion(self, v, why);
    while (!self->count && !v->frame->ending) {
        char *line = self->next, copy[1200];
        size_t length = strcspn(line, "\n");
        if (!*line) {
            if (!self->stay) viewer_quit(v);
            return true;
        }
        snprintf(copy, sizeof copy, "%.*s", (int)(length < 1100 ? length : 1100), line);
        char *rest = copy, *word = take_word(&rest);
        bool good = true, waits = is(word, "wait");
        if (waits && !is_wait(rest)) {
            snprintf(why, 512, "%.200s:%d: \"wait %.100s\" is nothing to wait for; docs/view.md lists what is",
                     self->path, self->line + 1, rest);
            return false;
        }
        if (waits && still_waiting(self, v, rest)) {
            if (clock_now() - self->since < 120.0) return true;
            snprintf(why, 512, "%.200s:%d: \"%.100s\" did not finish within 120 s", self->path, self->line + 1, copy);
            return false;
        }
        self->line++;
        self->next = line + length + (line[length] == '\n');
        if (waits || !*word || *word == '#') continue;
        if ((do_input(self, v, word, rest, &good) || do_action(self, v, word, rest, &good)) && good) {
            if (self->count) return do_motion(self, v, why);
            return true;
        }
        snprintf(why, 512, "%.200s:%d: \"%.*s\" is not an action, or failed", self->path, self->line,
                 (int)(length < 100 ? length : 100), line);
        return false;
    }
    return true;
}
