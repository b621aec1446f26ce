#include "src/python/contacts.hpp"

#include <stdexcept>

#include "src/python/bindings.hpp"

namespace fiber::python {
namespace {

/// For the process: Python's objects cannot be destroyed after its end.
template <class Make>
const py::dtype& make_once(const Make& make) {
  static const auto* made = new py::dtype(make());
  return *made;
}

std::vector<Field> pair_fields(const SegmentIdPair& pair) {
  return {{"fiber_a", "u4", offset_of(pair, &SegmentIdPair::fiber_a)},
          {"segment_a", "u4", offset_of(pair, &SegmentIdPair::segment_a)},
          {"fiber_b", "u4", offset_of(pair, &SegmentIdPair::fiber_b)},
          {"segment_b", "u4", offset_of(pair, &SegmentIdPair::segment_b)}};
}

/// An array of a structured dtype; others are refused, whose fields would be filled with something.
py::array to_records(const py::object& object, const py::dtype& dtype, const char* name) {
  if (!py::isinstance<py::array>(object) && !py::hasattr(object, "dtype")) {
    throw py::type_error(std::string(name) + " is a " + std::string(py::str(object.get_type())) +
                         ", it must be an array of contacts");
  }
  const py::module numpy = py::module::import("numpy");
  refuse_masked(object, name);
  py::array array = numpy.attr("asarray")(object);
  if (!array.dtype().equal(dtype)) {
    throw py::type_error(std::string(name) + " has the dtype " +
                         std::string(py::str(array.dtype())) + ", it must be " +
                         std::string(py::str(py::handle(dtype))));
  }
  return numpy.attr("ascontiguousarray")(array);
}

template <class Value>
const Value* items_of(const py::array& array) {
  return static_cast<const Value*>(array.data());
}

py::array gradients(const py::object& contacts) {
  const py::array array = to_contacts(contacts);
  const auto* items = items_of<Contact>(array);
  const Py_ssize_t count = array.size();
  py::array_t<double> result(std::vector<Py_ssize_t>{count, 4, 3});
  auto* rows = reinterpret_cast<Eigen::Vector3d*>(result.mutable_data());
  const WithoutPythonLock others_may_run;
  for (Py_ssize_t i = 0; i < count; ++i) {
    const GapGradient gradient = gradient_of(items[i]);
    *rows++ = gradient.a0;
    *rows++ = gradient.a1;
    *rows++ = gradient.b0;
    *rows++ = gradient.b1;
  }
  return result;
}

py::dict dict_of(const QueryCounts& counts) {
  py::dict dict;
  dict["node_tests"] = counts.node_tests;
  dict["node_overlaps"] = counts.node_overlaps;
  dict["primitive_tests"] = counts.primitive_tests;
  return dict;
}

}  // namespace

std::vector<Field> contact_fields() {
  const Contact contact{};
  const auto at = [&](auto member) { return offset_of(contact, member); };
  const std::vector<Field> pair = pair_fields(contact);
  return {pair[0],
          pair[1],
          {"s", "f8", at(&Contact::s)},
          pair[2],
          pair[3],
          {"t", "f8", at(&Contact::t)},
          {"distance", "f8", at(&Contact::distance)},
          {"lower", "f8", at(&Contact::lower)},
          {"upper", "f8", at(&Contact::upper)},
          {"point_a", "(3,)f8", at(&Contact::point_a)},
          {"point_b", "(3,)f8", at(&Contact::point_b)},
          {"normal", "(3,)f8", at(&Contact::normal)}};
}

const py::dtype& contact_dtype() {
  return make_once([] { return make_dtype(contact_fields(), sizeof(Contact)); });
}

const py::dtype& motion_contact_dtype() {
  return make_once([] {
    const MotionContact contact;
    std::vector<Field> fields = pair_fields(contact);
    fields.push_back({"time_lower", "f8", offset_of(contact, &MotionContact::lower)});
    fields.push_back({"time_upper", "f8", offset_of(contact, &MotionContact::upper)});
    fields.push_back({"certain", "?", offset_of(contact, &MotionContact::certain)});
    return make_dtype(fields, sizeof(MotionContact));
  });
}

py::array to_contacts(const py::object& object) {
  return to_records(object, contact_dtype(), "contacts");
}

Answer::Answer(QueryResult& result)
    : limit_reached(result.limit_reached),
      complete(result.complete),
      others_lower(result.others_lower),
      minimum_lower(result.minimum_lower()),
      counts(result.counts) {
  const Contact* nearest = result.closest();
  closest = nearest == nullptr ? py::none() : to_record(contact_dtype(), *nearest);
  contacts = to_array(contact_dtype(), result.contacts);
}

MotionAnswer::MotionAnswer(MotionResult& result, Locate locate_contact)
    : limit_reached(result.limit_reached),
      complete(result.complete),
      others_lower(result.others_lower),
      counts(result.counts),
      locate(std::move(locate_contact)) {
  const MotionContact* first = result.earliest();
  earliest = first == nullptr ? py::none() : to_record(motion_contact_dtype(), *first);
  contacts = to_array(motion_contact_dtype(), result.contacts);
  touching = to_array(motion_contact_dtype(), result.touching);
}

py::array MotionAnswer::at(const py::object& motion_contacts) const {
  const py::array array = to_records(motion_contacts, motion_contact_dtype(), "contacts");
  const auto* items = items_of<MotionContact>(array);
  const auto count = static_cast<std::size_t>(array.size());
  std::vector<Contact> located;
  {
    const WithoutPythonLock others_may_run;
    located.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      located.push_back(locate(items[i]));
    }
  }
  return to_array(contact_dtype(), located);
}

