#include "gpu/gpu.h"
