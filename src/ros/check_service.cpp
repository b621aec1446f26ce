#include "fiber_proximity/ros/check_service.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/geometry/select_fibers.hpp"
#include "fiber_proximity/query/deadline.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/request_options.hpp"

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

std::vector<fiber::FiberAssembly> to_assemblies(const CheckFibers::Request& request,
                                                const FixedFrame& frame) {
  std::vector<fiber::FiberAssembly> candidates;
  candidates.reserve(request.candidates.size());
  for (std::size_t i = 0; i < request.candidates.size(); ++i) {
    candidates.push_back(naming("candidate " + std::to_string(i),
                                [&] { return to_assembly(request.candidates[i], frame); }));
  }
  return candidates;
}

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
  PresentFibers(const QueryTarget& target, const std::vector<std::string>& names,
                const std::vector<std::string>& replaced) {
    for (const std::string& name : replaced) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw std::invalid_argument("there is no fibre '" + name + "' to be replaced");
      }
    }
    for (std::uint32_t i = 0; i < target.fibers.fiber_count(); ++i) {
      if (std::find(replaced.begin(), replaced.end(), names[i]) == replaced.end()) {
        kept_.push_back(i);
      }
    }
    engine_ = &target.engine;
    if (!replaced.empty()) {
      others_ = fiber::select_fibers(target.fibers, kept_);
      engine_of_others_ = fiber::make_engine("run_tree");
      engine_of_others_->update(others_);
      engine_ = engine_of_others_.get();
    }
  }

  const fiber::ProximityEngine& engine() const { return *engine_; }
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
            const std::vector<std::string>& names, const FindAllowed& find_allowed,
            CheckFibers::Response& response) {
  fiber::QueryOptions options = validated_options(request, target.defaults);
  const fiber::Deadline deadline(options.deadline);
  std::vector<fiber::FiberAssembly> candidates = to_assemblies(request, target.frame);
  const PresentFibers present(target, names, request.replaced_fibers);
  fiber::Surroundings surroundings;
  surroundings.fibers = request.ignore_fibers ? nullptr : &present.engine();
  surroundings.environment = request.ignore_environment ? nullptr : &target.environment;
  surroundings.self = !request.ignore_self;
  response.offsets.push_back(0);
  std::vector<fiber::FiberCheck> checks;
  // At once those of the same names in a row, which may touch the same: mostly all.
  for (std::size_t begin = 0, end = 0; begin < candidates.size(); begin = end) {
    const std::vector<std::string>& fiber_names = request.candidates[begin].names;
    while (end < candidates.size() && request.candidates[end].names == fiber_names) {
      ++end;
    }
    surroundings.allowed = find_allowed(fiber_names);
    options.deadline = deadline.left();
    const auto at = [&](std::size_t i) {
      return std::make_move_iterator(candidates.begin() + static_cast<std::ptrdiff_t>(i));
    };
    check_fibers({at(begin), at(end)}, surroundings, options, checks);
    for (const fiber::FiberCheck& check : checks) {
      append(check, present, response);
    }
  }
}

}  // namespace fiber_proximity_ros
