#include "host/oracle/root.h"

namespace solidcast::oracle {
namespace {

// (p + s sqrt(d)) / q with q > 0 and s in {-1, 0, 1}.
struct Surd {
  Dyadic p, d, q;
  int s = 0;
};

Surd surd(const Root<Exact>& root) {
  const Dyadic &a = root.a.value, &b = root.b.value, &d = root.d.value;
  Surd x;
  if (root.kind == Root<Exact>::rational) {
    x = {a, Dyadic(), b, 0};
  } else if (root.kind == Root<Exact>::above) {
    x = {a, d, b, 1};
  } else {
    const Dyadic rest = b * b - d;  // (b + sqrt(d)) (b - sqrt(d))
    if (rest.sign() == 0) {
      x = {a, Dyadic(), b + b, 0};  // sqrt(d) is |b|, and b > 0 since b + sqrt(d) is not 0
    } else {
      x = {a * b, d * a * a, rest, a.sign() > 0 ? -1 : 1};
    }
  }
  if (x.q.sign() < 0) x = {-x.p, x.d, -x.q, -x.s};
  return x;
}

// Sign of a + s sqrt(b), b >= 0.
int signOfSum(const Dyadic& a, int s, const Dyadic& b) {
  const int surdSign = b.sign() == 0 ? 0 : s;
  if (surdSign == 0 || a.sign() == surdSign) return a.sign() != 0 ? a.sign() : surdSign;
  if (a.sign() == 0) return surdSign;
  return (a * a - b).sign() * a.sign();
}

}  // namespace

int compare(const Root<Exact>& left, const Root<Exact>& right) {
  const Surd x = surd(left), y = surd(right);
  // x - y has the sign of r + s sqrt(b) + u sqrt(c), everything multiplied by q_x q_y > 0.
  const Dyadic r = x.p * y.q - y.p * x.q;
  const Dyadic b = x.d * y.q * y.q, c = y.d * x.q * x.q;
  const int s = b.sign() == 0 ? 0 : x.s, u = c.sign() == 0 ? 0 : -y.s;
  if (u == 0) return signOfSum(r, s, b);
  if (s == 0) return signOfSum(r, u, c);
  const int surds = s == u ? s : (b - c).sign() * s;  // sign of s sqrt(b) + u sqrt(c)
  if (surds == 0 || r.sign() == surds) return r.sign();
  if (r.sign() == 0) return surds;
  // Opposite signs: |r| against |s sqrt(b) + u sqrt(c)|, squared: r^2 - b - c - 2 s u sqrt(bc).
  return signOfSum(r * r - b - c, -s * u, Dyadic(4.0) * b * c) * r.sign();
}

}  // namespace solidcast::oracle
