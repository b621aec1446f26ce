#include "fiber_proximity/sim/loads.hpp"

#include <cmath>
#include <map>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/named_nodes.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/times.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// The force and the moment of a load at a time.
struct Exerted {
  Vector3d force = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();
  double torque = 0.0;
};

/// Whether moments and torques may act where a load is.
struct Allowed {
  bool has_twist;
  bool is_at_end;
};

/// Changes what is exerted by the keys of an entry; without a key, the value stays.
void read_exerted(const YamlField& entry, const Allowed& allowed, Exerted& exerted) {
  const auto force = entry.find("force");
  const auto moment = entry.find("moment");
  const auto torque = entry.find("torque");
  if (force) {
    exerted.force = force->vector();
    if (!exerted.force.allFinite()) {
      force->refuse("finite");
    }
  }
  if (moment) {
    if (!allowed.is_at_end) {
      moment->refuse(
          "absent but at the first or last node: in between there is only a torque, with twist");
    }
    exerted.moment = moment->vector();
    if (!exerted.moment.allFinite()) {
      moment->refuse("finite");
    }
  }
  if (torque) {
    if (!allowed.has_twist) {
      torque->refuse("absent where there is no twist: cross-sections that turn freely resist none");
    }
    exerted.torque = torque->number();
    if (!std::isfinite(exerted.torque)) {
      torque->refuse("finite");
    }
  }
}

/// One of the quantities of a table.
template <class Value>
TimeTable<Value> column(const std::vector<TimeTable<Exerted>::Entry>& table, bool is_periodic,
                        Value Exerted::*part) {
  std::vector<typename TimeTable<Value>::Entry> entries;
  for (const auto& entry : table) {
    entries.push_back({entry.time, entry.value.*part});
  }
  return TimeTable<Value>(entries, is_periodic);
}

/// Reads where a load is: at a node, or along a part.
void read_place(const YamlField& entry, const SimDescription& scene, Loads::Load& load) {
  const auto node = entry.find("node");
  const auto from = entry.find("from");
  const auto to = entry.find("to");
  if (node && (from || to)) {
    node->refuse("absent where there is a part, from and to");
  }
  if (!node && !from && !to) {
    throw std::invalid_argument(entry.place() +
                                " says not where it is, it must have a node, or from and to");
  }
  if (node) {
    load.node = read_node(node, scene.rods.given_node_count(load.rod));
  } else {
    const double length = scene.fibers[load.rod].length;
    load.part = along_edges(read_part(entry, length), length, scene.rods, load.rod);
  }
}

SimLoad read_load(const YamlField& entry, const SimDescription& scene, std::uint32_t rod) {
  SimLoad read;
  read.place = entry.place();
  Loads::Load& load = read.load;
  load.rod = rod;
  read_place(entry, scene, load);
  const bool is_at_end = !load.part && !scene.rods.is_closed(rod) &&
                         (load.node == 0 || load.node + 1 == scene.rods.node_count(rod));
  const Allowed allowed{scene.has_effect("twist"), is_at_end};
  Exerted exerted;
  read_exerted(entry, allowed, exerted);
  if (const auto mass = entry.find("mass")) {
    load.mass = mass->number();
    if (!key_limits("load", "mass").contain(load.mass)) {
      mass->refuse(key_limits("load", "mass").text());
    }
  }
  const auto table = read_table<Exerted>(
      entry, {"force", "moment", "torque"}, exerted,
      [&](const YamlField& each, Exerted& value) { read_exerted(each, allowed, value); });
  const bool is_periodic = entry.find("period").has_value();
  load.force = column(table, is_periodic, &Exerted::force);
  load.moment = column(table, is_periodic, &Exerted::moment);
  load.torque = column(table, is_periodic, &Exerted::torque);
  const bool has_table = entry.find("table").has_value();
  for (const char* name : {"force", "moment", "torque"}) {
    if (!has_table && entry.find(name)) {
      read.parameters.emplace_back(name);
    }
  }
  if (!has_table && read.parameters.empty() && !entry.find("mass")) {
    throw std::invalid_argument(
        read.place + " does nothing, it must have a force, moment, torque, mass or table");
  }
  return read;
}

/// The name of a parameter of an entry, and its numbers.
std::map<std::string, std::vector<double>> parameters_of(const SimLoad& load) {
  std::map<std::string, std::vector<double>> parameters;
  const auto numbers = [](const Vector3d& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  for (const std::string& name : load.parameters) {
    parameters[std::to_string(load.entry) + "." + name] =
        name == "force"    ? numbers(load.load.force.at(0.0))
        : name == "moment" ? numbers(load.load.moment.at(0.0))
                           : std::vector<double>{load.load.torque.at(0.0)};
  }
  return parameters;
}

/// Changes the loads to what the parameters say.
void apply(const std::vector<SimLoad>& described, const EffectOptions& options, Loads& loads) {
  for (std::uint32_t i = 0; i < described.size(); ++i) {
    for (const std::string& name : described[i].parameters) {
      const std::vector<double>& value =
          options.at(std::to_string(described[i].entry) + "." + name);
      if (name == "torque") {
        loads.set_torque(i, value.front());
      } else if (name == "moment") {
        loads.set_moment(i, Vector3d(value.data()));
      } else {
        loads.set_force(i, Vector3d(value.data()));
      }
    }
  }
}

}  // namespace

void read_loads(const YamlField& list, SimDescription& scene) {
  std::uint32_t index = 0;
  for (const YamlField& entry : list.items()) {
    entry.require_map(key_names("load"));
    for (const std::uint32_t rod : find_fibers(entry.get("fiber"), scene.fibers)) {
      with_fiber_name(scene.fibers[rod].name, [&] {
        scene.loads.push_back(read_load(entry, scene, rod));
        scene.loads.back().entry = index;
      });
    }
    ++index;
  }
}

std::shared_ptr<Loads> make_loads(const SimDescription& description, Rods& rods, SimScene& scene) {
  if (description.find_effect("load") == nullptr) {
    return nullptr;
  }
  auto loads = std::make_shared<Loads>();
  EffectOptions options;
  for (const SimLoad& load : description.loads) {
    with_context(load.place, [&] { loads->add(rods, load.load); });
    options.merge(parameters_of(load));
  }
  if (!options.empty()) {
    scene.parameters.add("load", options,
                         [loads, described = description.loads](const EffectOptions& changed) {
                           apply(described, changed, *loads);
                         });
  }
  return loads;
}

}  // namespace fiber
