#include <cmath>

#include "host/cast/footprint_kernels.h"
#include "host/cast/wide.h"

namespace solidcast {
namespace {

/// In SmallDisc's units, which moves the centre by up to 2^-6 pixels each way: the radius gives way by sqrt 2 of that, and by
/// what fp32 took of it.
inline std::uint64_t smallDisc(float x, float y, float radius, std::int32_t hides) {
  constexpr float per = SmallDisc::perPixel;
  const float size = (radius - 0.0225f) * per;
  const bool small = (size >= 1) & (size < SmallDisc::most + 1) & (x > 0) & (y > 0) & (x < 1 << 15) & (y < 1 << 15);
  const auto X = static_cast<std::int32_t>(small ? x * per + 0.5f : 0),
             Y = static_cast<std::int32_t>(small ? y * per + 0.5f : 0);
  const auto R = static_cast<std::int32_t>(small ? size : 0);
  // No types of 16 bits: for their sake the compiler would take vectors of so many numbers.
  const auto place = static_cast<std::uint32_t>((X & 0xffff) | Y << 16),
             rest = static_cast<std::uint32_t>(R | hides << 16);
  return std::uint64_t{rest} << 32 | place;
}

/// Of the squared radius, what the shader's rounding cannot take: lost |f| min(|f|, 16 r), from 16 radii on by the form for far
/// spheres; |f| <= (|f|^2 / Z + Z) / 2. `slope`: 1 / Z.
template <class Number>
inline Number heldOf(Number lost, Number radius, Number square, Number Z, Number slope) {
  const Number reach = 8 * radius * (square * slope + Z);
  const Number left = radius * radius - lost * (square < reach ? square : reach);
  return left > 0 ? left : 0;
}

/// Centres from the world's origin, and radii: where they are seen, and their discs. True: some sphere is farther than 16 radii.
/// In fp32 and units of the eye's: a centre is nowhere farther off than 12 u (|x| + |y| + |z|), by which the sphere is taken
/// larger; what is then calculated with errors of up to 16 u of its terms is moved by 32.
template <bool DISCS>
inline __attribute__((always_inline)) bool spheres(const Footprints::View& view, Footprints::Spheres& b) {
  const Footprints::View v = view;  // nothing that is stored can change it
  constexpr float u = 0x1p-24f;
  float axes[3][3];
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) axes[k][i] = static_cast<float>(v.axes[k][i]);
  const auto perX = static_cast<float>(v.perX), perY = static_cast<float>(v.perY);
  const auto lowX = static_cast<float>(v.lowX - v.rough), highX = static_cast<float>(v.highX + v.rough);
  const auto lowY = static_cast<float>(v.lowY - v.rough), highY = static_cast<float>(v.highY + v.rough);
  const auto middleX = static_cast<float>(v.middleX), middleY = static_cast<float>(v.middleY);
  const auto lastX = static_cast<float>(v.lastX), lastY = static_cast<float>(v.lastY);
  const auto unit = static_cast<float>(1 / v.inverseUnit), lost = static_cast<float>(1.01 * v.lost);
  const auto margin = static_cast<float>(v.margin + v.rough), per = perX < perY ? perX : perY;
  std::int32_t far = 0, near = 0;
  for (std::size_t i = 0, count = b.count; i < count; ++i) {
    const double x = (b.v[0][i] - v.origin[0]) * v.inverseUnit, y = (b.v[1][i] - v.origin[1]) * v.inverseUnit;
    const double z = (b.v[2][i] - v.origin[2]) * v.inverseUnit, r = b.v[3][i] * v.inverseUnit;
    far |= x * x + y * y + z * z > 256 * r * r;  // isFar()
    const auto fx = static_cast<float>(x), fy = static_cast<float>(y), fz = static_cast<float>(z);
    const auto radius = static_cast<float>(r);
    const float X = axes[0][0] * fx + axes[0][1] * fy + axes[0][2] * fz;
    const float Y = axes[1][0] * fx + axes[1][1] * fy + axes[1][2] * fz;
    const float Z = axes[2][0] * fx + axes[2][1] * fy + axes[2][2] * fz;
    const float size = std::abs(fx) + std::abs(fy) + std::abs(fz), off = 12 * u * size;
    const float big = radius * (1 + 2 * u) + off;
    const float q = Z * Z - big * big, inverse = 1 / q;
    const float hx = big * std::sqrt(X * X + q), hy = big * std::sqrt(Y * Y + q);
    const float acrossX = X * Z * inverse * perX, halfX = hx * inverse * perX;
    const float acrossY = Y * Z * inverse * perY, halfY = hy * inverse * perY;
    const float moreX = 32 * u * (std::abs(acrossX) + halfX), moreY = 32 * u * (std::abs(acrossY) + halfY);
    pixels(acrossX - halfX - moreX + lowX, acrossX + halfX + moreX + highX, lastX, b.x0[i], b.x1[i]);
    pixels(acrossY - halfY - moreY + lowY, acrossY + halfY + moreY + highY, lastY, b.y0[i], b.y1[i]);
    // Where squares neither overflow nor vanish, and q keeps its digits.
    const bool plain = (Z > 2 * big) & (Z > 1e-15f) & (size < 1e18f);
    b.plain[i] = plain, near |= (Z > big) & !plain;
    b.nearest[i] = v.scale.begins((Z - big) * (1 - 1e-6f) * unit);
    const float square = X * X + Y * Y + Z * Z;
    const bool covers = (Z > 0) & (square > radius * radius * 1.001f);
    const std::int32_t hides = covers ? v.scale.ends((Z + off) * (1 + 1e-6f) * unit) : DepthScale::none;
    b.hides[i] = hides;
    if constexpr (DISCS) {
      const float slope = 1 / Z, held = heldOf(lost, radius, square, Z, slope);
      const std::uint64_t disc = smallDisc(X * slope * perX + middleX, Y * slope * perY + middleY,
                                           std::sqrt(held) * slope * per - margin, hides);
      b.disc[i] = plain ? disc : 0;
    }
  }
  b.near = near;
  return far;
}

/// What they cover: a disc through the centre, parallel to the image, is a circle there, less what rounding takes.
inline __attribute__((always_inline)) bool coveringSpheres(const Footprints::View& view, Footprints::Spheres& b) {
  const Footprints::View v = view;
  std::int32_t far = 0;
  for (std::size_t i = 0, count = b.count; i < count; ++i) {
    const double x = b.v[0][i] - v.origin[0], y = b.v[1][i] - v.origin[1], z = b.v[2][i] - v.origin[2];
    const double radius = b.v[3][i];
    const double fx = x * v.inverseUnit, fy = y * v.inverseUnit, fz = z * v.inverseUnit, fr = radius * v.inverseUnit;
    far |= fx * fx + fy * fy + fz * fz > 256 * fr * fr;  // isFar()
    const double X = v.axes[0][0] * x + v.axes[0][1] * y + v.axes[0][2] * z;
    const double Y = v.axes[1][0] * x + v.axes[1][1] * y + v.axes[1][2] * z;
    const double Z = v.axes[2][0] * x + v.axes[2][1] * y + v.axes[2][2] * z;
    const double big = radius * (1 + 1e-9) + 1e-12 * (std::abs(X) + std::abs(Y) + std::abs(Z));
    const double q = Z * Z - big * big, inverse = 1 / q;
    const double hx = big * std::sqrt(X * X + q), hy = big * std::sqrt(Y * Y + q);
    const double square = X * X + Y * Y + Z * Z, slope = 1 / Z;
    const double circle = std::sqrt(heldOf(v.lost, radius, square, Z, slope)) * slope;
    const double wide = circle * v.perX - v.margin, high = circle * v.perY - v.margin;
    b.cover[0][i] = X * slope * v.perX + v.middleX, b.cover[1][i] = Y * slope * v.perY + v.middleY;
    b.cover[2][i] = wide, b.cover[3][i] = high;
    const bool covers = (Z > 0) & (square > radius * radius * 1.001) & (wide > 0) & (high > 0);
    store(v, {(X * Z - hx) * inverse, (X * Z + hx) * inverse, (Y * Z - hy) * inverse, (Y * Z + hy) * inverse},
          Z > 1.01 * big, Z - big, Z, covers, i, b);
  }
  return far;
}

}  // namespace

WIDE void numbersOf(const Sphere* __restrict solids, std::size_t count, const Triple&,
                    Footprints::Spheres& __restrict b, std::size_t to) {
  for (std::size_t i = 0; i < count; ++i) {
    const Sphere s = solids[i];
    b.v[0][to + i] = s.center[0], b.v[1][to + i] = s.center[1], b.v[2][to + i] = s.center[2];
    b.v[3][to + i] = s.radius;
  }
}

WIDE bool ofSpheres(const Footprints::View& v, Footprints::Spheres& b) { return spheres<false>(v, b); }
WIDE bool ofDiscs(const Footprints::View& v, Footprints::Spheres& b) { return spheres<true>(v, b); }
WIDE bool ofCoveringSpheres(const Footprints::View& v, Footprints::Spheres& b) { return coveringSpheres(v, b); }

}  // namespace solidcast
