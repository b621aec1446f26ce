#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/query/motion.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_match.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

// The parts of `sweep` that are the same with ranks and without.

constexpr const char* sweep_columns =
    "frame,fiber_a,segment_a,fiber_b,segment_b,time_lower,time_upper\n";

/// @throws std::invalid_argument
inline void require_motion(const std::string& path, bool has_frames, std::size_t frame_count) {
  if (frame_count < 2) {
    throw std::invalid_argument(quote(path) + " has " + (has_frames ? "one frame" : "no frames") +
                                ", a motion needs at least two");
  }
}

/// Contacts of a step between frames whose fibres differ: of the fibres that both have those of
/// their motion, of the others those that the first frame has itself. With ranks all of this is
/// collective, and rank 0 has the frames.
/// @param are_any_in_both whether match.before has fibres, on rank 0
/// @param between         contacts of a motion: of fibres before and after, their numbers in the
///                        first frame, and the options
template <class Contact, class Between>
std::vector<Contact> contacts_of_step(const FiberAssembly& from, const FiberAssembly& to,
                                      const FiberMatch& match, bool are_any_in_both,
                                      const MotionOptions& options, const Between& between) {
  std::vector<Contact> contacts;
  if (are_any_in_both) {
    contacts = between(select_fibers(from, match.before), select_fibers(to, match.after),
                       match.before, options);
  }
  if (!match.others.empty()) {
    MotionOptions all = options;
    all.type = MotionType::ALL;
    std::vector<std::uint32_t> every(from.fiber_count());
    std::iota(every.begin(), every.end(), 0U);
    for (const Contact& contact : between(from, from, every, all)) {
      if (match.is_other(contact.fiber_a) || match.is_other(contact.fiber_b)) {
        contacts.push_back(contact);
      }
    }
  }
  return contacts;
}

/// The contacts of a step, with those that there are at its beginning unless only new ones count.
template <class Result>
auto take_contacts(Result& result, bool new_only) {
  auto contacts = std::move(result.contacts);
  if (!new_only) {
    contacts.insert(contacts.end(), result.touching.begin(), result.touching.end());
  }
  return contacts;
}

/// @param contacts sorted by their keys
/// @return the earliest one; of several that are as early the first one
template <class Contacts>
auto earliest(const Contacts& contacts) {
  return std::min_element(contacts.begin(), contacts.end(),
                          [](const auto& x, const auto& y) { return x.lower < y.lower; });
}

template <class Contacts>
void write_sweep_rows(TextOutput& output, std::int64_t frame, const FiberNames& names,
                      const Contacts& contacts) {
  for (const auto& contact : contacts) {
    output.write_row(frame, FiberCalled{names, contact.fiber_a}, contact.segment_a,
                     FiberCalled{names, contact.fiber_b}, contact.segment_b, contact.lower,
                     contact.upper);
  }
}

}  // namespace fiber
