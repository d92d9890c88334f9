#include <math.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/steady_clock.h"
#include "raster/frame/passes.h"
#include "raster/frame/picture_block.h"
#include "raster/frame/shader_keys.h"
#include "raster/gl/gl_check.h"
#include "scene/material/hair.h"

/* Uploads `picture`, the uniform block that all shaders share, and binds it. */
static void upload_picture(const WeftRaster *self, const Picture *picture) {
    glBindBuffer(GL_UNIFORM_BUFFER, self->picture_buffer);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof *picture, picture);
    glBindBufferBase(GL_UNIFORM_BUFFER, BLOCK_PICTURE, self->picture_buffer);
}

static void put_row(float row[4], float x, float y, float z, float w) {
    row[0] = x, row[1] = y, row[2] = z, row[3] = w;
}

/* Writes the uniforms of reference.glsl. */
static void put_reference(const WeftRaster *self, Picture *out) {
    const Environment *e = &self->scene->environment;
    const RayScene *rays = &self->rays;
    const float kind = !self->environment_lit ? 0.0f : e->kind == ENVIRONMENT_CONSTANT ? 1.0f : 2.0f;
    put_row(out->sky_place, cosf(e->rotation), sinf(e->rotation), e->strength, kind);
    put_row(out->sky_color, e->color[0] * e->strength, e->color[1] * e->strength, e->color[2] * e->strength, 0.0f);
    put_row(out->sky_parts, e->ambient, e->reflection, 0.0f, 0.0f);
    put_row(out->ray_first, (float)rays->nodes, (float)rays->first[1], (float)rays->first[2], (float)rays->first[3]);
    put_row(out->ray_count, (float)rays->emitters, (float)self->sums.done, (float)rays->first[4],
            rays->hair_share > 1 ? 1.0f : 0.0f);
}

/* Fits the picture into the lower left of its shading points, whose squares of pixels may reach beyond its edges. */
static void fit_points(const Coarse *coarse, const WeftRasterView *view, float to_clip[16]) {
    const float rate = (float)view->shading_rate, x = (float)view->width / (rate * (float)coarse->width),
                y = (float)view->height / (rate * (float)coarse->height);
    for (int column = 0; column < 16; column += 4) {
        to_clip[column] = x * to_clip[column] + (x - 1.0f) * to_clip[column + 3];
        to_clip[column + 1] = y * to_clip[column + 1] + (y - 1.0f) * to_clip[column + 3];
    }
}

/* Returns the width of a pixel where w is 1, m. */
static float pixel_width(const float to_clip[16], int width) {
    return 2.0f / ((float)width * vec3_length(vec3(to_clip[0], to_clip[4], to_clip[8])));
}

/* Fills that block for a view of the scene, uploads it and binds it. seen: with which camera. points: of its shading points,
 * where they are fewer than pixels. */
static void upload_view(const WeftRaster *self, const View *seen, const WeftRasterView *view, bool points) {
    Picture picture;
    picture_make(self->scene, seen, &self->polygons, &self->shadows, &self->floor, &picture);
    picture.floor_light[0] = self->sky_on_floor;
    picture.floor_light[2] = self->floor_shaded ? 1.0f : 0.0f;
    put_reference(self, &picture);
    picture.texture_levels[0] = view->plain_textures ? 0.0f : 1.0f;
    put_row(picture.coarse, is_coarse(view) && !self->summing ? (float)COARSE_SIDE : 1.0f, (float)view->shading_rate,
            0.0f, points ? 2.0f : 1.0f);
    if (points) fit_points(&self->coarse, view, picture.to_clip);
    picture.coarse[2] = pixel_width(picture.to_clip, points ? self->coarse.width : view->width);
    upload_picture(self, &picture);
}

void frame_reset_state(WeftRaster *self) {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    meshes_bind(&self->meshes);
}

/* Clears the whole target, and then limits drawing to the crop: `box` holds x, y from below, width and height. With
 * several samples a pixel the limit is one pixel outside the crop, since drivers differ in the samples at its edge. */
static void clear_target(const Target *target, const WeftRasterView *view, const int box[4]) {
    bool several = target->drawn != target->resolved;
    int more = several ? 1 : 0;
    if (several && (box[2] < view->width || box[3] < view->height)) { /* target_resolve writes only the crop */
        glBindFramebuffer(GL_FRAMEBUFFER, target->resolved);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->drawn);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(box[0] - more, box[1] - more, box[2] + 2 * more, box[3] + 2 * more);
}

