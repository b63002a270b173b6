// Whom solidcast is measured against: from the arrays of solids to a finished 8-bit image, by other means.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/bench/kernels.h"
#include "host/bench/rays.h"
#include "host/bench/stopwatch.h"
#include "host/image/reader.h"
#include "host/scene/world.h"
#include "reference_cpu/reference.h"

namespace solidcast::bench {

/// build: from the solids to what rays are cast at; trace: rays, hits and the finished image.
struct Lap {
  Span build, trace;
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string name() const = 0;
  virtual std::string plan() const = 0;  // one line: how it works
  /// From the start of a program to a file: to be held against nothing but its like.
  virtual bool wholeProcess() const { return false; }
  /// Builds anew and traces.
  virtual Lap run() = 0;
  /// What the last run() made, 3 channels of 8 bits.
  virtual Image image() const = 0;
};

/// Pixels as words: red in the lowest byte, alpha 255.
class WordImage {
 public:
  WordImage(const Rays& rays) : view_(rays.view()), words_(rays.pixels()) {}
  std::uint32_t* data() { return words_.data(); }
  Image image() const;

 private:
  RayView view_;
  std::vector<std::uint32_t> words_;
};

/// All throw Error(Exit::usage) where they cannot be had: what is missing, and how to get it.
/// The scene must outlive the peer.
///
/// Embree 3, in packets of 4x4 rays (rtcIntersect16), or ray by ray (rtcIntersect1).
std::unique_ptr<Peer> embreePeer(const Scene& scene, int width, int height, bool packets,
                                 const Kernels* kernels = kernelsOfCpu());
/// Hand-written for small scenes: AVX-512, 16 rays at a time; AVX2, 8 rays, on CPUs without it. `skipping`: a packet
/// that misses a solid leaves its test early. Not for orthographic cameras: it lives by the shared origin.
std::unique_ptr<Peer> simdPeer(const Scene& scene, int width, int height, bool skipping,
                               const Kernels* kernels = kernelsOfCpu());
/// The CPU reference: the course's class model, every solid tried for every ray.
std::unique_ptr<Peer> referencePeer(const Scene& scene, int width, int height, reference::Precision precision);

}  // namespace solidcast::bench
