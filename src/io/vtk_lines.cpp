#include "src/io/vtk_lines.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {

void VtkLines::add(const VtkPiece& piece) {
  const std::size_t id_count = piece.ids.numbers.size();
  const std::size_t first_point = strands_.points.size();
  ids_.clear();
  std::size_t begin = 0;
  for (std::size_t line = 0; line < piece.ends.numbers.size(); ++line) {
    const std::int64_t end = piece.ends.numbers.whole(line);
    if (end < 0 || static_cast<std::uint64_t>(end) < begin ||
        static_cast<std::uint64_t>(end) > id_count) {
      refuse("line " + text_of(line) + " ends at " + text_of(end) + " of " + piece.ends.place +
             ", expected " + text_of(begin) + " to " + text_of(id_count));
    }
    add_line(piece, line, begin, static_cast<std::size_t>(end));
    begin = static_cast<std::size_t>(end);
  }
  if (begin != id_count) {
    refuse("the lines end at " + text_of(begin) + " of " + piece.ends.place + ", " +
           piece.ids.place + " has " + text_of(id_count) + " numbers");
  }
  join(piece, first_point);
}

void VtkLines::add_line(const VtkPiece& piece, std::size_t line, std::size_t begin,
                        std::size_t end) {
  const bool is_closed =
      end - begin > 1 && id_at(piece, line, begin) == id_at(piece, line, end - 1);
  if (is_closed && end - begin < 4) {
    refuse("line " + text_of(line) + " is closed and has " + text_of(end - begin - 1) +
           " points, a closed fibre needs at least 3");
  }
  for (std::size_t i = begin; i < end - (is_closed ? 1 : 0); ++i) {
    add_point(piece, line, id_at(piece, line, i));
  }
  strands_.end_strand(name_);
  strands_.topology.closed.push_back(is_closed ? 1 : 0);
}

std::size_t VtkLines::id_at(const VtkPiece& piece, std::size_t line, std::size_t index) const {
  const std::size_t point_count = piece.points.numbers.size() / 3;
  const std::int64_t id = piece.ids.numbers.whole(index);
  if (id < 0 || static_cast<std::uint64_t>(id) >= point_count) {
    refuse("line " + text_of(line) + " has the point " + text_of(id) + " (" + piece.ids.place +
           "), there are " + text_of(point_count));
  }
  return static_cast<std::size_t>(id);
}

/// Gives numbers to joints: those of the file, from 0 on in each piece, and others to points that
/// are used more than once.
void VtkLines::join(const VtkPiece& piece, std::size_t first_point) {
  const std::size_t point_count = piece.points.numbers.size() / 3;
  std::vector<std::uint8_t> uses(point_count, 0);
  for (const std::size_t id : ids_) {
    uses[id] = static_cast<std::uint8_t>(std::min(2, uses[id] + 1));
  }
  const std::int64_t first_joint = joint_count_;
  std::vector<std::int64_t> joints(point_count, -1);
  for (std::size_t id = 0; piece.joints && id < point_count; ++id) {
    const std::int64_t joint = piece.joints->numbers.whole(id);
    if (joint > std::numeric_limits<std::int32_t>::max()) {
      refuse("joint is " + text_of(joint) + " (" + piece.joints->place + "), beyond 32 bits");
    }
    if (joint >= 0) {
      joints[id] = first_joint + joint;
      joint_count_ = std::max(joint_count_, joints[id] + 1);
    }
  }
  for (std::size_t id = 0; id < point_count; ++id) {
    if (uses[id] > 1 && joints[id] < 0) {
      joints[id] = joint_count_++;
    }
  }
  if (joint_count_ > std::numeric_limits<std::int32_t>::max()) {
    refuse("has more joints than 32 bits count");
  }
  std::vector<std::int32_t>& all = strands_.topology.joints;
  all.resize(first_point, -1);
  for (const std::size_t id : ids_) {
    all.push_back(static_cast<std::int32_t>(joints[id]));
  }
  points_ += point_count;
  unused_points_ += static_cast<std::uint64_t>(std::count(uses.begin(), uses.end(), 0));
}

void VtkLines::add_point(const VtkPiece& piece, std::size_t line, std::size_t id) {
  const NumberArray& numbers = piece.points.numbers;
  strands_.points.emplace_back(numbers.real(3 * id), numbers.real(3 * id + 1),
                               numbers.real(3 * id + 2));
  check_point(name_, strands_.points.back(), [&](int) {
    return "point " + text_of(id) + " of line " + text_of(line) + " (" + piece.points.place + ')';
  });
  ids_.push_back(id);
  if (piece.radii) {
    strands_.radii.push_back(piece.radii->numbers.real(id));
    check_radius(name_, strands_.radii.back(), [&] {
      return "the radius of point " + text_of(id) + " of line " + text_of(line) + " (" +
             piece.radii->place + ')';
    });
  }
}

void VtkLines::skip_array(std::string_view array) {
  // write_vtp() writes it for people; the lines tell it as well.
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
  if (joint_count_ == 0) {
    strands_.topology.joints.clear();
  }
  return std::move(strands_);
}

}  // namespace fiber
