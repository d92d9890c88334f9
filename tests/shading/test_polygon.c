/* Polygons on the sphere: the closed form of a cosine and of transformed ones, clipping at the horizon, and
 * the points of the quadrature, against brute force in double */
#include "cases.h"
#include "lights.h"

static double cosine(const void *what, Dir o, Dir i) { return (double)i.z / PI_DOUBLE; }
static double one(const void *what, Dir o, Dir i) { return 1.0; }
/* 1 keeps them above 0, for a tolerance is a part of the sum. */
static double along_x(const void *what, Dir o, Dir i) { return 1.0 + (double)i.x; }
static double along_y(const void *what, Dir o, Dir i) { return 1.0 + (double)i.y; }
static double along_z(const void *what, Dir o, Dir i) { return 1.0 + (double)i.z; }

static double transformed(const void *what, Dir o, Dir i) { return (double)ltc_pdf(*(const Ltc *)what, o, i); }

static void form_factor_equals_the_integral(void **state) {
    (void)state;
    uint64_t random = 1;
    double worst = 0.0;
    for (int n = 0; n < (test_short() ? 100 : 1000); n++) {
        Point corners[8];
        int count = any_polygon(&random, n % 4 == 0 ? 30.0 : 2.0, corners);
        double expected = light_integral(cosine, NULL, dir(0.0f, 0.0f, 1.0f), corners, count, 3);
        double got = (double)polygon_cosine(light_polygon(corners, count));
        double error = fabs(got - expected) / (1e-3 * expected + 1e-6);
        if (error > worst) worst = error;
        if (error > 1.0) fail_msg("%d corners, polygon %d: %.9g for %.9g", count, n, got, expected);
    }
    print_message("form factors: %.2g of the tolerance\n", worst);
    /* a square of side 2 overhead, 1 away: four times the corner that Lambert has */
    const Point square[4] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    double corner = atan((sqrt)(0.5)) * (sqrt)(0.5) / PI_DOUBLE;
    assert_float_equal(polygon_cosine(light_polygon(square, 4)), (float)(4.0 * corner), 1e-6f);
}

static void transformed_cosines_equal_the_integral(void **state) {
    (void)state;
    uint64_t random = 2;
    for (int n = 0; n < (test_short() ? 40 : 400); n++) {
        Point corners[8];
        int count = any_polygon(&random, 2.0, corners);
        double z = 0.05 + 0.95 * light_random(&random), phi = 6.0 * light_random(&random);
        Dir o = dir((float)((sqrt)(1.0 - z * z) * (cos)(phi)), (float)((sqrt)(1.0 - z * z) * (sin)(phi)), (float)z);
        Ltc m = ltc_of((float)(0.2 + light_random(&random)), (float)light_random(&random),
                       (float)(light_random(&random) - 0.5), (float)light_random(&random), o.z);
        double expected = light_integral(transformed, &m, o, corners, count, 3);
        double got = (double)polygon_ltc(m, o, light_polygon(corners, count));
        if (fabs(got - expected) > 2e-3 * expected + 1e-5) fail_msg("polygon %d: %.9g for %.9g", n, got, expected);
    }
}

static void clipped_polygon_is_exact(void **state) {
    (void)state;
    uint64_t random = 3;
    int crossing = 0;
    for (int n = 0; n < 10000; n++) {
        Point corners[8];
        int count = any_polygon(&random, 0.7, corners), below = 0;
        Polygon p = light_polygon(corners, count), q = polygon_clip(p);
        for (int k = 0; k < count; k++) below += p.corners[k].z < 0.0f;
        crossing += below > 0 && below < count;
        assert_true(q.count <= count + 1);
        if (below == count) assert_int_equal(q.count, 0);
        if (below == 0) assert_memory_equal(&p.corners, &q.corners, (size_t)count * sizeof(Dir));
        for (int k = 0; k < q.count; k++) assert_true(q.corners[k].z >= 0.0f);
        /* what is above and what is below, turned over, add up to the whole seen by a sphere */
        Polygon turned = p;
        for (int k = 0; k < count; k++) turned.corners[k].z = -p.corners[k].z;
        float up = polygon_cosine(p), down = polygon_cosine(turned);
        float whole = fabsf(polygon_flux(polygon_on_sphere(p)).z) / PI;
        assert_float_equal(fabsf(up - down), whole, 2e-6f);
    }
    assert_true(crossing > 2000);
    /* a light that sinks goes out step by step */
    float last = -1.0f;
    for (int step = 0; step <= 4000; step++) {
        float z = 1.0f - (float)step * 5e-4f;
        Polygon p = {.corners = {{1, -1, z}, {1, 1, z}, {1, 1, z + 0.5f}, {1, -1, z + 0.5f}}, .count = 4};
        float f = polygon_cosine(p);
        if (step > 0) assert_true(fabsf(f - last) < 2e-4f);
        if (z + 0.5f <= 0.0f) assert_float_equal(f, 0.0f, 0.0f);
        last = f;
    }
}

