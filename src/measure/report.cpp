#include "measure/measure.h"

namespace relief {

std::string reportOf(const Results& results) { return tableOf(results); }

} // namespace relief
