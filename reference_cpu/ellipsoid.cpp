#include "reference_cpu/ellipsoid.h"

#include <algorithm>

namespace solidcast::reference {
namespace {

using Matrix = std::array<std::array<Quadruple, 3>, 3>;

// Products of three fp64 numbers, summed: the error is some units of 2^-113 of the terms' magnitudes.
const Quadruple noise = ldexpq(1, -106);

/// M, l, j with the sign that makes M's first entry positive, and what Cramer's rule needs of M.
struct CenteredForm {
  Matrix M{}, cofactors{};
  Vec<Quadruple> center;
  Quadruple determinant = 0;
  Quadruple level = 0;  // k: (p - center).M (p - center) = k
};

std::optional<CenteredForm> centeredForm(const QuadricCoefficients& q) {
  const int sign = q[0] < 0 ? -1 : 1;
  const auto coefficient = [&](int i) { return sign * Quadruple(q[i]); };
  CenteredForm form;
  Matrix& M = form.M;
  for (int i = 0; i < 3; ++i) M[i][i] = coefficient(i);
  M[0][1] = M[1][0] = coefficient(3) / 2;
  M[0][2] = M[2][0] = coefficient(4) / 2;
  M[1][2] = M[2][1] = coefficient(5) / 2;
  const Vec<Quadruple> l{coefficient(6) / 2, coefficient(7) / 2, coefficient(8) / 2};

  // Sylvester: definite when the leading minors are positive, each above its rounding error.
  const Quadruple minor2 = M[0][0] * M[1][1] - M[0][1] * M[0][1];
  if (!(M[0][0] > 0) || !(minor2 > noise * (absolute(M[0][0] * M[1][1]) + M[0][1] * M[0][1]))) return {};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      form.cofactors[i][k] = M[i1][k1] * M[i2][k2] - M[i1][k2] * M[i2][k1];
    }
  Quadruple magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    form.determinant += M[0][k] * form.cofactors[0][k];
    magnitude += absolute(M[0][k]) * (absolute(M[1][k1] * M[2][k2]) + absolute(M[1][k2] * M[2][k1]));
  }
  if (!(form.determinant > noise * magnitude)) return {};

  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) form.center[i] -= form.cofactors[i][k] * l[k] / form.determinant;
  const Quadruple square = -dot(l, form.center), constant = coefficient(9);
  form.level = square - constant;
  if (absolute(form.level) <= noise * (absolute(square) + absolute(constant))) form.level = 0;
  return form;
}

/// Turns M into its diagonal of eigenvalues; the columns of the result are the eigenvectors.
Matrix diagonalise(Matrix& M) {
  Matrix V{};
  for (int i = 0; i < 3; ++i) V[i][i] = 1;
  for (int sweep = 0; sweep < 50; ++sweep) {
    bool turned = false;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (absolute(M[p][q]) <= FLT128_EPSILON * sqrtq(absolute(M[p][p] * M[q][q]))) continue;
        turned = true;
        // The smaller angle that makes M[p][q] zero: tan = sign(theta) / (|theta| + sqrt(theta^2 + 1)).
        const Quadruple theta = (M[q][q] - M[p][p]) / (2 * M[p][q]);
        const Quadruple t = (theta < 0 ? -1 : 1) / (absolute(theta) + sqrtq(theta * theta + 1));
        const Quadruple c = 1 / sqrtq(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const Quadruple kp = M[k][p], kq = M[k][q];
          M[k][p] = c * kp - s * kq, M[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const Quadruple pk = M[p][k], qk = M[q][k], vp = V[k][p], vq = V[k][q];
          M[p][k] = c * pk - s * qk, M[q][k] = s * pk + c * qk;
          V[k][p] = c * vp - s * vq, V[k][q] = s * vp + c * vq;
        }
      }
    if (!turned) break;
  }
  return V;
}

/// Carlson's R_F and R_D by his duplication theorem and the closing series (DLMF 19.36.1, 19.36.2).
Quadruple carlsonF(Quadruple x, Quadruple y, Quadruple z) {
  for (;;) {
    const Quadruple mean = (x + y + z) / 3;
    const Quadruple X = 1 - x / mean, Y = 1 - y / mean, Z = -X - Y;
    if (!(greater(absolute(X), greater(absolute(Y), absolute(Z))) >= 1e-6Q)) {
      const Quadruple E2 = X * Y - Z * Z, E3 = X * Y * Z;
      return (1 - E2 / 10 + E3 / 14 + E2 * E2 / 24 - 3 * E2 * E3 / 44) / sqrtq(mean);
    }
    const Quadruple lambda = sqrtq(x * y) + sqrtq(x * z) + sqrtq(y * z);
    x = (x + lambda) / 4, y = (y + lambda) / 4, z = (z + lambda) / 4;
  }
}

Quadruple carlsonD(Quadruple x, Quadruple y, Quadruple z) {
  Quadruple sum = 0, power = 1;
  for (;;) {
    const Quadruple mean = (x + y + 3 * z) / 5;
    const Quadruple X = 1 - x / mean, Y = 1 - y / mean, Z = -(X + Y) / 3;
    if (!(greater(absolute(X), greater(absolute(Y), absolute(Z))) >= 1e-6Q)) {
      const Quadruple E2 = X * Y - 6 * Z * Z, E3 = (3 * X * Y - 8 * Z * Z) * Z;
      const Quadruple E4 = 3 * (X * Y - Z * Z) * Z * Z, E5 = X * Y * Z * Z * Z;
      const Quadruple series =
          1 - 3 * E2 / 14 + E3 / 6 + 9 * E2 * E2 / 88 - 3 * E4 / 22 - 9 * E2 * E3 / 52 + 3 * E5 / 26;
      return power * series / (mean * sqrtq(mean)) + 3 * sum;
    }
    const Quadruple lambda = sqrtq(x * y) + sqrtq(x * z) + sqrtq(y * z);
    sum += power / (sqrtq(z) * (z + lambda));
    power /= 4;
    x = (x + lambda) / 4, y = (y + lambda) / 4, z = (z + lambda) / 4;
  }
}

