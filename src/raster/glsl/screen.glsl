/* screen.glsl - one triangle over all of the picture, at the far end */
out highp vec2 screen;

void main() {
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
    screen = corner * 2.0 - 1.0;
    gl_Position = vec4(screen, 1.0, 1.0);
}
