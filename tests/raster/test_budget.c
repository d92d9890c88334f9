/* The driver's memory of a raster stays within a budget: its textures, renderbuffers and buffers are counted as they are
 * made and deleted
 *
 * Labels: slow */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "gl.h"
#include "shading/cases.h"
#include "weft/weft.h"

typedef enum Kind { TEXTURE, RENDERBUFFER, BUFFER } Kind;

/* A level of a texture or face, a renderbuffer, or a buffer. */
typedef struct Piece {
    Kind kind;
    GLuint name;
    GLenum target;
    GLint level;
    double bytes;
} Piece;

static Piece pieces[4096];
static int piece_count;

static PFNGLTEXIMAGE2DPROC tex_image_2d;
static PFNGLTEXIMAGE3DPROC tex_image_3d;
static PFNGLRENDERBUFFERSTORAGEPROC storage;
static PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC storage_of_samples;
static PFNGLBUFFERDATAPROC buffer_data;
static PFNGLDELETETEXTURESPROC delete_textures;
static PFNGLDELETERENDERBUFFERSPROC delete_renderbuffers;
static PFNGLDELETEBUFFERSPROC delete_buffers;

static double bytes_of(GLenum format) {
    switch (format) {
    case GL_RGBA32F: return 16.0;
    case GL_RGBA16F: return 8.0;
    case GL_R16F:
    case GL_DEPTH_COMPONENT16:
    case GL_RG8: return 2.0;
    case GL_R8: return 1.0;
    case GL_R32F:
    case GL_RGBA8:
    case GL_SRGB8_ALPHA8:
    case GL_DEPTH_COMPONENT32F: return 4.0;
    default: fail_msg("format 0x%x", format); return 0.0;
    }
}

/* Returns the name that is bound. */
static GLuint bound(GLenum binding) {
    GLint name = 0;
    glGetIntegerv(binding, &name);
    return (GLuint)name;
}

static GLenum texture_binding(GLenum target) {
    return target == GL_TEXTURE_2D         ? GL_TEXTURE_BINDING_2D
           : target == GL_TEXTURE_2D_ARRAY ? GL_TEXTURE_BINDING_2D_ARRAY
                                           : GL_TEXTURE_BINDING_CUBE_MAP;
}

static GLenum buffer_binding(GLenum target) {
    switch (target) {
    case GL_ARRAY_BUFFER: return GL_ARRAY_BUFFER_BINDING;
    case GL_ELEMENT_ARRAY_BUFFER: return GL_ELEMENT_ARRAY_BUFFER_BINDING;
    case GL_UNIFORM_BUFFER: return GL_UNIFORM_BUFFER_BINDING;
    default: fail_msg("buffer 0x%x", target); return 0;
    }
}

static void put(Piece piece) {
    int k = 0;
    while (k < piece_count && !(pieces[k].kind == piece.kind && pieces[k].name == piece.name &&
                                pieces[k].target == piece.target && pieces[k].level == piece.level))
        k++;
    assert_true(k < (int)(sizeof pieces / sizeof pieces[0]));
    if (k == piece_count) piece_count++;
    pieces[k] = piece;
}

static void forget(Kind kind, GLsizei count, const GLuint *names) {
    for (int k = piece_count - 1; k >= 0; k--)
        for (GLsizei n = 0; n < count; n++)
            if (pieces[k].kind == kind && pieces[k].name == names[n]) {
                pieces[k] = pieces[--piece_count];
                break;
            }
}

static void on_image_2d(GLenum target, GLint level, GLint format, GLsizei w, GLsizei h, GLint border, GLenum of,
                        GLenum type, const void *data) {
    put((Piece){TEXTURE, bound(texture_binding(target)), target, level,
                bytes_of((GLenum)format) * (double)w * (double)h});
    tex_image_2d(target, level, format, w, h, border, of, type, data);
}
static void on_image_3d(GLenum target, GLint level, GLint format, GLsizei w, GLsizei h, GLsizei d, GLint border,
                        GLenum of, GLenum type, const void *data) {
    put((Piece){TEXTURE, bound(texture_binding(target)), target, level,
                bytes_of((GLenum)format) * (double)w * (double)h * (double)d});
    tex_image_3d(target, level, format, w, h, d, border, of, type, data);
}
static void on_storage(GLenum target, GLenum format, GLsizei w, GLsizei h) {
    put((Piece){RENDERBUFFER, bound(GL_RENDERBUFFER_BINDING), 0, 0, bytes_of(format) * (double)w * (double)h});
    storage(target, format, w, h);
}
static void on_storage_of_samples(GLenum target, GLsizei samples, GLenum format, GLsizei w, GLsizei h) {
    const double each = samples > 1 ? (double)samples : 1.0;
    put((Piece){RENDERBUFFER, bound(GL_RENDERBUFFER_BINDING), 0, 0, each * bytes_of(format) * (double)w * (double)h});
    storage_of_samples(target, samples, format, w, h);
}
static void on_buffer(GLenum target, GLsizeiptr size, const void *data, GLenum usage) {
    put((Piece){BUFFER, bound(buffer_binding(target)), 0, 0, (double)size});
    buffer_data(target, size, data, usage);
}
static void on_delete_textures(GLsizei n, const GLuint *names) {
    forget(TEXTURE, n, names);
    delete_textures(n, names);
}
static void on_delete_renderbuffers(GLsizei n, const GLuint *names) {
    forget(RENDERBUFFER, n, names);
    delete_renderbuffers(n, names);
}
static void on_delete_buffers(GLsizei n, const GLuint *names) {
    forget(BUFFER, n, names);
    delete_buffers(n, names);
}

