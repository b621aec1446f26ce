#include "src/tools/rank_text.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <utility>
#include <vector>

#include "fiber_proximity/io/file.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::streamsize max_chunk = 65'536;  // [byte]

/// Hands on what is written to it.
class TextPieces : public std::streambuf {
 public:
  /// @return whether it went well
  using Take = std::function<bool(const char* text, std::streamsize size)>;

  explicit TextPieces(Take take) : take_(std::move(take)) {}

 private:
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    for (std::streamsize done = 0; done < size; done += max_chunk) {
      if (!take_(text + done, std::min(max_chunk, size - done))) {
        return done;
      }
    }
    return size;
  }
  int_type overflow(int_type c) override {
    const char character = traits_type::to_char_type(c);
    return xsputn(&character, 1) == 1 ? traits_type::not_eof(c) : traits_type::eof();
  }

  const Take take_;
};

void write_pieces(const std::function<void(TextOutput& output)>& write,
                  const TextPieces::Take& take) {
  TextPieces pieces(take);
  std::ostream stream(&pieces);
  TextOutput output(stream);
  write(output);
  output.flush();
}

/// @return "" where nothing went wrong
std::string text_of_mpi(int error) {
  if (error == MPI_SUCCESS) {
    return "";
  }
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(error, text.data(), &length);
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace

/// Makes the file that is written, or takes up what there is of it.
RunProgress RankText::begin(bool resume) const {
  const std::optional<RunProgress> earlier = resume ? note_.read() : std::nullopt;
  if (earlier) {
    std::filesystem::resize_file(partial_name(path_), earlier->bytes);
    return *earlier;
  }
  note_.remove();
  OutputFile(partial_name(path_)).close();
  return {};
}

RankText::RankText(const Communicator& ranks, const std::string& path, const TextRun& run)
    : ranks_(ranks),
      place_(path.empty() ? WritePlace{"", false} : write_place(ranks, path)),
      path_(place_.path),
      note_(path_, run.run) {
  if (!place_.is_file) {
    run_on_root(ranks_, [&] {
      if (run.resume) {
        throw std::invalid_argument(
            "--resume: what went to " +
            (path_.empty() ? "stdout" : quote(path_) + ", which is no file,") +
            " cannot be gone on with, give --out a file");
      }
      if (!path_.empty()) {
        stream_.emplace(path_);
      }
    });
    return;
  }
  RunProgress earlier;
  run_on_root(ranks_, [&] { earlier = begin(run.resume); });
  earlier = ranks_.broadcast(earlier);
  done_ = earlier.steps;
  size_ = earlier.bytes;
  const int error = MPI_File_open(ranks_.handle(), partial_name(path_).c_str(), MPI_MODE_WRONLY,
                                  MPI_INFO_NULL, &file_);
  if (!ranks_.all(error == MPI_SUCCESS)) {
    remove_unfinished();
    throw_on_all(text_of_mpi(error));
  }
}

/// @param reason why this rank cannot write, "" for none
void RankText::throw_on_all(const std::string& reason) const {
  ranks_.throw_on_all(
      reason.empty() ? "" : FileError(partial_name(path_), "cannot be written: " + reason).what());
}

RankText::~RankText() {
  close_file();
  remove_unfinished();  // it is there only where something went wrong
}

/// What was written of a file that is not whole.
void RankText::remove_unfinished() const {
  if (place_.is_file && ranks_.rank() == 0) {
    remove_partial(path_);
    note_.remove();
  }
}

void RankText::note(std::uint64_t steps) {
  if (place_.is_file) {
    throw_on_all(text_of_mpi(MPI_File_sync(file_)));
    run_on_root(ranks_, [&] { note_.write({steps, size_}); });
  }
}

void RankText::append(const std::function<void(TextOutput& output)>& write) {
  if (place_.is_file) {
    append_to_file(write);
  } else {
    append_to_stream(write);
  }
}

void RankText::append_to_file(const std::function<void(TextOutput& output)>& write) {
  std::uint64_t size = 0;
  write_pieces(write, [&](const char* /*text*/, std::streamsize piece) {
    size += static_cast<std::uint64_t>(piece);
    return true;
  });
  std::uint64_t place = size_;
  const std::vector<std::uint64_t> sizes = ranks_.gather_all(size);
  for (int other = 0; other < ranks_.size(); ++other) {
    place += other < ranks_.rank() ? sizes[static_cast<std::size_t>(other)] : 0;
    size_ += sizes[static_cast<std::size_t>(other)];
  }
  run_on_root(ranks_, [&] { reserve(partial_name(path_), size_); });
  std::string reason;
  const std::string error = error_in([&] {
    write_pieces(write, [&](const char* text, std::streamsize piece) {
      MPI_Status status;
      int written = 0;
      const int failure = MPI_File_write_at(file_, static_cast<MPI_Offset>(place), text,
                                            static_cast<int>(piece), MPI_BYTE, &status);
      if (failure != MPI_SUCCESS) {
        reason = text_of_mpi(failure);
        return false;
      }
      MPI_Get_count(&status, MPI_BYTE, &written);
      place += static_cast<std::uint64_t>(piece);
      return written == static_cast<int>(piece);
    });
  });
  ranks_.throw_on_all(error.empty() ? ""
                                    : FileError(partial_name(path_),
                                                reason.empty() ? "cannot be written"
                                                               : "cannot be written: " + reason)
                                          .what());
}

/// Rank 0 takes the others' pieces, one rank after another, and each waits for its turn.
void RankText::append_to_stream(const std::function<void(TextOutput& output)>& write) {
  if (ranks_.rank() > 0) {
    write_pieces(write, [&](const char* text, std::streamsize piece) {
      MPI_Ssend(text, static_cast<int>(piece), MPI_BYTE, 0, text_tag, ranks_.handle());
      return true;
    });
    MPI_Ssend(nullptr, 0, MPI_BYTE, 0, text_tag, ranks_.handle());
    ranks_.throw_on_all("");
    return;
  }
  std::ostream& stream = stream_ ? stream_->stream() : std::cout;
  const std::string error = error_in([&] {
    TextOutput output(stream);
    write(output);
    output.flush();
  });
  pass_on_others(stream);
  stream.flush();
  const std::string failure = failure_of_stream();
  ranks_.throw_on_all(failure.empty() ? error : failure);
}

void RankText::pass_on_others(std::ostream& stream) const {
  std::vector<char> text(static_cast<std::size_t>(max_chunk));
  for (int other = 1; other < ranks_.size(); ++other) {
    int size = 1;
    while (size > 0) {
      MPI_Status status;
      MPI_Recv(text.data(), static_cast<int>(text.size()), MPI_BYTE, other, text_tag,
               ranks_.handle(), &status);
      MPI_Get_count(&status, MPI_BYTE, &size);
      stream.write(text.data(), size);
    }
  }
}

/// @return what went wrong with it, "" for nothing
std::string RankText::failure_of_stream() const {
  if (stream_) {
    return error_in([&] { stream_->check(); });
  }
  return std::cout ? "" : "the output cannot be written";
}

/// @return what went wrong, "" for nothing
std::string RankText::close_file() {
  if (file_ == MPI_FILE_NULL) {
    return "";
  }
  return text_of_mpi(MPI_File_close(&file_));
}

void RankText::finish() {
  if (!place_.is_file) {
    run_on_root(ranks_, [&] {
      if (stream_) {
        stream_->close();
      }
    });
    return;
  }
  throw_on_all(close_file());
  run_on_root(ranks_, [&] {
    move_into_place(path_);
    note_.remove();
  });
}

}  // namespace fiber
