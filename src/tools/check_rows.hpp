#pragma once

#include <string>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// The line with the columns of write_check().
std::string check_header(bool has_frames);

/// A line of CSV for each contact of a candidate, one without a contact if it is free: whether it
/// is, what it touches, itself (`candidate`), a `fiber` or an `object`, the object's name, and the
/// contact.
/// @param names       of the candidate's fibres, and of the fibres that it was checked against
/// @param environment that it was checked against; nullptr for none
void write_check(TextOutput& output, const FrameNumber& frame, const FiberCheck& check,
                 const PairNames& names, const Environment* environment);

}  // namespace fiber
