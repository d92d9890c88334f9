/* vertex_run.c - the module of bench_vertex: this build's stacks, as the path tracer calls them */
#include "vertex.h"

#include "shading/albedo.h"
#include "shading/kind.h"

#define DEFAULT_SCALAR(d)                                                 d
#define DEFAULT_COLOR(d)                                                  rgb_grey(d)
#define DEFAULT_NORMAL(d)                                                 dir(0.0f, 0.0f, 1.0f)
#define DEFAULT_DIRECTION(d)                                              dir(1.0f, 0.0f, 0.0f)
#define DEFAULT_ANGLE(d)                                                  d
#define DEFAULT_OF(kind, name, def, low, high, hard_low, hard_high, help) s.name = DEFAULT_##kind(def);

static Surface surface_of(const VertexArrays *a, int k, int material) {
    Surface s;
    SURFACE_INPUTS(DEFAULT_OF)
    s.base_color = rgb(a->base[0][k], a->base[1][k], a->base[2][k]);
    s.roughness = a->roughness[k];
    if (material == 1) return s;
    s.sheen_color = rgb(a->sheen[0][k], a->sheen[1][k], a->sheen[2][k]);
    s.sheen_roughness = a->sheen_roughness[k];
    return s;
}

static TableRef table(void) {
    static AlbedoTable made;
    static int is_made;
    Lobe lobe = lobe_default(LOBE_CHARLIE_CONTY_KULLA);
    if (!is_made) albedo_table_fill(&made, &lobe, 0.005f, 1.0f, 1);
    is_made = 1;
    return albedo_table_ref(&made);
}

static void run(VertexArrays *a, int material, int once, bool known) {
    const Choices choices = choices_unmade();
    const TableRef e = table();
    static Stack m;
    static StackView w;
    Surface s = surface_of(a, 0, material);
    stack_make(&m, &s, &choices, e);
    const StackKind *kind = stack_kind(known ? &m : NULL, &choices);
    for (int k = 0; k < VERTEX_COUNT; k++) {
        if (!once) {
            s = surface_of(a, k, material);
            kind->make(&m, &s, &choices, e);
        }
        const Dir o = dir(a->o[0][k], a->o[1][k], a->o[2][k]);
        const Dir light = dir(a->light[0][k], a->light[1][k], a->light[2][k]);
        StackValue x, y;
        Dir i;
        kind->see(&m, &o, &w);
        kind->eval(&m, &w, &light, 0, &x);
        kind->sample(&m, &w, a->u[k], a->v[k], &i);
        kind->eval(&m, &w, &i, 0, &y);
        const float all[] = {x.f_cos.r, x.f_cos.g, x.f_cos.b, x.pdf,     i.x,  i.y,
                             i.z,       y.f_cos.r, y.f_cos.g, y.f_cos.b, y.pdf};
        for (int c = 0; c < 11; c++) a->out[c][k] = all[c];
    }
}

#define EXPORTED __attribute__((visibility("default")))
EXPORTED void vertex_run(VertexArrays *a, int material, int once) { run(a, material, once, false); }
EXPORTED void vertex_run_kind(VertexArrays *a, int material, int once) { run(a, material, once, true); }
