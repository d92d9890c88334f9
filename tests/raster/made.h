/* made.h - the driver's calls that make something, counted in `made` between COUNTED(COUNT) and
 * COUNTED(STOP_COUNTING) */
#ifndef WEFT_TEST_RASTER_MADE_H
#define WEFT_TEST_RASTER_MADE_H

#include <epoxy/gl.h>

static int made;
static PFNGLGENTEXTURESPROC gen_textures;
static PFNGLGENBUFFERSPROC gen_buffers;
static PFNGLGENFRAMEBUFFERSPROC gen_framebuffers;
static PFNGLGENRENDERBUFFERSPROC gen_renderbuffers;
static PFNGLGENSAMPLERSPROC gen_samplers;
static PFNGLGENVERTEXARRAYSPROC gen_vertices;
static PFNGLCREATEPROGRAMPROC create_program;
static PFNGLBUFFERDATAPROC buffer_data;
static PFNGLTEXIMAGE3DPROC tex_image;

static void count_textures(GLsizei n, GLuint *names) {
    made += n;
    gen_textures(n, names);
}
static void count_buffers(GLsizei n, GLuint *names) {
    made += n;
    gen_buffers(n, names);
}
static void count_framebuffers(GLsizei n, GLuint *names) {
    made += n;
    gen_framebuffers(n, names);
}
static void count_renderbuffers(GLsizei n, GLuint *names) {
    made += n;
    gen_renderbuffers(n, names);
}
static void count_samplers(GLsizei n, GLuint *names) {
    made += n;
    gen_samplers(n, names);
}
static void count_vertices(GLsizei n, GLuint *names) {
    made += n;
    gen_vertices(n, names);
}
static GLuint count_program(void) {
    made++;
    return create_program();
}
static void count_data(GLenum target, GLsizeiptr size, const void *data, GLenum usage) {
    made++;
    buffer_data(target, size, data, usage);
}
static void count_image(GLenum target, GLint level, GLint format, GLsizei w, GLsizei h, GLsizei d, GLint border,
                        GLenum of, GLenum type, const void *data) {
    made++;
    tex_image(target, level, format, w, h, d, border, of, type, data);
}

#define COUNTED(C)                                                                                                     \
    C(gen_textures, epoxy_glGenTextures, count_textures)                                                               \
    C(gen_buffers, epoxy_glGenBuffers, count_buffers)                                                                  \
    C(gen_framebuffers, epoxy_glGenFramebuffers, count_framebuffers)                                                   \
    C(gen_renderbuffers, epoxy_glGenRenderbuffers, count_renderbuffers)                                                \
    C(gen_samplers, epoxy_glGenSamplers, count_samplers)                                                               \
    C(gen_vertices, epoxy_glGenVertexArrays, count_vertices)                                                           \
    C(create_program, epoxy_glCreateProgram, count_program)                                                            \
    C(buffer_data, epoxy_glBufferData, count_data)                                                                     \
    C(tex_image, epoxy_glTexImage3D, count_image)
#define COUNT(kept, call, counting)         kept = call, call = counting;
#define STOP_COUNTING(kept, call, counting) call = kept;

#endif
