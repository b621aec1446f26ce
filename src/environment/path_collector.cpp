#include "src/environment/path_collector.hpp"

#include <algorithm>
#include <limits>

namespace fiber {
namespace {

std::size_t most_of_path(const MotionOptions& options) {
  std::size_t most = options.contact_limit;
  if (options.type != MotionType::ALL) {
    const std::size_t asked = options.type == MotionType::FIRST ? 1 : options.max_contacts;
    most = most == 0 ? asked : std::min(most, asked);
  }
  return most;
}

}  // namespace

PathCollector::PathCollector(const MotionOptions& options, PathContacts& contacts)
    : options_(options), most_(most_of_path(options)), contacts_(contacts) {
  contacts_.contacts.clear();
  contacts_.limit_reached = false;
  contacts_.complete = true;
}

MotionOptions PathCollector::options() const {
  MotionOptions options = options_;
  options.type = MotionType::ALL;
  // Some of what a step finds are pairs that met before: so many more are needed.
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max();
  options.contact_limit =
      static_cast<std::uint32_t>(most_ == 0 ? 0 : std::min(most_ + seen_.size(), largest));
  return options;
}

void PathCollector::take(const MotionResult& found, std::size_t step, const Report& report) {
  const auto begin = static_cast<double>(step);
  for (const auto* list : {&found.touching, &found.contacts}) {
    for (const MotionContact& contact : *list) {
      if (seen_.insert(contact.key()).second) {
        contacts_.contacts.push_back({contact, report(contact)});
        contacts_.contacts.back().when.lower += begin;
        contacts_.contacts.back().when.upper += begin;
      }
    }
  }
  contacts_.complete = contacts_.complete && found.complete;
  const bool is_cut_short = found.limit_reached && !found.complete;  // not for too many contacts
  contacts_.limit_reached = contacts_.limit_reached || is_cut_short ||
                            (found.limit_reached && options_.type != MotionType::FIRST);
}

void PathCollector::finish() {
  std::vector<PathContact>& contacts = contacts_.contacts;
  const bool are_more = has_left_out_ || (most_ > 0 && contacts.size() > most_);
  contacts_.limit_reached =
      contacts_.limit_reached || (are_more && options_.type != MotionType::FIRST);
  if (most_ > 0 && contacts.size() > most_) {
    std::sort(contacts.begin(), contacts.end(), [](const PathContact& x, const PathContact& y) {
      return x.when.earlier_than(y.when);
    });
    contacts.resize(most_);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const PathContact& x, const PathContact& y) { return x.when.key() < y.when.key(); });
}

}  // namespace fiber
