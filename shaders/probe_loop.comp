// How many iterations a plain loop really makes: some drivers cut loops off without a word.
#version 460
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) writeonly buffer Count { uint count; };
layout(push_constant) uniform Constants { uint wanted; };

void main() {
  uint done = 0;
  uint state = 1;
  while (done < wanted) {
    state = state * 1664525u + 1013904223u;  // keeps a compiler from seeing the result beforehand
    done += 1 + (state & 0);
  }
  count = state == 0u ? 0u : done;
}
