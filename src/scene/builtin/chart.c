/* chart.c - the reference materials
 *
 *   f0 = ((ior - 1) / (ior + 1))^2   of a dielectric (Fresnel, at normal incidence)
 *
 *   Augustin Fresnel, "Memoire sur la loi des modifications que la reflexion imprime a la lumiere polarisee",
 * 1823. Where a source gives the brightness of a grey material alone, base_color is grey. A dielectric whose index no
 * source gives has 1.5, as in the data base of Palmqvist. The index of a fibre is (n_along + 2 n_across) / 3. */
#include "weft/chart.h"

#include <stddef.h>

#define EPIC      "Epic Games, \"Physically Based Materials\", Unreal Engine documentation, 2014"
#define PALMQVIST "Anton Palmqvist, \"Physically Based\" data base (physicallybased.info), 2023"
#define HEARLE    "W. E. Morton, J. W. S. Hearle, \"Physical Properties of Textile Fibres\", 2008, table 24.1"
#define HOFFMAN   "Tomas Akenine-Moller et al., \"Real-Time Rendering\", 4th edition, 2018, table 9.2 (Naty Hoffman)"
#define LAGARDE   "Sebastien Lagarde, \"Feeding a physically based shading model\", 2011"

#define F0(n) (((n)-1.0f) / ((n) + 1.0f) * (((n)-1.0f) / ((n) + 1.0f)))
#define GREY(x)                                                                                                        \
    { x, x, x }
#define RGB(r, g, b)                                                                                                   \
    { r, g, b }
#define OPAQUE(name, help, color, ior, source)                                                                         \
    { name, help, source, WEFT_CHART_OPAQUE, color, GREY(F0(ior)), ior }
#define CLEAR(name, help, ior, source)                                                                                 \
    { name, help, source, WEFT_CHART_CLEAR, GREY(1.0f), GREY(F0(ior)), ior }
#define GEM(name, help, ior, source)                                                                                   \
    { name, help, source, WEFT_CHART_GEM, GREY(1.0f), GREY(F0(ior)), ior }
#define METAL(name, help, r, g, b, source)                                                                             \
    { name, help, source, WEFT_CHART_METAL, RGB(r, g, b), RGB(r, g, b), 0.0f }

static const WeftChartEntry entries[] = {
    OPAQUE("charcoal", "", GREY(0.02f), 1.5f, EPIC),
    OPAQUE("tyre", "rubber of a car tyre", GREY(0.023f), 1.5f, PALMQVIST),
    OPAQUE("worn-asphalt", "", GREY(0.08f), 1.5f, EPIC),
    OPAQUE("brick", "", RGB(0.262f, 0.095f, 0.061f), 1.5f, PALMQVIST),
    OPAQUE("bare-soil", "", GREY(0.13f), 1.5f, EPIC),
    OPAQUE("skin-dark", "dark skin (V of Fitzpatrick's six types)", RGB(0.283f, 0.148f, 0.079f), 1.4f, PALMQVIST),
    OPAQUE("grass", "", GREY(0.21f), 1.5f, EPIC),
    OPAQUE("desert-sand", "", GREY(0.36f), 1.5f, EPIC),
    OPAQUE("concrete", "fresh", GREY(0.51f), 1.5f, EPIC),
    OPAQUE("skin-light", "light skin (I of Fitzpatrick's six types)", RGB(0.847f, 0.638f, 0.552f), 1.4f, PALMQVIST),
    OPAQUE("marble", "white", RGB(0.83f, 0.791f, 0.753f), 1.5f, PALMQVIST),
    OPAQUE("snow", "fresh", GREY(0.81f), 1.3098f, EPIC),
    OPAQUE("paper", "office paper, whitened", RGB(0.794f, 0.834f, 0.884f), 1.5f, PALMQVIST),

    CLEAR("ice", "", 1.3098f, PALMQVIST),
    CLEAR("water", "", 1.333f, PALMQVIST),
    CLEAR("acrylic", "acrylic glass, PMMA", 1.476f, PALMQVIST),
    CLEAR("glass", "window glass, soda-lime", 1.52f, PALMQVIST),
    CLEAR("wool", "fibre of wool (1.553 along, 1.542 across)", 1.5457f, HEARLE),
    CLEAR("cotton", "fibre of cotton (1.578 along, 1.532 across)", 1.5473f, HEARLE),
    CLEAR("silk", "fibre of silk (1.591 along, 1.538 across)", 1.5557f, HEARLE),
    CLEAR("polyester", "fibre of polyester (1.725 along, 1.537 across)", 1.5997f, HEARLE),

    GEM("sapphire", "and ruby", 1.7682f, PALMQVIST),
    GEM("diamond", "", 2.4168f, PALMQVIST),

    METAL("tungsten", "", 0.504f, 0.498f, 0.478f, PALMQVIST),
    METAL("titanium", "", 0.542f, 0.497f, 0.449f, HOFFMAN),
    METAL("chromium", "", 0.549f, 0.556f, 0.554f, HOFFMAN),
    METAL("iron", "and plain steel", 0.562f, 0.565f, 0.578f, HOFFMAN),
    METAL("nickel", "", 0.660f, 0.609f, 0.526f, HOFFMAN),
    METAL("platinum", "", 0.673f, 0.637f, 0.585f, HOFFMAN),
    METAL("cobalt", "", 0.662f, 0.655f, 0.634f, LAGARDE),
    METAL("copper", "", 0.955f, 0.638f, 0.538f, HOFFMAN),
    METAL("brass", "70 % copper, 30 % zinc", 0.910f, 0.778f, 0.423f, HOFFMAN),
    METAL("zinc", "", 0.664f, 0.824f, 0.850f, HOFFMAN),
    METAL("gold", "", 1.000f, 0.782f, 0.344f, HOFFMAN),
    METAL("aluminium", "", 0.913f, 0.922f, 0.924f, HOFFMAN),
    METAL("silver", "", 0.972f, 0.960f, 0.915f, HOFFMAN),
};

enum { ENTRIES = sizeof entries / sizeof *entries };

const WeftChartEntry *weft_chart(int index) { return index >= 0 && index < ENTRIES ? &entries[index] : NULL; }