#define WATCHED(W)                                                                                                     \
    W(tex_image_2d, epoxy_glTexImage2D, on_image_2d)                                                                   \
    W(tex_image_3d, epoxy_glTexImage3D, on_image_3d)                                                                   \
    W(storage, epoxy_glRenderbufferStorage, on_storage)                                                                \
    W(storage_of_samples, epoxy_glRenderbufferStorageMultisample, on_storage_of_samples)                               \
    W(buffer_data, epoxy_glBufferData, on_buffer)                                                                      \
    W(delete_textures, epoxy_glDeleteTextures, on_delete_textures)                                                     \
    W(delete_renderbuffers, epoxy_glDeleteRenderbuffers, on_delete_renderbuffers)                                      \
    W(delete_buffers, epoxy_glDeleteBuffers, on_delete_buffers)
#define WATCH(kept, call, watching) kept = call, call = watching;
#define LEAVE(kept, call, watching) call = kept;

/* Calls each of them once, since libepoxy finds a call of the driver at its first use and would find the watching one. */
static int begin(void **state) {
    GlContext *context;
    GlOuter outer;
    GLuint names[2];
    gl_begin(state);
    if (no_gl) return 0;
    assert_int_equal(context_create(TEXT_GLSL_330, &context, NULL), WEFT_OK);
    assert_true(context_enter(context, &outer));
    glGenTextures(2, names);
    glBindTexture(GL_TEXTURE_2D, names[0]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glBindTexture(GL_TEXTURE_2D_ARRAY, names[1]);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, 1, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glDeleteTextures(2, names);
    glGenRenderbuffers(1, names);
    glBindRenderbuffer(GL_RENDERBUFFER, names[0]);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 1, 1);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 0, GL_RGBA8, 1, 1);
    glDeleteRenderbuffers(1, names);
    glGenBuffers(1, names);
    glBindBuffer(GL_ARRAY_BUFFER, names[0]);
    glBufferData(GL_ARRAY_BUFFER, 1, NULL, GL_STATIC_DRAW);
    glDeleteBuffers(1, names);
    context_leave(context, &outer);
    context_destroy(context);
    return 0;
}

/* MiB that live. */
static double live(void) {
    double sum = 0.0;
    for (int k = 0; k < piece_count; k++) sum += pieces[k].bytes;
    return sum / 1048576.0;
}

