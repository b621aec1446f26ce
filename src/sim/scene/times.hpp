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

/// Reads a path or a table: entries in the order of their times.
/// @param what  `path` or `table`
/// @param keys  of each entry
/// @param entry as it is before the first one; what an entry does not say is as in the one before
/// @param read  called with the field of an entry and the entry, which it changes
/// @throws std::invalid_argument naming file, line and value, and what is allowed
template <class Entry, class Read>
std::vector<Entry> read_entries(const YamlField& list, const std::string& what,
                                const std::vector<std::string>& keys, Entry entry,
                                const Read& read) {
  std::vector<Entry> entries;
  for (const YamlField& field : list.items()) {
    field.require_map(keys);
    entry.time = read_time(field.get("time"),
                           entries.empty() ? std::nullopt : std::make_optional(entry.time), what);
    read(field, entry);
    entries.push_back(entry);
  }
  if (entries.empty()) {
    list.refuse("a list of at least one entry");
  }
  return entries;
}

/// Leads a path or a table back to where it begins, after which it begins again.
template <class Entry>
void close_entries(const YamlField& period, const std::string& what, std::vector<Entry>& entries) {
  const double length = read_period(period, entries.back().time, what);
  entries.push_back(entries.front());
  entries.back().time = length;
}

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
  using Entry = typename TimeTable<Value>::Entry;
  const auto table = field.find("table");
  const auto period = field.find("period");
  if (period && !table) {
    period->refuse("absent where there is no table");
  }
  if (!table) {
    return {{0.0, value}};
  }
  keys.emplace_back("time");
  std::vector<Entry> entries = read_entries(
      *table, "table", keys, Entry{0.0, value},
      [&read](const YamlField& of_entry, Entry& entry) { read(of_entry, entry.value); });
  if (period) {
    close_entries(*period, "table", entries);
  }
  return entries;
}

}  // namespace fiber
