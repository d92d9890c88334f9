/* A raster in a context that is not its own: what it shows is what weft_image_tonemap makes; it works from
 * any state and leaves none; it refuses a context that is not there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>
#include <epoxy/egl.h>

#include "raster/gl/context.h"
#include "raster/made.h"
#include "scratch.h"
#include "trace/scenes.h"

enum { WIDTH = 100, HEIGHT = 70, EDGE = 8 };

/* A context that stands for a window's: none of this library's calls makes it current. */
typedef struct Window {
    EGLContext context;
    GLuint framebuffer, color; /* EDGE pixels wider than the picture on every side */
} Window;

static EGLDisplay display = EGL_NO_DISPLAY;

static void need_egl(void) {
    if (display == EGL_NO_DISPLAY) skip();
}

static int begin(void **state) {
    (void)state;
    EGLint major, minor;
    if (!epoxy_has_egl() || !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        print_message("there is no EGL without a surface here\n");
        return 0;
    }
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (!eglInitialize(display, &major, &minor)) display = EGL_NO_DISPLAY;
    return 0;
}

static void make_current(EGLContext context) {
    assert_true(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
}

static EGLContext make_context(WeftGl gl, int major, int minor) {
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, major, EGL_CONTEXT_MINOR_VERSION_KHR, minor, EGL_NONE};
    assert_true(eglBindAPI(gl == WEFT_GL_ES ? EGL_OPENGL_ES_API : EGL_OPENGL_API));
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
}