static WeftRaster *raster_of(WeftScene *scene) {
    WeftRaster *raster;
    WeftError error;
    if (weft_raster_create(scene, &(WeftRasterDesc){.no_cache = 1, .occlusion = 16}, &raster, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return raster;
}

static void draw(WeftRaster *raster, const WeftRasterView *view) {
    WeftError error;
    if (weft_raster_draw(raster, view, &error) != WEFT_OK) fail_msg("%s", error.text);
}

static WeftScene *scene_of(const char *name) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load(name, &scene, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return scene;
}

static WeftImage image_of(WeftRaster *raster) {
    WeftImage image;
    WeftError error;
    if (weft_raster_image(raster, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

/* Returns how many numbers differ, and frees both pictures. */
static int differing(WeftImage a, WeftImage b) {
    const float *p = a.pixels, *q = b.pixels;
    int count = 0;
    for (int k = 0; k < 4 * a.width * a.height; k++) count += p[k] < q[k] || p[k] > q[k];
    weft_image_free(&a);
    weft_image_free(&b);
    return count;
}

static const WeftRasterView still = {.width = 1280, .height = 720, .samples = 4, .bounces = 1};

/* The scene with the most triangles and lamps, as the window has it: moving, at rest, and while frames add up. */
static void a_sum_at_720p_stays_within_its_budget(void **state) {
    (void)state;
    need_gl();
    WeftRasterView moving = still;
    WeftError error;
    int done = 0;
    moving.samples = 1, moving.bounces = 0, moving.shading_rate = 4;
    WATCHED(WATCH)
    WeftScene *scene = scene_of("builtin:sewing");
    WeftRaster *raster = raster_of(scene);
    assert_int_equal(weft_raster_wait(raster, &error), WEFT_OK);
    draw(raster, &moving);
    const double first = live();
    draw(raster, &still);
    const double rest = live();
    WeftImage drawn = image_of(raster);
    weft_raster_rest(raster);
    const double idle = live();
    assert_int_equal(differing(drawn, image_of(raster)), 0); /* and it can still be shown */
    assert_int_equal(weft_raster_accumulate_begin(raster, &still, 4, &error), WEFT_OK);
    const double sum = live();
    assert_int_equal(weft_raster_accumulate(raster, 0.0, &done, &error), WEFT_OK);
    const double strip = live();
    draw(raster, &moving); /* the camera turns, and rests again */
    assert_int_equal(weft_raster_accumulate_begin(raster, &still, 4, &error), WEFT_OK);
    const double again = live();
    weft_raster_free(raster);
    weft_scene_free(scene);
    WATCHED(LEAVE)
    print_message("MiB: %.1f moving, %.1f at rest, %.1f once it stays so, %.1f as frames add up, %.1f after a turn; %d "
                  "pieces left\n",
                  first, rest, idle, sum, again, piece_count);
    assert_true(idle < rest - 42.0); /* four samples of twelve bytes a pixel */
    if (first > 70.0) fail_msg("moving: more than 70");
    if (sum > 95.0) fail_msg("a sum: more than 95");
    assert_true(strip <= sum);
    assert_true(again <= sum + 1.0);
    assert_int_equal(piece_count, 0); /* whatever is made is freed */
}

/* Returns the MiB of a sum of a scene. */
static double sum_of(WeftScene *scene) {
    WeftError error;
    WeftRaster *raster = raster_of(scene);
    assert_int_equal(weft_raster_wait(raster, &error), WEFT_OK);
    draw(raster, &still);
    weft_raster_rest(raster);
    assert_int_equal(weft_raster_accumulate_begin(raster, &still, 4, &error), WEFT_OK);
    const double sum = live();
    weft_raster_free(raster);
    return sum;
}

/* The largest tables are those of ltc-fibre; in long runs every lobe has its turn. */
static void each_sheen_stays_within_the_budget_of_a_sum(void **state) {
    (void)state;
    need_gl();
    WATCHED(WATCH)
    WeftScene *scene = scene_of("builtin:sewing");
    for (int k = 0; k < weft_lobe_count(); k++) {
        const char *lobe = weft_lobe_info(k)->id;
        if (weft_lobe_info(k)->traits & WEFT_LOBE_REFERENCE) continue; /* never in a shader */
        if (!test_long() && strcmp(lobe, "ltc-fibre") != 0) continue;
        if (weft_scene_set(scene, "*.sheen_lobe", lobe, NULL, NULL) != WEFT_OK) continue; /* no sheen */
        const double sum = sum_of(scene);
        print_message("%s: %.1f MiB\n", lobe, sum);
        if (sum > 95.0) fail_msg("%s: more than 95", lobe);
    }
    weft_scene_free(scene);
    WATCHED(LEAVE)
    assert_int_equal(piece_count, 0);
}

/* Two lamps cost as much as one. */
static void lamps_share_the_memory_of_soft_shadows(void **state) {
    (void)state;
    need_gl();
    static const WeftLight lamp = {.kind = WEFT_LIGHT_POLYGON,
                                   .position = {2.0f, 3.0f, 1.0f},
                                   .direction = {-2.0f, -3.0f, -1.0f},
                                   .size = {1.0f, 1.0f},
                                   .color = {5.0f, 5.0f, 5.0f}};
    double most[3];
    WATCHED(WATCH)
    WeftScene *scene = scene_of("builtin:cloth"); /* has a lamp of its own */
    for (int lamps = 0; lamps < 3; lamps++) {
        WeftRaster *raster = raster_of(scene);
        most[lamps] = live();
        weft_raster_free(raster);
        if (lamps < 2) assert_int_equal(weft_scene_add_light(scene, &lamp, NULL), WEFT_OK);
    }
    weft_scene_free(scene);
    WATCHED(LEAVE)
    print_message("MiB: %.1f with one lamp, %.1f with two, %.1f with three\n", most[0], most[1], most[2]);
    assert_true(most[0] > 27.0); /* maps of 16 bits, 55 of 512 x 512 */
    assert_true(most[1] < most[0] + 0.5);
    assert_true(most[2] < most[0] + 0.5);
    assert_int_equal(piece_count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sum_at_720p_stays_within_its_budget),
        cmocka_unit_test(each_sheen_stays_within_the_budget_of_a_sum),
        cmocka_unit_test(lamps_share_the_memory_of_soft_shadows),
    };
    return cmocka_run_group_tests(tests, begin, NULL);
}
