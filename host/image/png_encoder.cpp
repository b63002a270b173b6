// PNG, 8-bit RGB. libspng encodes on one core and in more time than a render takes, so the container is written here (PNG
// specification, third edition, chapters 5, 7.2 and 10) around ISA-L's deflate: the rows are cut into segments that are
// compressed side by side. A segment ends on a byte boundary (a sync flush) and starts with an empty window, so that the
// segments put one after the other are one deflate stream.
//
// Filter "sub" looks at its own row only, so a segment needs nothing of its neighbours. Of a render in 4K, on one core of a
// Zen 4: ISA-L's level 1 takes 6 to 25 ms for 25 MB, zlib's level 1 takes 140 to 220 ms and makes 7 to 10 % more bytes.
#include <isa-l.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "host/image/encoders.h"
#include "host/image/writer.h"

namespace solidcast {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSegmentBytes = std::size_t{256} << 10;  // before compression
constexpr std::size_t kSegmentsAtOnce = 64;                    // bounds the memory for compressed segments
constexpr std::uint8_t kFilterSub = 1;

void putBig(std::uint8_t* to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

/// One thread's state, used for one segment after the other.
///
/// A segment's first bytes are stored as they are and given to ISA-L as what came before. Without it ISA-L (2.30, assembly of
/// level 1) takes the hash of the third byte from the address of its own stream, and the same picture is other bytes in one
/// of some thousand runs.
class Deflater {
 public:
  static constexpr std::size_t kStoredBytes = 4;  // filter and first pixel: every row has them

  /// Appends the compressed bytes to `out`.
  void compress(const Bytes& in, bool last, Bytes& out) {
    constexpr std::uint8_t kBlock[] = {0, kStoredBytes, 0, 0xff ^ kStoredBytes,
                                       0xff};  // stored, length, its complement
    out.insert(out.end(), std::begin(kBlock), std::end(kBlock));
    out.insert(out.end(), in.begin(), in.begin() + kStoredBytes);
    isal_deflate_init(&stream_);
    stream_.level = 1;
    stream_.level_buf = tables_.data();
    stream_.level_buf_size = static_cast<std::uint32_t>(tables_.size());
    stream_.gzip_flag = IGZIP_DEFLATE;
    stream_.flush = SYNC_FLUSH;
    stream_.end_of_stream = last;
    const bool known = isal_deflate_set_dict(&stream_, const_cast<std::uint8_t*>(in.data()), kStoredBytes) == COMP_OK;
    const std::size_t start = out.size();
    out.resize(start + in.size() + in.size() / 8 + 1024);  // more than any input can grow to
    stream_.next_in = const_cast<std::uint8_t*>(in.data()) + kStoredBytes;
    stream_.avail_in = static_cast<std::uint32_t>(in.size() - kStoredBytes);
    stream_.next_out = out.data() + start;
    stream_.avail_out = static_cast<std::uint32_t>(out.size() - start);
    if (!known || isal_deflate(&stream_) != COMP_OK || stream_.avail_in != 0 || stream_.avail_out == 0)
      throw std::runtime_error("a segment of the image cannot be compressed");
    out.resize(out.size() - stream_.avail_out);
  }

 private:
  isal_zstream stream_{};
  Bytes tables_ = Bytes(ISAL_DEF_LVL1_DEFAULT);
};

struct Segment {
  Bytes chunk;              // length, "IDAT", compressed rows; checksum not yet
  std::uint32_t adler = 0;  // of the filtered rows
  std::size_t bytes = 0;    // of the filtered rows
};

class PngEncoder final : public RowEncoder {
 public:
  PngEncoder(ByteSink sink, int width, int height)
      : sink_(std::move(sink)),
        rowBytes_(3 * static_cast<std::size_t>(width)),
        segmentRows_(std::max<std::size_t>(1, kSegmentBytes / rowBytes_)),
        rowsLeft_(static_cast<std::size_t>(height)) {
    constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    sink_(kSignature.data(), kSignature.size());
    Bytes header(13);
    putBig(&header[0], static_cast<std::uint32_t>(width));
    putBig(&header[4], static_cast<std::uint32_t>(height));
    header[8] = 8;  // bits
    header[9] = 2;  // RGB; then deflate, the five standard filters, not interlaced: 0, 0, 0
    writeChunk("IHDR", header);
  }

  using RowEncoder::rows;
  void rows(const std::uint8_t* pixels, int count) override {
    std::size_t left = static_cast<std::size_t>(count);
    while (left > 0) {
      // Whole segments straight from the caller's rows; what is left over waits for the next ones.
      const std::size_t wanted = std::min(segmentRows_, rowsLeft_);
      if (waiting_.empty() && left >= wanted) {
        const std::size_t most = kSegmentsAtOnce * segmentRows_;
        const std::size_t taken = std::min({left == rowsLeft_ ? left : left / segmentRows_ * segmentRows_, most});
        encodeSegments(pixels, taken);
        pixels += taken * rowBytes_;
        left -= taken;
        continue;
      }
      const std::size_t taken = std::min(left, wanted - waiting_.size() / rowBytes_);
      waiting_.insert(waiting_.end(), pixels, pixels + taken * rowBytes_);
      pixels += taken * rowBytes_;
      left -= taken;
      if (waiting_.size() == wanted * rowBytes_) {
        encodeSegments(waiting_.data(), wanted);
        waiting_.clear();
      }
    }
  }

  void finish() override { writeChunk("IEND", {}); }

 private:
  /// `count` rows: whole segments, or all that is left of the image.
  void encodeSegments(const std::uint8_t* pixels, std::size_t count) {
    const std::size_t segments = (count + segmentRows_ - 1) / segmentRows_;
    std::vector<Segment> done(segments);
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      Deflater deflater;
      Bytes filtered;
      for (std::size_t i = next++; i < segments; i = next++) {
        const std::size_t first = i * segmentRows_, rows = std::min(segmentRows_, count - first);
        filter(pixels + first * rowBytes_, rows, filtered);
        const bool start = firstSegment_ && i == 0, last = first + rows == rowsLeft_;
        done[i] = compressed(deflater, filtered, start, last);
      }
    };
    runOnAllCores(work, segments);
    for (Segment& segment : done) {
      adler_ = adler32_combine(adler_, segment.adler, static_cast<z_off_t>(segment.bytes));
      rowsLeft_ -= segment.bytes / (rowBytes_ + 1);
      writeSegment(segment, rowsLeft_ == 0);
    }
    firstSegment_ = false;
  }

  template <class Work>
  static void runOnAllCores(const Work& work, std::size_t segments) {
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::exception_ptr> failures(std::min(cores, segments));
    std::vector<std::jthread> helpers;
    const auto guarded = [&](std::size_t which) {
      try {
        work();
      } catch (...) { failures[which] = std::current_exception(); }
    };
    for (std::size_t i = 1; i < failures.size(); ++i) helpers.emplace_back(guarded, i);
    guarded(0);
    helpers.clear();
    for (const std::exception_ptr& failure : failures)
      if (failure) std::rethrow_exception(failure);
  }

  void filter(const std::uint8_t* pixels, std::size_t rows, Bytes& out) const {
    out.resize(rows * (rowBytes_ + 1));
    std::uint8_t* to = out.data();
    for (std::size_t row = 0; row < rows; ++row, pixels += rowBytes_) {
      *to++ = kFilterSub;
      std::memcpy(to, pixels, 3);
      for (std::size_t i = 3; i < rowBytes_; ++i) to[i] = static_cast<std::uint8_t>(pixels[i] - pixels[i - 3]);
      to += rowBytes_;
    }
  }

  static Segment compressed(Deflater& deflater, const Bytes& filtered, bool first, bool last) {
    Segment segment;
    segment.bytes = filtered.size();
    segment.adler = isal_adler32(1, filtered.data(), filtered.size());
    segment.chunk = {0, 0, 0, 0, 'I', 'D', 'A', 'T'};
    if (first) segment.chunk.insert(segment.chunk.end(), {0x78, 0x01});  // zlib: window of 32 KiB, fastest
    deflater.compress(filtered, last, segment.chunk);
    return segment;
  }

  void writeSegment(Segment& segment, bool last) {
    if (last) {
      segment.chunk.resize(segment.chunk.size() + 4);
      putBig(&segment.chunk[segment.chunk.size() - 4], static_cast<std::uint32_t>(adler_));
    }
    writeChunk(segment.chunk);
  }

  void writeChunk(const char* name, const Bytes& content) {
    Bytes chunk(4);
    chunk.insert(chunk.end(), name, name + 4);
    chunk.insert(chunk.end(), content.begin(), content.end());
    writeChunk(chunk);
  }

  /// Length and checksum are put in here.
  void writeChunk(Bytes& chunk) {
    putBig(chunk.data(), static_cast<std::uint32_t>(chunk.size() - 8));
    const std::uint32_t checksum = crc32_gzip_refl(0, chunk.data() + 4, chunk.size() - 4);
    chunk.resize(chunk.size() + 4);
    putBig(&chunk[chunk.size() - 4], static_cast<std::uint32_t>(checksum));
    sink_(chunk.data(), chunk.size());
  }

  ByteSink sink_;
  std::size_t rowBytes_, segmentRows_, rowsLeft_;
  Bytes waiting_;  // rows of a segment that is not complete yet
  uLong adler_ = 1;
  bool firstSegment_ = true;
};

}  // namespace

std::unique_ptr<RowEncoder> makePngEncoder(ByteSink sink, int width, int height) {
  return std::make_unique<PngEncoder>(std::move(sink), width, height);
}

std::string pngOf(const std::vector<std::uint8_t>& rgb8, int width, int height) {
  std::string png;
  PngEncoder encoder(
      [&png](const void* bytes, std::size_t count) { png.append(static_cast<const char*>(bytes), count); }, width,
      height);
  encoder.rows(rgb8.data(), height);
  encoder.finish();
  return png;
}

}  // namespace solidcast
