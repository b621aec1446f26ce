#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include <QGridLayout>
#include <QWidget>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace fiber_proximity_rviz {

/// Controls for some parameters that a node has by dynamic_reconfigure, made from the node's own
/// description: choices, switches, and numbers within their limits.
class ParameterForm : public QWidget {
 public:
  /// Called with the one parameter that the user has changed, and its name and value as text; with
  /// none where the text is not a number.
  using OnChange = std::function<void(const dynamic_reconfigure::Config&, const std::string&)>;

  /// @param names of the parameters, in the order of the controls
  ParameterForm(std::vector<std::string> names, OnChange on_change, QWidget* parent = nullptr);

  /// Makes the controls anew.
  void describe(const dynamic_reconfigure::ConfigDescription& description);

  /// Shows the values that the node has now.
  void show_values(const dynamic_reconfigure::Config& values);

 private:
  void add(const dynamic_reconfigure::ParamDescription& parameter,
           const dynamic_reconfigure::ConfigDescription& description);

  std::vector<std::string> names_;
  OnChange on_change_;
  QGridLayout* layout_;
  std::map<std::string, std::function<void(const dynamic_reconfigure::Config&)>> setters_;
};

/// The choices of a parameter, as dynamic_reconfigure describes them in a Python literal.
/// @returns none if it is no enumeration
std::vector<std::string> choices_of(const std::string& edit_method);

/// The parameters whose values differ, as "name: new value".
std::vector<std::string> changed_values(const dynamic_reconfigure::Config& before,
                                        const dynamic_reconfigure::Config& after);

}  // namespace fiber_proximity_rviz
