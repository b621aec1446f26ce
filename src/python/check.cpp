#include <pybind11/stl.h>

#include <utility>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/python/bindings.hpp"
#include "src/python/candidates.hpp"
#include "src/python/engine.hpp"
#include "src/python/environment.hpp"
#include "src/python/options.hpp"

namespace fiber::python {
namespace {

// As the message Contact has them.
enum BodyType : std::uint8_t { FIBER = 0, OBJECT = 2, CANDIDATE = 3 };

/// A contact of a candidate; times are those of motions.
struct CandidateContact : Contact {
  std::uint32_t candidate = 0;
  BodyType type_a = CANDIDATE;
  BodyType type_b = CANDIDATE;
  bool certain = true;
  double time_lower = 0.0;
  double time_upper = 0.0;
};

py::dtype candidate_dtype(bool moves) {
  const CandidateContact contact;
  std::vector<Field> fields = contact_fields();
  const auto at = [&](auto member) { return offset_of(contact, member); };
  fields.insert(fields.begin(), {{"candidate", "u4", at(&CandidateContact::candidate)},
                                 {"type_a", "u1", at(&CandidateContact::type_a)},
                                 {"type_b", "u1", at(&CandidateContact::type_b)}});
  if (moves) {
    fields.insert(fields.end(), {{"time_lower", "f8", at(&CandidateContact::time_lower)},
                                 {"time_upper", "f8", at(&CandidateContact::time_upper)},
                                 {"certain", "?", at(&CandidateContact::certain)}});
  }
  return make_dtype(fields, sizeof(CandidateContact));
}

/// Answers for all candidates, as Python has them.
struct CheckAnswer : OnlyShared {
  template <class Check>
  CheckAnswer(const std::vector<Check>& checks, bool moves)
      : free(static_cast<Py_ssize_t>(checks.size())),
        decided(free.size()),
        complete(free.size()),
        limit_reached(free.size()) {
    std::vector<CandidateContact> found;
    for (std::size_t i = 0; i < checks.size(); ++i) {
      const Check& check = checks[i];
      const auto index = static_cast<Py_ssize_t>(i);
      free.mutable_at(index) = check.is_free();
      decided.mutable_at(index) = check.is_decided();
      complete.mutable_at(index) = check.is_complete();
      limit_reached.mutable_at(index) = check.is_limit_reached();
      const auto candidate = static_cast<std::uint32_t>(i);
      collect(check.self.contacts, candidate, CANDIDATE, found);
      collect(check.fibers.contacts, candidate, FIBER, found);
      collect(check.environment.contacts, candidate, OBJECT, found);
    }
    contacts = to_array(candidate_dtype(moves), found);
  }

  py::array_t<bool> free;
  py::array_t<bool> decided;
  py::array_t<bool> complete;
  py::array_t<bool> limit_reached;
  py::array contacts;

 private:
  static void copy(const Contact& contact, CandidateContact& copied) {
    static_cast<Contact&>(copied) = contact;
  }
  static void copy(const PathContact& contact, CandidateContact& copied) {
    static_cast<Contact&>(copied) = contact.where;
    copied.certain = contact.when.certain;
    copied.time_lower = contact.when.lower;
    copied.time_upper = contact.when.upper;
  }

  template <class Contacts>
  static void collect(const Contacts& contacts, std::uint32_t candidate, BodyType type_b,
                      std::vector<CandidateContact>& found) {
    for (const auto& contact : contacts) {
      found.emplace_back();
      copy(contact, found.back());
      found.back().candidate = candidate;
      found.back().type_b = type_b;
    }
  }
};

/// Calls with what candidates are checked against, without Python's lock.
template <class Check>
void check_against(const std::shared_ptr<Engine>& engine, const py::object& environment,
                   const py::object& allowed, bool self, const Check& check) {
  const auto around = to_environment(environment);
  Surroundings surroundings;
  surroundings.environment = around.get();
  surroundings.allowed = to_allowed(allowed);
  surroundings.self = self;
  const WithoutPythonLock others_may_run;
  if (engine == nullptr) {
    check(surroundings);
    return;
  }
  engine->read([&](const ProximityEngine& fibers) {
    surroundings.fibers = &fibers;
    check(surroundings);
  });
}

std::shared_ptr<CheckAnswer> check(const py::object& candidates,
                                   const std::shared_ptr<Engine>& engine,
                                   const py::object& environment, double margin,
                                   const std::string& type, const py::object& radii,
                                   const py::object& allowed, bool self,
                                   const py::kwargs& keywords) {
  const QueryOptions options = query_options(type, margin, keywords);
  const std::vector<FiberAssembly> assemblies = to_candidates(candidates, radii);
  std::vector<FiberCheck> checks;
  check_against(engine, environment, allowed, self, [&](const Surroundings& surroundings) {
    check_fibers(assemblies, surroundings, options, checks);
  });
  return std::make_shared<CheckAnswer>(checks, false);
}

std::shared_ptr<CheckAnswer> check_motions(const py::object& motions,
                                           const std::shared_ptr<Engine>& engine,
                                           const py::object& environment, double margin,
                                           const std::string& type, const py::object& radii,
                                           const py::object& allowed, bool self,
                                           const py::kwargs& keywords) {
  const MotionOptions options = motion_options(type, margin, keywords);
  const std::vector<FiberPath> paths = to_paths(motions, radii);
  std::vector<MotionCheck> checks;
  check_against(engine, environment, allowed, self, [&](const Surroundings& surroundings) {
    fiber::check_motions(paths, surroundings, options, checks);
  });
  return std::make_shared<CheckAnswer>(checks, true);
}

constexpr const char* check_doc = R"(
Whether hypothetical fibres could be there; all candidates at the same time on all cores.

Parameters
----------
candidates : (m, n, 3) or (m, fibres, n, 3) of real numbers [m], or a sequence of Fibers
    Each candidate is a fibre, or several of as many points each.
engine : Engine, optional
    Of the fibres that there are, as of its last update.
environment : Environment, optional
margin : float [m], default 0
type : str, default "first"
    "first": a candidate's check ends at its first contact, which is the fastest. Others as in
    ``Engine.query()``.
radii : number, or one per fibre of a candidate, or one per point [m], default 0
    Of candidates that are arrays.
allowed : sequence, optional
    Pairs with objects that may touch, as in ``Environment.contacts()``.
with_itself : bool, default True
    Whether contacts of a candidate with itself count.
**options
    As in ``Engine.query()``.

Returns
-------
CheckResult

>>> import numpy as np
>>> from fiber_proximity import Environment, check
>>> environment = Environment()
>>> environment.add_half_space("floor", normal=[0, 0, 1])
>>> heights = np.array([0.1, -0.1]).reshape(2, 1, 1)
>>> candidates = np.zeros((2, 5, 3)) + heights * [0, 0, 1] + np.linspace(0, 1, 5)[:, None] * [1, 0, 0]
>>> check(candidates, environment=environment, radii=0.01).free
array([ True, False])
)";

constexpr const char* motions_doc = R"(
Whether fibres could move like this among fibres and objects that stand still: the edges of a
planner's graph, for example. No contact is missed between two states.

Parameters
----------
motions : (m, states, n, 3) or (m, states, fibres, n, 3), or a sequence of sequences of Fibers [m]
    Each motion goes through its states, at least two; in between each point moves linearly.
engine, environment, margin, radii, allowed, with_itself
    As in ``check()``.
type : str, default "first"
    "first": the earliest contact of a motion, with whatever it is; "limited", "all": of each pair
    the first one.
**options
    As in ``Engine.motion()``.

Returns
-------
CheckResult
    Times of contacts are in states: 1.25 is a quarter of the way from state 1 to state 2.
)";

}  // namespace

