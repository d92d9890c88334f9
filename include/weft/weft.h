/* weft.h - all of the library */
#ifndef WEFT_H
#define WEFT_H

#include "weft/arrays.h"
#include "weft/bake.h"
#include "weft/diff.h"
#include "weft/export.h"
#include "weft/image.h"
#include "weft/lobe.h"
#include "weft/ltc.h"
#include "weft/material.h"
#include "weft/measure.h"
#include "weft/pick.h"
#include "weft/raster.h"
#include "weft/reflection.h"
#include "weft/render.h"
#include "weft/result.h"
#include "weft/save.h"
#include "weft/scene.h"
#include "weft/sheet.h"

#endif
