/* tone_check.h - checks of how radiance is to be shown */
#pragma once

#include "weft/image.h"

/* Fails with WEFT_MESSAGE_DESC where a tone is out of its range; the message begins with `subject`. */
WeftResult tone_check(const WeftTone *tone, const char *subject, WeftError *error);
