/* The panel that plots the material's reflection and shows the parts of a pixel's light. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/pi.h"
#include "view/panels/panels.h"
#include "view/render/cloth_reflection.h"
#include "view/state/edit.h"
#include "view/state/frame_requests.h"
#include "view/state/opening.h"
#include "weft/reflection.h"

enum { SLICE = 181, ANGLES = 21, RINGS = 24, SECTORS = 48, PAIRS = 64, PARTS = 4 };

static const WeftPart parts[PARTS] = {WEFT_PART_ALL, WEFT_PART_DIFFUSE, WEFT_PART_SPECULAR, WEFT_PART_SHEEN};
static const unsigned colors[PARTS] = {0xFFE8E8E8u, 0xFF5EA8E8u, 0xFFE0A858u,
                                       0xFF68C878u}; /* distinct with colour blindness too */

typedef struct Inspection {
    WeftMaterial of;
    bool known, valid; /* `of` is set; `reflection` is that of `of` */
    WeftReflection *reflection;
    ClothReflection *woven; /* of `of`, under way; NULL: none */
    float angle;            /* of wo from the normal, degrees */
    bool cosine;            /* f cos rather than f */
    bool logarithmic;
    float slice[PARTS][SLICE]; /* luminance of f in the plane of wo, from -90 to 90 degrees */
    float lobe[RINGS + 1][SECTORS];
    float lobe_most;
    float albedo[ANGLES][3];
    int angles; /* for which E is computed */
    float reciprocity;
    float sliced; /* angle of slice and lobe */
} Inspection;

void inspection_free(Inspection *self) {
    if (!self) return;
    weft_reflection_free(cloth_reflection_end(self->woven));
    weft_reflection_free(self->reflection);
    free(self);
}

static float luminance(const float c[3]) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

static void direction(float theta, float phi, float w[3]) {
    w[0] = sinf(theta) * cosf(phi), w[1] = sinf(theta) * sinf(phi), w[2] = fmaxf(cosf(theta), 1e-4f);
}

static void make_slice(Inspection *self) {
    float wo[3], wi[SLICE][3], f[SLICE][3];
    direction(self->angle * (float)RADIANS, PI_FLOAT, wo);
    for (int k = 0; k < SLICE; k++) direction(((float)k - 90.0f) * (float)RADIANS * 0.999f, 0.0f, wi[k]);
    for (int p = 0; p < PARTS; p++) {
        weft_reflection_eval(self->reflection, (int)parts[p], wo, SLICE, (const float(*)[3])wi, f);
        for (int k = 0; k < SLICE; k++) self->slice[p][k] = luminance(f[k]) * (self->cosine ? wi[k][2] : 1.0f);
    }
}

static void make_lobe(Inspection *self) {
    float wo[3], wi[SECTORS][3], f[SECTORS][3];
    direction(self->angle * (float)RADIANS, PI_FLOAT, wo);
    self->lobe_most = 1e-6f;
    for (int r = 0; r <= RINGS; r++) {
        for (int s = 0; s < SECTORS; s++)
            direction(1.5607f * (float)r / RINGS, 2.0f * PI_FLOAT * (float)s / SECTORS, wi[s]);
        weft_reflection_eval(self->reflection, WEFT_PART_ALL, wo, SECTORS, (const float(*)[3])wi, f);
        for (int s = 0; s < SECTORS; s++) {
            self->lobe[r][s] = luminance(f[s]) * (self->cosine ? wi[s][2] : 1.0f);
            self->lobe_most = fmaxf(self->lobe_most, self->lobe[r][s]);
        }
    }
}

