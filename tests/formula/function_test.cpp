#include <gtest/gtest.h>
#include "formula/formula.h"
