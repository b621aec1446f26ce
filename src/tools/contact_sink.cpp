#include "src/tools/contact_sink.hpp"

#include <stdexcept>

#include "src/tools/contact_rows.hpp"

namespace fiber {

ContactSink::ContactSink(const Communicator& ranks, const ContactTarget& target,
                         const DistributedFileOptions& options)
    : ranks_(ranks) {
  if (target.is_hdf5) {
    hdf5_.emplace(ranks.handle(), target.path, options);
    return;
  }
  text_.emplace(ranks, target.path);
  text_->append([&](TextOutput& output) {
    if (ranks_.rank() == 0) {
      output.write((options.has_frames ? "frame," : "") + std::string(contact_columns));
    }
  });
}

void ContactSink::write(const FrameNumber& frame, DistributedResult& result) {
  sort_over_ranks(ranks_.handle(), result);
  if (hdf5_) {
    hdf5_->write(frame.number, result);
  } else {
    text_->append([&](TextOutput& output) { write_csv_contacts(output, frame, result.contacts); });
  }
}

void ContactSink::finish() {
  if (hdf5_) {
    hdf5_->finish();
  } else {
    text_->finish();
  }
}

}  // namespace fiber