static bool shows_environment(const WeftRasterView *view) {
    return view->background == WEFT_BACKGROUND_ENVIRONMENT || view->background == WEFT_BACKGROUND_BLURRED;
}

/* Sets the colour that clears a target to that of the background. */
static void set_clear_color(const WeftRaster *self, const WeftRasterView *view) {
    bool color = view->background == WEFT_BACKGROUND_COLOR;
    const Environment *e = &self->scene->environment;
    const float *c = view->background_color;
    float constant[3];
    for (int k = 0; k < 3; k++) constant[k] = e->color[k] * e->strength;
    if (shows_environment(view) && e->kind == ENVIRONMENT_CONSTANT) {
        color = true;
        c = constant;
    }
    glClearColor(color ? c[0] : 0.0f, color ? c[1] : 0.0f, color ? c[2] : 0.0f, color ? 1.0f : 0.0f);
}

/* Clears the target to the background's colour and limits drawing to the crop. */
static void begin_picture(WeftRaster *self, const WeftRasterView *view, const int box[4]) {
    glViewport(0, 0, view->width, view->height);
    set_clear_color(self, view);
    clear_target(&self->target, view, box);
}

/* Binds the environment and the shadow maps, and switches the mipmaps of textures on or off as the view wants. */
static void bind_light(WeftRaster *self, const WeftRasterView *view) {
    bool no_mipmaps = view->plain_textures != 0;
    if (no_mipmaps != self->no_mipmaps) textures_filter(&self->textures, !no_mipmaps);
    self->no_mipmaps = no_mipmaps;
    if (self->environment_lit) environment_bind(&self->environment, UNIT_ENVIRONMENT, BLOCK_ENVIRONMENT);
    glActiveTexture(GL_TEXTURE0);
    if (self->shadows.count) shadows_bind(&self->shadows, UNIT_SHADOW, UNIT_SOFT_SHADOW);
}

/* Binds the triangles and the environment for rays, and textures without smaller copies. */
static void bind_rays(WeftRaster *self) {
    if (!self->no_mipmaps) textures_filter(&self->textures, false);
    self->no_mipmaps = true;
    ray_scene_bind(&self->rays, UNIT_RAYS, UNIT_MASKS);
    glActiveTexture(GL_TEXTURE0 + UNIT_SKY);
    glBindTexture(GL_TEXTURE_2D, self->sky.table);
    glActiveTexture(GL_TEXTURE0 + UNIT_BACKGROUND);
    glBindTexture(GL_TEXTURE_2D, self->environment_lit ? self->environment.map : 0);
    glActiveTexture(GL_TEXTURE0);
}

/* Puts the program of a key into use; a key holds all that the text of a shader depends on. If the files of the text
 * were edited and do not compile, the program from before is used. Fails if there is none. */
static WeftResult use_program(WeftRaster *self, const ShaderKey *key, const Program **program, WeftError *error) {
    WeftError failure = {0};
    *program = programs_get(&self->programs, key, &failure);
    if (*program) glUseProgram((*program)->name);
    if (!*program && error) *error = failure;
    return *program ? WEFT_OK : failure.result;
}

/* A mesh is drawn once where it is solid, with depth. What is left of one that blends is then blended over: of a
 * double-sided mesh the back faces first, since most of them lie behind. */
typedef enum MeshPass { PASS_SOLID, PASS_BLENDED } MeshPass;

/* The least opacity that counts as 1; texture filters round. */
#define SOLID_OPACITY 0.999f

/* Draws the faces of a mesh but those of one side. */
static void draw_side(const WeftRaster *self, int mesh, GLenum culled) {
    glEnable(GL_CULL_FACE);
    glCullFace(culled);
    meshes_draw(&self->meshes, mesh);
}

/* Draws a mesh in material k. culled: faces of one side that are left out; GL_NONE: none but those that the material
 * lacks. */
