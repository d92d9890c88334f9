#include "view/files/survey.h"

#include <math.h>
#include <stdlib.h>

enum { ROWS = 40 }; /* of rays */

float *survey_take(const WeftPick *pick, const WeftScene *scene, const char *camera, float aspect) {
    int count = weft_scene_info(scene).material_count, columns = (int)lroundf(ROWS * aspect);
    columns = columns < 1 ? 1 : columns > 4 * ROWS ? 4 * ROWS : columns;
    float *coverage = calloc((size_t)count + 1, sizeof *coverage);
    if (!coverage) return NULL;
    for (int k = 0; k < count; k++) coverage[k] = weft_scene_material_used(scene, k) ? 0.0f : -1.0f;
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < columns; x++) {
            WeftPicked at;
            if (!weft_pick_at(pick, camera, columns, ROWS, (float)x + 0.5f, (float)y + 0.5f, &at)) continue;
            if (at.material >= 0 && at.material < count) coverage[at.material] += 1.0f / (float)(ROWS * columns);
        }
    return coverage;
}

int survey_largest(const float *coverage, int count, const char *of) {
    int largest = -1;
    for (int k = 0; k < count; k++)
        if (coverage[k] > (largest < 0 ? 0.0f : coverage[largest]) && (!of || of[k])) largest = k;
    return largest;
}
