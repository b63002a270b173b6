#include "host/cast/index.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <thread>

#include "host/cast/bounds.h"
#include "host/cast/second_pass.h"

namespace solidcast {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float everything = 0x1p126f;
constexpr int bins = 16;
constexpr int deepest = 96;          // below, halves by number: no scene makes the recursion deep
constexpr double stepOverSolid = 1;  // what a node costs, in solids
constexpr std::size_t worthAThread = 8192;

struct Box {
  float lo[3] = {infinite, infinite, infinite}, hi[3] = {-infinite, -infinite, -infinite};

  void add(const Box& other) {
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], other.lo[k]), hi[k] = std::max(hi[k], other.hi[k]);
  }
  double area() const {  // half of it
    const double x = double(hi[0]) - lo[0], y = double(hi[1]) - lo[1], z = double(hi[2]) - lo[2];
    return x * y + y * z + z * x;
  }
};

struct Item {
  Box box;
  std::uint32_t solid;
  float middle(int axis) const { return box.lo[axis] * 0.5f + box.hi[axis] * 0.5f; }
};

/// A bin's number is a monotone function of the middle, so that solids of equal middles stay together.
struct Split {
  int axis = -1;
  int bin = 0;  // the left side ends with it
  float from = 0, scale = 0;
  double cost = infinite;
  int binOf(const Item& item) const {
    return std::clamp(static_cast<int>((item.middle(axis) - from) * scale), 0, bins - 1);
  }
};

Split bestSplit(std::span<const Item> items, double area) {
  Box middles;
  for (const Item& item : items)
    for (int k = 0; k < 3; ++k) {
      middles.lo[k] = std::min(middles.lo[k], item.middle(k));
      middles.hi[k] = std::max(middles.hi[k], item.middle(k));
    }
  struct Bin {
    Box box;
    std::uint32_t count = 0;
  };
  std::array<std::array<Bin, bins>, 3> all;
  std::array<Split, 3> axes;
  for (int k = 0; k < 3; ++k) {
    Split& s = axes[static_cast<std::size_t>(k)];
    const float extent = middles.hi[k] - middles.lo[k];
    s.axis = extent > 0 && bins / extent < infinite ? k : -1;
    s.from = middles.lo[k], s.scale = bins / extent;
  }
  for (const Item& item : items)
    for (std::size_t k = 0; k < 3; ++k) {
      if (axes[k].axis < 0) continue;
      Bin& bin = all[k][static_cast<std::size_t>(axes[k].binOf(item))];
      bin.box.add(item.box);
      ++bin.count;
    }
  Split best;
  for (std::size_t k = 0; k < 3; ++k) {
    if (axes[k].axis < 0) continue;
    std::array<double, bins> right{};  // area times number from bin i on
    Box box;
    std::uint32_t count = 0;
    for (int i = bins - 1; i > 0; --i) {
      const Bin& bin = all[k][static_cast<std::size_t>(i)];
      if (bin.count > 0) box.add(bin.box), count += bin.count;
      right[static_cast<std::size_t>(i)] = count > 0 ? box.area() * count : infinite;
    }
    box = {}, count = 0;
    for (int i = 0; i + 1 < bins; ++i) {
      const Bin& bin = all[k][static_cast<std::size_t>(i)];
      if (bin.count > 0) box.add(bin.box), count += bin.count;
      if (count == 0) continue;
      const double cost = stepOverSolid + (box.area() * count + right[static_cast<std::size_t>(i + 1)]) / area;
      if (cost < best.cost) best = axes[k], best.bin = i, best.cost = cost;
    }
  }
  return best;
}

/// One kind's tree. Nodes count from 0, places in the order from `firstPlace`.
class Builder {
 public:
  Builder(std::span<Item> items, std::uint32_t firstPlace) : items_(items), firstPlace_(firstPlace) {}

  std::vector<IndexNode> build(unsigned threads) const { return build(0, items_.size(), 0, threads); }

 private:
  std::vector<IndexNode> build(std::size_t first, std::size_t last, int depth, unsigned threads) const {
    std::vector<IndexNode> nodes;
    append(nodes, first, last, depth, threads);
    return nodes;
  }

