#include "raster/gl/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/memory.h"

enum { DEVICES_MAX = 16 };

/* Tells which context is current in this thread; NULL: none. */
typedef void *(*Current)(void);

struct GlContext {
    Current adopted; /* returns the current context, if this one was adopted; NULL: our own, through EGL */
    EGLDisplay display;
    EGLContext context;
    EGLConfig config;
    EGLSurface surface; /* EGL_NO_SURFACE, or one pixel where the driver insists */
    TextLanguage language;
    char driver[128];
};

static const char *version_name(TextLanguage language) {
    return language == TEXT_GLSL_ES_300 ? "OpenGL ES 3.0" : "OpenGL 3.3";
}

static EGLenum api_of(TextLanguage language) {
    return language == TEXT_GLSL_ES_300 ? EGL_OPENGL_ES_API : EGL_OPENGL_API;
}

static bool has_library(const char *name) {
    void *library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (library) dlclose(library);
    return library != NULL;
}

/* Returns a message if a library is missing, else NULL. Called first, since libepoxy ends the process if one is. */
static const char *missing_library(TextLanguage language) {
    if (!epoxy_has_egl()) return "libEGL is not installed";
    if (language == TEXT_GLSL_ES_300) return has_library("libGLESv2.so.2") ? NULL : "libGLESv2 is not installed";
    return has_library("libGL.so.1") || has_library("libOpenGL.so.0") ? NULL : "libGL is not installed";
}

/* Initialises a display, which may be done any number of times. It is never terminated, since all of the process shares
 * it: eglTerminate would end the contexts of other users too. */
static bool display_begin(EGLDisplay display) {
    EGLint major, minor;
    return display != EGL_NO_DISPLAY && eglInitialize(display, &major, &minor);
}

static EGLConfig choose_config(EGLDisplay display, TextLanguage language, bool pixel) {
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, language == TEXT_GLSL_ES_300 ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT,
                             EGL_SURFACE_TYPE, pixel ? EGL_PBUFFER_BIT : 0, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    return eglChooseConfig(display, wanted, &config, 1, &count) && count ? config : EGL_NO_CONFIG_KHR;
}

/* Fills in context and surface; its objects are also those of `share`. */
static bool make_context(GlContext *self, EGLContext share, bool pixel) {
    static const EGLint desktop[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                     EGL_NONE};
    static const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_CONTEXT_MINOR_VERSION_KHR, 0, EGL_NONE};
    static const EGLint one[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    self->context =
        eglCreateContext(self->display, self->config, share, self->language == TEXT_GLSL_ES_300 ? es : desktop);
    if (self->context == EGL_NO_CONTEXT) return false;
    self->surface = pixel ? eglCreatePbufferSurface(self->display, self->config, one) : EGL_NO_SURFACE;
    if (!pixel || self->surface != EGL_NO_SURFACE) return true;
    eglDestroyContext(self->display, self->context);
    self->context = EGL_NO_CONTEXT;
    return false;
}

/* Fills in a whole context on that display. */
static bool make_on(GlContext *self, EGLDisplay display) {
    if (!display_begin(display)) return false;
    if (!epoxy_has_egl_extension(display, "EGL_KHR_create_context") && epoxy_egl_version(display) < 15) return false;
    if (!eglBindAPI(api_of(self->language))) return false;
    bool pixel = !epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context");
    bool any = epoxy_has_egl_extension(display, "EGL_KHR_no_config_context") && !pixel;
    EGLConfig config = any ? EGL_NO_CONFIG_KHR : choose_config(display, self->language, pixel);
    if (!any && config == EGL_NO_CONFIG_KHR) return false;
    self->display = display;
    self->config = config;
    return make_context(self, EGL_NO_CONTEXT, pixel);
}

/* Fills in a context, first on displays that need no screen: Mesa's without surfaces, then each device, then the
 * system's default display. */
static bool make_anywhere(GlContext *self) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
        if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless") &&
            make_on(self, eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL)))
            return true;
        EGLDeviceEXT devices[DEVICES_MAX];
        EGLint count = 0;
        if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
            epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
            eglQueryDevicesEXT(DEVICES_MAX, devices, &count))
            for (int k = 0; k < count; k++)
                if (make_on(self, eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[k], NULL))) return true;
    }
    return make_on(self, eglGetDisplay(EGL_DEFAULT_DISPLAY));
}

static void *egl_current(void) { return eglGetCurrentContext(); }

/* Returns the function of GLX that returns the current context, or NULL if GLX is not loaded, as it is if a window has
 * a context of GLX. libepoxy has no such call: it ends the process if no context is current. */
static Current glx_current(void) {
    static const char *const names[] = {"libGLX.so.0", "libGL.so.1"};
    Current found = NULL;
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !found; k++) {
        void *library = dlopen(names[k], RTLD_LAZY | RTLD_NOLOAD);
        void *symbol = library ? dlsym(library, "glXGetCurrentContext") : NULL;
        memcpy(&found, &symbol, sizeof found);
        if (library) dlclose(library);
    }
    return found;
}

static GlOuter outer_now(void) {
    return (GlOuter){.display = eglGetCurrentDisplay(),
                     .context = eglGetCurrentContext(),
                     .draw = eglGetCurrentSurface(EGL_DRAW),
                     .read = eglGetCurrentSurface(EGL_READ),
                     .api = eglQueryAPI()};
}