void bind_check(py::module& module) {
  module.attr("candidate_contact_dtype") = candidate_dtype(false);
  module.attr("candidate_motion_contact_dtype") = candidate_dtype(true);
  py::class_<CheckAnswer, std::shared_ptr<CheckAnswer>>(
      module, "CheckResult", "Answer to ``check()`` and ``check_motions()``.")
      .def_readonly("free", &CheckAnswer::free,
                    "(m,) bool: whether it is certain that the candidate touches nothing.")
      .def_readonly("decided", &CheckAnswer::decided,
                    "(m,) bool: whether it is free, or has a contact. What a deadline or a limit "
                    "left open is neither.")
      .def_readonly("complete", &CheckAnswer::complete,
                    "(m,) bool: whether all pairs have been looked at. With type \"first\" the "
                    "first contact ends a check, which then is complete.")
      .def_readonly("limit_reached", &CheckAnswer::limit_reached,
                    "(m,) bool: whether contacts may be missing as a limit has been reached.")
      .def_readonly("contacts", &CheckAnswer::contacts,
                    "All contacts, by candidate: with itself, then with fibres, then with objects. "
                    "Fields of ``contact_dtype``, `candidate`, `type_a` and `type_b` (FIBER, "
                    "OBJECT, CANDIDATE); of motions `time_lower`, `time_upper` and `certain`.");
  module.attr("FIBER") = static_cast<int>(FIBER);
  module.attr("SHAPE") = 1;
  module.attr("OBJECT") = static_cast<int>(OBJECT);
  module.attr("CANDIDATE") = static_cast<int>(CANDIDATE);
  const py::none none;
  module.def("check", &check, py::arg("candidates"), py::arg("engine") = nullptr,
             py::arg("environment") = none, py::arg("margin") = 0.0, py::arg("type") = "first",
             py::arg("radii") = 0.0, py::arg("allowed") = none, py::arg("with_itself") = true,
             check_doc);
  module.def("check_motions", &check_motions, py::arg("motions"), py::arg("engine") = nullptr,
             py::arg("environment") = none, py::arg("margin") = 0.0, py::arg("type") = "first",
             py::arg("radii") = 0.0, py::arg("allowed") = none, py::arg("with_itself") = true,
             motions_doc);
  // An engine has the same methods.
  const auto of_engine = [](auto function) {
    return [function](const std::shared_ptr<Engine>& engine, const py::object& asked,
                      const py::object& environment, double margin, const std::string& type,
                      const py::object& radii, const py::object& allowed, bool with_itself,
                      const py::kwargs& options) {
      return function(asked, engine, environment, margin, type, radii, allowed, with_itself,
                      options);
    };
  };
  auto engine = static_cast<py::class_<Engine, std::shared_ptr<Engine>>>(module.attr("Engine"));
  engine
      .def("check", of_engine(&check), py::arg("candidates"), py::arg("environment") = none,
           py::arg("margin") = 0.0, py::arg("type") = "first", py::arg("radii") = 0.0,
           py::arg("allowed") = none, py::arg("with_itself") = true,
           "Whether hypothetical fibres could be among those of the engine: ``check()`` with it.")
      .def("check_motions", of_engine(&check_motions), py::arg("motions"),
           py::arg("environment") = none, py::arg("margin") = 0.0, py::arg("type") = "first",
           py::arg("radii") = 0.0, py::arg("allowed") = none, py::arg("with_itself") = true,
           "Whether fibres could move like this among those of the engine: ``check_motions()`` "
           "with it.");
}

}  // namespace fiber::python