/* Measures the greatest |f(wo, wi) - f(wi, wo)| over the larger of the two, over evenly distributed directions. */
static void measure_reciprocity(Inspection *self) {
    self->reciprocity = 0.0f;
    for (int k = 0; k < PAIRS; k++) {
        float a[1][3], b[1][3], f[1][3], g[1][3], u = ((float)k + 0.5f) / PAIRS;
        direction(1.5f * u, 2.4f * (float)k, a[0]);
        direction(1.5f * fmodf(u * 31.0f, 1.0f), 1.7f * (float)k, b[0]);
        weft_reflection_eval(self->reflection, WEFT_PART_ALL, a[0], 1, (const float(*)[3])b, f);
        weft_reflection_eval(self->reflection, WEFT_PART_ALL, b[0], 1, (const float(*)[3])a, g);
        float x = luminance(f[0]), y = luminance(g[0]);
        self->reciprocity = fmaxf(self->reciprocity, fabsf(x - y) / fmaxf(fmaxf(x, y), 1e-3f));
    }
}

static float cosine_of(int k) { return fmaxf(1.0f - (float)k / (ANGLES - 1), 0.01f); }

/* Takes a reflection, or NULL, for the material. */
static void take(Inspection *self, WeftReflection *reflection) {
    weft_reflection_free(self->reflection);
    self->reflection = reflection;
    self->valid = reflection != NULL;
    self->angles = 0;
    self->sliced = -1.0f;
    if (self->valid) measure_reciprocity(self);
}

/* Begins anew for a material; cloth: the one that it is woven as, or NULL. */
static void inspect(Inspection *self, const WeftMaterial *material, const FactCloth *cloth, Window *window) {
    WeftReflection *reflection = NULL;
    self->of = *material;
    self->known = true;
    self->woven = cloth ? cloth_reflection_start(material, cloth, window) : NULL;
    if (!cloth) weft_reflection_create(material, &reflection, NULL);
    take(self, reflection);
}

/* Measures a part of what is left, so that the window does not wait. */
static void refresh(Inspection *self, const Viewer *v) {
    const WeftMaterial *material = scene_state_material(&v->edit->state, v->edit->material);
    const Facts *facts = &v->shown->facts;
    const bool woven = material->cloth > 0 && material->cloth <= facts->cloth_count;
    if (self->woven && cloth_reflection_done(self->woven)) {
        take(self, cloth_reflection_end(self->woven));
        self->woven = NULL;
    }
    const bool other = !self->known || memcmp((const char *)&self->of, (const char *)material, sizeof *material) != 0;
    if (other && !self->woven) inspect(self, material, woven ? &facts->cloths[material->cloth - 1] : NULL, v->window);
    if (!self->valid) return;
    if (self->sliced < self->angle || self->sliced > self->angle) {
        make_slice(self);
        make_lobe(self);
        self->sliced = self->angle;
    }
    for (int k = 0; k < 2 && self->angles < ANGLES; k++, self->angles++)
        weft_reflection_albedo(self->reflection, WEFT_PART_ALL, cosine_of(self->angles), self->albedo[self->angles]);
}

static const unsigned line_color = 0xFF4A4C50u, text_color = 0xFF9A9C9Fu, ground = 0xFF17181Au;

static float radius_of(const Inspection *self, float f, float most) {
    if (!self->logarithmic) return f / most;
    return fmaxf(1.0f + log10f(fmaxf(f / most, 1e-6f)) / 3.0f, 0.0f); /* three decades */
}

/* Draws words in the colours of their curves, from the top right of a box downwards. */
static void draw_legend(const UiBox *box, const char *const *words, const unsigned *of, int count) {
    for (int k = 0; k < count; k++)
        ui_label(box->x + box->width - ui_text_width(words[k]) - 6.0f, box->y + 4.0f + 15.0f * ui_scale() * (float)k,
                 of[k], words[k]);
}

