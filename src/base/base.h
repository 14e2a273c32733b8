// What every module uses: vectors, errors and checks, files, images, words, progress. Each has its own header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/checks.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/images.h"
#include "base/progress.h"
#include "base/vectors.h"
#include "base/words.h"
