#include "fiber_proximity/sim/scene/parameters.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// In SI units: far beyond all that fibres are in, and far from where numbers end.
constexpr double largest = 1e6;

/// [character] Values that are longer are cut off in errors.
constexpr std::size_t longest_text = 80;

std::string text_of(const std::vector<double>& value) {
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

[[noreturn]] void refuse(const SimParameter& parameter, const std::string& problem) {
  throw std::invalid_argument("parameter " + quote(parameter.name) + " is " +
                              text_of(parameter.value) + ": " + problem);
}

}  // namespace

void SimParameters::add(const std::string& effect, const EffectOptions& options,
                        std::function<void(const EffectOptions&)> apply) {
  effects_[effect] = {options, std::move(apply)};
}

void SimParameters::set_one(const SimParameter& parameter) {
  const std::size_t dot = parameter.name.find('.');
  const auto effect = effects_.find(parameter.name.substr(0, dot));
  const std::string option = dot == std::string::npos ? "" : parameter.name.substr(dot + 1);
  if (effect == effects_.end() || effect->second.options.count(option) == 0) {
    std::vector<std::string> names;
    for (const SimParameter& known : all()) {
      names.push_back(known.name);
    }
    refuse(parameter, names.empty() ? "the scene names no effect that has parameters"
                                    : "there is no such parameter, known are: " + join(names));
  }
  std::vector<double>& value = effect->second.options.at(option);
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

void SimParameters::set(const std::vector<SimParameter>& parameters) {
  const std::map<std::string, Entry> before = effects_;
  try {
    for (const SimParameter& parameter : parameters) {
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

std::vector<SimParameter> SimParameters::all() const {
  std::vector<SimParameter> parameters;
  for (const auto& [effect, entry] : effects_) {
    for (const auto& [option, value] : entry.options) {
      parameters.push_back({std::string(effect).append(".").append(option), value});
    }
  }
  return parameters;
}

}  // namespace fiber
