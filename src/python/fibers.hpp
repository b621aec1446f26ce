#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/python/arrays.hpp"
#include "src/python/shared.hpp"

namespace fiber::python {

/// Fibres that Python moves. Each state of them is an assembly that does not change while anybody
/// holds it, an engine or an array that shows its points, whatever other threads do; so nothing
/// that Python does to an array or to these fibres reaches a query that runs.
class Fibers : public OnlyShared {
 public:
  using State = std::shared_ptr<const FiberAssembly>;

  explicit Fibers(FiberAssembly fibers, FiberNames names = {})
      : names_(std::move(names)), state_(std::make_shared<FiberAssembly>(std::move(fibers))) {}

  FiberNames names() const;
  void rename(FiberNames names);

  /// The newest one.
  State state() const;

  /// Makes a state of these rows of three [m], in the memory of one that nobody holds any more:
  /// they are copied once. Without Python's lock.
  /// @throws std::invalid_argument as FiberAssembly::update_points(); the newest state stays then
  void move(const double* rows, std::size_t count);

 private:
  std::mutex moving_;          // one move at a time
  mutable std::mutex newest_;  // guards state_ and names_
  FiberNames names_;
  std::shared_ptr<FiberAssembly> state_;
  std::shared_ptr<FiberAssembly> spare_;
  std::vector<Eigen::Vector3d> incoming_;
};

/// The newest state of an argument that must be Fibers.
/// @throws py::type_error naming it
Fibers::State to_state(const py::object& object, const char* name);

/// @throws std::invalid_argument for a segment that there is not
void require_segment(const FiberAssembly& fibers, std::uint32_t fiber, std::uint32_t segment);

}  // namespace fiber::python
