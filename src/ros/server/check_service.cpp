#include "src/ros/server/check_service.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/uncertainty.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/server/query_options.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;

/// A candidate is held against itself, fibres and objects.
constexpr std::size_t queries_per_candidate = 3;

/// So many are checked at once, that it does not take long to see that a deadline has come.
constexpr std::size_t max_candidates = 256;

/// Must be validated yet.
fiber::QueryOptions options_of_candidates(const CheckFibers::Request& request,
                                          const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options = to_options(request, defaults);
  options.neighbour_skip = defaults.neighbour_skip;
  options.neighbour_skip_length = defaults.neighbour_skip_length;
  return options;
}

fiber::MotionOptions options_of_motions(const CheckFibers::Request& request,
                                        const fiber::QueryOptions& defaults) {
  constexpr double usual_tolerance = 1e-6;  // [m]
  const fiber::QueryOptions options = options_of_candidates(request, defaults);
  if (options.type == fiber::QueryType::CLOSEST || options.type == fiber::QueryType::FIBER_PAIRS) {
    throw std::invalid_argument("type is " + std::to_string(request.type) +
                                ", of motions it must be 0 (FIRST), 2 (LIMITED) or 3 (ALL)");
  }
  const double tolerance = request.motion_tolerance;
  if (!(tolerance >= 0.0 && std::isfinite(tolerance))) {
    throw std::invalid_argument("motion_tolerance is " + std::to_string(tolerance) +
                                " m, it must be finite and at least 0");
  }
  fiber::validate(options);
  return fiber::motion_options(options, tolerance > 0.0 ? tolerance : usual_tolerance);
}

/// @throws std::invalid_argument unless they say which candidates are the states of which motion
void validate_waypoints(const CheckFibers::Request& request) {
  const auto refuse = [](const std::string& what) {
    throw std::invalid_argument("waypoint_offsets " + what);
  };
  const std::vector<std::uint32_t>& offsets = request.waypoint_offsets;
  if (offsets.front() != 0) {
    refuse("begins with " + std::to_string(offsets.front()) + ", it must begin with 0");
  }
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    if (offsets[i + 1] < offsets[i] + std::uint64_t{2}) {
      refuse("has " + std::to_string(offsets[i + 1]) + " behind " + std::to_string(offsets[i]) +
             ": motion " + std::to_string(i) + " needs at least 2 states");
    }
  }
  if (offsets.back() != request.candidates.size()) {
    refuse("ends with " + std::to_string(offsets.back()) +
           ", it must end with the number of candidates, " +
           std::to_string(request.candidates.size()));
  }
}

/// Hypothetical fibres of a request in the fixed frame.
/// @throws std::invalid_argument for fibres that are none, or have no radii
/// @throws TransformUnavailable
fiber::FiberAssembly to_candidate(const fiber_proximity::FiberArray& message,
                                  const FixedFrame& frame) {
  FiberBuffer buffer;
  to_chains(message, buffer);
  if (buffer.radii.empty()) {
    throw std::invalid_argument("has no radii, it needs one, one per fibre or one per point");
  }
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  if (buffer.header.frame_id.empty()) {
    buffer.header.frame_id = frame.name();
  }
  frame.place(buffer.header, fibers);
  return fibers;
}

fiber::FiberPath read_motion(const CheckFibers::Request& request, std::size_t motion,
                             const FixedFrame& frame) {
  fiber::FiberPath path;
  const std::size_t begin = request.waypoint_offsets[motion];
  for (std::size_t i = begin; i < request.waypoint_offsets[motion + 1]; ++i) {
    const std::string where = "motion " + std::to_string(motion) + ", state " +
                              std::to_string(i - begin) + " (candidate " + std::to_string(i) + ")";
    naming(where, [&] {
      path.push_back(to_candidate(request.candidates[i], frame));
      fiber::require_same_topology(path.front(), path.back());
      if (request.candidates[i].names != request.candidates[begin].names) {
        throw std::invalid_argument("has other names than the motion's first state");
      }
    });
  }
  return path;
}

/// The fibres that candidates are checked against: all, or all but those that they stand in for.
/// Where they are uncertain, candidates are checked against fibres that enclose the true ones.
class PresentFibers {
 public:
  /// Refers to the target. With ignore_fibers there are none, and none are to be replaced.
  /// @throws std::invalid_argument for a fibre to be replaced that there is not, or of whose name
  ///         there are several
  PresentFibers(const QueryTarget& target, const CheckFibers::Request& request) {
    surroundings_.environment = request.ignore_environment != 0 ? nullptr : &target.environment;
    surroundings_.self = request.ignore_self == 0;
    if (request.ignore_fibers == 0) {
      leave_out(target, request.replaced_fibers);
    }
  }

