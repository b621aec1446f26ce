#include "src/python/options.hpp"

#include <cstdint>
#include <limits>
#include <stdexcept>

#include "src/python/arrays.hpp"
#include "src/text/quote.hpp"

namespace fiber::python {
namespace {

template <class Value>
Value cast(const std::string& name, const py::handle& value, const char* allowed) {
  try {
    return value.cast<Value>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + " is " + std::string(py::repr(value)) + ", it must be " + allowed);
  }
}

double number(const std::string& name, const py::handle& value) {
  return cast<double>(name, value, "a number");
}

std::uint64_t whole(const std::string& name, const py::handle& value, std::uint64_t most) {
  const auto read = cast<std::int64_t>(name, value, "a whole number below 2^63");
  if (read < 0 || static_cast<std::uint64_t>(read) > most) {
    throw std::invalid_argument(name + " is " + std::to_string(read) +
                                ", it must be at least 0 and at most " + std::to_string(most));
  }
  return static_cast<std::uint64_t>(read);
}

std::uint32_t count(const std::string& name, const py::handle& value) {
  return static_cast<std::uint32_t>(whole(name, value, std::numeric_limits<std::uint32_t>::max()));
}

/// Whether it is an option of which pairs to look at.
bool read_pair_option(const std::string& name, const py::handle& value, PairOptions& options) {
  if (name == "max_contacts") {
    options.max_contacts = count(name, value);
  } else if (name == "pairing") {
    options.pairing = pairing_from_name(cast<std::string>(name, value, "a name"));
  } else if (name == "neighbour_skip") {
    if (!value.is_none()) {
      options.neighbour_skip = count(name, value);
    }
  } else if (name == "neighbour_skip_length") {
    if (!value.is_none()) {
      options.neighbour_skip_length = number(name, value);
    }
  } else if (name == "deadline") {
    options.deadline = number(name, value);
  } else if (name == "contact_limit") {
    options.contact_limit = count(name, value);
  } else if (name == "pair_limit") {
    options.pair_limit = whole(name, value, std::numeric_limits<std::int64_t>::max());
  } else {
    return false;
  }
  return true;
}

[[noreturn]] void refuse(const std::string& name, const char* more) {
  throw py::type_error("there is no option " + quote(name) +
                       "; known are margin, max_contacts, pairing, neighbour_skip, "
                       "neighbour_skip_length, deadline, contact_limit, pair_limit, " +
                       more);
}

MotionType motion_type_from_name(const std::string& name) {
  switch (query_type_from_name(name)) {
    case QueryType::FIRST:
      return MotionType::FIRST;
    case QueryType::LIMITED:
      return MotionType::LIMITED;
    case QueryType::ALL:
      return MotionType::ALL;
    default:
      throw std::invalid_argument("type is " + quote(name) +
                                  ", of a motion it must be first, limited or all");
  }
}

}  // namespace

QueryOptions query_options(const std::string& type, double margin, const py::kwargs& keywords) {
  QueryOptions options;
  options.type = query_type_from_name(type);
  options.margin = margin;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (name == "kernel") {
      options.kernel = kernel_from_name(cast<std::string>(name, value, "a name"));
    } else if (name == "tolerance") {
      options.tolerance = number(name, value);
    } else if (name == "relative_tolerance") {
      options.relative_tolerance = number(name, value);
    } else if (!read_pair_option(name, value, options)) {
      refuse(name, "kernel, tolerance, relative_tolerance");
    }
  }
  return options;
}

MotionOptions motion_options(const std::string& type, double margin, const py::kwargs& keywords) {
  MotionOptions options;
  options.type = motion_type_from_name(type);
  options.margin = margin;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (name == "tolerance") {
      options.tolerance = number(name, value);
    } else if (name == "time_tolerance") {
      options.time_tolerance = number(name, value);
    } else if (!read_pair_option(name, value, options)) {
      refuse(name, "tolerance, time_tolerance");
    }
  }
  return options;
}

}  // namespace fiber::python
