// .swc files, trees of neurons: neuroinformatics.nl/swcPlus
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "src/io/fiber_formats.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/io/number_array.hpp"
#include "src/io/strands.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::int64_t soma = 1;  // the type of points of a cell's body

/// A line of the file.
struct SwcNode {
  std::int64_t id = 0;
  std::int64_t type = 0;
  std::int64_t parent = 0;  // -1: none
  Eigen::Vector3d point;    // [m]
  double radius = 0.0;      // [m]
  std::size_t line = 0;
};

class SwcReader {
 public:
  explicit SwcReader(const std::string& name) : name_(name) {}

  void read_line(std::string_view text) {
    ++line_;
    std::string_view rest = text;
    std::array<std::string_view, 7> words;
    for (std::string_view& word : words) {
      word = take_word(rest);
    }
    if (words.front().empty() || words.front().front() == '#') {
      return;
    }
    const std::string_view more = take_word(rest);
    if (words.back().empty() || !(more.empty() || more.front() == '#')) {
      refuse(line_, "is " + quote(text) + ", expected id type x y z radius parent");
    }
    SwcNode node;
    node.line = line_;
    node.id = whole("id", words[0], 0);
    node.type = whole("type", words[1], std::numeric_limits<std::int64_t>::min());
    node.parent = whole("parent", words[6], -1);
    for (int axis = 0; axis < 3; ++axis) {
      const char name[] = {"xyz"[axis], '\0'};
      node.point[axis] = micrometres(name, words[static_cast<std::size_t>(axis) + 2]);
      if (!FiberAssembly::is_valid_coordinate(node.point[axis])) {
        refuse(line_, std::string(name) + " is " +
                          quote(words[static_cast<std::size_t>(axis) + 2]) + ", " +
                          FiberAssembly::coordinate_rule);
      }
    }
    node.radius = micrometres("radius", words[5]);
    if (!FiberAssembly::is_valid_radius(node.radius)) {
      refuse(line_, "radius is " + quote(words[5]) + ", " + FiberAssembly::radius_rule);
    }
    if (const auto known = indices_.find(node.id); known != indices_.end()) {
      refuse(line_, "id is " + text_of(node.id) + ", which line " +
                        text_of(nodes_[known->second].line) + " has, too");
    }
    indices_.emplace(node.id, nodes_.size());
    nodes_.push_back(node);
  }

  Strands finish() {
    find_parents();
    require_no_cycles();
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (nodes_[node].type == soma) {
        ++soma_points_;
      } else if (begins_section(node)) {
        add_section(node);
      }
    }
    if (soma_points_ > 0) {
      strands_.notes.push_back(
          text_of(soma_points_) +
          (soma_points_ == 1 ? " point of the soma is" : " points of the soma are") +
          " not read: neurites begin at their first own point");
    }
    if (joint_count_ == 0) {
      strands_.topology.joints.clear();
    }
    return std::move(strands_);
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  [[noreturn]] void refuse(std::size_t line, const std::string& reason) const {
    throw FileError(name_, line, reason);
  }

  std::int64_t whole(const char* name, std::string_view word, std::int64_t min) const {
    const auto value = parse_number<std::int64_t>(word);
    if (!value || *value < min) {
      refuse(line_, std::string(name) + " is " + quote(word) + ", expected a whole number" +
                        (min == 0    ? " from 0"
                         : min == -1 ? " from -1"
                                     : ""));
    }
    return *value;
  }

  /// @return [m]
  double micrometres(const char* name, std::string_view word) const {
    const auto value = parse_number<double>(word);
    if (!value) {
      refuse(line_, std::string(name) + " is " + quote(word) + ", expected a number");
    }
    return *value / 1e6;
  }

  void find_parents() {
    parents_.assign(nodes_.size(), none);
    children_.assign(nodes_.size(), {});
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      if (nodes_[node].parent == -1) {
        continue;
      }
      const auto parent = indices_.find(nodes_[node].parent);
      if (parent == indices_.end()) {
        refuse(nodes_[node].line,
               "parent is " + text_of(nodes_[node].parent) + ", there is no such point");
      }
      parents_[node] = parent->second;
      if (nodes_[node].type != soma) {
        children_[parent->second].push_back(node);
      }
    }
  }

  void require_no_cycles() const {
    std::vector<std::size_t> seen(nodes_.size(), none);  // from which node
    for (std::size_t begin = 0; begin < nodes_.size(); ++begin) {
      std::size_t node = begin;
      for (; node != none && seen[node] == none; node = parents_[node]) {
        seen[node] = begin;
      }
      if (node != none && seen[node] == begin) {
        refuse(nodes_[node].line,
               "point " + text_of(nodes_[node].id) + " is among its own ancestors");
      }
    }
  }

  bool has_fiber_parent(std::size_t node) const {
    return parents_[node] != none && nodes_[parents_[node]].type != soma;
  }

  /// Whether more or less than one neurite goes on from a point.
  bool branches(std::size_t node) const { return children_[node].size() > 1; }

  bool is_root(std::size_t node) const { return !has_fiber_parent(node); }

  /// Whether a fibre leads from the parent to this point first, or begins here.
  bool begins_section(std::size_t node) const {
    return is_root(node) ? !branches(node) : branches(parents_[node]);
  }

  /// From a branch, or a root, to the next branch or the end.
  void add_section(std::size_t node) {
    if (!is_root(node)) {
      add_point(parents_[node]);
    }
    add_point(node);
    while (children_[node].size() == 1) {
      node = children_[node].front();
      add_point(node);
    }
    strands_.end_strand(name_);
  }

  /// Points where fibres meet have a number.
  void add_point(std::size_t node) {
    strands_.points.push_back(nodes_[node].point);
    strands_.radii.push_back(nodes_[node].radius);
    std::int32_t joint = -1;
    if (branches(node)) {
      const auto [known, is_new] = joints_.emplace(node, joint_count_);
      joint_count_ += is_new ? 1 : 0;
      joint = known->second;
    }
    strands_.topology.joints.push_back(joint);
  }

  const std::string& name_;
  std::size_t line_ = 0;
  std::vector<SwcNode> nodes_;
  std::unordered_map<std::int64_t, std::size_t> indices_;  // of nodes, by id
  std::vector<std::size_t> parents_;
  std::vector<std::vector<std::size_t>> children_;  // without those of the soma
  std::unordered_map<std::size_t, std::int32_t> joints_;
  std::int32_t joint_count_ = 0;
  std::size_t soma_points_ = 0;
  Strands strands_;
};

}  // namespace

FiberFile read_swc(std::istream& stream, const std::string& name, const ReadOptions& options) {
  SwcReader reader(name);
  for_each_line(stream, name, [&](std::string_view line) { reader.read_line(line); });
  return to_file(reader.finish(), options, name, "fibre");
}

}  // namespace fiber
