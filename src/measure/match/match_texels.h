/* match_texels.h - the textures of a glTF material, rewritten texel by texel for its match */
#pragma once

#include "gltf/save/rewrite.h"
#include "measure/match/match_curves.h"
#include "scene/record/scene.h"

/* A material and its match. */
typedef struct TexelMatch {
    const WeftScene *scene;
    const WeftMaterial *material; /* with its textures, as the file has it */
    const MatchCurves *curves;
    const WeftMaterial *factors; /* with the factors of the match of the mean, which may be above 1 */
    int from, to;                /* profiles */
    WeftBrdfMetric metric;
    WeftProgress progress; /* may be NULL */
    void *user;
} TexelMatch;

/* Returns true unless the roughness and the colour of the sheen have textures that lie at different places. */
bool texels_joined(const WeftMaterial *material);

/* Rewrites those textures of the colours and roughnesses of base and sheen of which a factor does not do: into new
 * images, which replace the old ones in the JSON of the material. Uses of one texture whose channels differ share an
 * image. Without a texture, a colour whose gain varies gets one, placed as the texture that it depends on. `to` has the
 * factors of the match, at most 1, and receives those of what was rewritten, and the factors that do instead of
 * rewriting; *maps gets bit k for an input k that was rewritten. At some texels, new textures are weighed against the
 * factors alone, and against the material as it is: what is nearest in the mean is written, and if the material has
 * textures, found receives these errors. Fails with WEFT_INTERRUPTED or _MEMORY. */
WeftResult texels_rewrite(const TexelMatch *match, Rewrite *rewrite, json_t *material, WeftMaterial *to, uint64_t *maps,
                          WeftMatch *found, WeftError *error);
