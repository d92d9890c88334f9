#include "measure/bsdf/weave_sum.h"

#include "shading/catalogue/registry.h"

WeaveSum weave_sum_of(const WeftCloth *cloth) {
    WeaveSum sum = {.bases = cloth ? 2 : 1};
    for (int t = 0; cloth && t < 2; t++) {
        sum.threads[t] = cloth_base_far(cloth, t == WEFT_WEFT);
        sum.woven[t] = cloth->far.woven[t];
    }
    return sum;
}

WeaveSum weave_sum_of_lobes(const WeaveBase threads[2]) {
    WeaveSum sum = {.bases = 2};
    for (int t = 0; t < 2; t++) {
        sum.threads[t] = threads[t];
        woven_prepare(woven_of(&threads[t].lobe), &sum.woven[t]);
    }
    return sum;
}

void weave_sum_see(const WeaveSum *self, int base, const Surface *surface, const Choices *choices, TableRef e, Dir o,
                   SeenStack *seen) {
    const WeaveBase *threads = &self->threads[base];
    stack_make(&seen->stack, surface, choices, e);
    if (self->bases > 1) {
        stack_put_base(&seen->stack, &threads->lobe, threads->single, threads->multiple);
        seen->stack.diffuse_prepared.woven = self->woven[base];
    }
    stack_see(&seen->stack, &o, &seen->view);
}

Slots weave_sum_slots(int base, Slots slots) {
    return base == 0 ? slots : slots_of(slots.diffuse, false, false, false, false);
}

/* Estimates the reflected part of the light on the cloth. */
static float brightness(const WeaveBase *threads) {
    return threads->lobe.params[WOVEN_SHARE] * (rgb_mean(threads->single) + rgb_mean(threads->multiple));
}

float weave_sum_first(const WeaveSum *self) {
    const float warp = brightness(&self->threads[0]), weft = brightness(&self->threads[1]);
    return warp / max(warp + weft, 1e-6f);
}
