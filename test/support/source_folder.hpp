#pragma once

#include <filesystem>

namespace fiber::test {

/// The folder of the package that these tests were built from.
std::filesystem::path source_folder();

}  // namespace fiber::test
