// Exact dyadic rationals (integer times a power of two). Every fp32, fp64 and binary128 number is one, and they are
// closed under + - *, so any polynomial of a scene and a ray has a sign that can be decided, without the gcds of
// general rationals.
#pragma once
#include <gmpxx.h>

namespace solidcast::oracle {

class Dyadic {
 public:
  Dyadic() = default;
  /// Exactly x, which must be finite.
  explicit Dyadic(double x);
  explicit Dyadic(__float128 x);

  int sign() const { return sgn(integer_); }
  /// Nearest binary128 up to one unit of its last place.
  __float128 rounded() const;

  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return sum(a, b, false); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, true); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
  Dyadic operator-() const;

  /// a/b and sqrt(a) cut off after at least `bits` significant bits; exact where the result has no more than that.
  /// b must not be 0, a of a root not negative.
  friend Dyadic quotient(const Dyadic& a, const Dyadic& b, unsigned bits);
  friend Dyadic squareRoot(const Dyadic& a, unsigned bits);

 private:
  static Dyadic sum(const Dyadic& a, const Dyadic& b, bool subtract);

  mpz_class integer_ = 0;
  long exponent_ = 0;  // value = integer_ 2^exponent_
};

}  // namespace solidcast::oracle
