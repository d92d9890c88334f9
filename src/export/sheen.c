#include "export/sheen.h"

void sheen_table_fill(const Surface *surface, const Choices *choices, AlbedoTable *out) {
    enum { INPUTS = 4 };
    Stack m;
    Surface s = *surface;
    float low = 0.0f, high = 0.0f;
    s.sheen_color = (Rgb){0.5f, 0.5f, 0.5f};
    s.sheen = 1.0f;
    stack_make(&m, &s, choices, (TableRef){.kind = TABLE_NONE});
    Lobe lobe = m.sheen.lobe;
    for (int ends = 0; ends < 1 << INPUTS; ends++) {
        s.sheen_roughness = s.fuzz_roughness = (float)(ends & 1);
        s.roughness = (float)(ends >> 1 & 1);
        s.anisotropy = (float)(ends >> 2 & 1);
        s.sheen_beta = ends >> 3 & 1 ? surface->sheen_beta : 0.0f;
        stack_make(&m, &s, choices, (TableRef){.kind = TABLE_NONE});
        low = ends ? min(low, m.albedo_coord) : m.albedo_coord;
        high = ends ? max(high, m.albedo_coord) : m.albedo_coord;
    }
    albedo_table_fill(out, &lobe, low, high, 0);
}