static WeftResult draw_mesh(WeftRaster *self, int mesh, int k, GLenum culled, MeshPass pass, const ShaderKey *key,
                            WeftError *error) {
    const GlMaterial *material = &self->materials.all[k];
    const Program *program;
    WeftResult result = use_program(self, key, &program, error);
    if (result != WEFT_OK) return result;
    glActiveTexture(GL_TEXTURE0 + UNIT_TABLES);
    glBindTexture(GL_TEXTURE_2D_ARRAY, program->tables);
    glActiveTexture(GL_TEXTURE0); /* leaves unit 0 active, where code between draws binds the objects it makes */
    materials_bind(&self->materials, &self->textures, k, BLOCK_MATERIAL);
    glUniform1f(program->surface_number, (float)(k % 255 + 1));
    if (hair_is_mesh(self->scene, mesh)) glUniform1f(program->hair_half, 0.5f * hair_thickness(self->scene, mesh));
    glUniform1f(program->least_opacity, pass == PASS_SOLID ? SOLID_OPACITY : 0.0f); /* without effect at -1 */
    if (culled != GL_NONE) {
        draw_side(self, mesh, culled);
    } else if (material->key.double_sided && pass == PASS_BLENDED && !material->key.hairy) {
        draw_side(self, mesh, GL_FRONT);
        draw_side(self, mesh, GL_BACK);
    } else if (material->key.double_sided) {
        glDisable(GL_CULL_FACE);
        meshes_draw(&self->meshes, mesh);
    } else {
        draw_side(self, mesh, key->depth ? GL_FRONT : GL_BACK); /* see draw_depth */
    }
    return WEFT_OK;
}

/* Compiles the shaders of a picture that are not compiled yet: programs_want records each key that it needs. */
static WeftResult compile_shaders(WeftRaster *self, const WeftRasterView *view, WeftError *error) {
    bool kept = all_keys(self, view, self->floor.there, programs_want);
    double start = clock_now();
    int compiled = self->programs.compiled;
    kept = kept && programs_build(&self->programs, self->context);
    if (self->programs.compiled != compiled) self->compile_seconds += clock_now() - start;
    return kept ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "shaders", NULL);
}

/* Draws the depths of all meshes but hair, which is finer than a texel of the maps. Clear panes are left out too:
 * in the maps they let all of light through. A single-sided surface hides the light from what it faces, since it is seen
 * from there, and has no shadow on the side of its back: so the faces that look away from the light are drawn, as the path
 * tracer's rays to the light meet them. */
static WeftResult draw_depth(WeftRaster *self, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int m = 0; m < self->scene->mesh_count && result == WEFT_OK; m++) {
        if (hair_is_mesh(self->scene, m)) continue;
        const int k = self->scene->meshes[m].material;
        if (self->materials.all[k].clear) continue;
        ShaderKey key = depth_key(&self->materials.all[k].key);
        result = draw_mesh(self, m, k, GL_NONE, PASS_SOLID, &key, error);
    }
    return result;
}

/* Draws all shadow maps, unless they are up to date. A polygon light has a map for each of `points` points on it, a
 * point light amid the scene one for each face of a cube, and others one map. */
static WeftResult draw_shadows(WeftRaster *self, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->shadows.count && !self->shadows.drawn && result == WEFT_OK; k++) {
        const Shadow *shadow = &self->shadows.all[k];
        for (int point = 0; point < shadow_view_count(shadow) && result == WEFT_OK; point++) {
            Picture picture;
            picture_of_shadow(shadow, point, &picture);
            upload_picture(self, &picture);
            shadows_begin(&self->shadows, k, point);
            result = draw_depth(self, error);
            glFinish(); /* else Mesa's software renderer keeps the triangles of all maps in memory */
        }
    }
    self->shadows.drawn = result == WEFT_OK;
    return result;
}

/* Draws the environment where no solid mesh was drawn. Blended meshes must not be drawn yet. */
static WeftResult draw_background(WeftRaster *self, bool blurred, WeftError *error) {
    const Environment *e = &self->scene->environment;
    WeftError failure = {0};
    if (!self->background_program) self->background_program = programs_background(&self->programs, &failure);
    if (!self->background_program) {
        if (error) *error = failure;
        return failure.result;
    }
    if (blurred && environment_blur(&self->environment, e, &failure) != WEFT_OK) {
        if (error) *error = failure;
        return failure.result;
    }
    glUseProgram(self->background_program);
    glUniform4f(glGetUniformLocation(self->background_program, "background_place"), cosf(e->rotation),
                sinf(e->rotation), e->strength, 0.0f);
    glActiveTexture(GL_TEXTURE0 + UNIT_BACKGROUND);
    glBindTexture(GL_TEXTURE_2D, blurred ? self->environment.blurred : self->environment.map);
    glActiveTexture(GL_TEXTURE0);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    return WEFT_OK;
}