static void draw_slice(Inspection *self) {
    static const char *const words[PARTS] = {"all", "diffuse", "specular", "sheen"};
    UiBox box;
    float most = 1e-6f, xy[2 * SLICE];
    bool over = ui_canvas("##slice", 0.0f, 150.0f * ui_scale(), &box);
    ui_tip("Light from the grey line, and where it goes: f, or f times the cosine, in the plane of incidence.");
    (void)over;
    for (int p = 0; p < PARTS; p++)
        for (int k = 0; k < SLICE; k++) most = fmaxf(most, self->slice[p][k]);
    float r = fminf(0.5f * box.width, box.height) - 14.0f, x0 = box.x + 0.5f * box.width,
          y0 = box.y + box.height - 8.0f;
    ui_fill(box, ground);
    ui_clip(&box);
    for (int k = 1; k <= 2; k++) {
        for (int j = 0; j <= 36; j++) {
            float a = PI_FLOAT * (float)j / 36.0f, s = 0.5f * (float)k * r;
            xy[2 * j] = x0 - s * cosf(a), xy[2 * j + 1] = y0 - s * sinf(a);
        }
        ui_curve(xy, 37, line_color, 1.0f);
    }
    ui_line(x0 - r, y0, x0 + r, y0, line_color, 1.0f);
    float t = self->angle * (float)RADIANS;
    ui_line(x0, y0, x0 - r * sinf(t), y0 - r * cosf(t), text_color, 1.5f);
    for (int p = PARTS - 1; p >= 0; p--) {
        for (int k = 0; k < SLICE; k++) {
            float a = ((float)k - 90.0f) * (float)RADIANS, s = r * radius_of(self, self->slice[p][k], most);
            xy[2 * k] = x0 + s * sinf(a), xy[2 * k + 1] = y0 - s * cosf(a);
        }
        ui_curve(xy, SLICE, colors[p], p ? 1.2f : 2.0f);
    }
    char text[48];
    snprintf(text, sizeof text, "ends at %.3g /sr", (double)most);
    ui_label(box.x + 6.0f, box.y + 4.0f, text_color, text);
    draw_legend(&box, words, colors, PARTS);
    ui_clip(NULL);
}

typedef struct Facet {
    float xy[8], depth, bright;
} Facet;

static int by_depth(const void *a, const void *b) {
    float x = ((const Facet *)a)->depth, y = ((const Facet *)b)->depth;
    return (x > y) - (x < y);
}

/* Projects a point of the lobe, seen from the side and slightly from above. */
static void lobe_point(const Inspection *self, int ring, int sector, float size, float out[3]) {
    float w[3], s = size * radius_of(self, self->lobe[ring][sector % SECTORS], self->lobe_most);
    const float azimuth = 0.6f, tilt = 0.45f;
    direction(1.5607f * (float)ring / RINGS, 2.0f * PI_FLOAT * (float)sector / SECTORS, w);
    float x = w[0] * cosf(azimuth) - w[1] * sinf(azimuth), y = w[0] * sinf(azimuth) + w[1] * cosf(azimuth);
    out[0] = s * x;
    out[1] = s * (w[2] * cosf(tilt) + y * sinf(tilt));
    out[2] = s * (w[2] * sinf(tilt) - y * cosf(tilt)); /* towards the eye */
}

