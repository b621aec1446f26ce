#include "src/sim/scene/sections.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/named_nodes.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

RodMaterial read_preset(const YamlField& field) {
  return with_context(field.place(), [&] { return material_preset(field.text()); });
}

}  // namespace

RodMaterial read_material(const YamlField& field, const RodMaterial& otherwise,
                          std::string& defaults) {
  if (field.is_text()) {
    return read_preset(field);
  }
  field.require_map(key_names("material"));
  const auto preset = field.find("preset");
  RodMaterial material = preset ? read_preset(*preset) : otherwise;
  const auto read = [&](const char* key, double& value, const char* unit) {
    if (!preset && !field.find(key)) {
      defaults += format(defaults.empty() ? "" : ", ", key, " ", value, unit);
    }
    field.read(key, value);
  };
  read("youngs_modulus", material.youngs_modulus, " Pa");
  read("shear_modulus", material.shear_modulus, " Pa");
  read("density", material.density, " kg/m^3");
  read("bending_share", material.bending_share, "");
  field.read("bending_ratio", material.bending_ratio);
  return material;
}

namespace {

SectionEntry read_section(const YamlField& entry, const FiberBody& body) {
  entry.require_map(key_names("section"));
  SectionEntry section;
  section.place = entry.place();
  section.part = read_part(entry, body.length);
  if (const auto radius = entry.find("radius")) {
    section.radius = radius->number();
    if (!key_limits("section", "radius").contain(*section.radius)) {
      radius->refuse(key_limits("section", "radius").text());
    }
  }
  const auto rigid = entry.find("rigid");
  section.is_rigid = rigid && rigid->flag();
  const bool has_other = section.radius || section.is_rigid;
  const auto given = entry.find("material");
  if (!has_other && !given) {
    throw std::invalid_argument(
        entry.place() + " changes nothing: a section has a material, a radius, or is rigid");
  }
  std::string inherited;
  const RodMaterial material =
      given ? read_material(*given, body.material, inherited) : body.material;
  section.section = with_context(given ? given->place() : section.place, [&] {
    return solid_round_section(material, section.radius.value_or(body.radius));
  });
  return section;
}

/// Whether it goes from one node to another.
bool has_nodes(const SectionEntry& section) { return section.radius || section.is_rigid; }

/// The share of a fibre's length where a section begins or ends; that of a joint or of an end that
/// is there, but for a rounding.
double share_of(const FiberEntry& fiber, double length) {
  constexpr double rounding = 1e-9;
  const double share = std::min(1.0, length / fiber.length);
  for (const double joint : fiber.joint_shares) {
    if (std::abs(joint - share) <= rounding) {
      return joint;
    }
  }
  return share <= rounding ? 0.0 : (share >= 1.0 - rounding ? 1.0 : share);
}

void require_straight(const FiberEntry& fiber, const SectionEntry& section) {
  constexpr double most = 9.0;  // [degree]
  const double from = share_of(fiber, section.part.from);
  const double to = share_of(fiber, section.part.to);
  const auto point_at = [&](double share) -> Eigen::Vector3d {
    return share == 0.0   ? fiber.curve.front()
           : share == 1.0 ? fiber.curve.back()
                          : cut_curve(fiber.curve, 2, {{share, 1}})[1];
  };
  // An arc of an angle x has a chord of sin(x / 2) / (x / 2) = 1 - x² / 24 + ... of its length.
  const double chord = (point_at(to) - point_at(from)).norm();
  const double length = section.part.to - section.part.from;
  const double angle = std::sqrt(24.0 * std::max(0.0, 1.0 - chord / length)) * 180.0 / M_PI;
  if (!(angle <= most)) {
    throw std::invalid_argument(format(section.place, " is rigid, but the fibre's shape is bent ",
                                       "there, as an arc of ", angle, " degrees, at most ", most,
                                       " are allowed"));
  }
}

void require_rigid_parts(const FiberEntry& fiber, std::int64_t segments) {
  double length = fiber.length;  // of the rest
  std::int64_t edges = segments;
  for (const SectionEntry& section : fiber.sections) {
    if (section.is_rigid) {
      length -= section.part.to - section.part.from;
      --edges;
    }
  }
  for (std::size_t i = 0; i < fiber.sections.size(); ++i) {
    const SectionEntry& section = fiber.sections[i];
    if (!section.is_rigid) {
      continue;
    }
    const double own = section.part.to - section.part.from;
    constexpr double rounding = 1e-9;
    if (edges > 0 && !(own >= (1.0 - rounding) * length / static_cast<double>(edges))) {
      throw std::invalid_argument(format(
          section.place, " is rigid and ", own, " m long, it must be no shorter than a segment of ",
          "the rest of the fibre, ", length / static_cast<double>(edges), " m"));
    }
    if (i > 0 && fiber.sections[i - 1].is_rigid &&
        fiber.sections[i - 1].part.to == section.part.from) {
      throw std::invalid_argument(section.place +
                                  " is rigid as the one right before it: they must be one");
    }
    if (fiber.is_closed && i > 0 && fiber.sections.front().is_rigid &&
        share_of(fiber, fiber.sections.front().part.from) == 0.0 &&
        share_of(fiber, section.part.to) == 1.0) {
      throw std::invalid_argument(
          section.place +
          " is rigid and meets the first section, rigid as well, where the fibre is closed: the "
          "fibre must begin elsewhere, so that they are one");
    }
    for (const double joint : fiber.joint_shares) {
      if (joint > share_of(fiber, section.part.from) && joint < share_of(fiber, section.part.to)) {
        throw std::invalid_argument(
            format(section.place, " is rigid, a joint at ", joint,
                   " of the fibre's length must not be inside of it, only at its ends"));
      }
    }
    require_straight(fiber, section);
  }
}

}  // namespace

