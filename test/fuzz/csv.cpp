// Fibre files as CSV.
#include <sstream>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/text/csv_field.hpp"
#include "test/fuzz/fuzz_target.hpp"

namespace {

/// Names, as answers write them, come back as the same.
void check_names(const fiber::FiberFrame& frame) {
  const std::size_t count = frame.fibers.fiber_count();
  if (!frame.names.are_indices() && frame.names.size() != count) {
    fiber::test::finding("not as many names as fibres");
  }
  std::string text = "fiber,x,y,z\n";
  for (const std::string& name : frame.names.list(count)) {
    for (const char* point : {",0,0,0\n", ",1,0,0\n"}) {
      fiber::append_csv_field(text, name);
      text += point;
    }
  }
  std::istringstream stream(text);
  if (fiber::read_csv(stream, "names.csv").frames.front().names != frame.names) {
    fiber::test::finding("names that are others once they are written");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fiber::test::Bounds bounds(fiber::test::times(200, size));
  std::istringstream stream(fiber::test::text_of(data, size));
  try {
    const fiber::FiberFile file = fiber::read_csv(stream, "fuzz.csv", 0.01);
    for (const std::string& note : file.notes) {
      fiber::test::check_error(std::runtime_error(note));
    }
    fiber::test::Bounds::lift();
    for (const fiber::FiberFrame& frame : file.frames) {
      check_names(frame);
    }
  } catch (const fiber::FileError& error) {
    fiber::test::check_error(error);
  }
  return 0;
}
