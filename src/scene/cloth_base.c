#include "scene/cloth_base.h"

#include <math.h>

#include "shading/weave_light.h"

/* Rows of picks run up the cloth, v runs down it. */
static WeavePoint point_at(const WeftCloth *cloth, const float uv[2]) {
    const float x = uv[0] * cloth->per_uv[WEFT_WARP], y = -uv[1] * cloth->per_uv[WEFT_WEFT];
    const bool there = fabsf(x) < 1e6f && fabsf(y) < 1e6f; /* further out floats have no fractions */
    return weave_point(&cloth->weave, there ? x : 0.0f, there ? y : 0.0f);
}

bool cloth_is_gap(const WeftCloth *cloth, const float uv[2]) {
    return point_at(cloth, uv).height <= WEAVE_NONE;
}

void cloth_base(const WeftCloth *cloth, const float uv[2], float side, Stack *stack) {
    const Weave *m = &cloth->weave;
    WeavePoint point = point_at(cloth, uv);
    const Yarn yarn = weave_yarn(m, point);
    Lobe lobe = lobe_default(LOBE_YARN);
    const float numbers[LOBE_PARAMS_MAX] = {yarn.alpha,     yarn.slope_x, yarn.slope_y,     yarn.azimuth,
                                            yarn.roundness, yarn.crimp,   yarn.cross_crimp, yarn.share};
    float once[3], again[3];
    (void)side;
    for (int k = 0; k < LOBE_PARAMS_MAX; k++) lobe.params[k] = numbers[k];
    for (int c = 0; c < 3; c++) {
        const bool thread = point.height > WEAVE_NONE;
        once[c] = thread ? weave_once(m, point, c) : 0.0f;
        again[c] = thread ? weave_reflectance(m, point, c) : 0.0f;
    }
    stack_put_base(stack, &lobe, rgb(once[0], once[1], once[2]), rgb(again[0], again[1], again[2]));
}
