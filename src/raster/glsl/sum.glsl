/* sum.glsl - the sum of two pictures, each times a number */
uniform highp sampler2D sum_first;
uniform highp sampler2D sum_second;
uniform highp vec2 sum_weights;
out highp vec4 fragment;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    fragment = sum_weights.x * texelFetch(sum_first, at, 0) + sum_weights.y * texelFetch(sum_second, at, 0);
}
