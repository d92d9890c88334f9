/* lobe.c - the public face of the registry */
#include "base/fail.h"
#include "base/number.h"
#include "shading/catalogue/albedo.h"
#include "shading/lobes/fibre.h"
#include "shading/material/choice.h"

bool lobe_of(const WeftLobe *public_lobe, Lobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(public_lobe->lobe);
    if (!info) return false;
    *lobe = lobe_default(public_lobe->lobe);
    for (int k = 0; k < info->param_count; k++) lobe_set(lobe, k, public_lobe->params[k]);
    return true;
}

/* Returns true if the lobe has that parameter. Sets *set to true if its value differs from `neutral`. */
static bool has_param(const Lobe *lobe, const char *name, float neutral, bool *set) {
    int k = weft_lobe_param_find(lobe->id, name);
    if (k >= 0) *set |= fabsf(lobe->params[k] - neutral) > 0.0f;
    return k >= 0;
}

bool lobe_depends_on_azimuth(const Lobe *lobe) {
    bool set = false, any = has_param(lobe, "tilt", 0.0f, &set);
    any |= has_param(lobe, "anisotropy", 0.0f, &set);
    any |= has_param(lobe, "stretch", 1.0f, &set);
    return weft_lobe_info(lobe->id)->traits & TRAIT_ANISOTROPIC && (set || !any);
}

WeftResult weft_lobe_init(const char *id, WeftLobe *out, WeftError *error) {
    int k = weft_lobe_find(id);
    char text[SEVERAL_SIZE];
    const char *several = choice_several(CHOICE_sheen_lobe, id, text);
    if (k < 0 && several) return fail(error, WEFT_MESSAGE_LOBE_NAME, id, "several have this name: %s", several);
    if (k < 0) return fail(error, WEFT_MESSAGE_LOBE_NAME, id, "`weft models` lists them");
    *out = (WeftLobe){.lobe = k, .f0 = {1.0f, 1.0f, 1.0f}, .f90 = {1.0f, 1.0f, 1.0f}};
    memcpy(out->params, lobe_default(k).params, sizeof out->params);
    return WEFT_OK;
}

static const WeftParamInfo color_info = {"color", "", 1.0f, 0.0f, 1.0f, 0.0f, 1000.0f, NULL};

/* Returns the value clamped to the hard range. Warns if it is outside the plausible one. */
static float ranged(float value, const WeftParamInfo *p, const char *name, const WeftLog *log) {
    float taken = clamp(value, p->hard_low, p->hard_high);
    if (taken < value || taken > value)
        warn(log, WEFT_MESSAGE_PARAM_RANGE, name, "%g is beyond the limit, %g, which is used", (double)value,
             (double)taken);
    else if (value < p->low || value > p->high)
        warn(log, WEFT_MESSAGE_PARAM_RANGE, name, "%g is taken; plausible is %g .. %g", (double)value, (double)p->low,
             (double)p->high);
    return taken;
}

/* Sets the first parameter of a lobe without a parameter `roughness` from an artist's roughness, as a material does. */
static WeftResult set_roughness(WeftLobe *lobe, const char *value, const WeftLog *log, WeftError *error) {
    static const WeftParamInfo info = {"roughness", "", 0.5f, 0.0f, 1.0f, 0.0f, 2.0f, NULL};
    const WeftLobeInfo *of = weft_lobe_info(lobe->lobe);
    float v[3];
    if (!of->param_count)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, info.name, "%s has nothing that a roughness sets", of->id);
    if (!parse_number(value, v)) return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "%s is a number", info.name);
    lobe->params[0] = lobe_rough(lobe->lobe, ranged(v[0], &info, info.name, log)).params[0];
    return WEFT_OK;
}

