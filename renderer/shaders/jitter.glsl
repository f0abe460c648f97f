// Where this frame's samples stand: every sample of a method's grid is shifted by this, in samples of that grid (see
// MethodFrame). The only push constant of a method's pipelines.
#ifndef JITTER_GLSL
#define JITTER_GLSL

layout(push_constant) uniform JitterPush { vec2 jitter; };

#endif
