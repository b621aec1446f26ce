#include "src/tools/check_rows.hpp"

#include <algorithm>
#include <string>

#include "src/tools/contact_rows.hpp"

namespace fiber {
namespace {

/// A field of CSV, whatever is in the text.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char character : text) {
    quoted += character == '"' ? "\"\"" : std::string(1, character);
  }
  return quoted + '"';
}

/// A line for what has no contact.
std::string row_of_free(const FrameNumber& frame) {
  const std::string columns = check_header(false);
  const std::string none(static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')),
                         ',');
  return (frame.is_given ? std::to_string(frame.number) + ',' : "") + '1' + none + '\n';
}

}  // namespace

std::string check_header(bool has_frames) {
  return (has_frames ? "frame," : "") + std::string("free,with,object,") + contact_columns;
}

void write_check(TextOutput& output, const FrameNumber& frame, const FiberCheck& check,
                 const Environment* environment) {
  if (check.is_free()) {
    output.write(row_of_free(frame));
  }
  const auto write = [&](const QueryResult& result, const std::string& with) {
    for (const Contact& contact : result.contacts) {
      const bool is_object = &result == &check.environment;
      write_csv_contact(
          output, contact, frame, false, with,
          is_object ? csv_field(environment->objects()[contact.fiber_b].name) : std::string());
    }
  };
  write(check.self, "candidate");
  write(check.fibers, "fiber");
  write(check.environment, "object");
}

}  // namespace fiber
