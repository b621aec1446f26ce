#include "validation/geometry/hard_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// A segment by its start and direction, and what is added to both.
struct MovingPart {
  Vector3d start;
  Vector3d direction;
  Vector3d way;   // of the start
  Vector3d turn;  // of the direction
};

struct MovingParts {
  MovingPart a;
  MovingPart b;
};

MovingPart random_part(Random& random) {
  MovingPart part;
  part.start = random.point_in_cube(-1.0, 1.0);
  part.direction = random.point_in_cube(-0.5, 0.5);
  part.way = random.point_in_cube(-1.0, 1.0);
  part.turn = random.point_in_cube(-1.0, 1.0);
  return part;
}

MovingParts random_parts(Random& random) {
  MovingParts parts;
  parts.a = random_part(random);
  parts.b = random_part(random);
  return parts;
}

void place(const MovingPart& part, Vector3d* before, Vector3d* after) {
  before[0] = part.start;
  before[1] = part.start + part.direction;
  after[0] = part.start + part.way;
  after[1] = after[0] + (part.direction + part.turn);
}

HardMotion motion_of(const MovingParts& parts) {
  HardMotion motion;
  place(parts.a, motion.a_before.data(), motion.a_after.data());
  place(parts.b, motion.b_before.data(), motion.b_after.data());
  return motion;
}

HardMotion with_radii(HardMotion motion, double sum, Random& random) {
  motion.radius_a = random.uniform(0.0, 1.0) * sum;
  motion.radius_b = sum - motion.radius_a;
  return motion;
}

MotionFamily scaled_family(const std::string& name, double scale, double offset) {
  return {name, [=](Random& random) {
            const double sum = random.uniform(0.01, 0.3);
            HardMotion motion = with_radii(motion_of(random_parts(random)), sum, random);
            const Vector3d origin = offset * random.direction();
            for (Vector3d* ends : {motion.a_before.data(), motion.a_after.data(),
                                   motion.b_before.data(), motion.b_after.data()}) {
              ends[0] = scale * ends[0] + origin;
              ends[1] = scale * ends[1] + origin;
            }
            motion.radius_a *= scale;
            motion.radius_b *= scale;
            return motion;
          }};
}

double distance_at(const HardMotion& motion, double time) {
  const auto at = [=](const Vector3d* before, const Vector3d* after, int end) {
    return Vector3d((1.0 - time) * before[end] + time * after[end]);
  };
  return segment_distance(at(motion.a_before.data(), motion.a_after.data(), 0),
                          at(motion.a_before.data(), motion.a_after.data(), 1),
                          at(motion.b_before.data(), motion.b_after.data(), 0),
                          at(motion.b_before.data(), motion.b_after.data(), 1))
      .distance;
}

/// About the smallest distance during the motion [m].
double smallest_distance(const HardMotion& motion) {
  constexpr int samples = 100;
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= samples; ++i) {
    const double distance = distance_at(motion, static_cast<double>(i) / samples);
    if (distance < least) {
      best = i;
      least = distance;
    }
  }
  double lower = std::max(0.0, (best - 1.0) / samples);
  double upper = std::min(1.0, (best + 1.0) / samples);
  constexpr int halvings = 80;
  for (int i = 0; i < halvings; ++i) {
    const double third = (upper - lower) / 3.0;
    if (distance_at(motion, lower + third) < distance_at(motion, upper - third)) {
      upper -= third;
    } else {
      lower += third;
    }
  }
  return std::min(least, distance_at(motion, lower));
}

/// The distance, as much more or less as the parts from 1e-3 down to none that a double has.
double about(double distance, Random& random) {
  const int exponent = -10 - static_cast<int>(random.uniform(0.0, 46.0));
  const double change = std::ldexp(random.uniform(-1.0, 1.0), exponent);
  return distance * (1.0 + change);
}

/// A change of the parts, and the sum of the radii [m] of what comes of it.
using Change = std::function<void(MovingParts&, Random&)>;
using Radii = std::function<double(const HardMotion&, Random&)>;

