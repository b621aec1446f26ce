#include "src/tools/crossing_format.hpp"

#include <nlohmann/json.hpp>

#include "src/io/number.hpp"
#include "src/tools/json_list.hpp"

namespace fiber {
namespace {

/// The values of a crossing by their names, in the order of the columns.
nlohmann::ordered_json to_json(const Crossing& crossing) {
  const auto vector = [](const Eigen::Vector3d& v) -> nlohmann::ordered_json {
    return {v.x(), v.y(), v.z()};
  };
  return {{"fiber_a", crossing.fiber_a},
          {"segment_a", crossing.segment_a},
          {"s", crossing.s},
          {"fiber_b", crossing.fiber_b},
          {"segment_b", crossing.segment_b},
          {"t", crossing.t},
          {"over", crossing.a_is_over ? "a" : "b"},
          {"sign", crossing.sign},
          {"separation", crossing.separation},
          {"gap", crossing.gap},
          {"point_a", vector(crossing.point_a)},
          {"point_b", vector(crossing.point_b)}};
}

template <class Value>
void append_field(std::string& text, const Value& value) {
  append_number(text, value);
  text += ',';
}

}  // namespace

std::string crossings_csv_header() {
  return "fiber_a,segment_a,s,fiber_b,segment_b,t,over,sign,separation,gap,"
         "point_a_x,point_a_y,point_a_z,point_b_x,point_b_y,point_b_z\n";
}

void write_csv(TextOutput& output, std::optional<std::int64_t> frame,
               const std::vector<Crossing>& crossings) {
  std::string& text = output.text();
  for (const Crossing& crossing : crossings) {
    if (frame) {
      append_field(text, *frame);
    }
    append_field(text, crossing.fiber_a);
    append_field(text, crossing.segment_a);
    append_field(text, crossing.s);
    append_field(text, crossing.fiber_b);
    append_field(text, crossing.segment_b);
    append_field(text, crossing.t);
    text += crossing.a_is_over ? "a," : "b,";
    append_field(text, crossing.sign);
    append_field(text, crossing.separation);
    append_field(text, crossing.gap);
    for (const Eigen::Vector3d& point : {crossing.point_a, crossing.point_b}) {
      for (const double coordinate : {point.x(), point.y(), point.z()}) {
        append_field(text, coordinate);
      }
    }
    text.back() = '\n';
    output.flush_if_long();
  }
}

void write_json(TextOutput& output, std::optional<std::int64_t> frame,
                const std::vector<Crossing>& crossings) {
  nlohmann::ordered_json object;
  if (frame) {
    object["frame"] = *frame;
  }
  write_json_list(output, std::move(object), "crossings", crossings,
                  [](const Crossing& crossing) { return to_json(crossing); });
}

}  // namespace fiber