/* Blends the floor over the picture; its colours are premultiplied. `ground` has its mirror image. */
static WeftResult draw_floor(WeftRaster *self, const WeftRasterView *view, WeftError *error) {
    ShaderKey key = floor_key(self, view);
    const Program *program;
    WeftResult result = use_program(self, &key, &program, error);
    if (result != WEFT_OK) return result;
    ground_bind(&self->ground, UNIT_FLOOR);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    return WEFT_OK;
}

/* Returns true if a mesh that blends may have points that this pass draws. */
static bool takes_part(const WeftScene *scene, int mesh, MeshPass pass) {
    const Mesh *m = &scene->meshes[mesh];
    const Material *material = &scene->materials[m->material];
    const Input *opacity = &material->inputs[INPUT_opacity];
    bool solid = opacity->value[0] >= SOLID_OPACITY; /* maps, colours and gaps of cloth lower it */
    if (hair_is_mesh(scene, mesh)) return true;
    return pass == PASS_SOLID ? solid : !solid || opacity->texture || m->color || material->cloth;
}

/* Draws a mesh in its material, and its back faces before in the material's back, if that is another one. */
static WeftResult draw_faces(WeftRaster *self, int mesh, MeshPass pass, const WeftRasterView *view, WeftError *error) {
    const int front = self->scene->meshes[mesh].material, back = scene_back(self->scene, front);
    WeftResult result = WEFT_OK;
    if (back >= 0) {
        const ShaderKey key = lit_key(self, view, &self->materials.all[back]);
        result = draw_mesh(self, mesh, back, GL_FRONT, pass, &key, error);
    }
    const ShaderKey key = lit_key(self, view, &self->materials.all[front]);
    if (result == WEFT_OK) result = draw_mesh(self, mesh, front, back >= 0 ? GL_BACK : GL_NONE, pass, &key, error);
    return result;
}

/* Draws a pass of the meshes from `first` on, of those in the queue's order before `end`. */
static WeftResult draw_meshes(WeftRaster *self, int first, int end, MeshPass pass, const WeftRasterView *view,
                              WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = first; k < end && result == WEFT_OK; k++) {
        int mesh = self->queue.order[k];
        if (view->hide_lights && mesh >= scene_light_meshes(self->scene)) continue;
        if (k >= self->queue.solid && !self->summing && !takes_part(self->scene, mesh, pass)) continue;
        result = draw_faces(self, mesh, pass, view, error);
    }
    return result;
}

/* Draws what is solid. */
static WeftResult draw_solid(WeftRaster *self, const View *seen, const WeftRasterView *view, WeftError *error) {
    queue_sort(&self->queue, self->scene, seen);
    return draw_meshes(self, 0, self->queue.count, PASS_SOLID, view, error);
}

/* Finds the light of the shading points, where these are fewer than pixels, and smooths the shadows of polygons. box: the
 * pixels that are drawn. */
static WeftResult draw_points(WeftRaster *self, const View *seen, const WeftRasterView *view, const int box[4],
                              WeftError *error) {
    Coarse *coarse = &self->coarse;
    const int rate = view->shading_rate, more = COARSE_SIDE, left = box[0] / rate - more, low = box[1] / rate - more;
    WeftResult result = coarse_begin(coarse, &self->programs.desc, view->width, view->height, rate, error);
    if (result != WEFT_OK) return result;
    frame_reset_state(self);
    upload_view(self, seen, view, true);
    bind_light(self, view);
    glBindFramebuffer(GL_FRAMEBUFFER, coarse->drawn);
    glViewport(0, 0, coarse->width, coarse->height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(left, low, (box[0] + box[2]) / rate + more + 1 - left, (box[1] + box[3]) / rate + more + 1 - low);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    result = draw_solid(self, seen, view, error);
    coarse_filter(coarse);
    glDisable(GL_SCISSOR_TEST);
    coarse_bind(coarse, UNIT_COARSE);
    meshes_bind(&self->meshes);
    return result;
}

/* Draws what is solid, the background, the floor and what blends into the framebuffer that is bound. Nothing blends in
 * a frame of a sum, where a random number decides partial opacity. resolves: what is solid has the light of the shading
 * points. */
static WeftResult draw_all(WeftRaster *self, const View *seen, const WeftRasterView *view, bool resolves,
                           WeftError *error) {
    const Queue *queue = &self->queue;
    bool behind = shows_environment(view) && self->environment_lit && self->environment.map;
    self->coarse.resolving = resolves;
    WeftResult result = draw_solid(self, seen, view, error);
    self->coarse.resolving = false;
    if (behind && result == WEFT_OK) result = draw_background(self, view->background == WEFT_BACKGROUND_BLURRED, error);
    if (self->summing && self->floor.there) bind_light(self, view);
    if (view->floor.on && self->floor.there && result == WEFT_OK) result = draw_floor(self, view, error);
    if (self->summing) return result == WEFT_OK ? gl_check(error, "a frame") : result;
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA); /* colours are premultiplied */
    glDepthMask(GL_FALSE);
    if (result == WEFT_OK) result = draw_meshes(self, queue->solid, queue->count, PASS_BLENDED, view, error);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    return result == WEFT_OK ? gl_check(error, "a picture") : result;
}

