/* fitted.h - the parameters of a fitted lobe that a material can express */
#pragma once

#include "weft/fit.h"

/* Returns the parameters, as bits, that no input of a material sets: all but the first, which roughness sets,
 * and those that have an input of their own. Choices are inputs. */
unsigned params_without_input(const WeftLobe *lobe);
