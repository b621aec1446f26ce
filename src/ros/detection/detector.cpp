#include "src/ros/detection/detector.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "fiber_proximity/query/options.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

void Detection::fail(const std::string& reason) {
  *this = Detection();
  complete_ = false;
  failure_ = reason;
  minimum_lower_ = -std::numeric_limits<double>::infinity();
}

void Detection::detect(const fiber::QueryOptions& options, bool wants_minimum,
                       const Uncertainty& uncertainty, const Ask& ask) {
  failure_.clear();
  const Stopwatch stopwatch;
  const fiber::Deadline deadline(options.deadline);
  const bool leaves_out = query_possible(options, uncertainty, ask, contacts_);
  counts_ = contacts_.counts;
  complete_ = contacts_.complete;
  limit_reached_ = contacts_.limit_reached;
  // The first contact found need not be the closest, nor need one be that is possible.
  const bool tells_minimum = options.type != fiber::QueryType::FIRST && !leaves_out;
  minimum_ = tells_minimum ? contacts_.closest() : nullptr;
  minimum_lower_ = contacts_.minimum_lower();
  minimum_complete_ = contacts_.complete;
  contact_time_ = stopwatch.seconds();
  if (minimum_ == nullptr && wants_minimum) {
    fiber::QueryOptions closest = options;
    closest.type = fiber::QueryType::CLOSEST;
    closest.margin = std::numeric_limits<double>::infinity();
    closest.deadline = deadline.left();
    query_possible(closest, uncertainty, ask, closest_);
    complete_ = complete_ && closest_.complete;
    limit_reached_ = limit_reached_ || closest_.limit_reached;
    minimum_ = closest_.closest();
    minimum_complete_ = closest_.complete;
    minimum_lower_ = uncertainty.is_none() ? closest_.minimum_lower()
                                           : std::max(minimum_lower_, closest_.minimum_lower());
    counts_ += closest_.counts;
  }
  minimum_upper_ = minimum_ == nullptr ? std::numeric_limits<double>::infinity() : minimum_->upper;
  uncertain_contacts_ = 0;
  if (!uncertainty.is_none()) {
    // A pair that is told to be further apart may be known better.
    for (const fiber::Contact& contact : contacts_.contacts) {
      minimum_upper_ = std::min(minimum_upper_, contact.upper);
      uncertain_contacts_ += is_certain(contact, options.margin) ? 0 : 1;
    }
  }
  minimum_time_ = stopwatch.seconds() - contact_time_;
}

std::string Detection::limit_problem(const fiber::QueryOptions& options) const {
  const std::size_t count = contacts_.contacts.size();
  // Where bodies are uncertain, impossible pairs have counted, too.
  const bool all_contacts =
      options.contact_limit > 0 && (count == options.contact_limit || complete_);
  const bool of_limited =
      options.type == fiber::QueryType::LIMITED && complete_ && count == options.max_contacts;
  if (!limit_reached_ || of_limited) {
    return "";
  }
  std::ostringstream text;
  text << "of the pairs within the margin of " << options.margin << " m ";
  if (all_contacts) {
    text << "the closest " << count << " are reported, as contact_limit says";
  }
  if (!complete_ && (options.deadline == 0.0 || !all_contacts)) {
    text << (all_contacts ? ", and only those among" : "only those are reported that are among")
         << " the first " << options.pair_limit << " that came up, as pair_limit says";
  }
  text << "; a smaller margin or radius leaves fewer pairs, query_type limited or fiber_pairs "
          "reports fewer of them; higher limits cost time and memory";
  return text.str();
}

std::string cut_off_text(const std::string& pairs, const fiber::PairOptions& options) {
  std::ostringstream text;
  text << pairs << ": not all have been looked at, as";
  if (options.deadline > 0.0) {
    text << " the deadline of " << options.deadline << " s";
  }
  if (options.pair_limit > 0) {
    text << (options.deadline > 0.0 ? " or" : "") << " pair_limit, " << options.pair_limit << ",";
  }
  text << " came first";
  return text.str();
}

std::string no_time_text(const fiber::PairOptions& options) {
  std::ostringstream text;
  text << "the deadline of " << options.deadline << " s leaves no time for it";
  return text.str();
}

std::string Detection::cut_off(const fiber::QueryOptions& options) const {
  if (complete_) {
    return "";
  }
  return failure_.empty() ? cut_off_text("pairs of segments", options) : failure_;
}

double Detection::contact_error() const {
  double error = 0.0;
  for (const fiber::Contact& contact : contacts_.contacts) {
    error = std::max({error, contact.upper - contact.distance, contact.distance - contact.lower});
  }
  return error;
}

const fiber::ProximityEngine& Detector::engine() {
  if (new_fibers_ != nullptr) {
    const Stopwatch stopwatch;
    engine_->update(*new_fibers_);
    new_fibers_ = nullptr;  // only now: fibres the engine refuses are refused whenever it is asked
    update_time_ = stopwatch.seconds();
  }
  return *engine_;
}

void Detector::detect(const fiber::QueryOptions& options, bool wants_minimum, Budget& budget) {
  try {
    update_time_ = 0.0;
    const fiber::ProximityEngine& updated = engine();
    budget.ask(options, [&](const fiber::QueryOptions& in_time) {
      detection_.detect(in_time, wants_minimum, uncertainty_,
                        [&](const fiber::QueryOptions& asked, fiber::QueryResult& result) {
                          updated.query(asked, result);
                        });
    });
  } catch (const std::invalid_argument& error) {
    detection_.fail(error.what());
    throw;
  }
}

}  // namespace fiber_proximity_ros