/* Finds the floor of a picture and the environment's light on it. A picture has a floor only if it shows all light, not
 * one part such as the diffuse one, and if the camera sees the floor from above. */
static WeftResult find_floor(WeftRaster *self, const View *seen, const WeftRasterView *view, WeftError *error) {
    Floor floor = floor_of(self->scene, &view->floor);
    bool above = seen->orthographic ? seen->forward.y < 0.0f : seen->eye.y > floor.middle.y;
    floor.there = floor.there && view->part == WEFT_PART_ALL && above;
    self->floor = floor;
    self->sky_on_floor = 0.0f;
    self->floor_shaded = !view->no_shadows;
    if (!floor.there || !self->environment_lit || view->ambient == WEFT_AMBIENT_NONE) return WEFT_OK;
    WeftResult result = ground_look(&self->ground, self->scene, &floor, self->desc.threads, error);
    self->sky_on_floor = self->ground.light; /* ground.sky has the fraction of it that reaches each point */
    return result;
}

/* Draws the floor's mirror image of the scene, if the floor reflects. */
static WeftResult draw_mirror(WeftRaster *self, const View *seen, const WeftRasterView *view, const int box[4],
                              WeftError *error) {
    if (!self->floor.there || !(self->floor.reflection > 0.0f)) return WEFT_OK;
    View below = ground_view(&self->floor, seen);
    WeftRasterView alone = *view;
    alone.background = WEFT_BACKGROUND_TRANSPARENT;
    alone.floor.on = 0;
    WeftResult result = ground_mirror(&self->ground, view->width, view->height, box, error);
    if (result != WEFT_OK) return result;
    upload_view(self, &below, view, false);
    bind_light(self, view);
    result = draw_all(self, &below, &alone, false, error);
    ground_mirrored(&self->ground); /* makes the mipmaps of the mirror image */
    frame_reset_state(self);        /* blended meshes have changed it */
    return result;
}

/* Returns free memory to the system after the first picture with new programs, and after their first picture with each
 * number of samples a pixel. Drivers compile for such a picture, and free most of the memory of it afterwards. */
static void return_spare(WeftRaster *self) {
    const uint64_t samples = (uint64_t)1 << (self->target.samples & 63);
    if (self->programs.compiled != self->drawn_programs) self->drawn_samples = 0;
    if (!(self->drawn_samples & samples)) memory_return();
    self->drawn_programs = self->programs.compiled;
    self->drawn_samples |= samples;
}

WeftResult frame_take_occlusion(WeftRaster *self, bool wait, WeftError *error) {
    /* After shapes of lights have changed, an update uploads meshes first. `lookout` is the search for occlusion. */
    if (self->shape_version != self->scene->shape_version) return WEFT_OK;
    return lookout_take(&self->lookout, &self->meshes, wait, error);
}

