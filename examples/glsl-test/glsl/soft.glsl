// Smooth step from 0 to 1 between low and high.
float soft(float low, float high, float x) {
  precise float t = (x - low) / (high - low);
  t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
  precise float r = t * t * (3.0 - 2.0 * t);
  return r;
}
