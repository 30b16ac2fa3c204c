// Texels of the atlas (or any points) that receive light.
struct Receiver {
  vec4 position;  // xyz, object space
  vec4 normal;    // xyz, unit
};

layout(std430, binding = 1) readonly buffer ReceiverList {
  Receiver receivers[];
};
uniform int receiver_count;
