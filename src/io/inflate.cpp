#include "src/io/inflate.hpp"

#include <zlib.h>

#include <algorithm>

#include "src/io/number.hpp"

namespace fiber {

std::string inflate(std::string& out, std::string_view bytes, std::uint64_t size, Deflated kind) {
  constexpr std::uint64_t piece = 1U << 30U;  // [byte] zlib counts with 32 bits
  z_stream stream{};
  if (inflateInit2(&stream, kind == Deflated::ZLIB ? MAX_WBITS : -MAX_WBITS) != Z_OK) {
    return "zlib cannot begin";
  }
  const std::size_t begin = out.size();
  std::uint64_t taken = 0;
  std::uint64_t made = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    if (stream.avail_in == 0) {
      const std::uint64_t count = std::min<std::uint64_t>(piece, bytes.size() - taken);
      // zlib does not write here.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
      stream.avail_in = static_cast<uInt>(count);
      taken += count;
    }
    // One byte more than there should be, so that more is seen.
    const std::uint64_t room =
        std::min<std::uint64_t>({size + 1 - made, std::max<std::uint64_t>(made, 65'536), piece});
    out.resize(begin + made + room);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + begin + made);
    stream.avail_out = static_cast<uInt>(room);
    state = ::inflate(&stream, Z_NO_FLUSH);
    made += room - stream.avail_out;
    if (made > size) {
      break;
    }
  }
  inflateEnd(&stream);
  out.resize(begin + std::min(made, size));
  if (made > size) {
    return "more than " + text_of(size) + " bytes come out, as many as are told";
  }
  if (state != Z_STREAM_END) {
    return "the compressed bytes are damaged or end early, after " + text_of(made) + " of " +
           text_of(size) + " bytes";
  }
  return made == size ? "" : text_of(made) + " bytes come out, " + text_of(size) + " are told";
}

}  // namespace fiber