/// Integral of sqrt(p + (1-p) s^2) over s from 0 to z, for 0 < p <= 1.
double heightIntegral(double p, double z) {
  const double r = z * std::sqrt((1 - p) / p);
  const double asinhOverR = r < 1e-4 ? 1 - r * r / 6 : std::asinh(r) / r;
  return z * (std::sqrt(p + (1 - p) * z * z) + std::sqrt(p) * asinhOverR) / 2;
}

/// x in [low, high] where the increasing f reaches target.
template <class F>
double invert(F f, double target, double low, double high) {
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < target ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

std::optional<BoundedQuadric> boundedQuadric(const QuadricCoefficients& coefficients) {
  const auto form = centeredForm(coefficients);
  if (!form) return {};
  BoundedQuadric bounded;
  bounded.center = form->center;
  bounded.empty = form->level < 0;
  if (!bounded.empty)
    for (int i = 0; i < 3; ++i) bounded.halfExtents[i] = sqrtq(form->level * form->cofactors[i][i] / form->determinant);
  return bounded;
}

std::optional<EllipsoidAxes> ellipsoidAxes(const QuadricCoefficients& coefficients) {
  auto form = centeredForm(coefficients);
  if (!form || !(form->level > 0)) return {};
  const Matrix V = diagonalise(form->M);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int k) { return form->M[i][i] < form->M[k][k]; });
  // No eigenvalue is below determinant / largest^2, whatever the rotations' rounding left of it.
  const Quadruple largest = form->M[order[2]][order[2]];
  const Quadruple least = form->determinant / (largest * largest);
  EllipsoidAxes axes;
  axes.center = form->center;
  for (int i = 0; i < 3; ++i) {
    axes.semiAxes[i] = sqrtq(form->level / greater(form->M[order[i]][order[i]], least));
    axes.directions[i] = {V[0][order[i]], V[1][order[i]], V[2][order[i]]};
  }
  return axes;
}

Quadruple ellipsoidArea(const std::array<Quadruple, 3>& s) {
  // 2 R_G(x,y,z) = z R_F - (x-z)(y-z) R_D / 3 + sqrt(xy/z); with z in the middle no term is negative (DLMF 19.21.10).
  const Quadruple x = s[0] * s[0] * s[1] * s[1], z = s[0] * s[0] * s[2] * s[2], y = s[1] * s[1] * s[2] * s[2];
  return 2 * M_PIq * (z * carlsonF(x, y, z) + (x - z) * (z - y) * carlsonD(x, y, z) / 3 + sqrtq(x * y / z));
}

std::array<double, 3> sampleEllipsoidDirection(const std::array<Quadruple, 3>& semiAxes, double u, double v) {
  // For the unit vector (sqrt(1-z^2) cos f, sqrt(1-z^2) sin f, z), z along the shortest axis, an element dz df becomes
  // the area a b sqrt(p + (1-p) z^2) dz df with p = (c/b)^2 ((b/a)^2 cos^2 f + sin^2 f). Integrated over z this is
  // closed and changes by at most a factor 2 with f, so a plain Simpson rule serves for the longitude.
  const double bOverA = double(semiAxes[1] / semiAxes[0]), cOverB = double(semiAxes[2] / semiAxes[1]);
  const auto p = [&](double f) {
    const double x = bOverA * std::cos(f), y = std::sin(f);
    return std::clamp(cOverB * cOverB * (x * x + y * y), 1e-300, 1.0);
  };
  const auto band = [&](double from, double to) {
    const auto h = [&](double f) { return heightIntegral(p(f), 1); };
    return (to - from) / 6 * (h(from) + 4 * h((from + to) / 2) + h(to));
  };
  constexpr int panels = 256;
  constexpr double quarter = 1.57079632679489661923;
  std::array<double, panels + 1> sums{};
  for (int i = 0; i < panels; ++i) sums[i + 1] = sums[i] + band(quarter * i / panels, quarter * (i + 1) / panels);

  // v chooses one of the four quadrants, which are alike, and the longitude in it; u the height.
  const double inQuadrants = 4 * v;
  const int quadrant = std::clamp(int(inQuadrants), 0, 3);
  const double target = (inQuadrants - quadrant) * sums[panels];
  const int panel =
      std::clamp(int(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin()) - 1, 0, panels - 1);
  const double start = quarter * panel / panels;
  const double f =
      invert([&](double to) { return sums[panel] + band(start, to); }, target, start, quarter * (panel + 1) / panels);
  const double side = 2 * u - 1;
  const double height = std::abs(side) * heightIntegral(p(f), 1);
  const double z = invert([&](double to) { return heightIntegral(p(f), to); }, height, 0, 1);

  const double s = std::sqrt((1 - z) * (1 + z));
  const double x = s * std::cos(f), y = s * std::sin(f);
  return {quadrant == 1 || quadrant == 2 ? -x : x, quadrant >= 2 ? -y : y, side < 0 ? -z : z};
}

}  // namespace solidcast::reference
