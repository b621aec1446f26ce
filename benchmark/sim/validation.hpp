#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fiber {

/// A number that theory knows, beside the same of a simulated rod.
struct Validation {
  std::string test;
  std::string scene;
  std::string quantity;
  int segments = 0;  ///< of the rod, or of a turn around a post
  double theory = 0.0;
  double simulated = 0.0;
  double allowed = 0.01;  ///< error, as a part of what theory says

  double error() const { return simulated / theory - 1.0; }
};

/// Names of what they are about.
std::vector<std::string> validation_names();

/// Simulates those about something, one after the other; all take less than a minute.
void validate_simulation(const std::string& about,
                         const std::function<void(const Validation&)>& report);

}  // namespace fiber
