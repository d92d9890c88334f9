#include "trace/path/slot_light.h"

#include <string.h>

void slot_light_begin(LightBySlot *light) {
    memset(light->direct, 0, sizeof light->direct);
    memset(light->onward, 0, sizeof light->onward);
}

void slot_light_add(LightBySlot *light, const Chunk *chunk, LightGroup group, int vertex) {
    const uint32_t id = chunk->id[vertex];
    for (int slot = 0; slot < LIT_SLOTS; slot++)
        for (int c = 0; c < 3; c++)
            light->direct[slot][c][id] += chunk->contribution[c][vertex] * light->share[group][slot][c][vertex];
}

void slot_light_note(LightBySlot *light, const PathRadiance *radiance) {
    for (int c = 0; c < 3; c++) memcpy(light->before[c], radiance->rgba[c], sizeof light->before[c]);
}

void slot_light_end(LightBySlot *light, const PathRadiance *radiance) {
    for (int slot = 0; slot < LIT_SLOTS; slot++)
        for (int c = 0; c < 3; c++)
            for (int id = 0; id < PATHS_MAX; id++)
                light->direct[slot][c][id] +=
                    light->onward[slot][c][id] * (radiance->rgba[c][id] - light->before[c][id]);
}
