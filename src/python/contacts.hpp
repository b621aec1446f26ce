#pragma once

#include <functional>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/python/arrays.hpp"
#include "src/python/shared.hpp"

namespace fiber::python {

// Arrays of contacts have the fields of the message Contact, at the places where the library's
// structures have them, so that these become arrays without a copy.

const py::dtype& contact_dtype();
const py::dtype& motion_contact_dtype();

/// The fields of Contact in an object that is one or begins with one.
std::vector<Field> contact_fields();

/// An array of that dtype, C order.
py::array to_contacts(const py::object& object);

/// Answer to a query, as Python has it.
struct Answer : OnlyShared {
  explicit Answer(QueryResult& result);

  py::array contacts;
  py::object closest;
  bool limit_reached;
  bool complete;
  double others_lower;
  double minimum_lower;
  QueryCounts counts;
};

/// Answer to a question about a motion.
struct MotionAnswer : OnlyShared {
  /// Where a pair is when it comes into contact; keeps what it asks alive.
  using Locate = std::function<Contact(const MotionContact&)>;

  MotionAnswer(MotionResult& result, Locate locate_contact);

  /// Contacts of the dtype of contacts, where the pairs of an array of motion contacts are at their
  /// times.
  py::array at(const py::object& motion_contacts) const;

  py::array contacts;
  py::array touching;
  py::object earliest;
  bool limit_reached;
  bool complete;
  double others_lower;
  QueryCounts counts;

  Locate locate;
};

}  // namespace fiber::python