void bind_contacts(py::module& module) {
  // For what of the package is written in Python.
  module.def("refuse_masked",
             [](const py::object& object, const char* name) { refuse_masked(object, name); });
  module.attr("contact_dtype") = contact_dtype();
  module.attr("motion_contact_dtype") = motion_contact_dtype();
  module.def("gradients", &gradients, py::arg("contacts"), R"(
How the distance of each contact changes as the end points of its segments move.

Parameters
----------
contacts : (m,) of ``contact_dtype``

Returns
-------
(m, 4, 3) float64 [m per m]
    By the first and second point of segment a, then of segment b. Where segments are parallel side
    by side or their axes meet, the distance has a kink and this is one of its slopes.

>>> from fiber_proximity import Engine, Fibers, gradients
>>> fibers = Fibers([[0, 0, 0], [1, 0, 0], [.5, -1, 1], [.5, 1, 1]], [0, 2, 4])
>>> gradients(Engine(fibers).contacts(margin=1.0))[0, :, 2]
array([-0.5, -0.5,  0.5,  0.5])
)");
  py::class_<Answer, std::shared_ptr<Answer>>(module, "QueryResult",
                                              "Answer to ``Engine.query()``.")
      .def_readonly("contacts", &Answer::contacts,
                    "(m,) of ``contact_dtype``, sorted by fiber_a, segment_a, fiber_b, segment_b.")
      .def_readonly("closest", &Answer::closest,
                    "The reported contact of the smallest distance, or None.")
      .def_readonly("limit_reached", &Answer::limit_reached,
                    "Whether there may be more contacts than were reported.")
      .def_readonly("complete", &Answer::complete,
                    "False: the deadline or the pair limit came before all pairs had been ruled "
                    "out.")
      .def_readonly("others_lower", &Answer::others_lower,
                    "[m] No pair that was asked about and is not reported has a smaller gap.")
      .def_readonly("minimum_lower", &Answer::minimum_lower,
                    "[m] No pair that was asked about has a smaller gap.")
      .def_property_readonly(
          "counts", [](const Answer& answer) { return dict_of(answer.counts); },
          "Work done: node_tests, node_overlaps, primitive_tests.");
  py::class_<MotionAnswer, std::shared_ptr<MotionAnswer>>(module, "MotionResult",
                                                          "Answer to ``Engine.motion()``.")
      .def_readonly("contacts", &MotionAnswer::contacts,
                    "(m,) of ``motion_contact_dtype``: pairs whose contact begins during the "
                    "motion, sorted by fiber_a, segment_a, fiber_b, segment_b. There is none "
                    "before ``time_lower``; at ``time_upper`` the gap is at most margin + "
                    "tolerance. Times are parts of the motion, 0 before and 1 after.")
      .def_readonly("touching", &MotionAnswer::touching,
                    "The same of pairs that are in contact before the motion, at time 0.")
      .def_readonly("earliest", &MotionAnswer::earliest,
                    "The contact that begins first during the motion, or None.")
      .def_readonly("limit_reached", &MotionAnswer::limit_reached,
                    "Whether there may be more contacts than were reported.")
      .def_readonly("complete", &MotionAnswer::complete,
                    "False: the deadline or the pair limit came before all pairs had been ruled "
                    "out.")
      .def_readonly("others_lower", &MotionAnswer::others_lower,
                    "No pair that is not reported comes into contact before this time.")
      .def("at", &MotionAnswer::at, py::arg("contacts"),
           "(m,) of ``contact_dtype``: nearest points and distance of these contacts of the "
           "answer, where the pairs are at ``time_upper``; where that is infinite, at "
           "``time_lower``.")
      .def_property_readonly(
          "counts", [](const MotionAnswer& answer) { return dict_of(answer.counts); },
          "Work done: node_tests, node_overlaps, primitive_tests.");
}

}  // namespace fiber::python
