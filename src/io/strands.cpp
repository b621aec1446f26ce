#include "src/io/strands.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/io/radii.hpp"
#include "src/text/lower_case.hpp"

namespace fiber {
namespace {

/// Leaves out strands of fewer than two points.
/// @return how many there were
std::size_t skip_single_points(Strands& strands) {
  const std::size_t count = strands.count();
  const bool is_per_point = !strands.radii.empty() && strands.radius_per == RadiusPer::POINT;
  const bool is_per_strand = !strands.radii.empty() && strands.radius_per == RadiusPer::FIBER;
  std::vector<std::uint8_t>& closed = strands.topology.closed;
  std::vector<std::int32_t>& joints = strands.topology.joints;
  std::size_t strand_count = 0;
  std::uint32_t point_count = 0;
  std::uint32_t begin = 0;
  for (std::size_t strand = 0; strand < count; ++strand) {
    const std::uint32_t end = strands.offsets[strand + 1];
    if (end - begin > 1) {
      for (std::uint32_t i = begin; i < end; ++i, ++point_count) {
        strands.points[point_count] = strands.points[i];
        if (is_per_point) {
          strands.radii[point_count] = strands.radii[i];
        }
        if (!joints.empty()) {
          joints[point_count] = joints[i];
        }
      }
      if (is_per_strand) {
        strands.radii[strand_count] = strands.radii[strand];
      }
      if (!closed.empty()) {
        closed[strand_count] = closed[strand];
      }
      strands.offsets[++strand_count] = point_count;
    }
    begin = end;
  }
  strands.points.resize(point_count);
  joints.resize(joints.empty() ? 0 : point_count);
  closed.resize(closed.empty() ? 0 : strand_count);
  strands.offsets.resize(strand_count + 1);
  if (is_per_point || is_per_strand) {
    strands.radii.resize(is_per_point ? point_count : strand_count);
  }
  return count - strand_count;
}

}  // namespace

void Strands::end_strand(const std::string& name) {
  constexpr std::size_t max_points = 0x7fff'ffffU;
  if (points.size() > max_points) {
    throw FileError(name,
                    "has more than " + text_of(max_points) + " points, as many as are supported");
  }
  offsets.push_back(static_cast<std::uint32_t>(points.size()));
}

std::string note_of_skipped(std::size_t count) {
  return text_of(count) + (count == 1 ? " fibre" : " fibres") +
         " of fewer than two points left out, as skip_single_points says";
}

FiberFile to_file(Strands strands, const ReadOptions& options, const std::string& name,
                  const char* what) {
  check_default_radius(options.default_radius);
  if (options.skip_single_points) {
    if (const std::size_t skipped = skip_single_points(strands)) {
      strands.notes.push_back(note_of_skipped(skipped));
    }
  }
  for (std::size_t strand = 0; strand < strands.count(); ++strand) {
    const std::uint32_t points = strands.offsets[strand + 1] - strands.offsets[strand];
    if (points < 2) {
      throw FileError(name, std::string(what) + ' ' + text_of(strand) + " has " + text_of(points) +
                                (points == 1 ? " point, " : " points, ") + single_point_rule);
    }
  }
  if (strands.radii.empty()) {
    strands.radii.push_back(options.default_radius);
  }
  std::vector<std::uint8_t>& closed = strands.topology.closed;
  if (std::count(closed.begin(), closed.end(), 0) == static_cast<std::ptrdiff_t>(closed.size())) {
    closed.clear();
  }
  if (const auto lonely = lonely_joints(strands.topology.joints); !lonely.empty()) {
    strands.notes.push_back("joint " + text_of(lonely.front().joint) +
                            " joins nothing: one point alone has it");
  }
  try {
    FiberAssembly fibers(std::move(strands.points), std::move(strands.offsets),
                         shared_if_equal(std::move(strands.radii)), strands.topology);
    return {false, {{0, std::move(fibers)}}, std::move(strands.notes)};
  } catch (const std::invalid_argument& error) {
    throw FileError(name, error.what());  // all but joints and closed fibres was checked before
  }
}

bool is_radius_name(std::string_view name) {
  const std::string small = lower_case(name);
  return small == "radius" || small == "tuberadius";
}

}  // namespace fiber
