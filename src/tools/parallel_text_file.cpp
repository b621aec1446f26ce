#include "src/tools/parallel_text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <iostream>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {

ParallelTextFile::ParallelTextFile(const Communicator& ranks, const std::string& path,
                                   const DistributedFileOptions& options)
    : ranks_(ranks),
      place_(path.empty() ? WritePlace{"", false} : write_place(ranks, path)),
      path_(place_.path),
      checkpoint_(path_, options.run) {
  run_on_root(ranks_, [&] {
    if (place_.is_file) {
      progress_ = begin(options.resume);
      return;
    }
    if (options.resume) {
      throw std::invalid_argument(
          "--resume: what went to " +
          (path_.empty() ? "stdout" : quote(path_) + ", which is no file,") +
          " cannot be gone on with, give --out a file");
    }
    if (!path_.empty()) {
      stream_.emplace(path_);
    }
  });
  if (!place_.is_file) {
    return;
  }
  progress_ = ranks_.broadcast(progress_);
  file_ = open(partial_name(path_).c_str(), O_WRONLY | O_CLOEXEC);
  const std::string error =
      file_ < 0 ? FileError::from_system(partial_name(path_), "cannot be written").what() : "";
  if (!ranks_.all(error.empty())) {
    if (file_ >= 0) {
      close(file_);
    }
    remove_unfinished();
    ranks_.throw_on_all(error);
  }
}

/// Makes the file that is written, or takes up what there is of it.
RunProgress ParallelTextFile::begin(bool resume) const {
  const std::optional<RunProgress> earlier = resume ? checkpoint_.read() : std::nullopt;
  if (earlier) {
    std::filesystem::resize_file(partial_name(path_), earlier->bytes);
    return *earlier;
  }
  checkpoint_.remove();
  OutputFile(partial_name(path_)).close();
  return {};
}

ParallelTextFile::~ParallelTextFile() {
  if (file_ >= 0) {
    close(file_);
  }
  remove_unfinished();  // it is there only where something went wrong
}

/// Removes what was written of a file that is not whole.
void ParallelTextFile::remove_unfinished() const {
  if (place_.is_file && ranks_.rank() == 0) {
    remove_partial(path_);
    checkpoint_.remove();
  }
}

void ParallelTextFile::append(const std::function<void(TextOutput& output)>& write) {
  const bool is_root = ranks_.rank() == 0;
  std::vector<std::string> pieces;  // of a rank that does not know its place yet
  std::uint64_t size = 0;
  std::string error = error_in([&] {
    TextOutput output([&](std::string_view piece) {
      if (!is_root) {
        pieces.emplace_back(piece);
      } else if (place_.is_file) {
        write_to_file(progress_.bytes + size, piece);
      } else {
        write_to_stream(piece);
      }
      size += piece.size();
    });
    write(output);
    output.flush();
  });
  std::uint64_t place = progress_.bytes;
  const std::vector<std::uint64_t> sizes = ranks_.gather_all(size);
  for (int other = 0; other < ranks_.size(); ++other) {
    const std::uint64_t others_size = sizes[static_cast<std::size_t>(other)];
    place += other < ranks_.rank() ? others_size : 0;
    progress_.bytes += others_size;
    if (is_root && other > 0 && !place_.is_file) {
      const std::string failure = receive_from(other, others_size);
      error = error.empty() ? failure : error;
    }
  }
  if (!place_.is_file && is_root) {
    stream().flush();
    const std::string failure = error_in([&] { write_to_stream(""); });
    error = failure.empty() ? error : failure;
  } else if (!place_.is_file) {
    send_to_root(pieces);
  } else if (error.empty()) {
    error = error_in([&] {
      for (const std::string& piece : pieces) {
        write_to_file(place, piece);
        place += piece.size();
      }
    });
  }
  ranks_.throw_on_all(error);
}

void ParallelTextFile::write_to_file(std::uint64_t place, std::string_view text) const {
  while (!text.empty()) {
    const ssize_t written = pwrite(file_, text.data(), text.size(), static_cast<off_t>(place));
    if (written < 0 && errno != EINTR) {
      throw FileError::from_system(partial_name(path_), "cannot be written");
    }
    if (written > 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
      place += static_cast<std::uint64_t>(written);
    }
  }
}

std::ostream& ParallelTextFile::stream() { return stream_ ? stream_->stream() : std::cout; }

void ParallelTextFile::write_to_stream(std::string_view text) {
  stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream_) {
    stream_->check();
  } else if (!std::cout) {
    throw std::runtime_error("the output cannot be written");
  }
}

/// Each piece waits for rank 0 to take it.
void ParallelTextFile::send_to_root(const std::vector<std::string>& pieces) const {
  for (const std::string& piece : pieces) {
    MPI_Ssend(piece.data(), static_cast<int>(piece.size()), MPI_BYTE, 0,
              static_cast<int>(MessageTag::TEXT), ranks_.handle());
  }
}

/// Takes all pieces that a rank has, also where they cannot be written.
/// @return why they cannot, "" if they are
std::string ParallelTextFile::receive_from(int rank, std::uint64_t size) {
  std::string error;
  std::array<char, TextOutput::max_piece> text{};
  while (size > 0) {
    MPI_Status status;
    int received = 0;
    MPI_Recv(text.data(), static_cast<int>(text.size()), MPI_BYTE, rank,
             static_cast<int>(MessageTag::TEXT), ranks_.handle(), &status);
    MPI_Get_count(&status, MPI_BYTE, &received);
    size -= static_cast<std::uint64_t>(received);
    if (error.empty()) {
      error = error_in([&] { write_to_stream({text.data(), static_cast<std::size_t>(received)}); });
    }
  }
  return error;
}

void ParallelTextFile::checkpoint(std::uint64_t steps) {
  if (place_.is_file) {
    ranks_.throw_on_all(
        fsync(file_) == 0 || errno == EINVAL || errno == EROFS
            ? ""
            : FileError::from_system(partial_name(path_), "cannot be written").what());
    run_on_root(ranks_, [&] { checkpoint_.write({steps, progress_.bytes}); });
  }
}

/// @throws FileError where what was written has not reached the file
void ParallelTextFile::close_file() {
  if (file_ >= 0 && close(std::exchange(file_, -1)) != 0) {
    throw FileError::from_system(partial_name(path_), "cannot be written");
  }
}

void ParallelTextFile::finish() {
  ranks_.throw_on_all(error_in([&] { close_file(); }));
  run_on_root(ranks_, [&] {
    if (place_.is_file) {
      move_into_place(path_);
      checkpoint_.remove();
    } else if (stream_) {
      stream_->close();
    }
  });
}

}  // namespace fiber
