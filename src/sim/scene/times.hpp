// Times in a scene: of the paths of holds, and of tables of what changes in time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/sim/time_table.hpp"
#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber {

/// Reads the time of an entry [s].
/// @param before that of the entry before; none for the first one, whose time is 0
/// @param what   `path` or `table`
/// @throws std::invalid_argument naming file, line and value, for times that do not rise from 0
double read_time(const YamlField& time, std::optional<double> before, const std::string& what);

/// Reads the period after which a path or table begins again [s].
/// @param last the time of its last entry
/// @param what `path` or `table`
/// @throws std::invalid_argument naming file, line and value, for one that is not later
double read_period(const YamlField& period, double last, const std::string& what);

/// Reads the keys `table` and `period` of an entry. With a period, the last entry is where the
/// table leads back to its beginning.
/// @param keys  of the entries of the table, beside `time`
/// @param value as it is where there is no table, and before the table's first entry
/// @param read  called with an entry and the value before it, which it changes
/// @throws std::invalid_argument naming file, line and value, and what is allowed
template <class Value, class Read>
std::vector<typename TimeTable<Value>::Entry> read_table(const YamlField& field,
                                                         std::vector<std::string> keys, Value value,
                                                         const Read& read) {
  const auto table = field.find("table");
  const auto period = field.find("period");
  if (period && !table) {
    period->refuse("absent where there is no table");
  }
  if (!table) {
    return {{0.0, value}};
  }
  keys.emplace_back("time");
  std::vector<typename TimeTable<Value>::Entry> entries;
  for (const YamlField& entry : table->items()) {
    entry.require_map(keys);
    const double time = read_time(
        entry.get("time"), entries.empty() ? std::nullopt : std::make_optional(entries.back().time),
        "table");
    read(entry, value);
    entries.push_back({time, value});
  }
  if (entries.empty()) {
    table->refuse("a list of at least one entry");
  }
  if (period) {
    entries.push_back({read_period(*period, entries.back().time, "table"), entries.front().value});
  }
  return entries;
}

}  // namespace fiber