std::vector<SectionEntry> read_sections(const YamlField& fiber, const FiberBody& body) {
  std::vector<SectionEntry> sections;
  const auto list = fiber.find("sections");
  if (!list) {
    return sections;
  }
  double end = 0.0;  // of the section before
  for (const YamlField& each : list->items()) {
    SectionEntry section = read_section(each, body);
    if (section.part.from < end) {
      throw std::invalid_argument(each.place() + " begins at " + std::to_string(section.part.from) +
                                  " m, it must be behind the section before, which ends at " +
                                  std::to_string(end) + " m");
    }
    end = section.part.to;
    sections.push_back(std::move(section));
  }
  return sections;
}

NodesAt nodes_of(const FiberEntry& fiber, std::int64_t segments) {
  require_rigid_parts(fiber, segments);
  std::vector<double> shares = fiber.joint_shares;
  RigidShares rigid;
  for (const SectionEntry& section : fiber.sections) {
    if (has_nodes(section)) {
      const double from = share_of(fiber, section.part.from);
      const double to = share_of(fiber, section.part.to);
      shares.push_back(from);
      shares.push_back(to);
      if (section.is_rigid) {
        rigid.emplace_back(from, to);
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  return with_context(fiber.place, [&] { return nodes_at(shares, segments, rigid); });
}

void set_sections(const FiberEntry& entry, const NodesAt& nodes, Rods& rods) {
  const std::uint32_t rod = rods.count() - 1;
  std::vector<double> arcs{0.0};
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    arcs.push_back(arcs.back() + rods.rest_lengths[i]);
  }
  std::vector<RodSectionPart> parts;
  double end = 0.0;
  for (const SectionEntry& each : entry.sections) {
    RodPart part = along_edges(each.part, entry.length, rods, rod);
    if (has_nodes(each)) {
      part = {arcs[nodes.at(share_of(entry, each.part.from))],
              arcs[nodes.at(share_of(entry, each.part.to))]};
    }
    // Beside one that goes from node to node, another may be cut a little longer or shorter.
    part.from = std::max(part.from, end);
    if (part.from >= part.to) {
      continue;
    }
    if (!parts.empty() && has_nodes(each)) {
      parts.back().part.to = std::min(parts.back().part.to, part.from);
    }
    end = part.to;
    parts.push_back({part, each.section, each.radius, each.is_rigid});
  }
  if (!parts.empty()) {
    rods.set_sections(rod, parts);
  }
}

}  // namespace fiber
