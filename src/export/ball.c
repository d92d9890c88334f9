/* ball.c - what makes a Shadertoy of a model */
#include "export/draft.h"

void draft_ball(const Draft *draft, Buffer *out) {
    (void)draft;
    put_line(out, "void mainImage(out vec4 color, in vec2 at) { color = vec4(at / iResolution.xy, 0.0, 1.0); }");
}
