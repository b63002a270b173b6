// The number type `real` of the search, and its arithmetic. One source serves three types:
//   ARITHMETIC 0  float   (methods naive and fast)                 u = 2^-24
//   ARITHMETIC 1  double  (method exact where the device has it)   u = 2^-53
//   ARITHMETIC 2  double-float, an unevaluated sum hi + lo         u = 2^-44 (stated; each operation is better)
// Double-float, largest relative error in units of 2^-48 (in brackets seen in a million cases; tests/glsl/numeric_test.cpp):
//   add, sub  3      (2.4)  Joldes, Muller, Popescu 2017, algorithm 6
//   mul       5      (4.1)  the same, algorithm 10, with the bound of Muller and Rideau 2022
//   quotient  6      (2.9)  not proven: twice what was seen
//   root      25/8   (2.99)  Lefevre, Louvet, Muller, Picot, Rideau 2023, for this algorithm with fma
// They hold while products stay above 2^-79 (their errors would be denormals) and operands below 2^115 (splitting
// overflows). x / 0 is NaN. With NaN every comparison is false; smaller() and larger() then give their second operand.
// Only + - * / and sqrt, each `precise`: without it compilers reassociate, and (a+b)-a becomes b.
// fma() is not used: it is not fused on lavapipe. min/max are not used: with NaN they are unspecified.
#ifndef SOLIDCAST_NUMERIC
#define SOLIDCAST_NUMERIC

#ifndef ARITHMETIC
#define ARITHMETIC 0
#endif

#if ARITHMETIC == 2

struct real {
  float hi, lo;
};
struct real3 {
  real x, y, z;
};
struct real4 {
  real x, y, z, w;
};
#define BIG 3.0e37

// Error-free transformations (Knuth; Dekker and Veltkamp with splitter 2^12+1).
real twoSum(float a, float b) {
  precise float s = a + b;
  precise float bb = s - a;
  precise float e = (a - (s - bb)) + (b - bb);
  return real(s, e);
}
real quickTwoSum(float a, float b) {  // |a| >= |b|
  precise float s = a + b;
  precise float e = b - (s - a);
  return real(s, e);
}
real twoProduct(float a, float b) {
  precise float p = a * b;
  precise float ca = 4097.0 * a;
  precise float ah = ca - (ca - a);
  precise float al = a - ah;
  precise float cb = 4097.0 * b;
  precise float bh = cb - (cb - b);
  precise float bl = b - bh;
  precise float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
  return real(p, e);
}

real number(float a) { return real(a, 0.0); }
float toFloat(real a) { return a.hi; }
real negate(real a) { return real(-a.hi, -a.lo); }
real add(real a, real b) {
  real s = twoSum(a.hi, b.hi);
  real t = twoSum(a.lo, b.lo);
  precise float c = s.lo + t.hi;
  real v = quickTwoSum(s.hi, c);
  precise float w = t.lo + v.lo;
  return quickTwoSum(v.hi, w);
}
real sub(real a, real b) { return add(a, negate(b)); }
real mul(real a, real b) {
  real p = twoProduct(a.hi, b.hi);
  precise float c = p.lo + (a.hi * b.lo + a.lo * b.hi);
  return quickTwoSum(p.hi, c);
}
real quotient(real a, real b) {
  precise float q = a.hi / b.hi;
  real r = sub(a, mul(b, number(q)));
  precise float c = r.hi / b.hi;
  real s = quickTwoSum(q, c);
  r = sub(r, mul(b, number(c)));
  precise float e = r.hi / b.hi;
  return add(s, number(e));
}
real root(real a) {  // NaN for a < 0
  precise float x = sqrt(a.hi);
  if (a.hi == 0.0) return real(0.0, 0.0);
  real r = sub(a, twoProduct(x, x));
  precise float c = r.hi / (2.0 * x);
  return quickTwoSum(x, c);
}
bool less(real a, real b) { return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo); }
bool atLeast(real a, real b) { return a.hi > b.hi || (a.hi == b.hi && a.lo >= b.lo); }
bool isZero(real a) { return a.hi == 0.0; }
real select(real no, real yes, bool condition) {
  return real(condition ? yes.hi : no.hi, condition ? yes.lo : no.lo);
}
real magnitude(real a) { return select(a, negate(a), a.hi < 0.0); }

#else

#if ARITHMETIC == 1
#define real double
#define real3 dvec3
#define real4 dvec4
#define BIG 1.0e250lf
#else
#define real float
#define real3 vec3
#define real4 vec4
#define BIG 3.0e37
#endif

real number(float a) { return real(a); }
float toFloat(real a) { return float(a); }
real negate(real a) { return -a; }
real add(real a, real b) {
  precise real r = a + b;
  return r;
}
real sub(real a, real b) {
  precise real r = a - b;
  return r;
}
real mul(real a, real b) {
  precise real r = a * b;
  return r;
}
real quotient(real a, real b) {
  precise real r = a / b;
  return r;
}
real root(real a) {  // NaN for a < 0
  precise real r = sqrt(a);
  return r;
}
bool less(real a, real b) { return a < b; }
bool atLeast(real a, real b) { return a >= b; }
bool isZero(real a) { return a == real(0); }
real select(real no, real yes, bool condition) { return mix(no, yes, condition); }
real magnitude(real a) { return abs(a); }

#endif

// Larger than any quantity that is compared with it: "not in doubt".
real settled() {
#if ARITHMETIC == 2
  return real(BIG, 0.0);
#else
  return real(BIG);
#endif
}

real smaller(real a, real b) { return select(b, a, less(a, b)); }
real larger(real a, real b) { return select(b, a, less(b, a)); }

// g.d in a fixed order; the part in brackets is the same for all pixels of a row, where d.y and d.z are.
real linear(real3 g, real3 d) { return add(mul(g.x, d.x), add(mul(g.y, d.y), mul(g.z, d.z))); }

#endif
