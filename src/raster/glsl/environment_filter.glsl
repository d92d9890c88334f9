/* environment_filter.glsl - one texel of a filtered cube: the mean of a lat-long image about its direction
 *
 *   L(d) = sum w L_texel / sum w,   w = sin(theta) exp(kappa (mu - 1)),  mu = d . texel
 *
 * Only texels within `reach` of d are read: beyond it w is below a three-thousandth. */
uniform highp sampler2D source;
uniform highp mat3 face;  /* axes of the face as columns: towards the right, down, and out */
uniform highp vec4 how;   /* texels across the face, level of the source, kappa, cosine of reach */
uniform highp float reach; /* radians */
out highp vec4 texel;

const float pi = 3.14159265358979;

void main() {
    vec3 d = normalize(face * vec3(gl_FragCoord.xy * (2.0 / how.x) - 1.0, 1.0));
    int level = int(how.y);
    ivec2 size = textureSize(source, level);
    float theta = acos(clamp(d.y, -1.0, 1.0)), phi = atan(d.x, -d.z);
    float across = sqrt(max(1.0 - d.y * d.y, 0.0)), rows = float(size.y), columns = float(size.x);
    int top = max(int(floor((theta - reach) / pi * rows)), 0);
    int bottom = min(int(floor((theta + reach) / pi * rows)), size.y - 1);
    float step_angle = 2.0 * pi / columns, step_cos = cos(step_angle), step_sin = sin(step_angle);
    vec4 sum = vec4(0.0);
    for (int y = top; y <= bottom; y++) {
        float at = (float(y) + 0.5) * pi / rows, s = sin(at), c = cos(at);
        /* cos(reach) = c d.y + s across cos(phi - phi_texel) at the ends of the row's part within reach */
        float edge = (how.w - c * d.y) / max(s * across, 1e-6);
        float half_angle = edge <= -1.0 ? pi : edge >= 1.0 ? step_angle : acos(edge) + step_angle;
        int first = int(floor((phi - half_angle) / step_angle + 0.5 * columns));
        int count = min(int(ceil(2.0 * half_angle / step_angle)), size.x);
        float from = (float(first) + 0.5 - 0.5 * columns) * step_angle - phi;
        vec2 now = vec2(cos(from), sin(from));
        int x = first < 0 ? first + size.x : first;
        for (int k = 0; k < count; k++) {
            float mu = c * d.y + s * across * now.x;
            float w = s * exp(how.z * (mu - 1.0));
            sum += w * vec4(texelFetch(source, ivec2(x, y), level).rgb, 1.0);
            now = vec2(now.x * step_cos - now.y * step_sin, now.y * step_cos + now.x * step_sin);
            x = x + 1 < size.x ? x + 1 : 0;
        }
    }
    texel = vec4(min(sum.rgb / max(sum.a, 1e-30), vec3(65504.0)), 1.0);
}
