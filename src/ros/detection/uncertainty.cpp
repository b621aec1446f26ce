#include "src/ros/detection/uncertainty.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace fiber_proximity_ros {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The next number below, so that a rounded difference is no more than the true one.
double rounded_down(double value) {
  return std::isinf(value) ? value : std::nextafter(value, -infinity);
}

double rounded_up(double value) {
  return std::isinf(value) ? value : std::nextafter(value, infinity);
}

/// Widens all bounds and leaves out what is impossible.
/// @returns whether anything is
bool widen(double margin, const Uncertainty& uncertainty, fiber::QueryResult& result) {
  std::vector<fiber::Contact>& contacts = result.contacts;
  for (fiber::Contact& contact : contacts) {
    uncertainty.widen(contact);
  }
  result.others_lower = rounded_down(result.others_lower - uncertainty.max());
  const auto impossible = std::stable_partition(
      contacts.begin(), contacts.end(),
      [margin](const fiber::Contact& contact) { return contact.lower <= margin; });
  for (auto contact = impossible; contact != contacts.end(); ++contact) {
    result.others_lower = std::min(result.others_lower, contact->lower);
  }
  const bool leaves_out = impossible != contacts.end();
  contacts.erase(impossible, contacts.end());
  return leaves_out;
}

/// Whether no possible pair can be missing because an impossible one was reported instead.
bool has_all_possible(const fiber::QueryOptions& options, const fiber::QueryResult& result) {
  switch (options.type) {
    case fiber::QueryType::ALL:
      return true;
    case fiber::QueryType::FIBER_PAIRS:
      // All pairs of the same two fibres have one uncertainty: the closest of them is possible if
      // any is.
      return options.tolerance == 0.0 && options.relative_tolerance == 0.0;
    case fiber::QueryType::LIMITED:
      return !result.limit_reached;
    case fiber::QueryType::FIRST:
    case fiber::QueryType::CLOSEST:
      break;
  }
  return false;
}

}  // namespace

Uncertainty::Uncertainty(std::vector<double> of_fibers, Bodies bodies)
    : of_fibers_(std::move(of_fibers)), bodies_(bodies) {
  if (!of_fibers_.empty()) {
    const double most = *std::max_element(of_fibers_.begin(), of_fibers_.end());
    max_ = bodies == Bodies::BOTH ? 2.0 * most : most;
  }
}

double Uncertainty::of_pair(const fiber::SegmentIdPair& pair) const {
  if (is_none()) {
    return 0.0;
  }
  switch (bodies_) {
    case Bodies::A:
      return of_fiber(pair.fiber_a);
    case Bodies::B:
      return of_fiber(pair.fiber_b);
    case Bodies::BOTH:
      break;
  }
  const double sum = of_fiber(pair.fiber_a) + of_fiber(pair.fiber_b);
  return sum > 0.0 ? std::min(rounded_up(sum), max_) : 0.0;
}

double Uncertainty::possible_margin(double margin, const fiber::SegmentIdPair& pair) const {
  const double by = of_pair(pair);
  return by > 0.0 ? rounded_up(margin + by) : margin;
}

double Uncertainty::possible_margin(double margin) const {
  return is_none() ? margin : rounded_up(margin + max_);
}

double Uncertainty::certain_margin(double margin, const fiber::SegmentIdPair& pair) const {
  const double by = of_pair(pair);
  return by > 0.0 ? rounded_down(margin - by) : margin;
}

double Uncertainty::certain_margin(double margin) const {
  return is_none() ? margin : rounded_down(margin - max_);
}

void Uncertainty::widen(fiber::Contact& contact) const {
  const double by = of_pair(contact);
  if (by > 0.0) {
    contact.lower = rounded_down(contact.lower - by);
    contact.upper = rounded_up(contact.upper + by);
  }
}

bool query_possible(const fiber::QueryOptions& options, const Uncertainty& uncertainty,
                    const Ask& ask, fiber::QueryResult& result) {
  if (uncertainty.is_none()) {
    ask(options, result);
    return false;
  }
  const fiber::Deadline deadline(options.deadline);
  fiber::QueryOptions wide = options;
  wide.margin = uncertainty.possible_margin(options.margin);
  ask(wide, result);
  if (!widen(options.margin, uncertainty, result)) {
    return false;
  }
  if (has_all_possible(options, result)) {
    return true;
  }
  // The engine has reported impossible pairs, and perhaps no others as they are further apart.
  const fiber::QueryCounts counts = result.counts;
  wide.type = fiber::QueryType::ALL;
  wide.deadline = deadline.left();
  ask(wide, result);
  widen(options.margin, uncertainty, result);
  result.counts += counts;
  fiber::QueryResult no_others;
  no_others.others_lower = infinity;
  fiber::merge_results(options, no_others, result);
  return true;
}

fiber::FiberAssembly enclosing_fibers(const fiber::FiberAssembly& fibers,
                                      const std::vector<double>& of_fibers) {
  assert(of_fibers.size() == fibers.fiber_count());
  std::vector<double> radii;
  radii.reserve(fibers.point_count());
  for (std::size_t i = 0; i < fibers.fiber_count(); ++i) {
    for (std::uint32_t point = fibers.offsets()[i]; point < fibers.offsets()[i + 1]; ++point) {
      const double radius = fibers.radius_at(i, point) + of_fibers[i];
      radii.push_back(std::min(rounded_up(radius), fiber::FiberAssembly::max_coordinate));
    }
  }
  return {fibers.points(), fibers.offsets(), radii};
}

fiber::Contact told_contact(fiber::Contact enclosing, double uncertainty) {
  if (uncertainty > 0.0) {
    enclosing.distance += uncertainty;
    enclosing.upper = rounded_up(rounded_up(enclosing.upper + uncertainty) + uncertainty);
    enclosing.point_b += uncertainty * enclosing.normal;
  }
  return enclosing;
}

}  // namespace fiber_proximity_ros