/* In the plane of the light, and on it, there is no more than the hemisphere. */
static void form_factor_in_the_plane_of_the_light_is_bounded(void **state) {
    (void)state;
    uint64_t random = 4;
    for (int n = 0; n < 20000; n++) {
        Point corners[8];
        int count = any_polygon(&random, 0.0, corners);
        int kind = n % 4;
        Point at = corners[0]; /* the point lies there: on a corner, an edge, beside it, or just above */
        if (kind == 1) at = point_add(corners[0], point_add(corners[1], corners[0], -1.0), light_random(&random));
        if (kind == 2) at = point_add(corners[0], point_add(corners[1], corners[0], -1.0), 1.0 + light_random(&random));
        if (kind == 3) at = point_add(corners[0], corners[0], -0.5 + 1e-7);
        for (int k = 0; k < count; k++) corners[k] = point_add(corners[k], at, -1.0);
        float f = polygon_cosine(light_polygon(corners, count));
        if (!(f >= 0.0f && f <= 1.0f)) fail_msg("kind %d: %g", kind, (double)f);
        if (kind == 2) assert_float_equal(f, 0.0f, 2e-3f);
    }
}

/* Gauss' points hold the solid angle, and the mean direction, from afar and from near. */
static void points_of_a_polygon_keep_its_moments(void **state) {
    (void)state;
    static const Integrand moments[] = {one, along_x, along_y, along_z};
    static const double distances[] = {10.0, 2.0, 0.5};
    for (int d = 0; d < 3; d++) {
        uint64_t random = 5;
        double off = 0.0, all = 0.0;
        for (int n = 0; n < 200; n++) {
            Point corners[8];
            int count = any_polygon(&random, distances[d], corners);
            Polygon q = polygon_on_sphere(polygon_clip(light_polygon(corners, count)));
            Dir c = polygon_middle(q, polygon_flux(q)), a = polygon_last(q);
            double got[4] = {0}, expected[4];
            int points = 0, rays = polygon_rays(q.count), steps = polygon_steps(q.count);
            for (int k = 0; k < q.count; a = q.corners[k++])
                for (int j = 0; j < rays * steps; j++, points++) {
                    PolygonRay ray = polygon_ray(c, a, q.corners[k], j / steps, rays);
                    PolygonPoint p = polygon_point(c, ray, j % steps, steps);
                    assert_float_equal(dir_dot(p.w, p.w), 1.0f, 5e-5f);
                    assert_true(p.w.z > -1e-6f && p.area >= 0.0f);
                    got[0] += (double)p.area;
                    got[1] += (double)(p.area * (1.0f + p.w.x));
                    got[2] += (double)(p.area * (1.0f + p.w.y));
                    got[3] += (double)(p.area * (1.0f + p.w.z));
                }
            assert_true(points <= 32);
            for (int m = 0; m < 4; m++) {
                expected[m] = light_integral(moments[m], NULL, dir(0.0f, 0.0f, 1.0f), corners, count, 3);
                off += fabs(got[m] - expected[m]);
                all += fabs(expected[m]);
            }
        }
        print_message("moments at distance %g: off by %.3f %%\n", distances[d], 100.0 * off / all);
        assert_true(off < 0.005 * all);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(form_factor_equals_the_integral),
        cmocka_unit_test(transformed_cosines_equal_the_integral),
        cmocka_unit_test(clipped_polygon_is_exact),
        cmocka_unit_test(form_factor_in_the_plane_of_the_light_is_bounded),
        cmocka_unit_test(points_of_a_polygon_keep_its_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
