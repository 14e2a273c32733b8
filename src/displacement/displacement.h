// Height maps, vector maps, normal maps and the displaced surface: loading, convention, encoding for the device,
// lookup, and the double-precision reference of the displaced surface.
#pragma once

#include "displacement/displaced_frame.h"
#include "displacement/height_map.h"
#include "displacement/layers.h"
#include "displacement/normal_map.h"
#include "displacement/vector_map.h"
