// Near things white, far ones black, whatever they face.
vec3 radiance(Hit hit, Ray ray, Parameters p) {
  return vec3(1.0 - clamp((hit.distance - p.near) / (p.far - p.near), 0.0, 1.0));
}