double any_radii(const HardMotion& /*motion*/, Random& random) { return random.uniform(0.01, 0.3); }

/// The smallest distance of the motion, give or take a little.
double grazing_radii(const HardMotion& motion, Random& random) {
  return about(smallest_distance(motion), random);
}

MotionFamily family(const std::string& name, const Change& change, const Radii& radii = any_radii) {
  return {name, [change, radii](Random& random) {
            MovingParts parts = random_parts(random);
            change(parts, random);
            const HardMotion motion = motion_of(parts);
            return with_radii(motion, radii(motion, random), random);
          }};
}

void leave(MovingParts& /*parts*/, Random& /*random*/) {}

/// The radii are the distance at this time, give or take a little.
MotionFamily touching_family(const std::string& name, double time) {
  return family(name, leave, [time](const HardMotion& motion, Random& random) {
    return about(distance_at(motion, time), random);
  });
}

/// Two segments without thickness that meet at one time, inside both or at an end.
MotionFamily crossing_family(const std::string& name, bool at_end) {
  return {name, [at_end](Random& random) {
            MovingParts parts = random_parts(random);
            const double time = random.uniform(0.0, 1.0);
            const double s =
                at_end ? (random.uniform(0.0, 1.0) < 0.5 ? 0.0 : 1.0) : random.uniform(0.0, 1.0);
            const double t = random.uniform(0.0, 1.0);
            const auto point = [time](const MovingPart& part, double parameter) {
              return Vector3d(part.start + time * part.way +
                              parameter * (part.direction + time * part.turn));
            };
            parts.a.start += point(parts.b, t) - point(parts.a, s);
            return motion_of(parts);
          }};
}

/// Two segments without thickness of which one passes below the other, nearest where it meets it
/// but for 2⁻²⁰ to 2⁻⁶⁰ m: they do not cross, though by how little goes under in roundings.
MotionFamily nearly_crossing_family(const std::string& name) {
  return {name, [](Random& random) {
            const Vector3d x = random.direction();
            const Vector3d any = random.direction();
            const Vector3d y = unit(any.cross(x));
            const Vector3d z = x.cross(y);
            const double meeting = random.uniform(0.2, 0.8);
            const double part_a = random.uniform(0.2, 0.8);
            const double part_b = random.uniform(0.3, 0.7);
            const double speed = random.uniform(0.05, 0.2);
            const double tilt = random.uniform(0.1, 1.0);
            const double below =
                std::ldexp(-1.0, -20 - static_cast<int>(random.uniform(0.0, 41.0)));
            // One along x that goes along y, and one along y that tilts: at y it is y² above it.
            HardMotion motion;
            for (const auto& [time, a, b] :
                 {std::tuple(-meeting, motion.a_before.data(), motion.b_before.data()),
                  std::tuple(1.0 - meeting, motion.a_after.data(), motion.b_after.data())}) {
              a[0] = -part_a * x + speed * time * y + below * z;
              a[1] = a[0] + x;
              b[0] = -part_b * (y + tilt * time * z);
              b[1] = b[0] + (y + tilt * time * z);
            }
            return motion;
          }};
}

void stay(MovingPart& part) { part.turn = Vector3d::Zero(); }

void translate(MovingParts& parts, Random& /*random*/) {
  stay(parts.a);
  stay(parts.b);
}

void make_points(MovingParts& parts, Random& random) {
  parts.a.direction = Vector3d::Zero();
  parts.b.direction = Vector3d::Zero();
  translate(parts, random);
}

void make_parallel(MovingParts& parts, Random& random) {
  parts.b.direction = random.uniform(0.3, 2.0) * parts.a.direction;
}