WeftResult weft_lobe_set(WeftLobe *lobe, const char *param, const char *value, const WeftLog *log, WeftError *error) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    if (!info) return fail(error, WEFT_MESSAGE_LOBE_NAME, "index", "%d", lobe->lobe);
    float v[3];
    bool f90 = strcmp(param, "f90") == 0 && info->traits & TRAIT_TWO_COLORS;
    if (f90 || strcmp(param, "color") == 0 || strcmp(param, "f0") == 0) {
        if (!parse_color(value, v))
            return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "%s is a number or r,g,b", param);
        for (int c = 0; c < 3; c++) (f90 ? lobe->f90 : lobe->f0)[c] = ranged(v[c], &color_info, param, log);
        return WEFT_OK;
    }
    int k = weft_lobe_param_find(lobe->lobe, param);
    if (k < 0 && strcmp(param, "roughness") == 0) return set_roughness(lobe, value, log, error);
    if (k < 0) return fail(error, WEFT_MESSAGE_PARAM_NAME, param, "`weft models %s` lists them", info->id);
    const WeftParamInfo *row = &info->params[k];
    for (int choice = 0; row->choices && row->choices[choice]; choice++)
        if (strcmp(row->choices[choice], alias_id(value)) == 0) {
            lobe->params[k] = (float)choice;
            return WEFT_OK;
        }
    if (row->choices)
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "`weft models %s` lists what %s may be", info->id, param);
    if (!parse_number(value, v)) return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "%s is a number", param);
    lobe->params[k] = ranged(v[0], row, param, log);
    return WEFT_OK;
}

void lobe_fitted(const Lobe *lobe, const char *name, const WeftLog *log) {
    float taken = lobe_fitted_first(lobe), given = lobe->params[0];
    if (taken > given)
        warn(log, WEFT_MESSAGE_PARAM_FITTED, name,
             "alpha %.3g of fibres that lean counts as %.3g; the lobe fibre-walk has no such bound", (double)given,
             (double)taken);
}

void weft_lobe_fitted(const WeftLobe *lobe, const char *name, const WeftLog *log) {
    Lobe inner;
    if (lobe_of(lobe, &inner)) lobe_fitted(&inner, name, log);
}

void weft_lobe_eval(const WeftLobe *lobe, const float wo[3], const float wi[3], float f[3]) {
    f[0] = f[1] = f[2] = 0.0f;
    Lobe inner;
    if (!(wo[2] > 0.0f && wi[2] > 0.0f) || !lobe_of(lobe, &inner)) return;
    Angles a = angles_between(dir(wo[0], wo[1], wo[2]), dir(wi[0], wi[1], wi[2]));
    LobeValue value = lobe_value(&inner, a);
    for (int c = 0; c < 3; c++)
        f[c] = value.f * lobe_color(value, lobe->f0[c], lobe_second(&inner, lobe->f0[c], lobe->f90[c]));
}

float weft_lobe_pdf(const WeftLobe *lobe, const float wo[3], const float wi[3]) {
    Lobe inner;
    if (!(wo[2] > 0.0f && wi[2] > 0.0f) || !lobe_of(lobe, &inner)) return 0.0f;
    return lobe_pdf(&inner, angles_between(dir(wo[0], wo[1], wo[2]), dir(wi[0], wi[1], wi[2])));
}

float weft_lobe_sample(const WeftLobe *lobe, const float wo[3], const float u[2], float wi[3]) {
    Lobe inner;
    if (!(wo[2] > 0.0f) || !lobe_of(lobe, &inner)) return 0.0f;
    Dir i = lobe_sample(&inner, dir(wo[0], wo[1], wo[2]), u[0], u[1]);
    wi[0] = i.x, wi[1] = i.y, wi[2] = i.z;
    return weft_lobe_pdf(lobe, wo, wi);
}

void weft_lobe_albedo(const WeftLobe *lobe, float cos_o, float e[3]) {
    Lobe inner;
    e[0] = e[1] = e[2] = 0.0f;
    if (!lobe_of(lobe, &inner)) return;
    float z = clamp(cos_o, 1e-6f, 1.0f);
    Dir o = dir(sqrt(max(1.0f - z * z, 0.0f)), 0.0f, z);
    if (albedo_depends_on_color(&inner)) {
        albedo_in_color(&inner, o, lobe->f0, 2e-5, e);
        return;
    }
    Albedo albedo = albedo_quadrature(&inner, o, 2e-5);
    for (int c = 0; c < 3; c++)
        e[c] = albedo.f0 * lobe->f0[c] + albedo.f90 * lobe_second(&inner, lobe->f0[c], lobe->f90[c]);
}