static Window open_window(WeftGl gl) {
    Window w = {.context = make_context(gl, 3, gl == WEFT_GL_ES ? 0 : 3)};
    assert_true(w.context != EGL_NO_CONTEXT);
    make_current(w.context);
    glGenTextures(1, &w.color);
    glBindTexture(GL_TEXTURE_2D, w.color);
    /* one that converts to sRGB by itself where it is let: a desktop can be told not to */
    glTexImage2D(GL_TEXTURE_2D, 0, gl == WEFT_GL_ES ? GL_RGBA8 : GL_SRGB8_ALPHA8, WIDTH + 2 * EDGE, HEIGHT + 2 * EDGE,
                 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glGenFramebuffers(1, &w.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, w.framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, w.color, 0);
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    return w;
}

static void close_window(Window *w) {
    glDeleteFramebuffers(1, &w->framebuffer);
    glDeleteTextures(1, &w->color);
    make_current(EGL_NO_CONTEXT);
    assert_true(eglDestroyContext(display, w->context));
}

/* A quad of bright and dim colours, half of it seen through; around it nothing. */
static WeftScene *gradients(void) {
    static const float corners[4][4] = {
        {0.0f, 0.0f, 0.0f, 1.0f}, {4.0f, 0.5f, 0.02f, 1.0f}, {1.0f, 9.0f, 2.0f, 1.0f}, {0.01f, 0.02f, 0.3f, 0.0f}};
    WeftScene *scene = test_scene();
    Material *material = test_material(scene, 1.0f);
    material->unlit = true;
    material->alpha_mode = WEFT_ALPHA_BLEND;
    Mesh *mesh = test_quad(scene, vec3(-0.9f, -0.6f, 0.0f), vec3(1.8f, 0.0f, 0.0f), vec3(0.0f, 1.2f, 0.0f));
    mesh->color = arena_array(&scene->arena, 4, sizeof corners[0]);
    memcpy(mesh->color, corners, sizeof corners);
    scene_bounds(scene);
    return scene;
}

static const WeftRasterView view = {.width = WIDTH,
                                    .height = HEIGHT,
                                    .samples = 1,
                                    .camera = "0,0,3;0,0,0;30",
                                    .background = WEFT_BACKGROUND_TRANSPARENT};

static WeftRaster *raster_here(const WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.adopt = 1, .threads = 1, .no_cache = 1}, &raster, NULL, &error) !=
        WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static void draw(WeftRaster *raster) {
    WeftError error;
    if (weft_raster_draw(raster, &view, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftRasterShow shown_in(const Window *w) {
    return (WeftRasterShow){.framebuffer = w->framebuffer, .x = EDGE, .y = EDGE};
}

static void show(WeftRaster *raster, const WeftRasterShow *how) {
    WeftError error;
    if (weft_raster_show(raster, how, &error) != WEFT_OK) fail_msg("%s", error.text);
}

enum { ACROSS = WIDTH + 2 * EDGE, DOWN = HEIGHT + 2 * EDGE };
typedef struct Pixels {
    unsigned char rgba[DOWN][ACROSS][4]; /* from the bottom */
} Pixels;

static void read_window(const Window *w, Pixels *pixels) {
    glBindFramebuffer(GL_FRAMEBUFFER, w->framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, ACROSS, DOWN, GL_RGBA, GL_UNSIGNED_BYTE, pixels->rgba);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

static void clear_window(const Window *w) {
    glBindFramebuffer(GL_FRAMEBUFFER, w->framebuffer);
    glClearColor(0.0f, 1.0f, 0.0f, 0.2f);
    glClear(GL_COLOR_BUFFER_BIT);
}

/* How many channels are not the very byte of the tone-mapped image over the background; none may be off by
 * more than one. Around the picture nothing has changed. */
static int compare(const Pixels *pixels, const WeftImage *mapped) {
    static const unsigned char green[4] = {0, 255, 0, 51};
    int off = 0;
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            const unsigned char *is = pixels->rgba[DOWN - 1 - y][x];
            int column = x - EDGE, row = y - EDGE;
            if (column < 0 || column >= WIDTH || row < 0 || row >= HEIGHT) {
                assert_memory_equal(is, green, 4);
                continue;
            }
            const unsigned char *c = (const unsigned char *)mapped->pixels + 4 * (row * WIDTH + column);
            for (int k = 0; k < 3; k++) {
                if (abs(is[k] - c[k]) > 1) fail_msg("(%d, %d)[%d]: %d, not %d", column, row, k, is[k], c[k]);
                off += is[k] != c[k];
            }
            assert_int_equal(is[3], 255);
        }
    return off;
}

static void shows_what_tonemap_makes(WeftGl gl) {
    need_egl();
    Window w = open_window(gl);
    WeftScene *scene = gradients();
    WeftRaster *raster = raster_here(scene);
    WeftImage image, mapped;
    WeftError error;
    Pixels *pixels = calloc(1, sizeof *pixels);
    int off = 0, pictures = 0;
    assert_non_null(pixels);
    draw(raster);
    assert_int_equal(weft_raster_image(raster, &image, &error), WEFT_OK);
    for (int curve = WEFT_TONEMAP_PBR_NEUTRAL; curve < WEFT_TONEMAP_COUNT; curve++)
        for (float exposure = -3.0f; exposure <= 2.0f; exposure += 1.25f) {
            WeftTone tone = {.curve = (WeftTonemap)curve, .exposure = exposure};
            if (exposure > 0.0f) weft_white(3200.0f, 8.0f, tone.white);
            WeftRasterShow how = shown_in(&w);
            how.tonemap = (WeftTonemap)curve;
            how.exposure = exposure;
            memcpy(how.white, tone.white, sizeof how.white);
            how.background[0] = 0.2f;
            how.background[1] = 0.4f;
            how.background[2] = 1.0f;
            clear_window(&w);
            show(raster, &how);
            read_window(&w, pixels);
            assert_int_equal(weft_image_show(&image, &tone, how.background, &mapped, &error), WEFT_OK);
            off += compare(pixels, &mapped);
            weft_image_free(&mapped);
            pictures++;
        }
    print_message("%d bytes of %d are off by one\n", off, 3 * WIDTH * HEIGHT * pictures);
    assert_true(off < 3 * WIDTH * HEIGHT * pictures / 100);
    free(pixels);
    weft_image_free(&image);
    weft_raster_free(raster);
    weft_scene_free(scene);
    close_window(&w);
}

static void shown_pixels_are_those_of_tonemap_in_opengl(void **state) {
    (void)state;
    shows_what_tonemap_makes(WEFT_GL_DESKTOP);
}
static void shown_pixels_are_those_of_tonemap_in_opengl_es(void **state) {
    (void)state;
    shows_what_tonemap_makes(WEFT_GL_ES);
}

/* What is left and right of a border may come from two shows; and a picture may be made larger. */
static void shown_picture_is_clipped_and_scaled(void **state) {
    (void)state;
    need_egl();
    Window w = open_window(WEFT_GL_DESKTOP);
    WeftScene *scene = gradients();
    WeftRaster *raster = raster_here(scene);
    Pixels *whole = calloc(3, sizeof *whole), *part = whole + 1, *twice = whole + 2;
    assert_non_null(whole);
    draw(raster);
    WeftRasterShow how = shown_in(&w);
    clear_window(&w);
    show(raster, &how);
    read_window(&w, whole);
    how.clip[0] = ACROSS / 2;
    how.clip[2] = ACROSS;
    how.clip[3] = DOWN;
    clear_window(&w);
    show(raster, &how);
    read_window(&w, part);
    how = (WeftRasterShow){.framebuffer = w.framebuffer, .width = 2 * WIDTH, .height = 2 * HEIGHT};
    show(raster, &how);
    read_window(&w, twice);
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            static const unsigned char green[4] = {0, 255, 0, 51};
            assert_memory_equal(part->rgba[y][x], x < ACROSS / 2 ? green : whole->rgba[y][x], 4);
            for (int k = 0; k < 3; k++) /* but for the dither */
                assert_true(abs(twice->rgba[y][x][k] - whole->rgba[EDGE + y / 2][EDGE + x / 2][k]) <= 1);
        }
    free(whole);
    weft_raster_free(raster);
    weft_scene_free(scene);
    close_window(&w);
}

static GLint integer(GLenum what) {
    GLint value = -1;
    glGetIntegerv(what, &value);
    return value;
}

/* As a careless neighbour leaves it; returns its sampler. */
static GLuint spoil_state(void) {
    GLuint sampler;
    glGenSamplers(1, &sampler);
    glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    for (GLuint k = 0; k < 16; k++) glBindSampler(k, sampler);
    glEnable(GL_SCISSOR_TEST);
    glScissor(3, 4, 5, 6);
    glViewport(1, 2, 3, 4);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_NEVER, 0, 0);
    glEnable(GL_RASTERIZER_DISCARD);
    glEnable(GL_SAMPLE_COVERAGE);
    glSampleCoverage(0.0f, GL_FALSE);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_NEVER);
    glCullFace(GL_FRONT_AND_BACK);
    glEnable(GL_CULL_FACE);
    glFrontFace(GL_CW);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 7);
    glPixelStorei(GL_PACK_ROW_LENGTH, 1000);
    glPixelStorei(GL_PACK_SKIP_ROWS, 5);
    for (GLuint k = 0; k < 8; k++) glVertexAttrib4f(k, 0.0f, 0.5f, 0.0f, 0.0f);
    glActiveTexture(GL_TEXTURE0 + 5);
    if (epoxy_is_desktop_gl()) {
        glEnable(GL_FRAMEBUFFER_SRGB);
        glEnable(GL_COLOR_LOGIC_OP);
        glLogicOp(GL_CLEAR);
        glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
        glEnable(GL_CLIP_DISTANCE0 + 3);
        glPixelStorei(GL_UNPACK_SWAP_BYTES, GL_TRUE);
        glPixelStorei(GL_PACK_SWAP_BYTES, GL_TRUE);
        glDepthRange(1.0, 0.0);
    }
    glEnable(0xffff); /* an error that nobody asked for */
    return sampler;
}

