/* lifted.glsl - a fragment on the smooth surface that the normals of its triangle describe */
#ifdef SHADOWED
in highp vec3 lift_x;
in highp vec3 lift_yz;
in highp vec3 lift_from;

/* Returns the fragment, less eye, on the smooth surface that the normals of the corners describe: the mean of its
 * projections onto the tangent planes of the corners, sum w n (n . corner - n . p), if that lies on the side of n. Tamy
 * Boubekeur, Marc Alexa, "Phong Tessellation", ACM Transactions on Graphics 27(5), 2008, Equation 2. A facet so does
 * not shadow itself where its smooth surface faces the light. */
vec3 lifted(vec3 n) {
    vec3 p = from_eye;
    vec3 by = lift_from - vec3(dot(lift_x, p), dot(vec3(lift_x.y, lift_yz.xy), p), dot(vec3(lift_x.z, lift_yz.yz), p));
    return dot(by, n) > 0.0 ? p + by : p;
}
#else
vec3 lifted(vec3 n) { return from_eye; }
#endif
