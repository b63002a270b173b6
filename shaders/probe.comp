// What the device's arithmetic really does, one test case per invocation. Every operand comes from a buffer, so that
// nothing can be folded before the device sees it; host/gpu/probe.cpp recomputes each value and counts differences.
// REAL is float or double.
#version 460
layout(local_size_x = 64) in;

struct Case {
  REAL a, b, c, unused;
};
struct Outcome {
  REAL fusedProduct;      // fma(a, b, c)
  REAL productPlus;       // a * b + c, written as two operations
  REAL quotient;          // a / b
  REAL root;              // sqrt(a)
  REAL product;           // a * b
  REAL sum;               // a + b
  REAL difference;        // (a + b) - a
  REAL sumError;          // TwoSum: a + b = sum + sumError exactly
  REAL productError;      // TwoProd after Dekker and Veltkamp: a * b = product + productError exactly
  REAL unused1, unused2, unused3;
};

layout(std430, set = 0, binding = 0) readonly buffer Cases { Case cases[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Outcomes { Outcome outcomes[]; };
// 2^s + 1, where s is half the significand's width, rounded up: 4097 for float, 2^27 + 1 for double.
layout(push_constant) uniform Constants { uint splitter; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= cases.length()) return;
  REAL a = cases[i].a, b = cases[i].b, c = cases[i].c;

  precise REAL fusedProduct = fma(a, b, c);
  precise REAL productPlus = a * b + c;
  precise REAL quotient = a / b;
  precise REAL root = sqrt(a);
  precise REAL product = a * b;
  precise REAL sum = a + b;
  precise REAL difference = (a + b) - a;

  precise REAL bRounded = sum - a;
  precise REAL sumError = (a - (sum - bRounded)) + (b - bRounded);

  precise REAL aScaled = REAL(splitter) * a;
  precise REAL bScaled = REAL(splitter) * b;
  precise REAL aHigh = aScaled - (aScaled - a);
  precise REAL bHigh = bScaled - (bScaled - b);
  precise REAL aLow = a - aHigh;
  precise REAL bLow = b - bHigh;
  precise REAL productError = ((aHigh * bHigh - product) + aHigh * bLow + aLow * bHigh) + aLow * bLow;

  outcomes[i] = Outcome(fusedProduct, productPlus, quotient, root, product, sum, difference, sumError, productError,
                        REAL(0), REAL(0), REAL(0));
}
