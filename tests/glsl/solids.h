// What the tests of the solids' GLSL functions share: rays of the oracle's families with their truths, packed as the
// host packs them, and the GLSL around KIND_eye, KIND_free, KIND_naive and KIND_finish.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "host/cast/records.h"
#include "host/glsl_test/compare.h"
#include "host/oracle/families.h"
#include "host/oracle/oracle.h"

namespace solidcast::glsl_test {

using Float3 = std::array<float, 3>;

/// "float", "double" or "double-float"; ARITHMETIC 0, 1, 2.
inline int arithmeticOf(RealType type) { return static_cast<int>(type); }
std::string labelOf(RealType type);

/// One ray at one solid.
struct Aimed {
  std::string family;
  Shape shape;
  QueryRay ray;
  oracle::Truth truth;
};

/// `each` rays of each family. With `eye`, directions are brought to about length 1 by a power of two, as cameras
/// have them; rays of which that would change the bits are left out.
std::vector<Aimed> aimed(oracle::Kind kind, const std::vector<std::string>& families, std::size_t each, bool eye);

/// Records of many solids: those that the search of one kind reads, and which element each belongs to.
struct Packed {
  explicit Packed(RealType type) : rows(type) {}
  RowWriter rows;
  std::vector<std::size_t> elements;  // into the vector of Aimed
  std::vector<std::uint32_t> row;
  std::vector<float> unit;            // eye: the records' unit of length
  std::vector<bool> grazing, onFace;  // eye: the macros of that name in hit.glsl and box.glsl

  Values values() const;  // for the array `rows`
  std::vector<Float3> origins(const std::vector<Aimed>&all) const, directions(const std::vector<Aimed>&all) const;
};

/// By number of the kind in whose form the host casts it; `none` gets the elements without any: rays that cannot hit.
std::map<int, Packed> packedForEye(const std::vector<Aimed>& all, RealType type, std::vector<std::size_t>& none);
Packed packedWorld(const std::vector<Aimed>& all, RealType type);

/// Calls of solids/KIND.glsl. Outputs: hit, clear (EXACT: no decision in doubt; else true), t, cosine (of unit vectors).
Function eyeFunction(gpu::Device& device, const std::string& kind, RealType type, bool exact);
Function freeFunction(gpu::Device& device, const std::string& kind, RealType type, bool exact);
Function naiveFunction(gpu::Device& device, const std::string& kind);
/// Outputs: normal, local.
Function finishFunction(gpu::Device& device, const std::string& kind, RealType type);

/// The bound that the renderer compares margins with.
float doubtOf(RealType type, bool eye);

}  // namespace solidcast::glsl_test
