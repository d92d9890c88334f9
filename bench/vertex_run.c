/* vertex_run.c - the module of bench_vertex: this build's stacks, as the path tracer calls them */
#include "vertex.h"

#include <string.h>

#include "shading/catalogue/albedo.h"
#include "shading/kinds/kind.h"

#define DEFAULT_SCALAR(d)    d
#define DEFAULT_COLOR(d)     rgb_grey(d)
#define DEFAULT_NORMAL(d)    dir(0.0f, 0.0f, 1.0f)
#define DEFAULT_DIRECTION(d) dir(1.0f, 0.0f, 0.0f)
#define DEFAULT_ANGLE(d)     d
#define DEFAULT_OF(kind, name, label, initial, low, high, hard_low, hard_high, role, help)                             \
    s.name = DEFAULT_##kind(initial);

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

static void put(VertexArrays *a, int k, int at, const StackValue *x) {
    const float all[] = {x->f_cos.r, x->f_cos.g, x->f_cos.b, x->pdf};
    for (int c = 0; c < 4; c++) a->out[at + c][k] = all[c];
}

#define EXPORTED __attribute__((visibility("default")))
EXPORTED void vertex_run(VertexArrays *a, int material, int once) {
    const Choices choices = choices_unmade();
    const TableRef e = table();
    static Stack m;
    static StackView w;
    Surface s = surface_of(a, 0, material);
    stack_make(&m, &s, &choices, e);
    for (int k = 0; k < VERTEX_COUNT; k++) {
        if (!once) {
            s = surface_of(a, k, material);
            stack_make(&m, &s, &choices, e);
        }
        const Dir o = dir(a->o[0][k], a->o[1][k], a->o[2][k]);
        const Dir light = dir(a->light[0][k], a->light[1][k], a->light[2][k]);
        StackValue x;
        Dir i;
        stack_see(&m, &o, &w);
        stack_eval(&m, &w, &light, 0, &x);
        put(a, k, 0, &x);
        stack_sample(&m, &w, a->u[k], a->v[k], &i);
        a->out[4][k] = i.x, a->out[5][k] = i.y, a->out[6][k] = i.z;
        stack_eval(&m, &w, &i, 0, &x);
        put(a, k, 7, &x);
    }
}

/* Shades by the kind of the material, whose surfaces are rows already. */
EXPORTED void vertex_run_kind(VertexArrays *a, int material, int once) {
    static KindVertices rows[VERTEX_MATERIALS][2];
    static bool filled[VERTEX_MATERIALS][2];
    KindVertices *v = &rows[material][once];
    const Choices choices = choices_unmade();
    const TableRef e = table();
    Stack m;
    for (int k = 0; !filled[material][once] && k < VERTEX_COUNT; k++) {
        Surface s = surface_of(a, once ? 0 : k, material);
        surface_to_row(&v->surface, (size_t)k, &s);
    }
    filled[material][once] = true;
    Surface s = surface_of_row(&v->surface, 0);
    stack_make(&m, &s, &choices, e);
    for (int c = 0; c < 3; c++) {
        memcpy(v->o[c], a->o[c], sizeof a->o[c]);
        memcpy(v->i[0][c], a->light[c], sizeof a->light[c]);
    }
    memcpy(v->u, a->u, sizeof a->u);
    memcpy(v->v, a->v, sizeof a->v);
    kind_shade(stack_kind(&m, &choices), v, e, (const bool[KIND_LIGHTS]){true}, VERTEX_COUNT);
    for (int c = 0; c < 3; c++) {
        memcpy(a->out[c], v->f[0][c], sizeof a->out[c]);
        memcpy(a->out[4 + c], v->i[KIND_DRAWN][c], sizeof a->out[c]);
        memcpy(a->out[7 + c], v->f[KIND_DRAWN][c], sizeof a->out[c]);
    }
    memcpy(a->out[3], v->pdf[0], sizeof a->out[3]);
    memcpy(a->out[10], v->pdf[KIND_DRAWN], sizeof a->out[10]);
}
