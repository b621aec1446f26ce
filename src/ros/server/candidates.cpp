#include "src/ros/server/candidates.hpp"

#include <algorithm>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {

fiber::FiberAssembly to_candidate(const fiber_proximity::FiberArray& message,
                                  const FixedFrame& frame) {
  FiberBuffer chains;
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

void leave_unread(std::size_t count, fiber_proximity::CheckFibers::Response& response) {
  response.free.resize(count, 1);
  response.complete.resize(count, 0);
  response.offsets.resize(count + 1, response.offsets.back());
}

PresentFibers::PresentFibers(const QueryTarget& target,
                             const fiber_proximity::CheckFibers::Request& request) {
  surroundings_.environment = request.ignore_environment != 0 ? nullptr : &target.environment;
  surroundings_.self = request.ignore_self == 0;
  if (request.ignore_fibers == 0) {
    leave_out(target, request.replaced_fibers);
  }
}

void PresentFibers::leave_out(const QueryTarget& target, const std::vector<std::string>& replaced) {
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
  surroundings_.fibers = target.engine;
  if (!replaced.empty()) {
    others_ = fiber::select_fibers(target.fibers, kept_);
    engine_of_others_ = fiber::make_engine("run_tree");
    engine_of_others_->update(others_);
    surroundings_.fibers = engine_of_others_.get();
  }
}

void PresentFibers::number_as_all(std::size_t first,
                                  fiber_proximity::CheckFibers::Response& response) const {
  for (std::size_t i = first; i < response.contacts.size(); ++i) {
    response.contacts[i].fiber_b = kept_[response.contacts[i].fiber_b];
  }
}

}  // namespace fiber_proximity_ros
