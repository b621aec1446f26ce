#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "src/tools/text_output.hpp"

namespace fiber {

/// Columns of contacts as CSV; those of a file with frames begin with `frame`.
constexpr const char* contact_columns =
    "fiber_a,segment_a,s,fiber_b,segment_b,t,distance,point_a_x,point_a_y,point_a_z,"
    "point_b_x,point_b_y,point_b_z,normal_x,normal_y,normal_z,lower,upper\n";

/// The names of the fibres that a pair may be of.
struct PairNames {
  const FiberNames& a;
  const FiberNames& b;
};

/// A line of CSV.
/// @param contact Contact, or DistributedContact
/// @param fields  before those of the contact
template <class AnyContact, class... Fields>
void write_csv_contact(TextOutput& output, const AnyContact& contact, const PairNames& names,
                       const Fields&... fields) {
  output.write_row(fields..., FiberCalled{names.a, contact.fiber_a}, contact.segment_a, contact.s,
                   FiberCalled{names.b, contact.fiber_b}, contact.segment_b, contact.t,
                   contact.distance, contact.point_a, contact.point_b, contact.normal,
                   contact.lower, contact.upper);
}

/// A line per contact.
template <class Contacts>
void write_csv_contacts(TextOutput& output, const FrameNumber& frame, const FiberNames& names,
                        const Contacts& contacts) {
  for (const auto& contact : contacts) {
    write_csv_contact(output, contact, {names, names}, frame);
  }
}

/// @param contact Contact, or DistributedContact
template <class AnyContact>
nlohmann::ordered_json json_of_contact(const FiberNames& names, const AnyContact& contact) {
  return {{"fiber_a", json_of(FiberCalled{names, contact.fiber_a})},
          {"segment_a", contact.segment_a},
          {"s", contact.s},
          {"fiber_b", json_of(FiberCalled{names, contact.fiber_b})},
          {"segment_b", contact.segment_b},
          {"t", contact.t},
          {"distance", contact.distance},
          {"lower", contact.lower},
          {"upper", contact.upper},
          {"point_a", list_of(contact.point_a)},
          {"point_b", list_of(contact.point_b)},
          {"normal", list_of(contact.normal)}};
}

/// A JSON object of a frame's answer, before its contacts: the frame's number, if it has one,
/// whether the answer is complete, and what no pair is closer than (null without a pair).
inline nlohmann::ordered_json json_of_answer(const FrameNumber& frame, bool is_complete,
                                             double minimum_lower) {
  nlohmann::ordered_json object = object_of(frame);
  object["complete"] = is_complete;
  object["minimum_lower"] =
      std::isfinite(minimum_lower) ? nlohmann::ordered_json(minimum_lower) : nullptr;
  return object;
}

/// Tells that an answer is not complete.
inline std::string deadline_warning(const FrameNumber& frame) {
  return "the deadline has passed" +
         (frame.is_given ? " in frame " + std::to_string(frame.number) : "") +
         ": pairs may be missing";
}

}  // namespace fiber
