#include "src/io/vtk_lines.hpp"

#include <algorithm>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {

void VtkLines::add(const VtkPiece& piece) {
  const std::size_t point_count = piece.points.numbers.size() / 3;
  const std::size_t id_count = piece.ids.numbers.size();
  std::vector<bool> is_used(point_count, false);
  std::size_t begin = 0;
  for (std::size_t line = 0; line < piece.ends.numbers.size(); ++line) {
    const std::int64_t end = piece.ends.numbers.whole(line);
    if (end < 0 || static_cast<std::uint64_t>(end) < begin ||
        static_cast<std::uint64_t>(end) > id_count) {
      refuse("line " + text_of(line) + " ends at " + text_of(end) + " of " + piece.ends.place +
             ", expected " + text_of(begin) + " to " + text_of(id_count));
    }
    for (; begin < static_cast<std::size_t>(end); ++begin) {
      const std::int64_t id = piece.ids.numbers.whole(begin);
      if (id < 0 || static_cast<std::uint64_t>(id) >= point_count) {
        refuse("line " + text_of(line) + " has the point " + text_of(id) + " (" + piece.ids.place +
               "), there are " + text_of(point_count));
      }
      is_used[static_cast<std::size_t>(id)] = true;
      add_point(piece, line, static_cast<std::size_t>(id));
    }
    strands_.end_strand(name_);
  }
  if (begin != id_count) {
    refuse("the lines end at " + text_of(begin) + " of " + piece.ends.place + ", " +
           piece.ids.place + " has " + text_of(id_count) + " numbers");
  }
  points_ += point_count;
  unused_points_ += static_cast<std::uint64_t>(std::count(is_used.begin(), is_used.end(), false));
}

void VtkLines::add_point(const VtkPiece& piece, std::size_t line, std::size_t id) {
  const NumberArray& numbers = piece.points.numbers;
  strands_.points.emplace_back(numbers.real(3 * id), numbers.real(3 * id + 1),
                               numbers.real(3 * id + 2));
  check_point(name_, strands_.points.back(), [&](int) {
    return "point " + text_of(id) + " of line " + text_of(line) + " (" + piece.points.place + ')';
  });
  if (piece.radii) {
    strands_.radii.push_back(piece.radii->numbers.real(id));
    check_radius(name_, strands_.radii.back(), [&] {
      return "the radius of point " + text_of(id) + " of line " + text_of(line) + " (" +
             piece.radii->place + ')';
    });
  }
}

void VtkLines::skip_array(std::string_view array) {
  // What write_vtp() writes for people: the lines tell it as well.
  if (array != "fiber") {
    arrays_.push_back(quote(array));
  }
}

Strands VtkLines::finish() {
  constexpr std::size_t max_names = 10;
  if (strands_.count() == 0 && (points_ > 0 || other_cells_ > 0)) {
    refuse("has no lines, but " + text_of(points_) + " points and " + text_of(other_cells_) +
           " cells of other kinds");
  }
  if (!strands_.radii.empty() && strands_.radii.size() != strands_.points.size()) {
    refuse("some pieces have radii, and others have none");
  }
  if (other_cells_ > 0) {
    strands_.notes.push_back(text_of(other_cells_) + " cells that are no lines are not read");
  }
  if (unused_points_ > 0) {
    strands_.notes.push_back(text_of(unused_points_) + " points that are in no line are not read");
  }
  if (!arrays_.empty()) {
    std::string names;
    for (std::size_t i = 0; i < std::min(max_names, arrays_.size()); ++i) {
      names += (i == 0 ? "" : ", ") + arrays_[i];
    }
    strands_.notes.push_back("arrays not read: " + names +
                             (arrays_.size() > max_names
                                  ? " and " + text_of(arrays_.size() - max_names) + " more"
                                  : ""));
  }
  return std::move(strands_);
}

}  // namespace fiber
