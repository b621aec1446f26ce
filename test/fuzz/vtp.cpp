// Poly data in VTK's XML; what is read is written and read again as the same.
#include "src/io/fiber_formats.hpp"
#include "test/fuzz/format.hpp"

namespace {

void write_fuzzed(std::ostream& stream, const fiber::FiberFile& file) {
  fiber::write_vtp(stream, file.frames.front().fibers);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fiber::test::fuzz_format(fiber::read_vtp, write_fuzzed, data, size, 2000);
}
