#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/tools/text_output.hpp"

namespace fiber {

/// Writes a line with one JSON object that ends with a list, which is never in memory as text.
/// @param object   what stands before the list
/// @param name     of the list
/// @param to_json  makes JSON of an item
template <class Item, class ToJson>
void write_json_list(TextOutput& output, nlohmann::ordered_json object, const char* name,
                     const std::vector<Item>& items, const ToJson& to_json) {
  object[name] = nlohmann::ordered_json::array();
  std::string& text = output.text();
  text += object.dump();
  constexpr std::string_view end = "]}";
  text.resize(text.size() - end.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    text += i == 0 ? "" : ",";
    text += to_json(items[i]).dump();
    output.flush_if_long();
  }
  text += end;
  text += '\n';
}

}  // namespace fiber
