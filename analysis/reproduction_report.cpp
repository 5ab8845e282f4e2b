#include "analysis/reproduction.h"

namespace scree {

void write_reproduction(const std::vector<CaseResult>&, const std::vector<TrendComparison>&,
                        const std::filesystem::path&) {}

}  // namespace scree
