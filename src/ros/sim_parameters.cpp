#include "fiber_proximity/ros/sim_parameters.hpp"

#include <cmath>
#include <stdexcept>

#include "fiber_proximity/ros/listed.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using Value = SimParameters::Value;

/// In SI units: far beyond all that fibres are in, and far from where numbers end.
constexpr double largest = 1e6;

/// [character] Values that are longer are cut off in errors.
constexpr std::size_t longest_text = 80;

Value to_value(const Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Vector3d to_vector(const Value& value) { return {value[0], value[1], value[2]}; }

std::string text_of(const Value& value) {
  std::string text;
  for (const double number : value) {
    text += (text.empty() ? "" : ", ") + std::to_string(number);
    if (text.size() > longest_text) {
      text = text.substr(0, longest_text) + "...";
      break;
    }
  }
  return "[" + text + "]";
}

[[noreturn]] void refuse(const fiber_proximity::SimulationParameter& parameter,
                         const std::string& problem) {
  throw std::invalid_argument("parameter " + fiber::quote(parameter.name) + " is " +
                              text_of(parameter.value) + ": " + problem);
}

}  // namespace

// An effect with other numbers is another effect: its state is that of one step, which begins anew.

void SimParameters::add(fiber::Gravity& gravity, const Vector3d& acceleration) {
  effects_["gravity"] = {{{"acceleration", to_value(acceleration)}},
                         [&gravity](const Options& options) {
                           gravity = fiber::Gravity(to_vector(options.at("acceleration")));
                         }};
}

void SimParameters::add(fiber::Damping& damping, double relaxation_time) {
  effects_["damping"] = {{{"relaxation_time", {relaxation_time}}},
                         [&damping](const Options& options) {
                           damping = fiber::Damping(options.at("relaxation_time").front());
                         }};
}

void SimParameters::add(fiber::Drag& drag, const fiber::Drag::Options& options) {
  effects_["drag"] = {{{"fluid_density", {options.fluid_density}},
                       {"across", {options.across}},
                       {"along", {options.along}},
                       {"wind.mean", to_value(options.wind.mean)},
                       {"wind.gust", to_value(options.wind.gust)},
                       {"wind.gust_period", {options.wind.gust_period}},
                       {"wind.gust_length", {options.wind.gust_length}}},
                      [&drag](const Options& changed) {
                        fiber::Drag::Options wanted;
                        wanted.fluid_density = changed.at("fluid_density").front();
                        wanted.across = changed.at("across").front();
                        wanted.along = changed.at("along").front();
                        wanted.wind.mean = to_vector(changed.at("wind.mean"));
                        wanted.wind.gust = to_vector(changed.at("wind.gust"));
                        wanted.wind.gust_period = changed.at("wind.gust_period").front();
                        wanted.wind.gust_length = changed.at("wind.gust_length").front();
                        drag = fiber::Drag(wanted);
                      }};
}

void SimParameters::add(fiber::Friction& friction, const fiber::Friction::Options& options) {
  effects_["friction"] = {
      {{"coefficient", {options.coefficient}}, {"stick_speed", {options.stick_speed}}},
      [&friction](const Options& changed) {
        fiber::Friction::Options wanted;
        wanted.coefficient = changed.at("coefficient").front();
        wanted.stick_speed = changed.at("stick_speed").front();
        friction = fiber::Friction(wanted);
      }};
}

void SimParameters::set_one(const fiber_proximity::SimulationParameter& parameter) {
  const std::size_t dot = parameter.name.find('.');
  const auto effect = effects_.find(parameter.name.substr(0, dot));
  const std::string option = dot == std::string::npos ? "" : parameter.name.substr(dot + 1);
  if (effect == effects_.end() || effect->second.options.count(option) == 0) {
    std::vector<std::string> names;
    for (const auto& known : all()) {
      names.push_back(known.name);
    }
    refuse(parameter, names.empty() ? "the scene names no effect that has parameters"
                                    : "there is no such parameter, known are: " + listed(names));
  }
  Value& value = effect->second.options.at(option);
  if (parameter.value.size() != value.size()) {
    refuse(parameter, "it must be a list of " + std::to_string(value.size()) + " number(s)");
  }
  for (const double number : parameter.value) {
    if (!(std::abs(number) <= largest)) {
      refuse(parameter, "its numbers must be finite and at most 1e6 in magnitude");
    }
  }
  value = parameter.value;
  try {
    effect->second.apply(effect->second.options);
  } catch (const std::invalid_argument& error) {
    refuse(parameter, error.what());
  }
}

void SimParameters::set(const std::vector<fiber_proximity::SimulationParameter>& parameters) {
  const std::map<std::string, Entry> before = effects_;
  try {
    for (const auto& parameter : parameters) {
      set_one(parameter);
    }
  } catch (const std::invalid_argument&) {
    effects_ = before;
    for (const auto& [name, effect] : effects_) {
      effect.apply(effect.options);
    }
    throw;
  }
}

std::vector<fiber_proximity::SimulationParameter> SimParameters::all() const {
  std::vector<fiber_proximity::SimulationParameter> parameters;
  for (const auto& [effect, entry] : effects_) {
    for (const auto& [option, value] : entry.options) {
      parameters.emplace_back();
      parameters.back().name = effect;
      parameters.back().name += '.';
      parameters.back().name += option;
      parameters.back().value = value;
    }
  }
  return parameters;
}

}  // namespace fiber_proximity_ros