static void assert_new_state(const Window *w) {
    static const GLenum off[] = {GL_SCISSOR_TEST,       GL_BLEND,     GL_STENCIL_TEST,
                                 GL_RASTERIZER_DISCARD, GL_CULL_FACE, GL_DEPTH_TEST};
    static const struct {
        GLenum what;
        GLint value;
    } values[] = {{GL_CURRENT_PROGRAM, 0},        {GL_VERTEX_ARRAY_BINDING, 0},     {GL_ARRAY_BUFFER_BINDING, 0},
                  {GL_UNIFORM_BUFFER_BINDING, 0}, {GL_ACTIVE_TEXTURE, GL_TEXTURE0}, {GL_UNPACK_ROW_LENGTH, 0},
                  {GL_PACK_ROW_LENGTH, 0},        {GL_UNPACK_ALIGNMENT, 4},         {GL_PACK_ALIGNMENT, 4},
                  {GL_DEPTH_WRITEMASK, GL_TRUE},  {GL_DEPTH_FUNC, GL_LESS},         {GL_CULL_FACE_MODE, GL_BACK},
                  {GL_FRONT_FACE, GL_CCW},        {GL_BLEND_SRC_RGB, GL_ONE},       {GL_BLEND_DST_RGB, GL_ZERO},
                  {GL_RENDERBUFFER_BINDING, 0}};
    for (size_t k = 0; k < sizeof off / sizeof off[0]; k++) assert_false(glIsEnabled(off[k]));
    for (size_t k = 0; k < sizeof values / sizeof values[0]; k++)
        assert_int_equal(integer(values[k].what), values[k].value);
    if (epoxy_is_desktop_gl()) {
        assert_false(glIsEnabled(GL_CLIP_DISTANCE0 + 3));
        assert_int_equal(integer(GL_UNPACK_SWAP_BYTES), 0);
        assert_int_equal(integer(GL_PACK_SWAP_BYTES), 0);
    }
    for (GLuint k = 0; k < 16; k++) {
        GLfloat now[4], fresh[4] = {0.0f, 0.0f, 0.0f, 1.0f};
        glGetVertexAttribfv(k, GL_CURRENT_VERTEX_ATTRIB, now);
        assert_memory_equal(now, fresh, sizeof now);
    }
    GLint box[4];
    glGetIntegerv(GL_SCISSOR_BOX, box);
    assert_memory_equal(box, ((GLint[]){3, 4, 5, 6}), sizeof box);
    glGetIntegerv(GL_VIEWPORT, box);
    assert_memory_equal(box, ((GLint[]){1, 2, 3, 4}), sizeof box);
    assert_int_equal(integer(GL_DRAW_FRAMEBUFFER_BINDING), w->framebuffer);
    assert_int_equal(integer(GL_READ_FRAMEBUFFER_BINDING), w->framebuffer);
    for (GLenum k = 0; k < 16; k++) {
        glActiveTexture(GL_TEXTURE0 + k);
        assert_int_equal(integer(GL_SAMPLER_BINDING), 0);
        assert_int_equal(integer(GL_TEXTURE_BINDING_2D), 0);
        assert_int_equal(integer(GL_TEXTURE_BINDING_2D_ARRAY), 0);
        assert_int_equal(integer(GL_TEXTURE_BINDING_CUBE_MAP), 0);
    }
    glActiveTexture(GL_TEXTURE0);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

/* One raster draws in a clean context, one in a spoilt one. What is lit reads constants in the place of what
 * vertices lack, and a shadow map. */
static void any_state_will_do(WeftGl gl, bool lit) {
    need_egl();
    const WeftLight light = {.direction = {0.1f, -0.2f, -1.0f}, .color = {2.0f, 2.0f, 2.0f}};
    Window w = open_window(gl);
    WeftScene *scene = gradients();
    scene->materials[0].unlit = !lit;
    test_environment(scene, 0.0f);
    assert_int_equal(weft_scene_add_light(scene, &light, NULL), WEFT_OK);
    Pixels *clean = calloc(2, sizeof *clean), *spoilt = clean + 1;
    assert_non_null(clean);
    for (int k = 0; k < 2; k++) {
        clear_window(&w);
        glBindFramebuffer(GL_FRAMEBUFFER, w.framebuffer);
        GLuint sampler = k ? spoil_state() : 0;
        WeftRaster *raster = raster_here(scene);
        if (k) assert_new_state(&w);
        if (k) spoil_state();
        draw(raster);
        if (k) assert_new_state(&w);
        if (k) spoil_state();
        WeftRasterShow how = shown_in(&w);
        show(raster, &how);
        if (k) assert_new_state(&w);
        weft_raster_free(raster);
        read_window(&w, k ? spoilt : clean);
        glDeleteSamplers(1, &sampler);
    }
    assert_memory_equal(clean, spoilt, sizeof *clean);
    free(clean);
    weft_scene_free(scene);
    close_window(&w);
}

static void show_works_in_any_state_of_opengl(void **state) {
    (void)state;
    any_state_will_do(WEFT_GL_DESKTOP, false);
    any_state_will_do(WEFT_GL_DESKTOP, true);
}
static void show_works_in_any_state_of_opengl_es(void **state) {
    (void)state;
    any_state_will_do(WEFT_GL_ES, false);
}

/* Two in one context, a third beside them in its own: all draw the same. */
static void two_rasters_share_a_context(void **state) {
    (void)state;
    need_egl();
    Window w = open_window(WEFT_GL_DESKTOP);
    WeftScene *scene = gradients();
    WeftRaster *rasters[3] = {raster_here(scene), raster_here(scene), NULL};
    WeftImage images[3];
    WeftError error;
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){.threads = 1}, &rasters[2], NULL, &error), WEFT_OK);
    for (int k = 0; k < 3; k++) draw(rasters[k]);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(weft_raster_image(rasters[k], &images[k], &error), WEFT_OK);
        assert_memory_equal(images[k].pixels, images[0].pixels, WIDTH * HEIGHT * 4 * sizeof(float));
        assert_true(eglGetCurrentContext() == w.context);
    }
    WeftRasterShow how = shown_in(&w);
    assert_int_equal(weft_raster_show(rasters[2], &how, &error), WEFT_USAGE); /* it has no framebuffer */
    for (int k = 0; k < 3; k++) {
        weft_image_free(&images[k]);
        weft_raster_free(rasters[k]);
    }
    assert_true(eglGetCurrentContext() == w.context);
    weft_scene_free(scene);
    close_window(&w);
}

