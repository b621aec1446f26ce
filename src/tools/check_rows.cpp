#include "src/tools/check_rows.hpp"

#include <algorithm>
#include <string>

#include "src/text/csv_field.hpp"

namespace fiber {
namespace {

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
                 const PairNames& names, const Environment* environment) {
  if (check.is_free()) {
    output.write(row_of_free(frame));
  }
  const auto write = [&](const QueryResult& result, const std::string& with,
                         const FiberNames& names_b) {
    for (const Contact& contact : result.contacts) {
      std::string object;
      if (&result == &check.environment) {
        append_csv_field(object, environment->objects()[contact.fiber_b].name);
      }
      write_csv_contact(output, contact, {names.a, names_b}, frame, false, with, object);
    }
  };
  write(check.self, "candidate", names.a);
  write(check.fibers, "fiber", names.b);
  write(check.environment, "object", {});
}

}  // namespace fiber
