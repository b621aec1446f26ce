#include <yaml-cpp/eventhandler.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/yaml/yaml_field.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t most_values_per_byte = 10;
constexpr std::size_t largest_file = 100'000'000;  // [byte]

/// Counts the values of a document with its aliases written out, without writing them out: those of
/// aliases of aliases multiply.
class ValueCounter : public YAML::EventHandler {
 public:
  explicit ValueCounter(std::uint64_t most) : most_(most) {}

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
    if (count_ > most_) {
      throw YAML::ParserException(mark, "with its aliases written out the document has more than " +
                                            std::to_string(most_) + " values, " +
                                            std::to_string(most_values_per_byte) + " per byte");
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

  std::uint64_t most_;
  std::uint64_t count_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::uint64_t> values_;  // of what has an anchor and has ended
};

void check_aliases(const std::string& text) {
  if (text.find('*') == std::string::npos) {
    return;
  }
  std::istringstream stream(text);
  ValueCounter counter(most_values_per_byte * text.size());
  YAML::Parser(stream).HandleNextDocument(counter);
}

}  // namespace

YamlField load_yaml(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw std::invalid_argument("scene " + quote(file) + ": there is no such file to read");
  }
  std::string text;
  for (std::array<char, 65'536> chunk{}; stream; text.append(chunk.data(), stream.gcount())) {
    if (text.size() > largest_file) {
      throw std::invalid_argument("scene " + quote(file) + ": it may have at most " +
                                  std::to_string(largest_file) + " bytes");
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
