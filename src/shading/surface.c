#include "shading/surface.h"

#include "shading/layer.h"
#include "shading/terms/f_schlick.h"

static Rgb rgb_scale(Rgb c, float s) { return (Rgb){c.r * s, c.g * s, c.b * s}; }
static Rgb rgb_mix(Rgb a, Rgb b, float t) {
    return (Rgb){mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}
static float rgb_max(Rgb c) { return max(c.r, max(c.g, c.b)); }
static float rgb_mean(Rgb c) { return (c.r + c.g + c.b) / 3.0f; }

static Rgb dielectric_f0(const Surface *s) {
    float r = (s->ior - 1.0f) / (s->ior + 1.0f), f = r * r;
    Rgb c = s->specular_color;
    return rgb_scale((Rgb){min(f * c.r, 1.0f), min(f * c.g, 1.0f), min(f * c.b, 1.0f)}, s->specular);
}

/* Adds a lobe; `share` is about what it reflects towards wo, for the choice between lobes. */
static StackLobe *push(Stack *stack, LobeId id, Rgb f0, Rgb f90, float share) {
    StackLobe *lobe = &stack->lobes[stack->count++];
    *lobe = (StackLobe){.lobe = lobe_default(id), .f0 = f0, .f90 = f90, .pick = share};
    return lobe;
}

/* The tangent frame about the coat's own normal; which way x points does not matter to an isotropic coat. */
static void set_coat_frame(Stack *stack, Dir n) {
    /* Tom Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017 */
    float sign = n.z < 0.0f ? -1.0f : 1.0f, a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    stack->coat_x = dir(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    stack->coat_y = dir(b, sign + n.y * n.y * a, -n.y);
    stack->coat_z = n;
}

void surface_stack(Stack *stack, const Surface *s, Dir wo, LobeId sheen, int layer,
                   const AlbedoTable *sheen_e) {
    stack->count = 0;
    stack->under_f0 = stack->under_f90 = 0.0f;
    float left = 1.0f; /* what the layers above let through */

    float coat_o = dir_dot(wo, s->clearcoat_normal);
    if (s->clearcoat > 0.0f && coat_o > 1e-4f) { /* a coat turned away by its normal map is not seen */
        set_coat_frame(stack, s->clearcoat_normal);
        float f = s->clearcoat * mix(0.04f, 1.0f, schlick_s(coat_o));
        StackLobe *coat = push(stack, LOBE_GGX, (Rgb){f, f, f}, (Rgb){f, f, f}, f);
        lobe_set(&coat->lobe, 0, s->clearcoat_roughness * s->clearcoat_roughness);
        coat->coat = true;
        left -= f;
    }

    if (rgb_max(s->sheen_color) > 0.0f) {
        float alpha = s->sheen_roughness * s->sheen_roughness, e = albedo_table_read(sheen_e, wo.z, alpha);
        Rgb color = rgb_scale(s->sheen_color, left);
        StackLobe *top = push(stack, sheen, color, color, rgb_mean(color) * e);
        if (weft_lobe_info((int)sheen)->param_count > 0) lobe_set(&top->lobe, 0, alpha);
        left *= layer_base((LayerId)layer, s->sheen_color, e);
    }

    Rgb f0_dielectric = dielectric_f0(s), f0 = rgb_mix(f0_dielectric, s->base_color, s->metallic);
    float f90 = mix(s->specular, 1.0f, s->metallic), s_o = schlick_s(wo.z);
    if (rgb_max(f0) > 0.0f || f90 > 0.0f) {
        Rgb f90_left = {left * f90, left * f90, left * f90};
        float share = left * mix(rgb_mean(f0), f90, s_o);
        StackLobe *specular = push(stack, LOBE_GGX, rgb_scale(f0, left), f90_left, share);
        lobe_set(&specular->lobe, 0, s->roughness * s->roughness);
        lobe_set(&specular->lobe, 1, s->anisotropy);
    }

    Rgb diffuse = rgb_scale(s->base_color, left * (1.0f - s->metallic));
    if (rgb_max(diffuse) > 0.0f) {
        stack->under_f0 = rgb_max(f0_dielectric);
        stack->under_f90 = s->specular;
        float share = rgb_mean(diffuse) * (1.0f - mix(stack->under_f0, stack->under_f90, s_o));
        push(stack, LOBE_LAMBERT, diffuse, diffuse, share);
    }

    /* a floor keeps every lobe reachable, so that no weight is unbounded */
    float total = 0.0f;
    for (int k = 0; k < stack->count; k++) total += stack->lobes[k].pick = max(stack->lobes[k].pick, 1e-3f);
    float floor_pick = 0.05f / max((float)stack->count, 1.0f);
    for (int k = 0; k < stack->count; k++)
        stack->lobes[k].pick = 0.95f * stack->lobes[k].pick / total + floor_pick;
}
