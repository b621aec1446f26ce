#include "src/rviz/fiber_colors.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber_proximity_rviz {
namespace {

using fiber_proximity_ros::Rgb;

std::uint8_t to_byte(float part) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(part, 0.0F, 1.0F)));
}

/// Between 0.75 and 1.25, seemingly at random.
float brightness(std::uint32_t fiber) {
  // Multiples of the golden ratio, modulo 1, never crowd.
  const double fraction = std::fmod(0.6180339887498949 * fiber, 1.0);
  return static_cast<float>(0.75 + 0.5 * fraction);
}

template <class ColorOf>
void color_fibers(const fiber::FiberAssembly& fibers, std::vector<Color>& colors,
                  const ColorOf& color_of) {
  colors.resize(fibers.point_count());
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    std::fill(colors.begin() + fibers.offsets()[fiber],
              colors.begin() + fibers.offsets()[fiber + 1], color_of(fiber));
  }
}

/// First point of a segment that a contact names.
std::uint32_t first_point(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                          std::uint32_t segment) {
  if (fiber >= fibers.fiber_count()) {
    throw std::invalid_argument("a contact names fibre " + std::to_string(fiber) + " of " +
                                std::to_string(fibers.fiber_count()));
  }
  const std::uint32_t begin = fibers.offsets()[fiber];
  const std::uint32_t count = fibers.offsets()[fiber + 1] - begin - 1;
  if (segment >= count) {
    throw std::invalid_argument("a contact names segment " + std::to_string(segment) +
                                " of fibre " + std::to_string(fiber) + ", which has " +
                                std::to_string(count));
  }
  return begin + segment;
}

}  // namespace

Color to_color(const Rgb& rgb, float opacity) {
  return {to_byte(rgb[0]), to_byte(rgb[1]), to_byte(rgb[2]), to_byte(opacity)};
}

Rgb color_map(double value) {
  static constexpr std::array<Rgb, 4> stops{
      {{0.20F, 0.36F, 0.80F}, {0.16F, 0.70F, 0.62F}, {0.98F, 0.72F, 0.16F}, {0.90F, 0.14F, 0.12F}}};
  const double place = std::clamp(value, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const auto part = static_cast<float>(place - static_cast<double>(stop));
  Rgb rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    rgb[i] = (1.0F - part) * stops[stop][i] + part * stops[stop + 1][i];
  }
  return rgb;
}

void color_flat(const fiber::FiberAssembly& fibers, const Color& color,
                std::vector<Color>& colors) {
  color_fibers(fibers, colors, [&color](std::uint32_t fiber) {
    Color result = color;
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = to_byte(brightness(fiber) * static_cast<float>(color[i]) / 255.0F);
    }
    return result;
  });
}

void color_by_fiber(const fiber::FiberAssembly& fibers, float opacity, std::vector<Color>& colors) {
  color_fibers(fibers, colors, [opacity](std::uint32_t fiber) {
    return to_color(fiber_proximity_ros::fiber_color(fiber), opacity);
  });
}

void color_by_value(const std::vector<std::optional<double>>& values, const ValueRange& range,
                    const Color& otherwise, std::vector<Color>& colors) {
  colors.assign(values.size(), otherwise);
  const double width = range.at_red - range.at_blue;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!values[i]) {
      continue;
    }
    const double distance = *values[i] - range.at_blue;
    // All at one value: the middle.
    const double place = width != 0.0 ? distance / width : 0.5;
    colors[i] = to_color(color_map(place), static_cast<float>(otherwise[3]) / 255.0F);
  }
}

std::vector<std::optional<double>> radii_of_points(const fiber::FiberAssembly& fibers) {
  std::vector<std::optional<double>> radii(fibers.point_count());
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t point = fibers.offsets()[fiber]; point < last; ++point) {
      radii[point] = fibers.segment_radius(point);
    }
    radii[last] = radii[last - 1];
  }
  return radii;
}

std::vector<std::optional<double>> distances_of_points(
    const fiber::FiberAssembly& fibers, const fiber_proximity::ContactArray& contacts) {
  std::vector<std::optional<double>> distances(fibers.point_count());
  const auto note = [&](std::uint32_t fiber, std::uint32_t segment, double distance) {
    const std::uint32_t begin = first_point(fibers, fiber, segment);
    for (const std::uint32_t point : {begin, begin + 1}) {
      distances[point] = std::min(distances[point].value_or(distance), distance);
    }
  };
  const auto note_pair = [&](const fiber_proximity::Contact& contact) {
    if (!std::isfinite(contact.distance)) {
      throw std::invalid_argument("a contact's distance is " + std::to_string(contact.distance) +
                                  "; it must be finite");
    }
    if (contact.type_a == fiber_proximity::Contact::FIBER) {
      note(contact.fiber_a, contact.segment_a, contact.distance);
    }
    note(contact.fiber_b, contact.segment_b, contact.distance);
  };
  std::for_each(contacts.contacts.begin(), contacts.contacts.end(), note_pair);
  if (contacts.has_minimum) {
    note_pair(contacts.minimum);
  }
  return distances;
}

ValueRange range_of(const std::vector<std::optional<double>>& values) {
  std::optional<ValueRange> range;
  for (const std::optional<double>& value : values) {
    if (value) {
      range = range ? ValueRange{std::min(range->at_blue, *value), std::max(range->at_red, *value)}
                    : ValueRange{*value, *value};
    }
  }
  return range.value_or(ValueRange{});
}

}  // namespace fiber_proximity_rviz
