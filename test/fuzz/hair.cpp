// Fibre files in the HAIR format; what is read is written and read again as the same.
#include <sstream>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/fuzz/fuzz_target.hpp"

namespace {

void check_written(const fiber::FiberFile& file) {
  std::stringstream stream;
  fiber::write_hair(stream, file);
  const fiber::FiberFile again = fiber::read_hair(stream, "written.hair");
  const fiber::FiberAssembly& before = file.frames.front().fibers;
  const fiber::FiberAssembly& after = again.frames.front().fibers;
  if (before.points() != after.points() || before.offsets() != after.offsets() ||
      before.radii() != after.radii()) {
    fiber::test::finding("a file that is not read as it was written");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fiber::test::Bounds bounds(fiber::test::times(200, size));
  std::istringstream stream(fiber::test::text_of(data, size));
  try {
    check_written(fiber::read_hair(stream, "fuzz.hair"));
  } catch (const fiber::FileError& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
