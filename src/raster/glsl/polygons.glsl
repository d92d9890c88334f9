/* polygons.glsl - light from polygons */
#include "raster/glsl/picture.glsl"
#include "shading/area/area.h"
#include "shading/stack/frame.h"

/* The fraction of each polygon's light that reaches a pixel on its side and on the other; 0 behind a one-sided
 * polygon. */
struct PolygonReach {
    float front[POLYGONS], behind[POLYGONS];
};

/* The text before it defines POLYGONS, their number, CORNERS_OF(k), and EACH_POLYGON(L), which is L(k, corners,
 * two_sided, map) for each. */
#define ONE_REACH(k, corners, two_sided, map)                                                                \
    if (two_sided ||                                                                                         \
        dot(polygon_normals[k].xyz, here - polygon_corners[PICTURE_CORNERS * k].xyz) > 0.0) {                \
        reach.front[k] = polygon_reaches(map, lifted(normal), normal, polygon_normals[k].xyz);              \
        if (transmits)                                                                                       \
            reach.behind[k] = polygon_reaches(map, lifted(-normal), -normal, polygon_normals[k].xyz);        \
    }
PolygonReach polygon_reach(bool transmits, Facing at) {
    vec3 here = eye.xyz + from_eye, normal = vec_of_dir(smooth_normal);
    PolygonReach reach;
    for (int k = 0; k < POLYGONS; k++) reach.front[k] = reach.behind[k] = 0.0;
    EACH_POLYGON(ONE_REACH)
    return reach;
}

#ifdef COARSE
/* Returns the light of all polygons: that of two points on each, on a diagonal, the same for all pixels. Adds it to that of
 * the pixel. polygon_normals.w: 1 if both sides emit, else 0. */
Rgb polygon_light(Stack m, StackView w, PolygonReach reach, Frame f) {
    vec3 here = eye.xyz + from_eye;
    Rgb sum = rgb_grey(0.0);
    for (int k = 0; k < POLYGONS; k++) {
        for (int j = 0; j < polygons_number; j++) {
            vec4 point = polygon_points[POLYGON_POINTS * k + polygons_first + j], normal = polygon_normals[k];
            point.w *= float(POLYGON_POINTS) / float(polygons_number);
            vec3 to = point.xyz - here;
            float d2 = max(dot(to, to), point.w), r = inversesqrt(d2), cosine = -r * dot(normal.xyz, to);
            vec3 c = polygon_radiance[k].rgb * (point.w / d2 * max(cosine, -cosine * normal.w));
            Beam beam;
            beam.wi = dir_of(r * to);
            beam.radiance = rgb(c.r, c.g, c.b);
            Rgb open = beam_light(beam, m, w, SHOWN, f);
            Rgb light = rgb_scale(open, dir_dot(beam.wi, smooth_normal) > 0.0 ? reach.front[k] : reach.behind[k]);
            polygons_open += polygons_weight * vec_of(open);
            polygons_shadowed += polygons_weight * vec_of(light);
            sum = rgb_add(sum, light);
        }
    }
    return sum;
}
#else
/* Returns the light of polygon k that a stack reflects and transmits. front, behind: fractions that reach either side
 * of the surface's plane, which cuts the polygon. */
Rgb polygon_from(int k, int corners, float front, float behind, Stack m, StackView w, Frame f) {
    vec3 here = eye.xyz + from_eye, c = polygon_radiance[k].rgb;
    Polygon p;
    p.count = corners;
    for (int j = 0; j < corners; j++) {
        vec3 to = polygon_corners[PICTURE_CORNERS * k + j].xyz - here;
        p.corners[j] = frame_to(f, dir(to.x, to.y, to.z));
    }
    Rgb sum = rgb_scale(stack_polygon(m, w, p), front);
    if (HAS_TRANSMITTED(m) && SHOWS_DIFFUSE)
        sum = rgb_add(sum, rgb_scale(stack_polygon_behind(m, w, p), behind));
    return rgb_mul(sum, rgb(c.r, c.g, c.b));
}

/* Returns the light of all polygons. It is a loop, since compilers take a second for each unrolled copy of the
 * stack. */
Rgb polygon_light(Stack m, StackView w, PolygonReach reach, Frame f) {
    Rgb sum = rgb_grey(0.0);
    for (int k = 0; k < POLYGONS; k++)
        sum = rgb_add(sum, polygon_from(k, CORNERS_OF(k), reach.front[k], reach.behind[k], m, w, f));
    return sum;
}
#endif
