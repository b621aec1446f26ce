#include "src/io/strands.hpp"

#include <utility>

#include "src/io/radii.hpp"

namespace fiber {
namespace {

/// Leaves out strands of fewer than two points.
/// @return how many there were
std::size_t skip_single_points(Strands& strands) {
  const std::size_t count = strands.count();
  const bool is_per_point = !strands.radii.empty() && strands.radius_per == RadiusPer::POINT;
  const bool is_per_strand = !strands.radii.empty() && strands.radius_per == RadiusPer::FIBER;
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
      }
      if (is_per_strand) {
        strands.radii[strand_count] = strands.radii[strand];
      }
      strands.offsets[++strand_count] = point_count;
    }
    begin = end;
  }
  strands.points.resize(point_count);
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
  return {false,
          {{0, FiberAssembly(std::move(strands.points), std::move(strands.offsets),
                             shared_if_equal(std::move(strands.radii)))}},
          std::move(strands.notes)};
}

bool is_radius_name(std::string_view name) {
  std::string small;
  for (const char letter : name.substr(0, 16)) {
    small += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return small == "radius" || small == "tuberadius";
}

}  // namespace fiber
