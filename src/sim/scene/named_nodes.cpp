#include "src/sim/scene/named_nodes.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "src/sim/scene/parts.hpp"
#include "src/text/join.hpp"

namespace fiber {

std::vector<std::uint32_t> find_fibers(const YamlField& name, const std::vector<SimFiber>& fibers) {
  const std::string wanted = name.text();
  std::vector<std::uint32_t> found;
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < fibers.size(); ++i) {
    if (fibers[i].name == wanted || fibers[i].group == wanted) {
      found.push_back(i);
    }
    names.insert(fibers[i].group);
  }
  if (found.empty()) {
    name.refuse("the name of a fibre of the scene: " + shortened(join(names)));
  }
  return found;
}

std::uint32_t read_node(const std::optional<YamlField>& node, std::uint32_t count) {
  const std::uint32_t last = count - 1;
  if (!node || node->text() == "first") {
    return 0;
  }
  return node->text() == "last" ? last : static_cast<std::uint32_t>(node->integer(0, last));
}

RodPart read_part(const YamlField& entry, double length) {
  constexpr double rounding = 1e-6;  // of the length: that of an arc is measured along a polyline
  const auto from = entry.find("from");
  const auto to = entry.find("to");
  RodPart part{from ? from->number() : 0.0, to ? to->number() : length};
  if (!(part.from >= 0.0 && part.from < length)) {
    from->refuse(format("at least 0 and less than the fibre's length, ", length, " m"));
  }
  if (!(part.to > part.from && part.to <= (1.0 + rounding) * length)) {
    to->refuse(format("beyond `from` and at most the fibre's length, ", length, " m"));
  }
  part.to = std::min(part.to, length);
  return part;
}

RodPart along_edges(const RodPart& part, double length, const Rods& rods, std::uint32_t rod) {
  const double edges = std::accumulate(rods.rest_lengths.begin() + rods.first(rod),
                                       rods.rest_lengths.begin() + rods.end(rod), 0.0);
  const double ratio = edges / length;
  return {part.from * ratio, std::min(edges, part.to * ratio)};
}

}  // namespace fiber
