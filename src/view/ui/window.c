#define _POSIX_C_SOURCE 200809L
#include "view/ui/window.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "base/steady_clock.h"

enum { QUEUE_MOST = 4096, DROPS_MOST = 64 };

struct Window {
    GLFWwindow *seen, *worker; /* NULL where there is no display */
    GLFWcursor *cursors[UI_CURSORS];
    EGLDisplay display; /* of one that is unseen */
    EGLContext context, second;
    GLuint target, color;
    int width, height;
    float scale;
    Event *events; /* QUEUE_MOST, a ring */
    int first, count;
    char *drops[DROPS_MOST];
    int drop_count;
    bool closing, woken;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    char *clip;
    UiClipboard clipboard;
    UiCursor shape;
    bool keeps; /* the next frame */
    WeftImage kept;
};

void window_push(Window *self, const Event *event) {
    Event copy = *event;
    if (self->count == QUEUE_MOST) return;
    if (event->path) copy.path = strdup(event->path);
    self->events[(self->first + self->count++) % QUEUE_MOST] = copy;
}

static Window *of(GLFWwindow *window) { return glfwGetWindowUserPointer(window); }

static void on_move(GLFWwindow *w, double x, double y) {
    window_push(of(w), &(Event){.kind = EVENT_MOVE, .x = (float)x, .y = (float)y});
}
static void on_enter(GLFWwindow *w, int entered) {
    if (!entered) window_push(of(w), &(Event){.kind = EVENT_LEAVE});
}
static void on_button(GLFWwindow *w, int button, int action, int mods) {
    window_push(of(w), &(Event){.kind = EVENT_BUTTON, .code = button, .down = action == GLFW_PRESS});
}
static void on_wheel(GLFWwindow *w, double x, double y) {
    window_push(of(w), &(Event){.kind = EVENT_WHEEL, .x = (float)x, .y = (float)y});
}
static void on_key(GLFWwindow *w, int key, int scancode, int action, int mods) {
    const char *name = glfwGetKeyName(key, scancode);
    Event event = {.kind = EVENT_KEY,
                   .code = key,
                   .down = action != GLFW_RELEASE,
                   .repeats = action == GLFW_REPEAT,
                   .letter = (char)(name && !name[1] ? name[0] : 0),
                   .control = (mods & GLFW_MOD_CONTROL) != 0,
                   .shift = (mods & GLFW_MOD_SHIFT) != 0,
                   .alt = (mods & GLFW_MOD_ALT) != 0};
    window_push(of(w), &event);
}
static void on_typed(GLFWwindow *w, unsigned code) {
    window_push(of(w), &(Event){.kind = EVENT_TYPED, .code = (int)code});
}
static void on_drop(GLFWwindow *w, int count, const char **paths) {
    for (int k = 0; k < count; k++) window_push(of(w), &(Event){.kind = EVENT_DROP, .path = (char *)paths[k]});
}
static void on_size(GLFWwindow *w, int width, int height) {
    window_push(of(w), &(Event){.kind = EVENT_RESIZE, .x = (float)width, .y = (float)height});
}
static void on_focus(GLFWwindow *w, int focused) {
    if (!focused) window_push(of(w), &(Event){.kind = EVENT_FOCUS});
}
static void on_refresh(GLFWwindow *w) { of(w)->woken = true; }

static void set_callbacks(GLFWwindow *w) {
    glfwSetCursorPosCallback(w, on_move);
    glfwSetCursorEnterCallback(w, on_enter);
    glfwSetMouseButtonCallback(w, on_button);
    glfwSetScrollCallback(w, on_wheel);
    glfwSetKeyCallback(w, on_key);
    glfwSetCharCallback(w, on_typed);
    glfwSetDropCallback(w, on_drop);
    glfwSetFramebufferSizeCallback(w, on_size);
    glfwSetWindowFocusCallback(w, on_focus);
    glfwSetWindowRefreshCallback(w, on_refresh);
}

static const char *clip_get(void *user) {
    Window *self = user;
    const char *text = self->seen ? glfwGetClipboardString(self->seen) : self->clip;
    return text ? text : "";
}