  void append(std::vector<IndexNode>& nodes, std::size_t first, std::size_t last, int depth, unsigned threads) const {
    const auto part = items_.subspan(first, last - first);
    Box box;
    for (const Item& item : part) box.add(item.box);
    const std::size_t here = nodes.size();
    nodes.emplace_back();
    std::copy_n(box.lo, 3, nodes[here].lo), std::copy_n(box.hi, 3, nodes[here].hi);
    nodes[here].leaf = nodes[here].link = 0;
    int axis = 0;
    std::uint32_t upper = 0;
    const std::size_t middle = part.size() > 1 ? first + divide(part, box, depth, axis) : first;
    if (middle == first) {
      std::sort(part.begin(), part.end(), [](const Item& a, const Item& b) { return a.solid < b.solid; });
      nodes[here].leaf = static_cast<std::uint32_t>(16 * (firstPlace_ + first) + part.size());
    } else if (threads > 1 && part.size() > worthAThread) {
      std::vector<IndexNode> right;
      std::thread helper([&] { right = build(middle, last, depth + 1, threads / 2); });
      append(nodes, first, middle, depth + 1, threads - threads / 2);
      helper.join();
      const auto from = static_cast<std::uint32_t>(nodes.size());
      for (IndexNode& node : right)
        if (node.leaf == 0) node.link += 4 * from;
      nodes.insert(nodes.end(), right.begin(), right.end());
      upper = from;
    } else {
      append(nodes, first, middle, depth + 1, 1);
      upper = static_cast<std::uint32_t>(nodes.size());
      append(nodes, middle, last, depth + 1, 1);
    }
    if (nodes[here].leaf == 0) nodes[here].link = 4 * upper + static_cast<std::uint32_t>(axis);
  }

  /// Sorts the solids into two sides of an axis; number of those on the lower, 0: a leaf.
  static std::size_t divide(std::span<Item> part, const Box& box, int depth, int& axis) {
    const Split split = depth < deepest ? bestSplit(part, std::max(box.area(), 1e-300)) : Split{};
    if (part.size() <= mostInLeaf && !(split.cost < static_cast<double>(part.size()))) return 0;
    std::size_t left = 0;
    if (split.axis >= 0) {
      axis = split.axis;
      const auto right =
          std::partition(part.begin(), part.end(), [&](const Item& i) { return split.binOf(i) <= split.bin; });
      left = static_cast<std::size_t>(right - part.begin());
    }
    if (left == 0 || left == part.size()) left = part.size() / 2;  // all in one place
    return left;
  }

  std::span<Item> items_;
  std::uint32_t firstPlace_;
};

float below(double v) { return std::nextafter(static_cast<float>(v - 0x1p-100), -infinite); }
float above(double v) { return std::nextafter(static_cast<float>(v + 0x1p-100), infinite); }

Box boxOf(const Bounds& bounds, double widened) {
  Box box;
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) most = std::max(most, bounds.hi[k] - bounds.lo[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = below(bounds.lo[k] - widened * most);
    box.hi[k] = above(bounds.hi[k] + widened * most);
  }
  return box;
}

/// Of the tree that begins at `root` and is the last so far.
void addSkips(Index& index, std::size_t root) {
  index.skips.resize(8 * index.nodes.size(), static_cast<std::uint32_t>(index.nodes.size()));
  for (std::size_t at = root; at < index.nodes.size(); ++at) {
    const IndexNode& node = index.nodes[at];
    if (node.leaf != 0) continue;
    const auto lower = static_cast<std::uint32_t>(at + 1), upper = node.link / 4;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      const bool upperFirst = octant >> node.link % 4 & 1;
      const std::uint32_t first = upperFirst ? upper : lower, second = upperFirst ? lower : upper;
      index.skips[8 * first + octant] = second;
      index.skips[8 * second + octant] = index.skips[8 * at + octant];
    }
  }
}

}  // namespace

