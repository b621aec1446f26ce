#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// The number of straight pieces that stand for a curve.
constexpr int fine = 2000;

Points sample(const std::function<Vector3d(double)>& curve) {
  Points points;
  for (int i = 0; i <= fine; ++i) {
    points.push_back(curve(static_cast<double>(i) / fine));
  }
  return points;
}

double positive(const YamlField& field) {
  const double value = field.number();
  if (!(std::isfinite(value) && value > 0.0)) {
    field.refuse("positive and finite");
  }
  return value;
}

Points read_line(const YamlField& options) {
  options.require_map(key_names("shape line"));
  return {options.get("from").vector(), options.get("to").vector()};
}

/// Half the angle of an arc whose length is so many times its chord: x / sin x, which rises.
double half_angle(double ratio) {
  double low = 0.0;
  double high = M_PI;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (middle < ratio * std::sin(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Points read_arc(const YamlField& options) {
  options.require_map(key_names("shape arc"));
  const Vector3d from = options.get("from").vector();
  const Vector3d chord = options.get("to").vector() - from;
  const YamlField length = options.get("length");
  const double ratio = positive(length) / chord.norm();
  if (!(ratio > 1.0 && ratio < 1e3)) {
    length.refuse("longer than from `from` to `to`, " + std::to_string(chord.norm()) +
                  " m, and less than a thousand times that");
  }
  const auto towards = options.find("towards");
  const Vector3d wanted = towards ? towards->vector() : Vector3d(0.0, 0.0, -1.0);
  const Vector3d along = chord.normalized();
  const Vector3d sag = wanted - along * along.dot(wanted);
  if (!(sag.norm() > 1e-6 * wanted.norm())) {
    (towards ? *towards : options).refuse("a direction across that from `from` to `to`");
  }
  const double half = half_angle(ratio);
  const double radius = 0.5 * chord.norm() / std::sin(half);
  return sample([=](double share) -> Vector3d {
    const double angle = half * (2.0 * share - 1.0);
    return from + 0.5 * chord + radius * std::sin(angle) * along +
           radius * (std::cos(angle) - std::cos(half)) * sag.normalized();
  });
}

Points read_helix(const YamlField& options) {
  options.require_map(key_names("shape helix"));
  const Vector3d center = options.get("center").vector();
  const double radius = positive(options.get("radius"));
  const double pitch = options.get("pitch").number();
  const double turns = positive(options.get("turns"));
  return sample([=](double share) -> Vector3d {
    const double angle = 2.0 * M_PI * turns * share;
    return center +
           Vector3d(radius * std::cos(angle), radius * std::sin(angle), pitch * turns * share);
  });
}

Points read_polyline(const YamlField& list) {
  Points points;
  for (const YamlField& point : list.items()) {
    points.push_back(point.vector());
    if (points.size() > 1 && points[points.size() - 2] == points.back()) {
      point.refuse("another point than the one before");
    }
  }
  if (points.size() < 2) {
    list.refuse("a list of at least two points");
  }
  return points;
}

/// Rounds corners, the ends stay.
void smooth(Points& points) {
  constexpr int rounds = 2000;
  for (int round = 0; round < rounds; ++round) {
    Vector3d before = points.front();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vector3d here = points[i];
      points[i] = 0.25 * before + 0.5 * here + 0.25 * points[i + 1];
      before = here;
    }
  }
}

/// A closed trefoil, cut where it is widest, its ends led up and apart: an overhand knot, 6 wide,
/// about the origin. The first end is the one at smaller x.
Points make_trefoil() {
  const double cut = M_PI / 3.0;
  const double half_gap = 0.4;
  const Vector3d out(std::cos(M_PI / 6.0), std::sin(M_PI / 6.0), 0.0);
  const Vector3d side(-out.y(), out.x(), 0.0);
  Points points = sample([=](double share) -> Vector3d {
    const double t = cut + half_gap + share * 2.0 * (M_PI - half_gap);
    const Vector3d knot(std::sin(t) + 2.0 * std::sin(2.0 * t),
                        std::cos(t) - 2.0 * std::cos(2.0 * t), -std::sin(3.0 * t));
    return {side.dot(knot), knot.z(), out.dot(knot)};
  });
  const double apart = points.front().x() > points.back().x() ? 1.0 : -1.0;
  constexpr double lead = 3.0;
  constexpr int lead_points = fine / 6;
  const Vector3d first = points.front();
  const Vector3d last = points.back();
  for (int i = 1; i <= lead_points; ++i) {
    const double length = lead * i / lead_points;
    points.insert(points.begin(), first + length * Vector3d(0.6 * apart, 0.0, 1.0));
    points.push_back(last + length * Vector3d(-0.6 * apart, 0.0, 1.0));
  }
  smooth(points);
  if (apart > 0.0) {
    std::reverse(points.begin(), points.end());
  }
  return points;
}

Points read_trefoil(const YamlField& options) {
  static const Points trefoil = make_trefoil();  // rounding its corners takes a while
  options.require_map(key_names("shape trefoil"));
  const Vector3d center = options.get("center").vector();
  const double size = positive(options.get("size"));
  constexpr double width = 6.0;
  Points points = trefoil;
  for (Vector3d& point : points) {
    point = center + size / width * point;
  }
  return points;
}

}  // namespace

std::vector<Vector3d> resample(const Points& line, std::int64_t segments) {
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < line.size(); ++i) {
    lengths.push_back(lengths.back() + (line[i] - line[i - 1]).norm());
  }
  if (!(lengths.back() > 0.0)) {
    return Points(static_cast<std::size_t>(segments) + 1, line.front());
  }
  Points points;
  std::size_t piece = 0;
  for (std::int64_t i = 0; i < segments; ++i) {
    const double at = lengths.back() * static_cast<double>(i) / static_cast<double>(segments);
    while (piece + 2 < line.size() && lengths[piece + 1] <= at) {
      ++piece;
    }
    const double share = (at - lengths[piece]) / (lengths[piece + 1] - lengths[piece]);
    points.push_back(line[piece] + share * (line[piece + 1] - line[piece]));
  }
  points.push_back(line.back());
  return points;
}

std::vector<Vector3d> read_shape(const YamlField& shape) {
  static const std::map<std::string, Points (*)(const YamlField&)> readers{
      {"arc", read_arc},
      {"helix", read_helix},
      {"line", read_line},
      {"polyline", read_polyline},
      {"trefoil", read_trefoil}};
  std::vector<std::string> names;
  for (const auto& [name, reader] : readers) {
    names.push_back(name);
  }
  shape.require_map(names);
  std::optional<YamlField> options;
  Points (*read)(const YamlField&) = nullptr;
  for (const auto& [name, reader] : readers) {
    if (const auto found = shape.find(name)) {
      if (options) {
        shape.refuse("a map of one shape, not of two");
      }
      options = found;
      read = reader;
    }
  }
  if (!options) {
    shape.refuse("a map of one of the keys arc, helix, line, polyline, trefoil");
  }
  return read(*options);
}

}  // namespace fiber
