/* traits.h - properties of a lobe over its whole parameter range; tests check each claim */
#pragma once

/* The numbers are those of weft/lobe.h, which a plugin is made without. */
enum {
    TRAIT_RECIPROCAL = 1,
    TRAIT_CONSERVES = 2,
    TRAIT_LOSSLESS = 4,
    TRAIT_TWO_COLORS = 8,
    TRAIT_ANISOTROPIC = 16,
    TRAIT_REFERENCE = 32,
    TRAIT_DIFFUSE = 64,
    TRAIT_TABLE = 128,
    TRAIT_TINTED = 256,
    TRAIT_SYSTEM = 512
};
