/* horizon.glsl - the plane below which no light counts at a fragment */
#include "shading/stack/frame.h"

/* The normal of the shading frame without a map: the interpolated one, where the viewer sees its side. */
Dir smooth_normal;
