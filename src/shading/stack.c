#include "shading/stack.h"

#include "shading/terms/f_schlick.h"

static Dir to_coat(const Stack *stack, Dir w) {
    return dir(dir_dot(w, stack->coat_x), dir_dot(w, stack->coat_y), dir_dot(w, stack->coat_z));
}

static Dir from_coat(const Stack *s, Dir w) {
    return dir(w.x * s->coat_x.x + w.y * s->coat_y.x + w.z * s->coat_z.x,
               w.x * s->coat_x.y + w.y * s->coat_y.y + w.z * s->coat_z.y,
               w.x * s->coat_x.z + w.y * s->coat_y.z + w.z * s->coat_z.z);
}

static void add_lobe(const Stack *stack, const StackLobe *k, Angles a, StackValue *value) {
    if (a.o.z <= 0.0f || a.i.z <= 0.0f) return;
    LobeValue lobe = lobe_value(&k->lobe, a);
    value->pdf += k->pick * lobe.pdf;
    float e = lobe.f * a.i.z, s = lobe.s;
    if (k->lobe.id == LOBE_LAMBERT)
        e *= 1.0f - mix(stack->under_f0, stack->under_f90, schlick_s(min(a.d, min(a.o.z, a.i.z))));
    value->f_cos.r += e * mix(k->f0.r, k->f90.r, s);
    value->f_cos.g += e * mix(k->f0.g, k->f90.g, s);
    value->f_cos.b += e * mix(k->f0.b, k->f90.b, s);
}

StackValue stack_eval(const Stack *stack, Dir o, Dir i) {
    StackValue value = {0};
    if (o.z <= 0.0f || i.z <= 0.0f) return value; /* whatever the coat's own normal may see */
    Angles base = angles_between(o, i);
    for (int k = 0; k < stack->count; k++) {
        const StackLobe *lobe = &stack->lobes[k];
        add_lobe(stack, lobe, lobe->coat ? angles_between(to_coat(stack, o), to_coat(stack, i)) : base,
                 &value);
    }
    return value;
}

Dir stack_sample(const Stack *stack, Dir o, float u, float v) {
    int k = 0;
    float begin = 0.0f;
    while (k + 1 < stack->count && u >= begin + stack->lobes[k].pick) begin += stack->lobes[k++].pick;
    const StackLobe *lobe = &stack->lobes[k];
    u = min(max((u - begin) / max(lobe->pick, 1e-12f), 0.0f),
            0x1.fffffep-1f); /* the rest of u is as good as new */
    if (!lobe->coat) return lobe_sample(&lobe->lobe, o, u, v);
    Dir oc = to_coat(stack, o), ic = dir(0.0f, 0.0f, -1.0f);
    if (oc.z > 0.0f) ic = lobe_sample(&lobe->lobe, oc, u, v);
    return ic.z > 0.0f ? from_coat(stack, ic) : dir(0.0f, 0.0f, -1.0f);
}
