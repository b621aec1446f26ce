#include "fiber_proximity/ros/check_service.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/geometry/select_fibers.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/request_options.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;

fiber::FiberAssembly to_assembly(const fiber_proximity::FiberArray& message,
                                 const FixedFrame& frame) {
  ChainSet chains;
  to_chains(message, chains);
  if (chains.radii.empty()) {
    throw std::invalid_argument("has no radii, it needs one, one per fibre or one per point");
  }
  fiber::FiberAssembly fibers;
  assign(chains, fibers);
  if (chains.header.frame_id.empty()) {
    chains.header.frame_id = frame.name();
  }
  frame.place(chains.header, fibers, chains.points);
  return fibers;
}

/// A candidate is held against itself, fibres and objects.
constexpr std::size_t queries_per_candidate = 3;

/// Candidates of a request that are checked at once: those of the same names in a row, which may
/// touch the same, and not so many that it takes long to see that a deadline has come.
class Block {
 public:
  static constexpr std::size_t most_candidates = 256;

  /// Reads the block that begins at this candidate.
  Block(const CheckFibers::Request& request, std::size_t begin, const QueryTarget& target)
      : names_(request.candidates[begin].names) {
    const std::size_t end = std::min(request.candidates.size(), begin + most_candidates);
    for (std::size_t i = begin;
         i < end && request.candidates[i].names == names_ && !(i > begin && target.is_time_up());
         ++i) {
      candidates_.push_back(naming("candidate " + std::to_string(i), [&] {
        return to_assembly(request.candidates[i], target.frame);
      }));
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<fiber::FiberAssembly>& candidates() const { return candidates_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<fiber::FiberAssembly> candidates_;
};

fiber::QueryOptions validated_options(const CheckFibers::Request& request,
                                      const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options = to_options(request, defaults);
  options.neighbour_skip = defaults.neighbour_skip;
  options.neighbour_skip_length = defaults.neighbour_skip_length;
  fiber::validate(options);
  return options;
}

/// The fibres that are checked against: all, or all but those that are replaced.
class PresentFibers {
 public:
  PresentFibers(const QueryTarget& target, const std::vector<std::string>& replaced) {
    const std::vector<std::string>& names = target.fiber_names;
    for (const std::string& name : replaced) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw std::invalid_argument("there is no fibre " + fiber::quote(name) + " to be replaced");
      }
    }
    for (std::uint32_t i = 0; i < target.fibers.fiber_count(); ++i) {
      if (std::find(replaced.begin(), replaced.end(), names[i]) == replaced.end()) {
        kept_.push_back(i);
      }
    }
    engine_ = target.engine;
    if (!replaced.empty()) {
      others_ = fiber::select_fibers(target.fibers, kept_);
      engine_of_others_ = fiber::make_engine("run_tree");
      engine_of_others_->update(others_);
      engine_ = engine_of_others_.get();
    }
  }

  const fiber::ProximityEngine* engine() const { return engine_; }
  std::uint32_t index_of(std::uint32_t fiber) const { return kept_[fiber]; }

 private:
  std::vector<std::uint32_t> kept_;
  fiber::FiberAssembly others_;
  std::unique_ptr<fiber::ProximityEngine> engine_of_others_;
  const fiber::ProximityEngine* engine_ = nullptr;
};

void append(const fiber::QueryResult& result, std::uint8_t body_b,
            CheckFibers::Response& response) {
  for (const fiber::Contact& contact : result.contacts) {
    Contact message;
    to_message(contact, Contact::CANDIDATE, body_b, message);
    response.contacts.push_back(message);
  }
}

void append(const fiber::FiberCheck& check, const PresentFibers& present,
            CheckFibers::Response& response) {
  response.free.push_back(check.is_free());
  response.complete.push_back(check.is_complete());
  response.limit_reached = response.limit_reached || check.is_limit_reached();
  append(check.self, Contact::CANDIDATE, response);
  const std::size_t first = response.contacts.size();
  append(check.fibers, Contact::FIBER, response);
  for (std::size_t i = first; i < response.contacts.size(); ++i) {
    response.contacts[i].fiber_b = present.index_of(response.contacts[i].fiber_b);
  }
  append(check.environment, Contact::OBJECT, response);
  response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
}

}  // namespace

void answer(const CheckFibers::Request& request, const QueryTarget& target,
            const FindAllowed& find_allowed, CheckFibers::Response& response) {
  fiber::QueryOptions options = validated_options(request, target.defaults);
  // Without fibres to check against, none are to be replaced.
  const PresentFibers present(
      target, request.ignore_fibers ? std::vector<std::string>() : request.replaced_fibers);
  fiber::Surroundings surroundings;
  surroundings.fibers = request.ignore_fibers ? nullptr : present.engine();
  surroundings.environment = request.ignore_environment ? nullptr : &target.environment;
  surroundings.self = !request.ignore_self;
  const std::size_t count = request.candidates.size();
  response.offsets.push_back(0);
  std::vector<fiber::FiberCheck> checks;
  while (response.free.size() < count && !target.is_time_up()) {
    const Block block(request, response.free.size(), target);
    surroundings.allowed = find_allowed(block.names());
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(),
                          queries_per_candidate * block.candidates().size());
    check_fibers(block.candidates(), surroundings, options, checks);
    for (const fiber::FiberCheck& check : checks) {
      append(check, present, response);
    }
  }
  // Nothing is known to touch the candidates that the deadline came before.
  response.free.resize(count, 1);
  response.complete.resize(count, 0);
  response.offsets.resize(count + 1, response.offsets.back());
}

}  // namespace fiber_proximity_ros
