#pragma once

#include "src/tools/text_output.hpp"

namespace fiber {

/// Columns of contacts as CSV; those of a file with frames begin with `frame`.
constexpr const char* contact_columns =
    "fiber_a,segment_a,s,fiber_b,segment_b,t,distance,point_a_x,point_a_y,point_a_z,"
    "point_b_x,point_b_y,point_b_z,normal_x,normal_y,normal_z,lower,upper\n";

/// A line per contact.
/// @param contacts Contact, or DistributedContact
template <class Contacts>
void write_csv_contacts(TextOutput& output, const FrameNumber& frame, const Contacts& contacts) {
  for (const auto& contact : contacts) {
    output.write_row(frame, contact.fiber_a, contact.segment_a, contact.s, contact.fiber_b,
                     contact.segment_b, contact.t, contact.distance, contact.point_a,
                     contact.point_b, contact.normal, contact.lower, contact.upper);
  }
}

}  // namespace fiber
