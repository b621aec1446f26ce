#include "src/accuracy/answer_errors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

/// But for its last digit, and for the rounding of the radii [m].
double exact_gap(const FiberAssembly& fibers, const Contact& contact) {
  const Capsule a = fibers.capsule(fibers.offsets()[contact.fiber_a] + contact.segment_a);
  const Capsule b = fibers.capsule(fibers.offsets()[contact.fiber_b] + contact.segment_b);
  return exact_segment_distance(a.p0, a.p1, b.p0, b.p1).distance - (a.radius + b.radius);
}

/// The largest error of exact_gap() [m].
double rounding(double gap) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(gap); }

/// The contact of this pair among contacts sorted by key; nullptr if it is not there.
const Contact* find_pair(const std::vector<Contact>& contacts, const Contact& pair) {
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), pair, by_key);
  return found != contacts.end() && found->key() == pair.key() ? &*found : nullptr;
}

void check_contacts(const FiberAssembly& fibers, const std::vector<Contact>& contacts,
                    const std::vector<Contact>& expected, std::size_t max_checked,
                    AnswerErrors& errors) {
  const std::size_t step = contacts.size() / max_checked + 1;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const bool is_computed = i % step == 0;
    const Contact* const same = is_computed ? nullptr : find_pair(expected, contact);
    if (!is_computed && same == nullptr) {
      continue;
    }
    const double gap = is_computed ? exact_gap(fibers, contact) : same->distance;
    const bool holds = contact.lower <= gap + rounding(gap) && gap - rounding(gap) <= contact.upper;
    errors.wrong_bounds += holds ? 0 : 1;
    errors.error = std::max(errors.error, std::abs(contact.distance - gap));
    errors.bound = std::max(errors.bound, 0.5 * (contact.upper - contact.lower));
  }
}

/// Counts contacts that are not reported.
void add_missing(std::size_t count, bool is_complete, AnswerErrors& errors) {
  (is_complete ? errors.missed : errors.cut_off) += count;
}

/// A contact that should be reported and is not, or the other way round.
void add_wrong_decision(double margin, double gap, AnswerErrors& errors) {
  errors.decision_error = std::max(errors.decision_error, std::abs(margin - gap));
}

void check_pairs(const QueryOptions& options, const QueryResult& answer, const QueryResult& exact,
                 AnswerErrors& errors) {
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
  add_missing(missing.size(), answer.complete, errors);
  for (const std::vector<Contact>* wrong : {&missing, &extra}) {
    for (const Contact& contact : *wrong) {
      add_wrong_decision(options.margin, contact.distance, errors);
    }
  }
}

/// Errors of the k-th smallest distances. The pairs that have them may be others.
void check_limited(const QueryOptions& options, const QueryResult& answer, const QueryResult& exact,
                   AnswerErrors& errors) {
  const auto sorted = [](std::vector<Contact> contacts) {
    sort_by_distance(contacts);
    return contacts;
  };
  const std::vector<Contact> found = sorted(answer.contacts);
  const std::vector<Contact> expected = sorted(exact.contacts);
  errors.expected = expected.size();
  for (std::size_t k = 0; k < std::max(found.size(), expected.size()); ++k) {
    if (k >= found.size()) {
      add_missing(1, answer.complete, errors);
      add_wrong_decision(options.margin, expected[k].distance, errors);
    } else if (k >= expected.size()) {
      ++errors.extra;
      add_wrong_decision(options.margin, found[k].distance, errors);
    } else {
      errors.error = std::max(errors.error, found[k].distance - expected[k].distance);
    }
  }
}

/// Whether there is a contact. Which one is reported depends on the engine.
void check_first(const QueryOptions& options, const QueryResult& answer, const QueryResult& exact,
                 AnswerErrors& errors) {
  errors.expected = exact.contacts.size();
  if (answer.contacts.empty() && !exact.contacts.empty()) {
    add_missing(1, answer.complete, errors);
    add_wrong_decision(options.margin, exact.contacts.front().distance, errors);
  } else if (!answer.contacts.empty() && exact.contacts.empty()) {
    ++errors.extra;
    add_wrong_decision(options.margin, answer.contacts.front().distance, errors);
  }
}

