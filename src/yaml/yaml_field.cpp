#include "fiber_proximity/yaml/yaml_field.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

std::string value_of(const YAML::Node& node) {
  YAML::Emitter emitter;
  emitter << YAML::Flow << node;
  return node.IsDefined() ? shortened(emitter.c_str()) : "not there";
}

}  // namespace

void YamlField::require_map(const std::vector<std::string>& keys) const {
  if (!node_.IsMap()) {
    refuse("a map of the keys " + join(keys));
  }
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const YamlField name(entry.first, source_, path_);
    const std::string text = name.text();
    if (std::find(keys.begin(), keys.end(), text) == keys.end()) {
      throw std::invalid_argument(name.place() + " has the unknown key " + quote(text) +
                                  ", known are: " + join(keys));
    }
    if (!seen.insert(text).second) {
      throw std::invalid_argument(name.place() + " has the key " + quote(text) + " twice");
    }
  }
}

std::optional<YamlField> YamlField::find(const std::string& key) const {
  const YAML::Node value = node_[key];
  if (!value.IsDefined()) {
    return std::nullopt;
  }
  return YamlField(value, source_, path_.empty() ? key : path_ + "." + key);
}

YamlField YamlField::get(const std::string& key) const {
  std::optional<YamlField> value = find(key);
  if (!value) {
    throw std::invalid_argument(place() + " has no key '" + key + "'");
  }
  return *value;
}

std::vector<YamlField> YamlField::items() const {
  if (!node_.IsSequence()) {
    refuse("a list");
  }
  std::vector<YamlField> items;
  for (const YAML::Node& item : node_) {
    items.push_back(YamlField(item, source_, path_ + "[" + std::to_string(items.size()) + "]"));
  }
  return items;
}

std::vector<YamlField> YamlField::keys() const {
  if (!node_.IsMap()) {
    refuse("a map");
  }
  std::vector<YamlField> keys;
  for (const auto& entry : node_) {
    keys.push_back(YamlField(entry.first, source_, path_));
  }
  return keys;
}

std::string YamlField::text() const {
  if (!node_.IsScalar()) {
    refuse("a text");
  }
  return node_.Scalar();
}

bool YamlField::flag() const {
  bool flag = false;
  if (!node_.IsScalar() || !YAML::convert<bool>::decode(node_, flag)) {
    refuse("true or false");
  }
  return flag;
}

double YamlField::number() const {
  double number = 0.0;
  if (!node_.IsScalar() || !YAML::convert<double>::decode(node_, number)) {
    refuse("a number");
  }
  return number;
}

std::int64_t YamlField::integer(std::int64_t least, std::int64_t most) const {
  std::int64_t number = 0;
  if (!node_.IsScalar() || !YAML::convert<std::int64_t>::decode(node_, number) || number < least ||
      number > most) {
    refuse("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return number;
}

std::vector<double> YamlField::numbers() const {
  std::vector<double> numbers;
  for (const YamlField& item : items()) {
    numbers.push_back(item.number());
  }
  return numbers;
}

std::vector<double> YamlField::numbers(std::size_t count) const {
  if (!node_.IsSequence() || node_.size() != count) {
    refuse("a list of " + std::to_string(count) + " numbers");
  }
  return numbers();
}

Eigen::Vector3d YamlField::vector() const {
  const std::vector<double> values = numbers(3);
  return {values[0], values[1], values[2]};
}

void YamlField::read(const std::string& key, double& number) const {
  if (const auto given = find(key)) {
    number = given->number();
  }
}

void YamlField::read(const std::string& key, Eigen::Vector3d& vector) const {
  if (const auto given = find(key)) {
    vector = given->vector();
  }
}

void YamlField::refuse(const std::string& allowed) const {
  throw std::invalid_argument(statement() + ", it must be " + allowed);
}

std::string YamlField::statement() const { return place() + " is " + value_of(node_); }

std::string YamlField::place() const {
  const YAML::Mark mark = node_.Mark();
  std::string place = source_;
  if (!mark.is_null()) {
    place += ":" + std::to_string(mark.line + 1);
  }
  return place + ": " + (path_.empty() ? "the document" : path_);
}

}  // namespace fiber