  /// The bodies that candidates of the request are checked against, without the allowed pairs.
  const fiber::Surroundings& surroundings() const { return surroundings_; }

  /// The index among all fibres of the node of one that is present.
  std::uint32_t number_among_all(std::uint32_t fiber) const { return kept_[fiber]; }

  /// [m] How far the true points of one that is present may be from the told ones.
  double uncertainty(std::uint32_t fiber) const {
    return uncertainties_.empty() ? 0.0 : uncertainties_[fiber];
  }

 private:
  void leave_out(const QueryTarget& target, const std::vector<std::string>& replaced) {
    const std::vector<std::string>& names = target.scene.fibers.names();
    for (const std::string& name : replaced) {
      const auto count = std::count(names.begin(), names.end(), name);
      if (count == 0) {
        throw std::invalid_argument("there is no fibre " + fiber::quote(name) + " to be replaced");
      }
      if (count > 1) {
        throw std::invalid_argument("which of the " + std::to_string(count) +
                                    " fibres with the name " + fiber::quote(name) +
                                    " is to be replaced is not known: each must have its own");
      }
    }
    for (std::uint32_t i = 0; i < target.fibers.fiber_count(); ++i) {
      if (std::find(replaced.begin(), replaced.end(), names[i]) == replaced.end()) {
        kept_.push_back(i);
      }
    }
    surroundings_.fibers = target.engine;
    const std::vector<double>& uncertainties = target.scene.fibers.uncertainties();
    if (!replaced.empty() || !uncertainties.empty()) {
      others_ = fiber::select_fibers(target.fibers, kept_);
      if (!uncertainties.empty()) {
        for (const std::uint32_t fiber : kept_) {
          uncertainties_.push_back(uncertainties[fiber]);
        }
        others_ = enclosing_fibers(others_, uncertainties_);
      }
      engine_of_others_ = fiber::make_engine("run_tree");
      engine_of_others_->update(others_);
      surroundings_.fibers = engine_of_others_.get();
    }
  }

  std::vector<std::uint32_t> kept_;
  std::vector<double> uncertainties_;  // [m] by fibre that is kept; empty: none is uncertain
  fiber::FiberAssembly others_;
  std::unique_ptr<fiber::ProximityEngine> engine_of_others_;
  fiber::Surroundings surroundings_;
};

std::uint32_t fiber_b_of(const fiber::Contact& contact) { return contact.fiber_b; }
std::uint32_t fiber_b_of(const fiber::PathContact& contact) { return contact.where.fiber_b; }

/// Writes a contact whose body b has this uncertainty.
/// @returns whether the pair is certain to be in contact
bool append(const fiber::Contact& contact, double uncertainty, std::uint8_t body_b, double margin,
            CheckFibers::Response& response) {
  const fiber::Contact told = told_contact(contact, uncertainty);
  Contact& message = response.contacts.emplace_back();
  to_message(told, Contact::CANDIDATE, body_b, message);
  message.certain = is_certain(told, margin);
  return uncertainty == 0.0 || message.certain != 0;
}

bool append(const fiber::PathContact& contact, double uncertainty, std::uint8_t body_b,
            double margin, CheckFibers::Response& response) {
  const bool is_known = append(contact.where, uncertainty, body_b, margin, response);
  response.contacts.back().certain =
      is_known && (contact.when.certain || response.contacts.back().certain != 0);
  response.time_lower.push_back(contact.when.lower);
  // A contact that is only possible has no time at which it is certain.
  response.time_upper.push_back(is_known ? contact.when.upper
                                         : std::numeric_limits<double>::infinity());
  return is_known;
}

/// @param present the fibres that bodies b are; null for other bodies
/// @returns whether one of the pairs is certain to be in contact
template <class Found>
bool append(const Found& found, std::uint8_t body_b, const PresentFibers* present, double margin,
            CheckFibers::Response& response) {
  bool is_any_certain = false;
  for (const auto& contact : found.contacts) {
    const std::uint32_t b = fiber_b_of(contact);
    const double uncertainty = present == nullptr ? 0.0 : present->uncertainty(b);
    is_any_certain = append(contact, uncertainty, body_b, margin, response) || is_any_certain;
    if (present != nullptr) {
      response.contacts.back().fiber_b = present->number_among_all(b);
    }
  }
  return is_any_certain;
}