Index buildIndex(const World& world, double widened, unsigned threads) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::optional<Bounds>> bounds(world.solids.size());
  inParallel(bounds.size(), [&](std::size_t i) { bounds[i] = boundsOf(world.solids.shape(i)); });
  std::array<std::vector<Item>, kindCount> bounded;
  std::array<std::vector<std::uint32_t>, kindCount> always;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const auto kind = static_cast<std::size_t>(kindNumber(world.solids.shape(i)));
    const auto solid = static_cast<std::uint32_t>(i);
    if (bounds[i]) bounded[kind].push_back({boxOf(*bounds[i], widened), solid});
    else always[kind].push_back(solid);
  }
  Index index;
  index.order.reserve(bounds.size());
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    index.firstPlace[kind] = static_cast<std::uint32_t>(index.order.size());
    for (std::size_t i = 0; i < always[kind].size(); i += mostInLeaf) {
      const std::size_t n = std::min<std::size_t>(mostInLeaf, always[kind].size() - i);
      index.nodes.push_back({{-everything, -everything, -everything},
                             0,
                             {everything, everything, everything},
                             static_cast<std::uint32_t>(16 * (index.order.size() + i) + n)});
      const auto next = static_cast<std::uint32_t>(index.nodes.size());
      index.skips.insert(index.skips.end(), 8, next);
    }
    index.order.insert(index.order.end(), always[kind].begin(), always[kind].end());
    const auto from = static_cast<std::uint32_t>(index.nodes.size());
    if (!bounded[kind].empty()) {
      Builder builder(bounded[kind], static_cast<std::uint32_t>(index.order.size()));
      std::vector<IndexNode> tree = builder.build(threads);
      for (IndexNode& node : tree)
        if (node.leaf == 0) node.link += 4 * from;
      index.nodes.insert(index.nodes.end(), tree.begin(), tree.end());
      addSkips(index, from);
    }
    for (const Item& item : bounded[kind]) index.order.push_back(item.solid);
    index.end[kind] = static_cast<std::uint32_t>(index.nodes.size());
  }
  return index;
}

Records inOrder(const Records& records, const Index& index) {
  Records sorted = records;
  std::size_t rows = 0;
  for (std::size_t k = 0; k < kindCount; ++k) rows += std::size_t{records.count[k]} * records.rowsPer[k];
  const std::size_t rowBytes = rows > 0 ? records.bytes.size() / rows : 0;
  for (std::size_t place = 0; place < index.order.size(); ++place) {
    const std::uint32_t solid = index.order[place];
    const auto [kind, row] = records.places[solid];
    const auto to =
        static_cast<std::uint32_t>(records.firstRow[kind] + (place - index.firstPlace[kind]) * records.rowsPer[kind]);
    sorted.places[solid][1] = to;
    std::memcpy(sorted.bytes.data() + to * rowBytes, records.bytes.data() + row * rowBytes,
                records.rowsPer[kind] * rowBytes);
  }
  return sorted;
}

// With d scaled by a power of two so that its largest component m is in [1, 2), and exact: a bound ahead is reached at
// (bound - o)/d. The shader's difference and product and this quotient round by 2^-24 each, so a `near` smaller by 2^-22
// and a `far` larger by as much keep the first below and the second above the truth. Behind the origin (bound - o < 0)
// both only grow more negative or less, which decides nothing: a hit needs t > 0. Steep axes, |d_i| < 2^-60 and 0 among
// them: a bound ahead is taken to be as near as 2^60 times its distance, a farther bound as out of reach.
// Rays with numbers beyond 2^100, or a direction below 2^-100, meet every box: near = far = 0.
IndexRay indexRay(const float (&origin)[3], const float (&direction)[3]) {
  double most = 0;
  bool usual = true;
  for (int k = 0; k < 3; ++k) {
    most = std::max(most, std::abs(double(direction[k])));
    usual = usual && std::abs(origin[k]) <= 0x1p100f;
  }
  if (!usual || !(most >= 0x1p-100 && most <= 0x1p100)) return {};
  const int exponent = std::ilogb(most);
  IndexRay ray{};
  ray.toUnits = std::ldexp(1.f, -exponent);
  for (int k = 0; k < 3; ++k) {
    const double d = std::ldexp(double(direction[k]), -exponent), sign = std::signbit(direction[k]) ? -1 : 1;
    const bool steep = std::abs(d) < 0x1p-60;
    ray.near[k] = static_cast<float>((steep ? sign * 0x1p60 : 1 / d) * (1 - 0x1p-22));
    ray.far[k] = static_cast<float>(steep ? sign * HUGE_VAL : 1 / d * (1 + 0x1p-22));
  }
  return ray;
}

}  // namespace solidcast