static void draw_lobe(Inspection *self) {
    static Facet facets[RINGS * SECTORS];
    UiBox box;
    ui_canvas("##lobe", 0.0f, 150.0f * ui_scale(), &box);
    ui_tip("The same in all directions: the lobe as a body whose radius is f.");
    float size = fminf(0.5f * box.width, box.height) * 0.66f, x0 = box.x + 0.5f * box.width,
          y0 = box.y + 0.7f * box.height;
    int count = 0;
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SECTORS; s++) {
            Facet *f = &facets[count++];
            f->depth = 0.0f;
            for (int c = 0; c < 4; c++) {
                float p[3];
                lobe_point(self, r + (c == 1 || c == 2), s + (c >= 2), size, p);
                f->xy[2 * c] = x0 + p[0], f->xy[2 * c + 1] = y0 - p[1];
                f->depth += p[2];
            }
            f->bright = self->lobe[r][s] / self->lobe_most;
        }
    qsort(facets, (size_t)count, sizeof *facets, by_depth);
    ui_fill(box, ground);
    ui_clip(&box);
    for (int k = 0; k < count; k++) {
        const Facet *f = &facets[k];
        unsigned level = (unsigned)(70.0f + 150.0f * sqrtf(fminf(f->bright, 1.0f)));
        unsigned color = 0xFF000000u | (level / 2u << 16) | (level * 3u / 4u << 8) | level;
        const float a[6] = {f->xy[0], f->xy[1], f->xy[2], f->xy[3], f->xy[4], f->xy[5]};
        const float b[6] = {f->xy[0], f->xy[1], f->xy[4], f->xy[5], f->xy[6], f->xy[7]};
        ui_triangle(a, color);
        ui_triangle(b, color);
    }
    ui_clip(NULL);
}

/* Returns twice the integral of E mu over mu, the albedo under uniform light. */
static float mean_albedo(const Inspection *self, int channel) {
    float sum = 0.0f;
    for (int k = 0; k + 1 < ANGLES; k++) {
        float a = cosine_of(k), b = cosine_of(k + 1);
        sum += (a - b) * (self->albedo[k][channel] * a + self->albedo[k + 1][channel] * b);
    }
    return sum;
}

static void draw_albedo(Inspection *self) {
    static const char *const words[3] = {"red", "green", "blue"};
    static const unsigned channel_colors[3] = {0xFF6060F0u, 0xFF60D070u, 0xFFF08860u};
    UiBox box;
    float xy[2 * ANGLES], most = 1.1f;
    ui_canvas("##albedo", 0.0f, 110.0f * ui_scale(), &box);
    ui_tip("E, the directional albedo: how much of the light from an angle comes back, red, green and blue. "
           "Above the "
           "line at 1 the material gains energy.");
    for (int k = 0; k < self->angles; k++)
        for (int c = 0; c < 3; c++) most = fmaxf(most, 1.05f * self->albedo[k][c]);
    ui_fill(box, ground);
    ui_clip(&box);
    float y1 = box.y + box.height * (1.0f - 1.0f / most);
    ui_line(box.x, y1, box.x + box.width, y1, line_color, 1.0f);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < self->angles; k++) {
            xy[2 * k] = box.x + box.width * (float)k / (ANGLES - 1);
            xy[2 * k + 1] = box.y + box.height * (1.0f - self->albedo[k][c] / most);
        }
        if (self->angles > 1) ui_curve(xy, self->angles, channel_colors[c], 1.6f);
    }
    ui_label(box.x + 6.0f, y1 + 1.0f, text_color, "1");
    draw_legend(&box, words, channel_colors, 3);
    ui_clip(NULL);
    ui_dim("E over the angle of the light: left head on, right grazing");
}

static void draw_passport(const Inspection *self) {
    char text[320];
    float most = 0.0f, at = 0.0f;
    if (self->angles < ANGLES) {
        ui_dim("measuring ...\n\n\n");
        return;
    }
    for (int k = 0; k < ANGLES; k++)
        for (int c = 0; c < 3; c++)
            if (self->albedo[k][c] > most) most = self->albedo[k][c], at = cosine_of(k);
    snprintf(text, sizeof text,
             "furnace: %.3f  %.3f  %.3f of even light comes back\nE at most %.3f, at cosine %.2f%s\n%s to %.1g",
             (double)mean_albedo(self, 0), (double)mean_albedo(self, 1), (double)mean_albedo(self, 2), (double)most,
             (double)at, most > 1.01f ? ": it gains energy" : "",
             self->reciprocity < 0.01f ? "reciprocal" : "not reciprocal:", (double)self->reciprocity);
    if (most > 1.01f)
        ui_warning(text);
    else
        ui_text(text);
}