WeftResult frame_draw_passes(WeftRaster *self, const WeftRasterView *view, const View *seen, WeftError *error) {
    frame_reset_state(self);
    WeftResult result = find_floor(self, seen, view, error);
    if (result == WEFT_OK) result = compile_shaders(self, view, error);
    if (result == WEFT_OK) result = frame_take_occlusion(self, false, error);
    if (result == WEFT_OK && !view->no_shadows) result = draw_shadows(self, error);
    if (result == WEFT_OK) result = target_resize(&self->target, view->width, view->height, view->samples, error);
    /* OpenGL's rows run from the bottom */
    const int *c = view->crop, box[4] = {c[0], view->height - c[1] - c[3], c[2], c[3]};
    if (result == WEFT_OK) result = draw_mirror(self, seen, view, box, error);
    if (result == WEFT_OK && is_coarse(view)) result = draw_points(self, seen, view, box, error);
    if (result == WEFT_OK) {
        upload_view(self, seen, view, false);
        begin_picture(self, view, box);
        bind_light(self, view);
        result = draw_all(self, seen, view, is_coarse(view), error);
        glDisable(GL_SCISSOR_TEST);
        target_resolve(&self->target, box);
    }
    return_spare(self);
    return result;
}

/* Frees the shaders of a picture at rest, which is not drawn again before something changes, where moving pictures have
 * shaders of their own. A property has the same in each; the mirror of a floor is drawn as at rest. */
static void forget_still(WeftRaster *self, const WeftRasterView *view) {
    WeftRasterView moving = *view;
    moving.shading_rate = 2;
    if (!self->floor.there && is_coarse(&moving) && all_keys(self, &moving, false, programs_has))
        programs_forget(&self->programs, is_still);
}

WeftResult frame_begin_sum(WeftRaster *self, const View *seen, WeftError *error) {
    Sums *sums = &self->sums;
    const WeftRasterView *view = &sums->view;
    frame_reset_state(self);
    WeftResult result = find_floor(self, seen, view, error);
    if (result == WEFT_OK && self->floor.there) result = compile_shaders(self, view, error); /* of its mirror */
    if (result == WEFT_OK && self->floor.there && !view->no_shadows) result = draw_shadows(self, error);
    forget_still(self, view);
    self->summing = true;
    if (result == WEFT_OK) result = compile_shaders(self, view, error);
    self->summing = false;
    if (result == WEFT_OK)
        result = ray_scene_make(&self->rays, self->scene, view->bounces ? self->materials.sheens : NULL, error);
    if (result == WEFT_OK && self->environment_lit)
        result = sky_table_make(&self->sky, &self->scene->environment, error);
    if (result == WEFT_OK)
        result = sums_begin(sums, &self->programs.desc, view->width, view->height, sums->starts ? &self->target : NULL,
                            error);
    if (result == WEFT_OK && (self->target.width != view->width || self->target.height != view->height))
        result = target_resize(&self->target, view->width, view->height, 1, error);
    if (result == WEFT_OK) target_keep_mean(&self->target);
    memory_return();
    return result;
}

/* Draws `rows` rows of the frame, from `row` on. */
static WeftResult draw_strip(WeftRaster *self, const View *seen, int row, int rows, WeftError *error) {
    const WeftRasterView *view = &self->sums.view;
    const int *c = view->crop, bottom = view->height - c[1] - c[3];
    const int low = row > bottom ? row : bottom, high = row + rows < bottom + c[3] ? row + rows : bottom + c[3];
    const int box[4] = {c[0], low, c[2], high > low ? high - low : 0};
    WeftResult result = WEFT_OK;
    frame_reset_state(self);
    if (row == 0) result = draw_mirror(self, seen, view, (const int[4]){c[0], bottom, c[2], c[3]}, error);
    if (result != WEFT_OK) return result;
    upload_view(self, seen, view, false);
    glViewport(0, 0, view->width, view->height);
    glBindFramebuffer(GL_FRAMEBUFFER, self->sums.frame.drawn);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, row, view->width, rows);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f); /* outside the crop */
    glClear(GL_COLOR_BUFFER_BIT);
    glScissor(box[0], box[1], box[2], box[3]);
    set_clear_color(self, view);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    bind_rays(self);
    self->summing = true;
    result = draw_all(self, seen, view, false, error);
    self->summing = false;
    glDisable(GL_SCISSOR_TEST);
    return result;
}

WeftResult frame_draw_sum(WeftRaster *self, int rows, WeftError *error) {
    Sums *sums = &self->sums;
    const View seen = sums_view(sums);
    const int left = sums->height - sums->row;
    rows = rows < left ? rows : left;
    WeftResult result = draw_strip(self, &seen, sums->row, rows, error);
    if (result != WEFT_OK) return result;
    sums->row += rows;
    const bool whole = sums->row == sums->height;
    if (whole) sums_add(sums, &self->target);
    glFinish();
    if (whole) return_spare(self);
    return gl_check(error, "a sum of frames");
}
