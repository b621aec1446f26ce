#include "src/python/engine.hpp"

#include <pybind11/stl.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "src/python/bindings.hpp"
#include "src/python/options.hpp"
#include "src/query/threads.hpp"

namespace fiber::python {

Engine::Engine(std::string name, std::int64_t threads, std::optional<double> skin)
    : name_(std::move(name)) {
  options_.threads = to_index(threads, "threads");
  options_.skin = skin;
  engine_ = make_engine(name_, options_);
}

void Engine::update(std::shared_ptr<Fibers> fibers) {
  const WithoutPythonLock others_may_run;
  const std::lock_guard<std::shared_mutex> lock(mutex_);
  if (fibers == nullptr) {
    fibers = fibers_;
  }
  if (fibers == nullptr) {
    throw std::logic_error("the engine has no fibres yet: call update(fibers) first");
  }
  Fibers::State state = fibers->state();
  engine_->update(*state);
  state_ = std::move(state);
  fibers_ = std::move(fibers);
}

std::shared_ptr<Fibers> Engine::fibers() const {
  const WithoutPythonLock others_may_run;
  const std::shared_lock<std::shared_mutex> lock(mutex_);
  return fibers_;
}

std::shared_ptr<MotionAnswer> Engine::motion(const Fibers::State& before,
                                             const Fibers::State& after,
                                             const MotionOptions& options) {
  MotionResult result;
  {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(motion_mutex_);
    if (motion_engine_ == nullptr) {
      motion_engine_ = make_engine(name_, options_);
    }
    motion_engine_->update_motion(*before, *after);
    motion_engine_->query_motion(options, result);
  }
  return std::make_shared<MotionAnswer>(result, [before, after](const MotionContact& contact) {
    const FiberMotion motion{*before, *after};
    require_segment(*before, contact.fiber_a, contact.segment_a);
    require_segment(*before, contact.fiber_b, contact.segment_b);
    return first_contact(motion, motion, contact);
  });
}

py::array Engine::nearest(const py::object& points, std::int64_t k) {
  const Doubles array = to_doubles(points, "points");
  const bool is_one = array.ndim() == 1;
  if (array.ndim() < 1 || array.ndim() > 2 || array.shape(array.ndim() - 1) != 3) {
    refuse_shape(array, "points", "(3,) or (m, 3)");
  }
  const std::uint32_t count = to_index(k, "k", 1);
  const auto* rows = array.data();
  const Py_ssize_t asked = is_one ? 1 : array.shape(0);
  std::vector<Contact> found;
  Py_ssize_t each = 0;
  {
    const WithoutPythonLock others_may_run;
    read([&](const ProximityEngine& engine) {
      if (engine.fibers() != nullptr) {
        each =
            static_cast<Py_ssize_t>(std::min<std::size_t>(count, engine.fibers()->segment_count()));
      }
      found.resize(static_cast<std::size_t>(asked * each));
      const auto find = [&](const tbb::blocked_range<Py_ssize_t>& range) {
        QueryResult result;
        for (Py_ssize_t i = range.begin(); i < range.end(); ++i) {
          nearest_segments(engine, Eigen::Vector3d(rows + 3 * i), count, result);
          std::copy(result.contacts.begin(), result.contacts.end(), found.begin() + i * each);
        }
      };
      constexpr Py_ssize_t worth_a_thread = 32;
      const tbb::blocked_range<Py_ssize_t> all(0, asked, worth_a_thread);
      if (asked <= worth_a_thread) {
        find(all);
        return;
      }
      tbb::task_arena arena(arena_concurrency(options_.threads));
      arena.execute([&] { tbb::parallel_for(all, find); });
    });
  }
  const py::array all = to_array(contact_dtype(), found);
  return is_one ? all : py::array(all.attr("reshape")(asked, asked == 0 ? count : each));
}

namespace {

Fibers::State shape_of(const py::object& shape) {
  return shape.is_none() ? nullptr : to_state(shape, "shape");
}

constexpr const char* engine_doc = R"(
Answers proximity queries about fibres.

Any number of threads may use one engine: queries run at the same time and let Python go on, an
update waits for them. The engine answers about its fibres as they were at its last ``update()``,
and keeps these alive.

Parameters
----------
fibers : Fibers, optional
    To begin with; ``Engine(fibers)`` and ``Engine("run_tree")`` both work.
name : str, default "run_tree"
    One of ``engine_names()``. All give the same contacts; they differ in what they cost.
threads : int, default 0
    Most threads to use, 0 for as many as there are cores. The answers do not depend on it.
skin : float [m], optional
    Pairs up to this far beyond the margin are kept and serve as long as no two segments that are
    near each other have moved by more than this beside each other; 0 keeps none. Without, the engine chooses by what points move from one
    update to the next, and by what its frames cost.

Raises
------
ValueError
    For a name that is not known, listing those that are, and values that are not allowed.
)";

constexpr const char* contacts_doc = R"(
All pairs of segments whose surfaces are no further apart than the margin.

Parameters
----------
margin : float [m], default 0
    At least 0, infinity for no limit.
shape : Fibers, optional
    Pairs of a segment of the shape (a) and one of the engine's fibres (b), in place of pairs of
    these.
**options
    kernel : "robust" (default), in double precision, or "exact";
    pairing : "all" (default), "same_fiber", "different_fibers";
    neighbour_skip : int, segments of one fibre whose indices differ by at most this are no pair;
    neighbour_skip_length : float [m], the same by the length between them. With neither of the two,
    pairs of one fibre, or of fibres that are joined, count where a loop is between them.

Returns
-------
(m,) of ``contact_dtype``
    Sorted by fiber_a, segment_a, fiber_b, segment_b; fields as in the message Contact. `s` and `t`
    are the places on the segments in [0, 1], `distance` is negative in penetration [m], the true
    one is in [`lower`, `upper`].

Raises
------
ValueError
    For values that are not allowed.
TypeError
    For options that there are not.
RuntimeError
    Before the first ``update()``.

>>> from fiber_proximity import Engine, Fibers
>>> fibers = Fibers([[0, 0, 0], [1, 0, 0], [.5, -1, .1], [.5, 1, .1]], [0, 2, 4], radii=0.01)
>>> contacts = Engine(fibers).contacts(margin=0.1)
>>> contacts["fiber_b"], contacts["distance"].round(6)
(array([1], dtype=uint32), array([0.08]))
)";

