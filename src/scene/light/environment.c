#include "scene/light/environment.h"

#include "base/pi.h"

#include <math.h>

enum { WIDTH = 512, HEIGHT = 256 };

static float smooth(float low, float high, float x) {
    float t = fminf(fmaxf((x - low) / (high - low), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* A soft-edged rectangle of light as seen from the middle of the room: azimuth and elevation of its centre,
 * half width and half height as slopes, radiance. */
typedef struct Softbox {
    float azimuth, elevation, half_width, half_height, radiance, warmth;
} Softbox;

static const Softbox softboxes[] = {
    {-0.85f, 0.80f, 0.60f, 0.50f, 4.2f, 0.04f}, /* key */
    {1.25f, 0.35f, 0.22f, 0.75f, 1.6f, -0.05f}, /* fill strip */
    {2.75f, 0.60f, 0.55f, 0.18f, 4.0f, 0.0f},   /* rim, behind */
};

static float softbox_cover(const Softbox *box, float x, float y, float z) {
    float sa = sinf(box->azimuth), ca = cosf(box->azimuth), se = sinf(box->elevation), ce = cosf(box->elevation);
    float cx = sa * ce, cy = se, cz = ca * ce; /* centre; azimuth 0 is +z, towards the viewer */
    float d = x * cx + y * cy + z * cz;
    if (d <= 0.0f) return 0.0f;
    float u = (x * ca - z * sa) / d, v = (-x * sa * se + y * ce - z * ca * se) / d;
    float edge = 0.08f;
    return (1.0f - smooth(box->half_width - edge, box->half_width + edge, fabsf(u))) *
           (1.0f - smooth(box->half_height - edge, box->half_height + edge, fabsf(v)));
}

WeftResult environment_studio(WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *p = out->pixels;
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++, p += 3) {
            float theta = ((float)row + 0.5f) / HEIGHT * PI_FLOAT;
            float phi = (((float)column + 0.5f) / WIDTH - 0.5f) * 2.0f * PI_FLOAT;
            float x = sinf(theta) * sinf(phi), y = cosf(theta), z = -sinf(theta) * cosf(phi);
            float room = 0.14f + 0.16f * smooth(-0.2f, 1.0f, y) + 0.10f * smooth(0.0f, 1.0f, -y);
            float c[3] = {room, room, room};
            for (size_t k = 0; k < sizeof softboxes / sizeof *softboxes; k++) {
                float light = softboxes[k].radiance * softbox_cover(&softboxes[k], x, y, z);
                c[0] += light * (1.0f + softboxes[k].warmth);
                c[1] += light;
                c[2] += light * (1.0f - softboxes[k].warmth);
            }
            p[0] = c[0], p[1] = c[1], p[2] = c[2];
        }
    return WEFT_OK;
}

bool environment_in_parts(const Environment *e) {
    return e->ambient < 1.0f || e->ambient > 1.0f || e->reflection < 1.0f || e->reflection > 1.0f;
}

void environment_give_way(WeftScene *scene) {
    const float fill = 0.4f;
    bool lit = scene->light_count > 0;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Input *inputs = scene->materials[scene->meshes[m].material].inputs;
        const float *e = inputs[INPUT_emission].value;
        /* brighter than a surface in the studio can be: a light source, not a glowing sign */
        lit = lit || fmaxf(e[0], fmaxf(e[1], e[2])) * inputs[INPUT_emission_strength].value[0] > 4.0f;
    }
    float *p = scene->environment.image.pixels;
    if (!lit || scene->environment.kind != ENVIRONMENT_STUDIO) return;
    for (int k = 0; k < 3 * WIDTH * HEIGHT; k++) p[k] *= fill;
}
