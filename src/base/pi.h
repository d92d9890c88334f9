/* pi.h - pi, and radians in a degree; includes nothing of weft, so that programs may include it
 *
 * The dialect has a PI of its own, for its text is GLSL too (shading/dialect/lang.h). */
#pragma once

#define PI_DOUBLE 3.14159265358979323846
#define PI_FLOAT  ((float)PI_DOUBLE)
#define RADIANS   (PI_DOUBLE / 180.0) /* in a degree */
