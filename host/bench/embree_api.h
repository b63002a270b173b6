// Embree's functions, looked up when somebody asks for the peer: whoever does not ask does not load the library (2 ms of
// every start), and the program runs without it.
#pragma once
#include <embree3/rtcore.h>

namespace solidcast::bench {

#define SOLIDCAST_EMBREE_FUNCTIONS(X) \
  X(rtcNewDevice)                     \
  X(rtcReleaseDevice)                 \
  X(rtcGetDeviceError)                \
  X(rtcGetDeviceProperty)             \
  X(rtcNewScene)                      \
  X(rtcReleaseScene)                  \
  X(rtcCommitScene)                   \
  X(rtcNewGeometry)                   \
  X(rtcReleaseGeometry)               \
  X(rtcCommitGeometry)                \
  X(rtcAttachGeometry)                \
  X(rtcSetNewGeometryBuffer)          \
  X(rtcSetGeometryUserPrimitiveCount) \
  X(rtcSetGeometryUserData)           \
  X(rtcSetGeometryBoundsFunction)     \
  X(rtcSetGeometryIntersectFunction)  \
  X(rtcIntersect1)                    \
  X(rtcIntersect16)

struct EmbreeApi {
#define X(name) decltype(&::name) name = nullptr;
  SOLIDCAST_EMBREE_FUNCTIONS(X)
#undef X
};

/// Empty until loadEmbree().
extern EmbreeApi embreeApi;

/// Throws Error(Exit::usage) where the library is not installed.
void loadEmbree();

}  // namespace solidcast::bench
