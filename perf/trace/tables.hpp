#pragma once
// The tables of `trace`: rows are scenes, columns kinds of rays.

#include <map>
#include <string>

#include "perf/trace/cell.hpp"
#include "perf/trace/options.hpp"

namespace grelha::perf {

/// By name of the row and kind.
using Results = std::map<std::string, std::map<std::size_t, Cell>>;

void print_tables(const Options& options, const Results& results);

}  // namespace grelha::perf
