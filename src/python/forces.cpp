#include "fiber_proximity/sim/forces.hpp"

#include "src/python/contacts.hpp"
#include "src/python/simulation.hpp"

namespace fiber::python {
namespace {

/// RodForces, as Python has it.
struct Forces : OnlyShared {
  explicit Forces(RodForces& forces);

  py::array tensions;
  py::array bending_moments;
  py::array twisting_moments;
  py::array contacts;
  py::array holds;
  py::array joints;
  py::array loads;
  py::array obstacles;
};

py::dtype contact_force_dtype() {
  using Force = RodForces::ContactForce;
  const Force force{};
  const auto at = [&](auto member) { return offset_of(force, member); };
  return make_dtype({{"fiber", "u4", at(&Force::rod)},
                     {"segment", "u4", at(&Force::edge)},
                     {"other_fiber", "u4", at(&Force::other_rod)},
                     {"other_segment", "u4", at(&Force::other_edge)},
                     {"object", "u4", at(&Force::object)},
                     {"point", "(3,)f8", at(&Force::point)},
                     {"normal_force", "(3,)f8", at(&Force::normal_force)},
                     {"friction_force", "(3,)f8", at(&Force::friction_force)}},
                    sizeof(Force));
}

py::dtype hold_force_dtype() {
  using Force = RodForces::HoldForce;
  const Force force{};
  const auto at = [&](auto member) { return offset_of(force, member); };
  return make_dtype({{"fiber", "u4", at(&Force::rod)},
                     {"node", "u4", at(&Force::node)},
                     {"point", "(3,)f8", at(&Force::point)},
                     {"force", "(3,)f8", at(&Force::force)},
                     {"moment", "(3,)f8", at(&Force::moment)},
                     {"lag", "f8", at(&Force::lag)},
                     {"max_force", "f8", at(&Force::max_force)}},
                    sizeof(Force));
}

py::dtype obstacle_force_dtype() {
  using Force = RodForces::ObstacleForce;
  const Force force{};
  const auto at = [&](auto member) { return offset_of(force, member); };
  return make_dtype({{"object", "u4", at(&Force::object)},
                     {"point", "(3,)f8", at(&Force::point)},
                     {"force", "(3,)f8", at(&Force::force)},
                     {"moment", "(3,)f8", at(&Force::moment)}},
                    sizeof(Force));
}

/// Binds forces and moments on nodes.
/// @param name of the member that counts these
template <class Force>
py::dtype node_force_dtype(const char* name, std::uint32_t Force::*member) {
  const Force force{};
  const auto at = [&](auto each) { return offset_of(force, each); };
  return make_dtype({{name, "u4", at(member)},
                     {"fiber", "u4", at(&Force::rod)},
                     {"node", "u4", at(&Force::node)},
                     {"point", "(3,)f8", at(&Force::point)},
                     {"force", "(3,)f8", at(&Force::force)},
                     {"moment", "(3,)f8", at(&Force::moment)}},
                    sizeof(Force));
}

Forces::Forces(RodForces& forces)
    : tensions(to_array(forces.tensions)),
      bending_moments(to_array(forces.bending_moments)),
      twisting_moments(to_array(forces.twisting_moments)),
      contacts(to_array(contact_force_dtype(), forces.contacts)),
      holds(to_array(hold_force_dtype(), forces.holds)),
      joints(to_array(node_force_dtype("joint", &RodForces::JointForce::joint), forces.joints)),
      loads(to_array(node_force_dtype("load", &RodForces::LoadForce::load), forces.loads)),
      obstacles(to_array(obstacle_force_dtype(), forces.obstacles)) {}

}  // namespace

py::object forces_of(const Simulation& simulation) {
  RodForces forces = simulation.with([](SimScene& scene) { return scene.stepper->forces(); });
  return py::cast(std::make_shared<Forces>(forces));
}

void bind_forces(py::module& module) {
  py::class_<Forces, std::shared_ptr<Forces>>(
      module, "Forces", "What acts in fibres of a simulation and on them at the end of a frame.")
      .def_readonly("tensions", &Forces::tensions,
                    "(n,) float64 [N], by the first point of each segment: positive where it is "
                    "pulled; 0 at the last point of a fibre. Empty before the first step.")
      .def_readonly("bending_moments", &Forces::bending_moments,
                    "(n, 3) float64 [N m], by point: what the part of the fibre after it exerts on "
                    "the part before it.")
      .def_readonly("twisting_moments", &Forces::twisting_moments,
                    "(n,) float64 [N m], by the first point of each segment: about its tangent.")
      .def_readonly("contacts", &Forces::contacts,
                    "(m,) with the fields fiber, segment, other_fiber (2**32 - 1: an object), "
                    "other_segment, object, point [m], normal_force and friction_force [N] on the "
                    "fibre.")
      .def_readonly("joints", &Forces::joints,
                    "(m,) with the fields joint, as the scene counts them from 0, fiber, node, "
                    "point [m], force [N] and moment [N m] of the joint on the fibre: those of a "
                    "joint add up to 0.")
      .def_readonly("holds", &Forces::holds,
                    "(m,) with the fields fiber, node, point [m], force [N] and moment [N m] on "
                    "the fibre, lag [m] behind where the hold pulls it, max_force [N].")
      .def_readonly("loads", &Forces::loads,
                    "(m,) with the fields load (counted from 0, those of a repeated fibre one by "
                    "one), fiber, node, point [m], force [N] on the node and moment [N m] on the "
                    "segment after it: the share that the node has in the load.")
      .def_readonly("obstacles", &Forces::obstacles,
                    "(m,) with the fields object, as `contacts` counts them, point [m], its "
                    "origin, force [N] and moment [N m] about that: what fibres exert on each "
                    "object that moves.");
}

}  // namespace fiber::python
