#include "benchmark/answer_errors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

constexpr std::size_t max_checked = 1000;

/// But for its last digit, and for the rounding of the radii [m].
double exact_gap(const FiberAssembly& fibers, const Contact& contact) {
  const Capsule a = fibers.capsule(fibers.offsets()[contact.fiber_a] + contact.segment_a);
  const Capsule b = fibers.capsule(fibers.offsets()[contact.fiber_b] + contact.segment_b);
  return exact_segment_distance(a.p0, a.p1, b.p0, b.p1).distance - (a.radius + b.radius);
}

/// The largest error of exact_gap() [m].
double rounding(double gap) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(gap); }

void check_contacts(const FiberAssembly& fibers, const std::vector<Contact>& contacts,
                    AnswerErrors& errors) {
  const std::size_t step = contacts.size() / max_checked + 1;
  for (std::size_t i = 0; i < contacts.size(); i += step) {
    const Contact& contact = contacts[i];
    const double gap = exact_gap(fibers, contact);
    const bool holds = contact.lower <= gap + rounding(gap) && gap - rounding(gap) <= contact.upper;
    errors.wrong_bounds += holds ? 0 : 1;
    errors.error = std::max(errors.error, std::abs(contact.distance - gap));
    errors.bound = std::max(errors.bound, 0.5 * (contact.upper - contact.lower));
  }
}

void check_pairs(const QueryResult& answer, const QueryResult& exact, AnswerErrors& errors) {
  const std::vector<Contact>& found = answer.contacts;
  const std::vector<Contact>& expected = exact.contacts;
  std::vector<Contact> missing;
  std::vector<Contact> extra;
  std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                      std::back_inserter(missing), by_key);
  std::set_difference(found.begin(), found.end(), expected.begin(), expected.end(),
                      std::back_inserter(extra), by_key);
  errors.expected = expected.size();
  errors.extra += extra.size();
  (answer.complete ? errors.missed : errors.cut_off) = missing.size();
}

/// Errors of the smallest distance. The pair that has it may be another one.
void check_minimum(const QueryResult& answer, const QueryResult& exact, AnswerErrors& errors) {
  const Contact* closest = exact.closest();
  errors.expected = exact.contacts.size();
  if (closest == nullptr) {
    return;
  }
  const double lower = answer.minimum_lower();
  const double upper =
      answer.contacts.empty() ? std::numeric_limits<double>::infinity() : answer.closest()->upper;
  const bool holds = lower <= closest->upper && closest->lower <= upper;
  errors.wrong_bounds += holds ? 0 : 1;
  errors.cut_off = answer.contacts.empty() ? 1 : 0;
  if (!answer.contacts.empty()) {
    errors.error = std::max(0.0, answer.closest()->distance - closest->distance);
    errors.bound = answer.closest()->distance - lower;
  }
}

/// Errors of each pair of fibres. The segments that are closest may be others.
void check_fiber_pairs(const QueryResult& answer, const QueryResult& exact, AnswerErrors& errors) {
  const auto fibers = [](const Contact& contact) {
    return std::make_pair(contact.fiber_a, contact.fiber_b);
  };
  const auto by_fibers = [&](const Contact& x, const Contact& y) { return fibers(x) < fibers(y); };
  std::vector<Contact> found = answer.contacts;
  std::sort(found.begin(), found.end(), by_fibers);
  std::size_t missing = 0;
  for (const Contact& closest : exact.contacts) {
    const auto same = std::lower_bound(found.begin(), found.end(), closest, by_fibers);
    if (same == found.end() || fibers(*same) != fibers(closest)) {
      ++missing;
    } else {
      errors.error = std::max(errors.error, same->distance - closest.distance);
    }
  }
  errors.expected = exact.contacts.size();
  errors.extra = found.size() - std::min(found.size(), exact.contacts.size() - missing);
  (answer.complete ? errors.missed : errors.cut_off) = missing;
}

}  // namespace

void AnswerErrors::add(const AnswerErrors& other) {
  expected += other.expected;
  missed += other.missed;
  cut_off += other.cut_off;
  extra += other.extra;
  wrong_bounds += other.wrong_bounds;
  error = std::max(error, other.error);
  bound = std::max(bound, other.bound);
}

double AnswerErrors::found_part() const {
  const auto missing = static_cast<double>(missed + cut_off);
  return expected == 0 ? 1.0 : 1.0 - missing / static_cast<double>(expected);
}

AnswerErrors answer_errors(const FiberAssembly& fibers, const QueryOptions& options,
                           const QueryResult& answer, const QueryResult& exact) {
  AnswerErrors errors;
  if (options.type == QueryType::CLOSEST) {
    check_minimum(answer, exact, errors);
    return errors;
  }
  check_contacts(fibers, answer.contacts, errors);
  if (options.type == QueryType::FIBER_PAIRS) {
    check_fiber_pairs(answer, exact, errors);
    errors.bound += options.tolerance;
  } else {
    check_pairs(answer, exact, errors);
  }
  return errors;
}

}  // namespace fiber
