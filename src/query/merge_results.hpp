#pragma once

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Makes one answer of two, about pairs of which none is in both: those that the query asks for
/// among the contacts of both, sorted. What is left out then counts in others_lower.
/// @param more its contacts may be in any order, as those of the result
void merge_results(const QueryOptions& options, const QueryResult& more, QueryResult& result);

}  // namespace fiber
