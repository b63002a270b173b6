// The cosine with an ambient term: what is turned away keeps a part of its colour.
vec3 radiance(Hit hit, Ray ray, Parameters p) {
  return p.colour * (p.ambient + (1.0 - p.ambient) * max(hit.cosine, 0.0));
}
