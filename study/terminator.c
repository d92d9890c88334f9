/* terminator - prints how far coarse meshes are off where light grazes them, and shows it
 *
 *   study_terminator [SHEET.png]
 *
 * A matt ball of 12 rings under a sun from the side, whose terminator goes down its middle, is rendered with light
 * that meets its triangles, and with light that meets the smooth surface that their normals describe, as docs/render.md
 * has it. A ball of 192 rings is the reference. relMSE and the greatest difference are those of pixels within 0.9 of its
 * outline. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "trace/scenes.h"

enum { SIDE = 320, COARSE = 12, FINE = 192, SAMPLES = 64 };

static WeftImage ball(uint32_t rings, int no_lift) {
    WeftScene *scene = test_grazed_ball(rings, 0.8f, 0.02f);
    const WeftRenderDesc desc = {.width = SIDE, .height = SIDE, .camera = "0,1.5,9.9;0,0,0;13", .no_lift = no_lift};
    WeftImage image = test_render(scene, desc, SAMPLES);
    weft_scene_free(scene);
    return image;
}

static bool inside(int x, int y) {
    double half = 10.0129 * tan(6.5 * RADIANS) / 1.005, px = (x + 0.5) / (SIDE / 2.0) - 1.0,
           py = (y + 0.5) / (SIDE / 2.0) - 1.0;
    return (px * px + py * py) * half * half < 0.81;
}

static void print_row(const char *name, const WeftImage *image, const WeftImage *reference) {
    double sum = 0.0, most = 0.0;
    int count = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            if (!inside(x, y)) continue;
            double a = (double)((float *)image->pixels)[4 * (y * SIDE + x)],
                   b = (double)((float *)reference->pixels)[4 * (y * SIDE + x)];
            sum += (a - b) * (a - b) / (b * b + 1e-2), count++;
            most = fmax(most, fabs(a - b));
        }
    printf("%-28s relMSE %.2e, greatest difference %.3f\n", name, sum / count, most);
}

int main(int count, char **arguments) {
    static const char *const names[] = {"on the triangles", "on the smooth surface", "192 rings, the reference"};
    WeftImage images[] = {ball(COARSE, 1), ball(COARSE, 0), ball(FINE, 0)}, shown[3], sheet;
    WeftPanel panels[3] = {0};
    int code = 0;
    for (int k = 0; k < 3; k++) {
        if (k < 2) print_row(names[k], &images[k], &images[2]);
        code |= weft_image_tonemap(&images[k], WEFT_TONEMAP_NONE, 0.0f, &shown[k], NULL) != WEFT_OK;
        panels[k] = (WeftPanel){.image = &shown[k], .title = names[k]};
    }
    if (count > 1 && !code) {
        const WeftSheetDesc desc = {.panels = panels, .count = 3, .columns = 3};
        code = weft_sheet_compose(&desc, &sheet, NULL) != WEFT_OK ||
               weft_image_write(arguments[1], &sheet, NULL) != WEFT_OK;
    }
    return code;
}
