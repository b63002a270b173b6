// The CPU reference as a peer: what a plain C++ program of the course's classes reaches on all cores.
#include <thread>

#include "host/bench/peer.h"

namespace solidcast::bench {
namespace {

class ReferencePeer final : public Peer {
 public:
  ReferencePeer(const Scene& scene, int width, int height, reference::Precision precision)
      : scene_(scene), precision_(precision) {
    job_.width = width, job_.height = height;
    job_.twoSided = scene.twoSided;
    job_.channels.rgb8 = true;
  }

  std::string name() const override {
    const char* names[] = {"cpu f32", "cpu f64", "cpu f128"};
    return names[static_cast<int>(precision_)];
  }
  std::string plan() const override {
    return "CPU reference, virtual dispatch, every solid, " +
           std::to_string(std::max(1u, std::thread::hardware_concurrency())) + " threads";
  }
  Lap run() override {
    Stopwatch watch;
    bytes_.clear();
    reference::render(scene_, job_, precision_,
                      [&](Band& band) { bytes_.insert(bytes_.end(), band.rgb8.begin(), band.rgb8.end()); });
    return {{}, watch.lap()};
  }
  Image image() const override {
    Image image;
    image.width = job_.width, image.height = job_.height;
    image.values = bytes_;
    return image;
  }

 private:
  const Scene& scene_;
  reference::Precision precision_;
  RenderJob job_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::unique_ptr<Peer> referencePeer(const Scene& scene, int width, int height, reference::Precision precision) {
  return std::make_unique<ReferencePeer>(scene, width, height, precision);
}

}  // namespace solidcast::bench
