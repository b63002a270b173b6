// Inside of host/image: the file formats behind ImageWriter.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "host/image/output_file.h"

namespace solidcast {

/// Where encoded bytes go, in order.
using ByteSink = std::function<void(const void*, std::size_t)>;

/// Takes whole rows from the top down and writes them to a file. Which of the two rows() a format takes is fixed.
class RowEncoder {
 public:
  virtual ~RowEncoder() = default;
  virtual void rows(const std::uint8_t*, int) {}
  virtual void rows(const float*, int) {}
  virtual void finish() {}
};

/// 8-bit RGB, compressed by all cores. The bytes do not depend on how the rows are cut into bands nor on the cores.
std::unique_ptr<RowEncoder> makePngEncoder(ByteSink sink, int width, int height);
/// `channels` 1 (Pf) or 3 (PF).
std::unique_ptr<RowEncoder> makePfmEncoder(OutputFile& file, int width, int height, int channels);
/// 3 channels; run-length encoded where the format allows it (width 8 to 32767).
std::unique_ptr<RowEncoder> makeHdrEncoder(OutputFile& file, int width, int height);

}  // namespace solidcast
