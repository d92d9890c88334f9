/* reflection_write.c - any reflection as a file of RGL's format */
#include <math.h>
#include <stdint.h>

#include "base/fail.h"
#include "base/file.h"
#include "brdf/rgl_make.h"
#include "measure/reflection.h"
#include "weft/reflection.h"

enum { POINTS_MOST = 1 << 26 };

static void source_f(void *user, const float wo[3], int count, const float (*wi)[3], float (*f)[3]) {
    weft_reflection_eval(user, WEFT_PART_ALL, wo, count, wi, f);
}

/* Returns true if f of some pairs stays the same as both turn. */
static bool is_isotropic(const WeftReflection *reflection) {
    static const float ways[][3] = {
        {0.6f, 0.0f, 0.8f}, {0.64f, 0.48f, 0.6f}, {-0.28f, 0.0f, 0.96f}, {-0.48f, 0.36f, 0.8f}};
    enum { WAYS = sizeof ways / sizeof *ways, TURNS = 5 };
    bool same = true;
    for (int pair = 0; pair < WAYS * WAYS; pair++) {
        float first[3] = {0.0f};
        for (int turn = 0; turn < TURNS; turn++) {
            const float c = cosf(1.1f * (float)turn), s = sinf(1.1f * (float)turn), *o = ways[pair / WAYS],
                        *i = ways[pair % WAYS];
            const float wo[3] = {c * o[0] - s * o[1], s * o[0] + c * o[1], o[2]};
            const float wi[1][3] = {{c * i[0] - s * i[1], s * i[0] + c * i[1], i[2]}};
            float f[1][3];
            weft_reflection_eval(reflection, WEFT_PART_ALL, wo, 1, wi, f);
            for (int k = 0; k < 3; k++) {
                if (turn == 0) first[k] = f[0][k];
                same &= fabsf(f[0][k] - first[k]) <= 1e-3f * (fabsf(first[k]) + 1e-6f);
            }
        }
    }
    return same;
}

static WeftResult desc_check(const RglDesc *desc, bool isotropic, WeftError *error) {
    const char *name = "a .bsdf";
    if (desc->thetas < 2 || desc->thetas > RGL_SLICES_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it has %d polar angles, not 2 .. %d", desc->thetas,
                    RGL_SLICES_MOST);
    if (desc->phis < 3 || desc->phis > RGL_SLICES_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it has %d azimuths, not 3 .. %d", desc->phis,
                    RGL_SLICES_MOST);
    if (desc->side < 8 || desc->side > RGL_SIDE_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "its tables have sides of %d points, not 8 .. %d",
                    desc->side, RGL_SIDE_MOST);
    if (5LL * desc->thetas * (isotropic ? 1 : desc->phis) * desc->side * desc->side > POINTS_MOST)
        return fail(error, WEFT_MESSAGE_DESC, name, "it would have more than %d numbers", POINTS_MOST);
    return WEFT_OK;
}

static WeftResult file_write(const Rgl *rgl, const char *comment, const char *path, WeftError *error) {
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    if (rgl_write(rgl, comment, file.stream)) return output_commit(&file, error);
    output_discard(&file);
    return fail(error, WEFT_MESSAGE_FILE_WRITE, path, NULL);
}

WeftResult weft_reflection_write(const WeftReflection *reflection, const char *path, const WeftBsdfDesc *desc,
                                 WeftError *error) {
    const bool isotropic = is_isotropic(reflection);
    const RglDesc fine = {.thetas = desc->thetas ? desc->thetas : 32,
                          .phis = desc->phis ? desc->phis : 17,
                          .side = desc->side  ? desc->side
                                  : isotropic ? 96
                                              : 32,
                          .threads = desc->threads};
    const RglSource source = {.f = source_f, .user = (void *)(uintptr_t)reflection, .isotropic = isotropic};
    Rgl rgl = {0};
    const char *walk = reflection_walks(reflection);
    if (walk)
        return fail(error, WEFT_MESSAGE_DESC, walk,
                    "is an estimate by random walks; tabulate fibre, its mean");
    WeftResult result = desc_check(&fine, isotropic, error);
    if (result != WEFT_OK) return result;
    if (!rgl_make(&source, &fine, &rgl)) result = fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    if (result == WEFT_OK)
        result = file_write(&rgl, desc->comment && desc->comment[0] ? desc->comment : " ", path, error);
    rgl_free(&rgl);
    return result;
}