/// Errors of the smallest distance. The pair that has it may be another one.
void check_minimum(const QueryOptions& options, const QueryResult& answer, const QueryResult& exact,
                   AnswerErrors& errors) {
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
  if (answer.contacts.empty()) {
    errors.cut_off = 1;
    add_wrong_decision(options.margin, closest->distance, errors);
    return;
  }
  errors.error = std::max(0.0, answer.closest()->distance - closest->distance);
  errors.bound = answer.closest()->distance - lower;
}

auto fibers_of(const Contact& contact) { return std::make_pair(contact.fiber_a, contact.fiber_b); }

/// Errors of each pair of fibres. The segments that are closest may be others.
/// @param error_of of a reported distance and the true one [m]
template <class ErrorOf>
void check_fiber_pairs(const QueryOptions& options, const QueryResult& answer,
                       const QueryResult& exact, const ErrorOf& error_of, AnswerErrors& errors) {
  const auto by_fibers = [](const Contact& x, const Contact& y) {
    return fibers_of(x) < fibers_of(y);
  };
  const auto sorted = [&](std::vector<Contact> contacts) {
    std::sort(contacts.begin(), contacts.end(), by_fibers);
    return contacts;
  };
  const std::vector<Contact> found = sorted(answer.contacts);
  const std::vector<Contact> expected = sorted(exact.contacts);
  const auto same_fibers = [&](const std::vector<Contact>& contacts, const Contact& contact) {
    const auto same = std::lower_bound(contacts.begin(), contacts.end(), contact, by_fibers);
    return same != contacts.end() && fibers_of(*same) == fibers_of(contact) ? &*same : nullptr;
  };
  errors.expected = expected.size();
  for (const Contact& closest : expected) {
    const Contact* const same = same_fibers(found, closest);
    if (same == nullptr) {
      add_missing(1, answer.complete, errors);
      add_wrong_decision(options.margin, closest.distance, errors);
    } else {
      errors.error = std::max(errors.error, error_of(same->distance, closest.distance));
    }
  }
  for (const Contact& contact : found) {
    if (same_fibers(expected, contact) == nullptr) {
      ++errors.extra;
      add_wrong_decision(options.margin, contact.distance, errors);
    }
  }
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
  decision_error = std::max(decision_error, other.decision_error);
}

double AnswerErrors::found_part() const {
  const auto missing = static_cast<double>(missed + cut_off);
  return expected == 0 ? 1.0 : 1.0 - missing / static_cast<double>(expected);
}

AnswerErrors answer_errors(const FiberAssembly& fibers, const QueryOptions& options,
                           const QueryResult& answer, const QueryResult& exact,
                           std::size_t max_checked) {
  AnswerErrors errors;
  if (options.type == QueryType::CLOSEST) {
    check_minimum(options, answer, exact, errors);
    return errors;
  }
  check_contacts(fibers, answer.contacts, exact.contacts, max_checked, errors);
  switch (options.type) {
    case QueryType::FIBER_PAIRS:
      check_fiber_pairs(
          options, answer, exact, [](double found, double least) { return found - least; }, errors);
      errors.bound += options.tolerance;
      break;
    case QueryType::LIMITED:
      check_limited(options, answer, exact, errors);
      errors.bound += options.tolerance;
      break;
    case QueryType::FIRST:
      check_first(options, answer, exact, errors);
      break;
    default:
      check_pairs(options, answer, exact, errors);
      break;
  }
  return errors;
}

AnswerErrors resampled_errors(const QueryOptions& options, const QueryResult& answer,
                              const QueryResult& exact) {
  AnswerErrors errors;
  const auto difference = [](double x, double y) { return std::abs(x - y); };
  if (options.type == QueryType::FIBER_PAIRS) {
    check_fiber_pairs(options, answer, exact, difference, errors);
    return errors;
  }
  check_minimum(options, answer, exact, errors);
  errors.wrong_bounds = 0;
  errors.bound = 0.0;
  if (errors.expected > 0 && !answer.contacts.empty()) {
    errors.error = difference(answer.closest()->distance, exact.closest()->distance);
  }
  return errors;
}

}  // namespace fiber
