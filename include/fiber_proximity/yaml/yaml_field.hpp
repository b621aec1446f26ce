#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fiber {

/// A value of a YAML document that knows where it stands. Nothing is converted silently: what is
/// not as it must be throws std::invalid_argument with file, line, field, value and what is
/// allowed.
class YamlField {
 public:
  /// @param source what errors call the document
  /// @param path   what they call the value in it; empty for all of it
  YamlField(const YAML::Node& node, std::string source, std::string path = "")
      : node_(node), source_(std::move(source)), path_(std::move(path)) {}

  /// This value by another name: errors call it and its fields so.
  YamlField named(const std::string& name) const { return {node_, source_, name}; }

  /// Throws unless this is a map of these keys, each at most once.
  void require_map(const std::vector<std::string>& keys) const;

  /// The value of a key; none if there is no such key.
  std::optional<YamlField> find(const std::string& key) const;

  /// The value of a key; throws if there is none.
  YamlField get(const std::string& key) const;

  /// The items of a list.
  std::vector<YamlField> items() const;

  bool is_text() const { return node_.IsScalar(); }
  bool is_map() const { return node_.IsMap(); }

  /// The keys of a map, in their order.
  std::vector<YamlField> keys() const;

  std::string text() const;
  bool flag() const;
  double number() const;
  std::int64_t integer(std::int64_t least, std::int64_t most) const;

  /// @param count none: as many as there are
  std::vector<double> numbers(std::optional<std::size_t> count = std::nullopt) const;
  Eigen::Vector3d vector() const;

  // The value of a key if there is one; else the variable stays as it is.
  void read(const std::string& key, double& number) const;
  void read(const std::string& key, Eigen::Vector3d& vector) const;

  /// Throws: this value is not what is allowed.
  [[noreturn]] void refuse(const std::string& allowed) const;

  /// "FILE:LINE: FIELD", as much of it as there is.
  std::string place() const;

  /// "FILE:LINE: FIELD is VALUE", with which a refusal begins.
  std::string statement() const;

 private:
  YAML::Node node_;
  std::string source_;
  std::string path_;
};

/// A YAML file.
/// @throws std::invalid_argument naming the file, and the line if it is malformed, or if aliases
///         in it stand for more than ten values per byte: a few lines could stand for any number
YamlField load_yaml(const std::string& file);

/// Reads a YAML document, as load_yaml() a file.
/// @param name what errors call it
YamlField parse_yaml(const std::string& text, const std::string& name);

}  // namespace fiber
