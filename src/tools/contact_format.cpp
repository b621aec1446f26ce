#include "src/tools/contact_format.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "src/io/number.hpp"
#include "src/tools/json_list.hpp"

namespace fiber {
namespace {

nlohmann::ordered_json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json to_json(const Contact& contact) {
  return {{"fiber_a", contact.fiber_a},
          {"segment_a", contact.segment_a},
          {"s", contact.s},
          {"fiber_b", contact.fiber_b},
          {"segment_b", contact.segment_b},
          {"t", contact.t},
          {"distance", contact.distance},
          {"lower", contact.lower},
          {"upper", contact.upper},
          {"point_a", to_json(contact.point_a)},
          {"point_b", to_json(contact.point_b)},
          {"normal", to_json(contact.normal)}};
}

void append_vector(std::string& text, const Eigen::Vector3d& vector) {
  for (const double coordinate : {vector.x(), vector.y(), vector.z()}) {
    text += ',';
    append_number(text, coordinate);
  }
}

}  // namespace

std::string csv_header(bool has_frames) {
  return std::string(has_frames ? "frame," : "") +
         "fiber_a,segment_a,s,fiber_b,segment_b,t,distance,point_a_x,point_a_y,point_a_"
         "z,"
         "point_b_x,point_b_y,point_b_z,normal_x,normal_y,normal_z,lower,upper\n";
}

void write_csv(TextOutput& output, std::optional<std::int64_t> frame,
               const std::vector<Contact>& contacts) {
  std::string& text = output.text();
  for (const Contact& contact : contacts) {
    if (frame) {
      append_number(text, *frame);
      text += ',';
    }
    append_number(text, contact.fiber_a);
    text += ',';
    append_number(text, contact.segment_a);
    text += ',';
    append_number(text, contact.s);
    text += ',';
    append_number(text, contact.fiber_b);
    text += ',';
    append_number(text, contact.segment_b);
    text += ',';
    append_number(text, contact.t);
    text += ',';
    append_number(text, contact.distance);
    append_vector(text, contact.point_a);
    append_vector(text, contact.point_b);
    append_vector(text, contact.normal);
    text += ',';
    append_number(text, contact.lower);
    text += ',';
    append_number(text, contact.upper);
    text += '\n';
    output.flush_if_long();
  }
}

void write_json(TextOutput& output, std::optional<std::int64_t> frame, const QueryResult& result) {
  nlohmann::ordered_json object;
  if (frame) {
    object["frame"] = *frame;
  }
  object["complete"] = result.complete;
  const double lower = result.minimum_lower();
  object["minimum_lower"] = std::isfinite(lower) ? nlohmann::ordered_json(lower) : nullptr;
  write_json_list(output, std::move(object), "contacts", result.contacts,
                  [](const Contact& contact) { return to_json(contact); });
}

}  // namespace fiber
