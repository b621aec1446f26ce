#include "src/rviz/parameter_form.hpp"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <algorithm>
#include <memory>
#include <regex>

namespace fiber_proximity_rviz {
namespace {

using dynamic_reconfigure::Config;

/// The entry of a list of parameters with a name; null if there is none.
template <class Entry>
const Entry* entry_of(const std::vector<Entry>& entries, const std::string& name) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

QString text_of(double value) { return QString::number(value, 'g', 6); }

}  // namespace

std::vector<std::string> choices_of(const std::string& edit_method) {
  static const std::regex value("'value': '([^']*)'");
  std::vector<std::string> choices;
  for (std::sregex_iterator match(edit_method.begin(), edit_method.end(), value), end; match != end;
       ++match) {
    choices.push_back((*match)[1]);
  }
  return choices;
}

ParameterForm::ParameterForm(std::vector<std::string> names, OnChange on_change, QWidget* parent)
    : QWidget(parent),
      names_(std::move(names)),
      on_change_(std::move(on_change)),
      layout_(new QGridLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setVerticalSpacing(2);
}

void ParameterForm::describe(const dynamic_reconfigure::ConfigDescription& description) {
  while (const std::unique_ptr<QLayoutItem> item{layout_->takeAt(0)}) {
    delete item->widget();
  }
  setters_.clear();
  for (const std::string& name : names_) {
    for (const dynamic_reconfigure::Group& group : description.groups) {
      if (const auto* parameter = entry_of(group.parameters, name)) {
        add(*parameter, description);
      }
    }
  }
}

void ParameterForm::add(const dynamic_reconfigure::ParamDescription& parameter,
                        const dynamic_reconfigure::ConfigDescription& description) {
  const std::string name = parameter.name;
  QWidget* control = nullptr;
  if (parameter.type == "bool") {
    auto* box = new QCheckBox(this);
    QObject::connect(box, &QCheckBox::toggled, box, [this, name](bool is_on) {
      dynamic_reconfigure::BoolParameter set;
      set.name = name;
      set.value = static_cast<std::uint8_t>(is_on);
      Config config;
      config.bools.push_back(set);
      on_change_(config, name + ": " + (is_on ? "true" : "false"));
    });
    setters_[name] = [box, name](const Config& values) {
      if (const auto* value = entry_of(values.bools, name)) {
        const QSignalBlocker blocker(box);
        box->setChecked(value->value != 0);
      }
    };
    control = box;
  } else if (parameter.type == "str") {
    auto* box = new QComboBox(this);
    for (const std::string& choice : choices_of(parameter.edit_method)) {
      box->addItem(QString::fromStdString(choice));
    }
    QObject::connect(box, &QComboBox::currentTextChanged, box, [this, name](const QString& text) {
      dynamic_reconfigure::StrParameter set;
      set.name = name;
      set.value = text.toStdString();
      Config config;
      config.strs.push_back(set);
      on_change_(config, name + ": " + set.value);
    });
    setters_[name] = [box, name](const Config& values) {
      if (const auto* value = entry_of(values.strs, name)) {
        const QSignalBlocker blocker(box);
        box->setCurrentText(QString::fromStdString(value->value));
      }
    };
    control = box;
  } else {
    // A line, as limits reach from 1e-12 to infinity. What is no number, or beyond the limits, goes
    // to the node all the same, whose words tell what is allowed.
    auto* line = new QLineEdit(this);
    QObject::connect(line, &QLineEdit::editingFinished, line, [this, name, line] {
      if (!line->isModified()) {
        return;
      }
      line->setModified(false);
      bool is_number = false;
      dynamic_reconfigure::DoubleParameter set;
      set.name = name;
      set.value = line->text().toDouble(&is_number);
      Config config;
      config.doubles.push_back(set);
      on_change_(is_number ? config : Config(), name + ": " + line->text().toStdString());
    });
    setters_[name] = [line, name](const Config& values) {
      const auto* value = entry_of(values.doubles, name);
      if (value != nullptr && !line->isModified()) {
        line->setText(text_of(value->value));
      }
    };
    control = line;
  }
  control->setObjectName(QString::fromStdString(name));
  control->setToolTip(QString::fromStdString(parameter.description));
  // Two beside each other.
  const int place = static_cast<int>(setters_.size()) - 1;
  layout_->addWidget(new QLabel(QString::fromStdString(name), this), place / 2, 2 * (place % 2));
  layout_->addWidget(control, place / 2, 2 * (place % 2) + 1);
  setters_[name](description.dflt);
}

std::vector<std::string> changed_values(const Config& before, const Config& after) {
  std::vector<std::string> changed;
  const auto compare = [&](const auto& old_values, const auto& new_values, const auto& text) {
    for (const auto& value : new_values) {
      const auto* old = entry_of(old_values, value.name);
      if (old != nullptr && old->value != value.value) {
        changed.push_back(value.name + ": " + text(value.value));
      }
    }
  };
  compare(before.bools, after.bools,
          [](std::uint8_t value) { return std::string(value != 0 ? "true" : "false"); });
  compare(before.ints, after.ints, [](std::int32_t value) { return std::to_string(value); });
  compare(before.strs, after.strs, [](const std::string& value) { return value; });
  compare(before.doubles, after.doubles, [](double value) { return text_of(value).toStdString(); });
  return changed;
}

void ParameterForm::show_values(const Config& values) {
  for (const auto& [name, set] : setters_) {
    set(values);
  }
}

}  // namespace fiber_proximity_rviz
