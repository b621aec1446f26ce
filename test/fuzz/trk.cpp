// Tractograms of TrackVis; what is read is written and read again as the same.
#include "src/io/fiber_formats.hpp"
#include "test/fuzz/format.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fiber::test::fuzz_format(fiber::read_trk, fiber::write_trk, data, size);
}