static void clip_set(void *user, const char *text) {
    Window *self = user;
    if (self->seen) glfwSetClipboardString(self->seen, text);
    free(self->clip);
    self->clip = strdup(text);
}

/* Creates the target that everything is drawn into, which can be read at any time. */
static void make_target(Window *self) {
    if (!self->target) {
        glGenTextures(1, &self->color);
        glGenFramebuffers(1, &self->target);
    }
    glBindTexture(GL_TEXTURE_2D, self->color);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, self->width, self->height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glBindFramebuffer(GL_FRAMEBUFFER, self->target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->color, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
}

static bool open_seen(Window *self, const WindowDesc *desc, char why[256]) {
    const char *reason = NULL;
    if (!glfwInit()) {
        glfwGetError(&reason);
        snprintf(why, 256, "there is no display to open a window on; `weft render` makes pictures without one");
        return false;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    /* EGL contexts compile shaders in parallel; without EGL the system's own API is used. */
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    self->seen = glfwCreateWindow(desc->width, desc->height, desc->title, NULL, NULL);
    if (!self->seen) glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_NATIVE_CONTEXT_API);
    if (!self->seen) self->seen = glfwCreateWindow(desc->width, desc->height, desc->title, NULL, NULL);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    if (self->seen) self->worker = glfwCreateWindow(16, 16, desc->title, NULL, self->seen);
    if (!self->worker) {
        glfwGetError(&reason);
        snprintf(why, 256, "cannot open a window with OpenGL 3.3%s%.120s; `weft render` needs none", reason ? ": " : "",
                 reason ? reason : "");
        return false;
    }
    glfwSetWindowUserPointer(self->seen, self);
    glfwSetWindowSizeLimits(self->seen, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
    set_callbacks(self->seen);
    static const int shapes[UI_CURSORS] = {GLFW_ARROW_CURSOR, GLFW_IBEAM_CURSOR, GLFW_HRESIZE_CURSOR, GLFW_HAND_CURSOR};
    for (int k = 0; k < UI_CURSORS; k++) self->cursors[k] = glfwCreateStandardCursor(shapes[k]);
    glfwMakeContextCurrent(self->seen);
    glfwSwapInterval(1);
    glfwGetFramebufferSize(self->seen, &self->width, &self->height);
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(self->seen, &x, &y);
    self->scale = x > 0.5f && x < 8.0f ? x : 1.0f;
    return true;
}

static bool open_unseen(Window *self, const WindowDesc *desc, char why[256]) {
    static const EGLint wanted[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    snprintf(why, 256, "there is no OpenGL 3.3 without a display: EGL with surfaceless contexts is needed");
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base"))
        return false;
    self->display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (!self->display || !eglInitialize(self->display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_API)) return false;
    self->context = eglCreateContext(self->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    self->second = eglCreateContext(self->display, EGL_NO_CONFIG_KHR, self->context, wanted);
    if (!self->context || !self->second ||
        !eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, self->context))
        return false;
    self->width = desc->width;
    self->height = desc->height;
    self->scale = 1.0f;
    make_target(self);
    return true;
}

Window *window_open(const WindowDesc *desc, char why[256]) {
    Window *self = calloc(1, sizeof *self);
    Event *events = calloc(QUEUE_MOST, sizeof *events);
    if (!self || !events) {
        free(self);
        free(events);
        snprintf(why, 256, "out of memory");
        return NULL;
    }
    self->events = events;
    pthread_mutex_init(&self->lock, NULL);
    clock_condition(&self->wake);
    self->clipboard = (UiClipboard){clip_get, clip_set, self};
    if (desc->unseen ? !open_unseen(self, desc, why) : !open_seen(self, desc, why)) {
        window_close(self);
        return NULL;
    }
    if (desc->scale > 0.0f) self->scale = desc->scale;
    return self;
}

static void close_unseen(Window *self) {
    if (!self->display) return;
    if (self->context) {
        glDeleteFramebuffers(1, &self->target);
        glDeleteTextures(1, &self->color);
    }
    eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (self->second) eglDestroyContext(self->display, self->second);
    if (self->context) eglDestroyContext(self->display, self->context);
    /* The EGL display belongs to the whole process: it is not terminated. */
    eglReleaseThread();
}

void window_close(Window *self) {
    if (!self) return;
    close_unseen(self);
    if (self->worker) glfwDestroyWindow(self->worker);
    if (self->seen) glfwDestroyWindow(self->seen);
    /* GLFW is not terminated, since it would terminate the EGL display of the whole process. */
    for (int k = 0; k < self->count; k++) free(self->events[(self->first + k) % QUEUE_MOST].path);
    for (int k = 0; k < self->drop_count; k++) free(self->drops[k]);
    pthread_mutex_destroy(&self->lock);
    pthread_cond_destroy(&self->wake);
    free(self->events);
    free(self->clip);
    weft_image_free(&self->kept);
    free(self);
}

bool window_worker_begin(Window *self) {
    if (self->seen) {
        glfwMakeContextCurrent(self->worker);
        return glfwGetCurrentContext() == self->worker;
    }
    return eglBindAPI(EGL_OPENGL_API) && eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, self->second);
}

void window_worker_end(Window *self) {
    if (self->seen) {
        glfwMakeContextCurrent(NULL);
        return;
    }
    eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglReleaseThread();
}

static void take_key(UiInput *input, const Event *e) {
    if (e->code >= 0 && e->code < UI_KEYS) input->key[e->code] = e->down;
    input->control = e->control, input->shift = e->shift, input->alt = e->alt;
    bool left = e->code == GLFW_KEY_LEFT_CONTROL || e->code == GLFW_KEY_RIGHT_CONTROL;
    if (left) input->control = e->down;
    if (e->code == GLFW_KEY_LEFT_SHIFT || e->code == GLFW_KEY_RIGHT_SHIFT) input->shift = e->down;
    if (e->code == GLFW_KEY_LEFT_ALT || e->code == GLFW_KEY_RIGHT_ALT) input->alt = e->down;
    if (!e->down || input->pressed_count == UI_PRESSED) return;
    input->pressed[input->pressed_count++] =
        (UiPress){e->code, e->letter, input->control, input->shift, input->alt, e->repeats};
}

static void let_go(UiInput *input) {
    memset(input->key, 0, sizeof input->key);
    memset(input->button, 0, sizeof input->button);
    input->control = input->shift = input->alt = false;
}

static void take_resize(Window *self, const Event *e) {
    int width = (int)e->x, height = (int)e->y;
    if (width < 1 || height < 1) return; /* minimised */
    self->width = width, self->height = height;
    if (!self->seen) make_target(self);
}

static void take_drop(Window *self, Event *e) {
    if (self->drop_count == DROPS_MOST || !e->path)
        free(e->path);
    else
        self->drops[self->drop_count++] = e->path;
}

static void take_event(Window *self, UiInput *input, Event *e) {
    switch (e->kind) {
    case EVENT_MOVE: input->x = e->x, input->y = e->y; break;
    case EVENT_LEAVE: input->x = input->y = -1.0f; break;
    case EVENT_BUTTON:
        if (e->code >= 0 && e->code < UI_BUTTONS) input->button[e->code] = e->down;
        break;
    case EVENT_WHEEL: input->wheel_across += e->x, input->wheel += e->y; break;
    case EVENT_KEY: take_key(input, e); break;
    case EVENT_TYPED:
        if (input->typed_count < UI_TYPED) input->typed[input->typed_count++] = (unsigned)e->code;
        break;
    case EVENT_DROP: take_drop(self, e); break;
    case EVENT_RESIZE: take_resize(self, e); break;
    case EVENT_FOCUS: let_go(input); break;
    }
}

static bool is_modifier(const Event *e) {
    return e->kind == EVENT_KEY && e->code >= GLFW_KEY_LEFT_SHIFT && e->code <= GLFW_KEY_RIGHT_SUPER;
}

bool window_take(Window *self, UiInput *input) {
    bool button[UI_BUTTONS] = {0}, key[UI_KEYS] = {0}, any = false, pressed = false, struck = false;
    input->wheel = input->wheel_across = 0.0f;
    input->typed_count = input->pressed_count = 0;
    while (self->count) {
        Event *e = &self->events[self->first];
        bool click = e->kind == EVENT_BUTTON && e->code >= 0 && e->code < UI_BUTTONS;
        bool stroke = e->kind == EVENT_KEY && e->code >= 0 && e->code < UI_KEYS;
        if ((click && button[e->code]) || (stroke && key[e->code]) || (e->kind == EVENT_MOVE && pressed) ||
            (is_modifier(e) && struck))
            break;
        if (click) button[e->code] = pressed = true;
        if (stroke) key[e->code] = true;
        struck |= click || (stroke && !is_modifier(e));
        take_event(self, input, e);
        self->first = (self->first + 1) % QUEUE_MOST;
        self->count--;
        any = true;
    }
    input->width = self->width, input->height = self->height;
    return any;
}

bool window_has_events(const Window *self) { return self->count > 0 || self->drop_count > 0; }

char *window_dropped(Window *self) {
    if (!self->drop_count) return NULL;
    char *path = self->drops[0];
    memmove(self->drops, self->drops + 1, (size_t)--self->drop_count * sizeof *self->drops);
    return path;
}

static void wait_unseen(Window *self, double seconds) {
    struct timespec until = clock_after(seconds);
    pthread_mutex_lock(&self->lock);
    while (!self->woken && seconds > 0.0)
        if (pthread_cond_timedwait(&self->wake, &self->lock, &until)) break;
    self->woken = false;
    pthread_mutex_unlock(&self->lock);
}

void window_wait(Window *self, double seconds) {
    if (!self->seen) {
        wait_unseen(self, self->count ? 0.0 : seconds);
        return;
    }
    if (self->count || seconds <= 0.0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(seconds);
    if (glfwWindowShouldClose(self->seen)) self->closing = true;
}

void window_wake(Window *self) {
    if (self->seen) {
        glfwPostEmptyEvent();
        return;
    }
    pthread_mutex_lock(&self->lock);
    self->woken = true;
    pthread_cond_signal(&self->wake);
    pthread_mutex_unlock(&self->lock);
}

void window_bind(Window *self) {
    glBindFramebuffer(GL_FRAMEBUFFER, self->target);
    glViewport(0, 0, self->width, self->height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.09f, 0.095f, 0.10f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
}

static void keep_frame(Window *self) {
    WeftImage *out = &self->kept;
    weft_image_free(out);
    self->keeps = false;
    if (weft_image_create(self->width, self->height, 3, WEFT_PIXEL_U8, out, NULL) != WEFT_OK) return;
    size_t row = 3 * (size_t)self->width;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, self->target);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    unsigned char *pixels = out->pixels;
    for (int y = 0; y < self->height; y++)
        glReadPixels(0, self->height - 1 - y, self->width, 1, GL_RGB, GL_UNSIGNED_BYTE, pixels + (size_t)y * row);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

void window_present(Window *self) {
    if (self->keeps) keep_frame(self);
    if (self->seen)
        glfwSwapBuffers(self->seen);
    else
        glFinish();
}

void window_size(const Window *self, int *width, int *height) {
    *width = self->width;
    *height = self->height;
}

float window_scale(const Window *self) { return self->scale; }
bool window_hidden(const Window *self) { return self->seen && glfwGetWindowAttrib(self->seen, GLFW_ICONIFIED) != 0; }

bool window_take_close(Window *self) {
    const bool closing = self->closing;
    self->closing = false;
    if (self->seen) glfwSetWindowShouldClose(self->seen, GLFW_FALSE);
    return closing;
}

void window_request_close(Window *self) { self->closing = true; }

void window_cursor(Window *self, UiCursor cursor) {
    if (!self->seen || cursor == self->shape) return;
    self->shape = cursor;
    glfwSetCursor(self->seen, self->cursors[cursor]);
}

void window_title(Window *self, const char *title) {
    if (self->seen) glfwSetWindowTitle(self->seen, title);
}

const UiClipboard *window_clipboard(Window *self) { return &self->clipboard; }

void window_keep(Window *self) { self->keeps = true; }

const WeftImage *window_kept(const Window *self) { return self->kept.pixels ? &self->kept : NULL; }
