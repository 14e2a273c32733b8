#include <string_view>

#include "base/base.h"

namespace relief::checks {

void failCheck(const char* file, int line, const char* condition, const std::string& operands) {
    std::string_view name(file); // from the project's folder on
    if (const std::size_t src = name.rfind("src/"); src != std::string_view::npos) name.remove_prefix(src);
    fail(Failure::internal, "{}:{}: {} does not hold: {}", name, line, condition, operands);
}

} // namespace relief::checks
