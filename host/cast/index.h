// The index of a group: which solids a ray may hit, from boxes in boxes. One tree for each kind of solid, so that a leaf
// is searched by one kind's code. Walks need no stack: for each of the eight octants that a direction may lie in, `skip`
// says which node comes after this one and all below it, the nearer child before the farther, so that the first hits
// are near and the rest of the tree is passed by. After a kind's tree comes the next kind's.
//
// Never drops a hit. Solids' bounds are wider than the truth (bounds.h). A node's box holds those of its solids with at
// least 2^-100 to spare on each side, rounded outwards to fp32. The walks (below, and shaders/index.glsl) state what their
// own rounding takes. Solids without bounds lie in leaves ahead of their kind's tree, in boxes that hold everything.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "host/cast/records.h"
#include "host/scene/world.h"

namespace solidcast {

/// As shaders/index.glsl reads it.
struct IndexNode {
  float lo[3];
  std::uint32_t link;  // 4 * the upper child + the axis that divides; the lower child is the next node
  float hi[3];
  std::uint32_t leaf;  // 16 * place in the order + number of solids, 1 to 8; 0: no leaf
};
static_assert(sizeof(IndexNode) == 32);

inline constexpr std::uint32_t mostInLeaf = 8;

struct Index {
  std::vector<IndexNode> nodes;                              // parents before children, lower before upper
  std::vector<std::uint32_t> skips;                          // eight a node; bit k of an octant: negative along axis k
  std::vector<std::uint32_t> order;                          // solids, kind by kind, as leaves name them
  std::array<std::uint32_t, kindCount> firstPlace{}, end{};  // of each kind: in `order`; the node after its last
};

/// Binned SAH: 16 bins on each axis, the plane where (area times number) of both sides is least. The same for any number
/// of threads (0: all). `widened`: boxes grow by this part of their size on each side, for searches that see solids
/// blurred (fp32).
Index buildIndex(const World& world, double widened = 0, unsigned threads = 0);

/// The records in the order of the index.
Records inOrder(const Records& records, const Index& index);

/// The walk in fp64 for the host. Coordinates are of |o| + |box| = R at most; o and d are rounded to 2^-53, so at a
/// distance of up to 2R from the origin the ray is off by less than 2^-50 R, which `margin` covers; t is right to 2^-50.
class IndexWalk {
 public:
  /// Direction of unit length.
  IndexWalk(const double (&origin)[3], const double (&direction)[3]) {
    for (int k = 0; k < 3; ++k) {
      o_[k] = origin[k], d_[k] = direction[k];
      octant_ |= static_cast<std::size_t>(direction[k] < 0) << k;
      reach_ += std::abs(origin[k]);
    }
  }

  /// f(solid) for every solid whose box the ray meets within `limit`, which f may lower.
  template <class F>
  void visit(const Index& index, const double& limit, F&& f) const {
    for (std::size_t at = 0; at < index.nodes.size();) {
      const IndexNode& node = index.nodes[at];
      const bool met = meets(node.lo, node.hi, limit);
      if (met)
        for (std::uint32_t i = 0; i < node.leaf % 16; ++i) f(index.order[node.leaf / 16 + i]);
      const bool upperFirst = octant_ >> node.link % 4 & 1;
      at = !met || node.leaf != 0 ? index.skips[8 * at + octant_] : upperFirst ? node.link / 4 : at + 1;
    }
  }

  /// Whether the ray meets a box (of any number type that fp64 holds) within `limit`.
  template <class Corner>
  bool meets(const Corner& from, const Corner& to, double limit) const {
    double reach = reach_, enter = 0, leave = limit * (1 + 0x1p-30);
    for (int k = 0; k < 3; ++k) reach += std::max(std::abs(double(from[k])), std::abs(double(to[k])));
    const double margin = reach * 0x1p-46;
    for (int k = 0; k < 3; ++k) {
      const double lo = from[k] - margin - o_[k], hi = to[k] + margin - o_[k];
      if (std::abs(d_[k]) < 0x1p-60) {  // off by less than 2^-58 R on its whole way
        if (lo > 0 || hi < 0) return false;
        continue;
      }
      const double a = lo / d_[k], b = hi / d_[k];
      enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1 + 0x1p-40);
  }

 private:
  double o_[3], d_[3], reach_ = 0;
  std::size_t octant_ = 0;
};

/// A ray as shaders/index.glsl walks it: what (bound - origin) is multiplied by, nearer and farther bound of each axis, and
/// what brings s to these units.
struct IndexRay {
  float near[3], toUnits, far[3], unused;
};
IndexRay indexRay(const float (&origin)[3], const float (&direction)[3]);

}  // namespace solidcast