constexpr const char* query_doc = R"(
A query of any type, with all that the library says of its answer.

Parameters
----------
type : "first", "closest", "limited", "all" (default), "fiber_pairs"
    Which of the pairs within the margin to report: any one, the closest, the `max_contacts`
    closest, all, or the closest of each pair of fibres.
margin, shape, **options
    As ``contacts()`` has them, and
    max_contacts : int, of "limited", default 100;
    tolerance, relative_tolerance : [m], [1] by how much less than a reported one a distance may be
    that is not looked for;
    deadline : [s] after which the query answers with what it has found, 0 for none;
    contact_limit, pair_limit : int, most contacts to report and pairs to look at, 0 for none.

Returns
-------
QueryResult
)";

constexpr const char* nearest_doc = R"(
The segments whose surfaces are nearest to points.

Parameters
----------
points : (3,) or (m, 3) of real numbers [m]
k : int, default 1
    How many for each point.

Returns
-------
(k,) or (m, k) of ``contact_dtype``
    Nearest first; fewer columns where there are fewer segments. b is the segment, a the point.

>>> from fiber_proximity import Engine, Fibers
>>> engine = Engine(Fibers([[0, 0, 0], [1, 0, 0], [2, 0, 0]], radii=0.1))
>>> engine.nearest([[0.5, 1, 0], [2, 1, 0]])["segment_b"]
array([[0],
       [1]], dtype=uint32)
)";

constexpr const char* motion_doc = R"(
Pairs of segments that come into contact while every point moves linearly from where it is before
to where it is after, and when. No contact is missed, however fast segments pass.

What the engine answers otherwise does not change.

Parameters
----------
before, after : Fibers of the same offsets
margin : float [m], default 0
type : "first", "limited", "all" (default)
    The earliest contact, the `max_contacts` earliest, or all.
**options
    tolerance : float [m], default 1e-6: pairs that come as near as margin and this may be reported,
    with `certain` false; larger is faster;
    time_tolerance : float, how close the two bounds of a time are to be;
    pairing, neighbour_skip, neighbour_skip_length, max_contacts, deadline, contact_limit,
    pair_limit as in ``query()``.

Returns
-------
MotionResult

