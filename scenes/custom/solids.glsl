// Every solid its own hue, by index; edges, which face the eye least, go dark.
vec3 radiance(Hit hit, Ray ray, Parameters p) {
  float hue = fract(0.57 + float(hit.solid) * 0.618034);  // the golden ratio keeps neighbours apart
  vec3 colour = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return colour * smoothstep(0.0, p.edge, abs(hit.cosine));
}
