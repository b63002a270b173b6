// The normal as a colour: x, y and z from -1 to 1 become red, green and blue.
vec3 radiance(Hit hit, Ray ray, Parameters p) { return 0.5 + 0.5 * hit.normal; }
