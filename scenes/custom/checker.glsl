// Cubes of two colours by local coordinates: position on most solids, but along the edges of triangles and quads.
// A face that lies between two cubes would flicker with the last bit of its position: the grid stands off by a bit.
vec3 radiance(Hit hit, Ray ray, Parameters p) {
  ivec3 cell = ivec3(floor(hit.local / p.size + 0.137));
  bool odd = ((cell.x + cell.y + cell.z) & 1) != 0;
  return (odd ? p.first : p.second) * abs(hit.cosine);
}
