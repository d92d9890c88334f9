/* polygons.glsl - light from polygons */
#include "raster/glsl/picture.glsl"
#include "shading/area.h"
#include "shading/frame.h"

/* From polygon k, which has so many corners and that shadow map, or -1. Its back is dark unless it has two
 * sides; the surface's own plane parts what is reflected from what comes through. */
Rgb polygon_from(int k, int corners, bool two_sided, int map, Stack m, StackView w, Facing at, Frame f) {
    vec3 here = eye.xyz + from_eye, normal = polygon_normals[k].xyz, c = polygon_radiance[k].rgb;
    Polygon p;
    p.count = corners;
    for (int j = 0; j < corners; j++) {
        vec3 to = polygon_corners[8 * k + j].xyz - here;
        p.corners[j] = frame_to(f, dir(to.x, to.y, to.z));
    }
    if (!two_sided && dot(normal, here - polygon_corners[8 * k].xyz) <= 0.0) return rgb_grey(0.0);
    Rgb sum = rgb_scale(stack_polygon(m, w, p), polygon_reaches(map, vec_of_dir(at.geometric), normal));
    if (HAS_TRANSMITTED(m) && SHOWS_DIFFUSE)
        sum = rgb_add(sum, rgb_scale(stack_polygon_behind(m, w, p),
                                     polygon_reaches(map, -vec_of_dir(at.geometric), normal)));
    return rgb_mul(sum, rgb(c.r, c.g, c.b));
}

/* EACH_POLYGON(L) is L(k, corners, two_sided, map) for each polygon. */
#define ONE_POLYGON(k, corners, two_sided, map)                                                              \
    sum = rgb_add(sum, polygon_from(k, corners, two_sided, map, m, w, at, f));
Rgb polygon_light(Stack m, StackView w, Facing at, Frame f) {
    Rgb sum = rgb_grey(0.0);
    EACH_POLYGON(ONE_POLYGON)
    return sum;
}