static void put_back(GlContext *self, const GlOuter *outer) {
    eglBindAPI(outer->api);
    if (outer->context != EGL_NO_CONTEXT)
        eglMakeCurrent(outer->display, outer->draw, outer->read, outer->context);
    else
        eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

/* Reads the driver's name from the current context. Returns false if it cannot draw floats. */
static bool take_driver(GlContext *self) {
    snprintf(self->driver, sizeof self->driver, "%s", (const char *)glGetString(GL_RENDERER));
    return epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_color_buffer_float");
}

static const char *const no_floats = "the driver cannot draw floating-point numbers";

WeftResult context_create(TextLanguage language, GlContext **out, WeftError *error) {
    *out = NULL;
    const char *version = version_name(language);
    if (language == TEXT_GLSL_450) return fail(error, WEFT_MESSAGE_GL_CONTEXT, "Vulkan", NULL);
    const char *missing = missing_library(language);
    if (missing) return fail(error, WEFT_MESSAGE_GL_CONTEXT, version, "%s", missing);
    GlContext *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, version, NULL);
    self->language = language;
    GlOuter outer = outer_now();
    bool made = make_anywhere(self);
    EGLint code = eglGetError();
    eglBindAPI(outer.api);
    if (!made) {
        free(self);
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, version,
                    "no driver offers it (EGL error 0x%x); install a driver such as Mesa, or use --engine trace",
                    (unsigned)code);
    }
    if (!context_enter(self, &outer)) {
        context_destroy(self);
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, version,
                    "its context is unusable; install another driver, or use --engine trace");
    }
    bool floats = take_driver(self);
    context_leave(self, &outer);
    if (!floats) {
        context_destroy(self);
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, version, "%s", no_floats);
    }
    *out = self;
    return WEFT_OK;
}

/* Sets the configuration of a context that was made elsewhere, which may have none. Returns false if EGL does not find
 * it. */
static bool find_config(GlContext *self) {
    EGLint id = 0, count = 0;
    self->config = EGL_NO_CONFIG_KHR;
    if (!eglQueryContext(self->display, self->context, EGL_CONFIG_ID, &id)) return false;
    const EGLint wanted[] = {EGL_CONFIG_ID, id, EGL_NONE};
    return id == 0 || (eglChooseConfig(self->display, wanted, &self->config, 1, &count) && count == 1);
}

GlContext *context_share(const GlContext *of) {
    GlContext *self = of->adopted && of->adopted != egl_current ? NULL : alloc_array(1, sizeof *self);
    if (!self) return NULL;
    GlOuter outer = outer_now();
    bool pixel = of->surface != EGL_NO_SURFACE, found = true;
    *self = *of;
    if (of->adopted) {
        self->adopted = NULL;
        self->display = eglGetCurrentDisplay();
        found = find_config(self);
        pixel = !epoxy_has_egl_extension(self->display, "EGL_KHR_surfaceless_context");
    }
    eglBindAPI(api_of(self->language));
    bool made = found && make_context(self, of->context, pixel);
    eglBindAPI(outer.api);
    if (made) return self;
    free(self);
    return NULL;
}

WeftResult context_adopt(GlContext **out, WeftError *error) {
    static const char name[] = "the current context";
    *out = NULL;
    Current adopted = epoxy_has_egl() && egl_current() ? egl_current : glx_current();
    if (!adopted || !adopted())
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, name, "no context is current in this thread");
    bool desktop = epoxy_is_desktop_gl();
    int version = epoxy_gl_version();
    if (version < (desktop ? 33 : 30))
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, name, "it is OpenGL %s%d.%d", desktop ? "" : "ES ", version / 10,
                    version % 10);
    GlContext *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    self->adopted = adopted;
    self->context = adopted();
    self->language = desktop ? TEXT_GLSL_330 : TEXT_GLSL_ES_300;
    if (!take_driver(self)) {
        context_destroy(self);
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, name, "%s", no_floats);
    }
    *out = self;
    return WEFT_OK;
}

bool context_adopted(const GlContext *self) { return self->adopted != NULL; }

void context_destroy(GlContext *self) {
    if (!self) return;
    if (self->adopted) {
        free(self);
        return;
    }
    if (eglGetCurrentContext() == self->context)
        eglMakeCurrent(self->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(self->display, self->context);
    if (self->surface != EGL_NO_SURFACE) eglDestroySurface(self->display, self->surface);
    free(self);
}

bool context_enter(GlContext *self, GlOuter *outer) {
    if (self->adopted) {
        if (self->adopted() != self->context) return false;
        state_begin(&outer->place);
        return true;
    }
    *outer = outer_now();
    if (outer->context == self->context) return true;
    eglBindAPI(api_of(self->language));
    if (eglMakeCurrent(self->display, self->surface, self->surface, self->context)) return true;
    put_back(self, outer);
    return false;
}

void context_leave(GlContext *self, const GlOuter *outer) {
    if (self->adopted)
        state_end(&outer->place);
    else if (outer->context != self->context)
        put_back(self, outer);
}

void context_thread_ends(void) { eglReleaseThread(); }

TextLanguage context_language(const GlContext *self) { return self->language; }
const char *context_driver(const GlContext *self) { return self->driver; }
