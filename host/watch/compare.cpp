#include "host/watch/compare.h"

#include <sys/resource.h>
#include <unistd.h>

#include <utility>

#include "host/cast/stopwatch.h"
#include "host/image/compare.h"
#include "host/image/difference_picture.h"

namespace solidcast::watch {
namespace {

constexpr int kNice = 10;

struct Outdated {};

Image imageOf(std::vector<std::uint8_t> rgb8, const Frame& frame) {
  return {frame.width, frame.height, 3, std::move(rgb8)};
}

std::shared_ptr<const Comparison> compare(const Board& board, const Frame& frame, reference::Precision precision) {
  const auto check = [&] {
    if (board.outdated(frame)) throw Outdated{};
  };
  auto result = std::make_shared<Comparison>();
  result->frame = frame.number;
  result->width = frame.width;
  result->height = frame.height;
  RenderJob job = frame.job;
  job.channels = {.rgb8 = true};
  std::vector<std::uint8_t> pixels;
  Stopwatch watch;
  reference::render(
      *frame.scene, job, precision,
      [&](Band& band) { pixels.insert(pixels.end(), band.rgb8.begin(), band.rgb8.end()); }, 1,
      [&](int, int) { check(); });
  result->milliseconds = watch.ms();
  const Image gpu = imageOf(frame.rgb8, frame), cpu = imageOf(std::move(pixels), frame);
  const Census census = compareImages(gpu, cpu, Budget{});
  result->differing = census.beyond;
  result->largest = census.maxError;
  result->worstX = census.worst.x;
  result->worstY = census.worst.y;
  result->heat = heatMap(gpu, cpu, census);
  result->cpu = std::get<0>(cpu.values);
  return result;
}

void work(Board& board, reference::Precision precision) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);  // of this thread alone
  while (const auto frame = board.toCompare()) {
    try {
      board.put(compare(board, *frame, precision));
    } catch (const Outdated&) {
    } catch (const Error& error) {
      auto none = std::make_shared<Comparison>();
      none->frame = frame->number;
      none->fault = error.what();
      board.put(std::move(none));
    }
  }
}

}  // namespace

BackgroundReference::BackgroundReference(Board& board, reference::Precision precision)
    : board_(board), thread_([&board, precision] { work(board, precision); }) {}
BackgroundReference::~BackgroundReference() { board_.end(); }

}  // namespace solidcast::watch