/* What other threads make for it, as shaders are, is there in it. */
static void context_shares_objects_with_the_window(void **state) {
    (void)state;
    need_egl();
    for (int gl = WEFT_GL_DESKTOP; gl <= WEFT_GL_ES; gl++) {
        Window w = open_window((WeftGl)gl);
        GlContext *adopted;
        GlOuter outer;
        assert_int_equal(context_adopt(&adopted, NULL), WEFT_OK);
        GlContext *other = context_share(adopted);
        assert_non_null(other);
        assert_true(context_enter(other, &outer));
        GLuint program = glCreateProgram();
        glFinish();
        context_leave(other, &outer);
        assert_true(eglGetCurrentContext() == w.context);
        assert_true(glIsProgram(program));
        context_destroy(other);
        assert_true(glIsProgram(program) && eglGetCurrentContext() == w.context);
        context_destroy(adopted);
        close_window(&w);
    }
}

static void show_without_a_context_is_refused(void **state) {
    (void)state;
    need_egl();
    WeftScene *scene = gradients();
    WeftRaster *raster;
    WeftError error;
    make_current(EGL_NO_CONTEXT);
    assert_int_equal(weft_raster_create(scene, &(WeftRasterDesc){.adopt = 1}, &raster, NULL, &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_GL_CONTEXT);
    assert_null(raster);
    EGLContext old = make_context(WEFT_GL_ES, 2, 0); /* Mesa gives a later one, which will do */
    Window w = open_window(WEFT_GL_ES);
    raster = raster_here(scene);
    draw(raster);
    WeftRasterShow how = shown_in(&w);
    const EGLContext others[] = {EGL_NO_CONTEXT, old};
    for (int k = 0; k < 2; k++) {
        make_current(others[k]);
        assert_int_equal(weft_raster_draw(raster, &view, &error), WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_GL_CONTEXT);
        assert_int_equal(weft_raster_show(raster, &how, &error), WEFT_RESOURCES);
        assert_int_equal(weft_raster_update(raster, NULL, &error), WEFT_RESOURCES);
    }
    make_current(w.context);
    draw(raster);
    weft_raster_free(raster);
    assert_true(eglDestroyContext(display, old));
    close_window(&w);
    weft_scene_free(scene);
}

static void show_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    need_egl();
    Window w = open_window(WEFT_GL_DESKTOP);
    WeftScene *scene = gradients();
    WeftRaster *raster = raster_here(scene);
    WeftError error;
    WeftRasterShow how = shown_in(&w);
    assert_int_equal(weft_raster_show(raster, &how, &error), WEFT_USAGE); /* nothing was drawn */
    draw(raster);
    const WeftRasterShow wrong[] = {{.width = -1},     {.height = 1 << 20},     {.tonemap = WEFT_TONEMAP_COUNT},
                                    {.exposure = NAN}, {.white = {1.0f, 1.0f}}, {.clip = {0, 0, -1, 0}}};
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        assert_int_equal(weft_raster_show(raster, &wrong[k], &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    }
    show(raster, &how);
    weft_raster_free(raster);
    weft_scene_free(scene);
    close_window(&w);
}

/* Frames of a window make nothing, nor does an update that finds nothing. */
static void steady_shows_create_no_objects(void **state) {
    (void)state;
    need_egl();
    Window w = open_window(WEFT_GL_DESKTOP);
    WeftScene *scene = gradients();
    WeftRaster *raster = raster_here(scene);
    WeftRasterShow how = shown_in(&w);
    WeftError error;
    COUNTED(COUNT)
    draw(raster);
    show(raster, &how);
    int first = made;
    made = 0;
    for (int k = 0; k < 5; k++) {
        how.exposure = (float)k;
        how.tonemap = (WeftTonemap)(k % WEFT_TONEMAP_COUNT);
        assert_int_equal(weft_raster_update(raster, NULL, &error), WEFT_OK);
        draw(raster);
        show(raster, &how);
    }
    COUNTED(STOP_COUNTING)
    assert_true(first > 3);
    assert_int_equal(made, 0);
    weft_raster_free(raster);
    weft_scene_free(scene);
    close_window(&w);
}

static void write_text(const char *path, const char *text) {
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

/* The pass is text in the shader_dir as any other: broken, it leaves the one before in use. */
static void changed_show_text_is_compiled_and_broken_text_ignored(void **state) {
    (void)state;
    need_egl();
    char folder[SCRATCH_SIZE], path[96], command[128];
    assert_true(scratch_make(folder));
    snprintf(command, sizeof command, "mkdir -p %s/raster/glsl", folder);
    assert_int_equal(system(command), 0);
    snprintf(path, sizeof path, "%s/raster/glsl/display.glsl", folder);
    Window w = open_window(WEFT_GL_ES);
    WeftScene *scene = gradients();
    WeftRaster *raster;
    WeftError error;
    const WeftRasterDesc desc = {.adopt = 1, .shader_dir = folder};
    assert_int_equal(weft_raster_create(scene, &desc, &raster, NULL, &error), WEFT_OK);
    WeftRasterShow how = shown_in(&w);
    Pixels *before = calloc(2, sizeof *before), *after = before + 1;
    assert_non_null(before);
    draw(raster);
    show(raster, &how);
    read_window(&w, before);
    write_text(path, "out highp vec4 shown;\n\nvoid main() { shown = }\n");
    assert_int_equal(weft_raster_refresh(raster), 1);
    show(raster, &how);
    read_window(&w, after);
    assert_memory_equal(before, after, sizeof *after);
    snprintf(command, sizeof command, "%s:3: ", path);
    assert_memory_equal(weft_raster_info(raster).complaint, command, strlen(command));
    write_text(path, "out highp vec4 shown;\n\nvoid main() { shown = vec4(1.0); }\n");
    assert_int_equal(weft_raster_refresh(raster), 1);
    draw(raster);
    show(raster, &how);
    read_window(&w, after);
    assert_string_equal(weft_raster_info(raster).complaint, "");
    for (int k = 0; k < 4; k++) assert_int_equal(after->rgba[DOWN / 2][ACROSS / 2][k], 255);
    free(before);
    weft_raster_free(raster);
    weft_scene_free(scene);
    close_window(&w);
    assert_true(scratch_remove(folder));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shown_pixels_are_those_of_tonemap_in_opengl),
                                       cmocka_unit_test(shown_pixels_are_those_of_tonemap_in_opengl_es),
                                       cmocka_unit_test(shown_picture_is_clipped_and_scaled),
                                       cmocka_unit_test(show_works_in_any_state_of_opengl),
                                       cmocka_unit_test(show_works_in_any_state_of_opengl_es),
                                       cmocka_unit_test(two_rasters_share_a_context),
                                       cmocka_unit_test(context_shares_objects_with_the_window),
                                       cmocka_unit_test(show_without_a_context_is_refused),
                                       cmocka_unit_test(show_descriptors_without_sense_are_refused),
                                       cmocka_unit_test(steady_shows_create_no_objects),
                                       cmocka_unit_test(changed_show_text_is_compiled_and_broken_text_ignored)};
    return cmocka_run_group_tests(tests, begin, NULL);
}
