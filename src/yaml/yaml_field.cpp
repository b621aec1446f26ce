#include "fiber_proximity/yaml/yaml_field.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t max_values_per_byte = 10;
constexpr std::size_t max_file_size = 100'000'000;  // [byte]

/// Counts the values of a document with its aliases written out, without writing them out: those of
/// aliases of aliases multiply.
class ValueCounter : public YAML::EventHandler {
 public:
  explicit ValueCounter(std::uint64_t most) : max_(most) {}

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_one(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    add_one(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = values_.find(anchor);
    if (named == values_.end()) {
      throw YAML::ParserException(mark, "an alias is part of what it stands for");
    }
    add(mark, named->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    YAML::anchor_t anchor;
    std::uint64_t before;  // values of the document when it began
  };

  void add(const YAML::Mark& mark, std::uint64_t values) {
    count_ += values;  // each at most the most: no overflow
    if (count_ > max_) {
      throw YAML::ParserException(mark, "with its aliases written out the document has more than " +
                                            std::to_string(max_) + " values, " +
                                            std::to_string(max_values_per_byte) + " per byte");
    }
  }
  void add_one(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    name(anchor, 1);
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({anchor, count_});
    add(mark, 1);
  }
  void end() {
    name(open_.back().anchor, count_ - open_.back().before);
    open_.pop_back();
  }
  void name(YAML::anchor_t anchor, std::uint64_t values) {
    if (anchor != YAML::NullAnchor) {
      values_[anchor] = values;
    }
  }

  std::uint64_t max_;
  std::uint64_t count_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::uint64_t> values_;  // of what has an anchor and has ended
};

void check_aliases(const std::string& text) {
  if (text.find('*') == std::string::npos) {
    return;
  }
  std::istringstream stream(text);
  ValueCounter counter(max_values_per_byte * text.size());
  YAML::Parser(stream).HandleNextDocument(counter);
}

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

std::vector<double> YamlField::numbers(std::optional<std::size_t> count) const {
  if (count && (!node_.IsSequence() || node_.size() != *count)) {
    refuse("a list of " + std::to_string(*count) + " numbers");
  }
  std::vector<double> numbers;
  for (const YamlField& item : items()) {
    numbers.push_back(item.number());
  }
  return numbers;
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

YamlField load_yaml(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw std::invalid_argument("file " + quote(file) + ": there is no such file to read");
  }
  std::string text;
  for (std::array<char, 65'536> chunk{}; stream; text.append(chunk.data(), stream.gcount())) {
    if (text.size() > max_file_size) {
      throw std::invalid_argument("file " + quote(file) + ": it may have at most " +
                                  std::to_string(max_file_size) + " bytes");
    }
    stream.read(chunk.data(), chunk.size());
  }
  return parse_yaml(text, file);
}

YamlField parse_yaml(const std::string& text, const std::string& name) {
  try {
    check_aliases(text);
    return {YAML::Load(text), name};
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument(name + ":" + std::to_string(error.mark.line + 1) + ": " +
                                shortened(error.msg));
  }
}

}  // namespace fiber
