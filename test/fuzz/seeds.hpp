#pragma once

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

namespace fiber::test {

/// Writes the seeds of a target whose inputs are no text, name → bytes, if it is called with
/// --write_seeds=FOLDER, and ends then.
inline void write_seeds(int argc, char** argv, const std::map<std::string, std::string>& seeds) {
  const std::string option = "--write_seeds=";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind(option, 0) != 0) {
      continue;
    }
    for (const auto& [name, bytes] : seeds) {
      const std::string file = argument.substr(option.size()) + "/" + name;
      if (!(std::ofstream(file, std::ios::binary) << bytes)) {
        std::cerr << "cannot write '" << file << "'\n";
        std::exit(1);
      }
    }
    std::exit(0);
  }
}

}  // namespace fiber::test
