#include "test/support/source_folder.hpp"

namespace fiber::test {

std::filesystem::path source_folder() { return FIBER_PROXIMITY_SOURCE_DIR; }

}  // namespace fiber::test
