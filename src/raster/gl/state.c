#include "raster/gl/state.h"

#include <stdbool.h>
#include <stddef.h>

#include <epoxy/gl.h>

/* Texture units and uniform blocks in use at most; every driver has as many. */
enum { UNITS = 16, BLOCKS = 4, ATTRIBUTES = 16, CLIP_DISTANCES = 8 };

#define COUNT(a) (sizeof(a) / sizeof(a)[0])

static void reset_switches(bool desktop) {
    static const GLenum off[] = {GL_BLEND,
                                 GL_CULL_FACE,
                                 GL_DEPTH_TEST,
                                 GL_STENCIL_TEST,
                                 GL_SCISSOR_TEST,
                                 GL_POLYGON_OFFSET_FILL,
                                 GL_SAMPLE_ALPHA_TO_COVERAGE,
                                 GL_SAMPLE_COVERAGE,
                                 GL_RASTERIZER_DISCARD};
    static const GLenum off_desktop[] = {
        GL_COLOR_LOGIC_OP,    GL_DEPTH_CLAMP,      GL_SAMPLE_ALPHA_TO_ONE,      GL_SAMPLE_MASK,
        GL_PRIMITIVE_RESTART, GL_FRAMEBUFFER_SRGB, GL_TEXTURE_CUBE_MAP_SEAMLESS};
    for (size_t k = 0; k < COUNT(off); k++) glDisable(off[k]);
    if (!desktop) return;
    for (size_t k = 0; k < COUNT(off_desktop); k++) glDisable(off_desktop[k]);
    for (GLenum k = 0; k < CLIP_DISTANCES; k++) glDisable(GL_CLIP_DISTANCE0 + k);
    glEnable(GL_MULTISAMPLE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

static void reset_drawing(bool desktop) {
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    if (desktop) { /* the calls of ES came with 4.1 */
        glDepthRange(0.0, 1.0);
        glClearDepth(1.0);
    } else {
        glDepthRangef(0.0f, 1.0f);
        glClearDepthf(1.0f);
    }
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ZERO);
}

static void reset_pixels(bool desktop) {
    static const GLenum rows[] = {GL_UNPACK_ROW_LENGTH,  GL_UNPACK_SKIP_ROWS,    GL_UNPACK_SKIP_PIXELS,
                                  GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT, GL_PACK_ROW_LENGTH,
                                  GL_PACK_SKIP_ROWS,     GL_PACK_SKIP_PIXELS};
    static const GLenum rows_desktop[] = {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_PACK_SWAP_BYTES,
                                          GL_PACK_LSB_FIRST,    GL_PACK_SKIP_IMAGES, GL_PACK_IMAGE_HEIGHT};
    for (size_t k = 0; k < COUNT(rows); k++) glPixelStorei(rows[k], 0);
    for (size_t k = 0; desktop && k < COUNT(rows_desktop); k++) glPixelStorei(rows_desktop[k], 0);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

static void reset_bindings(void) {
    glUseProgram(0);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (GLuint k = 0; k < BLOCKS; k++) glBindBufferBase(GL_UNIFORM_BUFFER, k, 0);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
    for (GLuint k = 0; k < ATTRIBUTES; k++) glVertexAttrib4f(k, 0.0f, 0.0f, 0.0f, 1.0f);
    for (GLuint k = UNITS; k-- > 0;) {
        glActiveTexture(GL_TEXTURE0 + k);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
        glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
        glBindSampler(k, 0);
    }
}

static void reset(bool desktop) {
    reset_switches(desktop);
    reset_drawing(desktop);
    reset_pixels(desktop);
    reset_bindings();
}

void state_begin(GlPlace *place) {
    bool desktop = epoxy_is_desktop_gl();
    /* a driver may have one pending of each kind; a lost context reports errors for ever */
    for (int k = 0; k < 8 && glGetError() != GL_NO_ERROR; k++) continue;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &place->draw);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &place->read);
    glGetIntegerv(GL_VIEWPORT, place->viewport);
    glGetIntegerv(GL_SCISSOR_BOX, place->scissor);
    reset(desktop);
    if (desktop) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS); /* OpenGL ES always has it */
}

void state_end(const GlPlace *place) {
    const int *v = place->viewport, *s = place->scissor;
    reset(epoxy_is_desktop_gl());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, (GLuint)place->draw);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, (GLuint)place->read);
    glViewport(v[0], v[1], v[2], v[3]);
    glScissor(s[0], s[1], s[2], s[3]);
}