void append_general(std::vector<MotionFamily>& all) {
  all.push_back(family("random", leave));
  all.push_back(family("translating", translate));
  all.push_back(family("without motion", [](MovingParts& parts, Random& random) {
    translate(parts, random);
    parts.a.way = Vector3d::Zero();
    parts.b.way = Vector3d::Zero();
  }));
  all.push_back(family("ends change places", [](MovingParts& parts, Random& random) {
    for (MovingPart* part : {&parts.a, &parts.b}) {
      part->turn = -2.0 * part->direction;
      part->way += part->direction;
    }
    parts.a.turn += 1e-3 * random.direction();
  }));
  all.push_back(family("10^6 lengths", [](MovingParts& parts, Random& random) {
    parts.a.way *= 1e6;
    const Vector3d offset = random.point_in_cube(-0.2, 0.2);
    parts.a.start = parts.b.start - random.uniform(0.0, 1.0) * parts.a.way + offset;
  }));
  all.push_back(scaled_family("1e140 m", 1e140, 0.0));
  all.push_back(scaled_family("1e-150 m", 1e-150, 0.0));
  all.push_back(scaled_family("1e-310 m", 1e-310, 0.0));
  all.push_back(scaled_family("far from the origin", 1.0, 1e8));
}

void append_degenerate(std::vector<MotionFamily>& all) {
  all.push_back(family("parallel", make_parallel));
  all.push_back(family("staying parallel", [](MovingParts& parts, Random& random) {
    make_parallel(parts, random);
    parts.a.turn = random.uniform(-0.5, 0.5) * parts.a.direction;
    parts.b.turn = random.uniform(-0.5, 0.5) * parts.b.direction;
  }));
  all.push_back(family("nearly parallel", [](MovingParts& parts, Random& random) {
    make_parallel(parts, random);
    const double angle = std::ldexp(1.0, -static_cast<int>(random.uniform(5.0, 50.0)));
    parts.b.direction += angle * random.direction();
    parts.a.turn = angle * random.direction();
    parts.b.turn = angle * random.direction();
  }));
  all.push_back(family("coincident", [](MovingParts& parts, Random& random) {
    const Vector3d direction = random.direction();
    parts.b = parts.a;
    parts.b.start += std::ldexp(1.0, -static_cast<int>(random.uniform(0.0, 60.0))) * direction;
    parts.b.way += 0.1 * random.direction();
  }));
  all.push_back(family("a point", [](MovingParts& parts, Random&) {
    parts.a.direction = Vector3d::Zero();
    stay(parts.a);
  }));
  all.push_back(family("two points", make_points));
  all.push_back(family("a point at some time", [](MovingParts& parts, Random& random) {
    parts.a.turn = -random.uniform(1.0, 3.0) * parts.a.direction;
  }));
}

void append_grazing(std::vector<MotionFamily>& all) {
  const auto translate_parallel = [](MovingParts& parts, Random& random) {
    make_parallel(parts, random);
    translate(parts, random);
  };
  const auto slide = [=](MovingParts& parts, Random& random) {
    translate_parallel(parts, random);
    parts.b.way = parts.a.way + random.uniform(-1.0, 1.0) * parts.a.direction;
  };
  all.push_back(family("grazing", leave, grazing_radii));
  all.push_back(family("grazing, translating", translate, grazing_radii));
  all.push_back(family("grazing, parallel", translate_parallel, grazing_radii));
  all.push_back(family("grazing points", make_points, grazing_radii));
  all.push_back(family("sliding", slide, grazing_radii));
  all.push_back(touching_family("touching before", 0.0));
  all.push_back(touching_family("touching after", 1.0));
  all.push_back(crossing_family("crossing", false));
  all.push_back(crossing_family("crossing at an end", true));
  all.push_back(nearly_crossing_family("crossing, but for a rounding"));
}

}  // namespace

const std::vector<MotionFamily>& motion_families() {
  static const std::vector<MotionFamily> families = [] {
    std::vector<MotionFamily> all;
    append_general(all);
    append_degenerate(all);
    append_grazing(all);
    return all;
  }();
  return families;
}

std::vector<HardMotion> hard_motions(const MotionFamily& family, std::uint32_t count,
                                     std::uint64_t seed) {
  Random random(seed);
  std::vector<HardMotion> motions;
  motions.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    motions.push_back(family.make(random));
  }
  return motions;
}

}  // namespace fiber
