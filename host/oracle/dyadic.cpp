#include "host/oracle/dyadic.h"

#include <quadmath.h>

#include <cmath>

namespace solidcast::oracle {

Dyadic::Dyadic(double x) {
  int exponent = 0;
  integer_ = std::ldexp(std::frexp(x, &exponent), 53);
  exponent_ = exponent - 53;
}

Dyadic::Dyadic(__float128 x) {
  int exponent = 0;
  const __float128 fraction = frexpq(x < 0 ? -x : x, &exponent);
  const auto bits = static_cast<unsigned __int128>(ldexpq(fraction, 113));
  const unsigned long words[2] = {static_cast<unsigned long>(bits), static_cast<unsigned long>(bits >> 64)};
  mpz_import(integer_.get_mpz_t(), 2, -1, sizeof words[0], 0, 0, words);
  if (x < 0) integer_ = -integer_;
  exponent_ = exponent - 113;
}

__float128 Dyadic::rounded() const {
  if (sign() == 0) return 0;
  const long size = static_cast<long>(mpz_sizeinbase(integer_.get_mpz_t(), 2));
  const long drop = size > 126 ? size - 126 : 0;
  mpz_class top;
  mpz_tdiv_q_2exp(top.get_mpz_t(), integer_.get_mpz_t(), static_cast<mp_bitcnt_t>(drop));
  unsigned long words[2] = {0, 0};
  mpz_export(words, nullptr, -1, sizeof words[0], 0, 0, top.get_mpz_t());
  const auto bits = (static_cast<unsigned __int128>(words[1]) << 64) | words[0];
  const __float128 magnitude = ldexpq(static_cast<__float128>(bits), static_cast<int>(exponent_ + drop));
  return sign() < 0 ? -magnitude : magnitude;
}

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, bool subtract) {
  if (b.sign() == 0) return a;
  Dyadic result;
  if (a.sign() == 0) {
    result = b;
    if (subtract) result.integer_ = -result.integer_;
    return result;
  }
  // The one with the larger exponent is shifted up to the other's.
  result.exponent_ = std::min(a.exponent_, b.exponent_);
  const mpz_class left = a.integer_ << static_cast<mp_bitcnt_t>(a.exponent_ - result.exponent_);
  const mpz_class right = b.integer_ << static_cast<mp_bitcnt_t>(b.exponent_ - result.exponent_);
  if (subtract) {
    result.integer_ = left - right;
  } else {
    result.integer_ = left + right;
  }
  return result;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic result;
  result.integer_ = a.integer_ * b.integer_;
  result.exponent_ = a.exponent_ + b.exponent_;
  return result;
}

Dyadic Dyadic::operator-() const {
  Dyadic result = *this;
  result.integer_ = -result.integer_;
  return result;
}

Dyadic quotient(const Dyadic& a, const Dyadic& b, unsigned bits) {
  Dyadic result;
  const long sizeA = static_cast<long>(mpz_sizeinbase(a.integer_.get_mpz_t(), 2));
  const long sizeB = static_cast<long>(mpz_sizeinbase(b.integer_.get_mpz_t(), 2));
  const long shift = std::max(0L, static_cast<long>(bits) + 1 + sizeB - sizeA);
  result.integer_ = (a.integer_ << static_cast<mp_bitcnt_t>(shift)) / b.integer_;
  result.exponent_ = a.exponent_ - b.exponent_ - shift;
  return result;
}

Dyadic squareRoot(const Dyadic& a, unsigned bits) {
  Dyadic result;
  const long size = static_cast<long>(mpz_sizeinbase(a.integer_.get_mpz_t(), 2));
  long shift = std::max(0L, 2 * static_cast<long>(bits) + 2 - size);
  if ((a.exponent_ - shift) % 2 != 0) ++shift;
  result.integer_ = sqrt(mpz_class(a.integer_ << static_cast<mp_bitcnt_t>(shift)));
  result.exponent_ = (a.exponent_ - shift) / 2;
  return result;
}

}  // namespace solidcast::oracle
