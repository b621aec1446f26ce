#include "src/tools/contact_sink.hpp"

#include <algorithm>

#include "src/tools/contact_rows.hpp"

namespace fiber {

ContactSink::ContactSink(const Communicator& ranks, const ContactTarget& target,
                         const DistributedFileOptions& options)
    : ranks_(ranks), format_(target.format) {
  if (format_ == ContactFormat::HDF5) {
    hdf5_.emplace(ranks.handle(), target.path, options);
    return;
  }
  text_.emplace(ranks, target.path);
  text_->append([&](TextOutput& output) {
    if (ranks_.rank() == 0 && format_ == ContactFormat::CSV) {
      output.write((options.has_frames ? "frame," : "") + std::string(contact_columns));
    }
  });
}

void ContactSink::write(const FrameNumber& frame, const FiberNames& names,
                        DistributedResult& result) {
  sort_over_ranks(ranks_.handle(), result);
  if (hdf5_) {
    hdf5_->write(frame.number, result, names);
  } else if (format_ == ContactFormat::JSON) {
    write_json(frame, names, result);
  } else {
    text_->append(
        [&](TextOutput& output) { write_csv_contacts(output, frame, names, result.contacts); });
  }
}

/// One object, whose contacts the ranks write one after another.
void ContactSink::write_json(const FrameNumber& frame, const FiberNames& names,
                             const DistributedResult& result) {
  double lower = result.others_lower;
  for (const DistributedContact& contact : result.contacts) {
    lower = std::min(lower, contact.lower);
  }
  lower = ranks_.min(lower);
  const bool is_first = ranks_.share(result.contacts.size()).before == 0;
  text_->append([&](TextOutput& output) {
    if (ranks_.rank() == 0) {
      output.begin_object(json_of_answer(frame, result.complete, lower), "contacts");
    }
    const auto to_json = [&](const DistributedContact& contact) {
      return json_of_contact(names, contact);
    };
    output.write_items(result.contacts, to_json, is_first);
    if (ranks_.rank() == ranks_.size() - 1) {
      output.end_object();
    }
  });
}

void ContactSink::finish() {
  if (hdf5_) {
    hdf5_->finish();
  } else {
    text_->finish();
  }
}

}  // namespace fiber