/// @param check         a fiber::FiberCheck or fiber::MotionCheck
/// @param was_all_there whether there was all that it was to be checked against
template <class Check>
void append(const Check& check, const PresentFibers& present, bool was_all_there, double margin,
            CheckFibers::Response& response) {
  bool has_contact = append(check.self, Contact::CANDIDATE, nullptr, margin, response);
  has_contact = append(check.fibers, Contact::FIBER, &present, margin, response) || has_contact;
  has_contact =
      append(check.environment, Contact::OBJECT, nullptr, margin, response) || has_contact;
  response.free.push_back(check.is_free() && was_all_there);
  response.decided.push_back(has_contact || response.free.back() != 0);
  response.complete.push_back(check.is_complete() && was_all_there);
  response.limit_reached = response.limit_reached || check.is_limit_reached();
  response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
}

/// How completely the bodies are known that the candidates of a request are checked against.
Completeness surroundings_known(const CheckFibers::Request& request, const Knowledge& knowledge) {
  using About = Knowledge::About;
  const bool fibers = request.ignore_fibers == 0;
  const bool environment = request.ignore_environment == 0;
  if (!fibers && !environment) {
    return {};
  }
  return knowledge.completeness(fibers ? environment ? About::FIBERS_AND_ENVIRONMENT : About::FIBERS
                                       : About::ENVIRONMENT);
}

/// Answers for candidates or motions. At once those of the same names in a row are checked, which
/// may touch the same.
/// @param offsets of each one's states among the candidates of the request
/// @param read    reads the one of an index
/// @param check   fiber::check_fibers or fiber::check_motions
template <class Item, class Options, class Check, class Read>
void answer_all(const CheckFibers::Request& request, const QueryTarget& target,
                const std::vector<std::uint32_t>& offsets, Options options, const Read& read,
                void (*check)(const std::vector<Item>&, const fiber::Surroundings&, const Options&,
                              std::vector<Check>&),
                CheckFibers::Response& response) {
  const PresentFibers present(target, request);
  Completeness known = surroundings_known(request, target.scene.knowledge);
  bool is_cut_off = false;
  fiber::Surroundings surroundings = present.surroundings();
  const std::size_t count = offsets.size() - 1;
  response.offsets.push_back(0);
  std::vector<Check> checks;
  while (response.free.size() < count && !target.is_time_up()) {
    const std::size_t begin = response.free.size();
    const std::vector<std::string>& names = request.candidates[offsets[begin]].names;
    const auto is_next = [&](std::size_t i) {
      return i == begin || (offsets[i + 1] - offsets[begin] <= max_candidates &&
                            request.candidates[offsets[i]].names == names && !target.is_time_up());
    };
    std::vector<Item> items;
    for (std::size_t i = begin; i < count && is_next(i); ++i) {
      items.push_back(read(i));
    }
    surroundings.allowed = target.scene.environment.allowed(names);
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(),
                          queries_per_candidate * items.size());
    check(items, surroundings, options, checks);
    for (const Check& each : checks) {
      append(each, present, known.was_all_there(), options.margin, response);
      is_cut_off = is_cut_off || !each.is_complete();
    }
  }
  if (is_cut_off || response.free.size() < count) {
    options.deadline = request.deadline;
    known.add_cut_off(cut_off_text("pairs of candidates", options));
  }
  response.unknown = known.unknown();
  // Nothing is known of those that the deadline came before.
  response.free.resize(count, 0);
  response.decided.resize(count, 0);
  response.complete.resize(count, 0);
  response.offsets.resize(count + 1, response.offsets.back());
}

}  // namespace

void answer(const CheckFibers::Request& request, const QueryTarget& target,
            CheckFibers::Response& response) {
  if (request.waypoint_offsets.empty()) {
    const fiber::QueryOptions options = options_of_candidates(request, target.defaults);
    fiber::validate(options);
    std::vector<std::uint32_t> offsets(request.candidates.size() + 1);
    std::iota(offsets.begin(), offsets.end(), 0);
    const auto read = [&](std::size_t i) {
      return naming("candidate " + std::to_string(i), [&] {
        return to_candidate(request.candidates[i], target.scene.fibers.frame());
      });
    };
    answer_all(request, target, offsets, options, read, &fiber::check_fibers, response);
  } else {
    const fiber::MotionOptions options = options_of_motions(request, target.defaults);
    validate_waypoints(request);
    const auto read = [&](std::size_t i) {
      return read_motion(request, i, target.scene.fibers.frame());
    };
    answer_all(request, target, request.waypoint_offsets, options, read, &fiber::check_motions,
               response);
  }
  if (request.gradients) {
    std::for_each(response.contacts.begin(), response.contacts.end(), add_gradients);
  }
}

}  // namespace fiber_proximity_ros
