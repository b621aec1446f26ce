#include <utility>
#include <vector>

#include "src/scenes/hair.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t yarn_count = 500;
constexpr std::uint32_t segments_per_yarn = 2'600;
constexpr double yarn_segment_length = 1e-4;  // without crimp and folds [m]
constexpr double edge = 0.25;                 // of the woven square [m]
constexpr double crimp = 0.9 * hair_radius;   // of a yarn above and below the middle [m]
constexpr double fold_height = 0.01;          // [m]
constexpr double wave_height = 0.004;         // [m]
constexpr std::uint32_t wave_period = 100;    // of the wave [frames]

/// One of the two sets of parallel yarns.
struct Yarns {
  std::uint32_t count;

  double spacing() const { return edge / count; }
  double position(std::uint32_t yarn) const { return (yarn + 0.5) * spacing() - 0.5 * edge; }
};

/// Height of the cloth without its threads [m].
double drape(double x, double y, double time) {
  return fold_height * sine_of_turns(5.0 * x + 3.0 * y) * cosine_of_turns(2.0 * x - 4.0 * y) +
         wave_height * sine_of_turns(4.0 * x + 6.0 * y - time);
}

/// Appends the yarns of one set.
/// @param side 1 for the yarns that begin over the first of the others, −1 for those under it
/// @param point from the position across the yarn, that along it and the height [m]
template <class MakePoint>
void append_yarns(const Yarns& yarns, const Yarns& crossed, double side,
                  const MakePoint& make_point, std::vector<Vector3d>& points) {
  constexpr double middle = 0.5 * segments_per_yarn;
  for (std::uint32_t yarn = 0; yarn < yarns.count; ++yarn) {
    const double first_side = yarn % 2 == 0 ? side : -side;
    for (std::uint32_t i = 0; i <= segments_per_yarn; ++i) {
      const double along = (i - middle) * yarn_segment_length;
      const double crossings =
          crossed.count == 0 ? 0.0 : (along - crossed.position(0)) / crossed.spacing();
      const double height = first_side * crimp * cosine_of_turns(0.5 * crossings);
      points.push_back(make_point(yarns.position(yarn), along, height));
    }
  }
}

}  // namespace

FiberAssembly cloth(const SceneOptions& options, std::uint32_t frame) {
  const std::uint32_t count = scaled_fiber_count(options, yarn_count, segments_per_yarn + 1);
  const Yarns weft{count / 2};
  const Yarns warp{count - weft.count};
  const double time = static_cast<double>(frame % wave_period) / wave_period;
  std::vector<Vector3d> points;
  points.reserve(std::size_t{count} * (segments_per_yarn + 1));
  append_yarns(
      warp, weft, 1.0,
      [time](double x, double y, double height) {
        return Vector3d(x, y, drape(x, y, time) + height);
      },
      points);
  append_yarns(
      weft, warp, -1.0,
      [time](double y, double x, double height) {
        return Vector3d(x, y, drape(x, y, time) + height);
      },
      points);
  return equal_fibers(std::move(points), segments_per_yarn + 1, hair_radius);
}

}  // namespace fiber
