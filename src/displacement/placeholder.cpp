#include "displacement/displacement.h"