Raises
------
ValueError
    For fibres that are not of the same offsets, and values that are not allowed.

>>> from fiber_proximity import Engine, Fibers
>>> before = Fibers([[0, 0, 0], [1, 0, 0], [.5, -1, 1], [.5, 1, 1]], [0, 2, 4])
>>> after = Fibers([[0, 0, 0], [1, 0, 0], [.5, -1, -1], [.5, 1, -1]], [0, 2, 4])
>>> first = Engine().motion(before, after, margin=0.5).earliest
>>> first["fiber_a"], first["fiber_b"], first["time_upper"].round(6)
(0, 1, 0.25)
)";

using Pointer = std::shared_ptr<Engine>;

Pointer make_updated(std::shared_ptr<Fibers> fibers, const std::string& name, std::int64_t threads,
                     std::optional<double> skin) {
  auto engine = std::make_shared<Engine>(name, threads, skin);
  engine->update(std::move(fibers));
  return engine;
}

std::shared_ptr<Answer> query(Engine& engine, const std::string& type, double margin,
                              const py::object& shape, const py::kwargs& options) {
  std::shared_ptr<Answer> answer;
  engine.query(query_options(type, margin, options), shape_of(shape),
               [&](QueryResult& result) { answer = std::make_shared<Answer>(result); });
  return answer;
}

py::array contacts(Engine& engine, double margin, const py::object& shape,
                   const py::kwargs& options) {
  py::array contacts;
  engine.query(query_options("all", margin, options), shape_of(shape),
               [&](QueryResult& result) { contacts = to_array(contact_dtype(), result.contacts); });
  return contacts;
}

py::object closest(Engine& engine, double margin, const py::object& shape,
                   const py::kwargs& options) {
  py::object closest = py::none();
  engine.query(query_options("closest", margin, options), shape_of(shape),
               [&](QueryResult& result) {
                 if (const Contact* found = result.closest()) {
                   closest = to_record(contact_dtype(), *found);
                 }
               });
  return closest;
}

}  // namespace

void bind_engine(py::module& module) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  module.def("engine_names", &engine_names, "Names of all engines, a list of str.");
  py::class_<Engine, Pointer>(module, "Engine", engine_doc)
      .def(py::init([](const std::string& name, std::int64_t threads, std::optional<double> skin) {
             return std::make_shared<Engine>(name, threads, skin);
           }),
           py::arg("name") = "run_tree", py::arg("threads") = 0, py::arg("skin") = py::none())
      .def(py::init(&make_updated), py::arg("fibers").none(false), py::arg("name") = "run_tree",
           py::arg("threads") = 0, py::arg("skin") = py::none())
      .def("update", &Engine::update, py::arg("fibers") = nullptr, R"(
Makes these fibres, as they are now, the ones that queries are about.

Parameters
----------
fibers : Fibers, optional
    Without: those of the last update, where they have moved to.

Raises
------
RuntimeError
    Without fibres before the first update.
)")
      .def("contacts", &contacts, py::arg("margin") = 0.0, py::arg("shape") = py::none(),
           contacts_doc)
      .def("closest", &closest, py::arg("margin") = infinity, py::arg("shape") = py::none(),
           "The closest pair within the margin [m], a record of ``contact_dtype``, or None if "
           "there is no pair. Parameters as those of ``contacts()``.")
      .def("query", &query, py::arg("type") = "all", py::arg("margin") = 0.0,
           py::arg("shape") = py::none(), query_doc)
      .def("nearest", &Engine::nearest, py::arg("points"), py::arg("k") = 1, nearest_doc)
      .def(
          "motion",
          [](Engine& engine, const py::object& before, const py::object& after, double margin,
             const std::string& type, const py::kwargs& options) {
            return engine.motion(to_state(before, "before"), to_state(after, "after"),
                                 motion_options(type, margin, options));
          },
          py::arg("before"), py::arg("after"), py::arg("margin") = 0.0, py::arg("type") = "all",
          motion_doc)
      .def_property_readonly("name", &Engine::name, "Name of the engine.")
      .def_property_readonly("fibers", &Engine::fibers,
                             "The Fibers of the last update, or None before the first one.")
      .def("__repr__",
           [](const Engine& engine) { return "<fiber_proximity.Engine: " + engine.name() + ">"; });
}

}  // namespace fiber::python