static void draw_probe(const Viewer *v) {
    char text[512];
    if (!v->requests->has_probe) {
        ui_dim("Choose the tool Probe (P) and click on the picture.\n\n\n\n\n");
        return;
    }
    const Probe *p = &v->requests->probe;
    const float(*c)[3] = p->value;
    snprintf(text, sizeof text,
             "%s\nvalue     %.4f %.4f %.4f\ndiffuse   %.4f %.4f %.4f\nspecular  %.4f %.4f %.4f\nsheen     %.4f "
             "%.4f "
             "%.4f\nbase      %.3f %.3f %.3f\nroughness %.3f   normal %.3f %.3f %.3f\nuv %.4f %.4f   %.3f m away",
             p->material >= 0 && p->material < v->shown->facts.info.material_count
                 ? v->shown->facts.materials[p->material]
                 : "",
             (double)c[WEFT_PART_ALL][0], (double)c[WEFT_PART_ALL][1], (double)c[WEFT_PART_ALL][2],
             (double)c[WEFT_PART_DIFFUSE][0], (double)c[WEFT_PART_DIFFUSE][1], (double)c[WEFT_PART_DIFFUSE][2],
             (double)c[WEFT_PART_SPECULAR][0], (double)c[WEFT_PART_SPECULAR][1], (double)c[WEFT_PART_SPECULAR][2],
             (double)c[WEFT_PART_SHEEN][0], (double)c[WEFT_PART_SHEEN][1], (double)c[WEFT_PART_SHEEN][2],
             (double)c[WEFT_PART_BASE_COLOR][0], (double)c[WEFT_PART_BASE_COLOR][1], (double)c[WEFT_PART_BASE_COLOR][2],
             (double)c[WEFT_PART_ROUGHNESS][0], (double)(2.0f * c[WEFT_PART_NORMAL][0] - 1.0f),
             (double)(2.0f * c[WEFT_PART_NORMAL][1] - 1.0f), (double)(2.0f * c[WEFT_PART_NORMAL][2] - 1.0f),
             (double)p->texcoord[0], (double)p->texcoord[1], (double)p->distance);
    ui_text(text);
}

void inspect_panel(Viewer *v) {
    static const UiRange angles = {0.0f, 89.0f, 45.0f, "deg", false};
    if (!v->inspection) {
        v->inspection = calloc(1, sizeof *v->inspection);
        if (!v->inspection) return;
        v->inspection->angle = 45.0f;
    }
    Inspection *self = v->inspection;
    if (v->edit->material >= v->edit->state.material_count) return;
    refresh(self, v);
    if (ui_section("Lobes", true)) {
        ui_slider("light from", &angles, &self->angle);
        ui_tip("The angle between light and normal.");
        self->angle = fminf(fmaxf(self->angle, 0.0f), 89.9f);
        bool anew = ui_checkbox("times the cosine", &self->cosine);
        ui_tip("What a surface shows, rather than what it is.");
        ui_same_line();
        ui_checkbox("logarithmic", &self->logarithmic);
        ui_tip("Three decades.");
        if (anew) self->sliced = -1.0f;
        if (self->woven) ui_dim("weaving ...");
        if (self->valid) {
            draw_slice(self);
            draw_lobe(self);
        }
    }
    if (ui_section("Energy", true)) {
        draw_albedo(self);
        draw_passport(self);
        ui_dim(self->of.cloth ? "Of the whole cloth seen from afar, both threads together, without maps."
                              : "Of the numbers of this material, without its maps.");
    }
    if (ui_section("Pixel", true)) draw_probe(v);
}

bool inspection_busy(const Inspection *self) { return self && (self->woven || (self->valid && self->angles < ANGLES)); }

bool inspection_furnace(const Inspection *self, float share[3]) {
    if (!self || !self->valid || inspection_busy(self)) return false;
    for (int c = 0; c < 3; c++) share[c] = mean_albedo(self, c);
    return true;
}
